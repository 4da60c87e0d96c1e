"""Integrals over the mass of the beam's sections and the point masses along it, and the axial force by it.

A body at the tip is not among the integrals: it has an offset and moments of inertia, and enters with the
fields.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np

from beamdyn.equations.discretization import Functions, RootConditions, Space, Spaces
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import FRACTION, Profile, mean


def gram_by_mass(beam: Beam, space: Space) -> np.ndarray:
    """Integrate products of functions i and j over the mass [kg], shape (n, n)."""
    return space.gram(beam.mass_per_length, 0) * beam.length + product_at_lumps(beam, space, space)


def product_by_mass(beam: Beam, spaces: Spaces, rows: RootConditions, columns: RootConditions) -> np.ndarray:
    """Integrate products of function i of `rows` and j of `columns` over the mass [kg], shape (n, m)."""
    of_sections = spaces.product(beam.mass_per_length, rows, columns) * beam.length
    return of_sections + product_at_lumps(beam, spaces.functions(rows), spaces.functions(columns))


def load_by_mass(beam: Beam, space: Space) -> np.ndarray:
    """Integrate functions over the mass [kg], shape (n,)."""
    xi, mass = beam.lumps
    of_sections = space.load(beam.mass_per_length) * beam.length
    return of_sections + space.evaluate(xi) @ mass if mass.size else of_sections


def first_moment_by_mass(beam: Beam, space: Space) -> np.ndarray:
    """Integrate functions times the distance from the root over the mass [kg m], shape (n,)."""
    (xi, mass), length = beam.lumps, beam.length
    of_sections = space.load(_moment_per_length(beam)) * length**2
    return of_sections + space.evaluate(xi) @ (mass * xi * length) if mass.size else of_sections


def product_at_lumps(beam: Beam, rows: Functions, columns: Functions) -> np.ndarray:
    """Sum products of function i of `rows` and j of `columns` over the point masses [kg], shape (n, m)."""
    xi, mass = beam.lumps
    if not mass.size:
        return np.zeros((rows.size, columns.size))
    return (rows.evaluate(xi) * mass) @ columns.evaluate(xi).T


def moments_about_root(beam: Beam) -> tuple[float, float, float]:
    """Mass [kg], and its first and second moments about the root [kg m, kg m2], without the tip body."""
    (xi, mass), weight, moments = beam.lumps, beam.mass_per_length, []
    for k in range(3):
        moments.append(beam.length ** (k + 1) * mean(weight) + float(mass @ (xi * beam.length) ** k))
        weight = weight * FRACTION
    return moments[0], moments[1], moments[2]


@lru_cache(maxsize=64)
def _moment_per_length(beam: Beam) -> Profile:
    """Mass per length times x/L [kg/m]."""
    return beam.mass_per_length * FRACTION


@lru_cache(maxsize=64)
def outboard_moments(beam: Beam) -> tuple[Profile, Profile]:
    """Mass [kg] outboard of each section, and its first moment about the root [kg m], over x/L."""
    (xi, mass), length, of_sections = beam.lumps, beam.length, beam.mass_per_length
    outboard = of_sections.scaled(length).outboard_integral()
    moment = _moment_per_length(beam).scaled(length**2).outboard_integral()
    return outboard.stepped(xi, mass), moment.stepped(xi, mass * xi * length)


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
