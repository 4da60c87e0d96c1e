"""A truck that drives down a slope and brakes its front wheels (Yoo et al. 1997, section 2).

Axes: x down the slope, at the angle beta to the horizontal, y up from the ground; the origin is where the
front wheels, of the radius r1, touch it. The front axle A is locked; the rear axle B, at x = L, leads and
rolls. The wheels have no mass. With the total mass M, the centre of gravity at x = a, y_cg above the front
axle and so at the height h = y_cg + r1 above the ground, b = L - a, and the friction mu:

    load of the front axle N_A = M b g cos(beta) / (L + mu h),   its braking force R_A = mu N_A,
    acceleration = g sin(beta) - R_A / M,   torque of one brake = r1 R_A / 2.

Brakes whose torque T is less than that let the wheels roll, with R_A = 2 T / r1 in place of mu N_A, and
N_A = (M b g cos(beta) - h R_A) / L.

Load transfer: the friction at the ground moves mu h N_A / L from the braked front axle to the leading rear
axle. Both axle loads stay positive for any friction as long as the centre of gravity is between the axles.
At rest gravity alone decides: the truck overturns past tan(beta) = b / h.

These formulas are for a truck that reverses, as the paper's does. If it drives forwards, its front axle is
downhill and h changes its sign: N_A = M b g cos(beta) / (L - mu h); it overturns over that axle from mu = a /
h.

The paper's equation (3) and tables differ from this; `brakes.reproduce.forklift_as_printed` has them.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, positive, together
from beamdyn.common.inputs.checks import kind, one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned
from beamdyn.common.results.result import Result
from brakes.common.limits import EDGE
from brakes.common.locking import LEAST_MARGIN
from brakes.vehicle.axles import ACUTE, ROUNDING, Truck
from brakes.vehicle.rise import to_rest

STANDARD_GRAVITY = 9.806  # acceleration of gravity in Yoo et al. (1997) [m/s2]
STEEPEST = np.pi / 4  # steepest slope that a road can have [rad]


@dataclass(frozen=True)
class SlopeAngle(Described):
    """Description of the angle of a slope, which a file may also give in %."""


@dataclass(frozen=True)
class StopConditions:
    """Road, speed and timing of a stop; every value may be an array, one entry per case.

    Parameters
    ----------
    slope : float or ndarray
        Angle beta of the ground [rad], positive downhill in the direction of travel.
    speed : float or ndarray
        Speed V before the stop [m/s].
    friction : float or ndarray
        Friction mu of the sliding front wheels on the ground.
    reaction_time : float or ndarray
        Time t1 until the brakes act [s].
    rise_time : float or ndarray
        Time t2 in which the brake force rises linearly [s].
    gravity : float or ndarray
        Gravity g [m/s2].
    direction : {"reverse", "forward"}
        Direction of travel.

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> round(conditions.speed, 3)  # m/s
    5.556
    """

    slope: Annotated[Numbers, SlopeAngle("rad", "beta", "slope, downhill as it travels", **ACUTE)]
    speed: Annotated[Numbers, Described("m/s", "V", "speed before the stop", above=0)]
    friction: Annotated[
        Numbers, Described("", "mu", "friction of tyres on the ground", above=0, most=2, remedy="70 % is 0.7")
    ]
    reaction_time: Annotated[Numbers, Described("s", "t1", "time before the brakes act", least=0)]
    rise_time: Annotated[Numbers, Described("s", "t2", "time in which the brake force rises", least=0)]
    gravity: Annotated[Numbers, Described("m/s2", "g", "gravity", above=0)] = STANDARD_GRAVITY
    direction: Annotated[Literal["reverse", "forward"], Described(meaning="which way it drives")] = "reverse"

    def __post_init__(self) -> None:
        one_of("direction", self.direction, ("reverse", "forward"))
        keep_checked(self)

    @property
    def numbers(self) -> dict[str, Numbers]:
        """The inputs that may be arrays, by name; all but the direction."""
        return {name: value for name, value in vars(self).items() if name != "direction"}

    @property
    def sense(self) -> int:
        """1 if the truck travels towards its rear axle, -1 towards the front axle."""
        return 1 if self.direction == "reverse" else -1


@dataclass(frozen=True)
class Stop(Result):
    """A truck's stop, or why it does not stop; arrays have one entry per case.

    Attributes
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing.
    stops : ndarray of bool
        Whether the truck comes to rest.
    status : str or ndarray of str
        ``"stops"``, ``"stops in the rise time"``, ``"never stops"``, ``"brakes too weak"``, or ``"too near to
        decide"``: the slope is within 1e-9 of the steepest on which the brakes hold, or within rounding.
    acceleration : ndarray
        Acceleration A down the slope at full brake force [m/s2]; negative when the truck slows down.
    distance, time : ndarray
        Distance [m] and time [s] from the driver's reaction to rest; inf if it never stops. ISO 6292 counts
        from the first actuation: subtract `reaction_distance`.
    reaction_distance, rise_distance, braking_distance : ndarray
        Parts of the distance [m]: before the brakes act, while the brake force rises, and at full force.
    speed_lost_in_rise : ndarray
        Speed lost while the brake force rises [m/s]; negative if the truck gains speed.
    speed_gained_coasting : ndarray
        Speed that a freely rolling truck would gain in the reaction time [m/s]. The model holds the
        speed constant then (engine brake), so that the distance does not contain this gain.
    torque_per_brake : ndarray
        Torque of one of the two front brakes at full force [N m].
    front_load, rear_load : ndarray
        Normal forces of the axles during braking at full force [N].
    standing_front_load, standing_rear_load : ndarray
        Normal forces of the axles at rest on the slope [N].

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> steep = np.radians(27.0)
    >>> conditions = vehicle.StopConditions(steep, 20 / 3.6, 0.7, reaction_time=0.5, rise_time=0.3)
    >>> bool(vehicle.stop(truck, conditions).stops)  # not on a slope of 27 deg
    False
    """

    truck: Truck
    conditions: StopConditions
    stops: Any
    status: Any
    acceleration: Annotated[Numbers, Meaning("m/s2", "acceleration, wheels locked")]
    distance: Annotated[Numbers, Meaning("m", "stopping distance, from the driver's reaction")]
    time: Annotated[Numbers, Meaning("s", "time to rest")]
    reaction_distance: Annotated[Numbers, Meaning("m", "distance in the reaction time")]
    rise_distance: Annotated[Numbers, Meaning("m", "distance while the force rises")]
    braking_distance: Annotated[Numbers, Meaning("m", "distance with the full force")]
    speed_lost_in_rise: Annotated[Numbers, Meaning("m/s", "speed lost while the force rises")]
    speed_gained_coasting: Annotated[
        Numbers, Meaning("m/s", "speed a coasting truck would gain in reaction time, not counted")
    ]
    torque_per_brake: Annotated[Numbers, Meaning("N m", "torque of one brake")]
    front_load: Annotated[Numbers, Meaning("N", "front axle's load, sliding", "kN")]
    rear_load: Annotated[Numbers, Meaning("N", "rear axle's load, sliding", "kN")]
    standing_front_load: Annotated[Numbers, Meaning("N", "front axle's load, at rest", "kN")]
    standing_rear_load: Annotated[Numbers, Meaning("N", "rear axle's load, at rest", "kN")]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{spanned(self.distance, 'm')} in {spanned(self.time, 's')}"
        yield f"torque of a brake {spanned(self.torque_per_brake, 'N m')}"
        yield self.message

    @property
    def brake_force(self) -> Numbers:
        """Force of the braked front wheels along the ground at full force [N]."""
        return 2 * self.torque_per_brake / self.truck.front_wheel_radius

    @property
    def locking_torque(self) -> Numbers:
        """Torque of one brake at which its wheel locks [N m]; inf where the truck would overturn before."""
        c, truck = self.conditions, self.truck
        torque = truck.front_wheel_radius * c.friction * _load_that_locks(truck, c) / 2
        return np.where(_pitches_over(truck, c), np.inf, torque)[()]

    @property
    def limited_by(self) -> Any:
        """What limits the braking force: "road" where the front wheels lock, else "brake"."""
        held = self.conditions.friction * self.front_load
        return np.where(self.brake_force >= held * (1 - LEAST_MARGIN), "road", "brake")[()]

    @property
    def pulled_distance(self) -> Numbers:
        """Stopping distance [m] if the slope also pulls while the force rises; see `brakes.vehicle.rise`."""
        c = self.conditions
        pull = c.gravity * np.sin(c.slope)
        way, _ = to_rest(c.speed, pull, pull - self.acceleration, c.rise_time, self.stops)
        return (self.reaction_distance + way)[()]

    @property
    def residual(self) -> Numbers:
        """Residual moment of the axle forces about the centre of gravity, divided by weight and wheelbase."""
        (a, y), truck, c = self.truck.cg, self.truck, self.conditions
        height, friction = y + truck.front_wheel_radius, c.sense * self.brake_force
        moment = (truck.wheelbase - a) * self.rear_load - a * self.front_load - height * friction
        return np.abs(moment) / ((self.front_load + self.rear_load) * truck.wheelbase)

    @property
    def error(self) -> Numbers:
        """Bound of the relative error of distance and time, and of the axle loads relative to the weight.

        It is the rounding of inputs and sums, amplified near the slope on which the truck never stops.
        """
        c = self.conditions
        pull = c.gravity * np.abs(np.sin(c.slope))
        slowing = np.where(self.stops, np.abs(self.acceleration), np.inf)
        return (_rounding(self.truck, c) * (3 + 2 * pull / slowing))[()]

    @property
    def message(self) -> str:
        """One sentence that explains the status; of many cases, how many do not stop."""
        if np.ndim(self.status):
            short = int(np.sum(~self.stops))
            return f"{short} of {np.size(self.stops)} cases do not stop" if short else "every case stops"
        return _SENTENCES[str(self.status)]

    def messages_of_cases(self, count: int) -> dict[int, str]:
        """Return the message of each case that does not stop, by its index.

        `count` is the number of all cases.
        """
        each = np.broadcast_to(self.status, (count,)).tolist()
        return {i: _SENTENCES[status] for i, status in enumerate(each) if not status.startswith("stops")}


_KINDS = ["too near to decide", "brakes too weak", "never stops", "stops in the rise time"]
_SENTENCES = {
    "stops": "the truck stops",
    "stops in the rise time": "the truck stops while the brake force is still rising",
    "never stops": "the locked front wheels hold less than the slope pulls: the truck never stops; "
    "take less slope, more friction, or another load",
    "brakes too weak": "the brakes hold less than the slope pulls, though the road would hold more: the "
    "truck never stops; press harder, or take stronger brakes",
    "too near to decide": "does not stop: the slope is too near the steepest on which locked front wheels "
    "hold the truck; take less slope, more friction, or another load",
}


def stop(truck: Truck, conditions: StopConditions, most_torque: Numbers | None = None) -> Stop:
    """Compute the stop of a truck that drives down a slope.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing.
    most_torque : float or ndarray, optional
        Torque that each front brake can give [N m]; if not given, the torque that locks its wheel. The driver
        presses no harder than needed: the force rises to the smaller of what brake and road allow.

    Returns
    -------
    Stop
        Complete result, arrays broadcast over all inputs. A truck that does not stop is a status, not an
        error.

    Raises
    ------
    ValueError
        If the truck would overturn, at rest or forwards by braking, or the shapes do not broadcast.

    References
    ----------
    Yoo et al. (1997), section 2, corrected as the validation manual lists.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> round(float(vehicle.stop(truck, conditions).distance), 2)  # m
    13.42
    """
    kind("truck", truck, Truck)
    kind("conditions", conditions, StopConditions)
    brakes = np.inf if most_torque is None else positive("most_torque", most_torque, "N m")
    strongest = 2 * brakes / truck.front_wheel_radius
    _refuse_overturning(truck, conditions, strongest)
    beta, V, mu, t1, t2, g = _broadcast(truck, conditions, strongest)
    (a, y), L, M = truck.cg, truck.wheelbase, truck.mass
    h, b = conditions.sense * (y + truck.front_wheel_radius), L - a
    gc, gs = g * np.cos(beta), g * np.sin(beta)
    locked, standing = _load_that_locks(truck, conditions), M * (b * gc - h * gs) / L
    locking = truck.front_wheel_radius * mu * locked / 2
    rolls = brakes < locking
    R = np.where(rolls, strongest, mu * locked)
    front = np.where(rolls, (M * b * gc - R * h) / L, locked)
    A = gs - R / M
    undecided = np.maximum(EDGE, 4 * _rounding(truck, conditions)) * g * np.abs(np.sin(beta))
    stops, near = -undecided > A, np.abs(A) <= undecided
    in_rise, lost, rise, braking, time = _slow_down(V, A, t2, stops)
    weak = ~stops & rolls & (gs < mu * locked / M * (1 - EDGE))
    return Stop(
        truck=truck,
        conditions=conditions,
        stops=stops[()],
        status=np.select([near, weak, ~stops, in_rise], _KINDS, default="stops")[()],
        acceleration=A[()],
        distance=(V * t1 + rise + braking)[()],
        time=(t1 + time)[()],
        reaction_distance=(V * t1)[()],
        rise_distance=rise[()],
        braking_distance=braking[()],
        speed_lost_in_rise=lost[()],
        speed_gained_coasting=(gs * t1)[()],
        torque_per_brake=np.where(rolls, brakes, locking)[()],
        front_load=front[()],
        rear_load=(M * gc - front)[()],
        standing_front_load=standing[()],
        standing_rear_load=(M * gc - standing)[()],
    )


def _load_that_locks(truck: Truck, c: StopConditions) -> np.ndarray:
    """Compute the front axle's load at which its wheels lock [N]; inf if they never lock."""
    (a, y), L = truck.cg, truck.wheelbase
    left = L + c.friction * c.sense * (y + truck.front_wheel_radius)
    pressed = truck.mass * (L - a) * c.gravity * np.cos(c.slope)
    return np.where(left > 0, pressed / np.where(left > 0, left, 1.0), np.inf)


