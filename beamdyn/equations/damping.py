"""Modal damping."""

from __future__ import annotations

import numpy as np

from beamdyn.common.triangular import solve_lower, solve_lower_transposed
from beamdyn.equations.rounding import BACKWARD


def modal_damping(
    M: np.ndarray, K: np.ndarray, shift: float = 0.0, ratios: np.ndarray | None = None
) -> np.ndarray:
    """Damping matrix [kg/s] with which every mode of (K, M) has a damping ratio of 1, or its own (n,).

    Own ratios are in order of frequency.

    C = 2 L (B - shift B^2)^(1/2) L^T with K + shift M = L L^T and B = L^-1 M L^-T; the shift [1/s2] makes
    a singular stiffness positive definite.
    """
    L = np.linalg.cholesky(K + shift * M if shift else K)
    compliance = solve_lower(L, solve_lower(L, M).T)
    mu, U = np.linalg.eigh((compliance + compliance.T) / 2)
    unshifted = _quotients(K, solve_lower_transposed(L, U)) if shift else 1.0
    of_modes = 1.0 if ratios is None else ratios[::-1]  # mu ascends as frequencies descend
    root = (U * (of_modes * np.sqrt(np.maximum(mu * unshifted, 0)))) @ U.T
    return 2 * L @ root @ L.T


def _quotients(K: np.ndarray, v: np.ndarray) -> np.ndarray:
    """Quotients v^T K v (k,), 0 within rounding: 1 - shift mu, without its loss of digits on soft springs."""
    quotient = np.einsum("nk,nk->k", v, K @ v)
    lost = BACKWARD * np.einsum("nk,nk->k", np.abs(v), np.abs(K) @ np.abs(v))
    return np.where(quotient > lost, quotient, 0.0)
