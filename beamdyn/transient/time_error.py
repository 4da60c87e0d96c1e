"""Time-integration error: some steps of each segment are compared with steps of two more stages."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamdyn.transient.gauss import Segment, interior, step_maps, tableau
from beamdyn.transient.system import ModalSystem

STAGES = 8  # of the Gauss collocation that is checked
_MOST_CHECKED = 48  # steps of a segment at which the local error is measured
_GOLDEN = 0.6180339887498949  # spreads them so that no period of the motion is missed
_BETWEEN = np.array([0.1, 0.4, 0.6, 0.9])  # fractions of a step at which the interpolation errs most
_LOST = 0.05  # phase error in a step [rad] from which a mode is not followed
_NOISE = 1e-14  # rounding of a step, over the sum of its terms
_MARGIN = 1.5


@dataclass(frozen=True)
class CheckedSteps:
    """The steps of a segment at which the local error is measured.

    Parameters
    ----------
    starts : ndarray, shape (k,)
        Times at which they begin [s].
    h : float
        Step [s].
    steps : int
        Number of steps of the segment, for which they stand.
    state : ndarray, shape (k, 2 n + 1)
        Augmented states (1, q, v) at their beginnings.
    reached : ndarray, shape (k, 2 n)
        Coordinates and velocities at their ends, as computed.
    """

    starts: np.ndarray
    h: float
    steps: int
    state: np.ndarray
    reached: np.ndarray

    @classmethod
    def of_segment(cls, segment: Segment) -> CheckedSteps:
        """Pick the checked steps of a segment."""
        steps = len(segment.acceleration)
        chosen = choose_checked_steps(steps)
        starts = segment.start + segment.h * chosen
        return cls(starts, segment.h, steps, segment.state[chosen], segment.state[chosen + 1, 1:])


def choose_checked_steps(steps: int) -> np.ndarray:
    """Indices of the steps of a segment that are checked."""
    if steps <= _MOST_CHECKED:
        return np.arange(steps)
    return np.unique((steps * (_GOLDEN * np.arange(_MOST_CHECKED) % 1)).astype(int))


@dataclass(frozen=True)
class TimeError:
    """Estimated time-integration error of a tip deflection.

    Parameters
    ----------
    modes : ndarray, shape (n,)
        Contributions of the coordinates [m].
    between : float
        Error of interpolation between the ends of steps [m].
    lost : ndarray of bool, shape (n,)
        Whether the steps are too long to follow the free vibration of a mode.
    """

    modes: np.ndarray
    between: float
    lost: np.ndarray

    @property
    def total(self) -> float:
        """Sum with a margin [m]."""
        return _MARGIN * (float(self.modes.sum()) + self.between)


def estimate_time_error(system: ModalSystem, checks: Sequence[CheckedSteps]) -> TimeError:
    """Estimate the time-integration error of the tip deflection from the local errors of some steps.

    Gauss collocation keeps amplitudes and errs in phase.  A mode's local errors therefore add up
    coherently until its phase is lost, after 2 / delta steps with a phase error delta a step; the error
    of a mode that the steps do not resolve is then all of its free vibration, and no more.

    Parameters
    ----------
    system : ModalSystem
        The equations.
    checks : sequence of CheckedSteps
        Checked steps of each segment.

    Returns
    -------
    TimeError
    """
    n, tip = system.size, system.tip
    total, between, lost = np.zeros(n), 0.0, np.zeros(n, dtype=bool)
    for check in checks:
        own, finer = (step_maps(system, check.starts, check.h, tableau(STAGES + more)) for more in (0, 2))
        local = _local_errors(system, own.step, finer.step, check)
        delta = _phase_errors(system, finer.step - own.step)
        total += np.minimum(check.steps, 2 / np.maximum(delta, 1e-30)) * local
        lost |= delta > _LOST
        accelerations = [(maps.stages @ check.state[:, None, :, None])[..., 0] for maps in (own, finer)]
        inside = [interior(check.h, check.state, a, _BETWEEN)[0] for a in accelerations]
        between = max(between, float(np.abs((inside[0] - inside[1]) @ tip).max()))
    return TimeError(total * np.abs(tip), between, lost)


def _local_errors(system: ModalSystem, own: np.ndarray, exact: np.ndarray, check: CheckedSteps) -> np.ndarray:
    """Mean local error of each coordinate as an amplitude: the method's, and that of inexact steps."""
    n = system.size
    remainder = np.einsum("kij,kj->ki", own, check.state) - check.reached
    size = np.einsum("kij,kj->ki", np.abs(own), np.abs(check.state))
    remainder[np.abs(remainder) <= _NOISE * size] = 0  # rounding, which does not add up
    error = np.abs(np.einsum("kij,kj->ki", exact - own, check.state)) + np.abs(remainder)
    return np.hypot(error[:, :n], error[:, n:] / _frequencies(system)).mean(axis=0)


def _phase_errors(system: ModalSystem, difference: np.ndarray) -> np.ndarray:
    """Largest phase error of each coordinate in a step [rad], from the difference of two maps of steps."""
    n, k = system.size, np.arange(system.size)
    by_velocity = np.abs(difference[:, k, 1 + n + k]) * _frequencies(system)
    return np.maximum(np.abs(difference[:, k, 1 + k]), by_velocity).max(axis=0)


def _frequencies(system: ModalSystem) -> np.ndarray:
    """Angular frequency of each coordinate alone at time 0 [rad/s]."""
    _, K, _ = system.coefficients(np.zeros(()))
    return np.sqrt(np.abs(np.diag(K)))
