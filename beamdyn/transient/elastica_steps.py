"""Integration of large deflections to a tolerance: step size, and the error from a second run.

A run with two more stages in the same steps, of an order higher by four, shows the error of the first, with
all that the equations make of it.  The second is the result: its own error is far smaller.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from beamdyn.transient.elastica_gauss import StepNotSolved, propagate_elastica
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.gauss import Segment, interpolate, step_maps, tableau
from beamdyn.transient.record_steps import smooth_piece_ends
from beamdyn.transient.step_size import (
    TOLERANCES,
    Attempt,
    StepSize,
    check_number_of_steps,
    shorten_steps,
    split_at_breakpoints,
)
from beamdyn.transient.time_error import (
    STAGES,
    UNRESOLVED_PHASE,
    TimeError,
    phase_errors,
    vibration_frequencies,
)
from beamdyn.transient.trajectory import Trajectory

_FINER = STAGES + 2  # stages of the second run
_INSIDE = np.array([0.1, 0.4, 0.6, 0.9])  # fractions of a step with the largest error of interpolation
_BALANCE = 1e-13  # residual force in equilibrium, over the largest force: rounding error
_TIMES_COMPARED = 257  # times at which the motion of the root is compared with that at the start
_SHORTER = 0.5  # phase angle of the next step size, over that of a step that was not solved
_SHORT = 1.0  # phase angle of steps [rad] below which they resolve one mode more instead
_MANY = 64  # number of pieces of a motion, such as one given by samples, above which none is divided further
_CHECKED = 48  # steps of a segment at which the interpolation is checked


def integrate_elastica(
    system: ElasticaSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> tuple[Trajectory, float, str]:
    """Integrate large deflections: parameters and results as of `beamdyn.transient.step_size.integrate`.

    Raises
    ------
    TooManySteps
        If the steps of the run do not fit into memory.
    ArithmeticError
        If the steps cannot be solved at any size.
    """
    if _stays_in_equilibrium(system, y0, t_end):
        return _rest(system, y0, t_end), 0.0, "no steps: the beam stays in equilibrium"

    def run(step_size: StepSize, before: Attempt | None) -> Attempt:
        try:
            runs = _TwoRuns.of(system, y0, t_end, step_size)
        except StepNotSolved:
            if step_size.is_finest:
                raise
            return run(_shorten(step_size, system.size), before)
        method = f"Gauss collocation of order {2 * _FINER}, {runs.steps} steps"
        return Attempt(step_size, runs.path, runs.error, runs.largest, method)

    return shorten_steps(run, tolerance)


def _shorten(step_size: StepSize, size: int) -> StepSize:
    """Shorten steps that were not solved, at last until they resolve the vibration of all coordinates."""
    if step_size.phase < _SHORT and step_size.modes < size:
        return StepSize(StepSize.from_tolerance(TOLERANCES[1]).phase, step_size.modes + 1)
    return StepSize(step_size.phase * _SHORTER, step_size.modes)


@dataclass(frozen=True)
class _TwoRuns:
    """Two runs in the same steps, with different numbers of stages.

    Parameters
    ----------
    system : ElasticaSystem
        The equations.
    coarse, fine : tuple of Segment
        Segments of the runs, of 8 and 10 stages.
    """

    system: ElasticaSystem
    coarse: tuple[Segment, ...]
    fine: tuple[Segment, ...]

    @classmethod
    def of(cls, system: ElasticaSystem, y0: np.ndarray, t_end: float, step_size: StepSize) -> _TwoRuns:
        """Integrate twice, with equal steps in each segment."""
        pieces = smooth_piece_ends(system.motion, t_end)
        edges = pieces if len(pieces) > _MANY else split_at_breakpoints(system.motion, t_end)
        steps = [step_size.count_steps(system.straight, a, b) for a, b in pairwise(edges)]
        check_number_of_steps(sum(steps), system.size, t_end)
        coarse = _propagate(system, edges, steps, y0, STAGES)
        return cls(system, coarse, _propagate(system, edges, steps, y0, _FINER, coarse))

    @property
    def path(self) -> Trajectory:
        """The trajectory of the run with more stages."""
        return Trajectory(self.fine)

    @property
    def steps(self) -> int:
        """Number of steps."""
        return sum(len(segment.acceleration) for segment in self.fine)

    @property
    def largest(self) -> float:
        """Largest deflection at the ends of the steps [m]."""
        return max(float(np.abs(self._tips(segment.state)).max()) for segment in self.fine)

    @property
    def error(self) -> TimeError:
        """Error of the tip deflection: distance of the runs, divided among the coordinates."""
        tip, n = 0.0, self.system.size
        change = np.zeros(n)
        for coarse, fine in zip(self.coarse, self.fine, strict=True):
            difference = np.abs(coarse.state - fine.state)[:, 1 : n + 1].max(axis=0)
            change = np.maximum(change, difference * np.abs(self.system.equations.tip))
            tip = max(tip, float(np.abs(self._tips(coarse.state) - self._tips(fine.state)).max()))
        modes = tip * change / max(change.sum(), 1e-300)
        longest = max(self.fine, key=lambda segment: segment.h)
        unresolved = self._phase_errors(longest) > UNRESOLVED_PHASE
        some = self.fine[:: 1 + len(self.fine) // _MANY]
        interpolation = max(map(self._interpolation_error, some))
        return TimeError.of_coordinates(self.system.straight, modes, interpolation, unresolved)

    def _tips(self, state: np.ndarray) -> np.ndarray:
        return self.system.deflections(state[:, 1 : self.system.size + 1])[:, 0]

    def _phase_errors(self, segment: Segment) -> np.ndarray:
        """Phase error of each coordinate per step [rad], as if the beam were straight."""
        straight, starts = self.system.straight, np.array([(segment.start + segment.end - segment.h) / 2])
        maps, finer = (step_maps(straight, starts, segment.h, tableau(s)).step for s in (STAGES, _FINER))
        return phase_errors(finer - maps, vibration_frequencies(straight, segment.end))

    def _interpolation_error(self, segment: Segment) -> float:
        """Largest error of the tip's deflection between the ends of steps [m], by steps with more stages."""
        steps = len(segment.acceleration)
        error = 0.0
        for k in np.unique(np.linspace(0, steps - 1, _CHECKED).astype(int)):
            here = Segment(
                segment.start + k * segment.h,
                segment.h,
                segment.state[k : k + 2],
                segment.acceleration[k : k + 1],
            )
            q, v = np.split(here.state[0, 1:], 2)
            finer = propagate_elastica(self.system, here.start, here.end, 1, q, v, _FINER + 2, here)
            tips = [
                self.system.deflections(interpolate(s.h, s.state[:-1], s.acceleration, _INSIDE)[0])
                for s in (here, finer)
            ]
            error = max(error, float(np.abs(tips[0] - tips[1]).max()))
        return error


