"""Integration to a tolerance: choose the step size, integrate, estimate the error, refine."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.scene.motion import Motion
from beamdyn.transient.closed_form import propagate_in_closed_form
from beamdyn.transient.gauss import Segment, propagate
from beamdyn.transient.record_steps import (
    RecordSteps,
    is_record,
    most_steps_in_piece,
    propagate_record,
    smooth_piece_ends,
)
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import (
    ERROR_ORDER,
    STAGES,
    SegmentWithError,
    TimeError,
    estimate_time_error,
)
from beamdyn.transient.trajectory import Trajectory, magnitude
from beamdyn.transient.weakly_modulated import propagate_modulated

TOLERANCES = (1e-12, 0.1)  # smallest and largest; smaller ones are below the rounding error
_REFERENCE_PHASE = 3.84  # step size [rad] for a tolerance of 1e-5, measured on examples
_LOOSEST_TOLERANCE = 0.01  # tolerance of the free vibration of a mode whose phase is resolved
_PARTS = 4  # parts of a segment in which the speed changes, each with its own step size
_WORTH_A_SEGMENT = 500  # steps that cost as much as the preparation of a segment
_MOST_STEPS = 3_000_000  # steps of a run
_MOST_VALUES = 15_000_000  # steps times coordinates of a run that fits into some 3 GB of memory
_TIMES_COMPARED = 257  # times at which the equations are compared with those at the start
_BALANCE = 1e-13  # residual force in equilibrium, over the largest force: rounding error
ROUNDING = 1e-9  # error over the largest deflection that rounding may cause
_SERIES_SHARE = 0.1  # share of the tolerance for the truncated series of weakly modulated steps
_ORDER_ACROSS_SAMPLES = 3  # order of the error of steps in which the acceleration has kinks
_FEW_STEPS = 4  # samples in a step, from which on it is one over many
_CEILED = 1.02  # factor by which whole numbers of steps exceed those wanted, of hundreds
_MOST_REFINED = 50  # _REFERENCE_PHASE over the smallest step size, below which rounding errors grow


@dataclass(frozen=True)
class StepSize:
    """Step size, as the phase angle by which the fastest resolved motion advances per step.

    Parameters
    ----------
    phase : float
        Phase angle per step [rad].
    modes : int
        Number of the lowest modes whose phase is resolved.  The motion hardly excites the higher ones.
    """

    phase: float
    modes: int = 1

    @classmethod
    def from_tolerance(cls, tolerance: float) -> StepSize:
        """Estimate the step size that meets a tolerance, relative to the largest deflection."""
        return cls(_REFERENCE_PHASE * (tolerance / 1e-5) ** (1 / ERROR_ORDER))

    def count_steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Number of equal steps from start to end [s]."""
        return self.count_steps_of_each(system, np.array([start, end]))[0]

    def count_steps_of_each(self, system: ModalSystem, ends: np.ndarray) -> list[int]:
        """Numbers of equal steps of neighbouring segments, by their ends [s]."""
        t = np.linspace(ends[:-1], ends[1:], 9, axis=1)
        speed = np.abs(system.motion.at(t).speed).max(axis=1)
        multiple = max((line.multiple for line in system.motion.lines), default=0.0)
        _, K, _ = system.coefficients(t)
        natural = np.sqrt(np.sort(np.abs(np.linalg.eigvals(K)), axis=-1)[:, :, self.modes - 1].max(axis=1))
        fastest = np.maximum(natural, speed * max(multiple, float(system.equations.gravity != 0)))
        return np.maximum(1, np.ceil(np.diff(ends) * fastest / self.phase)).astype(int).tolist()

    def next(self, error: TimeError, bound: float, order: int) -> StepSize:
        """Next step size, where the error exceeds its bound [m]: more modes resolved, or a smaller angle.

        The `order` is that at which the error falls with the step size.
        """
        cumulative = np.cumsum((error.modes * error.unresolved)[::-1])[::-1]
        modes = int((cumulative > bound / 4).sum())  # the errors of all higher modes add up to less
        if modes > self.modes:  # only as closely as the highest of them contributes
            share = min(bound / 4 / cumulative[modes - 1], _LOOSEST_TOLERANCE)
            return StepSize(max(self.phase, StepSize.from_tolerance(share).phase), modes)
        shrink = max(0.3, 0.9 * (bound / error.total) ** (1 / order))
        return StepSize(self.phase * shrink, self.modes)

    @property
    def is_finest(self) -> bool:
        """Whether a smaller step size only adds rounding error."""
        return self.phase < _REFERENCE_PHASE / _MOST_REFINED


