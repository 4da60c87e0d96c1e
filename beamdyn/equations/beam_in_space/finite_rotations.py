"""Finite rotations: integration of a curvature along a curve, and rotation of vectors at many points.

In arrays of vectors and matrices, the last axis counts the points.
"""

from __future__ import annotations

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations.discretization import Cells, integrals_between_points

UNIT = np.array([1.0, 0.0, 0.0, 0.0])  # quaternion of the identity rotation
CONJUGATE = np.array([1.0, -1.0, -1.0, -1.0])  # factors that turn a unit quaternion into its inverse
_NEXT = np.array([1, 2, 0])  # cyclic successor of each component, for fast cross products
_ITERATIONS = 30  # number of Picard iterations that suffice for a rotation by 2 pi
_CONVERGED = 4 * float(np.finfo(float).eps)  # change of a quaternion below which the iteration has converged


def cross(a: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Compute the cross products of vectors (..., 3, points); the shapes are broadcast."""
    return (a * b.take(_NEXT, axis=-2) - a.take(_NEXT, axis=-2) * b).take(_NEXT, axis=-2)


def skew(a: np.ndarray) -> np.ndarray:
    """Build the skew-symmetric matrices (3, 3, ...) of vectors a (3, ...): skew(a) b = a x b."""
    matrix = np.zeros((3, *a.shape))
    matrix[0, 1], matrix[0, 2], matrix[1, 2] = -a[2], a[1], -a[0]
    return matrix - matrix.swapaxes(0, 1)


_PRODUCT = np.zeros((4, 4, 4))  # multiplication table of quaternions: two factors, then the product
_PRODUCT[0] = _PRODUCT[:, 0] = np.eye(4)
_PRODUCT[1:, 1:, 0], _PRODUCT[1:, 1:, 1:] = -np.eye(3), -skew(np.eye(3))
# Matrices of the quaternion product y -> y (0, a), one for each component of the vector a.
_FROM_RIGHT = _PRODUCT[:, 1:].swapaxes(0, 1).reshape(3, 16)
# Matrix entries of the rotation a -> y (0, a) y*, per product of two components of the quaternion y.
_TURNING = np.einsum("ajc,b,cbi->abij", _PRODUCT[:, 1:], CONJUGATE, _PRODUCT[..., 1:]).reshape(16, 9)


def turn(R: np.ndarray, a: np.ndarray) -> np.ndarray:
    """Multiply matrices (..., 3, 3, points) with vectors (..., 3, points); the shapes are broadcast."""
    return np.einsum("...abj,...bj->...aj", R, a)


def turn_tensors(R: np.ndarray, tensors: np.ndarray) -> np.ndarray:
    """Rotate tensors: R tensor R^T for rotations and tensors (..., 3, 3, points), which are broadcast."""
    half = np.einsum("...abj,...bcj->...acj", R, tensors)
    return np.einsum("...acj,...dcj->...adj", half, R)


def turn_law(R: np.ndarray, law: np.ndarray) -> np.ndarray:
    """Rotate section stiffness or mass matrices (6, 6, points) by rotations (3, 3, points)."""
    blocks = law.reshape(2, 3, 2, 3, -1).swapaxes(1, 2)
    return turn_tensors(R, blocks).swapaxes(1, 2).reshape(law.shape)


def integrate_curvature(cells: Cells, curvature: np.ndarray, kinks: np.ndarray) -> np.ndarray:
    """Integrate the curvature of a beam from the root: compute rotations at Gauss points and at the tip.

    The unit quaternion of R' = R skew(curvature) satisfies a linear equation, y' = y (0, curvature)/2, which
    Gauss collocation solves with an error that falls exponentially with the number of points on a cell.  The
    method preserves the length of the quaternion, so that the results remain rotations.

    Parameters
    ----------
    cells : Cells
        Cells and their Gauss points.
    curvature : ndarray, shape (..., 3, points)
        Twist rate and curvatures in the rotated axes, per unit of x/L, at the Gauss points.
    kinks : ndarray, shape (c, 4)
        Unit quaternions of the axes' rotation at the beginning of each of the c cells.

    Returns
    -------
    ndarray, shape (..., 3, 3, sections)
        Rotation matrices, whose columns are the rotated axes.

    References
    ----------
    Quaternions of a curve: standard.  Gauss methods keep quadratic invariants: Cooper (1987), IMA Journal of
    Numerical Analysis 7, 1-13.
    """
    # A quaternion has half the angle of its rotation; cells are mapped to [-1, 1].
    halves, shape = np.diff(cells.ends) / 4, curvature.shape[:-2]
    rates = np.moveaxis(curvature.reshape(-1, 3, len(halves), cells.points) * halves[:, None], 1, -1)
    within, across = _collocate(rates, integrals_between_points(cells.points), gauss_rule(cells.points)[1])
    starts = [np.tile(UNIT, (len(rates), 1))]
    for step in np.moveaxis(product(kinks, across), 1, 0):
        starts.append(product(starts[-1], step))
    turned = product(product(np.stack(starts[:-1], axis=1), kinks)[:, :, None], within)
    every = np.concatenate([turned.reshape(len(rates), -1, 4), starts[-1][:, None]], axis=1)
    return rotation_matrices(every).reshape(*shape, 3, 3, -1)


def _collocate(rates: np.ndarray, A: np.ndarray, b: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve y = 1 + A (y rates) for quaternions at p points of c cells, and at the ends of the cells.

    1 is the identity; A (p, p) and b (p,) are weights of integrals from the start of a cell to its points and
    to its end.  For S states of the curve the shapes of the results are (S, c, p, 4) and (S, c, 4).

    Picard iteration starts from the rotation about the integral of the rates (S, c, p, 3), which is exact if
    their direction is constant.  After j steps its error is of the order h^j / j!, where h is half the
    rotation angle over a cell; if this needs too many steps, the linear equations are solved instead.
    """
    operators, turns = (rates @ _FROM_RIGHT).reshape(*rates.shape[:-1], 4, 4), A @ rates
    angle = np.sqrt((turns * turns).sum(axis=-1, keepdims=True))
    y = np.concatenate([np.cos(angle), turns * np.sinc(angle / np.pi)], axis=-1)
    for _ in range(_ITERATIONS):
        before, slope = y, np.einsum("scja,scjab->scjb", y, operators)
        y = UNIT + A @ slope
        if np.abs(y - before).max() <= _CONVERGED:
            break
    else:
        size = 4 * len(A)
        feedback = np.einsum("ij,scjab->scibja", A, operators).reshape(*rates.shape[:2], size, size)
        y = np.linalg.solve(np.eye(size) - feedback, np.tile(UNIT, len(A))[:, None]).reshape(y.shape)
        slope = np.einsum("scja,scjab->scjb", y, operators)
    return y, UNIT + b @ slope


def quaternions_by_vectors(vectors: np.ndarray) -> np.ndarray:
    """Build the unit quaternions (..., 4) of rotation vectors (..., 3) [rad]."""
    half = np.sqrt((vectors * vectors).sum(axis=-1, keepdims=True)) / 2
    return np.concatenate([np.cos(half), vectors / 2 * np.sinc(half / np.pi)], axis=-1)


def product(y: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Multiply quaternions (..., 4), which are broadcast."""
    return np.einsum("...bc,...b->...c", (y @ _PRODUCT.reshape(4, 16)).reshape(*y.shape, 4), z)


def rotation_matrices(y: np.ndarray) -> np.ndarray:
    """Compute the rotation matrices (S, 3, 3, N) of S sets of N quaternions (S, N, 4), normalized first."""
    squares = (y[..., None] * y[..., None, :]).reshape(-1, 16)
    matrices = squares @ _TURNING / squares[:, ::5].sum(axis=1, keepdims=True)
    return np.moveaxis(matrices.reshape(*y.shape[:-1], 3, 3), 1, -1)
