"""Gauss collocation for the equations of large deflection, which are nonlinear.

As in `beamdyn.transient.gauss`, the unknowns of a step are the accelerations a_i at its s nodes; rates and
coordinates there are v + h sum A_ij a_j and q + c_i h v + h^2 sum A2_ij a_j.  Newton's method solves for them
to rounding, with the derivatives of the equations at all nodes.  The method is symmetric in time and has no
numerical damping, so that energy does not drift.
"""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg.lapack import dgetrf, dgetrs

from beamdyn.equations.root_motion import RootMotion
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.gauss import BLOCK, Segment, Tableau, tableau

_ITERATIONS = 30  # of Newton's method
_CONVERGED = 1e-13  # change of the accelerations over their size: the error left is far smaller
_STALLED = 1e-9  # the same from which on rounding may end the iteration
_FAST = 0.1  # reduction by an iteration with which derivatives are kept


class StepNotSolved(ArithmeticError):
    """A step whose equations Newton's method does not solve."""


def propagate_elastica(
    system: ElasticaSystem,
    t0: float,
    t1: float,
    steps: int,
    q0: np.ndarray,
    v0: np.ndarray,
    stages: int,
    like: Segment | None = None,
) -> Segment:
    """Integrate over equal steps: as `beamdyn.transient.gauss.propagate`.

    Parameters
    ----------
    system : ElasticaSystem
        The equations; smooth between t0 and t1.
    t0, t1 : float
        Beginning and end [s].
    steps : int
        Number of steps.
    q0, v0 : ndarray, shape (n,)
        Coordinates and rates at t0.
    stages : int
        Stages s of each step; the order is 2 s.
    like : Segment, optional
        The same steps with another number of stages, from which the iteration starts.

    Raises
    ------
    StepNotSolved
        If a step is too long.
    """
    h, n = (t1 - t0) / steps, system.size
    step = _Step(system, h, tableau(stages))
    state = np.empty((steps + 1, 2 * n + 1))
    state[:, 0], state[0, 1 : n + 1], state[0, n + 1 :] = 1, q0, v0
    acceleration = np.empty((steps, stages, n))
    known = None if like is None else at_nodes(like.acceleration.shape[1], stages)
    q, v = q0, v0
    for k, root in enumerate(_roots(system, t0, h, steps, step.table)):
        guess = None if like is None or known is None else known @ like.acceleration[k]
        q, v, a = step.advance(root, q, v, guess)
        acceleration[k], state[k + 1, 1 : n + 1], state[k + 1, n + 1 :] = a, q, v
    return Segment(t0, h, state, acceleration)


def at_nodes(given: int, wanted: int) -> np.ndarray:
    """Weights (wanted, given) of the values at the nodes of a rule in those at the nodes of another."""
    x, w = legendre.leggauss(given)
    degrees = np.arange(given)
    series = (2 * degrees[:, None] + 1) / 2 * legendre.legvander(x, given - 1).T * w
    return legendre.legvander(2 * tableau(wanted).c - 1, given - 1) @ series


def _roots(system: ElasticaSystem, t0: float, h: float, steps: int, table: Tableau):
    """Motion of the root at the nodes of each step, computed for blocks of steps."""
    for first in range(0, steps, BLOCK):
        k = np.arange(first, min(first + BLOCK, steps))
        block = system.root(t0 + h * (k[:, None] + table.c))
        values = [getattr(block, f.name) for f in fields(RootMotion)]
        yield from (RootMotion(*each) for each in zip(*values, strict=True))


Factors: TypeAlias = tuple[np.ndarray, np.ndarray]  # of a matrix, and the pivots


@dataclass(frozen=True)
class _Step:
    """Solution of steps of one length and number of stages."""

    system: ElasticaSystem
    h: float
    table: Tableau

    def __post_init__(self) -> None:
        table, h = self.table, self.h
        weights = {
            "to_v": h * table.A,
            "to_q": h**2 * table.A2,
            "end_v": h * table.b,
            "end_q": h**2 * table.b2,
        }
        for name, value in (weights | {"drift": h * table.c[:, None]}).items():
            object.__setattr__(self, name, value)

    def advance(
        self, root: RootMotion, q: np.ndarray, v: np.ndarray, guess: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coordinates and rates at the end of a step, and accelerations at its nodes."""
        s, drift = len(self.table.c), self.drift * v
        still = np.zeros((s, len(q)))
        start = self.system.at(root, still + q, still, still)
        factors = self._factorize(start.stiffness, start.damping, start.mass)
        if guess is None:  # as if the equations were linear about the beginning of the step
            load = start.residual + start.damping @ v + (start.stiffness @ drift[..., None])[..., 0]
            guess = self._divide(factors, -load)
        a = self._solve(root, q + drift, v, guess, factors)
        return q + self.h * v + self.end_q @ a, v + self.end_v @ a, a

    def _solve(
        self, root: RootMotion, drifted: np.ndarray, v: np.ndarray, a: np.ndarray, factors: Factors | None
    ) -> np.ndarray:
        """Solve for the accelerations (s, n) by Newton's method, from some accelerations and derivatives."""
        last = np.inf
        for _ in range(_ITERATIONS):
            now = self.system.at(root, drifted + self.to_q.dot(a), v + self.to_v.dot(a), a)
            if factors is None:
                factors = self._factorize(now.stiffness, now.damping, now.mass)
            residual = now.residual
            change = self._divide(factors, residual)
            a = a - change
            size, scale = np.abs(change).max(), np.abs(a).max() + np.abs(residual).max()
            if size <= _CONVERGED * scale or last * _FAST < size <= _STALLED * scale:
                return a
            if not np.isfinite(size):
                break
            if size > _FAST * last:
                factors = None
            last = size
        raise StepNotSolved("the equations of a step were not solved: take shorter steps")

    def _factorize(self, stiffness: np.ndarray, damping: np.ndarray, mass: np.ndarray) -> Factors:
        """LU factors of the derivative of all residuals of a step by all accelerations."""
        s, n, _ = mass.shape
        matrix = self.to_q[:, None, :, None] * stiffness[:, :, None]
        matrix += self.to_v[:, None, :, None] * damping[:, :, None]
        index = np.arange(s)
        matrix[index, :, index] += mass
        lu, pivots, _ = dgetrf(matrix.reshape(s * n, s * n))
        return lu, pivots

    @staticmethod
    def _divide(factors: Factors, residual: np.ndarray) -> np.ndarray:
        return dgetrs(*factors, residual.ravel())[0].reshape(residual.shape)
