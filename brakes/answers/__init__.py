"""Results that command, screen and HTML report show for each type of brake; see `base.BrakeType`.

`STANDARD` lists the types of brakes that have no options of their own: each gets a command and a screen.
"""

from __future__ import annotations

from functools import partial
from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from brakes.answers.base import BrakeType

_SHOWN = {  # what each command shows, by name of the command
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
    """Import a type of brake on first use, so that a command imports only its own type of brake."""
    alone = name in ("drum", "vehicle")
    module = import_module(f"brakes.answers.{name if alone else 'machine'}")
    return module.BRAKE if alone else module.MACHINES[name]


STANDARD = {name: (shown, partial(_load, name)) for name, shown in _SHOWN.items()}
