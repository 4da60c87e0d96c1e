"""Step size of a time integration, chosen by the tolerance; limits of the number of steps."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.scene.motion.base import Motion
from beamdyn.transient.gauss import Segment
from beamdyn.transient.record_steps import smooth_piece_ends
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import ERROR_ORDER, TimeError
from beamdyn.transient.trajectory import Trajectory

TOLERANCES = (1e-12, 0.1)  # smallest and largest tolerance; smaller ones are below the rounding error
_REFERENCE_PHASE = 3.84  # phase advance per step [rad] that gives an error of 1e-5, measured on examples
_LOOSEST_TOLERANCE = 0.01  # largest relative error of the free vibration of a mode whose phase is resolved
_PARTS = 4  # number of parts of a segment of changing speed, each with its own step size
_MOST_STEPS = 3_000_000  # largest number of steps of a run
# Largest number of steps times coordinates of a run, which fits into some 3 GB of memory.
_MOST_VALUES = 15_000_000
_ROUNDING = 1e-9  # ratio of error to largest deflection below which rounding may be the cause of the error
# Ratio of _REFERENCE_PHASE to the smallest useful phase per step: rounding errors grow below that.
_MOST_REFINED = 50


@dataclass(frozen=True)
class StepSize:
    """Step size, given as the phase angle by which the fastest resolved mode advances per step.

    Parameters
    ----------
    phase : float
        Phase angle per step [rad].
    modes : int
        Number of lowest modes whose phase is resolved; the motion hardly excites the higher ones.
    """

    phase: float
    modes: int = 1

    @classmethod
    def from_tolerance(cls, tolerance: float) -> StepSize:
        """Estimate the step size that meets a tolerance, relative to the largest deflection."""
        return cls(_REFERENCE_PHASE * (tolerance / 1e-5) ** (1 / ERROR_ORDER))

    def count_steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Count the equal steps that are needed from start to end [s]."""
        return self.count_steps_of_each(system, np.array([start, end]))[0]

    def count_steps_of_each(self, system: ModalSystem, ends: np.ndarray) -> list[int]:
        """Count the equal steps that are needed in each of neighbouring segments with given ends [s]."""
        sample = system.motion.at(np.linspace(ends[:-1], ends[1:], 9, axis=1))
        speed = np.abs(sample.speed).max(axis=1)
        multiple = max((line.multiple for line in system.motion.lines), default=0.0)
        _, K, _ = system.assemble(system.equations.root(sample))
        # The eigenvalue 0 belongs to the flux of a circuit, a coordinate without stiffness.
        first = int(system.equations.voltage is not None)
        squared = np.sort(np.abs(np.linalg.eigvals(K)), axis=-1)[:, :, max(self.modes - 1, first)]
        natural = np.sqrt(squared.max(axis=1))
        fastest = np.maximum(natural, speed * max(multiple, float(system.equations.gravity != 0)))
        return np.maximum(1, np.ceil(np.diff(ends) * fastest / self.phase)).astype(int).tolist()

    def next(self, error: TimeError, bound: float, order: int) -> StepSize:
        """Choose the next step size if the error exceeds its bound [m]: resolve more modes, or shorten steps.

        The error is proportional to the step size to the power `order`.
        """
        cumulative = np.cumsum((error.modes * error.unresolved)[::-1])[::-1]
        # The modes above this number together have an error below a quarter of the bound.
        modes = int((cumulative > bound / 4).sum())
        if modes > self.modes:
            # Unresolved modes have an error as large as their motion.  `share` is the relative error to which
            # the motion of the highest mode to be resolved is reduced, so that it meets its part of the
            # bound.
            share = min(bound / 4 / cumulative[modes - 1], _LOOSEST_TOLERANCE)
            return StepSize(max(self.phase, StepSize.from_tolerance(share).phase), modes)
        shrink = max(0.3, 0.9 * (bound / error.total) ** (1 / order))
        return StepSize(self.phase * shrink, self.modes)

    @property
    def is_finest(self) -> bool:
        """Whether a smaller step size would only increase the rounding error."""
        return self.phase < _REFERENCE_PHASE / _MOST_REFINED


@dataclass(frozen=True)
class Attempt:
    """Run with one step size, and its error.

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
        Order of convergence of the error with the step size.
    """

    step_size: StepSize
    path: Trajectory
    error: TimeError
    largest: float
    method: str
    order: int = ERROR_ORDER


def shorten_steps(
    run: Callable[[StepSize, Attempt | None], Attempt], tolerance: float
) -> tuple[Trajectory, float, str]:
    """Run with the step size for the tolerance, and with smaller steps while the error exceeds the tolerance.

    The refinement also ends if smaller steps did not halve an error that may be due to rounding.

    Parameters
    ----------
    run : callable
        Function from a step size and the previous attempt (or None) to a new attempt.
    tolerance : float
        Target of the time-integration error, relative to the largest deflection.

    Returns
    -------
    path, error, method
        Results as for `integrate`.
    """

    def meets(found: tuple[Attempt, Attempt | None]) -> bool:
        last, before = found
        error, largest = last.error.total, last.largest
        before_that = np.inf if before is None else before.error.total
        is_finest = last.step_size.is_finest and last.order == ERROR_ORDER
        return error <= tolerance * largest or before_that / 2 < error < _ROUNDING * largest or is_finest

    def finer(found: tuple[Attempt, Attempt | None]) -> tuple[Attempt, Attempt | None]:
        last, _ = found
        return run(last.step_size.next(last.error, tolerance * last.largest, last.order), last), last

    found, _ = refine((run(StepSize.from_tolerance(tolerance), None), None), finer, meets)
    return found.path, found.error.total, found.method


class TooManySteps(InvalidValue):
    """Raised if the time steps of a run do not fit into memory."""


def check_number_of_steps(steps: int, size: int, t_end: float) -> None:
    """Raise `TooManySteps` if a run's steps, of `size` coordinates each, do not fit into memory."""
    most = min(_MOST_STEPS, _MOST_VALUES // size)
    if steps > most:
        bound = f"it takes about {steps:.3g} steps in time; {most:.3g} of {size} coordinates fit into memory"
        remedy = "give an earlier end, a larger tolerance or fewer modes, or ask for the steady response"
        raise TooManySteps("t_end", t_end, bound, remedy, "s")


def split_at_breakpoints(motion: Motion, t_end: float) -> np.ndarray:
    """Split a run into segments for the choice of the step size; return all their ends [s].

    The run is split at the breakpoints of the motion; segments of changing speed are split into four parts.
    """
    parts = []
    for a, b in pairwise(smooth_piece_ends(motion, t_end)):
        speed_changes = np.ptp(motion.at(np.linspace(a, b, 9)[1:-1]).speed) > 0
        parts.append(np.linspace(a, b, (_PARTS if speed_changes else 1) + 1)[:-1])
    return np.concatenate([*parts, [t_end]])


def chain_segments(
    edges: np.ndarray,
    steps: Sequence[int],
    y0: np.ndarray,
    propagate: Callable[[float, float, int, np.ndarray, np.ndarray], Segment],
) -> tuple[Segment, ...]:
    """Integrate consecutive segments with ends `edges` [s] by `propagate`, each in its number of steps."""
    segments: list[Segment] = []
    for (a, b), count in zip(pairwise(edges), steps, strict=True):
        segments.append(propagate(a, b, count, *np.split(y0, 2)))
        y0 = segments[-1].state[-1, 1:]
    return tuple(segments)
