"""Time integrators for linear second-order systems q'' + C(t) q' + K(t) q = f(t).

Gauss collocation: of order 2 s with s stages, symmetric, without numerical damping (quadratic
invariants are kept), stable at any step size.  Since the system is linear, the steps of a block are
assembled and solved as one batch of affine maps, and only the product of the maps with the state
is sequential.  `propagate` integrates in equal steps.

In shapes of arrays, n counts coordinates, N steps, m columns of the maps, and d outputs.

References
----------
Hairer, Lubich, Wanner, Geometric Numerical Integration, 2006, sections II.1.3 and IV.2.1.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cache
from typing import Protocol

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.inputs.checks import MOST

BLOCK = 64  # number of steps solved as one batch, so that the matrices fit the processor's cache


class LinearSystem(Protocol):
    """Linear equations q'' + C(t) q' + K(t) q = f(t) with n coordinates."""

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        ...

    def coefficients(self, t: np.ndarray) -> tuple[np.ndarray | None, np.ndarray, np.ndarray]:
        """Evaluate damping C (None if zero), stiffness K and load f at times t [s] of any shape.

        The axes of t precede those of the matrices and of the load.
        """
        ...


@dataclass(frozen=True)
class Tableau:
    """Coefficients of Gauss collocation on [0, 1], for accelerations at the nodes.

    Parameters
    ----------
    c : ndarray, shape (s,)
        Nodes.
    b, A : ndarray, shape (s,) and (s, s)
        Weights of the accelerations in the velocity at the end of the step and at the nodes.
    integrals : ndarray, shape (s + 1, s)
        Legendre coefficients on [0, 1] of the integrals of the nodes' Lagrange polynomials, for
        dense output.
    """

    c: np.ndarray
    b: np.ndarray
    A: np.ndarray
    integrals: np.ndarray

    @property
    def A2(self) -> np.ndarray:
        """Weights A2 of the accelerations in the displacement at the nodes, shape (s, s).

        The square of A integrates the velocity's values at the nodes.  Integrating the polynomial of
        the acceleration twice instead would lose the A-stability of the first-order collocation.
        """
        return self.A @ self.A

    @property
    def b2(self) -> np.ndarray:
        """Weights of the accelerations in the displacement at the end of the step."""
        return self.b @ self.A


@cache
def tableau(stages: int) -> Tableau:
    """Compute the tableau from Legendre series, which need no ill-conditioned Vandermonde matrix."""
    x, w = legendre.leggauss(stages)
    k = np.arange(stages)
    nodal = ((2 * k + 1) / 2)[:, None] * (legendre.legvander(x, stages - 1) * w[:, None]).T
    integrals = legendre.legint(nodal, lbnd=-1, scl=0.5)
    b, A = (legendre.legvander(p, stages) @ integrals for p in (np.ones(1), x))
    return Tableau(c=(x + 1) / 2, b=b[0], A=A, integrals=integrals)


@dataclass(frozen=True)
class StepMaps:
    """Affine maps of a block of N steps, on the augmented state (1, q, v) of length 2 n + 1.

    Parameters
    ----------
    step : ndarray, shape (N, 2 n, 2 n + 1)
        Maps from the state at the beginning to (q, v) at the end of the step.
    acceleration : ndarray, shape (N, s, n, 2 n + 1)
        Maps from the state at the beginning to the accelerations at the nodes.
    step_extended : ndarray of longdouble, shape (2 n, 2 n + 1), optional
        Map to the end of every step, in extended precision, if all steps are equal.
    """

    step: np.ndarray
    acceleration: np.ndarray
    step_extended: np.ndarray | None = None


def step_maps(system: LinearSystem, starts: np.ndarray, h: float, table: Tableau) -> StepMaps:
    """Solve the collocation equations of N steps.

    Parameters
    ----------
    system : LinearSystem
        The equations.
    starts : ndarray, shape (N,)
        Beginnings of the steps [s].
    h : float
        Step size [s].
    table : Tableau
        Coefficients of the collocation.

    Returns
    -------
    StepMaps
    """
    return solve_steps(*system.coefficients(starts[:, None] + h * table.c), h, table)


