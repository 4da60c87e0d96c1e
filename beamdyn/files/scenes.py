"""Scenes in TOML: text with units in, core objects out, all mistakes in one message."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from os import PathLike
from pathlib import Path
from typing import Any

from beamdyn.common.edge.config import ConfigError, parse, read, validated
from beamdyn.common.edge.inputs import SiNumber
from beamdyn.common.edge.units import InvalidInput, quantity, unit_as_written
from beamdyn.common.results.display_units import DisplayUnits, known_unit
from beamdyn.files.csv_files import with_record_file, with_station_file
from beamdyn.files.scene_inputs import SceneInput
from beamdyn.scene.scene import Scene


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
    except InvalidInput:  # the check of the table names this mistake
        return data
    velocities = {key: as_velocity(value) for key, value in rotation.items()}
    if radius <= 0 or all(value is None for value in velocities.values()):
        return data
    speeds = {key: SiNumber(value / radius) for key, value in velocities.items() if value is not None}
    return {**data, "motion": {**motion, "rotation": {**rotation, **speeds}}}


# Scenes in TOML -----------------------------------------------------------------------------------


def load_scene(path: str | PathLike[str]) -> Scene:
    """Read a scene from a TOML file, and the CSV files of its stations and its motion if it names some.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        If there is no such file or it does not describe a scene; the message lists all mistakes.  One in
        the CSV file is named by its line.

    Examples
    --------
    >>> scene = bd.load_scene("examples/tyre_harvester.toml")
    >>> scene.mount.radius  # m
    0.215
    """
    try:
        data = parse(read(path), str(path))
    except ConfigError as error:
        if Path(path).suffix.lower() == ".toml":
            raise
        hint = f"a blade of another program is read by beamdyn import {path} -o scene.toml"
        raise ConfigError(str(path), ["; ".join([*error.mistakes, hint])]) from None
    return scene_from_dict(with_record_file(with_station_file(data, path), path), str(path))


def parse_scene(text: str, source: str = "scene") -> Scene:
    """Read a scene from TOML text.

    Parameters
    ----------
    text : str
        The text.
    source : str
        Name of its origin, for messages.

    Raises
    ------
    ConfigError
        If it does not describe a scene; the message lists all mistakes.
    """
    return scene_from_dict(parse(text, source), source)


def scene_from_dict(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """A scene from the tables of a TOML file.

    Parameters
    ----------
    data : mapping
        Tables "beam" and "mount", and where wanted "motion", "model", "damping" and "physics", as
        tomllib reads them.
    source : str
        Name of its origin, for messages.

    Raises
    ------
    ConfigError
        If it does not describe a scene; the message lists all mistakes.
    """
    return replace(validated(SceneInput, with_rolling_speeds(data), source).core, units=_units_of(data))


def _units_of(data: Mapping[str, Any]) -> DisplayUnits:
    """Units in which the file gives the length of the beam and the speed of the motion, if it has one."""
    length = unit_as_written(data["beam"].get("length"), "m")[0]
    speed = unit_as_written(_speed_in(data.get("motion")), "rad/s")[0]
    return DisplayUnits(known_unit("speed", speed), known_unit("length", length))


def _speed_in(motion: Any) -> Any:
    """The speed of a motion as its table has it, or that of the rotation within it."""
    if not isinstance(motion, Mapping):
        return motion
    inner = motion.get("speed", motion.get("rotation"))
    return _speed_in(inner)
