"""Estimate of the time-integration error, by solving some steps again with two more stages.

With equal steps, some steps of each segment are solved again; steps that span many samples are solved again
from sample to sample.

In shapes of arrays, n counts coordinates, k steps, and d components.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Legendre

from beamdyn.accuracy.refinement import STEPS
from beamdyn.transient.gauss import Segment, StepMaps, interpolate, solve_steps, tableau
from beamdyn.transient.record_steps import RecordSegment, RecordSteps, maps_of_record
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import magnitude

STAGES = 8  # number of stages of the Gauss collocation that is checked
ERROR_ORDER = 2 * STAGES  # order of convergence of the collocation error with respect to the step size
_MOST_CHECKED = 32  # number of steps of a segment at which the local error is estimated
_ROUGHEST = 2  # further checked steps per coordinate: those with the largest interpolation error
# Reciprocal of the golden ratio: spacing points by it avoids coincidence with a period.
_GOLDEN = 0.6180339887498949
# Fractions of a step at which the interpolation error is largest.
INTERPOLATION_POINTS = np.array([0.1, 0.4, 0.6, 0.9])
UNRESOLVED_PHASE = 0.05  # phase error per step [rad] above which a mode counts as unresolved
# Rounding error of each component of the state at the end of a step.  The component is a sum of products, of
# the entries of a matrix and the state at the start; the error is relative to the sum of their magnitudes.
_ROUNDING = 1e-14

_PIECES_CHECKED = 128  # number of sample intervals in the checked steps, unless that gives too few steps
_FEWEST_CHECKED = 48
# Fractions of a sample interval at which the error between its ends is evaluated.
_POINTS = np.arange(10) / 10
# Number of longest steps, and of steps with the roughest load, checked in addition to those spread over the
# run.
_MOST_OF_A_KIND = 24
_BATCH = 256  # number of sample intervals solved as one batch


def choose_checked_steps(steps: int, most: int = _MOST_CHECKED) -> np.ndarray:
    """Choose the indices of at most `most` steps of a segment to be checked."""
    if steps <= most:
        return np.arange(steps)
    return np.unique((steps * (_GOLDEN * np.arange(most) % 1)).astype(int))


@dataclass(frozen=True)
class SegmentError:
    """Time-integration error of a segment, in coordinates.

    Parameters
    ----------
    coordinates : ndarray, shape (n,)
        Largest error of each coordinate at the ends of the steps.
    interpolation : ndarray, shape (steps, n)
        Interpolation errors at some times.
    unresolved : ndarray of bool, shape (n,)
        Whether the steps are too long to follow the free vibration of a coordinate.
    """

    coordinates: np.ndarray
    interpolation: np.ndarray
    unresolved: np.ndarray


@dataclass(frozen=True)
class SegmentWithError(Segment):
    """Segment of a trajectory whose error is known from the method of its computation.

    Parameters
    ----------
    error : SegmentError
        Time-integration error of the segment.
    """

    error: SegmentError


@dataclass(frozen=True)
class TimeError:
    """Estimated time-integration error of an output, such as the tip deflection.

    Parameters
    ----------
    modes : ndarray, shape (n,)
        Contributions of the coordinates, by ascending frequency at rest [unit of the output].
    interpolation : float
        Interpolation error between the ends of steps [unit of the output].
    unresolved : ndarray of bool, shape (n,)
        Whether the steps are too long to follow the free vibration of a mode.
    """

    modes: np.ndarray
    interpolation: float
    unresolved: np.ndarray

    @classmethod
    def of_coordinates(
        cls, system: ModalSystem, modes: np.ndarray, interpolation: float, unresolved: np.ndarray
    ) -> TimeError:
        """Build the error from the contributions of a system's coordinates, sorted by frequency."""
        rank = np.argsort(np.diag(system.equations.matrices[0]["unity"]), kind="stable")
        return cls(modes[rank], interpolation, unresolved[rank])

    @property
    def total(self) -> float:
        """Sum of all contributions, with a safety factor [unit of the output]."""
        return STEPS.factor * (float(self.modes.sum()) + self.interpolation)


def estimate_time_error(
    system: ModalSystem, segments: Sequence[Segment | RecordSegment], outputs: np.ndarray
) -> TimeError:
    """Estimate the time-integration error of a quantity from the errors of all segments.

    Parameters
    ----------
    system : ModalSystem
        The equations.
    segments : sequence of Segment, or of one RecordSegment
        The segments of a trajectory.
    outputs : ndarray, shape (components, coordinates)
        Quantity whose error is estimated, such as the tip deflection, per unit of each coordinate: d
        components of a vector; the result is the magnitude of the vector's error.

    Returns
    -------
    TimeError
    """
    if len(segments) == 1 and isinstance(record := segments[0], RecordSegment):
        return _error_of_record(system, record, outputs)
    frequencies = vibration_frequencies(system, sum(s.end - s.start for s in segments))
    errors = [
        s.error if isinstance(s, SegmentWithError) else _error_of_steps(system, s, frequencies)
        for s in segments
        if isinstance(s, Segment)
    ]
    zero = np.zeros(system.size)
    modes = sum((e.coordinates for e in errors), zero) * size_per_coordinate(outputs)
    interpolation = max((float(magnitude(e.interpolation, outputs).max()) for e in errors), default=0.0)
    unresolved = np.logical_or.reduce([zero > 0, *(e.unresolved for e in errors)])
    return TimeError.of_coordinates(system, modes, interpolation, unresolved)


