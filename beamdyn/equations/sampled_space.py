"""Trial functions that are sampled at the points of a quadrature rule, which integrates their products."""

from __future__ import annotations

from abc import ABC, abstractmethod
from functools import cached_property

import numpy as np

from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.arc_quadrature import Cells
from beamdyn.scene.profile import Profile


class Sampler:
    """Values of properties at the Gauss points of cells, each computed once.

    Parameters
    ----------
    cells : Cells
        The cells and the number of points on each; properties are smooth within them.
    """

    def __init__(self, cells: Cells) -> None:
        self._cells = cells
        self._known: dict[Profile, np.ndarray] = {}

    def __call__(self, profile: Profile) -> np.ndarray:
        """Values (k,) of a property."""
        if profile not in self._known:
            ends, points = self._cells.ends, self._cells.points
            self._known[profile] = profile.within(ends[:-1], ends[1:], points).ravel()
        return self._known[profile]


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
