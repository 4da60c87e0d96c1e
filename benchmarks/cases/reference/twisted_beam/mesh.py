"""Gauss points on pieces of the beam."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Gauss points on all pieces; cumulative integrals from the start of each piece."""

    ends: np.ndarray
    x: np.ndarray  # (pieces, nodes)
    weights: np.ndarray  # (nodes,), of a piece of length 1
    inner: np.ndarray  # (nodes, nodes): integral from the start to each node, of a piece of length 1

    @classmethod
    def make(cls, breakpoints: Sequence[float], pieces: int, nodes: int) -> Mesh:
        stops = sorted({0.0, 1.0, *breakpoints})
        parts = [np.linspace(a, b, pieces, endpoint=False) for a, b in pairwise(stops)]
        ends = np.append(np.concatenate(parts), 1.0)
        t, w = np.polynomial.legendre.leggauss(nodes)
        t, w = (t + 1) / 2, w / 2
        return cls(ends, ends[:-1, None] + np.diff(ends)[:, None] * t, w, _integration(t))

    @property
    def steps(self) -> np.ndarray:
        return np.diff(self.ends)

    def outboard(self, values: np.ndarray) -> np.ndarray:
        """Integral from each node to the tip."""
        whole = self.steps * (values @ self.weights)
        beyond = np.append(np.cumsum(whole[::-1])[::-1], 0.0)
        return beyond[:-1, None] - self.steps[:, None] * (values @ self.inner.T)


def _integration(t: np.ndarray) -> np.ndarray:
    """Exact integrals from 0 to each node of the polynomials through the nodes."""
    legendre = np.polynomial.legendre
    values = legendre.legvander(2 * t - 1, t.size - 1)
    integrals = [legendre.legint(row, lbnd=-1, scl=1) / 2 for row in np.eye(t.size)]
    cumulative = np.stack([legendre.legval(2 * t - 1, c) for c in integrals], axis=1)
    return cumulative @ np.linalg.inv(values)
