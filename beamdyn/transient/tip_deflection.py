"""The tip's deflection along a path, in each direction that is modelled."""

from __future__ import annotations

import numpy as np

from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import Path, Trajectory


def sample_tip(system: ModalSystem | ElasticaSystem, path: Path) -> tuple[np.ndarray, np.ndarray]:
    """Samples of the tip's deflection: times (k,) [s] and deflections (k, 1 or 2) [m]."""
    if isinstance(system, ModalSystem) and isinstance(path, Trajectory):
        t, deflections, _ = path.projected(system.tips).samples  # far fewer numbers than all coordinates
        return t, deflections
    t, q, _ = path.samples
    return t, system.deflections(q)


def magnitude_of(deflections: np.ndarray) -> np.ndarray:
    """Magnitude (...) of deflections in each direction (..., 1 or 2)."""
    return np.hypot.reduce(np.abs(np.moveaxis(deflections, -1, 0)))


def in_direction(deflections: np.ndarray, direction: int) -> np.ndarray:
    """Deflection (...) in a direction, from those in each (..., 1 or 2); 0 where that is not modelled."""
    if direction >= deflections.shape[-1]:
        return np.zeros(deflections.shape[:-1])
    return deflections[..., direction]
