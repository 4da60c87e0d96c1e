"""Energy of a stop into drums and tyres, the temperature of the drums, and fading by repeated stops.

A truck of the mass M brakes from the speed V on a slope of the angle beta. From the moment the brakes act,
the braking force does the work M V^2 / 2 + M g sin(beta) s along the distance s on the ground.
While the force rises the wheels still roll, and the brakes take this work; at full force the brakes take it
if the wheels roll, and the sliding tyres if they are locked. The speed is constant in the reaction time, and
what holds it (the engine) is left out. The drums are not cooled during the stop: a drum of the mass m and the
specific heat c warms by its part of the energy over m c.

In repeated stops each front brake stops half of the truck's mass: at a wheel of the radius r this is the
moment of inertia J = M r^2 / 2 with the angular speed w = V / r, while the slope drives the wheel with the
torque L = M g sin(beta) r / 2. The torque of the brake is the smaller of what the brake gives at the pedal's
force and of what locks the wheel: the driver eases off before the wheels slide, so that all heat goes into
the drums. The gradual rise of the force is replaced: the wheel first turns freely by an angle, and then the
full torque acts at once. This angle is such that a stop with unfaded linings has the same length and the same
heat as with the gradual rise. Uphill the help of the slope is left out, as if the road were level: this
overestimates the temperature.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.checks import function, kind
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.chain.braked import BrakedStop
from brakes.common.heat import Duty, Fade, repeat_stops, warn_of_pv
from brakes.vehicle import Stop

_LEAST = 1e-12  # friction that replaces 0, which `internal_forces` refuses
BRAKES = 2  # number of brakes that share the energy


@dataclass(frozen=True)
class Drums:
    """Mass of the drums and area of the linings; every value may be an array, one entry per design.

    Parameters
    ----------
    drum_mass : float or ndarray
        Mass of each drum [kg].
    lining_area : float or ndarray
        Area of the linings of one brake [m2].
    specific_heat : float or ndarray
        Specific heat of the drum [J/(kg K)]; by default that of cast iron, about 500.
    most_pv : float or ndarray, optional
        Largest product of the lining's mean pressure and rubbing speed [W/m2]; not checked if not given.

    Raises
    ------
    ValueError
        If a value is not positive.

    Examples
    --------
    >>> chain.Drums(drum_mass=18.0, lining_area=0.05).specific_heat  # J/(kg K)
    500.0
    """

    drum_mass: Annotated[Numbers, Described("kg", "m_d", "mass of each drum", above=0)]
    lining_area: Annotated[Numbers, Described("m2", "A_l", "area of the linings of one brake", above=0)]
    specific_heat: Annotated[Numbers, Described("J/kg/K", "c", "specific heat of the drum", above=0)] = 500.0
    most_pv: Annotated[
        Numbers | None,
        Described("W/m2", "", "largest pressure times rubbing speed; not checked if not given", above=0),
    ] = None

    def __post_init__(self) -> None:
        keep_checked(self)


@dataclass(frozen=True)
class Heat(Result):
    """Energy of a stop, its parts, and the temperature rise; arrays by case, nan if the truck never stops.

    Attributes
    ----------
    stop : Stop
        The stop.
    drums : Drums, optional
        The drums that are heated.
    energy : ndarray
        Energy of the stop, from the moment the brakes act [J].
    drum_energy, tyre_energy : ndarray
        Parts of the energy into the drums and into the sliding tyres [J].
    temperature_rise : ndarray
        Temperature rise of each drum, without cooling [K]; nan without drums.
    lining_pv : ndarray
        Bound of mean pressure times rubbing speed of the linings: full pressure at the speed
        before the stop [W/m2]; nan without drums.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> heat = chain.heat_of_stop(vehicle.stop(truck, conditions))
    >>> round(float(heat.drum_energy / heat.energy), 3)  # the wheels lock: the tyres take more
    0.131
    """

    stop: Stop
    drums: Drums | None
    energy: Annotated[Numbers, Meaning("J", "energy of the stop")]
    drum_energy: Annotated[Numbers, Meaning("J", "... into the drums")]
    tyre_energy: Annotated[Numbers, Meaning("J", "... into the sliding tyres")]
    temperature_rise: Annotated[Numbers, Meaning("K", "each drum warms by, without cooling")]
    lining_pv: Annotated[
        Numbers, Meaning("W/m2", "pressure times rubbing speed of the linings, at most", "MW/m2")
    ]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"energy {spanned(self.energy, 'J')}, of which the drums take {spanned(self.drum_energy, 'J')}"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Sentence on a product of pressure and rubbing speed above the linings' limit; empty if none is."""
        return warn_of_pv(self.lining_pv, None if self.drums is None else self.drums.most_pv)


