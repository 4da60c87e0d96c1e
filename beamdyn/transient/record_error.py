"""Time-integration error of steps over many samples: some steps are solved again, piece by piece."""

from __future__ import annotations

import numpy as np

from beamdyn.transient.gauss import StepMaps, interpolate
from beamdyn.transient.record_steps import RecordSegment, RecordSteps, maps_of_record
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import (
    STAGES,
    UNRESOLVED_PHASE,
    TimeError,
    choose_checked_steps,
    local_errors,
    phase_errors,
    size_per_coordinate,
    total_of_local_errors,
    vibration_frequencies,
)
from beamdyn.transient.trajectory import magnitude

_PIECES_CHECKED = 128  # in the steps that are checked, if these are not too few
_FEWEST_CHECKED = 48
_POINTS = np.arange(10) / 10  # fractions of a piece at which the error between ends is sought
_MOST_OF_A_KIND = 24  # longest and roughest steps that are checked besides those spread over the run
_BATCH = 256  # pieces that are solved at once


def estimate_record_error(system: ModalSystem, segment: RecordSegment, outputs: np.ndarray) -> TimeError:
    """Estimate the time-integration error of a quantity, as `estimate_time_error` does.

    The checked steps are solved again from sample to sample, with two more stages, or where a step has many
    samples with as many as these need.  Some are spread over the run and stand for all; the others are the
    longest, and those in which the load is roughest.

    Parameters
    ----------
    system : ModalSystem
        The equations.
    segment : RecordSegment
        The run.
    outputs : ndarray, shape (d, n)
        As for `estimate_time_error`.

    Returns
    -------
    TimeError
    """
    count, total, interpolation = len(segment.steps), np.zeros(system.size), 0.0
    unresolved, across = np.zeros(system.size, dtype=bool), count < len(segment.steps.piece_start)
    most = max(_FEWEST_CHECKED, _PIECES_CHECKED // int(segment.steps.counts.mean()))
    spread, worst = choose_checked_steps(count, most), _find_worst(system, segment.steps)
    for chosen, represented in ((spread, count), (worst, len(worst))):
        local, delta, between = _check(system, segment, chosen, outputs)
        added = total_of_local_errors(local, delta, represented)
        if across:  # what samples inside a step change in its load adds up by chance
            added = np.maximum(added, np.sqrt(represented) * local.mean(axis=0))
        total += added
        unresolved |= delta > UNRESOLVED_PHASE
        interpolation = max(interpolation, between)
    modes = total * size_per_coordinate(outputs)
    return TimeError.of_coordinates(system, modes, interpolation, unresolved)


def _find_worst(system: ModalSystem, steps: RecordSteps) -> np.ndarray:
    """Indices of the longest steps, and of those whose displacement the bends of the load change most."""
    middle = steps.piece_start + steps.piece_width / 2
    slope = np.diff(system.equations.load(system.root(middle)), axis=0) / np.diff(middle)[:, None]
    bend = np.pad(np.abs(np.diff(slope, axis=0)).sum(axis=1), 1, mode="edge")
    kinds = steps.h, steps.h**3 * np.maximum.reduceat(bend, steps.first)
    return np.unique([np.argsort(kind)[-_MOST_OF_A_KIND:] for kind in kinds])


def _check(
    system: ModalSystem, segment: RecordSegment, chosen: np.ndarray, outputs: np.ndarray
) -> tuple[np.ndarray, np.ndarray, float]:
    """Local errors and largest phase error of each coordinate, and largest error of the quantity."""
    batches = np.array_split(chosen, -(-int(segment.steps.counts[chosen].sum()) // _BATCH))
    local, delta, between = zip(
        *(_check_batch(system, segment, batch, outputs) for batch in batches if len(batch)), strict=True
    )
    return np.concatenate(local), np.max(delta, axis=0), max(between)


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
