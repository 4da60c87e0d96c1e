"""Time steps for beams with large deflection, whose equations are nonlinear, by Gauss collocation.

As in `beamdyn.transient.gauss`, the unknowns of a step are the accelerations a_i at its s nodes; rates and
coordinates there are v + h sum A_ij a_j and q + c_i h v + h^2 sum A2_ij a_j.  Newton's method solves for them
to rounding, with the derivatives of the equations at all nodes.  The method is symmetric in time and has no
numerical damping, so that energy does not drift.

A second run uses the same steps with two more stages, so that its order is higher by four.  The difference
between the runs is the accumulated error of the first.  The second run is the result; its own error is far
smaller.

In shapes of arrays, n counts coordinates, N steps, and s nodes in each.
"""

from __future__ import annotations

import math
from functools import partial
from itertools import pairwise
from typing import TypeAlias

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg.lapack import dgetrf, dgetrs

from beamdyn.common.numerics import gauss_rule, legendre_series
from beamdyn.equations.beam_in_space.moving_beam import Carrier
from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem
from beamdyn.transient.gauss import BLOCK, Segment, Tableau, allocate_steps, interpolate, step_maps, tableau
from beamdyn.transient.record_steps import smooth_piece_ends
from beamdyn.transient.step_size import (
    TOLERANCES,
    Attempt,
    StepSize,
    chain_segments,
    check_number_of_steps,
    split_at_breakpoints,
)
from beamdyn.transient.time_error import (
    INTERPOLATION_POINTS,
    STAGES,
    UNRESOLVED_PHASE,
    TimeError,
    phase_errors,
    vibration_frequencies,
)
from beamdyn.transient.trajectory import Trajectory

_ITERATIONS = 30  # largest number of iterations of Newton's method in a step
_CONVERGED = 1e-13  # relative error of the accelerations at which the iteration ends
_LEAST_REDUCTION = 1e-3  # smallest ratio of successive errors with which the next error is predicted
_STALLED = 1e-9  # relative error of the accelerations below which a stalled iteration has converged
# Ratio of residual to elastic force below which a stalled iteration has converged, if accelerations are
# small.
_BALANCED = 1e-12
_FAST = 0.1  # ratio of successive errors up to which the Jacobian is reused
_FEW = 4  # number of iterations up to which the next step starts with the same Jacobian
_FINER = STAGES + 2  # number of stages of the second run
_BALANCE = 1e-13  # largest residual, over the largest force or coordinate, that counts as rounding error
_TIMES_COMPARED = 257  # number of times at which the equilibrium of forces is checked
_SHORTER = 0.5  # factor by which all steps are shortened after a step that was not solved
# Phase angle per step of the fastest resolved mode [rad] below which steps are not shortened any further
# after a step that was not solved; one more mode is resolved instead.
_SHORT = 1.0
# Number of smooth pieces of a motion, such as a sampled one, above which no piece is divided further.
_MANY = 64
_CHECKED = 48  # number of steps of a segment at which the interpolation error is estimated


def rest_in_equilibrium(system: BeamInSpaceSystem, y0: np.ndarray, t_end: float) -> Trajectory | None:
    """Build the motion of a beam that stays at rest, if its forces are in equilibrium at all times.

    Return None if they are not.
    """
    q, v = np.split(y0[None], 2, axis=1)
    if system.motion.steady_start > 0 or v.any():
        return None
    still = np.zeros((_TIMES_COMPARED, system.size))
    # Times are unevenly spaced, so that they do not coincide with any period of the forces.
    carrier = system.carrier(system.root(t_end * np.sqrt(np.linspace(0, 1, len(still)))))
    force = system.residual(carrier, q, still, still)
    stiffness, size = np.abs(system.elastica.beam.stiffness), np.abs(q[0])
    # Rounding errors of the coordinates in equilibrium cause a residual force, which is large in a stiff
    # mode.
    if (np.abs(force) > _BALANCE * ((stiffness @ size).max() + np.diag(stiffness) * size.max())).any():
        return None
    state = np.tile(np.append(1.0, y0), (2, 1))
    return Trajectory((Segment(0.0, t_end, state, np.zeros((1, _FINER, system.size))),))


