"""Parking and hill hold: whether a vehicle at rest on a slope holds, slips or tips, and the largest slope.

The braking ratio is tau = tan(beta), see `brakes.vehicle.axles`. The vehicle slips past tan(beta) =
`slipping_ratio`, tips over the lower axle past tan(beta) = `pitching_ratio` if that axle is braked, and rolls
past sin(beta) = R / (M g) if its brakes give the force R along the ground. A vehicle that does not hold moves
down the slope. Its braking ratio, on which the axle loads depend, is then the smaller of that of the road,
`slipping_ratio`, and that of the brakes, R / (M g cos(beta)); past `pitching_ratio` it tips. If only the
upper axle is braked, it loses its load, and so its grip, before the vehicle could tip.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, keep_checked, numbers, together
from beamdyn.common.inputs.checks import kind, one_of, refuse
from beamdyn.common.inputs.described import Described
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned
from beamdyn.common.results.result import Result
from brakes.common.limits import EDGE
from brakes.common.locking import LEAST_MARGIN
from brakes.vehicle.axles import ROUNDING, Axle, Braked, Vehicle
from brakes.vehicle.stop import STANDARD_GRAVITY, STEEPEST, SlopeAngle


@dataclass(frozen=True)
class Road:
    """Slope and friction of a road; every value may be an array, one entry per case.

    Parameters
    ----------
    slope : float or ndarray
        Angle beta of the road [rad], 0 to 45 deg.
    friction : float or ndarray
        Friction mu of the tyres.
    gravity : float or ndarray
        Gravity g [m/s2].

    Raises
    ------
    ValueError
        If a value is out of bounds.

    Examples
    --------
    >>> vehicle.Road(slope=0.15, friction=0.7).gravity  # m/s2
    9.806
    """

    slope: Annotated[
        Numbers,
        SlopeAngle("rad", "beta", "slope of the road", least=0, most=STEEPEST, remedy="no road is steeper"),
    ]
    friction: Annotated[
        Numbers, Described("", "mu", "friction of tyres on the road", above=0, most=2, remedy="70 % is 0.7")
    ]
    gravity: Annotated[Numbers, Described("m/s2", "g", "gravity", above=0)] = STANDARD_GRAVITY

    def __post_init__(self) -> None:
        keep_checked(self)


@dataclass(frozen=True)
class Holding(Result):
    """Whether a vehicle holds on a slope; arrays have one entry per case.

    Attributes
    ----------
    vehicle, road : Vehicle, Road
        The vehicle, and the road on which it stands.
    braked : {"front", "rear", "both"}
        Axles whose wheels are braked.
    downhill : {"front", "rear"}
        The lower axle.
    status : str or ndarray of str
        Motion on the road's slope: ``"holds"``, ``"slips"``, ``"tips"``, ``"rolls"`` (the brake is too
        weak), or ``"too near to decide"``, within 1e-9 of the largest slope.
    slipping_slope, tipping_slope, rolling_slope : ndarray
        Slopes past which the braked wheels slip, the vehicle tips over its lower axle, and the vehicle rolls
        as its brakes are too weak [rad]; inf where this never happens.
    largest_slope : ndarray
        The least of the slipping, tipping and rolling slope [rad].
    needed_force : ndarray
        Braking force along the ground that holds the vehicle on the road's slope [N].
    braking_force : ndarray
        Braking force along the ground that acts on this slope [N]: less than needed where the vehicle slips
        or rolls, nan where it tips.
    front_load, rear_load : ndarray
        Normal forces of the axles on this slope, at rest or as the vehicle slips or rolls [N]; nan where it
        tips.
    error : float
        Bound of the rounding error of the slopes [rad], which grows as the rolling slope nears 90 deg.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> road = vehicle.Road(slope=0.3, friction=0.8)
    >>> vehicle.hold(bicycle, road, braked="rear", downhill="front").message
    'slips on slopes above 14.6307 deg: on the given 17.1887 deg it slips'
    """

    vehicle: Vehicle
    road: Road
    braked: Braked
    downhill: Axle
    status: Any
    slipping_slope: Annotated[Numbers, Meaning("rad", "slips past", "deg")]
    tipping_slope: Annotated[Numbers, Meaning("rad", "tips over the lower axle past", "deg")]
    rolling_slope: Annotated[Numbers, Meaning("rad", "rolls, as the brake gives too little, past", "deg")]
    largest_slope: Annotated[Numbers, Meaning("rad", "largest slope", "deg")]
    needed_force: Annotated[Numbers, Meaning("N", "braking force that the slope needs")]
    braking_force: Annotated[Numbers, Meaning("N", "braking force that acts")]
    front_load: Annotated[Numbers, Meaning("N", "front axle's load on the slope")]
    rear_load: Annotated[Numbers, Meaning("N", "rear axle's load on the slope")]
    error: float

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{self.downhill} axle downhill: largest slope {spanned(np.degrees(self.largest_slope), 'deg')}"
        yield f"{self.status}" if np.ndim(self.status) == 0 else f"{np.sum(self.status == 'holds')} hold"

    @property
    def limited_by(self) -> Any:
        """Motion of the vehicle on a steeper slope: "slips", "tips" or "rolls"."""
        ends = np.stack(np.broadcast_arrays(self.slipping_slope, self.tipping_slope, self.rolling_slope))
        return np.array(["slips", "tips", "rolls"])[np.argmax(ends <= ends.min(axis=0) * (1 + EDGE), axis=0)]

    @property
    def message(self) -> str:
        """Sentence on the given slope and the motion on slopes past the largest; for a single case only."""
        on, most = np.degrees(float(self.road.slope)), np.degrees(float(self.largest_slope))
        near = {"too near to decide": "it is too near to decide whether it holds"}
        what = near.get(str(self.status), f"it {self.status}")
        return f"{self.limited_by} on slopes above {most:.6g} deg: on the given {on:.6g} deg {what}"


def hold(
    vehicle: Vehicle,
    road: Road,
    braked: Braked = "both",
    downhill: Axle = "front",
    brake_force: Numbers = np.inf,
) -> Holding:
    """Find whether a vehicle at rest holds on a slope, and the largest slope on which it holds.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    road : Road
        The road.
    braked : {"front", "rear", "both"}
        Axles whose wheels the parking brake holds.
    downhill : {"front", "rear"}
        The lower axle.
    brake_force : float or ndarray, optional
        Force along the ground that the brakes can give [N]; if not given, they hold the wheels on any slope.

    Returns
    -------
    Holding
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If a choice is unknown, the force is negative, or the shapes do not broadcast.

    References
    ----------
    Standard: moments about the points where the tyres stand; see the docstring of `brakes.vehicle.axles`.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> road = vehicle.Road(slope=0.3, friction=0.8)
    >>> found = vehicle.hold(bicycle, road, braked="both", downhill="front")
    >>> str(found.limited_by), round(float(np.degrees(found.largest_slope)), 2)
    ('tips', 29.41)
    """
    kind("vehicle", vehicle, Vehicle)
    kind("road", road, Road)
    one_of("downhill", downhill, ("front", "rear"))
    force = (
        brake_force
        if isinstance(brake_force, float) and brake_force == np.inf
        else numbers("brake_force", brake_force, "N")
    )
    refuse(np.asarray(force) < 0, "brake_force", force, "N", "it must be 0 or more")
    together(vehicle=vehicle.mass * vehicle.cg_height * vehicle.wheelbase, brake_force=force, **vars(road))
    weight = vehicle.mass * road.gravity
    grip, pitching = vehicle.slipping_ratio(road.friction, braked, downhill), vehicle.pitching_ratio(downhill)
    slips = np.arctan(grip)
    tips = np.arctan(pitching) if braked in (downhill, "both") else np.inf
    rolls = np.where(
        np.asarray(force) < weight * (1 - EDGE), np.arcsin(np.minimum(force / weight, 1.0)), np.inf
    )
    slips, tips, rolls, slope = np.broadcast_arrays(slips, tips, rolls, road.slope)
    most = np.minimum(np.minimum(slips, tips), rolls)
    near = np.abs(slope - most) <= EDGE * most
    pressed = weight * np.cos(slope)
    given = np.minimum(grip, force / pressed)  # braking ratio of a vehicle that slides or rolls
    ratio = np.minimum(np.tan(slope), given)
    kinds = [near, slope < most, ratio > pitching * (1 + EDGE), grip <= given]
    status = np.select(kinds, ["too near to decide", "holds", "tips", "slips"], default="rolls")
    shares = [vehicle.load_share(axle, ratio, downhill) for axle in ("front", "rear")]
    stands = np.minimum(*shares) >= -LEAST_MARGIN
    pressed = np.where(stands, pressed, np.nan)  # no equilibrium while the vehicle tips
    front, rear = (pressed * np.maximum(each, 0.0) for each in shares)
    return Holding(
        vehicle=vehicle,
        road=road,
        braked=braked,
        downhill=downhill,
        status=status[()],
        slipping_slope=slips[()],
        tipping_slope=tips[()],
        rolling_slope=rolls[()],
        largest_slope=most[()],
        needed_force=(weight * np.sin(slope))[()],
        braking_force=(pressed * ratio)[()],
        front_load=front[()],
        rear_load=rear[()],
        error=float(16 * ROUNDING / np.cos(np.where(np.isinf(rolls), 0.0, rolls)).min()),
    )
