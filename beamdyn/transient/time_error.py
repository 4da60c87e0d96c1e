"""Time-integration error, estimated by solving some steps again with two more stages.

Of equal steps some in each segment are solved again; steps over many samples are solved again piece by piece.
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

STAGES = 8  # stages of the Gauss collocation that is checked
ERROR_ORDER = 2 * STAGES  # order of its error in the step size
_MOST_CHECKED = 32  # steps of a segment at which the local error is measured
_ROUGHEST = 2  # more of them for each coordinate, where the interpolation error is largest
_GOLDEN = 0.6180339887498949  # 1 / golden ratio: such spacing misses no period of the motion
INTERPOLATION_POINTS = np.array([0.1, 0.4, 0.6, 0.9])  # fractions of a step with the largest error
UNRESOLVED_PHASE = 0.05  # phase error per step [rad] above which a mode counts as unresolved
_ROUNDING = 1e-14  # rounding error of a step, over the sum of the magnitudes of its terms

_PIECES_CHECKED = 128  # pieces in the steps over samples that are checked, if these are not too few
_FEWEST_CHECKED = 48
_POINTS = np.arange(10) / 10  # fractions of a piece at which the error between ends is sought
_MOST_OF_A_KIND = 24  # longest and roughest steps that are checked besides those spread over the run
_BATCH = 256  # pieces that are solved at once


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
    interpolation : ndarray, shape (k, n)
        Interpolation errors at some times.
    unresolved : ndarray of bool, shape (n,)
        Whether the steps are too long to follow the free vibration of a coordinate.
    """

    coordinates: np.ndarray
    interpolation: np.ndarray
    unresolved: np.ndarray


