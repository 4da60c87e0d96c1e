"""Batches of symmetric eigenproblems with diagonal stiffness, diag(d) z = w^2 M z, solved by the inverse.

In shapes of arrays, S counts eigenproblems, n coordinates, and k eigenvalues.
"""

from __future__ import annotations

import numpy as np
import scipy.linalg

from beamdyn.equations.equations_of_motion import BACKWARD, ROUNDING_SIZE, SteadyPencil

_EPS = np.finfo(float).eps
# Ratios of the rounding errors of frequencies to those of a clamped beam in one plane: for beams in two
# planes, and for beams on root springs.
_TWO_PLANES, _ON_SPRINGS = 3.0, 2.0
# Relative rounding error of stiffness entries, which matters where they cancel, as in pretwisted beams.
_CANCELLED = 0.5 * _EPS
# Error of mu = 1/w^2 relative to the largest mu, five times the error measured at mode 100.
_FORWARD = 0.5 * _EPS
LEAST_STIFFNESS = 0.1  # ratio of stiffness to that at rest below which the eigenproblem is shifted
_LARGEST_SHIFT = 256  # largest exponent of 4 in a shift: larger ones overflow
_LARGEST_BATCHED = 64  # largest size of matrices for which one batched call computes all eigenvectors


def solve_diagonal(
    mass: np.ndarray, stiffness: np.ndarray, count: int, lowest_at_rest: float | np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve diag(d) z = w^2 M z for the lowest modes of each of many problems.

    Parameters
    ----------
    mass : ndarray, shape (coordinates, coordinates) or (S, coordinates, coordinates)
        Mass matrix M, common to all problems or one for each.
    stiffness : ndarray, shape (S, coordinates)
        Diagonal stiffness d of each problem.
    count : int
        Number of modes k.
    lowest_at_rest : float or ndarray, shape (S,)
        Lowest squared frequency at rest.

    Returns
    -------
    squared : ndarray, shape (S, modes)
        Squared frequencies w^2.
    z : ndarray, shape (S, coordinates, modes)
        Mass-normalised modes.
    rounding : ndarray, shape (S, modes)
        Estimated relative error of w caused by the eigensolver.
    """
    stiff, lowest = stiffness.min(axis=1) >= LEAST_STIFFNESS, lowest_at_rest * np.ones(len(stiffness))
    if stiff.all():
        return _solve_scaled(mass, stiffness, count, lowest)
    S, n = stiffness.shape
    squared, z, rounding = np.empty((S, count)), np.empty((S, n, count)), np.empty((S, count))
    for mask, solve in ((stiff, _solve_scaled), (~stiff, _solve_shifted)):
        if mask.any():
            M = mass[mask] if mass.ndim == 3 else mass
            squared[mask], z[mask], rounding[mask] = solve(M, stiffness[mask], count, lowest[mask])
    return squared, z, rounding


def inverse_squares(mass: np.ndarray, stiffness: np.ndarray, count: int) -> np.ndarray:
    """Compute the largest 1/w^2 as `solve_diagonal` does, for stiffnesses of at least `LEAST_STIFFNESS`."""
    scale = 1 / np.sqrt(stiffness)
    mu = np.linalg.eigvalsh(scale[:, :, None] * mass * scale[:, None, :])
    return above_rounding(mu[:, : -count - 1 : -1])


def _solve_scaled(
    M: np.ndarray, d: np.ndarray, count: int, lowest_at_rest: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve d z = w^2 M z for positive diagonal stiffness d and mass matrices M, for a batch of problems.

    Return squared angular frequencies w^2, vectors z, and relative rounding errors of w.
    """
    scale = 1 / np.sqrt(d)
    mu, z = _solve_largest(scale[:, :, None] * M * scale[:, None, :], count)
    return 1 / mu, z * scale[:, :, None] / np.sqrt(mu)[:, None, :], forward_error(mu)


def _solve_shifted(
    M: np.ndarray, d: np.ndarray, count: int, lowest_at_rest: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve d z = w^2 M z for any diagonal stiffness d, by the positive definite d + shift M.

    The results are as those of `_solve_scaled`.
    """
    shift = _find_shift(M, d, lowest_at_rest)
    K = shift[:, None, None] * M
    K[:, np.arange(d.shape[1]), np.arange(d.shape[1])] += d
    L = np.linalg.cholesky(K)
    half = np.linalg.solve(L, np.broadcast_to(M, K.shape))
    A = np.linalg.solve(L, np.swapaxes(half, 1, 2))
    mu, x = _solve_largest((A + np.swapaxes(A, 1, 2)) / 2, count)
    z = np.linalg.solve(np.swapaxes(L, 1, 2), x) / np.sqrt(mu)[:, None, :]
    squared = 1 / mu - shift[:, None]
    cancellation = np.abs(1 / mu / np.where(squared == 0, np.inf, squared))
    return squared, z, forward_error(mu) * cancellation


def _solve_largest(A: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Compute the largest eigenvalues, descending, and eigenvectors of a batch of symmetric matrices."""
    n = A.shape[-1]
    if n <= _LARGEST_BATCHED:
        mu, z = np.linalg.eigh(A)
    else:  # most of the time is needed for eigenvectors, so only the requested ones are computed
        modes = [scipy.linalg.eigh(a, subset_by_index=(n - count, n - 1)) for a in A]
        mu, z = (np.array(values) for values in zip(*modes, strict=True))
    return above_rounding(mu[:, : -count - 1 : -1]), z[:, :, : -count - 1 : -1]


def above_rounding(mu: np.ndarray) -> np.ndarray:
    """Raise descending eigenvalues to at least half their rounding error, so that none is negative."""
    return np.maximum(mu, _FORWARD / 2 * mu[..., :1])


def forward_error(mu: np.ndarray) -> np.ndarray:
    """Estimate the relative error that the eigensolver causes in w = 1/sqrt(mu), for descending mu."""
    return _FORWARD * mu[..., :1] / mu


def _find_shift(M: np.ndarray, d: np.ndarray, smallest: np.ndarray) -> np.ndarray:
    """Find shifts (S,), `smallest` (S,) times a power of 4, that make diag(d) + shift M positive definite.

    Raises
    ------
    LinAlgError
        If rounding makes it impossible to decide whether the shifted matrix is positive definite.
    """
    # Exponents that are too small, and exponents to be tried.
    low, high = np.full(len(d), -1), np.zeros(len(d), dtype=int)
    failing, M = np.arange(len(d)), np.broadcast_to(M, (len(d), *M.shape[-2:]))
    while (
        failing := failing[~_are_definite(M[failing], d[failing], smallest[failing] * 4.0 ** high[failing])]
    ).size:
        low[failing], high[failing] = high[failing], np.maximum(1, 2 * high[failing])
        if high.max() > _LARGEST_SHIFT:
            raise np.linalg.LinAlgError
    while (wide := np.flatnonzero(high - low > 1)).size:
        middle = (low[wide] + high[wide]) // 2
        definite = _are_definite(M[wide], d[wide], smallest[wide] * 4.0**middle)
        low[wide], high[wide] = np.where(definite, low[wide], middle), np.where(definite, middle, high[wide])
    return smallest * 4.0**high


def _are_definite(M: np.ndarray, d: np.ndarray, shift: np.ndarray) -> np.ndarray:
    """Return for each problem whether diag(d) + shift M is positive definite beyond rounding errors."""
    n = d.shape[1]
    K = shift[:, None, None] * M
    K[:, np.arange(n), np.arange(n)] += d
    values = np.linalg.eigvalsh(K)
    return values[:, 0] >= np.maximum(LEAST_STIFFNESS / 2, n * BACKWARD * values[:, -1])


def rounding_of_matrices(
    terms: np.ndarray, squared: np.ndarray, z: np.ndarray, size: np.ndarray, mass: np.ndarray
) -> np.ndarray:
    """Estimate relative errors of frequencies by rounding of the matrices of conservative equations.

    Parameters
    ----------
    terms : ndarray, shape (problems, coordinates)
        The diagonal stiffness, summed over the absolute values of its terms.
    squared, z : ndarray, shapes (problems, modes) and (problems, coordinates, modes)
        Squared frequencies and modes, in coordinates in which the stiffness is diagonal.
    size : ndarray, shape (problems, coordinates, modes)
        Absolute values of the modes in the coordinates of the original equations.
    mass : ndarray, shape (coordinates, coordinates) or (problems, coordinates, coordinates)
        Absolute values of the mass matrix of the original equations.
    """
    modal_terms = np.einsum("snk,sn->sk", z**2, terms)  # modal stiffness, if no terms cancelled
    modal_norm = (z**2).sum(axis=1) * terms.max(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        by_terms, by_norm = modal_terms / np.abs(squared), modal_norm / np.abs(squared)
    modal_mass = (size * (mass @ size)).sum(axis=1)  # modal mass, if no terms cancelled
    growth = max(1.0, terms.shape[1] / ROUNDING_SIZE)  # rounding errors accumulate over the functions
    return growth * (BACKWARD * (by_terms + np.sqrt(by_norm) + 0.375 * by_norm) + _EPS * modal_mass)


def rounding_of_scene(
    pencil: SteadyPencil, speeds: np.ndarray, squared: np.ndarray, size: np.ndarray, rounding: np.ndarray
) -> np.ndarray:
    """Estimate the relative rounding errors of frequencies from those of a clamped beam in one plane.

    With two planes, cancellation of large stiffness entries of the stiffer plane increases the error.  The
    absolute values `size` of the modes have shape (speeds, coordinates, modes).
    """
    if pencil.planes == 1:
        return _ON_SPRINGS * rounding if pencil.shift else rounding
    K = np.abs(pencil.K0) + speeds[:, None, None] ** 2 * np.abs(pencil.K2)
    with np.errstate(divide="ignore", invalid="ignore"):
        cancelled = _CANCELLED * (size * (K @ size)).sum(axis=1) / np.abs(squared)
    return _TWO_PLANES * (rounding + cancelled)
