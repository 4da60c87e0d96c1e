"""Assumed modes: Rayleigh-Ritz spaces of integrated Legendre polynomials or of eigenfunctions at rest."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache, cached_property, lru_cache, partial
from itertools import pairwise
from typing import Literal

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.checks import count
from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile

MOST_FUNCTIONS = 200

Evaluation = Callable[[np.ndarray, int], np.ndarray]  # (xi of shape (k,), order) -> shape (n, k)


@dataclass(frozen=True)
class Ritz:
    """Assumed modes.

    Parameters
    ----------
    functions : int
        Number of functions for the deflection, and as many for the stretch where it is modelled,
        from 1 to 200; of Legendre functions, on each segment between the beam's breakpoints.
    basis : {"legendre", "eigenfunctions"}
        Integrated Legendre polynomials, or the modes of the uniform beam at rest, which the papers
        use and which converge slowly under rotation (like N^-5).
    """

    functions: int = 14
    basis: Literal["legendre", "eigenfunctions"] = "legendre"

    def __post_init__(self) -> None:
        if count("functions", self.functions, least=1) > MOST_FUNCTIONS:
            raise ValueError(
                f"functions = {self.functions}: at most {MOST_FUNCTIONS}; use fewer, or discretization='fem'"
            )
        if self.basis not in _BASES:
            raise ValueError(f"basis = {self.basis!r}: give one of {', '.join(map(repr, _BASES))}")

    @property
    def order(self) -> None:
        """None: convergence is not by a power of the size."""
        return None

    @property
    def rounding(self) -> float:
        """0: the functions are scaled so that their integrals keep all digits."""
        return 0.0

    def spaces(self, beam: Beam) -> RitzSpaces:
        """The function spaces on a beam."""
        return RitzSpaces(self, tuple(beam.breakpoints), self._points(beam))

    def _points(self, beam: Beam) -> int:
        """Gauss points a segment: exact for Legendre bases, past resolution for eigenfunctions."""
        weight = max(beam.mass_per_length.degree + 2, beam.bending_stiffness.degree)
        own = self.functions if self.basis == "legendre" else 2 * self.functions + 10
        return own + 2 + weight // 2 + 1

    def coarser(self) -> Ritz:
        """A basis whose distance from this one bounds this one's error by its rate of convergence."""
        keep = 0.88 if self.basis == "legendre" else 0.5
        return replace(self, functions=max(1, min(int(keep * self.functions), self.functions - 2)))

    def finer(self) -> Ritz | None:
        """The next larger basis."""
        if self.functions == MOST_FUNCTIONS:
            return None
        return replace(self, functions=min(MOST_FUNCTIONS, int(1.2 * self.functions) + 1))

    def fits(self, modes: int) -> bool:
        """Whether the coarser basis has functions enough for so many modes."""
        return self.coarser().functions >= modes


@dataclass(frozen=True)
class RitzSpaces:
    """The spaces of one basis over one quadrature rule; made once each.

    Parameters
    ----------
    ritz : Ritz
        The basis.
    breakpoints : tuple of float
        Ends of the segments.
    count : int
        Gauss points on each segment.
    """

    ritz: Ritz
    breakpoints: tuple[float, ...]
    count: int

    def functions(self, held: int) -> RitzSpace:
        """Functions whose derivatives 0 ... held - 1 vanish at the root: 2 clamped, 1 fixed."""
        return _make_space(self, held)

    def product(self, weight: Profile, rows: int, columns: int) -> np.ndarray:
        """Integrals of weight times function i of ``functions(rows)`` and j of ``functions(columns)``."""
        first, second = self.functions(rows), self.functions(columns)
        return (first.samples[0] * first.weights(weight)) @ second.samples[0].T


