"""Rotations along a curve by its curvature, and products of vectors given at many points.

Vectors and matrices at points have the components first and the points last: (..., 3, N) and (3, 3, N).
"""

from __future__ import annotations

import numpy as np

from beamdyn.common.legendre import gauss_rule
from beamdyn.equations.quadrature import Cells, integrals_between_points


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
    """Multiply matrices (3, 3, N) with vectors (..., 3, N)."""
    return np.einsum("abj,...bj->...aj", R, a)


def turn_back(R: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Multiply the transposes of matrices (3, 3, N) with vectors (..., 3, N)."""
    return np.einsum("baj,...bj->...aj", R, a)


def turn_tensors(R: np.ndarray, tensors: np.ndarray) -> np.ndarray:
    """Turn tensors (3, 3, N) by rotations: R tensor R^T."""
    return np.einsum("abj,bcj,dcj->adj", R, tensors, R, optimize=["einsum_path", (0, 1), (0, 1)])


def integrate_curvature(cells: Cells, curvature: np.ndarray, kinks: np.ndarray) -> np.ndarray:
    """Rotations from the root to the Gauss points of cells and to the tip.

    The unit quaternion of R' = R skew(curvature) satisfies a linear equation, y' = y (0, curvature)/2, which
    Gauss collocation solves with an error that falls exponentially with the number of points on a cell.  The
    method keeps the length of the quaternion, so that rotations do not leave their group.

    Parameters
    ----------
    cells : Cells
        Cells and their Gauss points.
    curvature : ndarray, shape (3, N)
        Twist rate and curvatures in the turned axes, per x/L, at the points.
    kinks : ndarray, shape (c, 4)
        Unit quaternions by which the axes turn where each of the c cells begins.

    Returns
    -------
    ndarray, shape (3, 3, N + 1)
        Components of the turned axes, in columns.

    References
    ----------
    Quaternions of a curve: standard.  Gauss methods keep quadratic invariants: Cooper (1987), IMA Journal of
    Numerical Analysis 7, 1-13.
    """
    p, halves = cells.points, np.diff(cells.ends) / 2
    count = len(halves)
    rates = product_from_right(curvature).transpose(2, 0, 1).reshape(count, p, 4, 4) / 2
    rates *= halves[:, None, None, None]
    A = integrals_between_points(p)
    matrix = -A[None, :, None, :, None] * rates[:, None].transpose(0, 1, 3, 2, 4)
    matrix = matrix.reshape(count, 4 * p, 4 * p)
    matrix[:, np.arange(4 * p), np.arange(4 * p)] += 1.0
    unit = np.tile([1.0, 0.0, 0.0, 0.0], p)
    within = np.linalg.solve(matrix, np.broadcast_to(unit[:, None], (count, 4 * p, 1))).reshape(count, p, 4)
    across = np.eye(4)[0] + np.einsum("j,cjab,cjb->ca", gauss_rule(p)[1], rates, within)
    start, turned = np.eye(4)[0], np.empty((count, p, 4))
    for cell in range(count):
        start = product_from_left(start) @ kinks[cell]
        turned[cell] = within[cell] @ product_from_left(start).T
        start = product_from_left(start) @ across[cell]
    return _matrices(np.concatenate([turned.reshape(-1, 4), start[None]]).T)


def quaternion_about(axis: int, angle: np.ndarray | float) -> np.ndarray:
    """Unit quaternions (..., 4) of turns by angles (...) [rad] about axis 0, 1 or 2."""
    turned = np.zeros((*np.shape(angle), 4))
    turned[..., 0], turned[..., 1 + axis] = np.cos(np.divide(angle, 2)), np.sin(np.divide(angle, 2))
    return turned


def product_from_right(a: np.ndarray) -> np.ndarray:
    """Matrices (4, 4, N) that multiply quaternions from the right with (0, a), a of shape (3, N)."""
    matrix = np.zeros((4, 4, *a.shape[1:]))
    matrix[1:, 0], matrix[0, 1:], matrix[1:, 1:] = a, -a, -skew(a)
    return matrix


def product_from_left(y: np.ndarray) -> np.ndarray:
    """Matrix (4, 4) that multiplies quaternions from the left with y (4,)."""
    w, v = y[0], y[1:]
    matrix = w * np.eye(4)
    matrix[1:, 0], matrix[0, 1:] = v, -v
    matrix[1:, 1:] += skew(v)
    return matrix


def _matrices(y: np.ndarray) -> np.ndarray:
    """Rotation matrices (3, 3, N) of quaternions (4, N), which are scaled to the length 1."""
    w, v = np.split(y / np.sqrt((y * y).sum(axis=0)), [1])
    return (2 * w**2 - 1) * np.eye(3)[..., None] + 2 * (v[:, None] * v + w * skew(v))
