"""Numerical tools: assignment problem, Gauss quadrature, Legendre series, ellipses, triangular systems.

Triangular systems are not solved by `scipy.linalg.solve_triangular`: its LAPACK routine starts threads even
for small matrices, and on a busy machine the threads wait for milliseconds although the arithmetic takes
microseconds.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg.blas import dtrsm


def solve_lower(L: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Solve L X = B for lower triangular L, shape (n, n), and right-hand sides B, shape (n, m)."""
    # The transpose is stored by columns, as LAPACK needs it, so that no copy is made.
    return dtrsm(1.0, L.T, B, lower=0, trans_a=1)


def solve_lower_transposed(L: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Solve L^T X = B for lower triangular L, shape (n, n), and right-hand sides B, shape (n, m)."""
    return dtrsm(1.0, L.T, B, lower=0)


def assign(cost: np.ndarray) -> np.ndarray:
    """Choose a different column for each row of a cost matrix (n, m), n <= m, for the least total cost.

    Return the indices of the columns, shape (n,).
    """
    least = cost.argmin(axis=1)
    if np.isfinite(cost).all() and len(np.unique(least)) == len(least):
        return least  # each row's cheapest column is the cheapest of no other row
    # Imported here, because this import takes as long as all others together.
    from scipy.optimize import linear_sum_assignment

    return linear_sum_assignment(cost)[1]


@cache
def gauss_rule(points: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points and weights of the Gauss-Legendre quadrature on [-1, 1]."""
    return legendre.leggauss(points)


def gauss_points_on(ends: np.ndarray, points: int) -> np.ndarray:
    """Return the Gauss points on each of c intervals between ascending ends (c + 1,); shape (c, points)."""
    return ends[:-1, None] + np.diff(ends)[:, None] * (1 + gauss_rule(points)[0]) / 2


def gauss_weights_on(ends: np.ndarray, points: int) -> np.ndarray:
    """Return the weights of the Gauss points on c intervals between ascending ends (c + 1,).

    Shape (c * points,): the weights of the first interval, then those of the second, and so on.
    """
    return (np.diff(ends)[:, None] / 2 * gauss_rule(points)[1]).ravel()


@cache
def legendre_values(points: int, degree: int) -> np.ndarray:
    """Evaluate Legendre polynomials up to a degree at the Gauss points on [-1, 1]: (points, degree + 1)."""
    return legendre.legvander(gauss_rule(points)[0], degree)


@cache
def legendre_series(points: int) -> np.ndarray:
    """Return the matrix that converts values at Gauss points to Legendre coefficients of the interpolant.

    Shape (points, points), for Gauss points on [-1, 1].
    """
    values, scale = legendre_values(points, points - 1), np.arange(points) + 0.5
    # Gauss weights by Christoffel's formula (reciprocal sums of squares): numpy's have errors up to 1e-12.
    return scale[:, None] * values.T / (values**2 @ scale)


def longer_semi_axis(c: np.ndarray) -> np.ndarray:
    """Compute the longer semi-axes of ellipses Re(c exp(i phi)), 0 <= phi < 2 pi, in d dimensions.

    `c` has the shape (d, ...), the result the shape (...).
    """
    return np.sqrt(((np.abs(c) ** 2).sum(axis=0) + np.abs((c * c).sum(axis=0))) / 2)


def multiply_series(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Multiply Legendre series a and b column by column; m and n coefficients give a product with m + n - 1.

    The product follows from its values at as many Gauss points as it has coefficients.
    """
    if min(len(a), len(b)) == 1:  # one of the two series is constant
        return a * b
    points = len(a) + len(b) - 1
    values_of_a, values_of_b = (legendre_values(points, len(each) - 1) @ each for each in (a, b))
    return legendre_series(points) @ (values_of_a * values_of_b)


def integrate_series(series: np.ndarray) -> np.ndarray:
    """Integrate Legendre series, one per column, from 1 to t; the integrals have one more coefficient.

    The derivative of P_{k+1} - P_{k-1} is (2k + 1) P_k.
    """
    parts = series / (2 * np.arange(len(series))[:, None] + 1)
    integral = np.concatenate([np.zeros_like(series[:1]), parts])
    integral[: len(series) - 1] -= parts[1:]
    integral[0] -= integral.sum(axis=0)
    return integral


def number_groups(values: np.ndarray, same: float) -> np.ndarray:
    """Number groups of equal values, in sorted values (..., k): neighbours within `same` of their size."""
    apart = np.abs(np.diff(values)) > same * np.abs(values[..., 1:])
    return np.concatenate([np.zeros_like(values[..., :1], int), np.cumsum(apart, axis=-1)], axis=-1)
