"""Time integration of a scene's equations to a tolerance: choice of step size, error estimate, refinement.

A straight beam has linear equations, solved as affine maps of many steps at once; the nonlinear equations of
large deflection (`elastica_steps`) are solved step by step.  Both use the same control of the step size.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beamdyn.transient import record_steps
from beamdyn.transient.beam_in_space_system import AnySystem, BeamInSpaceSystem
from beamdyn.transient.closed_form import propagate_in_closed_form
from beamdyn.transient.elastica_steps import attempt_elastica, rest_in_equilibrium
from beamdyn.transient.gauss import Segment, propagate
from beamdyn.transient.step_size import (
    Attempt,
    StepSize,
    chain_segments,
    check_number_of_steps,
    shorten_steps,
    split_at_breakpoints,
)
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import ERROR_ORDER, STAGES, SegmentWithError, estimate_time_error
from beamdyn.transient.trajectory import Trajectory, magnitude
from beamdyn.transient.weakly_modulated import propagate_modulated

_WORTH_A_SEGMENT = 500  # number of steps whose cost equals that of the preparation of a segment
_TIMES_COMPARED = 257  # number of times at which it is checked whether the equations are constant
_BALANCE = 1e-13  # residual force, over the largest force, below which it is a rounding error of equilibrium
# Fraction of the tolerance allowed for truncating the series in steps with weakly varying stiffness.
_SERIES_SHARE = 0.1
_ORDER_ACROSS_SAMPLES = 3  # order of the error of steps across samples, where the acceleration has kinks
# If the last steps spanned more than this number of sample intervals, and the next ones would be shorter than
# an interval, steps of one interval are tried first.
_FEW_STEPS = 4
_CEILED = 1.02  # factor by which steps are lengthened: rounding up their number (some hundreds) shortens them


def integrate(
    system: AnySystem, y0: np.ndarray, t_end: float, tolerance: float
) -> tuple[Trajectory, float, str]:
    """Integrate with the step size for the tolerance; use smaller steps while the estimated error exceeds it.

    Parameters
    ----------
    system : AnySystem
        The equations.
    y0 : ndarray, shape (2 n,)
        Coordinates and velocities at time 0.
    t_end : float
        End of the run [s].
    tolerance : float
        Target of the time-integration error, relative to the largest deflection.

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
    ArithmeticError
        If the steps of a beam with large deflection cannot be solved at any size.
    """
    if isinstance(system, BeamInSpaceSystem):
        path = rest_in_equilibrium(system, y0, t_end)
        attempt = partial(attempt_elastica, system, y0, t_end)
    else:
        start = _Start(system, y0, t_end, tolerance)
        path = _rest_in_equilibrium(start)
        by_samples = record_steps.is_record(system, t_end, StepSize.from_tolerance(tolerance))
        attempt = partial(_attempt_record if by_samples else _attempt, start)
    if path is not None:
        return path, 0.0, "no steps: the beam stays in equilibrium"
    return shorten_steps(attempt, tolerance)


class _Start(NamedTuple):
    """Input of an integration: equations of a straight beam, initial state, end [s], and tolerance."""

    system: ModalSystem
    y0: np.ndarray
    t_end: float
    tolerance: float


def _rest_in_equilibrium(start: _Start) -> Trajectory | None:
    """Build the motion of a beam that stays at rest, if the equations are constant and forces in equilibrium.

    Return None if this is not so.
    """
    system, y0, t_end, tolerance = start
    if system.motion.steady_start > 0:
        return None
    _, K, f = system.coefficients(np.linspace(0, t_end, _TIMES_COMPARED))
    q, v = np.split(y0, 2)
    size = np.abs(K[0]) @ np.abs(q) + np.abs(f[0])
    balanced = not v.any() and (np.abs(f[0] - K[0] @ q) <= _BALANCE * size.max()).all()
    if not (balanced and (K[0] == K).all() and (f == f[0]).all()):
        return None
    edges = record_steps.smooth_piece_ends(system.motion, t_end)
    return Trajectory(_propagate(system, edges, [1] * (len(edges) - 1), y0, tolerance))


def _attempt(start: _Start, step_size: StepSize, _: Attempt | None) -> Attempt:
    """Integrate with equal steps in each segment.

    Neighbouring parts of a smooth piece of the motion are joined to one segment, with the denser steps of the
    two, if the additional steps cost less than the preparation of another segment.
    """
    system, y0, t_end, tolerance = start
    breakpoints = set(record_steps.smooth_piece_ends(system.motion, t_end))
    edges, steps = [0.0], []
    parts = split_at_breakpoints(system.motion, t_end)
    counts = step_size.count_steps_of_each(system, parts)
    for (a, b), count in zip(pairwise(parts.tolist()), counts, strict=True):
        if steps and a not in breakpoints:
            densest = max(steps[-1] / (a - edges[-2]), count / (b - a))
            joined = int(np.ceil(densest * (b - edges[-2]) * (1 - 1e-12)))
            if joined <= steps[-1] + count + _WORTH_A_SEGMENT:
                edges[-1], steps[-1] = b, joined
                continue
        edges.append(b)
        steps.append(count)
    check_number_of_steps(sum(steps), system.size, t_end)
    path = Trajectory(_propagate(system, np.array(edges), steps, y0, tolerance))
    return _judged(system, step_size, path, ERROR_ORDER)


def _attempt_record(start: _Start, step_size: StepSize, before: Attempt | None) -> Attempt:
    """Integrate a motion given by samples; take account of the attempt `before`, if any.

    Steps without a sample inside are far more accurate than steps across samples.  So after steps across many
    samples, one step per sample interval is tried; each later attempt has more steps per interval.
    """
    system, y0, t_end, tolerance = start
    if before is not None:
        most, last = (
            record_steps.most_steps_in_piece(system, t_end, size) for size in (step_size, before.step_size)
        )
        wanted = None
        if before.order == ERROR_ORDER:
            wanted = max(np.ceil(most), np.ceil(last) + 1)
        elif most > 1 > _FEW_STEPS * last:
            wanted = 1
        if wanted is not None:
            step_size = replace(step_size, phase=step_size.phase * _CEILED * most / wanted)
    steps, n = record_steps.RecordSteps.choose(system, t_end, step_size), system.size
    check_number_of_steps(len(steps), n, t_end)
    segment = record_steps.propagate_record(system, steps, y0[:n], y0[n:], STAGES, _SERIES_SHARE * tolerance)
    order = ERROR_ORDER if len(steps) == len(steps.piece_start) else _ORDER_ACROSS_SAMPLES
    return _judged(system, step_size, Trajectory((segment,)), order)


def _judged(system: ModalSystem, step_size: StepSize, path: Trajectory, order: int) -> Attempt:
    """Build an attempt from a path: error estimate, largest deflection at step ends, name of the method."""
    error = estimate_time_error(system, path.segments, system.tips)
    largest = max(float(magnitude(s.state[:, 1 : system.size + 1], system.tips).max()) for s in path.segments)
    steps = sum(len(s.acceleration) for s in path.segments)
    method = f"Gauss collocation of order {ERROR_ORDER}, {steps} steps"
    return Attempt(step_size, path, error, largest, method, order)


def follow_steps(
    path: Trajectory, system: ModalSystem, y0: np.ndarray, tolerance: float
) -> tuple[Trajectory, float]:
    """Integrate a system with the time steps of a trajectory `path` that was computed for another system.

    Other parameters and errors raised: see `integrate`.

    Returns
    -------
    path : Trajectory
    error : float
        Estimated error of the tip deflection [m], from segments that are solved by series or in closed form;
        the error of other segments is not estimated.
    """
    steps = [len(segment.acceleration) for segment in path.segments]
    check_number_of_steps(sum(steps), system.size, path.end)
    edges = np.array([path.start, *(segment.end for segment in path.segments)])
    segments = _propagate(system, edges, steps, y0, tolerance)
    stated = [s for s in segments if isinstance(s, SegmentWithError)]
    return Trajectory(segments), estimate_time_error(system, stated, system.tips).total if stated else 0.0


def _propagate(
    system: ModalSystem, edges: np.ndarray, steps: Sequence[int], y0: np.ndarray, tolerance: float
) -> tuple[Segment, ...]:
    """Integrate from y0 over the segments with the ends `edges` [s], each in its number of equal steps.

    A segment whose stiffness varies weakly is integrated in closed form or by a series if one of them
    converges, otherwise by Gauss collocation.
    """
    accuracy = _SERIES_SHARE * tolerance

    def propagate_one(a: float, b: float, count: int, q: np.ndarray, v: np.ndarray) -> Segment:
        if (modulated := system.modulated(a, b)) is not None:
            for by_series in (propagate_in_closed_form, propagate_modulated):
                if (segment := by_series(modulated, a, b, count, q, v, STAGES, accuracy)) is not None:
                    return segment
        return propagate(system, a, b, count, q, v, STAGES)

    return chain_segments(edges, steps, y0, propagate_one)
