"""A truck that drives down a slope and stops with locked front wheels (Yoo et al. 1997, section 2).

Axes: x down the slope, y up from the ground; the origin is where the front wheels touch it. The front axle A
is locked; the rear axle B, at x = L, leads and rolls. The wheels have no mass. With the total mass M, the
centre of gravity at x = a and at the height h = y_cg + r1 above the ground, b = L - a, and the friction mu:

    N_A = M b g cos(beta) / (L + mu h),   R_A = mu N_A,
    acceleration = g sin(beta) - R_A / M,   torque of one brake = r1 R_A / 2.

Load transfer: the friction at the ground moves mu h N_A / L from the braked front axle to the leading rear
axle. Both axle loads stay positive for any friction as long as the centre of gravity is between the axles.
At rest gravity alone decides: the truck overturns past tan(beta) = b / h.

That is a truck that reverses, as the paper's does. One that drives forwards has its front axle downhill,
as if h had the other sign: N_A = M b g cos(beta) / (L - mu h); it overturns over that axle from mu = a / h.

The paper's equation (3) and its tables differ; `brakes.reproduce.forklift_as_printed` has them.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any, Literal

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, together
from beamdyn.common.inputs.checks import kind, one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.meanings import Meaning
from beamdyn.common.results.one_line import spanned
from beamdyn.common.results.result import Result
from brakes.forklift.levers import LEAST_MARGIN, ROUNDING

STANDARD_GRAVITY = 9.806  # [m/s2] the paper's
ACUTE: Any = {"above": -np.pi / 2, "below": np.pi / 2}  # [rad]


@dataclass(frozen=True)
class Truck:
    """A truck and its load; x from the front axle towards the rear, y up from the front wheels' centre.

    Every value may be an array, one entry per design.

    Parameters
    ----------
    empty_mass : float or ndarray
        Mass of the empty truck [kg].
    empty_cg : tuple
        Its centre of gravity (x, y) [m].
    load_mass : float or ndarray
        Mass of the load [kg], which may be 0.
    load_cg : tuple
        Its centre of gravity (x, y) [m]; a load on the fork has x < 0.
    front_wheel_radius : float or ndarray
        Radius r1 of the front wheels [m].
    wheelbase : float or ndarray
        Distance L of the axles [m].

    Raises
    ------
    ValueError
        If a mass or length is not positive, or the centre of gravity, of the truck alone or with its
        load, is not between the axles and above the ground.

    References
    ----------
    Yoo et al. (1997), section 2.

    Examples
    --------
    >>> truck = forklift.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> float(truck.mass)  # kg, with its load
    9450.0
    """

    empty_mass: Annotated[Numbers, Described("kg", "m", "mass of the empty truck", above=0)]
    empty_cg: tuple[
        Annotated[Numbers, Described("m", "x", "the empty truck's centre of gravity, behind the front axle")],
        Annotated[Numbers, Described("m", "y", "the empty truck's centre of gravity, above the front axle")],
    ]
    load_mass: Annotated[Numbers, Described("kg", "m_L", "mass of the load", least=0, default=0.0)]
    load_cg: tuple[
        Annotated[
            Numbers, Described("m", "x_L", "the load's centre, behind the front axle: negative", default=0.0)
        ],
        Annotated[Numbers, Described("m", "y_L", "the load's centre, above the front axle", default=0.0)],
    ]
    front_wheel_radius: Annotated[Numbers, Described("m", "r1", "radius of the front wheels", above=0)]
    wheelbase: Annotated[Numbers, Described("m", "L", "distance of the axles", above=0)]

    def __post_init__(self) -> None:
        keep_checked(self)
        (x, y), (xl, yl) = self.empty_cg, self.load_cg
        together(empty_mass=self.empty_mass, load_mass=self.load_mass, wheelbase=self.wheelbase,
                 front_wheel_radius=self.front_wheel_radius,
                 empty_x=x, empty_y=y, load_x=xl, load_y=yl)  # fmt: skip
        self._check("the empty truck's centre of gravity", *self.empty_cg, "check {other}")
        self._check("the centre of gravity with the load", *self.cg, "take less load, or nearer the axle")

    def _check(self, name: str, x: Numbers, y: Numbers, remedy: str) -> None:
        x, y, least = np.asarray(x), np.asarray(y), LEAST_MARGIN * np.asarray(self.wheelbase)
        ahead = "it is ahead of the front wheel: the truck tips over it"
        refuse(x <= least, f"x of {name}", x, "m", ahead, remedy, other="empty_cg")
        behind = "it is behind the rear wheel, at wheelbase = {limit}"
        late, length = x >= self.wheelbase - least, self.wheelbase
        refuse(late, f"x of {name}", x, "m", behind, remedy, limit=length, other="empty_cg")
        low = "it is below the ground (-front_wheel_radius)"
        refuse(y + self.front_wheel_radius <= least, f"y of {name}", y, "m", low, remedy, other="empty_cg")

    @property
    def mass(self) -> Numbers:
        """Mass with the load [kg]."""
        return self.empty_mass + self.load_mass

    @property
    def cg(self) -> tuple[Numbers, Numbers]:
        """Centre of gravity (x, y) with the load [m]."""
        m, ml = self.empty_mass, self.load_mass
        x, y = ((m * e + ml * w) / (m + ml) for e, w in zip(self.empty_cg, self.load_cg, strict=True))
        return x, y

    @property
    def sizes_of_coordinates(self) -> Numbers:
        """Sum of the lengths that make up the arms of weight and friction; it scales their rounding [m]."""
        m, ml = self.empty_mass, self.load_mass
        empty, load = (np.abs(x) + np.abs(y) for x, y in (self.empty_cg, self.load_cg))
        return (m * empty + ml * load) / (m + ml) + self.front_wheel_radius + self.wheelbase

    @property
    def overturning_slopes(self) -> tuple[Numbers, Numbers]:
        """Slopes between which the truck stands on both axles [rad]: over the front and the rear axle."""
        a, y = self.cg
        h = y + self.front_wheel_radius
        return -np.arctan2(a, h), np.arctan2(self.wheelbase - a, h)


@dataclass(frozen=True)
class SlopeAngle(Described):
    """Description of the angle of a slope, which files may give in %, too."""


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
        Which way the truck drives.

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> conditions = forklift.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
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
        together(**self.numbers)

    @property
    def numbers(self) -> dict[str, Numbers]:
        """The values that may be arrays, by name."""
        return {name: value for name, value in vars(self).items() if name != "direction"}

    @property
    def sense(self) -> int:
        """1 if the truck travels towards its rear axle, -1 towards the front axle."""
        return 1 if self.direction == "reverse" else -1


@dataclass(frozen=True)
class Stop(Result):
    """A stop, or why there is none; arrays have one entry per case.

    Attributes
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing.
    stops : ndarray of bool
        Whether the truck comes to rest.
    status : str or ndarray of str
        ``"stops"``, ``"stops in the rise time"``, ``"never stops"``, or ``"too near to decide"``: the slope
        is the steepest that the brakes hold, up to 1e-9 of its pull or rounding.
    acceleration : ndarray
        Down the slope with the full brake force, A [m/s2]; negative when the truck slows down.
    distance, time : ndarray
        From the driver's reaction to rest [m], [s]; inf if it never stops. ISO 6292 counts from the
        first actuation: subtract `reaction_distance`.
    reaction_distance, rise_distance, braking_distance : ndarray
        Parts of the distance [m]: before the brakes act, while their force rises, and at full force.
    speed_lost_in_rise : ndarray
        Speed lost while the brake force rises [m/s]; negative if gained.
    speed_gained_coasting : ndarray
        Speed that a freely rolling truck would gain in the reaction time [m/s]. The model holds the
        speed there (engine brake), so that the distance leaves it out.
    torque_per_brake : ndarray
        Torque of one of the two front brakes at full force [N m].
    front_load, rear_load : ndarray
        Normal forces of the axles while it slides [N].
    standing_front_load, standing_rear_load : ndarray
        Normal forces of the axles at rest on the slope [N].

    Examples
    --------
    >>> truck = forklift.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> steep = np.radians(27.0)
    >>> conditions = forklift.StopConditions(steep, 20 / 3.6, 0.7, reaction_time=0.5, rise_time=0.3)
    >>> bool(forklift.stop(truck, conditions).stops)  # on 27 deg it does not
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
        Numbers, Meaning("m/s", "speed a coasting truck would gain in reaction, not counted")
    ]
    torque_per_brake: Annotated[Numbers, Meaning("N m", "torque of one brake")]
    front_load: Annotated[Numbers, Meaning("N", "front axle's load, sliding", "kN")]
    rear_load: Annotated[Numbers, Meaning("N", "rear axle's load, sliding", "kN")]
    standing_front_load: Annotated[Numbers, Meaning("N", "front axle's load, at rest", "kN")]
    standing_rear_load: Annotated[Numbers, Meaning("N", "rear axle's load, at rest", "kN")]

    def headline(self) -> Iterator[str]:
        """The result in one line; see `Result.headline`."""
        yield f"{spanned(self.distance, 'm')} in {spanned(self.time, 's')}"
        yield f"torque of a brake {spanned(self.torque_per_brake, 'N m')}"
        yield self.message

    @property
    def residual(self) -> Numbers:
        """Residual moment of the axles' forces about the centre of gravity, over weight times wheelbase."""
        (a, y), truck, c = self.truck.cg, self.truck, self.conditions
        height, friction = y + truck.front_wheel_radius, c.sense * c.friction * self.front_load
        moment = (truck.wheelbase - a) * self.rear_load - a * self.front_load - height * friction
        return np.abs(moment) / ((self.front_load + self.rear_load) * truck.wheelbase)

    @property
    def error(self) -> Numbers:
        """Bound of the relative error of distance and time, and of the loads over the weight.

        The rounding of inputs and sums, over the margin to never stopping.
        """
        c = self.conditions
        pull = c.gravity * np.abs(np.sin(c.slope))
        slowing = np.where(self.stops, np.abs(self.acceleration), np.inf)
        return (_rounding(self.truck, c) * (3 + 2 * pull / slowing))[()]

    @property
    def message(self) -> str:
        """Meaning of the status, in one sentence; of many cases, how many do not stop."""
        if np.ndim(self.status):
            short = int(np.sum(~self.stops))
            return f"{short} of {np.size(self.stops)} cases do not stop" if short else "every case stops"
        return _SENTENCES[str(self.status)]

    def messages_of_cases(self, count: int) -> dict[int, str]:
        """The message of each case that does not stop, of as many cases, by its row."""
        each = np.broadcast_to(self.status, (count,)).tolist()
        return {i: _SENTENCES[status] for i, status in enumerate(each) if not status.startswith("stops")}


