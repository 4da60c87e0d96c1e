"""Modal damping."""

from __future__ import annotations

import numpy as np
import scipy.linalg


def modal_damping(M: np.ndarray, K: np.ndarray) -> np.ndarray:
    """Damping matrix [kg/s] with which every mode of (K, M) has a damping ratio of 1.

    C = 2 L (L^-1 M L^-T)^(1/2) L^T with K = L L^T.
    """
    L = np.linalg.cholesky(K)
    compliance = scipy.linalg.solve_triangular(
        L, scipy.linalg.solve_triangular(L, M, lower=True).T, lower=True
    )
    mu, U = np.linalg.eigh((compliance + compliance.T) / 2)
    root = (U * np.sqrt(np.maximum(mu, 0))) @ U.T
    return 2 * L @ root @ L.T
