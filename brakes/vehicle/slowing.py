"""A vehicle that brakes both axles on a slope: with rolling or locked wheels, or at the limit of pitching.

The brakes give the force B at all wheels, the fraction phi of it in front. The force of an axle is the
smaller of its part of B and of mu times its load, which depends on the braking ratio tau: with W = M g
cos(beta), and the loads of the front and rear axle n_f and n_r, as fractions of W,

    tau = min(phi B / W, mu n_f(tau)) + min((1 - phi) B / W, mu n_r(tau)).

Each minimum is of functions that are linear in tau, so that the right side is concave, and it is positive at
tau = 0: it equals tau at one value only. With one of the two functions for each axle there are four sums, and
each sum equals tau at some value; the solution is the least of these four values. The driver eases off where
the vehicle would pitch over. All this holds uphill and downhill: weight and inertia act at
the centre of gravity. `brakes.vehicle.rise` has the motion to rest. Until the brakes act the vehicle coasts:
it gets faster downhill and slower uphill in the driver's reaction time.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, numbers, positive, together
from beamdyn.common.inputs.checks import kind, one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.common.limits import EDGE
from brakes.vehicle.axles import Axle, Vehicle, other
from brakes.vehicle.holding import Road
from brakes.vehicle.rise import coast, to_rest

_STATES = ("no wheel locks", "front wheels locked", "rear wheels locked", "all wheels locked")
_PITCHES = "at the limit of pitching over"


@dataclass(frozen=True)
class Approach:
    """Speed, timing and braking force of a vehicle before its stop; values may be arrays, one per design.

    Parameters
    ----------
    speed : float or ndarray
        Speed V before the stop [m/s].
    reaction_time : float or ndarray
        Time t1 until the brakes act, in which the vehicle coasts [s].
    rise_time : float or ndarray
        Time t2 in which the braking force rises linearly [s].
    brake_force : float or ndarray, optional
        Force B along the ground that the brakes of all wheels can give [N]; in a file, by default that of the
        lever or, without one, the largest at which no wheel locks.
    heading : {"downhill", "uphill"}
        Direction of travel on the slope.

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
        Numbers, Described("s", "t1", "time before the brakes act, in which the vehicle coasts", least=0)
    ] = 0.0
    rise_time: Annotated[Numbers, Described("s", "t2", "time in which the brake force rises", least=0)] = 0.0
    brake_force: Annotated[
        Numbers | None,
        Described(
            "N",
            "B",
            "force along the ground of all brakes; if not given, that of the lever or, without one, the "
            "largest at which no wheel locks",
            above=0,
        ),
    ] = None
    heading: Annotated[Literal["downhill", "uphill"], Described(meaning="which way it goes on the slope")] = (
        "downhill"
    )

    def __post_init__(self) -> None:
        one_of("heading", self.heading, ("downhill", "uphill"))
        keep_checked(self)


@dataclass(frozen=True)
class Slowing(Result):
    """A stop on a slope with both axles braked; arrays have one entry per case.

    Attributes
    ----------
    vehicle, road, approach : Vehicle, Road, Approach
        The vehicle, the road, and speed and timing of the stop.
    leading : {"front", "rear"}
        The axle at the front of the motion.
    status : str or ndarray of str
        ``"no wheel locks"``, ``"front wheels locked"``, ``"rear wheels locked"``, ``"all wheels locked"``, or
        ``"at the limit of pitching over"``.
    stops : ndarray of bool
        Whether the vehicle comes to rest.
    ratio : ndarray
        Braking ratio at full force.
    front_force, rear_force, front_load, rear_load : ndarray
        Braking forces and loads of the axles at full force [N].
    deceleration : ndarray
        Deceleration at full force [m/s2]; negative where the vehicle gets faster.
    distance, time : ndarray
        Distance [m] and time [s] from the driver's reaction to rest; inf if it never stops.

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
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{spanned(self.distance, 'm')} in {spanned(self.time, 's')}"
        yield f"{self.status}" if np.ndim(self.status) == 0 else ""
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warning if the vehicle comes to rest uphill before the brakes act; empty otherwise."""
        a = self.approach
        since = np.asarray(self.time - a.reaction_time)
        with np.errstate(divide="ignore", invalid="ignore"):  # the rise time may be 0
            risen = np.where(since < a.rise_time, np.maximum(since, 0.0) / a.rise_time, since >= 0)
        held = self.ratio * np.cos(self.road.slope) * risen
        rolls = (a.heading == "uphill") & (held < np.sin(self.road.slope) * (1 - EDGE))
        many = f", in {np.sum(rolls)} of {rolls.size} cases" if rolls.ndim else ""
        said = "the vehicle stops before its brakes hold it, and rolls back until they do (not counted)"
        return (f"{said}{many}",) if np.any(rolls) else ()

    @property
    def message(self) -> str:
        """One sentence that says whether the vehicle stops; of many cases, how many do not."""
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
    """Compute the stop of a vehicle on a slope with both axles braked.

    Parameters
    ----------
    vehicle, road, approach : Vehicle, Road, Approach
        The vehicle, the road, and speed and timing of the stop; `approach.brake_force` is not used.
    brake_force : float or ndarray
        Force along the ground that all brakes can give [N].
    front_share : float or ndarray
        Fraction of this force at the front wheels, 0 to 1.
    leading : {"front", "rear"}
        The axle at the front of the motion: the lower one downhill, the upper one uphill.

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
    Standard: moments about the points where the tyres stand, and motion under constant forces; see the
    docstring of the module.

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
    eased = ratio / sum(forces.values())  # below 1 only where the driver eases off to avoid pitching over
    pull = road.gravity * np.sin(road.slope) * (1 if approach.heading == "downhill" else -1)
    rate = road.gravity * np.cos(road.slope) * ratio
    stops = rate - pull > EDGE * rate
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
    """Compute the braking ratio, and the status of the wheels that limits it."""
    moved = friction * vehicle.cg_height / vehicle.wheelbase
    rolling = braked["front"] + braked["rear"]
    locked = []
    for axle in braked:
        left = 1 - moved * (1 if axle == leading else -1)
        held = friction * vehicle.arm(axle) / vehicle.wheelbase + braked[other(axle)]
        locked.append(np.where(left > 0, held / np.where(left > 0, left, 1.0), np.inf))
    sums = np.stack(np.broadcast_arrays(rolling, *locked, friction))
    least, pitching = sums.min(axis=0), vehicle.pitching_ratio(leading)
    # Of states with the same braking ratio within rounding, the one with the fewest locked wheels is chosen.
    first = np.argmax(sums <= least * (1 + EDGE), axis=0)
    lifts = least >= pitching * (1 - EDGE)
    status = np.where(lifts, _PITCHES, np.array(_STATES)[first])
    return np.minimum(least, pitching)[()], status[()]