@dataclass(frozen=True)
class SegmentWithError(Segment):
    """Segment of a trajectory whose error is known from how it was found.

    Parameters
    ----------
    error : SegmentError
        Its error.
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
        """Sort the contributions of the coordinates of a system by frequency."""
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
    outputs : ndarray, shape (d, n)
        The quantity whose error is sought, such as the tip deflection, per unit of each coordinate: the d
        components of a vector, whose error is the magnitude of that of the vector.

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
    """Error of a segment by the local errors of some steps: spread over it, and the roughest.

    Gauss collocation keeps amplitudes and errs in phase.  A mode's local errors therefore add up
    coherently until its phase is lost, after 2 / delta steps with a phase error delta per step.  The error
    of a mode that the steps do not resolve is thus bounded by the amplitude of its free vibration.  What the
    stiffness varies within a step, such as on a wavy road, turns the error of one mode into that of another.
    """
    h, steps, own, more = segment.h, len(segment.acceleration), tableau(STAGES), tableau(STAGES + 2)
    series = own.b * Legendre.basis(STAGES - 1)(2 * own.c - 1)  # its last term: as the interpolation errs
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
    """Magnitude of a vector of d components per unit of each coordinate, (n,), from the components (d, n)."""
    return np.hypot.reduce(np.abs(outputs))


def _total_of_local_errors(local: np.ndarray, delta: np.ndarray, steps: int) -> np.ndarray:
    """Error of each coordinate after some steps, from local errors (k, n) and the largest phase error (n,).

    It is at most the sum of all local errors, and at most what the largest add up to until the phase is lost.
    """
    until_lost = 2 / np.maximum(delta, 1e-30)  # steps
    return np.minimum(steps * local.mean(axis=0), until_lost * local.max(axis=0))


def local_errors(
    step: np.ndarray, fine: np.ndarray, state: np.ndarray, end_state: np.ndarray, frequencies: np.ndarray
) -> np.ndarray:
    """Local error of each step and coordinate, as an amplitude: of the collocation and of its solution.

    Parameters
    ----------
    step, fine : ndarray, shape (k, 2 n, 2 n + 1)
        Maps of the steps, and more accurate ones.
    state : ndarray, shape (k, 2 n + 1)
        Augmented states at their beginnings.
    end_state : ndarray, shape (k, 2 n)
        Computed coordinates and velocities at their ends.
    frequencies : ndarray, shape (n,)
        As `vibration_frequencies` has them.

    Returns
    -------
    ndarray, shape (k, n)
    """
    n = len(frequencies)
    residual = np.einsum("kij,kj->ki", step, state) - end_state
    size = np.einsum("kij,kj->ki", np.abs(step), np.abs(state))
    residual[np.abs(residual) <= _ROUNDING * size] = 0  # rounding, which does not add up
    error = np.abs(np.einsum("kij,kj->ki", fine - step, state)) + np.abs(residual)
    return np.hypot(error[:, :n], error[:, n:] / frequencies)


def phase_errors(difference: np.ndarray, frequencies: np.ndarray) -> np.ndarray:
    """Largest phase error of each coordinate per step [rad], from the difference of two step maps."""
    n, k = len(frequencies), np.arange(len(frequencies))
    by_velocity = np.abs(difference[:, k, 1 + n + k]) * frequencies
    return np.maximum(np.abs(difference[:, k, 1 + k]), by_velocity).max(axis=0)


def vibration_frequencies(system: ModalSystem, duration: float) -> np.ndarray:
    """Angular frequency of each coordinate, uncoupled, at time 0 [rad/s].

    An error of velocity over it is one of the coordinate.  On a hinge it may be 0: the error of velocity
    then grows to one of the coordinate over the duration [s] of the run; so does that of a circuit's flux.
    """
    _, K, _ = system.coefficients(np.zeros(()))
    slowest = 1 / duration if system.equations.shift or system.equations.voltage else 0.0
    return np.maximum(np.sqrt(np.abs(np.diag(K))), slowest)


# Steps over many samples --------------------------------------------------------------------------


def _error_of_record(system: ModalSystem, segment: RecordSegment, outputs: np.ndarray) -> TimeError:
    """Error of a quantity: the checked steps are solved again from sample to sample.

    They have two more stages, or where a step has many samples as many as these need.  Some are spread over
    the run and stand for all; the others are the longest, and those in which the load is roughest.
    """
    steps, count, total, interpolation = segment.steps, len(segment.steps), np.zeros(system.size), 0.0
    unresolved, across = np.zeros(system.size, dtype=bool), count < len(steps.piece_start)
    most = max(_FEWEST_CHECKED, _PIECES_CHECKED // int(steps.counts.mean()))
    middle = steps.piece_start + steps.piece_width / 2
    slope = np.diff(system.equations.load(system.root(middle)), axis=0) / np.diff(middle)[:, None]
    bend = np.pad(np.abs(np.diff(slope, axis=0)).sum(axis=1), 1, mode="edge")
    kinds = steps.h, steps.h**3 * np.maximum.reduceat(bend, steps.first)  # as the bends change displacements
    worst = np.unique([np.argsort(kind)[-_MOST_OF_A_KIND:] for kind in kinds])
    spread = choose_checked_steps(count, most)
    for chosen, represented in ((spread, count), (worst, len(worst))):
        batches = np.array_split(chosen, -(-int(steps.counts[chosen].sum()) // _BATCH))
        found = [_check_batch(system, segment, batch, outputs) for batch in batches if len(batch)]
        local = np.concatenate([each[0] for each in found])
        delta = np.max([each[1] for each in found], axis=0)
        added = _total_of_local_errors(local, delta, represented)
        if across:  # what samples inside a step change in its load adds up by chance
            added = np.maximum(added, np.sqrt(represented) * local.mean(axis=0))
        total += added
        unresolved |= delta > UNRESOLVED_PHASE
        interpolation = max(interpolation, *(each[2] for each in found))
    modes = total * size_per_coordinate(outputs)
    return TimeError.of_coordinates(system, modes, interpolation, unresolved)


def _check_batch(
    system: ModalSystem, segment: RecordSegment, chosen: np.ndarray, outputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Local error of each chosen step, largest phase error and error between ends, against their pieces."""
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
    """Compose the maps of pieces to those of their steps, and find the states where the pieces begin."""
    size = state.shape[1]
    total = np.tile(np.eye(size), (len(steps), 1, 1))
    at_pieces = np.empty((len(steps.piece_start), size))
    for k in range(steps.counts.max()):
        longer = np.flatnonzero(steps.counts > k)
        here = steps.first[longer] + k
        at_pieces[here] = (total[longer] @ state[longer, :, None])[..., 0]
        total[longer, 1:] = pieces.step[here] @ total[longer]
    return total[:, 1:], at_pieces