def _propagate(
    system: ElasticaSystem,
    edges: np.ndarray,
    steps: Sequence[int],
    y0: np.ndarray,
    stages: int,
    like: Sequence[Segment] | None = None,
) -> tuple[Segment, ...]:
    """Integrate segment by segment, with the given numbers of steps."""
    segments: list[Segment] = []
    for k, (a, b) in enumerate(pairwise(edges)):
        q, v = np.split(y0, 2)
        known = None if like is None else like[k]
        segments.append(propagate_elastica(system, a, b, steps[k], q, v, stages, known))
        y0 = segments[-1].state[-1, 1:]
    return tuple(segments)


def _stays_in_equilibrium(system: ElasticaSystem, y0: np.ndarray, t_end: float) -> bool:
    """Whether the beam stays at rest: a constant motion of the root, and forces in equilibrium."""
    if system.motion.steady_start > 0 or np.split(y0, 2)[1].any():
        return False
    q, none = y0[None, : system.size], np.zeros((1, system.size))
    root = system.root(np.linspace(0, t_end, _TIMES_COMPARED))
    values = [getattr(root, name) for name in system.equations.vectors]
    if not all((value == value[0]).all() for value in (*values, root.speed_squared, root.root_axial)):
        return False
    force = system.at(system.drive(system.root(np.zeros(1))), q, none, none).residual
    elastic = np.abs(system.elastica.stiffness) @ np.abs(q[0])
    return bool(np.abs(force).max() <= _BALANCE * elastic.max())


def _rest(system: ElasticaSystem, y0: np.ndarray, t_end: float) -> Trajectory:
    """The trajectory of a beam that does not move."""
    state = np.tile(np.append(1.0, y0), (2, 1))
    return Trajectory((Segment(0.0, t_end, state, np.zeros((1, _FINER, system.size))),))