_EDGE = 1e-9  # deceleration, over the pull of the slope, that cannot be told from none

_SENTENCES = {
    "stops": "the truck stops",
    "stops in the rise time": "the truck stops while the brake force is still rising",
    "never stops": "the locked front wheels hold less than the slope pulls: the truck never stops; "
    "less slope, more friction, or another load",
    "too near to decide": "does not stop: the slope is too near the steepest that the locked front wheels "
    "hold to decide; less slope, more friction, or another load",
}


def stop(truck: Truck, conditions: StopConditions) -> Stop:
    """Compute the stop of a truck that drives down a slope.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing.

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
    >>> truck = forklift.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = forklift.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> round(float(forklift.stop(truck, conditions).distance), 2)  # m
    13.42
    """
    kind("truck", truck, Truck)
    kind("conditions", conditions, StopConditions)
    _refuse_overturning(truck, conditions)
    one_case = truck.cg[0] + truck.cg[1] + truck.front_wheel_radius + truck.wheelbase  # shape of its cases
    together(truck=one_case, **conditions.numbers)
    beta, V, mu, t1, t2, g, _ = np.broadcast_arrays(*conditions.numbers.values(), one_case)
    (a, y), L, M = truck.cg, truck.wheelbase, truck.mass
    h, b, gc, gs = (
        conditions.sense * (y + truck.front_wheel_radius),
        L - a,
        g * np.cos(beta),
        g * np.sin(beta),
    )
    front, standing = M * b * gc / (L + mu * h), M * (b * gc - h * gs) / L
    A = gs - mu * front / M
    # The deceleration rises linearly to -A within t2; for A >= 0 there is no end.
    v2 = V + A * t2 / 2
    in_rise = v2 <= LEAST_MARGIN * V
    slowing = np.where(A < 0, A, -1.0)  # what follows from the -1 is replaced below
    tau = np.sqrt(2 * V * t2 / -slowing)
    rise = np.where(in_rise, 2 / 3 * V * tau, V * t2 + A * t2**2 / 6)
    braking = np.where(in_rise, 0.0, -(v2**2) / (2 * slowing))
    time = t1 + np.where(in_rise, tau, t2 / 2 - V / slowing)
    undecided = np.maximum(_EDGE, 4 * _rounding(truck, conditions)) * g * np.abs(np.sin(beta))
    stops, near = -undecided > A, np.abs(A) <= undecided
    braking = np.where(stops, braking, np.inf)
    kinds = ["too near to decide", "never stops", "stops in the rise time"]
    status = np.select([near, ~stops, in_rise], kinds, default="stops")
    return Stop(
        truck=truck,
        conditions=conditions,
        stops=stops[()],
        status=status[()],
        acceleration=A[()],
        distance=(V * t1 + rise + braking)[()],
        time=np.where(stops, time, np.inf)[()],
        reaction_distance=(V * t1)[()],
        rise_distance=rise[()],
        braking_distance=braking[()],
        speed_lost_in_rise=np.where(in_rise, V, V - v2)[()],
        speed_gained_coasting=(gs * t1)[()],
        torque_per_brake=(truck.front_wheel_radius * mu * front / 2)[()],
        front_load=front[()],
        rear_load=(M * gc - front)[()],
        standing_front_load=standing[()],
        standing_rear_load=(M * gc - standing)[()],
    )


