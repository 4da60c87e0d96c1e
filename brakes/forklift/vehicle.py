"""A truck that reverses down a slope and stops with locked front wheels (Yoo et al. 1997, section 2).

Axes: x down the slope, y up from the ground. The loaded front axle A is at x = 0 and locked, the rear
axle B leads at x = L and rolls; the wheels have no mass. With M = m + mL, a = x_cg, b = L - a,
gc = g cos(beta), gs = g sin(beta) and e = L + mu h:

    N_A = M b gc / e,   R_A = mu N_A,   acceleration = gs - R_A / M,   torque of one brake = r1 R_A / 2.

In the corrected model h = y_cg + r1 is the height of the centre of gravity above the ground: the brake
torque r1 R_A turns the body as well, which (3) leaves out. As printed, h = y_cg - r1: the axle's height is
subtracted from a height that the data count from the axle, and the torque comes out about 30 % high:
safe for strength, unsafe for the distance.

Errata: (6) has theta' for theta''. (18) is g_c. (19) and (22) ignore the speed lost while the brake
force rises. (25) has m_B b for m_A b. The text before (21): from 0 to A. (26) is for the axle, Tables 4
and 5 for one brake.

Which axle unloads: the friction at the ground turns the truck onto its leading, rear axle, which gains
mu h N_A / L; the braked front axle loses it. As its friction falls with its load, N_A stays positive for
any friction, and no axle lifts while the truck slides, as long as the centre of gravity is between the
axles. At rest gravity alone decides: the truck overturns past tan(beta) = b / h.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Literal, NamedTuple

import numpy as np

from beamdyn.common.array_checks import Numbers, not_negative, numbers, pair, positive, together
from beamdyn.common.checks import one_of, refuse
from beamdyn.common.results import Result

STANDARD_GRAVITY = 9.806  # [m/s2] the paper's


@dataclass(frozen=True)
class Truck:
    """A truck and its load; x from the front axle towards the rear, y up from the front wheels' centre.

    Every value may be an array, one value a design.

    Parameters
    ----------
    empty_mass, load_mass : float or ndarray
        Mass of the empty truck and of the load [kg]; the load may be 0.
    empty_cg, load_cg : tuple
        Their centres of gravity (x, y) [m]; a load on the fork has x < 0.
    front_wheel_radius : float or ndarray
        Radius r1 of the front wheels [m].
    wheelbase : float or ndarray
        Distance L of the axles [m].

    Raises
    ------
    ValueError
        If a mass or length is not positive, or the centre of gravity, of the truck alone or with its
        load, is not between the axles and above the ground.
    """

    empty_mass: Numbers
    empty_cg: tuple[Numbers, Numbers]
    load_mass: Numbers
    load_cg: tuple[Numbers, Numbers]
    front_wheel_radius: Numbers
    wheelbase: Numbers

    def __post_init__(self) -> None:
        cleaned = {
            "empty_mass": positive("empty_mass", self.empty_mass, "kg"),
            "empty_cg": pair("empty_cg", self.empty_cg, "m"),
            "load_mass": not_negative("load_mass", self.load_mass, "kg"),
            "load_cg": pair("load_cg", self.load_cg, "m"),
            "front_wheel_radius": positive("front_wheel_radius", self.front_wheel_radius, "m"),
            "wheelbase": positive("wheelbase", self.wheelbase, "m"),
        }
        for name, value in cleaned.items():
            object.__setattr__(self, name, value)
        (x, y), (xl, yl) = self.empty_cg, self.load_cg
        together(empty_mass=self.empty_mass, load_mass=self.load_mass, wheelbase=self.wheelbase,
                 front_wheel_radius=self.front_wheel_radius,
                 empty_x=x, empty_y=y, load_x=xl, load_y=yl)  # fmt: skip
        self._check("the empty truck's centre of gravity", *self.empty_cg, "check {other}")
        self._check("the centre of gravity with the load", *self.cg, "take less load, or nearer the axle")

    def _check(self, name: str, x: Numbers, y: Numbers, remedy: str) -> None:
        x, y = np.asarray(x), np.asarray(y)
        ahead = "it is ahead of the front wheel: the truck tips over it"
        refuse(x <= 0, f"x of {name}", x, "m", ahead, remedy, other="empty_cg")
        behind = "it is behind the rear wheel, at wheelbase = {limit}"
        refuse(
            x >= self.wheelbase,
            f"x of {name}",
            x,
            "m",
            behind,
            remedy,
            limit=self.wheelbase,
            other="empty_cg",
        )
        low = "it is below the ground (-front_wheel_radius)"
        refuse(y + self.front_wheel_radius <= 0, f"y of {name}", y, "m", low, remedy, other="empty_cg")

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
    def overturning_slopes(self) -> tuple[Numbers, Numbers]:
        """Slopes between which the truck stands on both axles [rad]: over the front and the rear axle."""
        a, y = self.cg
        h = y + self.front_wheel_radius
        return -np.arctan2(a, h), np.arctan2(self.wheelbase - a, h)


@dataclass(frozen=True)
class Stop(Result):
    """A stop, or why there is none; arrays have one value a case.

    Attributes
    ----------
    stops : ndarray of bool
        Whether the truck comes to rest.
    status : str or ndarray of str
        ``"stops"``, ``"stops in the rise time"``, ``"never stops"``, ``"front wheel lifts"`` or
        ``"rear wheel lifts"``.
    acceleration : ndarray
        Down the slope with the full brake force, A [m/s2]; negative when the truck slows down.
    distance, time : ndarray
        From the driver's reaction to rest [m], [s]; inf if it never stops. ISO 6292 counts from the
        first actuation: subtract `reaction_distance`.
    reaction_distance, rise_distance, braking_distance : ndarray
        Parts of the distance [m].
    speed_lost_in_rise : ndarray
        Speed lost while the force rises [m/s], which (19) and (22) ignore; negative if gained.
    speed_gained_coasting : ndarray
        Speed that a freely rolling truck would gain in the reaction time [m/s]; the model holds the
        speed there (engine brake), so that it is not in the distance.
    torque_per_brake : ndarray
        Torque of one of the two front brakes at full force [N m].
    front_load, rear_load : ndarray
        Normal forces of the axles while it slides [N].
    standing_front_load, standing_rear_load : ndarray
        The same at rest on the slope [N].
    """

    truck: Truck
    model: str
    distance_formula: str
    slope: Numbers
    speed: Numbers
    friction: Numbers
    stops: Any
    status: Any
    acceleration: Numbers
    distance: Numbers
    time: Numbers
    reaction_distance: Numbers
    rise_distance: Numbers
    braking_distance: Numbers
    speed_lost_in_rise: Numbers
    speed_gained_coasting: Numbers
    torque_per_brake: Numbers
    front_load: Numbers
    rear_load: Numbers
    standing_front_load: Numbers
    standing_rear_load: Numbers

    @property
    def message(self) -> str:
        """What the status means, in one sentence; of many cases, how many do not stop."""
        if np.ndim(self.status):
            short = int(np.sum(~self.stops))
            return f"{short} of {np.size(self.stops)} cases do not stop" if short else "every case stops"
        return _SENTENCES[str(self.status)]


_SENTENCES = {
    "stops": "the truck stops",
    "stops in the rise time": "the truck stops while the brake force is still rising",
    "never stops": "the locked front wheels hold less than the slope pulls: the truck never stops; "
    "less slope, more friction, or another load",
    "front wheel lifts": "the front wheels lift: nothing brakes, and the truck turns over the rear axle",
    "rear wheel lifts": "the rear wheels lift: the truck turns over the front axle",
}


def stop(
    truck: Truck,
    *,
    slope: Numbers,
    speed: Numbers,
    friction: Numbers,
    reaction_time: Numbers,
    rise_time: Numbers,
    model: Literal["corrected", "as_printed"] = "corrected",
    distance: Literal["exact", "printed"] = "exact",
    factor: Numbers = 1.0,
    g: float = STANDARD_GRAVITY,
) -> Stop:
    """Stop of a truck that reverses down a slope.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    slope : float or ndarray
        Angle beta of the ground [rad], positive downhill in the direction of travel.
    speed : float or ndarray
        Speed V before [m/s].
    friction : float or ndarray
        Friction mu of the sliding front wheels on the ground.
    reaction_time, rise_time : float or ndarray
        Times t1 without brake force, and t2 in which it rises linearly [s].
    model : {"corrected", "as_printed"}
        Whether the brake torque turns the body as well, or the paper's equation (3).
    distance : {"exact", "printed"}
        With the speed lost in the rise time, or the paper's (19)-(24).
    factor : float or ndarray
        On the slope's pull in the acceleration only: 0.97 reproduces the paper's tables, for a reason
        that is not known.
    g : float
        Gravity [m/s2].

    Returns
    -------
    Stop
        Complete result; a truck that does not stop is a status, not an error.

    Raises
    ------
    ValueError
        If a value is out of bounds, or the truck would overturn at rest on the slope.
    """
    one_of("model", model, ("corrected", "as_printed"))
    one_of("distance", distance, ("exact", "printed"))
    V, mu = positive("speed", speed, "m/s"), positive("friction", friction)
    t1, t2 = not_negative("reaction_time", reaction_time, "s"), not_negative("rise_time", rise_time, "s")
    beta, k, g = _checked_slope(truck, slope), positive("factor", factor), positive("g", g, "m/s2")
    together(
        truck=_one_case(truck), slope=beta, speed=V, friction=mu, reaction_time=t1, rise_time=t2, factor=k
    )
    shape = np.broadcast_shapes(*(np.shape(x) for x in (_one_case(truck), beta, V, mu, t1, t2, k)))
    V, mu, t1, t2, beta = (np.broadcast_to(x, shape) for x in (V, mu, t1, t2, beta))
    slide = _slide(truck, beta, mu, model, k, g)
    parts = (_exact if distance == "exact" else _printed)(V, slide.A, t1, t2)
    status = np.select([slide.N_A <= 0, slide.N_B <= 0, slide.A >= 0, parts.early], _STATES, default="stops")
    stops = np.isin(status, ("stops", "stops in the rise time"))
    s3 = np.where(stops, parts.rest, np.inf)
    return Stop(
        truck=truck,
        model=model,
        distance_formula=distance,
        slope=beta[()],
        speed=V[()],
        friction=mu[()],
        stops=stops[()],
        status=status[()],
        acceleration=slide.A[()],
        distance=(V * t1 + parts.rise + s3)[()],
        time=np.where(stops, parts.time, np.inf)[()],
        reaction_distance=(V * t1)[()],
        rise_distance=parts.rise[()],
        braking_distance=s3[()],
        speed_lost_in_rise=parts.lost[()],
        speed_gained_coasting=(g * np.sin(beta) * t1)[()],
        torque_per_brake=(truck.front_wheel_radius * mu * slide.N_A / 2)[()],
        front_load=slide.N_A[()],
        rear_load=slide.N_B[()],
        standing_front_load=slide.standing_A[()],
        standing_rear_load=slide.standing_B[()],
    )


def _one_case(truck: Truck) -> Numbers:
    """Anything of the shape of the truck's cases."""
    return truck.cg[0] + truck.cg[1] + truck.front_wheel_radius + truck.wheelbase


