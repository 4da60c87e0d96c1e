"""From the force on the pedal to the brakes' actuators and back, and a truck's stop by that force.

Force and stroke rise with the pedal's force, each by a formula that can be inverted. A given force on the
actuators also fixes the stroke of the pedal's rod, so that the pedal's force falls as 1 / ratio while its
travel rises in proportion to the ratio. So each inverse question has one answer or none.

The stop uses the smaller of the forces that brakes and road can give.
The torque of a brake at a wheel is C* r times the force on its actuator, with brake factor C* and drum
radius r.  So the pedal force at which the wheels just lock follows from the torque of locked wheels in closed
form.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, not_negative, positive, together
from beamdyn.common.inputs.checks import InvalidValue, kind, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.chain.lines import BrakeCable, HydraulicLine
from brakes.chain.pedal import Pedal
from brakes.common.limits import EDGE, passes, verdict
from brakes.vehicle import Stop, StopConditions, Truck, friction_to_stop, stop
from brakes.vehicle.backwards import Needed, needed

Line = HydraulicLine | BrakeCable


@dataclass(frozen=True)
class Actuation(Result):
    """Forces and travel from pedal to actuators; arrays have one entry per case.

    Attributes
    ----------
    pedal, line : Pedal, HydraulicLine or BrakeCable
        The pedal, and the line or cable that it acts on.
    pedal_force : ndarray
        Force on the pedal [N].
    output_force : ndarray
        Force behind pedal and booster [N].
    pressure : ndarray
        Pressure of the line [Pa]; nan for a cable.
    actuator_force : ndarray
        Force on each actuator of a brake [N].
    pedal_travel : ndarray
        Travel of the pedal [m].

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> found = chain.actuate(chain.Pedal(ratio=5.0, force=450.0), line)
    >>> round(float(found.actuator_force), 1)  # N
    4593.9
    """

    pedal: Pedal
    line: Line
    pedal_force: Annotated[Numbers, Meaning("N", "force on pedal or lever")]
    output_force: Annotated[Numbers, Meaning("N", "force behind pedal or lever and booster")]
    pressure: Annotated[Numbers, Meaning("Pa", "pressure of the line", "MPa")]
    actuator_force: Annotated[Numbers, Meaning("N", "force on each actuator")]
    pedal_travel: Annotated[Numbers, Meaning("m", "travel of pedal or lever, by line or cable", "mm")]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{spanned(self.pedal_force, 'N')} on the pedal"
        yield f"{spanned(self.actuator_force, 'N')} on each actuator"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentence on a pedal force above the limit of the standards; empty if it is allowed."""
        return (f"the {self.verdict}",) if passes(self.pedal.operated_by, self.pedal_force) else ()

    @property
    def verdict(self) -> str:
        """One sentence that compares the pedal's force with the limit of the standards."""
        return verdict(self.pedal.operated_by, self.pedal_force)


def actuate(pedal: Pedal, line: Line) -> Actuation:
    """Compute forces and travel from the pedal to the actuators at the pedal's force.

    Parameters
    ----------
    pedal : Pedal
        The pedal and the force on it.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the actuators.

    Returns
    -------
    Actuation
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If the pedal would travel further than it can, or the pressure exceeds the largest that
        the cylinders bear.

    References
    ----------
    Standard formulas of a lever and of the volume of a fluid, in `Pedal` and `HydraulicLine`. Limits of the
    force: ISO 6292:2020.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> found = chain.actuate(chain.Pedal(ratio=5.0, force=450.0, booster=3.0), line)
    >>> round(float(found.pressure) / 1e6, 3)  # MPa
    17.407
    """
    _check(pedal, line)
    output = pedal.output_force
    travel = pedal.ratio * line.stroke(output)
    if isinstance(line, HydraulicLine) and line.most_pressure is not None:
        over = np.asarray(output) > line.limit * (1 + EDGE)
        bound, remedy = "the pedal's force gives {limit}", "less force, or a larger master cylinder"
        refuse(over, "most_pressure", line.most_pressure, "Pa", bound, remedy, limit=line.pressure(output))
    if pedal.travel is not None:
        late = np.asarray(travel) > pedal.travel * (1 + EDGE)
        bound, remedy = "it needs a travel of {limit}", "less lost travel, or a smaller ratio"
        refuse(late, "travel", pedal.travel, "m", bound, remedy, limit=travel)
    force = pedal.force + 0.0 * output
    return Actuation(pedal, line, force, output, line.pressure(output), line.gain * output, travel)