def heat_of_stop(
    stop: Stop, drums: Drums | None = None, normal_force: Numbers = np.nan, drum_radius: Numbers = np.nan
) -> Heat:
    """Compute the energy of a stop, its parts into drums and tyres, and the temperature rise of the drums.

    Parameters
    ----------
    stop : Stop
        The stop.
    drums : Drums, optional
        The drums that are heated; without them temperature rise and `lining_pv` are nan.
    normal_force : float or ndarray, optional
        Sum of the normal forces of the linings of one brake on its drum, at full force [N], for `lining_pv`.
    drum_radius : float or ndarray, optional
        Radius at which the linings rub [m], for `lining_pv`.

    Returns
    -------
    Heat
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If `stop` is no `brakes.vehicle.Stop`, or `drums` no `Drums`.

    References
    ----------
    Standard: work of a force along its path, as in the docstring of the module.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> round(float(chain.heat_of_stop(vehicle.stop(truck, conditions)).energy))  # J
    439195
    """
    kind("stop", stop, Stop)
    kind("drums", drums, Drums | None)
    c, mass = stop.conditions, stop.truck.mass
    pull, V = mass * c.gravity * np.sin(c.slope), np.asarray(c.speed)
    after = V - stop.speed_lost_in_rise
    stops = np.asarray(stop.stops)
    rising = pull * stop.rise_distance + mass * (V**2 - after**2) / 2
    full = np.where(stops, stop.brake_force * np.where(stops, stop.braking_distance, 0.0), np.nan)
    rising = np.where(stops, rising, np.nan)
    into_tyres = np.where(stop.limited_by == "road", full, 0.0 * full)
    drum_energy = rising + full - into_tyres
    rise = pv = np.full(drum_energy.shape, np.nan)
    if drums is not None:
        rise = drum_energy / (BRAKES * drums.drum_mass * drums.specific_heat)
        rubbing = V * drum_radius / stop.truck.front_wheel_radius
        pv = np.where(stops, normal_force / drums.lining_area * rubbing, np.nan)
    return Heat(stop, drums, (rising + full)[()], drum_energy[()], into_tyres[()], rise[()], pv[()])


def fade_of_stops(
    braked: BrakedStop,
    drums: Drums,
    friction: Numbers,
    torque_per_force: Callable[[Numbers], Numbers],
    **repeated: Any,
) -> Fade:
    """Compute repeated stops of a truck at the same force on the pedal, with heating and fading.

    Parameters
    ----------
    braked : BrakedStop
        The first stop, from the pedal.
    drums : Drums
        The drums that are heated.
    friction : float or ndarray
        Friction of the linings, used if no `friction_curve` is given.
    torque_per_force : callable
        Torque of a brake over the force on its actuator [m], at frictions of shape (..., cases); nan where
        the brake locks.
    **repeated
        ``stops``, ``interval``, ``cooling``, ``surroundings`` and ``friction_curve`` of `Duty`.

    Returns
    -------
    Fade
        Complete result; its angle is the rotation of the wheels.

    Raises
    ------
    ValueError
        As for `Duty`, or if a brake locks at a friction of the curve.

    References
    ----------
    Standard: conservation of energy; see the docstrings of the module and of `repeat_stops`.

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
    kind("drums", drums, Drums)
    function("torque_per_force", torque_per_force)
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
        """Return the torque of a brake [N m], limited by the torque that locks its wheel; nan stays nan."""
        return np.minimum(force * torque_per_force(np.maximum(mu, _LEAST)), braked.locking_torque)

    return repeat_stops(duty, friction, torque)


def _free_way(stop: Stop) -> np.ndarray:
    """Compute the distance [m] that a truck rolls freely in a stop that is equivalent to a given one.

    In the equivalent stop the truck first rolls without braking force, and then the full force acts at once.
    It has the same length and the same heat as the given stop, in which the force rises gradually.
    """
    way = np.where(stop.stops, stop.rise_distance + stop.braking_distance, np.nan)
    return np.nan_to_num(np.maximum(way - heat_of_stop(stop).energy / stop.brake_force, 0.0))