@dataclass(frozen=True)
class RitzSpace:
    """Functions sampled on a Gauss rule.

    Parameters
    ----------
    evaluation : callable
        Derivatives of the functions.
    points, rule : ndarray, shape (k,)
        Points and weights of the rule on [0, 1].
    orders : int
        Derivatives that the functions have.
    """

    evaluation: Evaluation
    points: np.ndarray
    rule: np.ndarray
    orders: int

    @cached_property
    def samples(self) -> list[np.ndarray]:
        """Functions and their derivatives at the points."""
        return [self.evaluation(self.points, order) for order in range(self.orders + 1)]

    @property
    def size(self) -> int:
        """Number of functions."""
        return len(self.samples[0])

    def weights(self, weight: Profile) -> np.ndarray:
        """Weights of the rule times a property."""
        return self.rule * weight(self.points)

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrals of weight times derivatives of functions i and j."""
        phi = self.samples[order]
        return (phi * self.weights(weight)) @ phi.T

    def load(self, weight: Profile) -> np.ndarray:
        """Integrals of weight times function i."""
        return self.samples[0] @ self.weights(weight)

    @cached_property
    def _ends(self) -> list[np.ndarray]:
        return [self.evaluation(np.ones(1), order)[:, 0] for order in range(self.orders + 1)]

    def end(self, order: int) -> np.ndarray:
        """Derivatives at the tip."""
        return self._ends[order]

    def evaluate(self, xi: np.ndarray, order: int = 0) -> np.ndarray:
        """Derivatives at xi."""
        return self.evaluation(np.asarray(xi, dtype=float), order)


@lru_cache(maxsize=128)  # beams differ in their properties, seldom in these: half the time of a small model
def _make_space(spaces: RitzSpaces, held: int) -> RitzSpace:
    evaluation, edges = _BASES[spaces.ritz.basis][held], np.array(spaces.breakpoints)
    return RitzSpace(evaluation(spaces.ritz.functions, edges), *_rule(edges, spaces.count), orders=held)


def _rule(edges: np.ndarray, points: int) -> tuple[np.ndarray, np.ndarray]:
    t, w = legendre.leggauss(points)
    half = np.diff(edges)[:, None] / 2
    return (edges[:-1, None] + half * (1 + t)).ravel(), (half * w).ravel()


# Integrated Legendre polynomials ------------------------------------------------------------------


def _integrated_legendre(functions: int, edges: np.ndarray, integrations: int) -> Evaluation:
    """Functions whose `integrations`-th derivative is a Legendre polynomial on one segment, 0 elsewhere.

    Integrated from the root they satisfy its conditions, join smoothly at breakpoints and leave the
    higher derivatives free to jump there; scaled so that the highest derivatives are orthonormal.
    """

    def evaluation(xi: np.ndarray, order: int) -> np.ndarray:
        parts = pairwise(edges)
        return np.concatenate([_on_segment(functions, a, b, xi, integrations - order) for a, b in parts])

    return evaluation


def _on_segment(n: int, a: float, b: float, xi: np.ndarray, integrations: int) -> np.ndarray:
    """The n functions of segment [a, b], integrated so many times, at xi: shape (n, k)."""
    if integrations < 0:
        raise ValueError("only as many derivatives as the basis was integrated")
    half = (b - a) / 2
    scale = np.sqrt((2 * np.arange(n) + 1) / (b - a))[:, None]
    inside, beyond = (xi >= a) & (xi <= b), xi > b
    t = ((xi[inside] - a) - (b - xi[inside])) / (b - a)
    values = np.zeros((n, len(xi)))
    series = _integrals(n, integrations)
    values[:, inside] = half**integrations * (series.T @ legendre.legvander(t, len(series) - 1).T)
    for k in range(integrations if beyond.any() else 0):  # Taylor's polynomial from the end; k! = 1
        derivative = half ** (integrations - k) * _integrals(n, integrations - k).sum(axis=0)
        values[:, beyond] += np.outer(derivative, (xi[beyond] - b) ** k)
    return scale * values


@cache
def _integrals(n: int, integrations: int) -> np.ndarray:
    """Legendre coefficients, in columns, of P_0 ... P_(n-1) integrated so many times from -1."""
    if integrations == 0:
        return np.eye(n)
    return legendre.legint(_integrals(n, integrations - 1), lbnd=-1)


# Eigenfunctions of the uniform beam at rest -------------------------------------------------------


def clamped_free_roots(count: int) -> np.ndarray:
    """Roots b of cos b + 1/cosh b = 0: the wave numbers of a clamped-free beam."""
    b = np.pi * (np.arange(1, count + 1) - 0.5)
    b[0] = 1.8751040687119611664
    for _ in range(8):
        sech = 2 * np.exp(-b) / (1 + np.exp(-2 * b))
        b -= (np.cos(b) + sech) / (-np.sin(b) - sech * np.tanh(b))
    return b


def _clamped_free(functions: int, edges: np.ndarray) -> Evaluation:
    """Clamped-free shapes over b^2, in a form that neither overflows nor cancels at high modes."""
    b = clamped_free_roots(functions)[:, None]
    decay = np.exp(-b)
    c = (-decay + np.sin(b) - np.cos(b)) / (1 - decay**2 + 2 * decay * np.sin(b))
    s = 1 - 2 * decay * c

    def evaluation(xi: np.ndarray, order: int) -> np.ndarray:
        quarter = order * np.pi / 2  # the order-th derivative of cos and sin shifts their phase
        root_layer = (-1) ** order * (np.exp(-b * xi) - c * np.exp(-b * (xi + 1)))
        tip_layer = c * np.exp(b * (xi - 1))
        wave = -np.cos(b * xi + quarter) + s * np.sin(b * xi + quarter)
        return b ** (order - 2.0) * (root_layer + tip_layer + wave)

    return evaluation


def _clamped_free_rod(functions: int, edges: np.ndarray) -> Evaluation:
    """Shapes of a rod fixed at the root and free at the tip, over their wave number."""
    b = np.pi * (np.arange(functions)[:, None] + 0.5)

    def evaluation(xi: np.ndarray, order: int) -> np.ndarray:
        return b ** (order - 1.0) * np.sin(b * xi + order * np.pi / 2)

    return evaluation


# For each basis, by the number of derivatives that vanish at the root.
_BASES = {
    "legendre": {
        2: partial(_integrated_legendre, integrations=2),
        1: partial(_integrated_legendre, integrations=1),
    },
    "eigenfunctions": {2: _clamped_free, 1: _clamped_free_rod},
}