def _pitches_over(truck: Truck, c: StopConditions) -> Any:
    """Return whether braking overturns the truck, over its front axle, before the front wheels lock."""
    (a, y), least = truck.cg, LEAST_MARGIN * np.asarray(truck.wheelbase)
    return (c.sense < 0) & (a <= c.friction * (y + truck.front_wheel_radius) + least)


def _broadcast(truck: Truck, conditions: StopConditions, strongest: Numbers) -> Sequence[np.ndarray]:
    """Broadcast the arrays of conditions, truck and brakes to one shape."""
    # This sum has the shape of the truck's numbers; its value is not used.
    one_case = truck.cg[0] + truck.cg[1] + truck.front_wheel_radius + truck.wheelbase
    together(truck=one_case, most_torque=strongest, **conditions.numbers)
    return np.broadcast_arrays(*conditions.numbers.values(), one_case, strongest)[:-2]


def _slow_down(V: np.ndarray, A: np.ndarray, t2: np.ndarray, stops: np.ndarray) -> tuple[np.ndarray, ...]:
    """Compute a stop from the speed V [m/s]: the acceleration changes linearly from 0 to A [m/s2] in t2 [s].

    Returns
    -------
    tuple of ndarray
        Whether it comes to rest in the rise time; speed lost [m/s] and distance [m] in the rise; distance
        after it [m] and time from the beginning of braking to rest [s], both inf where it does not stop.
    """
    v2 = V + A * t2 / 2
    in_rise = v2 <= LEAST_MARGIN * V
    slowing = np.where(A < 0, A, -1.0)  # -1 avoids a division by zero; such results are replaced below
    tau = np.sqrt(2 * V * t2 / -slowing)
    rise = np.where(in_rise, 2 / 3 * V * tau, V * t2 + A * t2**2 / 6)
    braking = np.where(in_rise, 0.0, -(v2**2) / (2 * slowing))
    time = np.where(in_rise, tau, t2 / 2 - V / slowing)
    ways = rise, np.where(stops, braking, np.inf), np.where(stops, time, np.inf)
    return in_rise, np.where(in_rise, V, V - v2), *ways


