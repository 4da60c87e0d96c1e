"""Interpolation of a smooth function of two numbers on a grid, with as few evaluations as possible.

Along each number the function is interpolated by a polynomial through the Chebyshev points (the extremes of a
Chebyshev polynomial).  Its degree is doubled until the last Chebyshev coefficients are small.  If a
polynomial needs as many evaluations as the grid has values along that number, the function is evaluated at
these values instead.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from itertools import product

import numpy as np
from numpy.polynomial.chebyshev import chebvander

_FIRST = 8  # degree of the polynomial at the first attempt
_LAST = 3  # number of last coefficients from which the neglected ones are estimated
_SAFETY = 4.0  # ratio of the stated error to the estimated one


@dataclass(frozen=True)
class ChebyshevAxis:
    """Axis of a grid: values of a number, and the interpolation of a function over their range.

    Parameters
    ----------
    values : ndarray, shape (k,)
        Values of the number on the grid.
    degree : int or None
        Degree of the interpolating polynomial; None if the function is evaluated at the values themselves.
    """

    values: np.ndarray
    degree: int | None

    @classmethod
    def coarsest(cls, values: np.ndarray) -> ChebyshevAxis:
        """Build an axis with the lowest degree."""
        return cls(values, _FIRST if len(values) > _FIRST + 1 else None)

    def finer(self) -> ChebyshevAxis:
        """Return the axis with twice the degree, or without a polynomial if that saves no evaluations."""
        assert self.degree is not None
        return replace(self, degree=2 * self.degree if len(self.values) > 2 * self.degree + 1 else None)

    @property
    def nodes(self) -> np.ndarray:
        """Values of the number at which the function is evaluated."""
        if self.degree is None:
            return self.values
        low, high = self.values.min(), self.values.max()
        return low + (high - low) * (0.5 - 0.5 * np.cos(np.pi * (np.arange(self.degree + 1) / self.degree)))

    def _vandermonde(self, at: np.ndarray) -> np.ndarray:
        low, high = self.values.min(), self.values.max()
        assert self.degree is not None
        return chebvander((2 * at - low - high) / (high - low), self.degree)

    def coefficients(self, samples: np.ndarray, axis: int) -> np.ndarray:
        """Compute Chebyshev coefficients along an axis from samples at the nodes.

        Without a polynomial (degree None) the result is the samples.
        """
        if self.degree is None:
            return samples
        moved = np.moveaxis(samples, axis, 0)
        found = np.linalg.solve(self._vandermonde(self.nodes), moved.reshape(len(moved), -1))
        return np.moveaxis(found.reshape(moved.shape), 0, axis)

    def at_values(self, coefficients: np.ndarray, axis: int) -> np.ndarray:
        """Evaluate the function at the values of the grid, from its coefficients along an axis."""
        if self.degree is None:
            return coefficients
        moved = np.moveaxis(coefficients, axis, 0)
        found = self._vandermonde(self.values) @ moved.reshape(len(moved), -1)
        return np.moveaxis(found.reshape(-1, *moved.shape[1:]), 0, axis)

    def tail(self, coefficients: np.ndarray, axis: int) -> float:
        """Return the largest of the last coefficients along an axis, as an estimate of the neglected ones."""
        if self.degree is None:
            return 0.0
        return float(np.abs(np.take(coefficients, range(-_LAST, 0), axis=axis)).max())


@dataclass(frozen=True)
class OnGrid:
    """Interpolated values of a function on a grid of two numbers.

    Parameters
    ----------
    value : ndarray, shape (A, B, k)
        The function, an array (k,), at each pair of A values of the first and B of the second number.
    error : float
        Estimated interpolation error of those of the k entries that were interpolated to a tolerance
        (argument `entries` of `interpolate_on_grid`); 0 without interpolation.
    samples : int
        Number of pairs at which the function was computed.
    """

    value: np.ndarray
    error: float
    samples: int


def interpolate_on_grid(
    function: Callable[[list[tuple[float, float]]], list[np.ndarray]],
    values: tuple[np.ndarray, np.ndarray],
    tolerance: Callable[[], float],
    entries: slice,
) -> OnGrid:
    """Evaluate a smooth function at all pairs of values of two numbers.

    Parameters
    ----------
    function : callable
        Function from pairs of numbers, which may be between the given values, to an array (k,) for each pair.
    values : tuple of ndarray, shapes (A,) and (B,)
        Values of the two numbers on the grid.
    tolerance : callable
        Function that returns the largest allowed size of the last coefficients.  It is called after the
        function has been evaluated, and may depend on the function's own error.
    entries : slice
        Entries of the array to which the tolerance applies.
    """
    known: dict[tuple[float, float], np.ndarray] = {}

    axes = [ChebyshevAxis.coarsest(each) for each in values]
    while True:
        first, second = (axis.nodes.tolist() for axis in axes)
        pairs = [*product(first, second)]
        new = [pair for pair in pairs if pair not in known]
        known.update(zip(new, function(new), strict=True))
        found = np.array([known[pair] for pair in pairs]).reshape(len(first), len(second), -1)
        for place, axis in enumerate(axes):
            found = axis.coefficients(found, place)
        tails = [axis.tail(found[..., entries], place) for place, axis in enumerate(axes)]
        rough = [tail > tolerance() for tail in tails]
        if not any(rough):
            break
        axes = [axis.finer() if is_rough else axis for axis, is_rough in zip(axes, rough, strict=True)]
    for place, axis in enumerate(axes):
        found = axis.at_values(found, place)
    return OnGrid(found, _SAFETY * sum(tails), len(known))