def solve_steps(C: np.ndarray | None, K: np.ndarray, f: np.ndarray, h: float, table: Tableau) -> StepMaps:
    """Solve the collocation equations of N steps, given the coefficients at their nodes.

    The accelerations a_i at the nodes satisfy
    a_i + C_i (v + h sum A_ij a_j) + K_i (q + c_i h v + h^2 sum A2_ij a_j) = f_i.

    Parameters
    ----------
    C : ndarray, shape (N, s, n, n), or None
        Damping; None if there is none.
    K : ndarray, shape (N, s, n, n)
        Stiffness.
    f : ndarray, shape (N, s, n)
        Loads.
    h : float
        Step size [s].
    table : Tableau
        Coefficients of the collocation.

    Returns
    -------
    StepMaps
    """
    equal = len(f) > 1 and all(x is None or (x == x[:1, :1]).all() for x in (C, K, f))
    count, some = len(f), slice(1 if equal else None)
    C, K, f = None if C is None else C[some], K[some], f[some]
    matrix, right = left_side(C, K, h, table), right_side(C, K, f, h, table)
    a = np.linalg.solve(matrix, right)
    if not equal:
        return StepMaps(_maps_to_end(a, h, table), a.reshape(*f.shape, -1))
    # Powers of the map magnify its errors, so the solution is refined by iteration.
    a = a.astype(np.longdouble)
    for _ in range(2):
        a += np.linalg.solve(matrix, (right - matrix.astype(np.longdouble) @ a).astype(float))
    step, acceleration = _maps_to_end(a, h, table)[0], a.astype(float).reshape(*f.shape, -1)
    return StepMaps(
        np.broadcast_to(step.astype(float), (count, *step.shape)),
        np.broadcast_to(acceleration, (count, *acceleration.shape[1:])),
        step_extended=step,
    )


def _maps_to_end(a: np.ndarray, h: float, table: Tableau) -> np.ndarray:
    """Compute the maps from the state at the start of each step to that at its end.

    `a` are the maps from the state at the start to the accelerations at the nodes.
    """
    return add_drift(increment(a, h, table), h, first=1)


def increment(a: np.ndarray, h: float, table: Tableau) -> np.ndarray:
    """Compute the increments of coordinates and velocities over N steps by the accelerations at the nodes.

    `a` has the maps from some vector, such as the state at the start, to the accelerations at the nodes of
    each step, (N, s n, columns); the result has the maps from this vector to the increments, (N, 2 n,
    columns).
    """
    N, rows, columns = a.shape
    weights = np.stack([h**2 * table.b2, h * table.b])
    n = rows // len(table.c)
    return (weights @ a.reshape(N, len(table.c), n * columns)).reshape(N, 2 * n, columns)


def add_drift(step: np.ndarray, h: float, first: int) -> np.ndarray:
    """Add the motion without acceleration to maps from the start of each step to (q, v) at its end.

    Without acceleration, the coordinates at the end are q + h v, and the velocities v.  The maps `step`,
    (N, 2 n, columns), are changed in place; their columns for the q and then the v at the start begin at the
    index `first`.
    """
    n = step.shape[1] // 2
    step[:, np.arange(2 * n), first + np.arange(2 * n)] += 1
    step[:, np.arange(n), first + n + np.arange(n)] += h
    return step


def left_side(C: np.ndarray | None, K: np.ndarray, h: float, table: Tableau) -> np.ndarray:
    """Build the matrices (N, s n, s n) of the collocation equations for the accelerations at the nodes."""
    N, s, n, _ = K.shape
    matrix = np.empty((N, s, n, s, n))
    np.multiply((h**2 * table.A2)[:, None, :, None], K[:, :, :, None, :], out=matrix)
    if C is not None:
        matrix += (h * table.A)[:, None, :, None] * C[:, :, :, None, :]
    matrix = matrix.reshape(N, s * n, s * n)
    matrix[:, np.arange(s * n), np.arange(s * n)] += 1
    return matrix


