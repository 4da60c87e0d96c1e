"""Time steps of bent beams, whose equations are nonlinear, by Gauss collocation; errors from a second run.

As in `beamdyn.transient.gauss`, the unknowns of a step are the accelerations a_i at its s nodes; rates and
coordinates there are v + h sum A_ij a_j and q + c_i h v + h^2 sum A2_ij a_j.  Newton's method solves for them
to rounding, with the derivatives of the equations at all nodes.  The method is symmetric in time and has no
numerical damping, so that energy does not drift.

The difference from a second run with two more stages in the same steps, of an order higher by four, is the
first run's error, as it has accumulated.  The second run is the result: its own error is far smaller.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Any, NamedTuple, TypeAlias

import numpy as np
from numpy.polynomial import legendre
from scipy.linalg.lapack import dgetrf, dgetrs

from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem, Evaluated
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
_LEAST_REDUCTION = 1e-3  # least reduction of the error by an iteration that is believed
_STALLED = 1e-9  # relative error of the accelerations below which a stalled iteration has converged
# Residual over the elastic force below which a stalled iteration has converged, where accelerations are
# small.
_BALANCED = 1e-12
_FAST = 0.1  # reduction of the error by an iteration up to which the derivatives are kept
_FEW = 4  # number of iterations up to which the next step begins with the same derivatives
_FINER = STAGES + 2  # number of stages of the second run
_BALANCE = 1e-13  # residual in equilibrium, relative to the largest force or coordinate, that is rounding
_TIMES_COMPARED = 257  # number of times at which the motion of the root is compared with that at the start
_SHORTER = 0.5  # ratio of the next step's phase angle to that of a step that was not solved
_SHORT = 1.0  # phase angle of steps [rad] below which they resolve one more mode instead
_MANY = 64  # number of pieces of a motion, such as a sampled one, above which no piece is divided further
_CHECKED = 48  # number of steps of a segment at which the interpolation is checked


def rest_in_equilibrium(system: BeamInSpaceSystem, y0: np.ndarray, t_end: float) -> Trajectory | None:
    """Build the path of a beam that stays at rest, if root motion is constant and forces in equilibrium."""
    q, v = y0[None, : system.size], y0[None, system.size :]
    if system.motion.steady_start > 0 or v.any():
        return None
    root = system.root(np.linspace(0, t_end, _TIMES_COMPARED))
    values = [getattr(root, name) for name in system.equations.vectors]
    if not all((value == value[0]).all() for value in (*values, root.speed_squared, root.root_axial)):
        return None
    force = system.at(system.drive(system.root(np.zeros(1))), q, v, v).residual
    stiffness, size = np.abs(system.elastica.stiffness), np.abs(q[0])
    # Equilibria are known to rounding of their coordinates, which in a stiff mode is a large force.
    if (np.abs(force) > _BALANCE * ((stiffness @ size).max() + np.diag(stiffness) * size.max())).any():
        return None
    state = np.tile(np.append(1.0, y0), (2, 1))
    return Trajectory((Segment(0.0, t_end, state, np.zeros((1, _FINER, system.size))),))


def attempt_elastica(
    system: BeamInSpaceSystem,
    y0: np.ndarray,
    t_end: float,
    step_size: StepSize,
    before: Attempt | None = None,
) -> Attempt:
    """Integrate twice with equal steps in each segment, with 8 and 10 stages.

    Steps that were not solved are shortened, finally until they resolve the vibration of all coordinates.
    The earlier attempt `before` is not used: an attempt takes nothing over from it.
    """
    pieces = smooth_piece_ends(system.motion, t_end)
    edges = pieces if len(pieces) > _MANY else split_at_breakpoints(system.motion, t_end)
    steps = [step_size.count_steps(system.straight, a, b) for a, b in pairwise(edges)]
    check_number_of_steps(sum(steps), system.size, t_end)

    def run(stages: int, like: tuple[Segment, ...] = ()) -> tuple[Segment, ...]:
        known = iter(like)
        return chain_segments(
            edges,
            steps,
            y0,
            lambda a, b, count, q, v: propagate_elastica(
                system, a, b, count, q, v, stages, next(known, None)
            ),
        )

    try:
        coarse = run(STAGES)
        fine = run(_FINER, coarse)
    except StepNotSolved:
        if step_size.is_finest:
            raise
        shorter = StepSize(step_size.phase * _SHORTER, step_size.modes)
        if step_size.phase < _SHORT and step_size.modes < system.size:
            shorter = StepSize(StepSize.from_tolerance(TOLERANCES[1]).phase, step_size.modes + 1)
        return attempt_elastica(system, y0, t_end, shorter, before)
    method = f"Gauss collocation of order {2 * _FINER}, {sum(steps)} steps"
    largest = max(float(np.abs(_tips(system, segment)).max()) for segment in fine)
    return Attempt(step_size, Trajectory(fine), _error(system, coarse, fine), largest, method)


def _tips(system: BeamInSpaceSystem, segment: Segment) -> np.ndarray:
    """Compute deflections of the tip (k, planes) at the ends of the steps [m]."""
    return system.deflections(segment.state[:, 1 : system.size + 1])


def _error(system: BeamInSpaceSystem, coarse: tuple[Segment, ...], fine: tuple[Segment, ...]) -> TimeError:
    """Estimate the error of the tip deflection: the distance of two runs, divided among coordinates."""
    tip, n, straight = 0.0, system.size, system.straight
    change = np.zeros(n)
    for first, second in zip(coarse, fine, strict=True):
        difference = np.abs(first.state - second.state)[:, 1 : n + 1].max(axis=0)
        change = np.maximum(change, difference * np.abs(system.equations.tips).max(axis=0))
        tip = max(tip, float(np.abs(_tips(system, first) - _tips(system, second)).max()))
    modes = tip * change / max(change.sum(), 1e-300)
    # The phase errors are those of a straight beam in the longest step.
    longest = max(fine, key=lambda segment: segment.h)
    starts = np.array([(longest.start + longest.end - longest.h) / 2])
    maps, finer = (step_maps(straight, starts, longest.h, tableau(s)).step for s in (STAGES, _FINER))
    phases = phase_errors(finer - maps, vibration_frequencies(straight, longest.end))
    some = fine[:: 1 + len(fine) // _MANY]
    interpolation = max(_interpolation_error(system, segment) for segment in some)
    return TimeError.of_coordinates(straight, modes, interpolation, phases > UNRESOLVED_PHASE)


def _interpolation_error(system: BeamInSpaceSystem, segment: Segment) -> float:
    """Estimate the tip deflection's largest error between step ends [m], by steps with more stages."""
    error, h = 0.0, segment.h
    for k in np.unique(np.linspace(0, len(segment.acceleration) - 1, _CHECKED).astype(int)):
        state, acceleration = segment.state[k : k + 2], segment.acceleration[k : k + 1]
        here = Segment(segment.start + k * h, h, state, acceleration)
        q, v = np.split(state[0, 1:], 2)
        finer = propagate_elastica(system, here.start, here.end, 1, q, v, _FINER + 2, here)
        each = (
            interpolate(s.h, s.state[:-1], s.acceleration, INTERPOLATION_POINTS)[0] for s in (here, finer)
        )
        coarse, fine = map(system.deflections, each)
        error = max(error, float(np.abs(coarse - fine).max()))
    return error


