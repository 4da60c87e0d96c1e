"""Integrals over the mass along the beam, and the axial force due to accelerations, as piecewise polynomials.

A tip body is not included: it has an offset and moments of inertia, and the displacement fields add its
terms.

In shapes of arrays, n and m count functions, N positions, c cells, and p parts.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.polynomial import legendre

from beamdyn.equations.discretization import Functions, RootConditions, Space, Spaces
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import Mount, exact_cos_sin
from beamdyn.scene.profile import Profile, mean


@dataclass(frozen=True)
class PiecewisePolynomials:
    """Polynomials in x/L on each part of the beam (between point masses).

    Parameters
    ----------
    ends : tuple of float
        Ends of the p parts, from 0 to 1.
    """

    ends: tuple[float, ...]

    def counts(self, number: int) -> list[int]:
        """Return the number of functions on each part: `number` times the square root of its length x/L."""
        return [int(np.ceil(number * length**0.5)) for length in np.diff(self.ends)]

    def __call__(self, xi: np.ndarray, counts: Sequence[int], continuous: bool) -> np.ndarray:
        """Evaluate all polynomials at xi (N,): shape (functions, N).

        Parameters
        ----------
        xi : ndarray, shape (N,)
            Positions x/L.
        counts : sequence of int
            Number of polynomials on each part; continuous functions include the linear ones in any case.
        continuous : bool
            Whether the functions are continuous between parts, or may jump there.
        """
        on_parts = [self._on_part(xi, k, n) for k, n in enumerate(counts)]
        if len(on_parts) == 1:
            return on_parts[0]
        if not continuous:
            return np.concatenate(on_parts)
        bubbles = [P[2:] - P[:-2] for P in on_parts]  # bubble functions: 0 at both ends of their part
        hats = [np.interp(xi, self.ends, unit) for unit in np.eye(len(self.ends))]
        return np.concatenate([hats, *bubbles])

    def _on_part(self, xi: np.ndarray, k: int, number: int) -> np.ndarray:
        """Evaluate Legendre polynomials of part k, which are 0 elsewhere: shape (number, N)."""
        a, b = self.ends[k : k + 2]
        inside = self._part(xi) == k
        values = np.zeros((number, len(xi)))
        if number:
            values[:, inside] = legendre.legvander(2 * (xi[inside] - a) / (b - a) - 1, number - 1).T
        return values

    def _part(self, xi: np.ndarray) -> np.ndarray:
        """Find the index of the part that contains each xi."""
        return np.clip(np.searchsorted(self.ends, xi, side="right") - 1, 0, len(self.ends) - 2)

    def contained(self, counts: Sequence[int], fewer: Sequence[int], continuous: bool) -> np.ndarray:
        """Mark the polynomials of one set that a smaller set also contains.

        The sets have `counts` and `fewer` polynomials on each part.
        """
        bubbles = 2 if continuous and len(counts) > 1 else 0
        on_parts = [np.arange(max(n - bubbles, 0)) < m - bubbles for n, m in zip(counts, fewer, strict=True)]
        hats = np.ones(len(self.ends) if bubbles else 0, dtype=bool)
        return np.concatenate([hats, *on_parts])

    def phases(self, left: np.ndarray, right: np.ndarray, number: int) -> np.ndarray:
        """Compute the phase change [rad] of the polynomial of highest degree over each of given cells.

        The polynomial oscillates like the cosine of this phase.
        """
        part, ends = self._part((left + right) / 2), np.array(self.ends)
        start, length = ends[part], np.diff(ends)[part]
        first, last = (np.arccos(np.clip(1 - 2 * (x - start) / length, -1, 1)) for x in (left, right))
        return (last - first) * np.array(self.counts(number))[part]


def gram_by_mass(beam: Beam, space: Space) -> np.ndarray:
    """Integrate products of all pairs of functions, weighted by the mass [kg]."""
    return space.gram(beam.mass_per_length, 0) * beam.length + product_at_lumps(beam, space, space)


def product_by_mass(beam: Beam, spaces: Spaces, rows: RootConditions, columns: RootConditions) -> np.ndarray:
    """Integrate products of two functions, weighted by the mass [kg], for all pairs of functions.

    The rows of the result are functions with the root conditions `rows`, its columns are functions with the
    root conditions `columns`.
    """
    of_sections = spaces.product(beam.mass_per_length, rows, columns) * beam.length
    return of_sections + product_at_lumps(beam, spaces.functions(rows), spaces.functions(columns))


def loads_by_mass(beam: Beam, space: Space) -> tuple[np.ndarray, np.ndarray]:
    """Integrate functions [kg], and functions times distance from the root [kg m], weighted by the mass."""
    (xi, mass), length = beam.lumps, beam.length
    load = space.load(beam.mass_per_length) * length
    moment = space.load(_moment_per_length(beam)) * length**2
    if not mass.size:
        return load, moment
    at_lumps = space.evaluate(xi)
    return load + at_lumps @ mass, moment + at_lumps @ (mass * xi * length)


def product_at_lumps(beam: Beam, rows: Functions, columns: Functions) -> np.ndarray:
    """Sum products of functions of `rows` with functions of `columns` over the point masses [kg]."""
    xi, mass = beam.lumps
    if not mass.size:
        return np.zeros((rows.size, columns.size))
    return (rows.evaluate(xi) * mass) @ columns.evaluate(xi).T


def moments_about_root(beam: Beam) -> tuple[float, float, float]:
    """Compute mass [kg], first [kg m] and second moment [kg m2] about the root, without the tip body."""
    (xi, mass), weight, moments = beam.lumps, beam.mass_per_length, []
    for k in range(3):
        moments.append(beam.length ** (k + 1) * mean(weight) + float(mass @ (xi * beam.length) ** k))
        weight = weight.times_fraction()
    return moments[0], moments[1], moments[2]


@lru_cache(maxsize=64)
def _moment_per_length(beam: Beam) -> Profile:
    """Compute mass per length times x/L [kg/m]."""
    return beam.mass_per_length.times_fraction()


@lru_cache(maxsize=64)
def outboard_moments(beam: Beam) -> tuple[Profile, Profile]:
    """Compute the mass [kg] beyond each section and its first moment about the root [kg m], over x/L."""
    (xi, mass), length, of_sections = beam.lumps, beam.length, beam.mass_per_length
    outboard = of_sections.scaled(length).outboard_integral()
    moment = _moment_per_length(beam).scaled(length**2).outboard_integral()
    return outboard.stepped(xi, mass), moment.stepped(xi, mass * xi * length)


@lru_cache(maxsize=64)
def axial_tension(beam: Beam) -> tuple[Profile, Profile]:
    """Compute tension per root acceleration, N_A [kg], and per squared speed, N_B [kg m], over x/L.

    The axial force at steady speed is omega^2 N_B - a_O1 N_A: Lee and Yoo (2019), eqs. (18), (19).
    """
    n_a, n_b = outboard_moments(beam)
    if beam.tip is None:
        return n_a, n_b
    reach = beam.length + beam.tip.offset
    return _add_constant(n_a, beam.tip.mass), _add_constant(n_b, beam.tip.mass * reach)


PLACES = np.linspace(0.0, 1.0, 101)  # positions x/L from root to tip at which the axial force is evaluated


@lru_cache(maxsize=64)
def steady_tension(beam: Beam, mount: Mount) -> np.ndarray:
    """Compute the axial force in steady rotation, divided by squared speed [N s2], at `PLACES`: (101,)."""
    n_a, n_b = _sampled_tension(beam)
    cosine, _ = exact_cos_sin(mount.precone)
    inward = exact_cos_sin(mount.setting_angle)[0] * mount.radius
    return cosine * (cosine * n_b - inward * n_a)


@lru_cache(maxsize=64)
def _sampled_tension(beam: Beam) -> tuple[np.ndarray, np.ndarray]:
    n_a, n_b = axial_tension(beam)
    return n_a(PLACES), n_b(PLACES)


@lru_cache(maxsize=64)
def sampled_axial_stiffness(beam: Beam) -> np.ndarray:
    """Evaluate the axial stiffness [N] at `PLACES`, for a beam that has one: shape (101,)."""
    assert beam.axial_stiffness is not None
    return beam.axial_stiffness(PLACES)


def _add_constant(profile: Profile, constant: float) -> Profile:
    rows = tuple((row[0] + constant, *row[1:]) for row in profile.coefficients)
    return Profile(profile.breakpoints, rows)
