"""Conservative equations at one speed, by a factorization of the stiffness there.

Coordinates in which the stiffness is diagonal at every speed cost an eigenproblem of their own, which at one
speed would be most of the work.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.lapack import dpotrf, dsyevd, dsyevr

from beamdyn.common.triangular import solve_lower, solve_lower_transposed
from beamdyn.equations.equations_of_motion import BACKWARD, ROUNDING_SIZE, SteadyPencil

_EPS = np.finfo(float).eps


def factor_stiffness(pencil: SteadyPencil, speed: float, least: float) -> np.ndarray | None:
    """Cholesky factor L (n, n) of the stiffness at a speed [rad/s].

    None where some deflection has less than the share `least` of its stiffness at rest.
    """
    spin = speed**2 * pencil.K2
    upper, failed = dpotrf((pencil.K0 + spin).T)
    if failed or dpotrf(((1 - least) * pencil.K0 + spin).T)[1]:
        return None
    return upper.T


def transformed(L: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Compute L^-1 A L^-T for triangular L and symmetric A, symmetric but for rounding."""
    return solve_lower(L, solve_lower(L, A).T)


def largest_values(A: np.ndarray, count: int) -> np.ndarray:
    """Compute the largest eigenvalues (k,), descending, of a symmetric matrix."""
    values, _, failed = dsyevd(A, compute_v=0)
    _check(failed)
    return values[: -count - 1 : -1]


def largest_modes(A: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Compute the largest eigenvalues (k,), descending, of a symmetric matrix, and their vectors (n, k)."""
    n = len(A)
    values, vectors, _, _, failed = dsyevr(A, range="I", il=n - count + 1, iu=n)
    _check(failed)
    return values[:count][::-1], vectors[:, ::-1]


def _check(failed: int) -> None:
    if failed:
        raise np.linalg.LinAlgError


def static_coordinates(L: np.ndarray, load: np.ndarray) -> np.ndarray:
    """Solve L L^T q = f for a load (n,): shape (n,)."""
    return solve_lower_transposed(L, solve_lower(L, load[:, None]))[:, 0]


def rounding_of_factored(
    pencil: SteadyPencil, speed: float, squared: np.ndarray, v: np.ndarray, size: np.ndarray
) -> np.ndarray:
    """Relative error (k,) of frequencies of a clamped beam by rounding of its matrices.

    Parameters
    ----------
    pencil : SteadyPencil
        Equations of which the stiffness was factored at a speed.
    speed : float
        The speed [rad/s].
    squared : ndarray, shape (k,)
        Squared frequencies.
    v, size : ndarray, shape (n, k)
        Mass-normalised modes, and their absolute values.
    """
    spin = speed**2 * (size * (np.abs(pencil.K2) @ size)).sum(axis=0)
    by_terms = ((v * (pencil.K0 @ v)).sum(axis=0) + spin) / squared
    mass = (size * (np.abs(pencil.M) @ size)).sum(axis=0)  # 1 without cancellation
    growth = max(1.0, len(v) / ROUNDING_SIZE)  # rounding adds up over the functions
    return growth * (BACKWARD * (by_terms + np.sqrt(by_terms)) + _EPS * mass)