# Steps --------------------------------------------------------------------------------------------


class StepNotSolved(ArithmeticError):
    """Raised when Newton's method does not solve the equations of a step."""


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
    """Integrate over equal steps by Gauss collocation; like `beamdyn.transient.gauss.propagate`.

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
    known = None if like is None else _at_nodes(like.acceleration.shape[1], stages)
    q, v = q0, v0
    drive: Any = None
    with np.errstate(over="ignore", invalid="ignore"):  # a step that is too long overflows, and is refused
        for k in range(steps):
            if k % BLOCK == 0:
                some = np.arange(k, min(k + BLOCK, steps))
                drive = system.drive(system.root(t0 + h * (some[:, None] + step.table.c)))
            guess = None if like is None or known is None else known @ like.acceleration[k]
            q, v, a = step.advance(drive.step(k % BLOCK), q, v, guess)
            acceleration[k], state[k + 1, 1 : n + 1], state[k + 1, n + 1 :] = a, q, v
    return Segment(t0, h, state, acceleration)


def _at_nodes(given: int, wanted: int) -> np.ndarray:
    """Build the matrix (wanted, given) from values at one Gauss rule's nodes to those at another's."""
    x, w = legendre.leggauss(given)
    degrees = np.arange(given)
    series = (2 * degrees[:, None] + 1) / 2 * legendre.legvander(x, given - 1).T * w
    return legendre.legvander(2 * tableau(wanted).c - 1, given - 1) @ series


Factors: TypeAlias = tuple[np.ndarray, np.ndarray]  # factors of a matrix, and pivots


class Tangent(NamedTuple):
    """Derivatives of the equations by coordinates and rates (1, n, n), with factors of a step's matrix."""

    stiffness: np.ndarray
    damping: np.ndarray
    factors: Factors


