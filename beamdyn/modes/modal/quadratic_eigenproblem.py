"""Quadratic eigenproblems M q'' + C q' + K q = 0 of gyroscopic and damped equations, at one speed."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import scipy.linalg
from scipy.linalg.lapack import zheevr

from beamdyn.modes.modal.springs import SPLIT_ROOT

_EPS = np.finfo(float).eps
# In large problems few modes are sought in Krylov spaces, of at most this number of blocks of vectors.
_MOST_BLOCKS = 20
_EXTRA = 8  # number of vectors in a block beyond that of the modes
_CONVERGED = 64 * _EPS  # norm of an eigenpair's residual, over the largest eigenvalue, that is rounding
_MASSLESS = 16 * _EPS  # relative eigenvalue of a mass matrix, below which it is 0 within rounding


def solve_gyroscopic(
    M: np.ndarray, C: np.ndarray, d: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray]:
    """Solve M q'' + C q' + diag(d) q = 0 for skew-symmetric C and positive d: see `solve_general`.

    Only the `count` lowest modes are returned, each with one eigenvalue of its conjugate pair.
    """
    n, scale, count = len(d), 1 / np.sqrt(d), min(count, len(d))
    mu, U = np.linalg.eigh(scale[:, None] * M * scale)
    C, inertia = scale[:, None] * C * scale, U * np.sqrt(np.maximum(mu, 0))
    scales, block = np.concatenate([scale, np.ones(n)])[:, None], count + _EXTRA
    if _MOST_BLOCKS * block < n:
        undamped = np.concatenate([U[:, -block:], 1j * np.eye(n)[:, -block:]])
        if found := _find_largest(lambda y: _times_pencil(C, inertia, y), undamped, count):
            return found[0] / 1j, found[1] * scales
    W = np.zeros((2 * n, 2 * n), dtype=complex, order="F")  # Hermitian; only its upper half is set
    W[:n, :n], W[:n, n:] = -1j * C, -1j * inertia
    theta, y, _, _, failed = zheevr(W, range="I", il=2 * n - count + 1, iu=2 * n, overwrite_a=1)
    if failed:
        raise np.linalg.LinAlgError
    return theta[:count] / 1j, y * scales


def _times_pencil(C: np.ndarray, inertia: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Multiply the Hermitian matrix -i [[C, inertia], [-inertia^T, 0]] with columns y, by real products."""
    parts = np.ascontiguousarray(y).view(float)
    z, w = np.split(parts, 2)
    return -1j * np.concatenate([C @ z + inertia @ w, -inertia.T @ z]).view(complex)


def _find_largest(
    multiply: Callable[[np.ndarray], np.ndarray], start: np.ndarray, count: int
) -> tuple[np.ndarray, np.ndarray] | None:
    """Find the `count` largest eigenvalues of a Hermitian matrix, ascending, and its eigenvectors.

    The block Krylov space of the columns `start` and of some random columns, which have a part of every
    eigenvector, grows until more than `count` eigenpairs are exact within rounding.  Return None if they are
    not with `_MOST_BLOCKS` blocks.
    """
    wanted = slice(-count - _EXTRA // 2, None)
    random = np.random.default_rng(0).standard_normal((len(start), _EXTRA))
    basis, block = np.empty((len(start), 0), dtype=complex), np.concatenate([start, random], axis=1)
    products = basis
    for _ in range(_MOST_BLOCKS):
        for _ in range(2):  # the second time removes what rounding has left
            block = np.linalg.qr(block - basis @ (basis.conj().T @ block))[0]
        basis, products = np.c_[basis, block], np.c_[products, block := multiply(block)]
        theta, Y = np.linalg.eigh(basis.conj().T @ products)
        theta, Y = theta[wanted], Y[:, wanted]
        residual = np.linalg.norm(products @ Y - theta * (basis @ Y), axis=0)
        if (residual <= _CONVERGED * theta[-1]).all():
            return theta[-count:], basis @ Y[:, -count:]
    return None


def solve_general(M: np.ndarray, C: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve M q'' + C q' + diag(d) q = 0, d nonzero, with q ~ exp(s t): return 1/s and columns (q, s q)."""
    n = len(d)
    B = np.zeros((2 * n, 2 * n))
    B[:n, :n], B[:n, n:], B[n:, :n] = -C / d[:, None], -M / d[:, None], np.eye(n)
    return np.linalg.eig(B)


def solve_first_order(M: np.ndarray, C: np.ndarray, K: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve M q'' + C q' + K q = 0 for any K, with q ~ exp(s t): return all 1/s and columns q above s q.

    Of the 2 n eigenvalues s, those that are infinite within rounding are omitted.
    """
    n, zero = len(M), np.zeros_like(M)
    A, B = np.block([[zero, np.eye(n)], [-K, -C]]), scipy.linalg.block_diag(np.eye(n), M)
    s, y = scipy.linalg.eig(A, B)
    finite = np.isfinite(s)
    s, y = s[finite], y[:, finite]
    least = _EPS * np.abs(s).max()
    none = np.flatnonzero(np.abs(s) < least)
    # 1/s is infinite for s = 0: such pairs of eigenvalues are replaced by very small conjugate pairs.
    s[none] = 1j * least * (-1.0) ** np.arange(len(none))
    return 1 / s, y


def select_lowest(inverse: np.ndarray, z: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Select the lowest modes by 1/s.

    Each mode has two eigenvalues, of which one is selected: of a conjugate pair, that with Im s > 0; of a
    growing and a decaying one, the growing one; of two decaying ones, the slower one.
    """
    inverse = np.where(
        np.abs(np.real(inverse)) < SPLIT_ROOT * np.abs(inverse), 1j * np.imag(inverse), inverse
    )
    inverse = np.where(inverse == 0, _EPS * np.abs(inverse).max(), inverse)
    s = 1 / inverse
    oscillating = np.flatnonzero(s.imag > 0)
    growing = np.flatnonzero((s.imag == 0) & (s.real > 0))
    decaying = np.flatnonzero((s.imag == 0) & (s.real < 0))
    decaying = decaying[np.argsort(-s[decaying].real)]
    slower = decaying[: max(0, (len(decaying) - len(growing)) // 2)]
    modes = np.concatenate([oscillating, growing, slower])
    squared = np.where(np.isin(modes, growing), -1, 1) * np.abs(s[modes]) ** 2
    modes = modes[np.argsort(squared, kind="stable")][:count]
    return s[modes], z[:, modes]


# Coordinates without mass, such as shear versus bending if sections have no rotary inertia ---------


def has_massless(mass: np.ndarray) -> bool:
    """Return whether some combination of coordinates has no mass within rounding."""
    values = np.linalg.eigvalsh(mass)
    return bool(values[0] < _MASSLESS * values[-1])


def condense(mass: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Compute a basis (columns) with a regular mass matrix; massless coordinates follow quasi-statically.

    Neither damping nor gyroscopic terms may act on massless coordinates.
    """
    values, V = np.linalg.eigh(mass)
    massless = values < _MASSLESS * values[-1]
    V0, V1 = V[:, massless], V[:, ~massless]
    return V1 - V0 @ np.linalg.solve(V0.T @ stiffness @ V0, V0.T @ stiffness @ V1)