def force_for(pedal: Pedal, line: Line, actuator_force: Numbers) -> Needed:
    """Find the force on the pedal [N] that gives a wanted force on the actuators.

    Parameters
    ----------
    pedal : Pedal
        The pedal; its own force is not used.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the actuators.
    actuator_force : float or ndarray
        Wanted force on each actuator [N].

    Returns
    -------
    Needed
        The force; none if the line's pressure or the pedal's travel reaches its limit first.

    Raises
    ------
    ValueError
        If the force is negative, or the shapes do not broadcast.

    References
    ----------
    Standard formulas of a lever and of the volume of a fluid, as in `actuate`, solved in closed form.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    >>> round(float(chain.force_for(chain.Pedal(ratio=5.0, force=1.0), line, 11650.0).value), 2)  # N
    1141.19
    """
    output = _output_for(pedal, line, actuator_force)
    travel = pedal.ratio * line.stroke(output)
    return needed(pedal.rod_force_for(output) / pedal.ratio, *_ends(pedal, line, output, travel))


def ratio_for(pedal: Pedal, line: Line, actuator_force: Numbers) -> Needed:
    """Find the pedal ratio that gives a wanted force on the actuators at the pedal's force.

    Parameters
    ----------
    pedal : Pedal
        The pedal; its own ratio is not used.
    line : HydraulicLine or BrakeCable
        Transmission of the force to the actuators.
    actuator_force : float or ndarray
        Wanted force on each actuator [N].

    Returns
    -------
    Needed
        The ratio; none if the pedal's travel, which rises with the ratio, reaches its limit first.

    Raises
    ------
    ValueError
        If the force is negative, or the shapes do not broadcast.

    References
    ----------
    Standard formulas of a lever and of the volume of a fluid, as in `actuate`, solved in closed form.

    Examples
    --------
    >>> line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175, lost_travel=0.02)
    >>> pedal = chain.Pedal(ratio=1.0, force=450.0, travel=0.15)
    >>> chain.ratio_for(pedal, line, 11650.0).message
    'none: the pedal reaches the end of its travel first; a higher ratio or force needs more travel'
    """
    output = _output_for(pedal, line, actuator_force)
    ratio = pedal.rod_force_for(output) / pedal.force
    return needed(ratio, *_ends(pedal, line, output, ratio * line.stroke(output)))


def _check(pedal: Pedal, line: Line) -> None:
    kind("pedal", pedal, Pedal)
    if not isinstance(line, HydraulicLine | BrakeCable):
        raise InvalidValue("line", line, "give a HydraulicLine or a BrakeCable")
    together(pedal=pedal.output_force, line=line.gain + line.stroke(1.0))


def _output_for(pedal: Pedal, line: Line, actuator_force: Numbers) -> Numbers:
    """Compute the force behind the booster [N] that gives a wanted force on the actuators."""
    _check(pedal, line)
    wanted = not_negative("actuator_force", actuator_force, "N")
    together(actuator_force=wanted, pedal=pedal.output_force * line.gain)
    return wanted / line.gain


def _ends(pedal: Pedal, line: Line, output: Numbers, travel: Numbers) -> tuple[tuple[Numbers, str], ...]:
    """Find the cases without a solution (pressure or travel at the limit), and the reasons."""
    over = output > line.limit * (1 + EDGE)
    far = travel > (np.inf if pedal.travel is None else pedal.travel * (1 + EDGE))
    return (
        (over, "the pressure, which rises with the force, would exceed the largest that the cylinders bear"),
        (far, "the pedal reaches the end of its travel first; a higher ratio or force needs more travel"),
    )


# The stop of a truck -----------------------------------------------------------------------------------


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
