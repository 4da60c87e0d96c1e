"""Tensors of section stiffness and inertia in directions that do not turn with the twist.

A section with the values f (bending in the direction of the bending angle) and g (in the direction across)
that is turned by beta has, along the directions e1, e2 at the root,

    Y11 = f cos^2 beta + g sin^2 beta,  Y22 = f sin^2 beta + g cos^2 beta,  Y12 = (f - g) cos beta sin beta.
"""

from __future__ import annotations

from functools import lru_cache
from typing import NamedTuple, TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.scene.beam import OFFSETS, Beam, TipMass
from beamdyn.scene.names_elsewhere import IN_RADIANS
from beamdyn.scene.profile import Profile, combine

# For each section property, the order of the derivatives of deflections that it multiplies in energies.
_ORDERS = {"bending_stiffness": 2, "shear_stiffness": 1, "rotary_inertia": 1}

# Entries of a tensor by pair of directions; entries that are 0 are missing.
Tensor: TypeAlias = "dict[tuple[int, int], Profile]"


@lru_cache(maxsize=256)
def section_tensor(beam: Beam, name: str) -> Tensor:
    """Compute the tensor of a section property, such as "bending_stiffness", in the directions e1, e2.

    Rotary inertia is about the centre of tension where that differs from the centre of mass, because a
    section tilts about the line that keeps its length.

    Parameters
    ----------
    beam : Beam
        The beam.
    name : str
        The property for bending in the first direction; the name of that in the second begins with "second_".

    Returns
    -------
    dict
        Profiles by pair of directions 0 and 1; only (0, 0) of a beam in one plane, none of a property that
        the beam lacks.
    """
    return _turn(beam, name, _from_tension_to_mass(beam) if name == "rotary_inertia" else None)


@lru_cache(maxsize=64)
def inertia_about_shear_centre(beam: Beam) -> Tensor:
    """Compute the tensor of rotary inertia about the shear centre, as `section_tensor` returns it."""
    return _turn(beam, "rotary_inertia", beam.mass_offset)


def _turn(beam: Beam, name: str, lever: Profile | None) -> Tensor:
    """Compute the tensor of a section property, plus the inertia of the mass at a distance `lever` [m]."""
    first, second = getattr(beam, name), getattr(beam, f"second_{name}")
    if first is None:
        return {}
    if second is not None and lever is not None:
        second = second + beam.mass_per_length * lever * lever
    if second is None:
        return {(0, 0): first}
    if beam.twist is None or not any(any(row) for row in beam.twist.coefficients):
        return {(0, 0): first, (1, 1): second}
    # Turn the values in the axes of the sections by the twist; refuse a twist that is not resolved.
    excess = first + second.scaled(-1.0)  # difference as a series: differences of values lose digits
    try:
        along, oblique, across = combine(_turned_values, first, second, excess, beam.twist)
    except ValueError as error:
        at_tip = float(beam.twist(np.array(1.0)))
        raise InvalidValue("twist", at_tip, str(error), IN_RADIANS, "rad", where=" at the tip") from None
    return {(0, 0): along, (0, 1): oblique, (1, 0): oblique, (1, 1): across}


def _from_tension_to_mass(beam: Beam) -> Profile | None:
    """Compute the mass centre's distance from the centre of tension, across [m]; None without offsets."""
    if beam.tension_offset is None:
        return beam.mass_offset
    back = beam.tension_offset.scaled(-1.0)
    return back if beam.mass_offset is None else beam.mass_offset + back


def _turned_values(
    first: np.ndarray, second: np.ndarray, excess: np.ndarray, twist: np.ndarray
) -> np.ndarray:
    """Compute entries 11, 12 and 22 of a tensor turned by the twist."""
    c, s = np.cos(twist), np.sin(twist)
    return np.stack([first * c**2 + second * s**2, excess * (c * s), first * s**2 + second * c**2])


@lru_cache(maxsize=64)
def offset_components(beam: Beam) -> tuple[Profile | None, ...]:
    """Compute components along e1, e2 of the offsets of mass centre, then tension centre [m]; None for 0."""
    offsets = (getattr(beam, name) for name in OFFSETS)
    given = [offset if offset is not None and offset.series.any() else None for offset in offsets]
    if beam.twist is None:
        return tuple(component for offset in given for component in (None, offset))
    there = [offset for offset in given if offset is not None]

    def turned(twist: np.ndarray, *offsets: np.ndarray) -> np.ndarray:
        c, s = np.cos(twist), np.sin(twist)
        return np.stack([part for offset in offsets for part in (-s * offset, c * offset)])

    found = iter(combine(turned, beam.twist, *there) if there else ())
    return tuple(next(found) if offset is not None else None for offset in given for _ in range(2))


class TipInertia(NamedTuple):
    """Moments of inertia of a tip body [kg m2] against rotations towards the directions e1 and e2.

    Parameters
    ----------
    tilting : ndarray, shape (2, 2)
        Moment of inertia against rotation.
    centrifugal : ndarray, shape (2, 2)
        Centrifugal stiffness against rotation out of the plane of rotation, divided by the squared speed;
        in the axes of the section diag(J_e - J_1, J_n - J_1), with the moments of inertia J_1 about the beam,
        J_n about the axis of bending, and J_e about the direction of bending.
    """

    tilting: np.ndarray
    centrifugal: np.ndarray


def tip_inertia(tip: TipMass, twist: float) -> TipInertia:
    """Compute the inertia of a tip body on a section that is turned by an angle [rad]."""
    across, bending = tip.inertia, tip.inertia_about_bending_direction
    tilting = np.diag([across, bending])
    centrifugal = np.diag([bending - tip.axial_inertia, across - tip.axial_inertia])
    if not twist:
        return TipInertia(tilting, centrifugal)
    R = np.array([[np.cos(twist), -np.sin(twist)], [np.sin(twist), np.cos(twist)]])
    return TipInertia(R @ tilting @ R.T, R @ centrifugal @ R.T)


@lru_cache(maxsize=256)
def weight_degree(beam: Beam) -> int:
    """Find the degree that section properties add, at most, to integrands with products of deflections.

    Each property adds its degree minus the order of the derivatives that it multiplies; the degree of
    tension is that of the mass plus two.
    """
    degrees = [beam.mass_per_length.degree + 1]
    for name, order in _ORDERS.items():
        degrees += [p.degree - 2 * order for p in section_tensor(beam, name).values()]
    return max(degrees)
