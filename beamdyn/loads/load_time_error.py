"""Time-integration error of loads along the span."""

from __future__ import annotations

import numpy as np

from beamdyn.loads.load_rows import LoadRows
from beamdyn.transient.gauss import Segment
from beamdyn.transient.record_error import estimate_record_error
from beamdyn.transient.record_steps import RecordSegment
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.time_error import TimeError, estimate_time_error, vibration_frequencies
from beamdyn.transient.trajectory import Path, Trajectory


def time_errors_of_rows(rows: LoadRows, system: ModalSystem, path: Path, of_tip: float) -> np.ndarray:
    """Estimate the time-integration errors of loads on a path.

    Parameters
    ----------
    rows : LoadRows
        K components of loads at S stations, by the state.
    system : ModalSystem
        The equations.
    path : Path
        The motion.
    of_tip : float
        Time-integration error of the tip deflection [m].

    Returns
    -------
    ndarray, shape (S, K)
        nan where the error of the tip is not known, and 0 where the beam stays in equilibrium.
    """
    if of_tip == 0 or not isinstance(path, Trajectory):
        return np.full(rows.shape, of_tip)
    frequencies = vibration_frequencies(system, path.end - path.start)
    per_coordinate = largest_per_coordinate(rows, system, path, frequencies)
    components = range(rows.shape[1])
    return np.stack([_of_component(per_coordinate[:, k], system, path) for k in components], axis=1)


def largest_per_coordinate(
    rows: LoadRows, system: ModalSystem, path: Trajectory, frequencies: np.ndarray
) -> np.ndarray:
    """Largest load over the run per unit amplitude of each coordinate: shape (S, K, n)."""
    root = system.root(path.samples[0])  # several in each step: steps are short where a shock acts
    total = np.zeros((*rows.shape, system.size))
    for by_quantity, factor in ((rows.position, 1.0), (rows.velocity, frequencies)):
        for quantity, row in by_quantity.items():
            total += np.abs(row) * np.abs(getattr(root, quantity)).max() * factor
    return total


def _of_component(sizes: np.ndarray, system: ModalSystem, path: Trajectory) -> np.ndarray:
    """Errors (S,) of one component, per unit of each coordinate (S, n), from the errors of coordinates."""
    largest = sizes.max(axis=0)
    scale = np.where(largest > 0, largest, 1.0)
    steps = [segment for segment in path.segments if isinstance(segment, Segment)]
    records = (s for s in path.segments if isinstance(s, RecordSegment))
    outputs = np.diag(largest)
    estimated = [estimate_time_error(system, steps, outputs)] if steps else []
    estimated += [estimate_record_error(system, segment, outputs) for segment in records]
    return sum((_at_stations(error, sizes / scale, system) for error in estimated), np.zeros(len(sizes)))


def _at_stations(error: TimeError, shares: np.ndarray, system: ModalSystem) -> np.ndarray:
    """Errors (S,) by the contributions of the coordinates, of which each station has shares (S, n)."""
    rank = np.argsort(np.diag(system.equations.matrices[0]["unity"]), kind="stable")
    contributions = np.empty(system.size)
    contributions[rank] = error.modes
    totals = shares @ contributions + shares.max(axis=1) * error.interpolation
    return np.array([TimeError(np.array([total]), 0.0, error.unresolved).total for total in totals])
