"""A vehicle that brakes both axles on a slope: partly, or so hard that wheels lock or it pitches over.

The brakes give the force B of all wheels, the share phi of it in front. An axle gives the smaller of its
share and of what its tyres hold, mu times its load, which follows the braking ratio tau: with W = M g
cos(beta),

    tau = min(phi B / W, mu n_f(tau)) + min((1 - phi) B / W, mu n_r(tau)).

Each minimum is of functions that are linear in tau, so that the right side is concave and above 0 at tau = 0:
it meets tau once, at the least of the ratios that the four sums of these functions give alone. The driver
eases off where the vehicle would pitch over. None of it depends on which way the slope goes: weight and
inertia act at the centre of gravity. How it comes to rest: `brakes.vehicle.rise`; until the brakes act it
coasts, so that it gets faster downhill and slower uphill in the driver's reaction time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, numbers, positive, together
from beamdyn.common.inputs.checks import kind, one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.meanings import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.vehicle.axles import Axle, Vehicle, other
from brakes.vehicle.holding import Road
from brakes.vehicle.rise import coast, to_rest

_EDGE = 1e-9  # relative difference of two ratios or accelerations that are equal
_STATES = ("no wheel locks", "front wheels locked", "rear wheels locked", "all wheels locked")
_PITCHES = "at the limit of pitching over"


@dataclass(frozen=True)
class Approach:
    """How a vehicle comes to its stop; every value may be an array, one entry per design.

    Parameters
    ----------
    speed : float or ndarray
        Speed V before the stop [m/s].
    reaction_time : float or ndarray
        Time t1 until the brakes act, in which it coasts [s].
    rise_time : float or ndarray
        Time t2 in which their force rises linearly [s].
    brake_force : float or ndarray, optional
        Force B along the ground that the brakes of all wheels can give [N].
    heading : {"downhill", "uphill"}
        Which way it goes on the slope.

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> vehicle.Approach(speed=20 / 3.6, rise_time=0.3).reaction_time  # s
    0.0
    """

    speed: Annotated[Numbers, Described("m/s", "V", "speed before the stop", above=0)]
    reaction_time: Annotated[
        Numbers, Described("s", "t1", "time before the brakes act, in which it coasts", least=0)
    ] = 0.0
    rise_time: Annotated[Numbers, Described("s", "t2", "time in which the brake force rises", least=0)] = 0.0
    brake_force: Annotated[
        Numbers | None,
        Described(
            "N",
            "B",
            "force along the ground of all brakes; that of the lever, or without one the most at which no "
            "wheel locks, if not given",
            above=0,
        ),
    ] = None
    heading: Annotated[Literal["downhill", "uphill"], Described(meaning="which way it goes on the slope")] = (
        "downhill"
    )

    def __post_init__(self) -> None:
        one_of("heading", self.heading, ("downhill", "uphill"))
        keep_checked(self)
        given = vars(self).items()
        together(**{name: x for name, x in given if x is not None and name != "heading"})


@dataclass(frozen=True)
class Slowing(Result):
    """A stop on a slope, with both axles braked; arrays have one entry per case.

    Attributes
    ----------
    vehicle, road, approach : Vehicle, Road, Approach
        What stops where, and from which speed.
    leading : {"front", "rear"}
        The axle that leads.
    status : str or ndarray of str
        ``"no wheel locks"``, ``"front wheels locked"``, ``"rear wheels locked"``, ``"all wheels locked"``, or
        ``"at the limit of pitching over"``.
    stops : ndarray of bool
        Whether it comes to rest.
    ratio : ndarray
        Braking ratio at full force.
    front_force, rear_force, front_load, rear_load : ndarray
        Braking forces and loads of the axles at full force [N].
    deceleration : ndarray
        At full force [m/s2]; negative where it gets faster.
    distance, time : ndarray
        From the driver's reaction to rest [m], [s]; inf if it never stops.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> road, approach = vehicle.Road(slope=0.1, friction=0.8), vehicle.Approach(speed=8.0)
    >>> found = vehicle.slow_down(bicycle, road, approach, brake_force=250.0, front_share=0.5)
    >>> str(found.status), round(float(found.distance), 3)
    ('no wheel locks', 14.911)
    """

    vehicle: Vehicle
    road: Road
    approach: Approach
    leading: Axle
    status: Any
    stops: Any
    ratio: Annotated[Numbers, Meaning("", "braking force over the force normal to the road")]
    front_force: Annotated[Numbers, Meaning("N", "braking force of the front wheels")]
    rear_force: Annotated[Numbers, Meaning("N", "braking force of the rear wheels")]
    front_load: Annotated[Numbers, Meaning("N", "front axle's load, braked")]
    rear_load: Annotated[Numbers, Meaning("N", "rear axle's load, braked")]
    deceleration: Annotated[Numbers, Meaning("m/s2", "deceleration at full force")]
    distance: Annotated[Numbers, Meaning("m", "stopping distance, from the driver's reaction")]
    time: Annotated[Numbers, Meaning("s", "time to rest")]

    def headline(self) -> Iterator[str]:
        """The result in one line; see `Result.headline`."""
        yield f"{spanned(self.distance, 'm')} in {spanned(self.time, 's')}"
        yield f"{self.status}" if np.ndim(self.status) == 0 else ""
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """A sentence if it stands, uphill, before the brakes hold it."""
        a = self.approach
        since = np.asarray(self.time - a.reaction_time)
        with np.errstate(divide="ignore", invalid="ignore"):  # where the force does not rise but is there
            risen = np.where(since < a.rise_time, np.maximum(since, 0.0) / a.rise_time, since >= 0)
        held = self.ratio * np.cos(self.road.slope) * risen
        rolls = (a.heading == "uphill") & (held < np.sin(self.road.slope) * (1 - _EDGE))
        many = f", in {np.sum(rolls)} of {rolls.size} cases" if rolls.ndim else ""
        said = "it stands before its brakes hold it, and rolls back until they do: that is not counted"
        return (f"{said}{many}",) if np.any(rolls) else ()

    @property
    def message(self) -> str:
        """Whether it stops, in one sentence; of many cases, how many do not."""
        if np.ndim(self.stops):
            return f"{np.sum(~self.stops)} of {np.size(self.stops)} cases do not stop"
        held = "stops" if self.stops else "does not stop: the slope pulls as much as the brakes hold, or more"
        return f"{held}; {self.status}"


def slow_down(
    vehicle: Vehicle,
    road: Road,
    approach: Approach,
    brake_force: Numbers,
    front_share: Numbers,
    leading: Axle = "front",
) -> Slowing:
    """Stop a vehicle on a slope by the brakes of both axles.

    Parameters
    ----------
    vehicle, road, approach : Vehicle, Road, Approach
        What stops where, and from which speed; the approach's own force is not used.
    brake_force : float or ndarray
        Force along the ground that all brakes can give [N].
    front_share : float or ndarray
        Share of the front wheels in it, 0 to 1.
    leading : {"front", "rear"}
        The axle that leads: the lower one downhill, the upper one uphill.

    Returns
    -------
    Slowing
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If a value is out of bounds, or the shapes do not broadcast.

    References
    ----------
    Standard (moments about where the tyres stand, and constant forces): the docstring of the module.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> road, approach = vehicle.Road(slope=0.0, friction=0.8), vehicle.Approach(speed=8.0)
    >>> hard = vehicle.slow_down(bicycle, road, approach, brake_force=1000.0, front_share=1.0)
    >>> str(hard.status), round(float(hard.ratio), 4)
    ('at the limit of pitching over', 0.5636)
    """
    kind("vehicle", vehicle, Vehicle)
    kind("road", road, Road)
    kind("approach", approach, Approach)
    one_of("leading", leading, ("front", "rear"))
    force, share = positive("brake_force", brake_force, "N"), numbers("front_share", front_share)
    refuse((np.asarray(share) < 0) | (np.asarray(share) > 1), "front_share", share, "", "it must be 0 to 1")
    shape = vehicle.mass * vehicle.cg_height * vehicle.wheelbase
    times = approach.speed * (1 + approach.reaction_time + approach.rise_time)
    together(vehicle=shape, approach=times, brake_force=force, front_share=share, **vars(road))
    weight = vehicle.mass * road.gravity * np.cos(road.slope) + 0.0 * times
    braked: dict[Axle, Any] = {
        "front": share * force / weight,
        "rear": (1 - np.asarray(share)) * force / weight,
    }
    ratio, status = _ratio(vehicle, road.friction, braked, leading)
    loads = {axle: vehicle.load_share(axle, ratio, leading) for axle in braked}
    forces = {axle: np.minimum(braked[axle], road.friction * loads[axle]) for axle in braked}
    eased = ratio / sum(forces.values())  # below 1 only where the driver eases off
    pull = road.gravity * np.sin(road.slope) * (1 if approach.heading == "downhill" else -1)
    rate = road.gravity * np.cos(road.slope) * ratio
    stops = rate - pull > _EDGE * rate
    coasted, reaction, speed = coast(approach.speed, pull, approach.reaction_time)
    way, time = to_rest(speed, pull, rate, approach.rise_time, stops)
    return Slowing(
        vehicle,
        road,
        approach,
        leading,
        status,
        stops[()],
        ratio=ratio,
        front_force=weight * eased * forces["front"],
        rear_force=weight * eased * forces["rear"],
        front_load=weight * loads["front"],
        rear_load=weight * loads["rear"],
        deceleration=rate - pull,
        distance=(coasted + way)[()],
        time=(reaction + time)[()],
    )


def _ratio(vehicle: Vehicle, friction: Numbers, braked: dict[Axle, Any], leading: Axle) -> tuple[Any, Any]:
    """Braking ratio, and the words for what ends it."""
    moved = friction * vehicle.cg_height / vehicle.wheelbase
    rolling = braked["front"] + braked["rear"]
    locked = []
    for axle in braked:
        left = 1 - moved * (1 if axle == leading else -1)
        held = friction * vehicle.arm(axle) / vehicle.wheelbase + braked[other(axle)]
        locked.append(np.where(left > 0, held / np.where(left > 0, left, 1.0), np.inf))
    sums = np.stack(np.broadcast_arrays(rolling, *locked, friction))
    least, pitching = sums.min(axis=0), vehicle.pitching_ratio(leading)
    first = np.argmax(sums <= least * (1 + _EDGE), axis=0)  # of equal ones, that with fewer wheels locked
    lifts = least >= pitching * (1 - _EDGE)
    status = np.where(lifts, _PITCHES, np.array(_STATES)[first])
    return np.minimum(least, pitching)[()], status[()]