@dataclass(frozen=True)
class Attempt:
    """A run in steps of one size.

    Parameters
    ----------
    step_size : StepSize
        The step size.
    path : Trajectory
        The motion.
    error : TimeError
        Estimated error of the tip deflection.
    largest : float
        Largest deflection of the tip [m].
    method : str
        Integrator and number of steps, for the provenance.
    order : int
        Order at which the error falls with the step size.
    """

    step_size: StepSize
    path: Trajectory
    error: TimeError
    largest: float
    method: str
    order: int = ERROR_ORDER

    @property
    def is_finest(self) -> bool:
        """Whether shorter steps only add rounding errors."""
        return self.step_size.is_finest and self.order == ERROR_ORDER

    def stalls_after(self, before: Attempt | None) -> bool:
        """Whether shorter steps have not halved an error that may be one of rounding."""
        last = np.inf if before is None else before.error.total
        return last / 2 < self.error.total < ROUNDING * self.largest


def shorten_steps(
    run: Callable[[StepSize, Attempt | None], Attempt], tolerance: float
) -> tuple[Trajectory, float, str]:
    """Run with the step size of the tolerance, and with shorter ones while the error exceeds it.

    Parameters
    ----------
    run : callable
        A run in steps of a wanted size, after another one, if there was one.
    tolerance : float
        Time-integration error aimed at, relative to the largest deflection.

    Returns
    -------
    path, error, method
        As of `integrate`.
    """

    def meets(found: tuple[Attempt, Attempt | None]) -> bool:
        last, before = found
        return last.error.total <= tolerance * last.largest or last.stalls_after(before) or last.is_finest

    def finer(found: tuple[Attempt, Attempt | None]) -> tuple[Attempt, Attempt | None]:
        last, _ = found
        return run(last.step_size.next(last.error, tolerance * last.largest, last.order), last), last

    found, _ = refine((run(StepSize.from_tolerance(tolerance), None), None), finer, meets)
    return found.path, found.error.total, found.method