def _error_of_steps(system: ModalSystem, segment: Segment, frequencies: np.ndarray) -> SegmentError:
    """Estimate a segment's error from local errors of steps spread over it, and of the roughest steps.

    Gauss collocation preserves amplitudes; its error is one of phase.  A mode's local errors therefore add up
    coherently until its phase is lost, after 2 / delta steps with a phase error delta per step.  The error
    of a mode that the steps do not resolve is thus bounded by the amplitude of its free vibration.  A
    stiffness that varies within a step, as on a wavy road, transfers the error of one mode to another.
    """
    h, steps, own, more = segment.h, len(segment.acceleration), tableau(STAGES), tableau(STAGES + 2)
    # The last term of the polynomial in a step is as large as the interpolation error: it shows the roughest
    # steps.
    series = own.b * Legendre.basis(STAGES - 1)(2 * own.c - 1)
    last = np.abs(np.einsum("s,ksn->kn", series, segment.acceleration))
    roughest = np.unique(np.argsort(last, axis=0)[-_ROUGHEST:])
    chosen = np.union1d(choose_checked_steps(steps), roughest)
    state, starts = segment.state[chosen], segment.start + h * chosen
    C, K, f = system.coefficients(starts[:, None] + h * np.concatenate([own.c, more.c]))
    maps, finer = (
        solve_steps(None if C is None else C[:, part], K[:, part], f[:, part], h, table)
        for part, table in ((slice(None, STAGES), own), (slice(STAGES, None), more))
    )
    local = local_errors(maps.step, finer.step, state, segment.state[chosen + 1, 1:], frequencies)
    delta = phase_errors(finer.step - maps.step, frequencies)
    accelerations = segment.acceleration[chosen], (finer.acceleration @ state[:, None, :, None])[..., 0]
    q = [interpolate(h, state, a, INTERPOLATION_POINTS)[0] for a in accelerations]
    total = _total_of_local_errors(local, delta, steps)
    coupling = np.ptp(K, axis=1).max(axis=0) / 2
    np.fill_diagonal(coupling, 0.0)
    total = total + coupling @ total / frequencies**2
    return SegmentError(total, (q[0] - q[1]).reshape(-1, system.size), delta > UNRESOLVED_PHASE)


def size_per_coordinate(outputs: np.ndarray) -> np.ndarray:
    """Compute the magnitude of an output vector, such as the tip deflection, per unit of each coordinate.

    The rows of `outputs` are the components of the vector per unit of each coordinate.
    """
    return np.hypot.reduce(np.abs(outputs))


def _total_of_local_errors(local: np.ndarray, delta: np.ndarray, steps: int) -> np.ndarray:
    """Bound the error of each coordinate after a number of steps.

    Local errors add up until the phase of a coordinate is lost, after 2 / delta steps, where delta [rad] is
    its largest phase error per step.  The bound is the sum of all local errors or, if this is less, the
    largest local error times 2 / delta.
    """
    until_lost = 2 / np.maximum(delta, 1e-30)  # number of steps until the phase is lost
    return np.minimum(steps * local.mean(axis=0), until_lost * local.max(axis=0))


def local_errors(
    step: np.ndarray, fine: np.ndarray, state: np.ndarray, end_state: np.ndarray, frequencies: np.ndarray
) -> np.ndarray:
    """Compute the local error of each step and coordinate as an amplitude: collocation and rounding error.

    Parameters
    ----------
    step, fine : ndarray, shape (steps, 2 n, 2 n + 1)
        Maps of the steps, and maps with more stages, which are more accurate.
    state : ndarray, shape (steps, 2 n + 1)
        Augmented states at the beginnings of the steps.
    end_state : ndarray, shape (steps, 2 n)
        Computed coordinates and velocities at the ends of the steps.
    frequencies : ndarray, shape (n,)
        Angular frequencies of the coordinates, of `vibration_frequencies` [rad/s].

    Returns
    -------
    ndarray, shape (steps, n)
    """
    n = len(frequencies)
    residual = np.einsum("kij,kj->ki", step, state) - end_state
    size = np.einsum("kij,kj->ki", np.abs(step), np.abs(state))
    residual[np.abs(residual) <= _ROUNDING * size] = 0  # rounding errors are random: they do not add up
    error = np.abs(np.einsum("kij,kj->ki", fine - step, state)) + np.abs(residual)
    return np.hypot(error[:, :n], error[:, n:] / frequencies)


