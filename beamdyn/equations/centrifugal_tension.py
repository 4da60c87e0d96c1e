"""Axial force in the beam due to rotation and to the acceleration of its root."""

from __future__ import annotations

from functools import lru_cache

from beamdyn.equations.mass import outboard_moments
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile


@lru_cache(maxsize=64)
def axial_tension(beam: Beam) -> tuple[Profile, Profile]:
    """Tension N_A [kg] per root acceleration and N_B [kg m] per squared speed, over x/L.

    The axial force at steady speed is omega^2 N_B - a_O1 N_A: Lee and Yoo (2019), eqs. (18), (19).
    """
    n_a, n_b = outboard_moments(beam)
    if beam.tip is None:
        return n_a, n_b
    reach = beam.length + beam.tip.offset
    return _add_constant(n_a, beam.tip.mass), _add_constant(n_b, beam.tip.mass * reach)


def _add_constant(profile: Profile, constant: float) -> Profile:
    rows = tuple((row[0] + constant, *row[1:]) for row in profile.coefficients)
    return Profile(profile.breakpoints, rows)
