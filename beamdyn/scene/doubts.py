"""Inputs that are allowed but look like a mistake of units: a warning, when they are given.

What makes an answer doubtful is in `beamdyn.scene.validity`, and stands in the results.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

from beamdyn.scene.profile import Profile

SLOWEST, FASTEST = 100.0, 20e3  # speeds of waves along a bar [m/s]: hard rubber has 200, diamond 18e3
_THICKEST = 1 / math.sqrt(12)  # radius of gyration over length, of a rectangle as thick as the beam is long
_ROUNDING = 1e-9  # relative


def warn_of_degrees(name: str, angle: float) -> None:
    """Warn of an angle [rad] beyond half a turn with few decimals: in radians it would be written by pi."""
    if abs(angle) > math.pi and round(angle, 2) == angle:
        warnings.warn(f"{name} = {_say_degrees(angle)}", stacklevel=4)  # at the user's call of the class


def warn_of_twist(twist: Profile | None) -> None:
    """Warn of a twist [rad] beyond one turn anywhere, or beyond half a turn with few decimals."""
    if twist is None:
        return
    values = np.concatenate([*twist.end_values(), twist(np.linspace(0, 1, 33))])
    largest = float(values[np.abs(values).argmax()])
    few_decimals = abs(round(largest, 2) - largest) <= _ROUNDING
    if abs(largest) > 2 * math.pi or (abs(largest) > math.pi and few_decimals):
        warnings.warn(f"twist reaches {_say_degrees(largest)}", stacklevel=3)


def _say_degrees(angle: float) -> str:
    """Say what an angle [rad] is in degrees, and how degrees are given."""
    return (
        f"{angle:g} rad: angles are in radians, and this is {math.degrees(angle):.4g} degrees; "
        f"if {angle:g} degrees were meant, give math.radians({angle:g})"
    )


def warn_of_material(youngs_modulus: float, density: float) -> None:
    """Warn of a modulus [Pa] and a density [kg/m3] of no usual material, by the speed of waves in it."""
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
    """Warn of stiffnesses [N m2, N], mass [kg/m], length [m] and outer fibre [m] that do not fit together.

    Small stiffnesses are not suspected: dimensionless beams have them.
    """
    xi = np.linspace(0, 1, 33)
    EI, m = bending(xi), mass(xi)
    if axial is None:  # the section is at most as thick as the beam is long: waves are at least so fast
        speed = np.sqrt(EI) / np.sqrt(m) / (_THICKEST * length)
        words = f"bending_stiffness = {EI[0]:g} N m2 with length = {length:g} m"
    else:
        EA = axial(xi)
        speed, words = np.sqrt(EA) / np.sqrt(m), f"axial_stiffness = {EA[0]:g} N"
        thickest = np.full(33, _THICKEST * length) if fibre is None else fibre(xi)
        name = "length / sqrt(12)" if fibre is None else "outer_fibre"
        _warn_of_gyration(EI, EA, thickest, name)
    if speed.min() > FASTEST:
        sentence = (
            f"{words} and mass_per_length = {m[0]:g} kg/m: waves along the beam would run at "
            f"{speed.min():.3g} m/s, in usual materials at no more than {FASTEST:g} m/s; give SI units"
        )
        warnings.warn(sentence, stacklevel=3)


def _warn_of_gyration(EI: np.ndarray, EA: np.ndarray, most: np.ndarray, name: str) -> None:
    """Warn of a radius of gyration of a section, sqrt(EI / EA), beyond the outer fibre or that of a cube."""
    gyration = np.sqrt(EI) / np.sqrt(EA)
    k = int((gyration / most).argmax())
    if gyration[k] > most[k] * (1 + _ROUNDING):
        sentence = (
            f"bending_stiffness = {EI[k]:g} N m2 with axial_stiffness = {EA[k]:g} N: the section's radius of "
            f"gyration, sqrt(E I / E A), would be {gyration[k]:.3g} m, more than {name} = {most[k]:.3g} m; "
            "give SI units"
        )
        warnings.warn(sentence, stacklevel=4)