def attempt_elastica(
    system: BeamInSpaceSystem, y0: np.ndarray, t_end: float, step_size: StepSize, _: Attempt | None = None
) -> Attempt:
    """Integrate twice with equal steps in each segment, with 8 and 10 stages.

    Steps in which Newton's method failed are shortened, if necessary until they resolve the vibration of all
    coordinates.  The last argument, an earlier attempt, is not used.
    """
    pieces = smooth_piece_ends(system.motion, t_end)
    edges = pieces if len(pieces) > _MANY else split_at_breakpoints(system.motion, t_end)
    steps = [step_size.count_steps(system.straight, a, b) for a, b in pairwise(edges)]
    check_number_of_steps(sum(steps), system.size, t_end)

    def run(stages: int, like: tuple[Segment, ...] = ()) -> tuple[Segment, ...]:
        known = iter(like)
        one = partial(propagate_elastica, system, stages=stages)
        return chain_segments(edges, steps, y0, lambda *step: one(*step, like=next(known, None)))

    try:
        coarse = run(STAGES)
        fine = run(_FINER, coarse)
    except StepNotSolved:
        if step_size.is_finest:
            raise
        shorter = StepSize(step_size.phase * _SHORTER, step_size.modes)
        if step_size.phase < _SHORT and step_size.modes < system.size:
            shorter = StepSize(StepSize.from_tolerance(TOLERANCES[1]).phase, step_size.modes + 1)
        return attempt_elastica(system, y0, t_end, shorter)
    method = f"Gauss collocation of order {2 * _FINER}, {sum(steps)} steps"
    largest = max(float(np.abs(_tips(system, segment)).max()) for segment in fine)
    return Attempt(step_size, Trajectory(fine), _error(system, coarse, fine), largest, method)


def _tips(system: BeamInSpaceSystem, segment: Segment) -> np.ndarray:
    """Compute tip deflections (k, planes) [m] at the ends of the steps of a segment."""
    return system.deflections(segment.state[:, 1 : system.size + 1])


