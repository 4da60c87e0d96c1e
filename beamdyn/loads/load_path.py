"""Loads at stations during a transient: values at any time, largest magnitudes, and errors.

In shapes of arrays, S counts stations, K outputs at each, T times, and d directions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.loads.load_rows import LoadRows, span_rows
from beamdyn.loads.stations import SpanStations, StationOutputs, mode_error, through, with_neighbours
from beamdyn.transient.record_steps import smooth_piece_ends
from beamdyn.transient.simulate import Transient
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import TimeError, estimate_time_error, vibration_frequencies
from beamdyn.transient.trajectory import Trajectory

_COMPARED = 4000  # largest number of times at which two simulations are compared
_BATCH = 500  # number of times evaluated at once
_REFINEMENTS, _FINE = 3, 17  # number of refinements of a maximum, and of grid points in each
_OF_TURNING_POINTS = 2  # number of refinements of a turning point: values within 1e-6 of the largest range
_BETWEEN_SAMPLES = 4  # number of instants per sample of the run at which turning points are sought
# Time before the end of a segment at which loads are evaluated, as a fraction of its duration: at the end
# itself they may jump.
_BEFORE_JUMP = 1e-9


@dataclass(frozen=True)
class LoadPath(FieldsOnly):
    """Outputs at stations along the span as functions of the time of a run.

    Parameters
    ----------
    run : Transient
        The run, of a straight beam.
    stations : SpanStations
        The stations, S of them.
    given : StationOutputs, optional
        The K outputs at each station; None if only forces and moments are wanted: 1 + 2 d loads, with d
        planes of bending.
    """

    run: Transient
    stations: SpanStations
    given: StationOutputs | None = None

    @property
    def outputs(self) -> StationOutputs:
        """Outputs at each station, such as strains, as functions of the forces and moments there."""
        assert self.given is not None
        return self.given

    @cached_property
    def rows(self) -> LoadRows:
        """Outputs at the stations as linear functions of the state of the run."""
        return self.loads.through(self.outputs.matrix)

    @cached_property
    def loads(self) -> LoadRows:
        """Forces and moments as linear functions of the state of the run."""
        equations, model = self._system.equations, self.run.request.model
        return span_rows(self.run.scene, model.discretization, equations, self.stations).in_motion(equations)

    @property
    def _system(self) -> ModalSystem:
        """Equations of motion of the transient."""
        assert isinstance(self.run.system, ModalSystem)
        return self.run.system

    def at(self, t: np.ndarray) -> np.ndarray:
        """Evaluate the outputs at times t [s]: shape (times, stations, outputs)."""
        return self.rows.at(self._system.root(t), *self.run.path.at(t))

    def loads_at(self, t: np.ndarray) -> np.ndarray:
        """Evaluate forces and moments at times t [s]: (times, stations, components)."""
        return self.loads.at(self._system.root(t), *self.run.path.at(t))

    # Turning points and largest magnitudes --------------------------------------------------------

    def turning_values(self, station: int, output: int, start: float, end: float) -> np.ndarray:
        """Find the values of one output at its local extremes from start to end [s], and at start and end."""
        single = self.rows.chosen(np.array([station]), np.array([output]))
        samples, parts = self.run.path.samples[0], np.linspace(0, 1, _BETWEEN_SAMPLES, endpoint=False)
        between = (samples[:-1, None] + np.diff(samples)[:, None] * parts).ravel()
        pieces = np.array(smooth_piece_ends(self.run.request.motion, self.run.path.end))
        before = pieces[1:] - _BEFORE_JUMP * np.diff(pieces)
        t = np.unique(np.concatenate([between, before, [start, end]]))
        t = t[(t >= start) & (t <= end)]
        values = np.concatenate([self._each_at(single, some[None])[0] for some in _batches(t)])
        signs = np.sign(np.diff(values))
        rising = np.flatnonzero(signs)  # on a plateau, only the first sample is the turning point
        turns = 1 + rising[:-1][signs[rising[:-1]] != signs[rising[1:]]]
        # The second value is kept, too, because rainflow counting needs more than two values in all.
        found = [values[:2], values[-1:]]
        for k in _batches(turns):
            sign = signs[k - 1, None]
            near = t[k, None], t[k - 1, None], t[k + 1, None]
            best, _ = self._refine(single, lambda y, sign=sign: sign * y, *near, _OF_TURNING_POINTS)
            found.insert(-1, best[:, 0])
        return np.concatenate(found)

    def peaks(self, start: float, end: float) -> tuple[np.ndarray, np.ndarray]:
        """Find the values of largest magnitude from start to end [s], and their times [s], of all outputs."""
        t = self.run.path.samples[0]
        longest_gap = float(np.diff(t).max())
        t = np.concatenate([[start], t[(t > start) & (t < end)], [end]])
        best, times = np.zeros(self.rows.shape), np.full(self.rows.shape, start)
        for some in _batches(t):
            values = self.at(some)
            k = np.abs(values).argmax(axis=0)[None]
            largest = np.take_along_axis(values, k, axis=0)[0]
            larger = np.abs(largest) > np.abs(best)
            best, times = np.where(larger, largest, best), np.where(larger, some[k[0]], times)
        single = self.rows.chosen(*(index.ravel() for index in np.indices(best.shape)))
        t = times.ravel()[:, None]
        window = np.maximum(t - longest_gap, start), np.minimum(t + longest_gap, end)
        found, t = self._refine(single, np.abs, t, *window, _REFINEMENTS)
        return found.reshape(best.shape), t.reshape(best.shape)

    def _refine(
        self,
        single: LoadRows,
        size: Callable[[np.ndarray], np.ndarray],
        t: np.ndarray,
        first: np.ndarray,
        last: np.ndarray,
        refinements: int,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Find the times near t [s] at which the function `size` of each of the single outputs is largest.

        The times are sought between `first` and `last`.  Return the values of the outputs, and the times [s].
        """
        found, half_width = np.empty(0), np.maximum(last - t, t - first)
        for _ in range(refinements):
            near = np.clip(t + half_width * np.linspace(-1, 1, 2 * _FINE + 1), first, last)
            sampled = self._each_at(single, near)
            best = size(sampled).argmax(axis=1)[:, None]
            t, found = (np.take_along_axis(each, best, axis=1) for each in (near, sampled))
            half_width = half_width / _FINE
        return found, t

    def _each_at(self, single: LoadRows, t: np.ndarray) -> np.ndarray:
        """Evaluate single outputs, output i at the times t[i] [s]: shape (outputs, times)."""
        root = self._system.root(t)
        states = (each.reshape(*t.shape, -1) for each in self.run.path.at(t.ravel()))
        total = np.zeros(t.shape)
        for quantity, value in single.load.items():
            total += getattr(root, quantity) * value
        for rows, state in zip((single.position, single.velocity), states, strict=True):
            for quantity, row in rows.items():
                total += getattr(root, quantity) * np.einsum("otn,on->ot", state, row[:, 0])
        return total

    # Errors ---------------------------------------------------------------------------------------

    @cached_property
    def error(self) -> np.ndarray:
        """Estimated errors of all outputs over the transient, due to modes left out and time integration."""
        run, refined = self.run, self.run.refined
        if refined is None:
            return np.full(self.rows.shape, np.inf)
        everywhere = with_neighbours(self.stations)
        own, other = (LoadPath(each, everywhere) for each in (run, refined))
        distance, largest = np.zeros((2, *own.loads.shape))
        t = run.path.samples[0]
        for some in _batches(t[:: 1 + len(t) // _COMPARED]):
            values = own.loads_at(some)
            distance = np.maximum(distance, np.abs(values - other.loads_at(some)).max(axis=0))
            largest = np.maximum(largest, np.abs(values).max(axis=0))
        where = self.stations, self.outputs, run.request.basis, run.scene.beam.length
        of_modes = mode_error(distance, largest.max(axis=0), *where)
        return of_modes + through(self.outputs, self._time_errors())

    def _time_errors(self) -> np.ndarray:
        """Estimate the time-integration errors of the loads, (stations, components).

        The errors are nan where the error of the tip is not known, and 0 where the beam stays in equilibrium.
        """
        rows, system, path = self.loads, self._system, self.run.path
        if self.run.time_error == 0 or not isinstance(path, Trajectory):
            return np.full(rows.shape, self.run.time_error)
        frequencies = vibration_frequencies(system, path.end - path.start)
        sizes, errors = largest_per_coordinate(rows, system, path, frequencies), np.zeros(rows.shape)
        rank = np.argsort(np.diag(system.equations.matrices[0]["unity"]), kind="stable")
        for k in range(rows.shape[1]):
            largest = sizes[:, k].max(axis=0)
            error = estimate_time_error(system, path.segments, np.diag(largest))
            contributions = np.empty(system.size)
            contributions[rank] = error.modes
            # Bounds at each station by each coordinate, relative to the station with the largest bound.
            shares = sizes[:, k] / np.where(largest > 0, largest, 1.0)
            totals = shares @ contributions + shares.max(axis=1) * error.interpolation
            errors[:, k] = [TimeError(np.array([total]), 0.0, error.unresolved).total for total in totals]
        return errors


def largest_per_coordinate(
    rows: LoadRows, system: ModalSystem, path: Trajectory, frequencies: np.ndarray
) -> np.ndarray:
    """Compute bounds of loads (S stations, K outputs) over the run, per unit amplitude of n coordinates.

    Each coordinate vibrates at its frequency [rad/s]; the bounds (S, K, n) sum the largest contributions
    of all quantities of the root's motion.
    """
    # Maxima over the samples suffice: each time step has several samples, and steps are short during a shock.
    root = system.root(path.samples[0])
    total = np.zeros((*rows.shape, system.size))
    for by_quantity, factor in ((rows.position, 1.0), (rows.velocity, frequencies)):
        for quantity, row in by_quantity.items():
            total += np.abs(row) * np.abs(getattr(root, quantity)).max() * factor
    return total


def _batches(t: np.ndarray) -> Iterator[np.ndarray]:
    """Split times into batches of at most `_BATCH`, each of which is evaluated in one call."""
    return (t[k : k + _BATCH] for k in range(0, len(t), _BATCH))
