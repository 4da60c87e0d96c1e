"""Checks of a beam and its mount: inputs that belong together, and probable mistakes of units.

Impossible inputs raise an error, unusual ones a warning.  Limits of validity of the theory are checked in
`beamdyn.scene.validity`, and reported in the results.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Sequence
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, kind, refuse, set_fields, several
from beamdyn.common.words import Named, Words
from beamdyn.scene.names_elsewhere import GIVE_IT, GIVE_OR_COMPUTE, IN_RADIANS
from beamdyn.scene.points import PointMass, PointSpring
from beamdyn.scene.profile import Profile
from beamdyn.scene.section_matrices import SectionMatrices

Beam = Any  # `beamdyn.scene.beam.Beam`, whose module imports this one
# Distance by which a point may exceed the length, relative to the length, because of rounding errors.
_ROUNDING = 1e-12
_TURNS_BACK = np.pi / 2  # kink [rad] of the axis at which the axis runs back on itself
OFFSETS = ("mass_offset", "tension_offset")  # distances of centres from the shear centre
_MADE = {PointMass: "PointMass(position, mass)", PointSpring: "PointSpring(position, stiffness)"}
_BEYOND = {PointMass: "a body beyond the tip is a TipMass", PointSpring: "hold the tip itself"}


def check_together(beam: Beam) -> None:
    """Refuse properties given without others that they need, and a tip body that is behind the root."""
    if beam.twist is not None and beam.second_bending_stiffness is None:
        bound, other = "twist turns two directions of bending: it needs {other}", "second_bending_stiffness"
        said: dict[str, Any] = {"other": other, "where": " at the tip"}
        raise InvalidValue("twist", beam.tip_twist, bound, GIVE_OR_COMPUTE, "rad", **said)
    if beam.torsion_stiffness is None:
        _check_without_torsion(beam)
    if beam.tip is not None and beam.length + beam.tip.offset < 0:
        bound, remedy = "it puts the body behind the root", "give an offset above {limit}"
        raise InvalidValue("tip.offset", beam.tip.offset, bound, remedy, "m", -beam.length)


def _check_without_torsion(beam: Beam) -> None:
    """Refuse warping stiffness and offsets of a beam without torsional stiffness."""
    said: dict[str, Any] = {"other": "torsion_stiffness"}
    if beam.warping_stiffness is not None:
        value, bound = float(beam.warping_stiffness(np.zeros(1))[0]), "warping needs {other} as well"
        said |= {"unit": "N m4", "where": " at the root"}
        raise InvalidValue("warping_stiffness", value, bound, "give both, or neither", **said)
    bound = "forces beside the shear centre twist the beam, which needs {other}"
    for name in OFFSETS:
        if (given := getattr(beam, name)) is not None and (place := first_place(given)) is not None:
            value, where = float(given(np.array(place))), f" at x/L = {place:.3f}"
            raise InvalidValue(name, value, bound, GIVE_IT, "m", where=where, **said)
    if beam.tip is not None and beam.tip.offset_across:
        raise InvalidValue("tip.offset_across", beam.tip.offset_across, bound, GIVE_IT, "m", **said)


def check_matrices(beam: Beam, names: Sequence[str]) -> None:
    """Refuse properties that differ from those of the beam's 6 x 6 section matrices."""
    if beam.matrices is None:
        return
    kind("matrices", beam.matrices, SectionMatrices, "SectionMatrices.at_stations makes them")
    for name in names:
        if not alike(getattr(beam, name), beam.matrices.properties.get(name)):
            bound = "differs from that of the 6 x 6 section matrices"
            raise InvalidValue(name, getattr(beam, name), bound, "change the matrices instead")


def check_axis(beam: Beam) -> None:
    """Refuse an axis that turns back on itself at a kink."""
    for name, angle in (("sweep", beam.sweep), ("prebend", beam.prebend)):
        if angle is None:
            continue
        left, right = angle.end_values()
        turned = np.abs(left - np.append(0.0, right[:-1]))
        k = int(turned.argmax())
        if turned[k] >= _TURNS_BACK:
            where = f" turns by {turned[k]:.4g} rad at x/L = {angle.breakpoints[k]:.4g}"
            bound = "the axis turns back on itself: a kink must be below {limit}"
            said: dict[str, Any] = {"limit": _TURNS_BACK, "where": where}
            raise InvalidValue(name, float(left[k]), bound, IN_RADIANS, "rad", **said)


def check_points(beam: Beam, name: str, wanted: type) -> None:
    """Store point masses or springs as a tuple; refuse other objects, and positions beyond the tip."""
    points = several(name, getattr(beam, name), wanted, f"{_MADE[wanted]} makes one")
    for k, point in enumerate(points):
        beyond, field = point.position > beam.length * (1 + _ROUNDING), f"{name}[{k}].position"
        bound = "it must be at most {limit}, the length"
        refuse(beyond, field, point.position, "m", bound, _BEYOND[wanted], limit=beam.length)
    set_fields(beam, **{name: points})


def alike(given: Profile | None, made: Profile | None) -> bool:
    """Return whether a given property equals the derived one; it may have further breakpoints."""
    return given == made or (
        given is not None and made is not None and given == made.split(given.breakpoints)
    )