def _rounding(truck: Truck, conditions: StopConditions) -> Numbers:
    """Compute a bound of the deceleration's rounding error, relative to its terms (friction and slope)."""
    size = (1 + conditions.friction) * truck.sizes_of_coordinates / (truck.wheelbase - truck.cg[0])
    return ROUNDING * (4 + size)


def _refuse_overturning(truck: Truck, conditions: StopConditions, strongest: Numbers) -> None:
    slope, sense = conditions.slope, conditions.sense
    front, rear = truck.overturning_slopes
    together(slope=slope, truck=front)
    remedy = "give less slope, or a lower centre of gravity"
    tilt = sense * np.asarray(slope)
    for axle, limit, bad in (
        ("rear", rear, tilt >= rear - LEAST_MARGIN),
        ("front", front, tilt <= front + LEAST_MARGIN),
    ):
        bound = f"the truck overturns on it at rest, over the {axle} axle, past {{limit}}"
        refuse(bad, "slope", slope, "rad", bound, remedy, limit=sense * limit)
    a, y = truck.cg
    limit = a / (y + truck.front_wheel_radius)
    pressed = strongest * (1 + EDGE) >= truck.mass * conditions.gravity * np.cos(conditions.slope) * limit
    bad = _pitches_over(truck, conditions) & pressed
    bound = "braking overturns the truck over the front axle from {limit} on"
    remedy = "give less load, nearer the axle or lower"
    remedy += "" if np.isinf(strongest).all() else ", or press less"
    refuse(bad, "friction", conditions.friction, "", bound, remedy, limit=limit)
