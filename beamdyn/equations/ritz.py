"""Rayleigh-Ritz trial functions: integrated Legendre polynomials, or eigenfunctions of the beam at rest.

In shapes of arrays, n and m count functions, and k Gauss points or positions.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.inputs.checks import count, one_of, set_fields
from beamdyn.common.numerics import gauss_points_on, gauss_weights_on
from beamdyn.equations.discretization import Cells, RootConditions, SampledSpace, SampledSpaces
from beamdyn.equations.moment_functions import MomentSpaces
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile
from beamdyn.scene.sections import weight_degree

_MOST_ACROSS = 16  # largest number of functions across the width of a plate
MOST_FUNCTIONS = 200  # largest accepted number of functions on each segment
# Smallest number of additional Gauss points on each segment, for large deflections; where many functions are
# needed, the sections' rotation varies as fast as they do, and half their number is added.
_POINTS_OF_TURNS = 14
# Number of Gauss points on each cell of the basis "moments", whose cells are many and small.
_POINTS_OF_MOMENTS = 8

# Number of functions of the coarser basis, divided by that of the given basis.  The more slowly a basis
# converges, the smaller is this ratio, so that the difference of both results is not less than the error.
_COARSER = {"legendre": 0.88, "eigenfunctions": 0.5, "moments": 0.72}
_WORDS = {"legendre": "Legendre functions", "eigenfunctions": "eigenfunctions", "moments": "bending moments"}
# Number of functions of the next finer basis, divided by that of the given basis.
_FINER = {"legendre": 1.2, "eigenfunctions": 1.2, "moments": 1.35}


@dataclass(frozen=True)
class Ritz:
    """Rayleigh-Ritz basis of assumed modes.

    Parameters
    ----------
    functions : int
        Number of functions for the deflection, and for the stretch if it is modelled, from 1 to 200; for
        Legendre functions, the number on each segment between the beam's breakpoints; for moments in twisted
        sections, the number in each direction.
    basis : {"legendre", "eigenfunctions", "moments"}
        Integrated Legendre polynomials; or the modes of the uniform beam at rest, which the papers use
        and whose error falls slowly, as N^-5, under rotation; or deflections by bending moments that are
        polynomials over the whole beam, for beams of many segments.

    References
    ----------
    Integrated Legendre polynomials: Szabo and Babuska (1991), Finite Element Analysis; eigenfunctions: Lee
    and Yoo (2019).

    Examples
    --------
    >>> scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0))
    >>> modes = bd.natural_modes(scene, modes=1, discretization=bd.Ritz(functions=10))
    >>> round(2 * np.pi * float(modes.frequency[0]), 9)  # 1.8751...^2
    3.516015269
    """

    # The error of eigenvalues is not a power of the number of functions.
    order = None
    rounding = 0.0  # the functions are scaled so that their integrals keep all digits

    functions: int = 14
    basis: Literal["legendre", "eigenfunctions", "moments"] = "legendre"

    def __post_init__(self) -> None:
        most, remedy = MOST_FUNCTIONS, "use fewer, or discretization='fem'"
        set_fields(self, functions=count("functions", self.functions, most=most, remedy=remedy))
        one_of("basis", self.basis, (*_BASES, "moments"))

    def __str__(self) -> str:
        return f"Rayleigh-Ritz with {self.functions} {_WORDS[self.basis]}"

    @property
    def on_each_segment(self) -> bool:
        """Whether each segment between breakpoints has its own functions."""
        return self.basis == "legendre"

    @property
    def converges_regularly(self) -> bool:
        """Whether more functions change eigenvalues less and less; false for moments on many segments."""
        return self.basis != "moments"

    def spaces(self, beam: Beam) -> RitzSpaces | MomentSpaces:
        """Build the function spaces on a beam."""
        if self.basis == "moments":
            return MomentSpaces(beam, self.functions, self.fewer)
        # Degree for which Gauss points are chosen: integrals of Legendre functions are then exact, and
        # eigenfunctions have more than enough points.
        degree = self.functions if self.basis == "legendre" else 2 * self.functions + 10
        points, across = degree + 2 + weight_degree(beam) // 2, min(self.functions - 2, _MOST_ACROSS)
        return RitzSpaces(self, tuple(beam.breakpoints), points, max(2, across))

    def cells(self, beam: Beam) -> Cells:
        """Return the segments as cells, with enough Gauss points for cosines of angles of several turns."""
        spaces = self.spaces(beam)
        if isinstance(spaces, MomentSpaces):
            return Cells(spaces.cells, _POINTS_OF_MOMENTS)
        return Cells(np.array(beam.breakpoints), spaces.points + max(_POINTS_OF_TURNS, self.functions // 2))

    def coarser(self) -> Ritz:
        """Return a smaller basis, for the error estimate.

        Its results differ from those of this basis by more than the error of the latter.
        """
        return Ritz(self.fewer, self.basis)

    @property
    def fewer(self) -> int:
        """Number of functions of the coarser basis."""
        return max(1, min(int(_COARSER[self.basis] * self.functions), self.functions - 2))

    def finer(self) -> Ritz | None:
        """Return the next larger basis; None if this is the largest."""
        if self.functions == MOST_FUNCTIONS:
            return None
        return replace(self, functions=min(MOST_FUNCTIONS, int(_FINER[self.basis] * self.functions) + 1))

    def fits(self, modes: int) -> bool:
        """Return whether even the coarser basis has enough functions for a number of modes."""
        return self.fewer >= modes


@dataclass(frozen=True)
class RitzSpaces(SampledSpaces):
    """Function spaces of one Ritz basis with one quadrature rule; each space is built once and cached.

    Parameters
    ----------
    ritz : Ritz
        The basis.
    breakpoints : tuple of float
        Ends of the segments.
    points : int
        Number of Gauss points on each segment.
    across : int
        Number of functions across the width beyond the mean, if sections camber or twist.
    """

    ritz: Ritz
    breakpoints: tuple[float, ...]
    points: int
    across: int

    def functions(self, conditions: RootConditions) -> RitzSpace:
        """Build trial functions that satisfy conditions at the root."""
        return _build_space(self, RootConditions(conditions.held, conditions.derivatives))

    @property
    def fewer_across(self) -> int:
        """Number of functions across the width in the coarser basis: two fewer, but at least 2."""
        return max(2, self.across - 2)

    def shares_functions(self, other: RitzSpaces) -> bool:
        """Return whether other spaces have the same basis and segments."""
        return (self.ritz, self.breakpoints) == (other.ritz, other.breakpoints)


@dataclass(frozen=True)
class RitzSpace(SampledSpace):
    """Trial functions of a Ritz basis, sampled at the points of a Gauss rule.

    Parameters
    ----------
    spaces : RitzSpaces
        Basis, segments and Gauss rule.
    conditions : RootConditions
        Boundary conditions at the root.
    """

    spaces: RitzSpaces
    conditions: RootConditions

    @property
    def coarse(self) -> np.ndarray:
        """Indices of the coarser basis' functions: the first ones of each segment, and the root rotation."""
        return self._coarse

    @cached_property
    def _coarse(self) -> np.ndarray:
        functions, fewer = self.spaces.ritz.functions, self.spaces.ritz.fewer
        # If the root can rotate, the rigid rotation is an additional function.
        turns = self.conditions.derivatives - self.conditions.held
        on_segment = np.arange(self.size - turns) % functions < fewer
        return np.flatnonzero(np.concatenate([np.ones(turns, dtype=bool), on_segment]))

    @cached_property
    def points(self) -> np.ndarray:
        """Points x/L of the Gauss rule on [0, 1]."""
        return gauss_points_on(np.array(self.spaces.breakpoints), self.spaces.points).ravel()

    @cached_property
    def rule(self) -> np.ndarray:
        """Weights of the Gauss rule."""
        return gauss_weights_on(np.array(self.spaces.breakpoints), self.spaces.points)

    def weights(self, weight: Profile) -> np.ndarray:
        """Multiply the weights of the Gauss rule by a property of the beam."""
        if weight.breakpoints == self.spaces.breakpoints:
            return self.rule * weight.at_points(self.spaces.points).ravel()
        return super().weights(weight)

    @cached_property
    def samples(self) -> list[np.ndarray]:
        """Values of the functions and of each derivative at the Gauss points, (functions, points) each."""
        return [self.evaluate(self.points, order) for order in range(self.conditions.derivatives + 1)]

    @cached_property
    def _tip_values(self) -> list[np.ndarray]:
        orders = range(self.conditions.derivatives + 1)
        return [self.evaluate(np.ones(1), order)[:, 0] for order in orders]

    def end(self, order: int) -> np.ndarray:
        """Evaluate the `order`-th derivatives of the functions at the tip."""
        return self._tip_values[order]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Evaluate the `order`-th derivatives at xi; with a hinged root, the rotation x/L is first."""
        xi, (held, derivatives) = np.asarray(xi, dtype=float), self.conditions[:2]
        ritz, ends = self.spaces.ritz, self.spaces.breakpoints
        values = _BASES[ritz.basis](ritz.functions, ends, derivatives, xi, order)
        if held == derivatives:
            return values
        rotation = (xi, np.ones_like(xi), np.zeros_like(xi))[order]
        return np.concatenate([rotation[None, :], values])


# The functions do not depend on the beam's properties: caching them halves the time of a small model.
@lru_cache(maxsize=128)
def _build_space(spaces: RitzSpaces, conditions: RootConditions) -> RitzSpace:
    return RitzSpace(spaces, conditions)


# Integrated Legendre polynomials ------------------------------------------------------------------


def _integrated_legendre(
    functions: int, ends: tuple[float, ...], derivatives: int, xi: np.ndarray, order: int
) -> np.ndarray:
    """Evaluate derivatives at xi of functions whose highest derivative is a Legendre polynomial on a segment.

    As integrals from the root, the functions satisfy the root conditions and are smooth at breakpoints,
    except for the highest derivative, which may jump.  They are scaled so that these derivatives are
    orthonormal.
    """
    if order > derivatives:
        raise ValueError(f"order = {order}: the functions have derivatives up to order {derivatives}")
    times = derivatives - order  # number of integrations
    return np.concatenate([_integrate_on_segment(functions, a, b, xi, times) for a, b in pairwise(ends)])


def _integrate_on_segment(n: int, a: float, b: float, xi: np.ndarray, integrations: int) -> np.ndarray:
    """Integrate n Legendre polynomials on [a, b] repeatedly from the root; evaluate them at xi: (n, k)."""
    half = (b - a) / 2
    scale = np.sqrt((2 * np.arange(n) + 1) / (b - a))[:, None]
    inside, beyond = (xi >= a) & (xi <= b), xi > b
    t = ((xi[inside] - a) - (b - xi[inside])) / (b - a)
    values = np.zeros((n, len(xi)))
    series = _integrate_legendre(n, integrations)
    values[:, inside] = half**integrations * (series.T @ legendre.legvander(t, len(series) - 1).T)
    for k in range(integrations if beyond.any() else 0):  # beyond b: a Taylor polynomial about b
        derivative = half ** (integrations - k) * _integrate_legendre(n, integrations - k).sum(axis=0)
        values[:, beyond] += np.outer(derivative, (xi[beyond] - b) ** k)
    return scale * values


@cache
def _integrate_legendre(n: int, integrations: int) -> np.ndarray:
    """Compute Legendre coefficients, in columns, of P_0 ... P_(n-1) integrated repeatedly from -1."""
    if integrations == 0:
        return np.eye(n)
    return legendre.legint(_integrate_legendre(n, integrations - 1), lbnd=-1)


# Eigenfunctions of the uniform beam at rest -------------------------------------------------------


def clamped_free_roots(count: int) -> np.ndarray:
    """Compute roots b of cos b + 1/cosh b = 0: wave numbers of a uniform clamped-free beam of unit length."""
    b = np.pi * (np.arange(1, count + 1) - 0.5)
    b[0] = 1.8751040687119611664
    for _ in range(8):
        sech = 2 * np.exp(-b) / (1 + np.exp(-2 * b))
        b -= (np.cos(b) + sech) / (-np.sin(b) - sech * np.tanh(b))
    return b


def _eigenfunctions(
    functions: int, ends: tuple[float, ...], derivatives: int, xi: np.ndarray, order: int
) -> np.ndarray:
    """Evaluate derivatives of a uniform beam's mode shapes divided by b^2, or of a rod's divided by b.

    b is the wave number of each mode, and `derivatives` is 2 for the beam and 1 for the rod.
    The formula neither overflows nor loses digits by cancellation at high modes.
    """
    quarter = order * np.pi / 2  # the order-th derivative of cos and sin shifts their phase
    if derivatives == 1:
        b = np.pi * (np.arange(functions)[:, None] + 0.5)
        return b ** (order - 1.0) * np.sin(b * xi + quarter)
    b = clamped_free_roots(functions)[:, None]
    decay = np.exp(-b)
    c = (-decay + np.sin(b) - np.cos(b)) / (1 - decay**2 + 2 * decay * np.sin(b))
    root_layer = (-1) ** order * (np.exp(-b * xi) - c * np.exp(-b * (xi + 1)))
    tip_layer = c * np.exp(b * (xi - 1))
    wave = -np.cos(b * xi + quarter) + (1 - 2 * decay * c) * np.sin(b * xi + quarter)
    return b ** (order - 2.0) * (root_layer + tip_layer + wave)


_BASES = {"legendre": _integrated_legendre, "eigenfunctions": _eigenfunctions}