class _Slide(NamedTuple):
    """Acceleration and loads of the axles with locked front wheels, and the loads at rest."""

    A: np.ndarray
    N_A: np.ndarray
    N_B: np.ndarray
    standing_A: np.ndarray
    standing_B: np.ndarray


def _slide(truck: Truck, beta: np.ndarray, mu: np.ndarray, model: str, factor: Numbers, g: float) -> _Slide:
    (a, y), r1, L, M = truck.cg, truck.front_wheel_radius, truck.wheelbase, truck.mass
    h = y + r1 if model == "corrected" else y - r1
    b, gc, gs = L - a, g * np.cos(beta), g * np.sin(beta)
    e = L + mu * h
    N_A = M * b * gc / e
    standing = M * (b * gc - (y + r1) * gs) / L
    return _Slide(factor * gs - mu * N_A / M, N_A, M * gc - N_A, standing, M * gc - standing)


_STATES = ["front wheel lifts", "rear wheel lifts", "never stops", "stops in the rise time"]


class _Parts(NamedTuple):
    """Distances in the rise time and after it, time of the stop, whether it ends in the rise, speed lost."""

    rise: np.ndarray
    rest: np.ndarray
    time: np.ndarray
    early: np.ndarray
    lost: np.ndarray


def _checked_slope(truck: Truck, slope: Numbers) -> Numbers:
    beta = numbers("slope", slope, "rad")
    refuse(
        np.abs(beta) >= np.pi / 2, "slope", beta, "rad", "it must be less than a right angle", "give {unit}"
    )
    front, rear = truck.overturning_slopes
    together(slope=beta, truck=front)
    remedy = "less slope, or a lower centre of gravity"
    for axle, limit, bad in (("rear", rear, beta >= rear), ("front", front, beta <= front)):
        bound = f"the truck overturns on it at rest, over the {axle} axle, past {{limit}}"
        refuse(bad, "slope", beta, "rad", bound, remedy, limit=limit)
    return beta


def _exact(V: np.ndarray, A: np.ndarray, t1: np.ndarray, t2: np.ndarray) -> _Parts:
    """With the speed lost in the rise time."""
    v2 = V + A * t2 / 2
    early = v2 <= 0
    brakes = np.where(A < 0, A, -1.0)  # where it does not, the caller puts inf
    tau = np.sqrt(2 * V * t2 / -brakes)
    rise = np.where(early, 2 / 3 * V * tau, V * t2 + A * t2**2 / 6)
    rest = np.where(early, 0.0, -(v2**2) / (2 * brakes))
    time = np.where(early, t1 + tau, t1 + t2 / 2 - V / brakes)
    return _Parts(rise, rest, time, early, np.where(early, V, V - v2))


def _printed(V: np.ndarray, A: np.ndarray, t1: np.ndarray, t2: np.ndarray) -> _Parts:
    """By (19)-(24), which take the full speed V into the third phase."""
    brakes = np.where(A < 0, A, -1.0)
    rest = -(V**2) / (2 * brakes)
    none = np.zeros(np.shape(A))
    return _Parts(A * t2**2 / 6 + V * t2, rest, t1 + t2 - V / brakes, none.astype(bool), none)
