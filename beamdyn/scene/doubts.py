"""Warnings of input that is allowed but looks like a mistake of units.

What makes an answer doubtful is checked in `beamdyn.scene.validity`, and reported in the results.
"""

from __future__ import annotations

import math
import warnings

import numpy as np

from beamdyn.scene.profile import Profile

SLOWEST, FASTEST = 100.0, 20e3  # speeds of waves along a bar [m/s]: hard rubber has 200, diamond 18e3
_THICKEST = 1 / math.sqrt(12)  # radius of gyration over length, of a rectangle as thick as the beam is long
_ROUNDING = 1e-9  # relative rounding error of lengths


def warn_of_degrees(name: str, angle: float) -> None:
    """Warn of an angle [rad] beyond half a turn with at most two decimals, which suggests degrees."""
    if abs(angle) > math.pi and round(angle, 2) == angle:
        # The warning points at the user's call of the class.
        warnings.warn(f"{name} = {_say_degrees(angle)}", stacklevel=4)


def warn_of_twist(twist: Profile | None) -> None:
    """Warn of a twist [rad] beyond one turn, or beyond half a turn with few decimals."""
    if twist is None:
        return
    values = np.concatenate([*twist.end_values(), twist(np.linspace(0, 1, 33))])
    largest = float(values[np.abs(values).argmax()])
    few_decimals = abs(round(largest, 2) - largest) <= _ROUNDING
    if abs(largest) > 2 * math.pi or (abs(largest) > math.pi and few_decimals):
        warnings.warn(f"twist reaches {_say_degrees(largest)}", stacklevel=3)


def _say_degrees(angle: float) -> str:
    """Write the warning that an angle [rad] may be in degrees, with how degrees are given."""
    return (
        f"{angle:g} rad: angles are in radians, and this is {math.degrees(angle):.4g} degrees; "
        f"if {angle:g} degrees were meant, give math.radians({angle:g})"
    )


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

    Small stiffnesses are not suspected: dimensionless beams have them.
    """
    xi = np.linspace(0, 1, 33)
    EI, m = bending(xi), mass(xi)
    # The section is at most as thick as the beam is long, which bounds the speed of waves from below.
    if axial is None:
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
    """Warn of a radius of gyration sqrt(EI / EA) beyond the outer fibre or the length of the beam."""
    gyration = np.sqrt(EI) / np.sqrt(EA)
    k = int((gyration / most).argmax())
    if gyration[k] > most[k] * (1 + _ROUNDING):
        sentence = (
            f"bending_stiffness = {EI[k]:g} N m2 with axial_stiffness = {EA[k]:g} N: the section's radius of "
            f"gyration, sqrt(E I / E A), would be {gyration[k]:.3g} m, more than {name} = {most[k]:.3g} m; "
            "give SI units"
        )
        warnings.warn(sentence, stacklevel=4)
