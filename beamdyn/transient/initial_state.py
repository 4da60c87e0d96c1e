"""Coordinates and velocities at the beginning of a transient: at rest, in equilibrium, or given."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats
from beamdyn.equations.elastica import QUANTITIES
from beamdyn.equations.root_motion import Quantity
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.modal.equilibrium import NoEquilibrium, SteadyLoad, find_bent, follow_to
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.system import ModalSystem

_FREE = 1e-9  # stiffness, over that of the beam with a clamped root, below which the root turns freely
_REMEDY = "give 'rest' or an array"


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
            found = _bent_equilibrium(system) if isinstance(system, ElasticaSystem) else _equilibrium(system)
            return np.concatenate([found, np.zeros(n)])
        raise ValueError(f"initial = {initial!r}: give 'rest', 'equilibrium' or an array")
    y0 = as_floats(initial)
    if y0 is None or y0.shape != (2 * n,) or not np.isfinite(y0).all():
        bound = f"give {2 * n} finite numbers, coordinates then velocities, or 'rest' or 'equilibrium'"
        raise InvalidValue("initial", initial, bound)
    return y0


def _equilibrium(system: ModalSystem) -> np.ndarray:
    """Coordinates in static equilibrium with the loads at time 0; a ValueError where a hinge turns freely."""
    _, K, f = system.coefficients(np.zeros(()))
    if (shift := system.equations.shift) and np.abs(np.linalg.eigvalsh(K)).min() < _FREE * shift:
        bound = "at time 0 the beam turns freely on its hinge: no position is its equilibrium"
        raise InvalidValue("initial", "equilibrium", bound, "give 'rest', or a root_stiffness")
    return np.linalg.solve(K, f)


@dataclass(frozen=True)
class LoadAtOnce(SteadyLoad):
    """Equilibrium under all loads at one time, gravity and angular acceleration included.

    The continuation parameter is the squared speed, and all other quantities grow in proportion to it; for a
    beam that does not rotate it is the fraction of the loads.

    Parameters
    ----------
    quantities : dict of str to float
        Quantities of the root's motion, per unit of the parameter.
    """

    quantities: dict[Quantity, float] | None = None

    @cached_property
    def _values(self) -> dict[Quantity, float]:
        values = dict(self.quantities or {})
        values["root_transverse"] = values.get("root_transverse", 0.0) + self.push
        return {quantity: value for quantity, value in values.items() if value}

    @property
    def transverse(self) -> float:
        """Transverse acceleration of the root, or what else bends the straight beam, per parameter."""
        given = self._values.get("root_transverse", 0.0)
        return given or float(np.abs(self.load(self.elastica.at(np.zeros(self.elastica.size)))).max())


def _bent_equilibrium(system: ElasticaSystem) -> np.ndarray:
    """Coordinates (n,) in equilibrium with the loads at time 0, on the branch of the scene."""
    root, lowest = system.root(np.zeros(())), Solver(system.equations.steady()).lowest_at_rest
    speed = abs(float(root.speed)) or 1.0
    is_bent = system.branch == "bent"
    if is_bent and not root.speed:
        bound = "at time 0 the beam does not rotate, and no branch but that of the beam at rest exists"
        raise InvalidValue(
            "initial", "equilibrium", bound, f"{_REMEDY}, or a motion that begins with a speed"
        )
    values: dict[Quantity, float] = {name: float(getattr(root, name)) / speed**2 for name in QUANTITIES}
    size = max(1.0, abs(values["root_transverse"]) / system.elastica.length)
    load = LoadAtOnce(system.elastica, lowest / size, quantities=values)
    try:
        return find_bent(load, speed) if is_bent else follow_to(load, np.array([speed]))[0]
    except NoEquilibrium as error:
        bound = f"at time 0 there is none: {error}"
        raise InvalidValue("initial", "equilibrium", bound, _REMEDY) from None
