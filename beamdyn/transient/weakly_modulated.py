"""Gauss collocation for equations whose stiffness one small scalar modulates: at steady speed.

There q'' + C q' + (K + e(t) G) q = sum g_l(t) P_l with constant matrices.  With e = 0 the matrix of a
step is the same for all steps and is inverted once; the steps follow from a series in the values of e
at their nodes, up to the second order, so that no step needs a factorisation of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamdyn.transient.gauss import BLOCK, Piece, Tableau, add_drift, advance, at_end, left_side, tableau


@dataclass(frozen=True)
class Modulation:
    """q'' + C q' + (K + e(t) G) q = sum g_l(t) P_l.

    Parameters
    ----------
    C : ndarray, shape (n, n), or None
        Damping and gyroscopic matrix.
    K, G : ndarray, shape (n, n)
        Mean stiffness, and what modulates it.
    P : ndarray, shape (l, n)
        Loads.
    scalars : callable
        From times of any shape to e, of that shape, and g, of that shape and l.
    """

    C: np.ndarray | None
    K: np.ndarray
    G: np.ndarray
    P: np.ndarray
    scalars: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class _Series:
    """Accelerations a = (L + D Z)^-1 (R0 + D R1) z of a step, with D = diag(e) over its nodes.

    z = (q, v, g at the nodes) has 2 n + s l entries.  To the second order in D,
    a = X0 z + Y D W z - Y D Z Y D W z, with Y = L^-1, X0 = Y R0 and W = R1 - Z X0.
    """

    Y: np.ndarray
    Z: np.ndarray
    X0: np.ndarray
    W: np.ndarray

    def accelerations(self, e: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Accelerations of N steps, shape (N, s n), from e repeated for all coordinates and z."""
        first = (e * (z @ self.W.T)) @ self.Y.T
        return z @ self.X0.T + first - (e * (first @ self.Z.T)) @ self.Y.T

    def steps(self, h: float, table: Tableau) -> np.ndarray:
        """Maps from z to (q, v) at the end, for 1, each e_i and each e_i e_j: (1 + s + s^2, 2 n, :)."""
        s, size = len(table.c), len(self.Y)
        n = size // s
        blocks = [slice(i * n, (i + 1) * n) for i in range(s)]
        ZY = self.Z @ self.Y
        first = [self.Y[:, i] @ self.W[i] for i in blocks]
        second = [-self.Y[:, i] @ ZY[i, j] @ self.W[j] for i in blocks for j in blocks]
        still = add_drift(at_end(self.X0[None], h, table), h, first=0)
        return np.concatenate([still, at_end(np.array([*first, *second]), h, table)])


def _series(m: Modulation, h: float, table: Tableau) -> _Series:
    s, n = len(table.c), len(m.K)
    nodes = np.ones(s)
    C = None if m.C is None else np.broadcast_to(m.C, (1, s, n, n))
    L = left_side(C, np.broadcast_to(m.K, (1, s, n, n)), h, table)[0]
    drift = np.stack([nodes, h * table.c], axis=1)  # of q and v in the displacement at the nodes
    R0 = -np.einsum("ix,ab->iaxb", drift, m.K).reshape(s * n, 2 * n)
    if m.C is not None:
        R0[:, n:] -= np.tile(m.C, (s, 1))
    loads = np.einsum("ij,la->iajl", np.eye(s), m.P).reshape(s * n, -1)
    R1 = -np.einsum("ix,ab->iaxb", drift, m.G).reshape(s * n, 2 * n)
    Y, Z = np.linalg.inv(L), h**2 * np.kron(table.A2, m.G)
    X0 = Y @ np.concatenate([R0, loads], axis=1)
    W = np.concatenate([R1, np.zeros_like(loads)], axis=1) - Z @ X0
    return _Series(Y, Z, X0, W)


def propagate_modulated(
    modulation: Modulation,
    t0: float,
    t1: float,
    steps: int,
    q0: np.ndarray,
    v0: np.ndarray,
    stages: int,
    accuracy: float,
) -> Piece | None:
    """Advance a state over equal steps, as `beamdyn.transient.gauss.propagate` does.

    Parameters
    ----------
    modulation : Modulation
        The equations.
    t0, t1, steps, q0, v0, stages
        As for `propagate`.
    accuracy : float
        Largest relative error by what the series leaves out: its third-order term adds up over
        the steps to rho^3 times their number, rho being the ratio of its terms.

    Returns
    -------
    Piece or None
        None where the modulation is too strong for the series.
    """
    h, n, table = (t1 - t0) / steps, len(q0), tableau(stages)
    series = _series(modulation, h, table)
    strength = np.abs(np.linalg.eigvals(series.Z @ series.Y)).max()
    maps = series.steps(h, table).reshape(1 + stages + stages**2, -1)
    state, acceleration = np.empty((steps + 1, 2 * n + 1)), np.empty((steps, stages, n))
    state[:, 0], state[0, 1 : n + 1], state[0, n + 1 :] = 1, q0, v0
    for first in range(0, steps, BLOCK):
        block = slice(first, min(first + BLOCK, steps))
        k = np.arange(block.start, block.stop)
        e, g = modulation.scalars(t0 + h * (k[:, None] + table.c))
        if steps * (strength * np.abs(e).max()) ** 3 > accuracy:
            return None
        g = g.reshape(len(k), -1)
        products = np.concatenate(
            [np.ones((len(k), 1)), e, (e[:, :, None] * e[:, None]).reshape(len(k), -1)], 1
        )
        step = (products @ maps).reshape(len(k), 2 * n, -1)
        constant = step[:, :, 2 * n :] @ g[:, :, None]
        advance(np.concatenate([constant, step[:, :, : 2 * n]], axis=2), state[first : block.stop + 1])
        z = np.concatenate([state[block, 1:], g], axis=1)
        a = series.accelerations(np.repeat(e, n, axis=1), z)
        acceleration[block] = a.reshape(len(k), stages, n)
    return Piece(t0, h, state, acceleration)
