"""Contents of a command, a screen and an HTML report on each type of brake; the pattern is `base.BrakeType`.

Types of brakes with no options of their own are listed in `STANDARD`: a command and a screen for each.
"""

from __future__ import annotations

from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from brakes.answers.base import BrakeType

_SHOWN = {  # by the name of the command and of its module: what it shows
    "drum": "Torque, forces, shoe factors and self-locking of a drum brake with pivoted shoes.",
    "band": "Torque, tensions, pressure and self-locking of a simple or differential band brake.",
    "block": "Torque, forces, pressure and self-locking of a block brake with one or two levers.",
    "cone": "Torque, pressure and sticking of a cone brake.",
    "disc": "Torque, forces and pressure of a disc brake with a fixed or floating caliper.",
    "plates": "Torque and pressure of a multi-plate brake.",
    "sliding": "Torque, contact and self-locking of a drum brake whose shoes slide on their abutment.",
    "vehicle": "Parking on a slope in both directions, pitching over, and which axle locks first.",
}


def _load(name: str) -> BrakeType[Any]:
    """A type, imported when it is wanted: a command imports no other brake than its own."""
    return import_module(f"brakes.answers.{name}").BRAKE


STANDARD = {name: (shown, partial(_load, name)) for name, shown in _SHOWN.items()}
