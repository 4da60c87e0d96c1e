"""Time-integration error, estimated by solving some steps of each segment again with two more stages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Legendre

from beamdyn.accuracy.margins import STEPS
from beamdyn.transient.gauss import Segment, StepMaps, interpolate, solve_steps, tableau
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import magnitude

STAGES = 8  # of the Gauss collocation that is checked
ERROR_ORDER = 2 * STAGES  # of its error, in the step size
_MOST_CHECKED = 32  # steps of a segment at which the local error is measured
_ROUGHEST = 2  # more of them for each coordinate, where the interpolation error is largest
_GOLDEN = 0.6180339887498949  # 1 / golden ratio: such spacing misses no period of the motion
INTERPOLATION_POINTS = np.array([0.1, 0.4, 0.6, 0.9])  # fractions of a step with the largest error
UNRESOLVED_PHASE = 0.05  # phase error per step [rad] above which a mode counts as unresolved
_ROUNDING = 1e-14  # rounding error of a step, over the sum of the magnitudes of its terms


@dataclass(frozen=True)
class CheckedSteps:
    """The steps of a segment at which the local error is measured.

    Parameters
    ----------
    starts : ndarray, shape (k,)
        Times at which they begin [s].
    h : float
        Step size [s].
    steps : int
        Number of steps of the whole segment.
    state : ndarray, shape (k, 2 n + 1)
        Augmented states (1, q, v) at the beginnings of the checked steps.
    end_state : ndarray, shape (k, 2 n)
        Computed coordinates and velocities at their ends.
    acceleration : ndarray, shape (k, s, n)
        Computed accelerations at their nodes.
    """

    starts: np.ndarray
    h: float
    steps: int
    state: np.ndarray
    end_state: np.ndarray
    acceleration: np.ndarray

    @classmethod
    def of_segment(cls, segment: Segment) -> CheckedSteps:
        """Select the checked steps of a segment."""
        steps = len(segment.acceleration)
        chosen = np.union1d(choose_checked_steps(steps), _find_roughest(segment.acceleration))
        starts = segment.start + segment.h * chosen
        ends = segment.state[chosen + 1, 1:]
        return cls(starts, segment.h, steps, segment.state[chosen], ends, segment.acceleration[chosen])


def choose_checked_steps(steps: int, most: int = _MOST_CHECKED) -> np.ndarray:
    """Choose the indices of at most `most` steps of a segment to be checked."""
    if steps <= most:
        return np.arange(steps)
    return np.unique((steps * (_GOLDEN * np.arange(most) % 1)).astype(int))


def _find_roughest(acceleration: np.ndarray) -> np.ndarray:
    """Indices of the steps in which the polynomial through the accelerations (k, s, n) converges worst.

    The last coefficient of its Legendre series is in proportion to the interpolation error.
    """
    stages = acceleration.shape[1]
    c, b = tableau(stages).c, tableau(stages).b
    last = np.abs(np.einsum("s,ksn->kn", b * Legendre.basis(stages - 1)(2 * c - 1), acceleration))
    return np.unique(np.argsort(last, axis=0)[-_ROUGHEST:])


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


def estimate_time_error(system: ModalSystem, segments: Sequence[Segment], outputs: np.ndarray) -> TimeError:
    """Estimate the time-integration error of a quantity from the errors of all segments.

    Parameters
    ----------
    system : ModalSystem
        The equations.
    segments : sequence of Segment
        The segments of a trajectory.
    outputs : ndarray, shape (d, n)
        The quantity whose error is sought, such as the tip deflection, per unit of each coordinate: the d
        components of a vector, whose error is the magnitude of that of the vector.

    Returns
    -------
    TimeError
    """
    frequencies = vibration_frequencies(system, sum(s.end - s.start for s in segments))
    errors = [
        s.error if isinstance(s, SegmentWithError) else _error_of_steps(system, s, frequencies)
        for s in segments
    ]
    zero = np.zeros(system.size)
    modes = sum((e.coordinates for e in errors), zero) * size_per_coordinate(outputs)
    interpolation = max((float(magnitude(e.interpolation, outputs).max()) for e in errors), default=0.0)
    unresolved = np.logical_or.reduce([zero > 0, *(e.unresolved for e in errors)])
    return TimeError.of_coordinates(system, modes, interpolation, unresolved)


def _error_of_steps(system: ModalSystem, segment: Segment, frequencies: np.ndarray) -> SegmentError:
    """Error of a segment by the local errors of some steps.

    Gauss collocation keeps amplitudes and errs in phase.  A mode's local errors therefore add up
    coherently until its phase is lost, after 2 / delta steps with a phase error delta per step.  The error
    of a mode that the steps do not resolve is thus bounded by the amplitude of its free vibration.  What the
    stiffness varies within a step, such as on a wavy road, turns the error of one mode into that of another.
    """
    check = CheckedSteps.of_segment(segment)
    maps, finer, K = _maps_of(system, check)
    local = local_errors(maps.step, finer.step, check.state, check.end_state, frequencies)
    delta = phase_errors(finer.step - maps.step, frequencies)
    accelerations = check.acceleration, (finer.acceleration @ check.state[:, None, :, None])[..., 0]
    q = [interpolate(check.h, check.state, a, INTERPOLATION_POINTS)[0] for a in accelerations]
    total = total_of_local_errors(local, delta, check.steps)
    coupling = np.ptp(K, axis=1).max(axis=0) / 2
    np.fill_diagonal(coupling, 0.0)
    total = total + coupling @ total / frequencies**2
    return SegmentError(total, (q[0] - q[1]).reshape(-1, system.size), delta > UNRESOLVED_PHASE)


def _maps_of(system: ModalSystem, check: CheckedSteps) -> tuple[StepMaps, StepMaps, np.ndarray]:
    """Maps of the checked steps, those of two more stages, and stiffness (k, nodes, n, n) at all nodes."""
    tables = tableau(STAGES), tableau(STAGES + 2)
    nodes = np.concatenate([table.c for table in tables])
    C, K, f = system.coefficients(check.starts[:, None] + check.h * nodes)
    own, more = slice(None, STAGES), slice(STAGES, None)
    found = (
        solve_steps(None if C is None else C[:, part], K[:, part], f[:, part], check.h, table)
        for part, table in zip((own, more), tables, strict=True)
    )
    return next(found), next(found), K


def size_per_coordinate(outputs: np.ndarray) -> np.ndarray:
    """Magnitude of a vector of d components per unit of each coordinate, (n,), from the components (d, n)."""
    return np.hypot.reduce(np.abs(outputs))


def total_of_local_errors(local: np.ndarray, delta: np.ndarray, steps: int) -> np.ndarray:
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
    then grows to one of the coordinate over the duration [s] of the run.
    """
    _, K, _ = system.coefficients(np.zeros(()))
    slowest = 1 / duration if system.equations.shift else 0.0
    return np.maximum(np.sqrt(np.abs(np.diag(K))), slowest)
