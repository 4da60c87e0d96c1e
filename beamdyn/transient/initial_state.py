"""Coordinates and velocities at the beginning of a transient."""

from __future__ import annotations

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats
from beamdyn.transient.elastica_equilibrium import find_equilibrium
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.system import ModalSystem

_FREE = 1e-9  # stiffness, over that of the beam with a clamped root, below which the root turns freely


def initial_state(initial: str | np.ndarray, system: ModalSystem | ElasticaSystem) -> np.ndarray:
    """Coordinates and velocities (2 n,) at "rest", in "equilibrium", or as given by an array.

    Raises
    ------
    ValueError
        If it is another word, an array of another shape, or there is no equilibrium.
    """
    n = system.size
    if isinstance(initial, str):
        if initial == "rest":
            return np.zeros(2 * n)
        if initial == "equilibrium":
            found = find_equilibrium(system) if isinstance(system, ElasticaSystem) else _equilibrium(system)
            return np.concatenate([found, np.zeros(n)])
        raise ValueError(f"initial = {initial!r}: give 'rest', 'equilibrium' or an array")
    y0 = as_floats(initial)
    if y0 is None or y0.shape != (2 * n,) or not np.isfinite(y0).all():
        bound = f"give {2 * n} finite numbers, coordinates then velocities, or 'rest' or 'equilibrium'"
        raise InvalidValue("initial", initial, bound)
    return y0


def padded(initial: str | np.ndarray, modes: int, more: int) -> str | np.ndarray:
    """Extend initial coordinates and velocities from `modes` to `more` modes by zeros; words are kept."""
    if isinstance(initial, str):
        return initial
    parts = np.reshape(initial, (-1, modes))
    return np.hstack([parts, np.zeros((len(parts), more - modes))]).ravel()


def _equilibrium(system: ModalSystem) -> np.ndarray:
    """Coordinates in static equilibrium with the loads at time 0; a ValueError where a hinge turns freely."""
    _, K, f = system.coefficients(np.zeros(()))
    if (shift := system.equations.shift) and np.abs(np.linalg.eigvalsh(K)).min() < _FREE * shift:
        bound = "at time 0 the beam turns freely on its hinge: no position is its equilibrium"
        raise InvalidValue("initial", "equilibrium", bound, "give 'rest', or a root_stiffness")
    return np.linalg.solve(K, f)
