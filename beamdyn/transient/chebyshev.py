"""Sums of Chebyshev polynomials over [-1, 1] or a part of it, with as few terms as an accuracy needs."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache, lru_cache

import numpy as np

NEGLIGIBLE = 1e-3  # fraction of the required accuracy below which terms of a series are negligible


@dataclass(frozen=True)
class Polynomials:
    """Sum of Chebyshev polynomials over [-1, 1], from which small terms may be left out.

    Parameters
    ----------
    values : ndarray, shape (p, ...)
        Chebyshev coefficients.
    size : ndarray, shape (p,)
        Largest magnitudes of the coefficients, scaled as `allowed` is.
    allowed : float
        Largest total size of the terms that may be left out.
    """

    values: np.ndarray
    size: np.ndarray
    allowed: float

    def shortened(self, rough: bool) -> Polynomials:
        """Drop the last terms if they are far below `allowed`; convert to single precision if `rough`."""
        left_out = np.cumsum(self.size[::-1])[::-1]
        count = max(1, int((left_out > NEGLIGIBLE * self.allowed).sum()))
        values = self.values[:count]
        return replace(self, values=values.astype(np.float32) if rough else values, size=self.size[:count])

    def over(self, local: np.ndarray) -> np.ndarray:
        """Compute the coefficients over a part of [-1, 1], without small terms.

        `local` is the matrix that `to_part` builds for this part.
        """
        p = len(self.values)
        if p == 1:
            return self.values
        left_out = np.cumsum((np.abs(local[:p, :p]) @ self.size)[::-1])[::-1]
        count = int((left_out > self.allowed).sum())
        found = local[:count, :p].astype(self.values.dtype) @ self.values.reshape(p, -1)
        return found.reshape(count, *self.values.shape[1:])


@lru_cache(maxsize=64)
def to_part(count: int, start: float, end: float) -> np.ndarray:
    """Build the matrix from `count` Chebyshev coefficients over [-1, 1] to those over [start, end]."""
    T = polynomials(start + (end - start) * (1 + extrema(count)) / 2, count)
    return _to_coefficients(count) @ T


def expand(values: np.ndarray) -> np.ndarray:
    """Compute Chebyshev coefficients of functions from their values at P extrema, along the first axis."""
    P = len(values)
    return values if P == 1 else (_to_coefficients(P) @ values.reshape(P, -1)).reshape(values.shape)


@cache
def _to_coefficients(points: int) -> np.ndarray:
    """Build the matrix from values at P = `points` Chebyshev extrema to P Chebyshev coefficients."""
    return np.linalg.inv(polynomials(extrema(points), points))


def extrema(points: int) -> np.ndarray:
    """Compute the P = `points` extrema of a Chebyshev polynomial, from 1 to -1; the point 0 for P = 1."""
    return np.cos(np.pi * np.arange(points) / (points - 1)) if points > 1 else np.zeros(1)


def polynomials(x: np.ndarray, count: int) -> np.ndarray:
    """Evaluate the first `count` Chebyshev polynomials at N points x in [-1, 1]: shape (N, count)."""
    return np.cos(np.arccos(np.clip(x, -1, 1))[:, None] * np.arange(count))
