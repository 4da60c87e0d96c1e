"""The largest deceleration of a vehicle: limits by grip and by pitching over, and which axle locks first.

All decelerations are braking ratios tau of `brakes.vehicle.axles`: on level ground, in units of gravity.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Annotated, Any

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers, numbers, positive, together
from beamdyn.common.inputs.checks import kind, one_of, refuse
from beamdyn.common.results.columns import Meaning
from beamdyn.common.results.one_line import spanned
from beamdyn.common.results.result import Result
from brakes.common.limits import EDGE
from brakes.vehicle.axles import Axle, Vehicle


@dataclass(frozen=True)
class Braking(Result):
    """Limits of the braking ratio; arrays have one entry per case.

    Attributes
    ----------
    vehicle : Vehicle
        The vehicle.
    friction, front_share : ndarray
        Friction of the tyres, and fraction of the braking force at the front wheels.
    leading : {"front", "rear"}
        The axle at the front of the motion.
    pitching, front_alone, rear_alone, both : ndarray
        Braking ratios at which the vehicle pitches over the leading axle, and which the grip of the front
        wheels, of the rear wheels and of all wheels allows; inf where grip sets no limit.
    front_locks, rear_locks : ndarray
        Braking ratios at which each axle locks with its share of the braking force; inf if it never does.
    largest : ndarray
        Largest braking ratio, with these shares, at which no wheel locks or lifts.
    first : str or ndarray of str
        What limits `largest`: ``"front"`` or ``"rear"``, the axle that locks first; ``"both"`` if they lock
        together; or ``"pitching over"``.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> found = vehicle.braking_limits(bicycle, friction=0.8, front_share=0.5)
    >>> str(found.first)
    'rear'
    """

    vehicle: Vehicle
    friction: Numbers
    front_share: Numbers
    leading: Axle
    pitching: Annotated[Numbers, Meaning("", "pitches over, g")]
    front_alone: Annotated[Numbers, Meaning("", "grip of the front wheels alone, g")]
    rear_alone: Annotated[Numbers, Meaning("", "grip of the rear wheels alone, g")]
    both: Annotated[Numbers, Meaning("", "grip of all wheels, g")]
    front_locks: Annotated[Numbers, Meaning("", "front wheels lock, with their share, g")]
    rear_locks: Annotated[Numbers, Meaning("", "rear wheels lock, with their share, g")]
    largest: Annotated[Numbers, Meaning("", "hardest braking with these shares, g")]
    first: Any

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"{self.leading} axle leading: hardest braking {spanned(self.largest, 'g')}"
        yield self.message if np.ndim(self.first) == 0 else ""

    @property
    def message(self) -> str:
        """Phrase that says which wheels lock first, or that the vehicle pitches over; for one case only."""
        return _WORDS[str(self.first)]


_WORDS = {
    "front": "the front wheels lock first",
    "rear": "the rear wheels lock first",
    "both": "all wheels lock at once",
    "pitching over": "it pitches over before any wheel locks",
}


def braking_limits(
    vehicle: Vehicle, friction: Numbers, front_share: Numbers, leading: Axle = "front"
) -> Braking:
    """Compute the largest braking ratio of a vehicle, and which axle locks first.

    Parameters
    ----------
    vehicle : Vehicle
        The vehicle.
    friction : float or ndarray
        Friction mu of the tyres.
    front_share : float or ndarray
        Fraction of the braking force at the front wheels, 0 to 1.
    leading : {"front", "rear"}
        The axle at the front of the motion.

    Returns
    -------
    Braking
        Complete result, arrays broadcast over all inputs.

    Raises
    ------
    ValueError
        If a value is out of bounds, or the shapes do not broadcast.

    References
    ----------
    Standard: moments about the points where the tyres stand; see the docstring of `brakes.vehicle.axles`.

    Examples
    --------
    >>> bicycle = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
    >>> round(float(vehicle.braking_limits(bicycle, friction=0.8, front_share=0.0).largest), 4)  # g
    0.2611
    """
    kind("vehicle", vehicle, Vehicle)
    one_of("leading", leading, ("front", "rear"))
    mu, share = positive("friction", friction), numbers("front_share", front_share)
    wrong = (np.asarray(share) < 0) | (np.asarray(share) > 1)
    refuse(wrong, "front_share", share, "", "it must be 0 to 1", "60 % is 0.6")
    together(vehicle=vehicle.cg_height * vehicle.wheelbase, friction=mu, front_share=share)
    front = vehicle.locking_ratio("front", mu, share, leading)
    rear = vehicle.locking_ratio("rear", mu, 1 - np.asarray(share), leading)
    pitching = vehicle.pitching_ratio(leading)
    front, rear, pitching = np.broadcast_arrays(front, rear, pitching)
    lock = np.minimum(front, rear)
    with np.errstate(invalid="ignore"):
        equal = np.abs(front - rear) <= EDGE * lock
    kinds = [lock >= pitching * (1 - EDGE), equal, front < rear]
    return Braking(
        vehicle,
        mu,
        share,
        leading,
        pitching=pitching[()],
        front_alone=vehicle.slipping_ratio(mu, "front", leading),
        rear_alone=vehicle.slipping_ratio(mu, "rear", leading),
        both=vehicle.slipping_ratio(mu, "both", leading),
        front_locks=front[()],
        rear_locks=rear[()],
        largest=np.minimum(lock, pitching)[()],
        first=np.select(kinds, ["pitching over", "both", "front"], default="rear")[()],
    )
