"""Transients of one beam for several motions, integrated as one batch with common steps.

The collocation equations are those of `gauss`, but each step is solved for all cases at once
by iteration, with the diagonal of the stiffness treated implicitly and exactly.  A step then costs
a few products of small matrices for all cases, and no factorisation for each.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np

from beamdyn.scene.motion import SteadyRotation
from beamdyn.transient.gauss import BLOCK, Segment, Tableau, tableau
from beamdyn.transient.record_steps import RecordSegment
from beamdyn.transient.step_size import StepSize, check_number_of_steps, split_at_breakpoints
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import (
    ERROR_ORDER,
    STAGES,
    CheckedSteps,
    TimeError,
    choose_checked_steps,
    estimate_time_error,
)
from beamdyn.transient.trajectory import Trajectory, magnitude

_MOST_ITERATIONS = 40  # of a step, before it counts as not converged
_CONVERGED = 1e-12  # change of the displacements in the last iteration, over the largest displacement
_ITERATION_ERROR = 1e-6  # error over the largest deflection that unconverged iterations may cause
_CHOICE_INTERVAL = 16  # steps for which the number of iterations is chosen at once


@dataclass(frozen=True)
class TipHistories:
    """Tip deflections of a batch of transients.

    Parameters
    ----------
    tips : tuple of Trajectory
        Tip deflection of each case: the coordinates of a trajectory are those in each direction.
    time_error : tuple of float
        Estimated time-integration error of each case [m].
    """

    tips: tuple[Trajectory, ...]
    time_error: tuple[float, ...]


def integrate_batch(systems: Sequence[ModalSystem], t_end: float, tolerance: float = 1e-5) -> TipHistories:
    """Integrate all cases from rest, with the step size of the most demanding one.

    Parameters
    ----------
    systems : sequence of ModalSystem
        Cases that differ only in their motions; the motions share their breakpoints.
    t_end : float
        End of the run [s].
    tolerance : float
        Time-integration error aimed at, relative to the largest deflection of a case.

    Returns
    -------
    TipHistories

    Raises
    ------
    ArithmeticError
        If the iteration does not converge, as with very strong coupling of the modes.
    """
    systems = _diagonalize(systems)
    step_size, last = StepSize.from_tolerance(tolerance), np.inf
    while True:
        tips, errors = _integrate_all(systems, t_end, step_size)
        bounds = [tolerance * max(_largest_deflection(s) for s in path.segments) for path in tips]
        worst = int(np.argmax([e.total / max(b, 1e-300) for e, b in zip(errors, bounds, strict=True)]))
        total, bound = errors[worst].total, bounds[worst]
        stalled = last / 2 < total < _ITERATION_ERROR / tolerance * bound
        if total <= bound or stalled or step_size.is_finest:
            return TipHistories(tuple(tips), tuple(e.total for e in errors))
        step_size, last = step_size.refine(errors[worst], bound, ERROR_ORDER), total


def _largest_deflection(segment: Segment | RecordSegment) -> float:
    """Largest tip deflection at the ends of the steps [m], of a segment whose coordinates it is."""
    directions = segment.acceleration.shape[2]
    return float(magnitude(segment.state[:, 1 : 1 + directions], np.eye(directions)).max())


def _integrate_all(
    systems: Sequence[ModalSystem], t_end: float, step_size: StepSize
) -> tuple[list[Trajectory], list[TimeError]]:
    """Integrate with equal steps in each segment, small enough for every case; with the errors."""
    C, n = len(systems), systems[0].size
    state = np.zeros((C, n)), np.zeros((C, n))
    runs: list[_SegmentRun] = []
    ends = list(pairwise(split_at_breakpoints(systems[0].motion, t_end)))
    counts = [max(step_size.count_steps(s, a, b) for s in systems) for a, b in ends]
    check_number_of_steps(sum(counts), C, t_end)
    for (a, b), steps in zip(ends, counts, strict=True):
        runs.append(_SegmentRun(systems, a, (b - a) / steps, steps))
        state = runs[-1].advance(*state)
    if not all(run.converged for run in runs):
        raise ArithmeticError("the iteration of a step did not converge: simulate the cases one by one")
    tips = [Trajectory(tuple(run.segment(case) for run in runs)) for case in range(C)]
    errors = [
        estimate_time_error(s, [run.checks(case) for run in runs], s.tips) for case, s in enumerate(systems)
    ]
    return tips, errors


def _diagonalize(systems: Sequence[ModalSystem]) -> list[ModalSystem]:
    """Transform to coordinates in which the stiffness of each field is nearly diagonal at the final speed.

    The iteration treats the diagonal exactly, so that it then converges fast.
    """
    middle = systems[len(systems) // 2]
    speed = middle.motion.final_speed
    steady = SteadyRotation(speed if np.isfinite(speed) else 0.0)
    _, K, _ = ModalSystem(middle.equations, steady).coefficients(np.zeros(()))
    bases = {(name,): np.linalg.eigh(K[block, block])[1] for name, block in middle.equations.blocks.items()}
    equations = middle.equations.reduced(bases)
    return [ModalSystem(equations, s.motion) for s in systems]


class _SegmentRun:
    """Integration of all cases over one segment of equal steps, with the recorded states."""

    def __init__(self, systems: Sequence[ModalSystem], start: float, h: float, steps: int) -> None:
        C, n = len(systems), systems[0].size
        self.systems, self.start, self.h, self.steps = systems, start, h, steps
        self.outputs = systems[0].tips
        self.tips = np.empty((steps + 1, 2, len(self.outputs), C))
        self.accelerations = np.empty((steps, STAGES, C, len(self.outputs)))
        self.checked = choose_checked_steps(steps)
        self.states = np.ones((len(self.checked), C, 2 * n + 1))
        self.end_state = np.empty((len(self.checked), C, 2 * n))
        self.converged, self.iterations = True, 2

    def advance(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Integrate all cases from (q, v), shapes (C, n), to the end of the segment."""
        table, h, check = tableau(STAGES), self.h, {k: i for i, k in enumerate(self.checked.tolist())}
        for k, step in enumerate(self._step_coefficients(table)):
            self.tips[k] = self._tips(q, v)
            if k in check:
                self.states[check[k], :, 1:] = np.hstack([q, v])
            if k % _CHOICE_INTERVAL == 0:
                self._choose_iterations(step, q, v)
            a = self._solve(step, q, v, self.iterations)[0]
            self.accelerations[k] = np.stack([a @ output for output in self.outputs], axis=-1)
            flat = a.reshape(STAGES, -1)
            q = q + h * v + h**2 * (table.b2 @ flat).reshape(q.shape)
            v = v + h * (table.b @ flat).reshape(v.shape)
            if k in check:
                self.end_state[check[k]] = np.hstack([q, v])
        self.tips[self.steps] = self._tips(q, v)
        return q, v

    def _tips(self, *states: np.ndarray) -> list[list[np.ndarray]]:
        """Tip's components in each direction, of each state (C, n)."""
        return [[state @ output for output in self.outputs] for state in states]

    def _step_coefficients(self, table: Tableau) -> Iterator[_StepCoefficients]:
        """Compute the coefficients of each step, in blocks of steps."""
        for first in range(0, self.steps, BLOCK):
            k = np.arange(first, min(first + BLOCK, self.steps))
            times = self.start + self.h * (k[:, None] + np.append(table.c, 0.5))
            yield from _coefficients(self.systems, times, self.h)

    def _choose_iterations(self, step: _StepCoefficients, q: np.ndarray, v: np.ndarray) -> None:
        """Choose the number of iterations of the next steps, and note if some case does not converge."""
        for self.iterations in range(2, _MOST_ITERATIONS):
            (_, before), (_, after) = (self._solve(step, q, v, self.iterations + i) for i in (0, 1))
            change, size = (np.abs(x).max(axis=(0, 2)) for x in (after - before, after + np.abs(q)))
            if (change <= _CONVERGED * size).all():
                return
        self.converged = False

    def _solve(
        self, step: _StepCoefficients, q: np.ndarray, v: np.ndarray, iterations: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Solve for the accelerations at the nodes and the displacements they cause, both (s, C, n)."""
        table, h = tableau(STAGES), self.h
        to_eigen, from_eigen, _ = _decompose_A2(STAGES)
        free = q + h * table.c[:, None, None] * v  # displacement at the nodes without acceleration
        a, displacement, velocity = free, np.zeros_like(free), v if step.damping else None
        for _ in range(iterations):
            g = step.acceleration(free + displacement, velocity)
            g += step.diagonal * displacement
            pairs = (to_eigen @ g.reshape(STAGES, -1)).reshape(2, STAGES // 2, *q.shape)
            z = (pairs[0] + 1j * pairs[1]) * step.inverse
            a = from_eigen @ np.concatenate([z.real, z.imag]).reshape(STAGES, -1)
            displacement = (h**2 * table.A2 @ a).reshape(free.shape)
            if step.damping:
                velocity = v + (h * table.A @ a).reshape(free.shape)
        return a.reshape(free.shape), displacement

    def segment(self, case: int) -> Segment:
        """Segment of a case, whose coordinates are the tip deflections in each direction."""
        tips = self.tips[..., case].reshape(self.steps + 1, -1)
        state = np.concatenate([np.ones((self.steps + 1, 1)), tips], axis=1)
        return Segment(self.start, self.h, state, self.accelerations[:, :, case].copy())

    def checks(self, case: int) -> CheckedSteps:
        """Checked steps of a case."""
        starts = self.start + self.h * self.checked
        return CheckedSteps(starts, self.h, self.steps, self.states[:, case], self.end_state[:, case])


@dataclass(frozen=True)
class _StepCoefficients:
    """Coefficients of one step of all cases.

    Parameters
    ----------
    stiffness, damping : list of (ndarray, ndarray)
        Quantities of the root's motion, shape (s, C, 1), each with its constant matrix, transposed.
    load : ndarray, shape (s, C, n)
        Loads at the nodes.
    diagonal : ndarray, shape (C, n)
        Diagonal of the stiffness at mid-step.
    inverse : ndarray of complex, shape (s / 2, C, n)
        1 / (1 + h^2 beta diagonal) for the eigenvalues beta of the collocation.
    """

    stiffness: list[tuple[np.ndarray, np.ndarray]]
    damping: list[tuple[np.ndarray, np.ndarray]]
    load: np.ndarray
    diagonal: np.ndarray
    inverse: np.ndarray

    def acceleration(self, q: np.ndarray, v: np.ndarray | None) -> np.ndarray:
        """Compute f - K q - C v at the nodes, shape (s, C, n)."""
        total = self.load.copy()
        for quantity, transposed in self.stiffness:
            total -= quantity * (q @ transposed)
        for quantity, transposed in self.damping:
            total -= quantity * (v @ transposed)
        return total


@cache
def _decompose_A2(stages: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Diagonalize A2, whose eigenvalues come in conjugate pairs, in real arithmetic.

    Returns
    -------
    to_eigen : ndarray, shape (s, s)
        From values at the nodes to coefficients of one eigenvector of each pair: real, then imaginary parts.
    from_eigen : ndarray, shape (s, s)
        From such coefficients to values at the nodes.
    beta : ndarray of complex, shape (s / 2,)
        One eigenvalue of each pair.
    """
    beta, vectors = np.linalg.eig(tableau(stages).A2)
    upper = np.imag(beta) > 0
    inverse, vectors = np.linalg.inv(vectors)[upper], vectors[:, upper]
    to_eigen = np.concatenate([np.real(inverse), np.imag(inverse)])
    from_eigen = 2 * np.concatenate([np.real(vectors), -np.imag(vectors)], axis=1)
    return to_eigen, from_eigen, beta[upper]


def _coefficients(systems: Sequence[ModalSystem], times: np.ndarray, h: float) -> Iterator[_StepCoefficients]:
    """Compute the coefficients of steps; a row of `times` has the nodes of a step, then its middle."""
    roots = [s.root(times) for s in systems]
    system, (_, _, beta) = systems[0], _decompose_A2(STAGES)
    stiffness, damping = ([*system.equations.matrices[order].items()] for order in (0, 1))
    names = {name for name, _ in (*stiffness, *damping)}
    quantity = {name: np.stack([getattr(r, name) for r in roots], axis=-1)[..., None] for name in names}
    diagonal = sum(quantity[name][:, -1] * np.diag(G) for name, G in stiffness)  # at mid-step: (N, C, n)
    load = np.stack([system.equations.load(r) for r in roots], axis=2)
    inverse = 1 / (1 + h**2 * beta[:, None, None] * np.asarray(diagonal)[:, None])
    for k in range(len(times)):
        yield _StepCoefficients(
            stiffness=[(quantity[name][k, :-1], G.T) for name, G in stiffness],
            damping=[(quantity[name][k, :-1], G.T) for name, G in damping],
            load=load[k, :-1],
            diagonal=np.asarray(diagonal)[k],
            inverse=inverse[k],
        )
