"""Gauss points on pieces of the beam."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np


@dataclass(frozen=True)
class Mesh:
    """Gauss points on all pieces; cumulative integrals from the start of each piece."""

    ends: np.ndarray
    x: np.ndarray  # (pieces, nodes)
    weights: np.ndarray  # (nodes,), quadrature weights of a piece of length 1
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
        """Integrate a function with given values at the nodes from each node to the tip."""
        whole = self.steps * (values @ self.weights)
        beyond = np.append(np.cumsum(whole[::-1])[::-1], 0.0)
        return beyond[:-1, None] - self.steps[:, None] * (values @ self.inner.T)


_RATIO = 4.0  # ratio of a property at the ends of a piece, above which the piece is halved
_WITHIN = 1e-10  # fraction of a piece, from its ends, at which properties are evaluated, to be beside jumps
_HALVINGS = 50


def graded(functions: Iterable[Callable[[np.ndarray], np.ndarray]], stops: Sequence[float]) -> list[float]:
    """Add stops, so that no positive function changes by a large factor between two stops.

    The reciprocal of a stiffness that falls linearly by a factor r has a pole at 1/(r - 1) of the segment's
    length beyond its end: polynomials over the whole segment resolve that slowly.
    """
    functions = list(functions)

    def changes_fast(a: float, b: float) -> bool:
        ends = np.array([a + _WITHIN * (b - a), b - _WITHIN * (b - a)])
        ratios = [values[0] / values[1] for values in (f(ends) for f in functions)]
        return any(max(ratio, 1 / ratio) > _RATIO for ratio in ratios)

    def divided(a: float, b: float, halvings: int) -> list[float]:
        middle = (a + b) / 2
        if halvings == 0 or not changes_fast(a, b):
            return [a]
        return [*divided(a, middle, halvings - 1), *divided(middle, b, halvings - 1)]

    return [x for a, b in pairwise(stops) for x in divided(a, b, _HALVINGS)] + [stops[-1]]


def _integration(t: np.ndarray) -> np.ndarray:
    """Compute exact integrals from 0 to each node of the polynomials through the nodes."""
    legendre = np.polynomial.legendre
    values = legendre.legvander(2 * t - 1, t.size - 1)
    integrals = [legendre.legint(row, lbnd=-1, scl=1) / 2 for row in np.eye(t.size)]
    cumulative = np.stack([legendre.legval(2 * t - 1, c) for c in integrals], axis=1)
    return cumulative @ np.linalg.inv(values)
