"""Many transients of one beam advanced together: the same steps, one motion each.

The collocation equations are those of `integrators`, but each step is solved for all cases at once
by iteration, with the diagonal of the stiffness treated exactly.  The cost of a step is then that
of a few products of small matrices for all cases, and not that of a factorisation for each.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cache
from itertools import pairwise

import numpy as np

from beamdyn.equations.equations_of_motion import RootMotion
from beamdyn.scene.motion import SteadyRotation
from beamdyn.transient.gauss import BLOCK, Piece, Tableau, tableau
from beamdyn.transient.step_size import (
    STAGES,
    Checks,
    Resolution,
    TimeError,
    Trajectory,
    check_steps,
    checked_steps,
    smooth_stretches,
    time_error,
)
from beamdyn.transient.system import ModalSystem

_ITERATIONS = 40
_CONVERGED = 1e-12  # change of the stage displacements relative to the largest
_AT_RESIDUE = 1e-6  # error over the largest deflection from which what the iteration leaves may be all of it
_SURVEY = 16  # steps between counts of the iterations that are needed


@dataclass(frozen=True)
class Histories:
    """Tip deflections of a batch.

    Parameters
    ----------
    tips : tuple of Trajectory
        Tip deflection of each case, as the single coordinate of a trajectory.
    time_error : tuple of float
        Estimated error of each by the steps in time [m].
    """

    tips: tuple[Trajectory, ...]
    time_error: tuple[float, ...]


def histories(
    systems: Sequence[ModalSystem], tip: np.ndarray, t_end: float, tolerance: float = 1e-5
) -> Histories:
    """Transients from rest, all with the steps of the most demanding case.

    Parameters
    ----------
    systems : sequence of ModalSystem
        Cases that differ in their motions alone; the motions share their breakpoints.
    tip : ndarray, shape (m,)
        Tip deflection of the bending modes.
    t_end : float
        End of the run [s].
    tolerance : float
        Error in time that is aimed at, relative to the largest deflection of a case.

    Returns
    -------
    Histories

    Raises
    ------
    ArithmeticError
        If the iteration does not converge, as with very strong coupling of the modes.
    """
    systems, tip = _turned(systems, tip)
    resolution, last = Resolution.of(tolerance), np.inf
    while True:
        tips, errors = _advanced(systems, tip, t_end, resolution)
        bounds = [tolerance * max(_largest(p) for p in path.pieces) for path in tips]
        worst = int(np.argmax([e.total / max(b, 1e-300) for e, b in zip(errors, bounds, strict=True)]))
        total, bound = errors[worst].total, bounds[worst]
        at_residue = last / 2 < total < _AT_RESIDUE / tolerance * bound
        if total <= bound or at_residue or resolution.exhausted:
            return Histories(tuple(tips), tuple(e.total for e in errors))
        resolution, last = resolution.finer(errors[worst], bound), total


def _largest(piece: Piece) -> float:
    return float(np.abs(piece.state[:, 1]).max())


def _advanced(
    systems: Sequence[ModalSystem], tip: np.ndarray, t_end: float, resolution: Resolution
) -> tuple[list[Trajectory], list[TimeError]]:
    """Tip deflections and their errors with steps that give every case its resolution."""
    C, n = len(systems), systems[0].size
    state = np.zeros((C, n)), np.zeros((C, n))
    runs: list[_Run] = []
    for a, b in pairwise(smooth_stretches(systems[0].motion, t_end)):
        steps = max(resolution.steps(s, a, b) for s in systems)
        check_steps(steps, t_end)
        runs.append(_Run(systems, tip, a, (b - a) / steps, steps))
        state = runs[-1].advance(*state)
    if not all(run.converged for run in runs):
        raise ArithmeticError("the iteration of a step did not converge: simulate the cases one by one")
    tips = [Trajectory(tuple(run.piece(case) for run in runs)) for case in range(C)]
    errors = [time_error(tip, s, [run.checks(case) for run in runs]) for case, s in enumerate(systems)]
    return tips, errors


def _turned(systems: Sequence[ModalSystem], tip: np.ndarray) -> tuple[list[ModalSystem], np.ndarray]:
    """The same systems in coordinates in which the bending stiffness is nearly diagonal at the end.

    The iteration treats the diagonal exactly, so that few iterations are left.
    """
    middle = systems[len(systems) // 2]
    speed = middle.motion.final_speed
    place = middle.equations.fields["bending"]
    _, K, _ = ModalSystem(
        middle.equations, SteadyRotation(speed if np.isfinite(speed) else 0.0)
    ).coefficients(np.zeros(()))
    turn = {name: np.eye(f.stop - f.start) for name, f in middle.equations.fields.items()}
    turn["bending"] = np.linalg.eigh(K[place, place])[1]
    equations = middle.equations.reduced(turn)
    return [ModalSystem(equations, s.motion) for s in systems], turn["bending"].T @ tip


class _Run:
    """One stretch of equal steps: the records that it fills as it advances."""

    def __init__(
        self, systems: Sequence[ModalSystem], tip: np.ndarray, start: float, h: float, steps: int
    ) -> None:
        C, n = len(systems), systems[0].size
        self.systems, self.start, self.h, self.steps = systems, start, h, steps
        self.tip = np.concatenate([tip, np.zeros(n - len(tip))])
        self.tips = np.empty((steps + 1, 2, C))
        self.accelerations = np.empty((steps, STAGES, C))
        self.checked = checked_steps(steps)
        self.states = np.ones((len(self.checked), C, 2 * n + 1))
        self.reached = np.empty((len(self.checked), C, 2 * n))
        self.converged, self.iterations = True, 2

    def advance(self, q: np.ndarray, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Advance all cases from (q, v), shapes (C, n), to the end of the stretch."""
        table, h, check = tableau(STAGES), self.h, {k: i for i, k in enumerate(self.checked.tolist())}
        for k, step in enumerate(self._steps(table)):
            self.tips[k] = q @ self.tip, v @ self.tip
            if k in check:
                self.states[check[k], :, 1:] = np.hstack([q, v])
            if k % _SURVEY == 0:
                self._survey(step, q, v)
            a = self._solve(step, q, v, self.iterations)[0]
            self.accelerations[k] = a @ self.tip
            flat = a.reshape(STAGES, -1)
            q = q + h * v + h**2 * (table.b2 @ flat).reshape(q.shape)
            v = v + h * (table.b @ flat).reshape(v.shape)
            if k in check:
                self.reached[check[k]] = np.hstack([q, v])
        self.tips[self.steps] = q @ self.tip, v @ self.tip
        return q, v

    def _steps(self, table: Tableau) -> Iterator[_Step]:
        """Coefficients of each step, computed for blocks of steps."""
        for first in range(0, self.steps, BLOCK):
            k = np.arange(first, min(first + BLOCK, self.steps))
            times = self.start + self.h * (k[:, None] + np.append(table.c, 0.5))
            yield from _coefficients(self.systems, times, self.h)

    def _survey(self, step: _Step, q: np.ndarray, v: np.ndarray) -> None:
        """Find how many iterations the next steps need, and whether all cases converge."""
        for self.iterations in range(2, _ITERATIONS):
            (_, before), (_, after) = (self._solve(step, q, v, self.iterations + i) for i in (0, 1))
            change, size = (np.abs(x).max(axis=(0, 2)) for x in (after - before, after + np.abs(q)))
            if (change <= _CONVERGED * size).all():
                return
        self.converged = False

    def _solve(
        self, step: _Step, q: np.ndarray, v: np.ndarray, iterations: int
    ) -> tuple[np.ndarray, np.ndarray]:
        """Accelerations at the nodes and what they move the nodes by, both of shape (s, C, n)."""
        table, h = tableau(STAGES), self.h
        forward, back, _ = _spectrum(STAGES)
        still = q + h * table.c[:, None, None] * v  # displacement at the nodes without acceleration
        shape, a, moved, rate = still.shape, still, np.zeros_like(still), v if step.damping else None
        for _ in range(iterations):
            g = step.acceleration(still + moved, rate)
            g += step.diagonal * moved
            pairs = (forward @ g.reshape(STAGES, -1)).reshape(2, STAGES // 2, *shape[1:])
            solved = (pairs[0] + 1j * pairs[1]) * step.inverse
            a = back @ np.concatenate([solved.real, solved.imag]).reshape(STAGES, -1)
            moved = (h**2 * table.A2 @ a).reshape(shape)
            if step.damping:
                rate = v + (h * table.A @ a).reshape(shape)
        return a.reshape(shape), moved

    def piece(self, case: int) -> Piece:
        """The tip deflection of a case."""
        state = np.concatenate([np.ones((self.steps + 1, 1)), self.tips[:, :, case]], axis=1)
        return Piece(self.start, self.h, state, self.accelerations[:, :, case, None].copy())

    def checks(self, case: int) -> Checks:
        """The checked steps of a case."""
        starts = self.start + self.h * self.checked
        return Checks(starts, self.h, self.steps, self.states[:, case], self.reached[:, case])


@dataclass(frozen=True)
class _Step:
    """Coefficients of one step of all cases: quantities of shape (s, C, 1) and constant matrices."""

    stiffness: list[tuple[np.ndarray, np.ndarray]]
    damping: list[tuple[np.ndarray, np.ndarray]]
    load: np.ndarray
    diagonal: np.ndarray
    inverse: np.ndarray

    def acceleration(self, q: np.ndarray, v: np.ndarray | None) -> np.ndarray:
        """F - K q - C v at the nodes, shape (s, C, n)."""
        total = self.load.copy()
        for quantity, transposed in self.stiffness:
            total -= quantity * (q @ transposed)
        for quantity, transposed in self.damping:
            total -= quantity * (v @ transposed)
        return total


@cache
def _spectrum(stages: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Spectrum of A2, whose eigenvalues come in conjugate pairs, in real arithmetic.

    Returns
    -------
    forward : ndarray, shape (s, s)
        From values at the nodes to the real, then imaginary, parts of one coefficient of each pair.
    back : ndarray, shape (s, s)
        From such parts to values at the nodes.
    beta : ndarray of complex, shape (s / 2,)
        One eigenvalue of each pair.
    """
    beta, vectors = np.linalg.eig(tableau(stages).A2)
    upper = np.imag(beta) > 0
    inverse, vectors = np.linalg.inv(vectors)[upper], vectors[:, upper]
    forward = np.concatenate([np.real(inverse), np.imag(inverse)])
    back = 2 * np.concatenate([np.real(vectors), -np.imag(vectors)], axis=1)
    return forward, back, beta[upper]


def _coefficients(systems: Sequence[ModalSystem], times: np.ndarray, h: float) -> Iterator[_Step]:
    """Coefficients of the steps whose nodes, then middles, are the rows of `times`."""
    roots = [s.root(times) for s in systems]
    system, (_, _, beta) = systems[0], _spectrum(STAGES)
    stiffness, damping = ([(name, G) for name, G in system.parts[order].items()] for order in (0, 1))
    names = {name for name, _ in (*stiffness, *damping)}
    quantity = {name: np.stack([getattr(r, name) for r in roots], axis=-1)[..., None] for name in names}
    diagonal = sum(quantity[name][:, -1] * np.diag(G) for name, G in stiffness)  # at mid-step: (N, C, n)
    load = np.stack([_load(system, r) for r in roots], axis=2)
    inverse = 1 / (1 + h**2 * beta[:, None, None] * np.asarray(diagonal)[:, None])
    for k in range(len(times)):
        yield _Step(
            stiffness=[(quantity[name][k, :-1], G.T) for name, G in stiffness],
            damping=[(quantity[name][k, :-1], G.T) for name, G in damping],
            load=load[k, :-1],
            diagonal=np.asarray(diagonal)[k],
            inverse=inverse[k],
        )


def _load(system: ModalSystem, root: RootMotion) -> np.ndarray:
    return system.equations.load(root)
