"""A truck's stop from the pedal force, with the smaller of the forces that brakes and road can give.

The torque of a brake at a wheel is C* r times the force on its actuator, with brake factor C* and drum
radius r.  So the pedal force at which the wheels just lock follows from the torque of locked wheels in closed
form.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, positive
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.result import Result
from brakes.chain.actuation import Actuation, Line, actuate, force_for
from brakes.chain.pedal import Pedal
from brakes.vehicle import Stop, StopConditions, Truck, friction_to_stop, stop
from brakes.vehicle.backwards import Needed, needed


@dataclass(frozen=True)
class WheelBrakes:
    """Equal brakes on the braked wheels; every value may be an array, one entry per design.

    Parameters
    ----------
    c_star : float or ndarray
        Brake factor C* = torque / (force on the actuator times drum radius).
    drum_radius : float or ndarray
        Radius r at which the linings rub [m].
    wheel_radius : float or ndarray
        Radius of the braked wheels [m].
    number : float or ndarray
        Number of brakes.

    Raises
    ------
    ValueError
        If a value is not positive, or the number of brakes is not whole.

    Examples
    --------
    >>> brakes = chain.WheelBrakes(c_star=4.0, drum_radius=0.15, wheel_radius=0.4)
    >>> round(brakes.force_per_actuator_force, 6)
    3.0
    """

    c_star: Annotated[Numbers, Described("", "C*", "torque / (actuator force times drum radius)", above=0)]
    drum_radius: Annotated[Numbers, Described("m", "r", "radius at which the linings rub", above=0)]
    wheel_radius: Annotated[Numbers, Described("m", "r_w", "radius of the braked wheels", above=0)]
    number: Annotated[Numbers, Described("", "n", "number of brakes", least=1, whole=True)] = 2.0

    def __post_init__(self) -> None:
        keep_checked(self)

    @property
    def force_per_actuator_force(self) -> Numbers:
        """Braking force of all braked wheels along the ground, over the force on each actuator."""
        return self.number * self.c_star * self.drum_radius / self.wheel_radius


@dataclass(frozen=True)
class BrakedStop(Result):
    """A truck's stop from the force on its pedal; arrays have one entry per case.

    Attributes
    ----------
    actuation : Actuation
        Forces and travel from the pedal to the actuators.
    stop : Stop
        The stop, with the smaller of the forces that brakes and road can give.
    available_torque : ndarray
        Torque that each front brake can give at the pedal's force [N m].
    locking_torque : ndarray
        Torque of each front brake at which its wheel locks [N m]; inf where the truck would overturn before.
    locking : Needed
        Force on the pedal at which the wheels just lock [N].
    friction : Needed
        Least friction of the tyres with which locked wheels stop the truck.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> pedal = chain.Pedal(ratio=5.0, force=450.0)
    >>> found = chain.brake_from_pedal(truck, conditions, pedal, line, torque_per_force=0.728)
    >>> str(found.stop.limited_by), round(float(found.locking_force))  # N
    ('brake', 1141)
    """

    actuation: Actuation
    stop: Stop
    available_torque: Annotated[Numbers, Meaning("N m", "torque that a brake can give")]
    locking_torque: Annotated[Numbers, Meaning("N m", "torque at which its wheel locks")]
    locking: Needed
    friction: Needed

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield from self.stop.headline()
        yield "" if np.ndim(self.limited_by) else f"the {self.limited_by} limits"

    @property
    def limited_by(self) -> Any:
        """What limits the braking force: "brake", or "road" where the wheels lock."""
        return self.stop.limited_by

    @property
    def locking_force(self) -> Numbers:
        """Force on the pedal at which the wheels just lock [N]; nan where it cannot be reached."""
        return self.locking.value

    @property
    def locking_pressure(self) -> Numbers:
        """Line pressure at which the wheels just lock [Pa]; nan for a cable."""
        return self.actuation.pressure * self.locking_torque / self.available_torque

    @property
    def least_friction(self) -> Numbers:
        """Least tyre friction with which locked wheels stop the truck; nan if more than 2 is needed."""
        return self.friction.value


def brake_from_pedal(
    truck: Truck, conditions: StopConditions, pedal: Pedal, line: Line, torque_per_force: Numbers
) -> BrakedStop:
    """Compute the stop of a truck from the force on its pedal.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing.
    pedal : Pedal
        The pedal and the force on it.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the brakes.
    torque_per_force : float or ndarray
        Torque of a brake over the force on its actuator, C* r [m].

    Returns
    -------
    BrakedStop
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        As for `actuate` and `brakes.vehicle.stop`.

    References
    ----------
    Yoo et al. (1997), section 2, with the smaller of the forces that brakes and road can give.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> pedal = chain.Pedal(ratio=5.0, force=450.0, booster=3.0)
    >>> found = chain.brake_from_pedal(truck, conditions, pedal, line, torque_per_force=0.728)
    >>> round(float(found.stop.distance), 2)  # m, with locked wheels
    13.42
    """
    gain = positive("torque_per_force", torque_per_force, "m")
    actuation = actuate(pedal, line)
    available = gain * actuation.actuator_force
    stopped = stop(truck, conditions, available)
    torque = np.asarray(stopped.locking_torque)
    never = np.isinf(torque)
    locking = force_for(pedal, line, np.where(never, 0.0, torque) / gain)
    words = "the truck would overturn over its front axle before the wheels lock"
    return BrakedStop(
        actuation,
        stopped,
        available_torque=available,
        locking_torque=torque[()],
        locking=needed(locking.value, (never, words), (np.asarray(locking.reason) != "", locking.reason)),
        friction=friction_to_stop(truck, conditions),
    )
