"""Stops of a truck that follow each other: how hot its drums get, and how far its linings fade.

Each front brake stops half the mass from the speed V, J = M r^2 / 2 and w = V / r about a wheel of radius r,
while the slope drives on with L = M g sin(beta) r / 2. Its torque is the smaller of what it gives at the
pedal's force and of what locks its wheel: the driver eases off before the wheels slide, so that all heat is
the drums'. While its force rises a wheel turns by more than at full force: by the angle that makes the heat
of a stop with unfaded linings the energy of that stop. Uphill the help of the slope is left out, as if the
road were level: it gets no hotter.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import kind
from brakes.chain.braked import BrakedStop
from brakes.chain.heat import BRAKES, Drums, heat_of_stop
from brakes.common.heat import Duty, Fade, repeat_stops
from brakes.vehicle import Stop

_LEAST = 1e-12  # friction in place of none, at which no brake gives a torque


def fade_of_stops(
    braked: BrakedStop,
    drums: Drums,
    friction: Numbers,
    torque_per_force: Callable[[Numbers], Numbers],
    **repeated: Any,
) -> Fade:
    """Repeat a truck's stop at the same force on the pedal.

    Parameters
    ----------
    braked : BrakedStop
        The stop from the pedal.
    drums : Drums
        What is warmed.
    friction : float or ndarray
        Friction of the linings where there is no curve.
    torque_per_force : callable
        Torque of a brake over the force on its actuator [m], at frictions of shape (..., cases); nan where it
        locks.
    **repeated
        ``stops``, ``interval``, ``cooling``, ``surroundings`` and ``friction_curve`` of `Duty`.

    Returns
    -------
    Fade
        Complete result, with the angle that the wheels turn.

    Raises
    ------
    ValueError
        As for `Duty`, or if a brake locks at a friction of the curve.

    References
    ----------
    Standard (conservation of energy): the docstring of the module, and of `repeat_stops`.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.1, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> stopped = chain.brake_from_pedal(truck, conditions, chain.Pedal(5.0, 450.0), line, 0.728)
    >>> drums, curve = chain.Drums(18.0, 0.05), [[293.15, 0.39], [493.15, 0.2]]
    >>> found = chain.fade_of_stops(
    ...     stopped, drums, 0.39, lambda mu: 0.728 * mu / 0.39, stops=3, friction_curve=curve
    ... )
    >>> found.angle.round(1)  # rad: each stop is longer
    array([53.7, 60.4, 70.1])
    """
    kind("braked", braked, BrakedStop)
    stop, force = braked.stop, braked.actuation.actuator_force
    radius, c = stop.truck.front_wheel_radius, stop.conditions
    share = stop.truck.mass / BRAKES
    duty = Duty(
        inertia=share * np.square(radius),
        speed=c.speed / radius,
        heated_mass=drums.drum_mass,
        specific_heat=drums.specific_heat,
        load_torque=share * c.gravity * np.maximum(np.sin(c.slope), 0.0) * radius,
        free_angle=_free_way(stop) / radius,
        **repeated,
    )

    def torque(mu: Numbers) -> Numbers:
        """Torque of a brake whose wheel does not lock; nan stays."""
        return np.minimum(force * torque_per_force(np.maximum(mu, _LEAST)), braked.locking_torque)

    return repeat_stops(duty, friction, torque)


def _free_way(stop: Stop) -> np.ndarray:
    """Way before the full force, if that came at once, so that the stop is as long and as hot [m]."""
    way = np.where(stop.stops, stop.rise_distance + stop.braking_distance, np.nan)
    return np.nan_to_num(np.maximum(way - heat_of_stop(stop).energy / stop.brake_force, 0.0))