def integrate(
    system: ModalSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> tuple[Trajectory, float, str]:
    """Integrate with the step size of the tolerance, refined while the estimated error exceeds it.

    Parameters
    ----------
    system : ModalSystem
        The equations.
    y0 : ndarray, shape (2 n,)
        Coordinates and velocities at time 0.
    t_end : float
        End [s].
    tolerance : float
        Time-integration error aimed at, relative to the largest deflection.

    Returns
    -------
    path : Trajectory
    error : float
        Estimated time-integration error of the tip deflection [m].
    method : str
        Integrator and number of steps, for the provenance.

    Raises
    ------
    TooManySteps
        If the steps of the run do not fit into memory.
    """
    if stays_in_equilibrium(system, y0, t_end):
        edges = smooth_piece_ends(system.motion, t_end)
        path = Trajectory(_propagate(system, edges, [1] * (len(edges) - 1), y0, tolerance))
        return path, 0.0, "no steps: the beam stays in equilibrium"
    given_by_samples = is_record(system, t_end, StepSize.from_tolerance(tolerance))

    def run(step_size: StepSize, before: Attempt | None) -> Attempt:
        if given_by_samples and before is not None:
            step_size = _between_samples(system, t_end, step_size, before.step_size, before.order)
        solve = _run_record if given_by_samples else _run
        path, error, order = solve(system, y0, t_end, tolerance, step_size)
        tips = (magnitude(s.state[:, 1 : system.size + 1], system.tips).max() for s in path.segments)
        steps = sum(len(s.acceleration) for s in path.segments)
        method = f"Gauss collocation of order {ERROR_ORDER}, {steps} steps"
        return Attempt(step_size, path, error, max(map(float, tips)), method, order)

    return shorten_steps(run, tolerance)


def _run(
    system: ModalSystem, y0: np.ndarray, t_end: float, tolerance: float, step_size: StepSize
) -> tuple[Trajectory, TimeError, int]:
    """Integrate with equal steps in each segment: path, error, and the order of the error."""
    edges, steps = _choose_steps(system, t_end, step_size)
    check_number_of_steps(sum(steps), system.size, t_end)
    segments = _propagate(system, edges, steps, y0, tolerance)
    error = estimate_time_error(system, segments, system.tips)
    return Trajectory(segments), error, ERROR_ORDER


def _choose_steps(system: ModalSystem, t_end: float, step_size: StepSize) -> tuple[np.ndarray, list[int]]:
    """Segments of a run, by their ends [s], and their numbers of steps.

    Neighbouring parts of one smooth piece are joined where steps of one size cost fewer steps more than
    the preparation of another segment is worth.
    """
    breakpoints = set(smooth_piece_ends(system.motion, t_end))
    edges, steps = [0.0], []
    parts = split_at_breakpoints(system.motion, t_end)
    for (a, b), count in zip(
        pairwise(parts.tolist()), step_size.count_steps_of_each(system, parts), strict=True
    ):
        if steps and a not in breakpoints:
            densest = max(steps[-1] / (a - edges[-2]), count / (b - a))
            joined = int(np.ceil(densest * (b - edges[-2]) * (1 - 1e-12)))
            if joined <= steps[-1] + count + _WORTH_A_SEGMENT:
                edges[-1], steps[-1] = b, joined
                continue
        edges.append(b)
        steps.append(count)
    return np.array(edges), steps


def _run_record(
    system: ModalSystem, y0: np.ndarray, t_end: float, tolerance: float, step_size: StepSize
) -> tuple[Trajectory, TimeError, int]:
    """Integrate a motion given by samples: path, error, and the order of the error."""
    steps, n = RecordSteps.choose(system, t_end, step_size), system.size
    check_number_of_steps(len(steps), n, t_end)
    segment = propagate_record(system, steps, y0[:n], y0[n:], STAGES, _SERIES_SHARE * tolerance)
    order = ERROR_ORDER if len(steps) == len(steps.piece_start) else _ORDER_ACROSS_SAMPLES
    return Trajectory((segment,)), estimate_time_error(system, (segment,), system.tips), order


def _between_samples(
    system: ModalSystem, t_end: float, wanted: StepSize, before: StepSize, order: int
) -> StepSize:
    """Step size of a record after another one, `before`, whose error had an order.

    Loads without kinks are integrated so much better than those across samples that one step between two
    samples comes after steps over many.  Later it is at least one more: so many steps have been tried.
    """
    most, last = (most_steps_in_piece(system, t_end, size) for size in (wanted, before))
    if order == ERROR_ORDER:
        steps = max(np.ceil(most), np.ceil(last) + 1)
    elif most > 1 > _FEW_STEPS * last:
        steps = 1
    else:
        return wanted
    return replace(wanted, phase=wanted.phase * _CEILED * most / steps)


def follow_steps(
    path: Trajectory, system: ModalSystem, y0: np.ndarray, tolerance: float
) -> tuple[Trajectory, float]:
    """Integrate other equations in the equal steps of a path.

    The other parameters and what is raised are those of `integrate`.

    Returns
    -------
    path : Trajectory
    error : float
        Error of the tip deflection [m] in those segments that state one; that of the others is not estimated.
    """
    steps = [len(segment.acceleration) for segment in path.segments]
    check_number_of_steps(sum(steps), system.size, path.end)
    edges = np.array([path.start, *(segment.end for segment in path.segments)])
    segments = _propagate(system, edges, steps, y0, tolerance)
    stated = [s for s in segments if isinstance(s, SegmentWithError)]
    return Trajectory(segments), estimate_time_error(system, stated, system.tips).total if stated else 0.0


def stays_in_equilibrium(system: ModalSystem, y0: np.ndarray, t_end: float) -> bool:
    """Whether the beam stays at rest: constant equations and an initial state in equilibrium."""
    if system.motion.steady_start > 0:
        return False
    _, K, f = system.coefficients(np.linspace(0, t_end, _TIMES_COMPARED))
    q, v = np.split(y0, 2)
    size = np.abs(K[0]) @ np.abs(q) + np.abs(f[0])
    balanced = not v.any() and (np.abs(f[0] - K[0] @ q) <= _BALANCE * size.max()).all()
    return balanced and bool((K[0] == K).all() and (f == f[0]).all())


class TooManySteps(InvalidValue):
    """A run that is refused because its steps would not fit into memory."""


def check_number_of_steps(steps: int, size: int, t_end: float) -> None:
    """Raise a `TooManySteps` if the steps of a run, of `size` coordinates each, do not fit into memory."""
    most = min(_MOST_STEPS, _MOST_VALUES // size)
    if steps > most:
        bound = f"it takes about {steps:.3g} steps in time; {most:.3g} of {size} coordinates fit into memory"
        remedy = "give an earlier end, a larger tolerance or fewer modes, or ask for the steady response"
        raise TooManySteps("t_end", t_end, bound, remedy, "s")


def split_at_breakpoints(motion: Motion, t_end: float) -> np.ndarray:
    """Split a run at the motion's breakpoints, and segments of changing speed into parts: all ends [s]."""
    parts = []
    for a, b in pairwise(smooth_piece_ends(motion, t_end)):
        speed_changes = np.ptp(motion.at(np.linspace(a, b, 9)[1:-1]).speed) > 0
        parts.append(np.linspace(a, b, (_PARTS if speed_changes else 1) + 1)[:-1])
    return np.concatenate([*parts, [t_end]])


def _propagate(
    system: ModalSystem, edges: np.ndarray, steps: Sequence[int], y0: np.ndarray, tolerance: float
) -> tuple[Segment, ...]:
    """Integrate segment by segment, with the given numbers of steps."""
    segments, n, accuracy = [], system.size, _SERIES_SHARE * tolerance
    for (a, b), count in zip(pairwise(edges), steps, strict=True):
        segments.append(_propagate_segment(system, a, b, count, y0[:n], y0[n:], accuracy))
        y0 = segments[-1].state[-1, 1:]
    return tuple(segments)


def _propagate_segment(
    system: ModalSystem, a: float, b: float, steps: int, q: np.ndarray, v: np.ndarray, accuracy: float
) -> Segment:
    """Integrate a segment: by the series for weakly modulated stiffness if it converges, else directly."""
    modulated = system.modulated(a, b)
    if modulated is not None:
        for propagate_all in (propagate_in_closed_form, propagate_modulated):
            segment = propagate_all(modulated, a, b, steps, q, v, STAGES, accuracy)
            if segment is not None:
                return segment
    return propagate(system, a, b, steps, q, v, STAGES)