def _error(system: BeamInSpaceSystem, coarse: tuple[Segment, ...], fine: tuple[Segment, ...]) -> TimeError:
    """Estimate the error of the tip deflection, and the contribution of each coordinate to it.

    The error is the distance of the run `coarse` from the run `fine`, which has the same steps but more
    stages.
    """
    straight, pairs = system.straight, [*zip(coarse, fine, strict=True)]
    change = np.max([np.abs(a.state - b.state).max(axis=0) for a, b in pairs], axis=0)[1 : system.size + 1]
    change *= np.abs(system.equations.tips).max(axis=0)
    tip = max(float(np.abs(_tips(system, a) - _tips(system, b)).max()) for a, b in pairs)
    modes = tip * change / max(change.sum(), 1e-300)
    # The phase errors are computed for the straight beam and the longest step.
    longest = max(fine, key=lambda segment: segment.h)
    starts = np.array([(longest.start + longest.end - longest.h) / 2])
    maps, finer = (step_maps(straight, starts, longest.h, tableau(s)).step for s in (STAGES, _FINER))
    phases = phase_errors(finer - maps, vibration_frequencies(straight, longest.end))
    interpolation = max(_interpolation_error(system, s) for s in fine[:: 1 + len(fine) // _MANY])
    return TimeError.of_coordinates(straight, modes, interpolation, phases > UNRESOLVED_PHASE)


def _interpolation_error(system: BeamInSpaceSystem, segment: Segment) -> float:
    """Estimate the largest interpolation error of the tip deflection [m], by steps with more stages."""
    error, h = 0.0, segment.h
    for k in np.unique(np.linspace(0, len(segment.acceleration) - 1, _CHECKED).astype(int)):
        state, acceleration = segment.state[k : k + 2], segment.acceleration[k : k + 1]
        here = Segment(segment.start + k * h, h, state, acceleration)
        q, v = np.split(state[0, 1:], 2)
        finer = propagate_elastica(system, here.start, here.end, 1, q, v, _FINER + 2, here)
        at = [interpolate(s.h, s.state[:-1], s.acceleration, INTERPOLATION_POINTS)[0] for s in (here, finer)]
        error = max(error, float(np.abs(np.subtract(*map(system.deflections, at))).max()))
    return error


# Steps --------------------------------------------------------------------------------------------


class StepNotSolved(ArithmeticError):
    """Raised when Newton's method cannot solve the equations of a time step."""


def propagate_elastica(
    system: BeamInSpaceSystem,
    t0: float,
    t1: float,
    steps: int,
    q0: np.ndarray,
    v0: np.ndarray,
    stages: int,
    like: Segment | None = None,
) -> Segment:
    """Integrate the nonlinear equations of a beam with large deflection over equal steps.

    The corresponding function for linear equations is `beamdyn.transient.gauss.propagate`.

    Parameters
    ----------
    system : BeamInSpaceSystem
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
        If a step is too long for Newton's method to converge.
    """
    h, n = (t1 - t0) / steps, system.size
    step = _Step(system, h, tableau(stages))
    state, acceleration = allocate_steps(steps, stages, q0, v0)
    guesses = [None] * steps if like is None else _at_nodes(stages, like.acceleration)
    q, v = q0, v0
    # A step that is too long overflows, and is then reported as not solved.
    with np.errstate(over="ignore", invalid="ignore"):
        for first in range(0, steps, BLOCK):
            some = np.arange(first, min(first + BLOCK, steps))
            motion = system.carrier(system.root(t0 + h * (some[:, None] + step.table.c)))
            for k in some.tolist():
                q, v, a = step.advance(motion.at(k - first), q, v, guesses[k])
                acceleration[k], state[k + 1, 1 : n + 1], state[k + 1, n + 1 :] = a, q, v
    return Segment(t0, h, state, acceleration)


def _at_nodes(stages: int, values: np.ndarray) -> np.ndarray:
    """Interpolate values (steps, nodes, coordinates) from their Gauss nodes to `stages` Gauss nodes."""
    given = values.shape[1]
    return legendre.legvander(gauss_rule(stages)[0], given - 1) @ legendre_series(given) @ values


Factors: TypeAlias = tuple[np.ndarray, np.ndarray]  # LU factors of a matrix, and pivots


class _Step:
    """Solver for time steps of one length h [s] and one number of stages."""

    def __init__(self, system: BeamInSpaceSystem, h: float, table: Tableau) -> None:
        self.system, self.h, self.table = system, h, table
        self.drift, self.end_v, self.end_q = h * table.c[:, None], h * table.b, h**2 * table.b2
        self.to_motion = np.concatenate([h**2 * table.A2, h * table.A, np.eye(len(table.c))])
        # Derivatives of the residual with respect to q, q', q'' (3, n, n), and LU factors, to be reused.
        self.kept: tuple[np.ndarray, Factors] | None = None

    def advance(
        self, carrier: Carrier, q: np.ndarray, v: np.ndarray, guess: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute coordinates and rates at the end of a step, and accelerations at its nodes.

        `carrier` is the motion of the carrier at the nodes; q and v are the coordinates and rates at the
        start of the step.  Newton's method starts with the accelerations `guess`; for None they are estimated
        from the equations linearized at the start of the step.
        """
        drift, middle = self.drift * v, len(self.table.c) // 2
        still = np.zeros_like(drift)
        if self.kept is None:  # the Jacobian of the beam at rest in these coordinates serves all nodes
            here = carrier.at(slice(middle, middle + 1)), q[None], still[:1], still[:1]
            tangents = self.system.tangents(*here, self.system.residual(*here))
            self.kept = tangents[:, 0], self._factorize(tangents)
        (stiffness, damping, _), factors = self.kept
        if guess is None:  # initial guess from the equations linearized about the state at the step's start
            load = self.system.residual(carrier, still + q, still, still)
            guess = -_divide(factors, load + damping @ v + drift @ stiffness.T)
        a = self._solve(carrier, q + drift, v, guess, factors)
        return q + self.h * v + self.end_q @ a, v + self.end_v @ a, a

    def _solve(
        self, carrier: Carrier, drifted: np.ndarray, v: np.ndarray, a: np.ndarray, factors: Factors | None
    ) -> np.ndarray:
        """Solve for accelerations at the nodes by Newton's method, from a guess a.

        The LU factors of the Jacobian are reused as long as the method converges fast.  `drifted` are the
        coordinates at the nodes for zero acceleration, v the velocities at the start of the step.
        """
        start, last = np.stack([drifted, np.broadcast_to(v, a.shape), np.zeros_like(a)]), np.inf
        for iteration in range(_ITERATIONS):
            motion = start + self.to_motion.dot(a).reshape(start.shape)
            residual = self.system.residual(carrier, *motion)
            factors = factors or self._factorize(self.system.tangents(carrier, *motion, residual))
            change = _divide(factors, residual)
            a = a - change
            size, scale = _norm(change), _norm(a) + _norm(residual)
            reduction = max(size / last, _LEAST_REDUCTION) if last else 1.0
            is_stalled = last * _FAST < size and (
                size <= _STALLED * scale or self._balances(residual, motion)
            )
            if is_stalled or size * min(1.0, reduction) <= _CONVERGED * scale:
                if iteration > _FEW:
                    self.kept = None
                return a
            if not math.isfinite(size):
                break
            if size > _FAST * last:
                factors = None
            last = size
        raise StepNotSolved("Newton's method did not converge in a time step: take shorter steps")

    def _balances(self, residual: np.ndarray, motion: np.ndarray) -> bool:
        """Return whether a residual is only rounding error of the elastic forces."""
        return _norm(residual) <= _BALANCED * _norm(motion[0] @ self.system.elastica.beam.stiffness)

    def _factorize(self, tangents: np.ndarray) -> Factors:
        """Compute LU factors of the Jacobian of all residuals of a step with respect to all accelerations."""
        s, n = len(self.table.c), self.system.size
        matrix = (self.to_motion.reshape(3, s, 1, s, 1) * tangents[:, :, :, None]).sum(axis=0)
        return dgetrf(matrix.reshape(s * n, s * n))[:2]


def _norm(values: np.ndarray) -> float:
    """Compute the Euclidean norm of all elements of an array."""
    flat = values.ravel()
    return math.sqrt(flat.dot(flat))


def _divide(factors: Factors, residual: np.ndarray) -> np.ndarray:
    """Solve a linear system for accelerations by the LU factors of its matrix."""
    return dgetrs(*factors, residual.ravel())[0].reshape(residual.shape)
