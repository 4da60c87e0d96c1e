"""Step size from a tolerance: integrate, estimate the error, refine."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from beamdyn.scene.motion import Motion
from beamdyn.transient.gauss import Segment, propagate
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import STAGES, CheckedSteps, TimeError, estimate_time_error
from beamdyn.transient.trajectory import Trajectory
from beamdyn.transient.weakly_modulated import propagate_modulated

TOLERANCES = (1e-12, 0.1)  # smaller ones are below rounding
_PHASE = 3.84  # advance of the fastest motion in a step [rad] for an error of 1e-5: measured
_LOOSEST = 0.01  # error of a mode, over its size, at which it is still followed
_PARTS = 4  # of a segment of changing speed, each with its own step size
_MOST_STEPS = 3_000_000
_COMPARED = 257  # times at which equations are compared with those at the start
_BALANCED = 1e-13  # forces left over in equilibrium, over the largest
_AT_ROUNDING = 1e-9  # error over the largest deflection from which finer steps may gain nothing
_SERIES_SHARE = 0.1  # of the tolerance, for the truncation of the series of weakly modulated steps
_FINEST = 50  # times smaller than the step for 1e-5: below it rounding grows


@dataclass(frozen=True)
class StepSize:
    """Step size, as the phase angle by which the fastest resolved motion advances per step.

    Parameters
    ----------
    phase : float
        Phase angle per step [rad].
    modes : int
        Number of the lowest modes that are resolved.  The free vibration of higher ones, which the
        motion hardly excites, may lose its phase.
    """

    phase: float
    modes: int = 1

    @classmethod
    def from_tolerance(cls, tolerance: float) -> StepSize:
        """The step size that leaves about this error, relative to the largest deflection."""
        return cls(_PHASE * (tolerance / 1e-5) ** (1 / (2 * STAGES)))

    def count_steps(self, system: ModalSystem, start: float, end: float) -> int:
        """Number of equal steps from start to end [s]."""
        t = np.linspace(start, end, 9)
        speed = np.abs(system.motion.at(t).speed).max()
        lines = [line.multiple * speed for line in system.motion.lines]
        _, K, _ = system.coefficients(t)
        own = np.sqrt(np.sort(np.abs(np.linalg.eigvals(K)), axis=1)[:, self.modes - 1].max())
        fastest = max(own, speed * (system.equations.gravity != 0), *lines, 0.0)
        return max(1, int(np.ceil((end - start) * fastest / self.phase)))

    def refine(self, error: TimeError, bound: float) -> StepSize:
        """The step size to try next where the error exceeds its bound [m]."""
        from_mode_up = np.cumsum((error.modes * error.lost)[::-1])[::-1]
        needed = int((from_mode_up > bound / 4).sum())  # the modes above add up to little
        if needed > self.modes:  # the highest is followed no more closely than its size asks for
            share = min(bound / 4 / from_mode_up[needed - 1], _LOOSEST)
            return StepSize(max(self.phase, StepSize.from_tolerance(share).phase), needed)
        shrink = max(0.3, 0.9 * (bound / error.total) ** (1 / (2 * STAGES)))
        return StepSize(self.phase * shrink, self.modes)

    @property
    def is_finest(self) -> bool:
        """Whether smaller steps only add rounding."""
        return self.phase < _PHASE / _FINEST


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
        What was done, for the provenance.
    """
    edges, step_size = split_at_breakpoints(system.motion, t_end), StepSize.from_tolerance(tolerance)
    if stays_in_equilibrium(system, y0, t_end):
        path = _propagate(system, edges, [1] * (len(edges) - 1), y0, tolerance)
        return path, 0.0, "no steps: it stays as it begins"
    last = np.inf
    while True:
        steps = [step_size.count_steps(system, a, b) for a, b in pairwise(edges)]
        check_number_of_steps(sum(steps), t_end)
        path = _propagate(system, edges, steps, y0, tolerance)
        error = estimate_time_error(system, [CheckedSteps.of_segment(s) for s in path.segments])
        largest = max(
            float(np.abs(s.state[:, 1 : system.size + 1] @ system.tip).max()) for s in path.segments
        )
        at_rounding = last / 2 < error.total < _AT_ROUNDING * largest
        if error.total <= tolerance * largest or at_rounding or step_size.is_finest:
            return path, error.total, f"Gauss collocation of order {2 * STAGES}, {sum(steps)} steps"
        step_size, last = step_size.refine(error, tolerance * largest), error.total


def stays_in_equilibrium(system: ModalSystem, y0: np.ndarray, t_end: float) -> bool:
    """Whether nothing moves: constant equations, begun in equilibrium."""
    if system.motion.steady_start > 0:
        return False
    _, K, f = system.coefficients(np.linspace(0, t_end, _COMPARED))
    q, v = np.split(y0, 2)
    size = np.abs(K[0]) @ np.abs(q) + np.abs(f[0])
    balanced = not v.any() and (np.abs(f[0] - K[0] @ q) <= _BALANCED * size.max()).all()
    return balanced and bool((K[0] == K).all() and (f == f[0]).all())


def check_number_of_steps(steps: int, t_end: float) -> None:
    """Refuse a run that would not fit into memory."""
    if steps > _MOST_STEPS:
        raise ValueError(
            f"t_end = {t_end:g} s takes {steps} steps in time; at most {_MOST_STEPS} are kept: "
            "give an earlier end or a larger tolerance, or ask for the steady response"
        )


def split_at_breakpoints(motion: Motion, t_end: float) -> np.ndarray:
    """Ends of the segments [s]: the motion's breakpoints, and parts of those in which the speed changes."""
    inner = [b for b in motion.breakpoints if 0 < b < t_end]
    parts = []
    for a, b in pairwise([0.0, *inner, t_end]):
        changing = np.ptp(motion.at(np.linspace(a, b, 9)[1:-1]).speed) > 0
        parts.append(np.linspace(a, b, (_PARTS if changing else 1) + 1)[:-1])
    return np.concatenate([*parts, [t_end]])


def _propagate(
    system: ModalSystem, edges: np.ndarray, steps: Sequence[int], y0: np.ndarray, tolerance: float
) -> Trajectory:
    segments, n, accuracy = [], system.size, _SERIES_SHARE * tolerance
    for (a, b), count in zip(pairwise(edges), steps, strict=True):
        segments.append(_propagate_segment(system, a, b, count, y0[:n], y0[n:], accuracy))
        y0 = segments[-1].state[-1, 1:]
    return Trajectory(tuple(segments))


def _propagate_segment(
    system: ModalSystem, a: float, b: float, steps: int, q: np.ndarray, v: np.ndarray, accuracy: float
) -> Segment:
    """One segment: by the series of a weakly modulated system where it converges, else step by step."""
    modulated = system.modulated(a, b)
    if modulated is not None:
        segment = propagate_modulated(modulated, a, b, steps, q, v, STAGES, accuracy)
        if segment is not None:
            return segment
    return propagate(system, a, b, steps, q, v, STAGES)