def phase_errors(difference: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    """Compute each coordinate's largest phase error per step [rad] from the difference of two step maps."""
    n, k = len(frequencies), np.arange(len(frequencies))
    by_velocity = np.abs(difference[:, k, 1 + n + k]) * frequencies
    return np.maximum(np.abs(difference[:, k, 1 + k]), by_velocity).max(axis=0)


def vibration_frequencies(system: ModalSystem, duration: float) -> np.ndarray:
    """Compute the angular frequency of each uncoupled coordinate at time 0 [rad/s].

    The frequency converts an error of velocity to one of the coordinate.  With a hinged root or for a
    circuit's flux it may be 0: the velocity error then accumulates over the duration [s] of the run.
    """
    _, K, _ = system.coefficients(np.zeros(()))
    slowest = 1 / duration if system.equations.shift or system.equations.voltage else 0.0
    return np.maximum(np.sqrt(np.abs(np.diag(K))), slowest)


# Error of steps over many samples -----------------------------------------------------------------


def _error_of_record(system: ModalSystem, segment: RecordSegment, outputs: np.ndarray) -> TimeError:
    """Estimate the error of a quantity by solving some steps again from sample to sample.

    These solutions have two more stages or, in steps of many samples, as many as the sample intervals need.
    Some steps are spread over the run and represent all steps; others are the longest ones, and those with
    the roughest load.
    """
    steps, count, total, interpolation = segment.steps, len(segment.steps), np.zeros(system.size), 0.0
    unresolved, across = np.zeros(system.size, dtype=bool), count < len(steps.piece_start)
    most = max(_FEWEST_CHECKED, _PIECES_CHECKED // int(steps.counts.mean()))
    middle = steps.piece_start + steps.piece_width / 2
    slope = np.diff(system.equations.load(system.root(middle)), axis=0) / np.diff(middle)[:, None]
    bend = np.pad(np.abs(np.diff(slope, axis=0)).sum(axis=1), 1, mode="edge")
    # Steps are ranked by their length, and by the roughness of the load: a change of the load's slope changes
    # displacements in proportion to the cube of the step size.
    kinds = steps.h, steps.h**3 * np.maximum.reduceat(bend, steps.first)
    worst = np.unique([np.argsort(kind)[-_MOST_OF_A_KIND:] for kind in kinds])
    for chosen, represented in ((choose_checked_steps(count, most), count), (worst, len(worst))):
        batches = np.array_split(chosen, -(-int(steps.counts[chosen].sum()) // _BATCH))
        found = [_check_batch(system, segment, batch, outputs) for batch in batches if len(batch)]
        local = np.concatenate([each[0] for each in found])
        delta = np.max([each[1] for each in found], axis=0)
        added = _total_of_local_errors(local, delta, represented)
        if across:  # errors by samples inside a step are random, so their squares are added
            added = np.maximum(added, np.sqrt(represented) * local.mean(axis=0))
        total += added
        unresolved |= delta > UNRESOLVED_PHASE
        interpolation = max(interpolation, *(each[2] for each in found))
    modes = total * size_per_coordinate(outputs)
    return TimeError.of_coordinates(system, modes, interpolation, unresolved)


def _check_batch(
    system: ModalSystem, segment: RecordSegment, chosen: np.ndarray, outputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Compare the steps `chosen` with solutions of their pieces, which are more accurate.

    Return the local errors (k, n), the largest phase error of each coordinate per step [rad], and the largest
    error between the ends of steps, in units of the output.
    """
    steps, state = segment.steps.select(chosen), segment.state[chosen]
    step = maps_of_record(system, steps, STAGES).step
    pieces = maps_of_record(system, steps.pieces(), steps.nodes_in_piece(STAGES + 2))
    fine, at_pieces = _compose(steps, pieces, state)
    a = (pieces.acceleration @ at_pieces[:, None, :, None])[..., 0]
    q, _ = interpolate(steps.piece_width[:, None, None], at_pieces, a, _POINTS)
    t = steps.piece_start[:, None] + steps.piece_width[:, None] * _POINTS
    between = magnitude(segment.at(t.ravel())[0] - q.reshape(t.size, -1), outputs).max()
    frequencies = vibration_frequencies(system, segment.end - segment.start)
    local = local_errors(step, fine, state, segment.state[chosen + 1, 1:], frequencies)
    return local, phase_errors(fine - step, frequencies), float(between)


def _compose(steps: RecordSteps, pieces: StepMaps, state: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Multiply the maps of pieces to maps of steps, and compute the states at the beginnings of pieces."""
    size = state.shape[1]
    total = np.tile(np.eye(size), (len(steps), 1, 1))
    at_pieces = np.empty((len(steps.piece_start), size))
    for k in range(steps.counts.max()):
        longer = np.flatnonzero(steps.counts > k)
        here = steps.first[longer] + k
        at_pieces[here] = (total[longer] @ state[longer, :, None])[..., 0]
        total[longer, 1:] = pieces.step[here] @ total[longer]
    return total[:, 1:], at_pieces
