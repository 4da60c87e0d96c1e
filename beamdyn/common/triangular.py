"""Triangular systems of equations of any size, by BLAS.

LAPACK's routine, which `scipy.linalg.solve_triangular` calls, starts threads for matrices of any size: on a
busy machine they wait for milliseconds where the arithmetic takes microseconds.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg.blas import dtrsm


def solve_lower(L: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Solve L X = B for lower triangular L (n, n) and B (n, m)."""
    return dtrsm(1.0, L.T, B, lower=0, trans_a=1)  # the transpose is in the order of columns: no copy


def solve_lower_transposed(L: np.ndarray, B: np.ndarray) -> np.ndarray:
    """Solve L^T X = B for lower triangular L (n, n) and B (n, m)."""
    return dtrsm(1.0, L.T, B, lower=0)
