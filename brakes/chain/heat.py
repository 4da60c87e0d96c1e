"""Where the energy of a stop goes, and how warm the drums get.

From the moment the brakes act, the work of the braking force along the ground is m V^2 / 2 + m g sin(beta) s.
While the force rises the wheels still roll, so that the brakes take its work; at full force they take it if
the wheels roll, and the sliding tyres if they are locked. The speed is held in the reaction time, and what
holds it (the engine) is left out. A drum that nothing cools meanwhile warms by its energy over m c.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, together
from beamdyn.common.inputs.checks import kind
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.meanings import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.common.heat import warn_of_pv
from brakes.vehicle import Stop

BRAKES = 2  # that share the energy


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
        together(**{name: x for name, x in vars(self).items() if x is not None})


@dataclass(frozen=True)
class Heat(Result):
    """Energy of a stop and what it warms; arrays have one entry per case, nan where there is no stop.

    Attributes
    ----------
    stop : Stop
        The stop.
    drums : Drums, optional
        What is warmed.
    energy : ndarray
        Energy of the stop, from the moment the brakes act [J].
    drum_energy, tyre_energy : ndarray
        Its parts into the drums and into the sliding tyres [J].
    temperature_rise : ndarray
        Temperature rise of each drum, without cooling [K]; nan without drums.
    lining_pv : ndarray
        Bound of the mean pressure of the linings times their rubbing speed: the full pressure at the speed
        before the stop [W/m2]; nan without drums.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> heat = chain.heat_of_stop(vehicle.stop(truck, conditions))
    >>> round(float(heat.drum_energy / heat.energy), 3)  # the wheels lock: the tyres take the rest
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
        """The result in one line; see `Result.headline`."""
        yield f"energy {spanned(self.energy, 'J')}, of it in the drums {spanned(self.drum_energy, 'J')}"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """A sentence if pressure times speed is above the linings' limit."""
        return warn_of_pv(self.lining_pv, None if self.drums is None else self.drums.most_pv)


def heat_of_stop(
    stop: Stop, drums: Drums | None = None, normal_force: Numbers = np.nan, drum_radius: Numbers = np.nan
) -> Heat:
    """Find where the energy of a stop goes.

    Parameters
    ----------
    stop : Stop
        The stop.
    drums : Drums, optional
        What is warmed.
    normal_force : float or ndarray, optional
        Sum of the normal forces of the linings of one brake on its drum, at full force [N].
    drum_radius : float or ndarray, optional
        Radius at which they rub [m].

    Returns
    -------
    Heat
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If `stop` is no stop.

    References
    ----------
    Standard (work of a force along its path), as in the docstring of the module.

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
