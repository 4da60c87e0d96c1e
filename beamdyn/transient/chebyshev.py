"""Sums of Chebyshev polynomials over [-1, 1], as few terms as an accuracy needs, also over parts of it."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np

NEGLIGIBLE = 1e-3  # share of an accuracy


@dataclass(frozen=True)
class Polynomials:
    """A sum of Chebyshev polynomials over [-1, 1] whose terms may be left out while they are small.

    Parameters
    ----------
    values : ndarray, shape (p, ...)
        Coefficients.
    size : ndarray, shape (p,)
        Their sizes.
    allowed : float
        Size of all that may be left out.
    """

    values: np.ndarray
    size: np.ndarray
    allowed: float

    def shortened(self, rough: bool) -> Polynomials:
        """The sum without last terms far below what is allowed; in single precision if `rough`."""
        left_out = np.cumsum(self.size[::-1])[::-1]
        count = max(1, int((left_out > NEGLIGIBLE * self.allowed).sum()))
        values = self.values[:count]
        return replace(self, values=values.astype(np.float32) if rough else values, size=self.size[:count])

    def over(self, local: np.ndarray) -> np.ndarray:
        """Coefficients over a part of [-1, 1], (q, ...) with q <= p, by the matrix of `to_part`."""
        p = len(self.values)
        if p == 1:
            return self.values
        left_out = np.cumsum((np.abs(local[:p, :p]) @ self.size)[::-1])[::-1]
        count = int((left_out > self.allowed).sum())
        found = local[:count, :p].astype(self.values.dtype) @ self.values.reshape(p, -1)
        return found.reshape(count, *self.values.shape[1:])


@lru_cache(maxsize=64)
def to_part(count: int, start: float, end: float) -> np.ndarray:
    """Matrix from `count` Chebyshev coefficients over [-1, 1] to those over a part of it."""
    T = polynomials(start + (end - start) * (1 + extrema(count)) / 2, count)
    return _to_coefficients(count) @ T


def chebyshev_coefficients(values: np.ndarray) -> np.ndarray:
    """Chebyshev coefficients of functions given at the P extrema of a polynomial, along the first axis."""
    P = len(values)
    return values if P == 1 else (_to_coefficients(P) @ values.reshape(P, -1)).reshape(values.shape)


@cache
def _to_coefficients(points: int) -> np.ndarray:
    """Matrix from values at the extrema of a Chebyshev polynomial to coefficients, shape (P, P)."""
    return np.linalg.inv(polynomials(extrema(points), points))


def extrema(points: int) -> np.ndarray:
    """Extrema of a Chebyshev polynomial, P of them, from 1 to -1; of one point, 0."""
    return np.cos(np.pi * np.arange(points) / (points - 1)) if points > 1 else np.zeros(1)


def polynomials(x: np.ndarray, count: int) -> np.ndarray:
    """The first `count` Chebyshev polynomials at x (N,) in [-1, 1]: shape (N, count)."""
    return np.cos(np.arccos(np.clip(x, -1, 1))[:, None] * np.arange(count))
