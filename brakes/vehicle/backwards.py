"""Inverse questions: the tyre friction that a slope or a stopping distance needs.

A braking ratio tau on axles that carry the fraction n(tau) of the load needs the friction mu = tau / n(tau),
and tau rises with mu until the vehicle pitches over: each answer is unique. The distance of a stop from the
speed V, with the reaction time t1, the rise time t2 of the braking force and the acceleration A at full
force,

    s = V t1 + V t2 / 2 - d t2^2 / 24 + V^2 / (2 d)   for the deceleration d = -A up to 2 V / t2,
    s = V t1 + (2 / 3) V sqrt(2 V t2 / d)             for a stop within the rise time,

falls with d, ds/dd < 0 in both cases, so that d is unique: the positive root of a quadratic equation, or
(2 / d)^(1/2) from the second formula.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, not_negative, positive, together
from beamdyn.common.inputs.checks import kind, one_of
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned
from beamdyn.common.results.result import Result
from brakes.common.limits import EDGE
from brakes.common.locking import LEAST_MARGIN
from brakes.vehicle.axles import Axle, Braked, Truck, Vehicle, other
from brakes.vehicle.stop import StopConditions

MOST_FRICTION = 2.0  # largest friction that `Road` and `StopConditions` accept


@dataclass(frozen=True)
class Needed(Result):
    """An input that gives a wanted output, or why there is none; arrays have one entry per case.

    Attributes
    ----------
    value : ndarray
        The unique value that gives the output [SI unit]; nan if there is none.
    reason : str or ndarray of str
        Why there is no value; empty if there is one.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> vehicle.friction_to_hold(bicycle, slope=0.6, braked="front", downhill="front").message
    'none: the vehicle tips over its lower axle, whatever the friction'
    """

    value: Annotated[Numbers, Meaning("", "the needed value")]
    reason: Any

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield spanned(self.value)
        yield self.message if np.ndim(self.reason) == 0 and self.reason else ""

    @property
    def message(self) -> str:
        """Text of the value, or "none" with the reason; for a single case only."""
        return f"none: {self.reason}" if self.reason else f"{float(self.value):.6g}"


def needed(value: Numbers, *reasons: tuple[Any, Any]) -> Needed:
    """Make the result: the value, or nan with a reason where one of the conditions `reasons` holds.

    Each of `reasons` is a condition with its description; the first that holds counts.
    """
    shapes = np.broadcast_arrays(value, *(bad for bad, _ in reasons))
    value, bad = shapes[0], list(shapes[1:])
    none = np.any(bad, axis=0) if bad else np.zeros(value.shape, dtype=bool)
    reason = np.select(bad, [words for _, words in reasons], default="") if bad else np.full(value.shape, "")
    return Needed(np.where(none, np.nan, value)[()], reason[()])


def friction_to_hold(vehicle: Vehicle, slope: Numbers, braked: Braked, downhill: Axle) -> Needed:
    """Find the least tyre friction with which a parked vehicle holds on a slope.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    slope : float or ndarray
        Angle of the slope [rad].
    braked : {"front", "rear", "both"}
        Axles whose wheels are braked.
    downhill : {"front", "rear"}
        The lower axle.

    Returns
    -------
    Needed
        The friction; none if the vehicle tips, or if the friction would have to exceed 2.

    Raises
    ------
    ValueError
        If the slope is negative, or a choice is unknown.

    References
    ----------
    Standard: equilibrium of moments, solved for the friction, as in the docstring of the module.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> round(float(vehicle.friction_to_hold(bicycle, 0.2, braked="rear", downhill="front").value), 4)
    0.5208
    """
    kind("vehicle", vehicle, Vehicle)
    one_of("downhill", downhill, ("front", "rear"))
    one_of("braked", braked, ("front", "rear", "both"))
    slope = not_negative("slope", slope, "rad")
    together(vehicle=vehicle.cg_height * vehicle.wheelbase, slope=slope)
    return _friction_for(vehicle, np.tan(slope), braked, downhill)


def friction_to_stop(truck: Truck, conditions: StopConditions, distance: Numbers = np.inf) -> Needed:
    """Find the least tyre friction with which a truck with locked front wheels stops, within a distance.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing; their friction is not used.
    distance : float or ndarray, optional
        Stopping distance from the driver's reaction [m]; any distance if not given.

    Returns
    -------
    Needed
        The friction; none if the truck pitches over, covers the distance before the brakes act, or
        would need a friction above 2.

    Raises
    ------
    ValueError
        If the distance is not positive, or the shapes do not broadcast.

    References
    ----------
    Yoo et al. (1997), section 2, corrected and solved for the friction, as in the docstring of the module.

    Examples
    --------
    >>> truck = vehicle.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = vehicle.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> round(float(vehicle.friction_to_stop(truck, conditions, distance=10.0).value), 6)
    0.879483
    """
    kind("truck", truck, Truck)
    kind("conditions", conditions, StopConditions)
    c, left = conditions, np.inf
    if np.ndim(distance) or distance != np.inf:
        left = positive("distance", distance, "m") - c.speed * np.asarray(c.reaction_time)
    together(truck=truck.cg[0] + truck.cg[1] + truck.wheelbase, distance=left, **c.numbers)
    ratio = np.tan(c.slope) + _deceleration(c, left) / (c.gravity * np.cos(c.slope))
    found = _friction_for(truck.vehicle, ratio, "front", "rear" if c.sense > 0 else "front")
    late = np.asarray(left) <= EDGE * c.speed * np.asarray(c.reaction_time)
    words = "the distance is covered in the reaction time"
    return needed(found.value, (late, words), (np.asarray(found.reason) != "", np.asarray(found.reason)))


def _friction_for(vehicle: Vehicle, ratio: Numbers, braked: Braked, leading: Axle) -> Needed:
    """Find the tyre friction that a braking ratio needs at the braked axles."""
    share = 1.0 + 0.0 * ratio if braked == "both" else vehicle.load_share(braked, ratio, leading)
    lifted = vehicle.load_share(other(leading), ratio, leading) <= LEAST_MARGIN
    lifted &= braked != other(leading)  # a braked upper axle slips before its load falls to 0
    with np.errstate(divide="ignore", invalid="ignore"):
        friction = np.maximum(ratio, 0.0) / np.where(share > 0, share, np.nan)
    much = f"even a friction of {MOST_FRICTION:g}, the largest that is accepted, is too low"
    tips = "the vehicle tips over its lower axle, whatever the friction"
    much_friction = ~(friction <= MOST_FRICTION * (1 + EDGE))
    return needed(np.minimum(friction, MOST_FRICTION), (lifted, tips), (much_friction, much))


def _deceleration(c: StopConditions, left: Numbers) -> Numbers:
    """Find the deceleration at full force [m/s2] of a stop within `left` [m] after the reaction time."""
    V, t2 = np.asarray(c.speed), np.asarray(c.rise_time)
    way = np.where(np.asarray(left) > 0, left, np.nan)
    with np.errstate(divide="ignore", invalid="ignore"):
        late = way - V * t2 / 2  # the deceleration d solves t2^2 d^2 / 24 + late d - V^2 / 2 = 0
        rolling = V**2 / (late + np.sqrt(late**2 + t2**2 * V**2 / 12))
        rising = 2 * V * t2 * (2 * V / (3 * way)) ** 2
        return np.where(way < 2 / 3 * V * t2, rising, np.where(way < np.inf, rolling, 0.0))
