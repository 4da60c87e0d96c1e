"""Gauss collocation for the equations of large deflection, which are nonlinear.

As in `beamdyn.transient.gauss`, the unknowns of a step are the accelerations a_i at its s nodes; rates and
coordinates there are v + h sum A_ij a_j and q + c_i h v + h^2 sum A2_ij a_j.  Newton's method solves for them
to rounding, with the derivatives of the equations at all nodes.  The method is symmetric in time and has no
numerical damping, so that energy does not drift.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple, TypeAlias

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg.lapack import dgetrf, dgetrs

from beamdyn.transient.elastica_system import Drive, ElasticaSystem, Evaluation
from beamdyn.transient.gauss import BLOCK, Segment, Tableau, allocate_steps, tableau

_ITERATIONS = 30  # iterations of Newton's method
_CONVERGED = 1e-13  # error of the accelerations, over their size, with which the iteration ends
_LEAST_REDUCTION = 1e-3  # least ratio of errors by an iteration that the last two changes may show
_STALLED = 1e-9  # error of the accelerations over their size below which a stalled iteration has converged
_BALANCED = 1e-12  # the same for the residual over the elastic force, where accelerations are small beside it
_FAST = 0.1  # reduction by an iteration up to which the derivatives are kept
_FEW = 4  # number of iterations up to which the next step begins with the same derivatives


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
        Steps with another number of stages, from which the iteration starts.

    Raises
    ------
    StepNotSolved
        If a step is too long.
    """
    h, n = (t1 - t0) / steps, system.size
    step = _Step(system, h, tableau(stages))
    state, acceleration = allocate_steps(steps, stages, q0, v0)
    known = None if like is None else at_nodes(like.acceleration.shape[1], stages)
    q, v = q0, v0
    with np.errstate(over="ignore", invalid="ignore"):  # a step that is too long overflows, and is refused
        for k, drive in enumerate(_drives(system, t0, h, steps, step.table)):
            guess = None if like is None or known is None else known @ like.acceleration[k]
            q, v, a = step.advance(drive, q, v, guess)
            acceleration[k], state[k + 1, 1 : n + 1], state[k + 1, n + 1 :] = a, q, v
    return Segment(t0, h, state, acceleration)


def at_nodes(given: int, wanted: int) -> np.ndarray:
    """Matrix (wanted, given) from values at the nodes of one Gauss rule to those at the nodes of another."""
    x, w = legendre.leggauss(given)
    degrees = np.arange(given)
    series = (2 * degrees[:, None] + 1) / 2 * legendre.legvander(x, given - 1).T * w
    return legendre.legvander(2 * tableau(wanted).c - 1, given - 1) @ series


def _drives(system: ElasticaSystem, t0: float, h: float, steps: int, table: Tableau) -> Iterator[Drive]:
    """Motion of the root at the nodes of each step, computed for blocks of steps."""
    for first in range(0, steps, BLOCK):
        k = np.arange(first, min(first + BLOCK, steps))
        block = system.drive(system.root(t0 + h * (k[:, None] + table.c)))
        yield from (Drive(*each) for each in zip(*block, strict=True))


Factors: TypeAlias = tuple[np.ndarray, np.ndarray]  # factors of a matrix, and the pivots


class Tangent(NamedTuple):
    """Derivatives of the equations by coordinates and rates (1, n, n), and the factors of a step's matrix."""

    stiffness: np.ndarray
    damping: np.ndarray
    factors: Factors


class _Step:
    """Solution of steps of one length h [s] and one number of stages."""

    def __init__(self, system: ElasticaSystem, h: float, table: Tableau) -> None:
        self.system, self.h, self.table = system, h, table
        self.drift, self.to_v, self.to_q = h * table.c[:, None], h * table.A, h**2 * table.A2
        self.to_motion = np.concatenate([self.to_q, self.to_v, np.eye(len(table.c))])
        self.end_v, self.end_q = h * table.b, h**2 * table.b2
        self.tangent: Tangent | None = None

    def advance(
        self, drive: Drive, q: np.ndarray, v: np.ndarray, guess: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Coordinates and rates at the end of a step, and accelerations at its nodes."""
        drift = self.drift * v
        if self.tangent is None:
            self.tangent = self._tangent_at(drive, q)
        if guess is None:
            guess = self._guess(drive, q, v, drift)
        a = self._solve(drive, q + drift, v, guess)
        return q + self.h * v + self.end_q @ a, v + self.end_v @ a, a

    def _tangent_at(self, drive: Drive, q: np.ndarray) -> Tangent:
        """Derivatives at rest in some coordinates (n,), the same for all nodes of a step."""
        still = np.zeros((1, len(q)))
        here = self.system.at(drive.node(len(self.table.c) // 2), q[None], still, still)
        return Tangent(here.stiffness, here.damping, self._factorize(here))

    def _guess(self, drive: Drive, q: np.ndarray, v: np.ndarray, drift: np.ndarray) -> np.ndarray:
        """Accelerations (s, n) as if the equations were linear about the beginning of the step."""
        assert self.tangent is not None
        still = np.zeros((len(self.table.c), len(q)))
        load = self.system.at(drive, still + q, still, still).residual
        load += self.tangent.damping[0] @ v + drift @ self.tangent.stiffness[0].T
        return -_divide(self.tangent.factors, load)

    def _solve(self, drive: Drive, drifted: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Solve for the accelerations (s, n) by Newton's method; the tangent is kept while it serves."""
        assert self.tangent is not None
        factors: Factors | None = self.tangent.factors
        start, last = np.stack([drifted, np.broadcast_to(v, a.shape), np.zeros_like(a)]), np.inf
        for iteration in range(_ITERATIONS):
            now = Evaluation(self.system, drive, start + self.to_motion.dot(a).reshape(start.shape))
            factors = factors or self._factorize(now)
            residual = now.residual
            change = _divide(factors, residual)
            a = a - change
            size, scale = _norm(change), _norm(a) + _norm(residual)
            reduction = max(size / last, _LEAST_REDUCTION) if last else 1.0
            is_stalled = last * _FAST < size and (
                size <= _STALLED * scale or _norm(residual) <= _BALANCED * _norm(now.elastic)
            )
            if is_stalled or size * min(1.0, reduction) <= _CONVERGED * scale:
                if iteration > _FEW:
                    self.tangent = None
                return a
            if not math.isfinite(size):
                break
            if size > _FAST * last:
                factors = None
            last = size
        raise StepNotSolved("the equations of a step were not solved: take shorter steps")

    def _factorize(self, now: Evaluation) -> Factors:
        """LU factors of the derivative of all residuals of a step by all accelerations."""
        s, n = len(self.table.c), self.system.size
        matrix = self.to_q[:, None, :, None] * now.stiffness[:, :, None]
        matrix += self.to_v[:, None, :, None] * now.damping[:, :, None]
        index = np.arange(s)
        matrix[index, :, index] += now.mass
        lu, pivots, _ = dgetrf(matrix.reshape(s * n, s * n))
        return lu, pivots


def _norm(values: np.ndarray) -> float:
    flat = values.ravel()
    return math.sqrt(flat.dot(flat))


def _divide(factors: Factors, residual: np.ndarray) -> np.ndarray:
    return dgetrs(*factors, residual.ravel())[0].reshape(residual.shape)
