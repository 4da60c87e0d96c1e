"""Speeds of a rolling wheel in files, which may be those of the vehicle, such as "60 km/h"."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from beamdyn.common.edge.inputs import SiNumber
from beamdyn.common.edge.units import InvalidInput, quantity


def as_velocity(text: object) -> float | None:
    """A velocity [m/s], None if it is not one."""
    try:
        return quantity(text, "m/s") if isinstance(text, str) else None
    except InvalidInput:
        return None


def with_rolling_speeds(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """The tables of a file with velocities in the rotation of a rolling wheel as angular speeds [rad/s]."""
    motion = data.get("motion")
    rotation = motion.get("rotation") if isinstance(motion, Mapping) else None
    if not isinstance(motion, Mapping) or not isinstance(rotation, Mapping):
        return data
    try:
        radius = quantity(motion.get("rolling_radius"), "m")
    except InvalidInput:  # which is said where the table is checked
        return data
    velocities = {key: as_velocity(value) for key, value in rotation.items()}
    if radius <= 0 or all(value is None for value in velocities.values()):
        return data
    speeds = {key: SiNumber(value / radius) for key, value in velocities.items() if value is not None}
    return {**data, "motion": {**motion, "rotation": {**rotation, **speeds}}}