class _Step:
    """Solver of steps of one length h [s] and one number of stages."""

    def __init__(self, system: BeamInSpaceSystem, h: float, table: Tableau) -> None:
        self.system, self.h, self.table = system, h, table
        self.drift, self.to_v, self.to_q = h * table.c[:, None], h * table.A, h**2 * table.A2
        self.to_motion = np.concatenate([self.to_q, self.to_v, np.eye(len(table.c))])
        self.end_v, self.end_q = h * table.b, h**2 * table.b2
        self.tangent: Tangent | None = None

    def advance(
        self, drive: Any, q: np.ndarray, v: np.ndarray, guess: np.ndarray | None
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute coordinates and rates at the end of a step, and accelerations at its nodes."""
        drift, middle = self.drift * v, len(self.table.c) // 2
        if self.tangent is None:  # tangent at rest in these coordinates, the same for all nodes
            still = np.zeros((1, len(q)))
            here = self.system.at(drive.node(middle), q[None], still, still)
            self.tangent = Tangent(here.stiffness, here.damping, self._factorize(here))
        if guess is None:  # initial guess from equations linearized about the beginning of the step
            still = np.zeros((len(self.table.c), len(q)))
            load = self.system.at(drive, still + q, still, still).residual
            load += self.tangent.damping[0] @ v + drift @ self.tangent.stiffness[0].T
            guess = -_divide(self.tangent.factors, load)
        a = self._solve(drive, q + drift, v, guess)
        return q + self.h * v + self.end_q @ a, v + self.end_v @ a, a

    def _solve(self, drive: Any, drifted: np.ndarray, v: np.ndarray, a: np.ndarray) -> np.ndarray:
        """Solve for accelerations (s, n) by Newton's method, keeping the tangent while it serves."""
        assert self.tangent is not None
        factors: Factors | None = self.tangent.factors
        start, last = np.stack([drifted, np.broadcast_to(v, a.shape), np.zeros_like(a)]), np.inf
        for iteration in range(_ITERATIONS):
            now = self.system.evaluate(drive, start + self.to_motion.dot(a).reshape(start.shape))
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

    def _factorize(self, now: Evaluated) -> Factors:
        """Compute LU factors of the derivative of all residuals of a step by all accelerations."""
        s, n = len(self.table.c), self.system.size
        matrix = self.to_q[:, None, :, None] * now.stiffness[:, :, None]
        matrix += self.to_v[:, None, :, None] * now.damping[:, :, None]
        index = np.arange(s)
        matrix[index, :, index] += now.mass
        lu, pivots, _ = dgetrf(matrix.reshape(s * n, s * n))
        return lu, pivots


def _norm(values: np.ndarray) -> float:
    """Compute the Euclidean norm of all values."""
    flat = values.ravel()
    return math.sqrt(flat.dot(flat))


def _divide(factors: Factors, residual: np.ndarray) -> np.ndarray:
    """Solve a linear system for accelerations by the factors of its matrix."""
    return dgetrs(*factors, residual.ravel())[0].reshape(residual.shape)
