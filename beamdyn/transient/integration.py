"""Integration of a scene's equations to a tolerance, linear or of large deflection."""

from __future__ import annotations

import numpy as np

from beamdyn.transient import step_size
from beamdyn.transient.elastica_steps import integrate_elastica
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import Trajectory


def integrate(
    system: ModalSystem | ElasticaSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> tuple[Trajectory, float, str]:
    """Integrate by Gauss collocation: see `beamdyn.transient.step_size.integrate`."""
    if isinstance(system, ElasticaSystem):
        return integrate_elastica(system, y0, t_end, tolerance)
    return step_size.integrate(system, y0, t_end, tolerance)
