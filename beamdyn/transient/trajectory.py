"""Trajectories: coordinates over time, and the largest tip deflection during a motion.

In shapes of arrays, n counts coordinates, and k times.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol, TypeAlias

import numpy as np

from beamdyn.transient.beam_in_space_system import AnySystem
from beamdyn.transient.gauss import Segment
from beamdyn.transient.record_steps import RecordSegment
from beamdyn.transient.system import ModalSystem

SAMPLES = 8  # number of samples per step, unless times are given
# Number of highest sampled maxima that are refined; samples miss a maximum by at most 1e-3 of its height.
_CANDIDATES = 12
_REFINED = 4  # number of maxima that are refined a second time
# Number of refinements of a maximum, each 17 times finer; the final parabola's relative error is below 1e-12.
_REFINEMENTS = 2

Size: TypeAlias = "Callable[[np.ndarray], np.ndarray]"


class Path(Protocol):
    """Coordinates of a motion over time, computed by any integrator.

    In order to add an integrator:

    1. Write a function of the equations (`ModalSystem`), the initial coordinates and velocities, the end
       and the tolerance, which returns a path.  It evaluates C, K and f of the equations at arrays of times.
    2. Steps end at the motion's breakpoints, see `beamdyn.transient.step_size.split_at_breakpoints`.
    3. `samples` has several samples in each step, so that no maximum is missed; `at` interpolates between
       them.
    4. The function estimates the time-integration error of the tip deflection [m], or returns nan.
    5. `TransientProblem.solve` calls it by the name in ``method=``.  A subclass of scipy's `OdeSolver` needs
       none of this: it is passed as ``method=`` itself.
    """

    @property
    def start(self) -> float:
        """Time at the beginning of the motion [s]."""
        ...

    @property
    def end(self) -> float:
        """Time at the end of the motion [s]."""
        ...

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times [s], coordinates and velocities (times, coordinates); several in each step."""
        ...

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Evaluate coordinates and velocities at times t [s]: shapes (len(t), n)."""
        ...


@dataclass(frozen=True)
class Trajectory:
    """Consecutive segments of equal steps or, for a motion given by samples, of unequal steps."""

    segments: tuple[Segment | RecordSegment, ...]

    @property
    def start(self) -> float:
        """Time at the beginning of the trajectory [s]."""
        return self.segments[0].start

    @property
    def end(self) -> float:
        """Time at the end of the trajectory [s]."""
        return self.segments[-1].end

    @property
    def in_equal_steps(self) -> bool:
        """Whether each segment has equal steps."""
        return all(isinstance(segment, Segment) for segment in self.segments)

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times [s], coordinates and velocities (times, coordinates); several in each step."""
        return self._samples

    @cached_property
    def _samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        n = self.segments[0].acceleration.shape[2]
        last = self.segments[-1].state[-1:]
        end = np.array([self.end]), last[:, 1 : n + 1], last[:, n + 1 :]
        parts = [*(segment.samples(SAMPLES) for segment in self.segments), end]
        t, q, v = (np.concatenate(each) for each in zip(*parts, strict=True))
        return t, q, v

    def projected(self, outputs: np.ndarray) -> Trajectory:
        """Replace the n coordinates by d linear functions of them with coefficients `outputs` (d, n)."""
        return Trajectory(tuple(segment.projected(outputs) for segment in self.segments))

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Evaluate coordinates and velocities at times t [s]: shapes (len(t), n)."""
        n = self.segments[0].acceleration.shape[2]
        q, v = np.empty((len(t), n)), np.empty((len(t), n))
        index = np.searchsorted([segment.start for segment in self.segments[1:]], t, side="right")
        for k in np.unique(index):
            here = index == k
            q[here], v[here] = self.segments[k].at(t[here])
        return q, v


def magnitude(q: np.ndarray, outputs: np.ndarray) -> np.ndarray:
    """Compute the magnitude of a vector whose d components are linear functions of coordinates.

    Parameters
    ----------
    q : ndarray, shape (..., coordinates)
        Coordinates.
    outputs : ndarray, shape (d, coordinates)
        The components per unit of each coordinate, such as the tip's deflections in two directions.

    Returns
    -------
    ndarray, shape (...)
    """
    return np.hypot.reduce([np.abs(q @ output) for output in outputs])


def largest_on(size_of: Size, path: Path, start: float, end: float) -> float:
    """Find the largest magnitude of the tip's deflection [m] in a time window, as `largest_in_each` does."""
    return largest_in_each(size_of, path, [(start, end)])[0]


