"""Stopping distance of a vehicle by its energy: M v^2 = 4 mu F L, and its integral for a varying force."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamdyn.common.checks import not_negative, positive
from beamdyn.common.results import Result

_RTOL, _ATOL = 1e-12, 1e-12  # of the integration; the latter [m]


@dataclass(frozen=True)
class StoppingDistance(Result):
    """A stop on one rim with two pads.

    Parameters
    ----------
    distance : float
        Stopping distance [m]; inf where the brake does not stop the vehicle.
    energy : float
        Energy that the pads take up [J].
    deceleration : float
        Mean deceleration over the distance [m/s2].
    status : {"stops", "does not stop"}
        Whether it stops.
    message : str
        The status as a sentence.
    """

    distance: float
    energy: float
    deceleration: float
    status: str
    message: str


def stop(
    mass: float,
    speed: float,
    pad_force: float | Callable[[float], float],
    friction: float,
    wheel_inertia: float = 0.0,
    tyre_radius: float | None = None,
    rim_radius: float | None = None,
) -> StoppingDistance:
    """Stop on level ground by the pads of one rim alone, without slip of the tyre.

    With the force F on each of two pads, E = (M + J / R^2) v^2 / 2 = integral of 2 mu F (r / R) ds over the
    stopping distance; constant F, no inertia and r = R give M v^2 = 4 mu F L (the eeBrake paper's form).

    Parameters
    ----------
    mass : float
        Mass M of vehicle and rider, wheels included [kg].
    speed : float
        Speed v at which the pads begin to press [m/s].
    pad_force : float or callable
        Force F of each pad on the rim [N], constant or as a function of the distance s [m].
    friction : float
        Coefficient of friction mu between pads and rim.
    wheel_inertia : float
        Moment of inertia J of all wheels about their axles [kg m2].
    tyre_radius : float, optional
        Rolling radius R of the wheels [m]; needed with the inertia of the wheels.
    rim_radius : float, optional
        Radius r at which the pads press [m]; that of the tyre if not given, as in the paper.

    Returns
    -------
    StoppingDistance

    Raises
    ------
    ValueError
        If a value is out of its bounds, or the tyre's radius is missing.
    """
    inertia = _equivalent_mass(wheel_inertia, tyre_radius)
    lever = _radius_ratio(rim_radius, tyre_radius)
    energy = (positive("mass", mass, "kg") + inertia) * not_negative("speed", speed, "m/s") ** 2 / 2
    factor = 2 * positive("friction", friction) * lever
    distance = _integrated(energy, factor, pad_force) if callable(pad_force) else None
    if distance is None:
        force = not_negative("pad_force", pad_force, "N")  # pyright: ignore[reportArgumentType]
        distance = energy / (factor * force) if force else np.inf
    return _result(distance, energy, speed)


def _equivalent_mass(inertia: float, tyre_radius: float | None) -> float:
    if not not_negative("wheel_inertia", inertia, "kg m2"):
        return 0.0
    if tyre_radius is None:
        raise ValueError("wheel_inertia needs tyre_radius, the rolling radius of the wheels in m")
    return inertia / positive("tyre_radius", tyre_radius, "m") ** 2


def _radius_ratio(rim_radius: float | None, tyre_radius: float | None) -> float:
    if rim_radius is None:
        return 1.0
    if tyre_radius is None:
        raise ValueError("rim_radius needs tyre_radius, the rolling radius of the wheels in m")
    ratio = positive("rim_radius", rim_radius, "m") / positive("tyre_radius", tyre_radius, "m")
    if ratio > 1:
        raise ValueError(f"rim_radius = {rim_radius:g} m: it must not exceed tyre_radius = {tyre_radius:g} m")
    return ratio


def _integrated(energy: float, factor: float, force: Callable[[float], float]) -> float:
    """Distance s at which ds/dE = 1 / (factor F(s)) has used the energy up; inf if F vanishes before."""
    from scipy.integrate import solve_ivp

    if not energy:
        return 0.0
    if not force(0.0) > 0:
        raise ValueError(f"pad_force at s = 0 is {force(0.0):g} N: begin where the pads begin to press")

    def rate(_: float, s: np.ndarray) -> np.ndarray:
        pressing = force(float(s[0]))
        return np.array([1 / (factor * pressing) if pressing > 0 else np.nan])

    solution = solve_ivp(rate, (0.0, energy), np.zeros(1), method="DOP853", rtol=_RTOL, atol=_ATOL)
    return float(solution.y[0, -1]) if solution.success else np.inf


def _result(distance: float, energy: float, speed: float) -> StoppingDistance:
    if distance == np.inf:
        return StoppingDistance(
            distance, energy, 0.0, "does not stop", "the pads do not press long enough: no stop"
        )
    deceleration = speed**2 / (2 * distance) if distance else 0.0
    return StoppingDistance(distance, energy, deceleration, "stops", f"stops in {distance:.6g} m")
