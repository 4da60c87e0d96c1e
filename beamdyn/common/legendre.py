"""Gauss-Legendre points on the parts of an interval, and Legendre series of interpolants through them."""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import legendre


@cache
def gauss_rule(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Points and weights of the Gauss rule on [-1, 1]."""
    return legendre.leggauss(points)


def gauss_points_on(ends: np.ndarray, points: int) -> np.ndarray:
    """Gauss points on each of c cells between ascending ends (c + 1,): shape (c, points)."""
    return ends[:-1, None] + np.diff(ends)[:, None] * (1 + gauss_rule(points)[0]) / 2


@cache
def legendre_series(points: int) -> np.ndarray:
    """Legendre coefficients, in rows, of the interpolant through Gauss points by its values there."""
    t, w = gauss_rule(points)
    return (np.arange(points)[:, None] + 0.5) * legendre.legvander(t, points - 1).T * w
