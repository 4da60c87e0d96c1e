"""Rank, null spaces and least-squares solutions of many small matrices at once, by singular values."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

RANK_TOLERANCE = 1e-7  # relative singular value that counts as 0; toggle positions are solved to 1e-8


class Decomposition(NamedTuple):
    """Singular values of matrices (S, m, n): u (S, m, m), s (S, min(m, n)), vt (S, n, n), ranks (S,).

    `kept` and `dropped` (S,) are the smallest singular value within the rank and the largest beyond it, over
    the largest of all: the wider the gap, the surer the rank.
    """

    u: np.ndarray
    s: np.ndarray
    vt: np.ndarray
    rank: np.ndarray
    kept: np.ndarray
    dropped: np.ndarray

    def null(self, index: int = 0) -> np.ndarray:
        """Basis of the null space of one matrix, (n, n - rank)."""
        return self.vt[index, self.rank[index] :].T

    def left_null(self, index: int = 0) -> np.ndarray:
        """Basis of the left null space of one matrix, (m, m - rank)."""
        return self.u[index, :, self.rank[index] :]

    def null_rows(self) -> np.ndarray:
        """Rows of vt, those outside the null space set to zero, (S, n, n)."""
        outside = np.arange(self.vt.shape[1]) < self.rank[:, None]
        return np.where(outside[:, :, None], 0.0, self.vt)

    def solve(self, b: np.ndarray) -> np.ndarray:
        """Least-squares solution of least norm, b of shape (S, m)."""
        k = self.s.shape[1]
        keep = np.arange(k) < self.rank[:, None]
        inverse = np.divide(1.0, self.s, out=np.zeros_like(self.s), where=keep)
        parts = inverse * times(self.u.swapaxes(1, 2)[:, :k], b)
        return times(self.vt[:, :k].swapaxes(1, 2), parts)


def times(a: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Products of matrices (S, m, n) and vectors (S, n) or (n,)."""
    return (a @ x[..., None])[..., 0]


def rank_tolerance(rounding: float) -> float:
    """Size, relative to the largest, up to which singular values and motions count as zero."""
    return max(RANK_TOLERANCE, 100 * rounding)


def decompose(a: np.ndarray, rounding: float) -> Decomposition:
    """Singular values, vectors and rank of matrices (S, m, n) whose entries have a relative rounding."""
    u, s, vt = np.linalg.svd(a)
    padded = np.concatenate((s, np.zeros((len(s), 1))), axis=1)
    largest = np.maximum(padded[:, :1], np.finfo(float).tiny)
    relative = padded / largest
    rank = (relative > rank_tolerance(rounding)).sum(axis=1)
    each = np.arange(len(s))
    return Decomposition(u, s, vt, rank, relative[each, np.maximum(rank - 1, 0)], relative[each, rank])