def right_side(C: np.ndarray | None, K: np.ndarray, f: np.ndarray, h: float, table: Tableau) -> np.ndarray:
    """Build the matrices (N, s n, 2 n + 1) from (1, q, v) to the collocation equations' right-hand sides."""
    N, s, n = f.shape
    right = np.empty((N, s, n, 2 * n + 1))
    right[..., 0] = f
    np.negative(K, out=right[..., 1 : n + 1])
    np.multiply(-h * table.c[:, None, None], K, out=right[..., n + 1 :])
    if C is not None:
        right[..., n + 1 :] -= C
    return right.reshape(N, s * n, 2 * n + 1)


def components(q: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Evaluate linear functions of coordinates q (last axis); rows of `outputs` are their coefficients."""
    return np.stack([q @ output for output in outputs], axis=-1)


def project(state: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Replace q and v of augmented states by linear functions of them, with coefficients `outputs` (rows)."""
    n = outputs.shape[1]
    q, v = state[..., 1 : n + 1], state[..., n + 1 :]
    return np.concatenate([state[..., :1], components(q, outputs), components(v, outputs)], axis=-1)


@dataclass(frozen=True)
class Segment:
    """Segment of a trajectory, computed in equal steps.

    Parameters
    ----------
    start, h : float
        Beginning and step size [s].
    state : ndarray, shape (N + 1, 2 n + 1)
        Augmented states (1, q, v) at the ends of the steps.
    acceleration : ndarray, shape (N, s, n)
        Accelerations at the nodes of each step.
    """

    start: float
    h: float
    state: np.ndarray
    acceleration: np.ndarray

    @property
    def end(self) -> float:
        """Time at the end of the segment [s]."""
        return self.start + self.h * len(self.acceleration)

    def projected(self, outputs: np.ndarray) -> Segment:
        """Replace the n coordinates by d linear functions of them with coefficients `outputs` (d, n)."""
        return replace(
            self, state=project(self.state, outputs), acceleration=components(self.acceleration, outputs)
        )

    def samples(self, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Sample times, displacements, velocities at the beginnings of `count` equal parts of each step."""
        theta = np.arange(count) / count
        q, v = interpolate(self.h, self.state[:-1], self.acceleration, theta)
        t = self.start + self.h * (np.arange(len(q))[:, None] + theta)
        return t.ravel(), q.reshape(t.size, -1), v.reshape(t.size, -1)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Interpolate displacement and velocity at times t [s]: shape (len(t), n)."""
        x = (np.asarray(t, dtype=float) - self.start) / self.h
        k = np.clip(x.astype(int), 0, len(self.acceleration) - 1)
        return interpolate_each(self.h, self.state[k], self.acceleration[k], x - k)


def interpolate_each(
    h: float | np.ndarray, state: np.ndarray, acceleration: np.ndarray, theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Interpolate displacement and velocity at one fraction `theta` of each of k steps: (k, coordinates)."""
    _, s, n = acceleration.shape
    table = tableau(s)
    weights = legendre.legvander(2 * theta - 1, s) @ table.integrals
    q, v = state[:, 1 : n + 1], state[:, n + 1 :]
    dq, dv = (np.einsum("tj,tjn->tn", w, acceleration) for w in (weights @ table.A, weights))
    h = np.broadcast_to(h, theta.shape)[:, None]
    return q + theta[:, None] * h * v + h**2 * dq, v + h * dv


def interpolate(
    h: float | np.ndarray, state: np.ndarray, acceleration: np.ndarray, theta: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Interpolate displacement and velocity at the same fractions of every step.

    Parameters
    ----------
    h : float or ndarray, shape (N, 1, 1)
        One step size, or the size of each step [s].
    state : ndarray, shape (N, 2 n + 1)
        Augmented states at the beginnings of the steps.
    acceleration : ndarray, shape (N, s, n)
        Accelerations at the nodes of the steps.
    theta : ndarray, shape (k,)
        Fractions of a step.

    Returns
    -------
    q, v : ndarray, shape (N, k, n)
    """
    _, s, n = acceleration.shape
    table = tableau(s)
    weights = legendre.legvander(2 * theta - 1, s) @ table.integrals
    q, v = state[:, None, 1 : n + 1], state[:, None, n + 1 :]
    both = weights @ table.A, weights
    if n > 1:
        dq, dv = (each @ acceleration for each in both)
    else:  # for one coordinate, a single matrix product suffices
        dq, dv = ((acceleration[:, :, 0] @ each.T)[:, :, None] for each in both)
    return q + h * theta[:, None] * v + h**2 * dq, v + h * dv


def propagate(
    system: LinearSystem, t0: float, t1: float, steps: int, q0: np.ndarray, v0: np.ndarray, stages: int = 8
) -> Segment:
    """Integrate over equal steps by Gauss collocation.

    Parameters
    ----------
    system : LinearSystem
        The equations; smooth between t0 and t1.
    t0, t1 : float
        Beginning and end [s].
    steps : int
        Number of steps.
    q0, v0 : ndarray, shape (n,)
        Displacement and velocity at t0.
    stages : int
        Stages s of each step; the order is 2 s.

    Returns
    -------
    Segment
    """
    h, powers = (t1 - t0) / steps, None
    state, acceleration = allocate_steps(steps, stages, q0, v0)
    for first in range(0, steps, BLOCK):
        block = slice(first, min(first + BLOCK, steps))
        maps = step_maps(system, t0 + h * np.arange(block.start, block.stop), h, tableau(stages))
        with np.errstate(over="ignore", invalid="ignore"):
            powers = _advance_block(maps, state[block.start : block.stop + 1], powers)
        if not (np.abs(state[block.stop]) < MOST).all():
            raise growth_without_bound(f"to states past {MOST:g} before t = {t0 + h * block.stop:.4g} s")
        acceleration[block] = (maps.acceleration @ state[block, None, :, None])[..., 0]
    return Segment(t0, h, state, acceleration)


def growth_without_bound(how_far: str) -> ArithmeticError:
    """Build the error for a motion that grows without bound; `how_far` states how far it has grown."""
    return ArithmeticError(
        f"the motion grows without bound, {how_far}: the beam buckles under its weight, or it is "
        "parametrically unstable, and linear theory does not hold; lower gravity or the speed, or end the "
        "run earlier"
    )


def _advance_block(maps: StepMaps, state: np.ndarray, powers: np.ndarray | None) -> np.ndarray | None:
    """Compute the states state[1:] of a block of steps from state[0], in place.

    Equal steps use the powers of one map.  They are taken from `powers` if these fit, and returned for the
    next block; None is returned for unequal steps.
    """
    if maps.step_extended is not None:
        if powers is None or len(powers) < len(maps.step) or (powers[0] != maps.step[0]).any():
            # Powers of the map cause one rounding error per block, instead of one per step.
            full = np.eye(state.shape[1], dtype=np.longdouble)
            full[1:] = maps.step_extended
            power, rows = full, []
            for _ in maps.step:
                rows.append(power[1:])
                power = full @ power
            powers = np.array(rows, dtype=float)
        state[1:, 1:] = powers[: len(maps.step)] @ state[0]
        return powers
    advance(maps.step, state)
    return None


def advance(steps: np.ndarray, state: np.ndarray) -> None:
    """Compute the augmented states state[1:] from state[0] by applying affine maps one after the other."""
    for step, before, after in zip(steps, state[:-1], state[1:, 1:], strict=True):
        step.dot(before, out=after)


def allocate_steps(steps: int, stages: int, q0: np.ndarray, v0: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Allocate `state` and `acceleration` of a segment, with the first state filled in."""
    n = len(q0)
    state = np.empty((steps + 1, 2 * n + 1))
    state[:, 0], state[0, 1 : n + 1], state[0, n + 1 :] = 1, q0, v0
    return state, np.empty((steps, stages, n))