def largest_in_each(size_of: Size, path: Path, windows: Sequence[tuple[float, float]]) -> list[float]:
    """Find the largest magnitude of the tip's deflection on a path in time windows, also between samples.

    Parameters
    ----------
    size_of : callable
        Magnitude (k,) of the deflection [m] at coordinates (k, n).
    path : Path
        The coordinates over time.
    windows : sequence of tuple of float
        Beginning and end of each window [s].

    Returns
    -------
    list of float
        Largest magnitude in each window [m], from refining the highest maxima of the samples.
    """
    times, q, _ = path.samples
    size = size_of(q)
    t = np.array([_candidates(times, size, *window) for window in windows])
    start, end = np.array(windows).T[:, :, None]
    spacing, found = np.diff(times), np.empty((0, 0, 0))
    beside = np.clip(np.searchsorted(times, t) + np.array([-2, -1, 0])[:, None, None], 0, len(spacing) - 1)
    half_width = spacing[beside].max(axis=0)
    for _ in range(_REFINEMENTS):
        near = np.linspace(np.maximum(t - half_width, start), np.minimum(t + half_width, end), 35, axis=-1)
        found = size_of(path.at(near.ravel())[0]).reshape(near.shape)
        # The first refinement shows which maxima are highest.
        highest = np.argsort(found.max(axis=2))[:, -_REFINED:]
        best = np.take_along_axis(found.argmax(axis=2), highest, axis=1)
        near = np.take_along_axis(near, highest[:, :, None], axis=1)
        t = np.take_along_axis(near, best[:, :, None], axis=2)[:, :, 0]
        half_width = np.take_along_axis(half_width, highest, axis=1) / 17
    at = np.clip(found.argmax(axis=2), 1, found.shape[2] - 2)[:, :, None]
    beside = (np.take_along_axis(found, at + k, axis=2)[:, :, 0] for k in (-1, 0, 1))
    return np.maximum(_top_of_parabola(*beside), found.max(axis=2)).max(axis=1).tolist()


def _top_of_parabola(left: np.ndarray, middle: np.ndarray, right: np.ndarray) -> np.ndarray:
    """Find the maximum of the parabola through three equidistant values, if the middle one is largest.

    Otherwise, return the middle value.
    """
    is_maximum = (middle >= left) & (middle >= right)
    bend = np.where(is_maximum, 2 * middle - left - right, 0.0)
    # The tilt is at most 1 in magnitude: the highest value is between the left and right values.
    tilt = np.divide(right - left, bend, out=np.zeros_like(bend), where=bend > 0)
    return middle + (right - left) * tilt / 8


def _candidates(times: np.ndarray, size: np.ndarray, start: float, end: float) -> np.ndarray:
    """Choose the times of the 12 highest samples in a window, and its two ends: shape (14,).

    Times repeat if there are fewer samples.  Samples are ranked by the maximum of the parabola through three
    neighbours.
    """
    first, last = np.searchsorted(times, start), np.searchsorted(times, end, side="right")
    size = size[first:last]
    chosen = np.arange(len(size))
    if len(size) >= 3:
        size = size / max(size.max(), 1e-300)  # scaled so that the squares do not overflow
        height = _top_of_parabola(size[:-2], size[1:-1], size[2:])
        chosen = 1 + np.argpartition(height, -min(_CANDIDATES, len(height)))[-_CANDIDATES:]
    return np.concatenate([times[first + chosen], np.full(_CANDIDATES - len(chosen), start), [start, end]])


# Tip deflection -----------------------------------------------------------------------------------


def sample_tip(system: AnySystem, path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Sample the tip's deflection on a path: times [s] and deflections [m], in 1 or 2 columns."""
    if isinstance(system, ModalSystem) and isinstance(path, Trajectory):
        # The tip deflection alone needs far less memory than all coordinates.
        t, deflections, _ = path.projected(system.tips).samples
        return t, deflections
    t, q, _ = path.samples
    return t, system.deflections(q)


def magnitude_of(deflections: np.ndarray) -> np.ndarray:
    """Compute magnitudes, shape (...), of deflections given in each direction, shape (..., 1 or 2)."""
    return np.hypot.reduce(np.abs(np.moveaxis(deflections, -1, 0)))


def in_direction(deflections: np.ndarray, direction: int) -> np.ndarray:
    """Select one direction from deflections (..., 1 or 2); return 0 if the direction is not modelled."""
    if direction >= deflections.shape[-1]:
        return np.zeros(deflections.shape[:-1])
    return deflections[..., direction]
