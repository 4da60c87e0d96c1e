"""Gauss collocation for a stiffness that varies weakly about its mean: at steady speed.

The equations: q'' + C q' + (K + sum_m e_m(t) G_m) q = sum_l g_l(t) P_l with constant matrices.  With e = 0
the matrix of the collocation equations is the same for all steps and is inverted once.  The maps of the steps
follow from a power series in the values of e at their nodes, up to the second order, so that no step needs a
factorisation of its own.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamdyn.transient.gauss import BLOCK, Segment, Tableau, add_drift, advance, increment, left_side, tableau


@dataclass(frozen=True)
class ModulatedSystem:
    """Equations q'' + C q' + (K + sum_m e_m(t) G_m) q = sum_l g_l(t) P_l.

    Parameters
    ----------
    C : ndarray, shape (n, n), or None
        Damping and gyroscopic matrix.
    K : ndarray, shape (n, n)
        Mean stiffness.
    G : ndarray, shape (m, n, n)
        Matrices G_m of the varying stiffness.
    P : ndarray, shape (l, n)
        Vectors P_l of the loads.
    scalars : callable
        From times (...) [s] to e, shape (..., m), and g, shape (..., l).
    """

    C: np.ndarray | None
    K: np.ndarray
    G: np.ndarray
    P: np.ndarray
    scalars: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]


@dataclass(frozen=True)
class _Series:
    """Power series of the accelerations a = (L + sum_m D_m Z_m)^-1 (R0 + sum_m D_m R_m) z, D_m = diag(e_m).

    z = (q, v, g at the nodes) has 2 n + s l entries.  To the second order in D,
    a = X0 z + Y D W z - Y D Z Y D W z, summed over m, with Y = L^-1, X0 = Y R0 and W_m = R_m - Z_m X0.
    """

    Y: np.ndarray
    Z: np.ndarray
    X0: np.ndarray
    W: np.ndarray

    def accelerations(self, e: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Accelerations at the nodes of N steps, shape (N, s n), for e (m, N, s n) and z (N, 2 n + s l)."""
        first = (e * (z @ np.swapaxes(self.W, 1, 2))).sum(axis=0) @ self.Y.T
        second = (e * (first @ np.swapaxes(self.Z, 1, 2))).sum(axis=0) @ self.Y.T
        return z @ self.X0.T + first - second

    def maps(self, h: float, table: Tableau) -> np.ndarray:
        """Maps from z to (q, v) at the end of a step: factors of 1, e_k and e_k e_l with k, l = (m, node).

        With d = m s such pairs, the shape is (1 + d + d^2, 2 n, :).
        """
        s, size = len(table.c), len(self.Y)
        n = size // s
        nodes = [slice(i * n, (i + 1) * n) for i in range(s)]
        pairs = [(m, i) for m in range(len(self.Z)) for i in nodes]
        ZY = self.Z @ self.Y
        first = [self.Y[:, i] @ self.W[m, i] for m, i in pairs]
        second = [-self.Y[:, i] @ ZY[m, i, j] @ self.W[k, j] for m, i in pairs for k, j in pairs]
        constant = add_drift(increment(self.X0[None], h, table), h, first=0)
        varying = np.array([*first, *second]).reshape(-1, *self.X0.shape)
        return np.concatenate([constant, increment(varying, h, table)])


def _expand_accelerations(system: ModulatedSystem, h: float, table: Tableau) -> _Series:
    """Expand the accelerations of a step of h [s] in powers of the varying stiffness."""
    s, n = len(table.c), len(system.K)
    C = None if system.C is None else np.broadcast_to(system.C, (1, s, n, n))
    L = left_side(C, np.broadcast_to(system.K, (1, s, n, n)), h, table)[0]
    drift = np.stack([np.ones(s), h * table.c], axis=1)  # of q and v in the displacement at the nodes
    R0 = -np.einsum("ix,ab->iaxb", drift, system.K).reshape(s * n, 2 * n)
    if system.C is not None:
        R0[:, n:] -= np.tile(system.C, (s, 1))
    loads = np.einsum("ij,la->iajl", np.eye(s), system.P).reshape(s * n, -1)
    R = -np.einsum("ix,mab->miaxb", drift, system.G).reshape(-1, s * n, 2 * n)
    Y = np.linalg.inv(L)
    Z = h**2 * np.einsum("ij,mab->miajb", table.A2, system.G).reshape(-1, s * n, s * n)
    X0 = Y @ np.concatenate([R0, loads], axis=1)
    W = np.concatenate([R, np.zeros((len(R), *loads.shape))], axis=2) - Z @ X0
    return _Series(Y, Z, X0, W)


def propagate_modulated(
    system: ModulatedSystem,
    t0: float,
    t1: float,
    steps: int,
    q0: np.ndarray,
    v0: np.ndarray,
    stages: int,
    accuracy: float,
) -> Segment | None:
    """Integrate over equal steps, as `beamdyn.transient.gauss.propagate` does, by the power series.

    Parameters
    ----------
    system : ModulatedSystem
        The equations.
    t0, t1, steps, q0, v0, stages
        As for `propagate`.
    accuracy : float
        Largest relative error by the truncation of the series, estimated as rho^3 times the number of
        steps, where rho is the ratio of successive terms.

    Returns
    -------
    Segment or None
        None if the stiffness varies too strongly for the series.
    """
    h, n, table = (t1 - t0) / steps, len(q0), tableau(stages)
    series = _expand_accelerations(system, h, table)
    ratio = np.abs(np.linalg.eigvals(series.Z @ series.Y)).max(axis=1)
    maps = series.maps(h, table).reshape(-1, 2 * n * series.X0.shape[1])
    state, acceleration = np.empty((steps + 1, 2 * n + 1)), np.empty((steps, stages, n))
    state[:, 0], state[0, 1 : n + 1], state[0, n + 1 :] = 1, q0, v0
    for first in range(0, steps, BLOCK):
        block = slice(first, min(first + BLOCK, steps))
        k = np.arange(block.start, block.stop)
        e, g = system.scalars(t0 + h * (k[:, None] + table.c))
        if steps * (ratio * np.abs(e).max(axis=(0, 1))).sum() ** 3 > accuracy:
            return None
        e, g = np.moveaxis(e, 2, 1), g.reshape(len(k), -1)  # e over (step, m, node)
        step = (_monomials(e.reshape(len(k), -1)) @ maps).reshape(len(k), 2 * n, -1)
        constant = step[:, :, 2 * n :] @ g[:, :, None]
        advance(np.concatenate([constant, step[:, :, : 2 * n]], axis=2), state[first : block.stop + 1])
        z = np.concatenate([state[block, 1:], g], axis=1)
        a = series.accelerations(np.repeat(np.moveaxis(e, 1, 0), n, axis=2), z)
        acceleration[block] = a.reshape(len(k), stages, n)
    return Segment(t0, h, state, acceleration)


def _monomials(e: np.ndarray) -> np.ndarray:
    """Monomials 1, e_k and e_k e_l of each row of e (N, d): shape (N, 1 + d + d^2)."""
    return np.concatenate([np.ones((len(e), 1)), e, (e[:, :, None] * e[:, None]).reshape(len(e), -1)], axis=1)
