"""Trial functions that are sampled at the points of a quadrature rule, which integrates their products."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.legendre import gauss_rule
from beamdyn.common.results.pickling import FieldsOnly
from beamdyn.equations.arc_quadrature import Cells
from beamdyn.scene.profile import Profile

_OF_TENSION = 3  # degree of the moment of a linear mass


class Sampler:
    """Values of properties at the Gauss points of cells, each computed once.

    Parameters
    ----------
    left, right : ndarray, shape (c,)
        Ends of the cells, as x/L; properties are smooth within them.
    points : int
        Number of points on each.
    """

    def __init__(self, left: np.ndarray, right: np.ndarray, points: int) -> None:
        self._left, self._right, self._points = left, right, points
        self._known: dict[Profile, np.ndarray] = {}
        self._placed: dict[tuple[float, ...], tuple[np.ndarray, np.ndarray]] = {}

    @classmethod
    def on_cells(cls, cells: Cells) -> Sampler:
        """That of cells one after the other."""
        return cls(cells.ends[:-1], cells.ends[1:], cells.points)

    def __call__(self, profile: Profile) -> np.ndarray:
        """Values (c points,) of a property."""
        if profile not in self._known:
            segment, polynomials = self._place(profile.breakpoints, profile.degree)
            series = profile.series.T[segment]
            values = np.einsum("cpd,cd->cp", polynomials[..., : profile.degree + 1], series)
            self._known[profile] = values.ravel()
        return self._known[profile]

    def _place(self, breakpoints: tuple[float, ...], degree: int) -> tuple[np.ndarray, np.ndarray]:
        """Segment (c,) of each cell, and Legendre polynomials of the segment at its points (c, points, n).

        They are those up to the degree, or to a higher one; most properties have the same segments.
        """
        placed = self._placed.get(breakpoints)
        if placed is None or placed[1].shape[2] <= degree:
            placed = self._placed[breakpoints] = self._find(np.array(breakpoints), max(degree, _OF_TENSION))
        return placed

    def _find(self, ends: np.ndarray, degree: int) -> tuple[np.ndarray, np.ndarray]:
        segment = ends[1:-1].searchsorted((self._left + self._right) / 2, side="right")
        a, b = ends[segment, None], ends[segment + 1, None]
        lengths = (self._right - self._left)[:, None]
        xi = self._left[:, None] + lengths * (1 + gauss_rule(self._points)[0]) / 2
        return segment, legendre.legvander(((xi - a) - (b - xi)) / (b - a), degree)


class SampledSpace(FieldsOnly, ABC):
    """Base class of spaces of functions that are smooth between the points of a Gauss rule on cells."""

    @property
    @abstractmethod
    def points(self) -> np.ndarray:
        """Points of the rule on [0, 1], shape (k,)."""

    @property
    @abstractmethod
    def rule(self) -> np.ndarray:
        """Weights of the rule, shape (k,)."""

    @cached_property
    @abstractmethod
    def samples(self) -> list[np.ndarray]:
        """Values of the functions and of each derivative at the points, each of shape (n, k)."""

    @property
    def size(self) -> int:
        """Number n of functions."""
        return len(self.samples[0])

    @property
    @abstractmethod
    def coarse(self) -> np.ndarray | None:
        """Indices of functions that span those of the coarser discretization; None where none do."""

    def weights(self, weight: Profile) -> np.ndarray:
        """Multiply the weights of the rule by a property."""
        return self.rule * weight(self.points)

    def gram(self, weight: Profile, order: int) -> np.ndarray:
        """Integrate the weight times the `order`-th derivatives of functions i and j."""
        phi = self.samples[order]
        return (phi * self.weights(weight)) @ phi.T

    def load(self, weight: Profile, order: int = 0) -> np.ndarray:
        """Integrate the weight times the `order`-th derivative of function i."""
        return self.samples[order] @ self.weights(weight)


def product_of(
    rows: SampledSpace, columns: SampledSpace, weight: Profile, orders: tuple[int, int]
) -> np.ndarray:
    """Integrate the weight times derivatives of functions i of one space and j of another, on one rule."""
    return (rows.samples[orders[0]] * rows.weights(weight)) @ columns.samples[orders[1]].T
