"""Rotations along a curve by its curvature, and products of vectors given at many points.

Vectors and matrices at points have the points last: (..., 3, N) and (..., 3, 3, N).
"""

from __future__ import annotations

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations.discretization import Cells, integrals_between_points

_UNIT = np.array([1.0, 0.0, 0.0, 0.0])
_ITERATIONS = 30  # of Picard's method, enough for a turn by 2 pi
_CONVERGED = 4 * float(np.finfo(float).eps)  # change of a quaternion with which the iteration ends


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Vector products of vectors (..., 3, N), which are broadcast."""
    product = np.empty(np.broadcast_shapes(a.shape, b.shape))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        product[..., i, :] = a[..., j, :] * b[..., k, :] - a[..., k, :] * b[..., j, :]
    return product


def skew(a: np.ndarray) -> np.ndarray:
    """Matrices (3, 3, ...) of vector products with a (3, ...) from the left: skew(a) b = a x b."""
    matrix = np.zeros((3, *a.shape))
    matrix[0, 1], matrix[0, 2], matrix[1, 2] = -a[2], a[1], -a[0]
    return matrix - matrix.swapaxes(0, 1)


def turn(R: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Multiply matrices (..., 3, 3, N) with vectors (..., 3, N), which are broadcast."""
    return np.einsum("...abj,...bj->...aj", R, a)


def turn_back(R: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Multiply the transposes of matrices (..., 3, 3, N) with vectors (..., 3, N)."""
    return np.einsum("...baj,...bj->...aj", R, a)


def turn_tensors(R: np.ndarray, tensors: np.ndarray) -> np.ndarray:
    """Turn tensors (3, 3, N) by rotations (..., 3, 3, N): R tensor R^T."""
    half = np.einsum("...abj,bcj->...acj", R, tensors)
    return np.einsum("...acj,...dcj->...adj", half, R)


def integrate_curvature(cells: Cells, curvature: np.ndarray, kinks: np.ndarray) -> np.ndarray:
    """Rotations from the root to the Gauss points of cells and to the tip.

    The unit quaternion of R' = R skew(curvature) satisfies a linear equation, y' = y (0, curvature)/2, which
    Gauss collocation solves with an error that falls exponentially with the number of points on a cell.  The
    method keeps the length of the quaternion, so that rotations do not leave their group.

    Parameters
    ----------
    cells : Cells
        Cells and their Gauss points.
    curvature : ndarray, shape (..., 3, N)
        Twist rate and curvatures in the turned axes, per x/L, at the points.
    kinks : ndarray, shape (c, 4)
        Unit quaternions by which the axes turn where each of the c cells begins.

    Returns
    -------
    ndarray, shape (..., 3, 3, N + 1)
        Components of the turned axes, in columns.

    References
    ----------
    Quaternions of a curve: standard.  Gauss methods keep quadratic invariants: Cooper (1987), IMA Journal of
    Numerical Analysis 7, 1-13.
    """
    p, halves = cells.points, np.diff(cells.ends) / 2
    count, shape = len(halves), curvature.shape[:-2]
    of_cells = curvature.reshape(-1, 3, count, p) * halves[:, None]
    rates = _product_from_right(of_cells.transpose(1, 0, 2, 3)).transpose(2, 3, 4, 0, 1) / 2
    within = _collocate(rates, integrals_between_points(p))
    across = _UNIT + np.einsum("j,scjab,scjb->sca", gauss_rule(p)[1], rates, within)
    start, turned = np.broadcast_to(_UNIT, (len(rates), 4)), np.empty_like(within)
    for cell in range(count):
        start = product(start, kinks[cell])
        turned[:, cell] = product(start[:, None], within[:, cell])
        start = product(start, across[:, cell])
    every = np.concatenate([turned.reshape(len(rates), -1, 4), start[:, None]], axis=1)
    return _matrices(every).reshape(*shape, 3, 3, -1)


def _collocate(rates: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Solve y = 1 + A (rates y) for quaternions (S, c, p, 4) at points of cells, by rates (S, c, p, 4, 4).

    Picard iteration converges as the powers of half the angle over their factorials; where a cell turns so
    far that it takes many steps, the linear equations are solved instead.
    """
    y = np.broadcast_to(_UNIT, rates.shape[:-1])
    for _ in range(_ITERATIONS):
        before, y = y, _UNIT + A @ np.einsum("scjab,scjb->scja", rates, y)
        if np.abs(y - before).max() <= _CONVERGED:
            return y
    p = len(A)
    matrix = (-A[:, None, :, None] * rates[:, :, None].swapaxes(3, 4)).reshape(*rates.shape[:2], 4 * p, 4 * p)
    matrix[..., np.arange(4 * p), np.arange(4 * p)] += 1.0
    unit = np.broadcast_to(np.tile(_UNIT, p)[:, None], (*matrix.shape[:3], 1))
    return np.linalg.solve(matrix, unit).reshape(y.shape)


def quaternion_about(axis: int, angle: np.ndarray | float) -> np.ndarray:
    """Unit quaternions (..., 4) of turns by angles (...) [rad] about axis 0, 1 or 2."""
    turned = np.zeros((*np.shape(angle), 4))
    turned[..., 0], turned[..., 1 + axis] = np.cos(np.divide(angle, 2)), np.sin(np.divide(angle, 2))
    return turned


def product(y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Products of quaternions (..., 4), which are broadcast."""
    (w, v), (a, b) = (np.split(each, [1], axis=-1) for each in (y, z))
    real = w * a - (v * b).sum(axis=-1, keepdims=True)
    return np.concatenate([real, w * b + a * v + np.cross(v, b)], axis=-1)


def _product_from_right(a: np.ndarray) -> np.ndarray:
    """Matrices (4, 4, ...) that multiply quaternions from the right with (0, a), a of shape (3, ...)."""
    matrix = np.zeros((4, 4, *a.shape[1:]))
    matrix[1:, 0], matrix[0, 1:], matrix[1:, 1:] = a, -a, -skew(a)
    return matrix


def _matrices(y: np.ndarray) -> np.ndarray:
    """Rotation matrices (S, 3, 3, N) of quaternions (S, N, 4), which are scaled to the length 1."""
    w, v = np.split(np.moveaxis(y / np.sqrt((y * y).sum(axis=-1, keepdims=True)), -1, 0), [1])
    matrices = (2 * w**2 - 1) * np.eye(3)[..., None, None] + 2 * (v[:, None] * v + w * skew(v))
    return np.moveaxis(matrices, 2, 0)
