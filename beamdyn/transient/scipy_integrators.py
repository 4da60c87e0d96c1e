"""Integration by `scipy.integrate.solve_ivp`."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from scipy.integrate import OdeSolver, solve_ivp

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.gauss_solver import GaussCollocation
from beamdyn.transient.integration import integrate
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.trajectory import SAMPLES

_KNOWN_METHODS = ("RK23", "RK45", "DOP853", "Radau", "BDF", "LSODA")
_JACOBIAN_METHODS = ("Radau", "BDF", "LSODA")
_SCALING_TOLERANCE = 1e-2  # tolerance of the run that gives the magnitudes of the coordinates


@dataclass(frozen=True)
class SolveIvpPath:
    """Solution of `solve_ivp` as a path.

    Parameters
    ----------
    solution : OdeSolution
        Dense output.
    times : ndarray
        Sampled times [s].
    """

    solution: Any
    times: np.ndarray

    @property
    def start(self) -> float:
        """First time [s]."""
        return float(self.times[0])

    @property
    def end(self) -> float:
        """Last time [s]."""
        return float(self.times[-1])

    @property
    def samples(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Times (k,) [s], coordinates and velocities (k, n), several in each step."""
        return self.times, *self.at(self.times)

    def at(self, t: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Coordinates and velocities at times t [s]: shapes (len(t), n)."""
        q, v = np.split(self.solution(t), 2)
        return q.T, v.T


def check_method(method: object) -> None:
    """Refuse anything but a method of `solve_ivp`."""
    named = isinstance(method, str) and method in _KNOWN_METHODS
    if not named and not (isinstance(method, type) and issubclass(method, OdeSolver)):
        known = ", ".join(map(repr, _KNOWN_METHODS))
        raise InvalidValue("method", method, f"give 'auto', {known} or a class derived from OdeSolver")


def integrate_by_solve_ivp(
    system: ModalSystem | ElasticaSystem,
    y0: np.ndarray,
    t_end: float,
    method: str | type[OdeSolver],
    tolerance: float,
    options: dict[str, Any],
) -> SolveIvpPath:
    """Integrate by a method of `solve_ivp`.

    Parameters
    ----------
    system : ModalSystem or ElasticaSystem
        The equations.
    y0 : ndarray, shape (2 n,)
        Coordinates and velocities at time 0.
    t_end : float
        End [s].
    method : str or OdeSolver
        The method, by name or class.
    tolerance : float
        Default of rtol; that of atol is a tenth of it, times the largest magnitude of each coordinate.
    options : dict
        Further options of `solve_ivp` and of the method.

    Returns
    -------
    SolveIvpPath

    Raises
    ------
    ArithmeticError
        If `solve_ivp` fails.
    """
    options = {"rtol": tolerance, "atol": _absolute_tolerance(system, y0, t_end, tolerance), **options}
    if isinstance(method, type) and issubclass(method, GaussCollocation):
        if isinstance(system, ElasticaSystem):
            bound = "it integrates linear equations only, and those of large_deflection are not"
            raise InvalidValue("method", method.__name__, bound, "give 'auto'")
        options = {"system": system, **options}
    elif method in _JACOBIAN_METHODS:
        options = {"jac": system.jacobian, **options}
    chosen: Any = method  # one of those that `check_method` accepts
    result: Any = solve_ivp(system.rhs, (0.0, t_end), y0, method=chosen, dense_output=True, **options)
    if not result.success:
        raise ArithmeticError(f"solve_ivp stopped at t = {result.t[-1]:g} s: {result.message}")
    steps = [np.linspace(a, b, SAMPLES + 1)[:-1] for a, b in pairwise(result.t)]
    return SolveIvpPath(result.sol, np.concatenate([*steps, [t_end]]))


def _absolute_tolerance(
    system: ModalSystem | ElasticaSystem, y0: np.ndarray, t_end: float, tolerance: float
) -> np.ndarray:
    """Absolute tolerances of coordinates and velocities, scaled by a coarse run of our own integrator."""
    path, _, _ = integrate(system, y0, t_end, _SCALING_TOLERANCE)
    sizes = [np.abs(x).max(axis=0) for x in path.samples[1:]]
    return 0.1 * tolerance * np.concatenate(sizes) + 1e-300
