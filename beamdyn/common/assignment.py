"""Assignment of each of some things to one of others, such as modes to modes."""

from __future__ import annotations

import numpy as np


def assign(cost: np.ndarray) -> np.ndarray:
    """Column (n,) of each row of a cost matrix (n, m), n <= m, with the least sum of costs."""
    least = cost.argmin(axis=1)
    if np.isfinite(cost).all() and len(np.unique(least)) == len(least):
        return least  # what each row would choose alone
    from scipy.optimize import linear_sum_assignment  # here, because it takes as long to import as the rest

    return linear_sum_assignment(cost)[1]
