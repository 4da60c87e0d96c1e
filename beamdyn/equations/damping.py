"""Modal damping."""

from __future__ import annotations

import numpy as np
import scipy.linalg


def modal_damping(M: np.ndarray, K: np.ndarray, shift: float = 0.0) -> np.ndarray:
    """Damping matrix [kg/s] with which every mode of (K, M) has a damping ratio of 1.

    C = 2 L (B - shift B^2)^(1/2) L^T with K + shift M = L L^T and B = L^-1 M L^-T; the shift [1/s2] makes
    a singular stiffness positive definite.
    """
    L = np.linalg.cholesky(K + shift * M if shift else K)
    compliance = scipy.linalg.solve_triangular(
        L, scipy.linalg.solve_triangular(L, M, lower=True).T, lower=True
    )
    mu, U = np.linalg.eigh((compliance + compliance.T) / 2)
    root = (U * np.sqrt(np.maximum(mu * (1 - shift * mu), 0))) @ U.T
    return 2 * L @ root @ L.T
