"""A smooth function of two numbers on a grid of their values, from as few of its values as resolve it.

Along each number it is interpolated by a polynomial through the extremes of a Chebyshev polynomial, of twice
the degree until the last coefficients are small.  Where that takes as many as there are values, it is taken
at the values themselves.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
from numpy.polynomial.chebyshev import chebvander

_FIRST = 8  # degree with which the search begins
_LAST = 3  # coefficients that tell the size of those left out
_SAFETY = 4.0  # error over that size


@dataclass(frozen=True)
class ChartAxis:
    """A number, at values between whose smallest and largest a function is interpolated.

    Parameters
    ----------
    values : ndarray, shape (k,)
        The values.
    degree : int or None
        Degree of the polynomial; None where the function is taken at the values.
    """

    values: np.ndarray
    degree: int | None

    @classmethod
    def coarsest(cls, values: np.ndarray) -> ChartAxis:
        """An axis with the lowest degree that is tried."""
        return cls(values, _FIRST if len(values) > _FIRST + 1 else None)

    def finer(self) -> ChartAxis:
        """The axis with twice the degree, or with the values."""
        assert self.degree is not None
        return replace(self, degree=2 * self.degree if len(self.values) > 2 * self.degree + 1 else None)

    @property
    def nodes(self) -> np.ndarray:
        """Where the function is computed."""
        if self.degree is None:
            return self.values
        low, high = self.values.min(), self.values.max()
        return low + (high - low) * (0.5 - 0.5 * np.cos(np.pi * (np.arange(self.degree + 1) / self.degree)))

    def _vandermonde(self, at: np.ndarray) -> np.ndarray:
        low, high = self.values.min(), self.values.max()
        assert self.degree is not None
        return chebvander((2 * at - low - high) / (high - low), self.degree)

    def coefficients(self, samples: np.ndarray, axis: int) -> np.ndarray:
        """Chebyshev coefficients along an axis of samples at the nodes; themselves at the values."""
        if self.degree is None:
            return samples
        moved = np.moveaxis(samples, axis, 0)
        found = np.linalg.solve(self._vandermonde(self.nodes), moved.reshape(len(moved), -1))
        return np.moveaxis(found.reshape(moved.shape), 0, axis)

    def at_values(self, coefficients: np.ndarray, axis: int) -> np.ndarray:
        """The function at the values, along an axis of its coefficients."""
        if self.degree is None:
            return coefficients
        moved = np.moveaxis(coefficients, axis, 0)
        found = self._vandermonde(self.values) @ moved.reshape(len(moved), -1)
        return np.moveaxis(found.reshape(-1, *moved.shape[1:]), 0, axis)

    def tail(self, coefficients: np.ndarray, axis: int) -> float:
        """Largest size of the last coefficients along an axis: about what those left out are."""
        if self.degree is None:
            return 0.0
        return float(np.abs(np.take(coefficients, range(-_LAST, 0), axis=axis)).max())


@dataclass(frozen=True)
class OnGrid:
    """A function on a grid of values of two numbers.

    Parameters
    ----------
    value : ndarray, shape (A, B, ...)
        The function at each pair of values.
    error : float
        Estimated error by the interpolation, of the entries that the tolerance is for; 0 without one.
    samples : int
        Number of pairs at which the function was computed.
    """

    value: np.ndarray
    error: float
    samples: int


def interpolate_on_grid(
    function: Callable[[float, float], np.ndarray],
    values: tuple[np.ndarray, np.ndarray],
    tolerance: Callable[[], float],
    entries: slice,
) -> OnGrid:
    """Evaluate a smooth function at all pairs of values of two numbers.

    Parameters
    ----------
    function : callable
        The function of two numbers: an array (k,).  It is called at values between those given.
    values : tuple of ndarray, shapes (A,) and (B,)
        The values.
    tolerance : callable
        Largest size of coefficients left out, once the function has been called.
    entries : slice
        Entries of the array for which the tolerance is.
    """
    known: dict[tuple[float, float], np.ndarray] = {}

    def sample(x: float, y: float) -> np.ndarray:
        if (x, y) not in known:
            known[x, y] = function(x, y)
        return known[x, y]

    axes = [ChartAxis.coarsest(each) for each in values]
    while True:
        first, second = (axis.nodes.tolist() for axis in axes)
        found = np.array([[sample(x, y) for y in second] for x in first])
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