def _rounding(truck: Truck, conditions: StopConditions) -> Numbers:
    """Bound of the error of the deceleration, over what it is the difference of."""
    size = (1 + conditions.friction) * truck.sizes_of_coordinates / (truck.wheelbase - truck.cg[0])
    return ROUNDING * (4 + size)


def _refuse_overturning(truck: Truck, conditions: StopConditions) -> None:
    slope, sense = conditions.slope, conditions.sense
    front, rear = truck.overturning_slopes
    together(slope=slope, truck=front)
    remedy = "less slope, or a lower centre of gravity"
    tilt = sense * np.asarray(slope)
    for axle, limit, bad in (
        ("rear", rear, tilt >= rear - LEAST_MARGIN),
        ("front", front, tilt <= front + LEAST_MARGIN),
    ):
        bound = f"the truck overturns on it at rest, over the {axle} axle, past {{limit}}"
        refuse(bad, "slope", slope, "rad", bound, remedy, limit=sense * limit)
    (a, y), mu = truck.cg, np.asarray(conditions.friction)
    least = mu * (y + truck.front_wheel_radius) + LEAST_MARGIN * truck.wheelbase
    bad, limit = (sense < 0) & (a <= least), a / (y + truck.front_wheel_radius)
    bound = "braking overturns the truck over the front axle from {limit} on"
    refuse(bad, "friction", mu, "", bound, "less load, or nearer the axle and lower", limit=limit)