def first_place(profile: Profile) -> float | None:
    """Find the first x/L, among segment ends and middles, at which a property is not 0; None if none."""
    ends = np.array(profile.breakpoints)
    left, right = profile.end_values()
    at = np.column_stack([ends[:-1], (ends[:-1] + ends[1:]) / 2, ends[1:]]).ravel()
    values = np.column_stack([left, profile((ends[:-1] + ends[1:]) / 2), right]).ravel()
    return float(at[np.flatnonzero(values)[0]]) if values.any() else None


# Probable mistakes of units --------------------------------------------------------------------------

SLOWEST, FASTEST = 100.0, 20e3  # speeds of sound in a bar [m/s]: hard rubber has 200, diamond 18e3
_THICKEST = 1 / math.sqrt(12)  # radius of gyration over length, of a rectangle as thick as the beam is long
_NEARLY_EQUAL = 1e-9  # tolerance of comparisons of angles [rad], and of radii of gyration (relative)


def warn_of_degrees(name: str, angle: float) -> None:
    """Warn of an angle [rad] beyond half a turn with at most two decimals, which suggests degrees."""
    if abs(angle) > math.pi and round(angle, 2) == angle:
        # With this stack level the warning shows the user's line that calls the class.
        warnings.warn(_say_degrees(f"{name} =", angle), stacklevel=4)


def warn_of_twist(twist: Profile | None) -> None:
    """Warn of a twist [rad] beyond one turn, or beyond half a turn with few decimals."""
    if twist is None:
        return
    values = np.concatenate([*twist.end_values(), twist(np.linspace(0, 1, 33))])
    largest = float(values[np.abs(values).argmax()])
    few_decimals = abs(round(largest, 2) - largest) <= _NEARLY_EQUAL
    if abs(largest) > 2 * math.pi or (abs(largest) > math.pi and few_decimals):
        warnings.warn(_say_degrees("twist reaches", largest), stacklevel=3)


def _say_degrees(said: str, angle: float) -> Words:
    """Return a warning, which begins as `said`, that an angle [rad] may be in degrees; files have units."""
    degrees = f"{math.degrees(angle):.4g}"
    in_python = (
        f"{said} {angle:g} rad: angles are in radians, and this is {degrees} degrees; "
        f"if {angle:g} degrees were meant, give math.radians({angle:g})"
    )
    return Named(in_python, f"{said} {degrees} deg, more than half a turn: is its unit right?")


def warn_of_material(youngs_modulus: float, density: float) -> None:
    """Warn of a Young's modulus [Pa] and density [kg/m3] that give an unusual speed of sound."""
    speed = math.sqrt(youngs_modulus) / math.sqrt(density)
    if not SLOWEST <= speed <= FASTEST:
        sentence = (
            f"youngs_modulus = {youngs_modulus:g} Pa with density = {density:g} kg/m3: waves along the beam "
            f"would run at {speed:.3g} m/s, in usual materials at {SLOWEST:g} to {FASTEST:g} m/s; "
            "give Pa and kg/m3, for steel 200e9 and 7850"
        )
        warnings.warn(sentence, stacklevel=3)


def warn_of_stiffness(
    length: float, mass: Profile, bending: Profile, axial: Profile | None, fibre: Profile | None
) -> None:
    """Warn of inconsistent stiffnesses [N m2, N], mass per length [kg/m], length and outer fibre [m].

    Small stiffnesses cause no warning: dimensionless beams have them.
    """
    xi = np.linspace(0, 1, 33)
    EI, m = bending(xi), mass(xi)
    # The speed of sound has a lower bound, because the section is at most as thick as the beam is long.
    if axial is None:
        speed = np.sqrt(EI) / np.sqrt(m) / (_THICKEST * length)
        words = f"bending_stiffness = {EI[0]:g} N m2 with length = {length:g} m"
    else:
        EA = axial(xi)
        speed, words = np.sqrt(EA) / np.sqrt(m), f"axial_stiffness = {EA[0]:g} N"
        thickest = np.full(33, _THICKEST * length) if fibre is None else fibre(xi)
        _warn_of_gyration(EI, EA, thickest, "length / sqrt(12)" if fibre is None else "outer_fibre")
    if speed.min() > FASTEST:
        sentence = (
            f"{words} and mass_per_length = {m[0]:g} kg/m: waves along the beam would run at "
            f"{speed.min():.3g} m/s, in usual materials at no more than {FASTEST:g} m/s; give SI units"
        )
        warnings.warn(sentence, stacklevel=3)


def _warn_of_gyration(EI: np.ndarray, EA: np.ndarray, most: np.ndarray, name: str) -> None:
    """Warn of a radius of gyration sqrt(EI / EA) above `most` [m], a bound that the warning calls `name`."""
    gyration = np.sqrt(EI) / np.sqrt(EA)
    k = int((gyration / most).argmax())
    if gyration[k] > most[k] * (1 + _NEARLY_EQUAL):
        sentence = (
            f"bending_stiffness = {EI[k]:g} N m2 with axial_stiffness = {EA[k]:g} N: the section's radius of "
            f"gyration, sqrt(E I / E A), would be {gyration[k]:.3g} m, more than {name} = {most[k]:.3g} m; "
            "give SI units"
        )
        warnings.warn(sentence, stacklevel=4)
