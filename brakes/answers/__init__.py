"""Contents of a command, a screen and an HTML report on each type of brake; the pattern is `base.BrakeType`.

Types of brakes with no options of their own are listed in `STANDARD`: a command and a screen for each.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from brakes.answers.base import BrakeType


def _drum() -> BrakeType[Any]:
    """Drum brakes, imported when they are wanted: a command imports no other brake than its own."""
    from brakes.answers.drum import BRAKE

    return BRAKE


def _vehicle() -> BrakeType[Any]:
    """Vehicles, imported when they are wanted."""
    from brakes.answers.vehicle import BRAKE

    return BRAKE


STANDARD = {  # by the name of the command: what it shows, and what gives the type
    "drum": ("Torque, forces, shoe factors and self-locking of a drum brake with pivoted shoes.", _drum),
    "vehicle": (
        "Parking on a slope in both directions, pitching over, and which axle locks first.",
        _vehicle,
    ),
}
