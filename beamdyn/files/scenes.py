"""Reading of scenes in TOML and of CSV files named in them: from texts with units to objects in SI units."""

from __future__ import annotations

import math
import os
import re
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from decimal import Decimal
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any, get_origin

from beamdyn.common.edge.config import ConfigError, parse, read, validated
from beamdyn.common.edge.data_text import (
    CsvTable,
    DataText,
    check_places,
    named_file,
    plain_name,
    read_csv,
    read_data,
)
from beamdyn.common.edge.inputs import Quantity, SiNumber
from beamdyn.common.edge.toml_text import toml_of, toml_value
from beamdyn.common.edge.units import InvalidInput, quantity, unit_as_written
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import described_hints, description, kinds_of, part_at, with_parts
from beamdyn.common.results.columns import DisplayUnits, known_unit
from beamdyn.files.scene_inputs import PLACES, VARYING, SceneInput
from beamdyn.scene.motion.kinds import KINDS
from beamdyn.scene.motion.oscillating import check_record_times
from beamdyn.scene.numbers import number_at, unit_of, with_numbers
from beamdyn.scene.scene import Scene

_DIGITS = 10
_TABLE = re.compile(r"\s*\[{1,2}([^\[\]]+)\]{1,2}\s*(#.*)?")
# Keys of a scene file that may name a CSV file.
_NAMES_OF_FILES = ("beam.stations", "motion.file", "motion.rotation.file")


def with_numbers_in_file(
    path: str | PathLike[str], values: Mapping[str, float], to: str | PathLike[str], head: Iterable[str] = ()
) -> str:
    """Return the text of a scene file with numbers replaced, or added to their tables.

    The other lines stay as they are.  If a number has no line of its own, as in a list, the text is written
    anew, without the comments of the file.

    Parameters
    ----------
    path : str or path-like
        The scene file.
    values : mapping of str to float
        Numbers [SI units] by path, such as "beam.thickness"; an infinite number is written as "inf".
    to : str or path-like
        The file that the text is for: names of CSV files in the text are relative to its folder.
    head : iterable of str
        Sentences to write as comments at the start of the file.

    Raises
    ------
    ConfigError
        If the file cannot state a number beside its other keys, such as the factor "scale" of a property
        along the beam, or the value of a property that is a column of stations.
    """
    text = read(path)
    tables = parse(text, str(path))
    asked = ", ".join(f"{name} = {_written(name, value)}" for name, value in values.items())
    said = f"{asked}: the file cannot state this beside its other keys; write the scene by hand"
    refusal = ConfigError(str(path), [said])
    if any("[" in name and part_at(tables, name) is None for name in values):  # a list that is not there
        raise refusal
    named = {key: name for key in _NAMES_OF_FILES if isinstance(name := part_at(tables, key), str)}
    entries: dict[str, Any] = {name: _written(name, value) for name, value in values.items()}
    entries |= {
        key: os.path.relpath(Path(path).parent / name, Path(to).parent) for key, name in named.items()
    }
    wanted, lines = with_parts(tables, entries), text.splitlines()
    for name, entry in entries.items():
        table, _, key = name.rpartition(".")
        _put(lines, table, key, f"{key} = {toml_value(entry)}")
    body = "\n".join(lines) + "\n"
    if _tables_in(body) != wanted:
        body = toml_of(wanted)
    try:
        written = with_numbers(_scene_of(wanted, to), values)
    except ValueError:
        written = None
    if written != with_numbers(_scene_of(tables, path), values):
        raise refusal
    comments = [f"# {''.join(c if c.isprintable() else ' ' for c in said)}" for said in head]
    return "\n".join([*comments, body])


def check_numbers_in_file(
    path: str | PathLike[str],
    scene: Scene,
    free: Mapping[str, tuple[float, float] | None],
    to: str | PathLike[str],
) -> None:
    """Refuse numbers that are to be found, before that takes time, if a scene file cannot state them.

    `free` has the bounds of each number [SI units] by path, or None; `path`, `to` and the error raised are
    those of `with_numbers_in_file`.
    """
    own = {name: number_at(scene, name) for name in free}
    first = {name: bounds[0] for name, bounds in free.items() if bounds is not None}  # where it varies along
    known = {name: first.get(name) if value != value else value for name, value in own.items()}
    with_numbers_in_file(path, {name: value for name, value in known.items() if value is not None}, to)


def _written(path: str, value: float) -> str | float:
    """Return a number in the notation of files: a text with a unit, or a bare number."""
    if math.isinf(value):
        return "inf"
    text, unit = f"{value:.{_DIGITS}g}", unit_of(path)
    return f"{text} {unit}" if unit else float(text)


def _tables_in(text: str) -> dict[str, Any] | None:
    """Return the tables in a TOML text; None if it is not valid."""
    try:
        return parse(text, "scene")
    except ConfigError:
        return None


def _put(lines: list[str], table: str, key: str, line: str) -> None:
    """Replace the line of a key in a table, or add it at the end of the table; add the table if needed."""
    heads = {match[1].strip(): k for k, each in enumerate(lines) if (match := _TABLE.fullmatch(each))}
    if table not in heads:
        lines += ["", f"[{table}]", line]
        return
    start = heads[table] + 1
    end = min([k for k in heads.values() if k >= start], default=len(lines))
    for k in range(start, end):
        if re.match(rf"\s*{re.escape(key)}\s*=", lines[k]):
            comment = re.search(r"\s+#[^\"']*$", lines[k])
            lines[k] = line + (comment[0] if comment else "")
            return
    while end > start and not lines[end - 1].strip():
        end -= 1
    lines.insert(end, line)


RADIUS = "r"  # column heading of the distance from the axis of rotation in CSV files
# Column headings of CSV files, in addition to the keys of the beam.
_HEADS = {
    "x/L": ("span", "blfract", "sec_loc", "span_loc"),
    "mass_per_length": ("mass", "mass per metre", "BMassDen", "mass_den"),
    "bending_stiffness": ("EI", "EI flap", "flap EI", "flap stiffness", "FlpStff", "flp_stff"),
    "second_bending_stiffness": ("EI edge", "edge EI", "edge stiffness", "EI lag", "EdgStff", "edge_stff"),
    "axial_stiffness": ("EA", "axial_stff"),
}
_STATION_NAMES = {plain_name(name): name for name in [*PLACES, *VARYING]}
_STATION_NAMES |= {plain_name(head): name for name, heads in _HEADS.items() for head in heads}


def read_station_file(text: DataText, more: Mapping[str, Quantity] | None = None) -> CsvTable:
    """Read a CSV file of stations as a table whose columns have the names of the keys in [beam].

    The positions must ascend.

    Parameters
    ----------
    text : DataText
        Text of the file.
    more : mapping, optional
        Further positions or properties that columns may have, by name.

    Raises
    ------
    ConfigError
        At the first mistake; the message names the file, the line, and what was expected.
    """
    known = PLACES | VARYING | dict(more or {})
    table = read_csv(text, known, _STATION_NAMES | {plain_name(name): name for name in more or ()})
    places = [name for name in table.named() if name in PLACES or name == RADIUS]
    if len(places) != 1:
        wanted = "x/L, x [m] or r [m]" if more else "x/L or x [m]"
        found = ", ".join(column.head for column in table.columns)
        said = f"expected one column of positions, {wanted}; the headings are {found}"
        raise text.refusal(table.head_line, said)
    check_places(table, places[0])
    return table


def with_station_file(data: dict[str, Any], path: str | PathLike[str]) -> dict[str, Any]:
    """Replace the name of a CSV file in `beam.stations` by the rows of the file.

    Return the tables of the scene file.
    """
    beam = data.get("beam")
    if not isinstance(beam, dict) or not isinstance(beam.get("stations"), str):
        return data
    table = read_station_file(read_data(named_file(path, "beam.stations", beam["stations"])))
    if unknown := next((column.head for column in table.columns if not column.name), ""):
        known = ", ".join([*PLACES, *VARYING])
        raise table.text.refusal(table.head_line, f"unknown column '{unknown}'; known are {known}")
    units = {name: (PLACES | VARYING)[name].unit for name in table.named()}
    heads = [f"{name} [{unit}]" if unit else name for name, unit in units.items()]
    rows = [list(row) for row in zip(*(column.values for column in table.columns), strict=True)]
    return data | {"beam": beam | {"stations": [heads, *rows]}}


# Recorded motions ---------------------------------------------------------------------------------


class RecordedQuantity(Quantity):
    """A quantity in a recorded time series; the conversion of a unit is computed once for all numbers."""

    def parse(self, given: object) -> float:
        """Convert a number with a unit to SI units."""
        number, _, unit = str(given).partition(" ")
        return float(Decimal(number) * _si_value(unit, self.unit))


@cache
def _si_value(unit: str, si_unit: str) -> Decimal:
    """Return the size of a unit in terms of an SI unit, such as 0.001 for mm and m, as a decimal number."""
    return Decimal(repr(quantity(f"1 {unit}", si_unit)))


FILE = "file"
_TIMES = "times"
# Column headings, in addition to the keys of the motion.
_RECORD_HEADS = {
    "times": ("t", "time"),
    "speeds": ("speed", "omega"),
    "along_n1": ("n1", "a1"),
    "along_n2": ("n2", "a2"),
    "along_n3": ("n3", "a3"),
}


def with_record_file(data: dict[str, Any], path: str | PathLike[str]) -> dict[str, Any]:
    """Add the columns of CSV files that a scene's motion names; return the tables of the scene.

    Raises
    ------
    ConfigError
        At the first mistake in a file, with the line and what was expected; or if a motion without time
        series names a file, or gives a time series in addition to the file.
    """
    motion = data.get("motion")
    if not isinstance(motion, dict):
        return data
    try:
        if isinstance(motion.get("rotation"), dict):
            motion = motion | {"rotation": _with_columns(motion["rotation"], "motion.rotation", path)}
        return data | {"motion": _with_columns(motion, "motion", path)}
    except InvalidInput as error:
        raise ConfigError(str(path), [str(error)], [error.field]) from None


def _with_columns(motion: dict[str, Any], place: str, path: str | PathLike[str]) -> dict[str, Any]:
    """Return the table of a motion with the time series from the file that it names."""
    if not isinstance(motion.get(FILE), str):
        return motion
    name, known = motion[FILE], _lists_of(motion.get("kind"))
    if not known:
        kinds = " or ".join(f'"{kind}"' for kind in KINDS if _lists_of(kind))
        raise InvalidInput(f"{place}.{FILE}", name, f"this kind of motion reads no file; give kind = {kinds}")
    if given := [key for key in known if key in motion]:
        raise InvalidInput(f"{place}.{given[0]}", "", f"the file {name} has this column, too; give it once")
    columns = read_record(named_file(path, f"{place}.{FILE}", name), known)
    rest = {key: value for key, value in motion.items() if key != FILE}
    return rest | {key: [SiNumber(value) for value in values] for key, values in columns.items()}


def _lists_of(kind: object) -> dict[str, RecordedQuantity]:
    """Return the time series that a kind of motion may read from a file, by key."""
    made = KINDS.get(kind) if isinstance(kind, str) else None
    if made is None:
        return {}
    found = ((name, description(hint), kinds_of(hint)[0]) for name, hint in described_hints(made).items())
    return {
        name: RecordedQuantity(**vars(entry))
        for name, entry, read in found
        if entry is not None and get_origin(read) is Sequence
    }


def read_record(path: Path, known: Mapping[str, Quantity]) -> dict[str, tuple[float, ...]]:
    """Read a recorded motion in SI units: evenly spaced times, and numbers at each time.

    Parameters
    ----------
    path : Path
        The CSV file: a line of headings with units, such as "t [s], n2 [m/s2]", then lines of numbers.
    known : mapping
        The known quantities, by name; they include "times".

    Raises
    ------
    ConfigError
        If a heading lacks its unit, a cell is not a number, or samples are missing; the message names the
        line.
    """
    text = read_data(path)
    names = {plain_name(head): key for key in known for head in (key, *_RECORD_HEADS.get(key, ()))}
    table = read_csv(text, known, names)
    columns = {name: column.values for name, column in table.named().items()}
    if unknown := next((column.head for column in table.columns if not column.name), ""):
        raise text.refusal(table.head_line, f"unknown column '{unknown}'; known are {', '.join(known)}")
    if _TIMES not in columns or len(columns) < 2:
        raise text.refusal(table.head_line, f"expected a column t [s], and one of {', '.join(known)}")
    times = columns[_TIMES]
    try:
        check_record_times("t", times)
    except InvalidValue as error:
        row = times.index(error.value) if error.value in times else 0
        raise table.text.refusal(table.lines[row], str(error)) from None
    return columns


def as_velocity(text: object) -> float | None:
    """Convert a text to a velocity [m/s]; return None if it is not a velocity."""
    try:
        return quantity(text, "m/s") if isinstance(text, str) else None
    except InvalidInput:
        return None


def with_rolling_speeds(data: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a file's tables with velocities of a rolling wheel converted to rotational speeds [rad/s]."""
    motion = data.get("motion")
    rotation = motion.get("rotation") if isinstance(motion, Mapping) else None
    if not isinstance(motion, Mapping) or not isinstance(rotation, Mapping):
        return data
    try:
        radius = quantity(motion.get("rolling_radius"), "m")
    except InvalidInput:  # the check of the table reports this error later
        return data
    velocities = {key: as_velocity(value) for key, value in rotation.items()}
    if radius <= 0 or all(value is None for value in velocities.values()):
        return data
    speeds = {key: SiNumber(value / radius) for key, value in velocities.items() if value is not None}
    return {**data, "motion": {**motion, "rotation": {**rotation, **speeds}}}


# Scenes in TOML -----------------------------------------------------------------------------------


def load_scene(path: str | PathLike[str]) -> Scene:
    """Read a scene from a TOML file, and from the CSV files that it names for stations and motion.

    Parameters
    ----------
    path : str or path-like
        The TOML file.

    Returns
    -------
    Scene

    Raises
    ------
    ConfigError
        If the file does not exist or does not describe a scene; the message lists all mistakes, with line
        numbers for CSV files.

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
    return _scene_of(data, path)


def _scene_of(data: dict[str, Any], path: str | PathLike[str]) -> Scene:
    """Make a scene from the tables of a file, and from the CSV files that they name."""
    return scene_from_dict(with_record_file(with_station_file(data, path), path), str(path))


def parse_scene(text: str, source: str = "scene") -> Scene:
    """Read a scene from TOML text.

    Parameters
    ----------
    text : str
        TOML text.
    source : str
        Name of the file or other source, for messages.

    Raises
    ------
    ConfigError
        If the text does not describe a scene; the message lists all mistakes.
    """
    return scene_from_dict(parse(text, source), source)


def scene_from_dict(data: Mapping[str, Any], source: str = "scene") -> Scene:
    """Make a scene from the tables of a TOML file.

    Parameters
    ----------
    data : mapping
        Tables "beam" and "mount", and optionally "motion", "model", "damping", "tip_load", "harvester" and
        "physics", as tomllib returns them.
    source : str
        Name of the file or other source, for messages.

    Raises
    ------
    ConfigError
        If the tables do not describe a scene; the message lists all mistakes.
    """
    return replace(validated(SceneInput, with_rolling_speeds(data), source).core, units=_units_of(data))


def _units_of(data: Mapping[str, Any]) -> DisplayUnits:
    """Return the units in which the file gives the length of the beam and the speed of the motion."""
    length = unit_as_written(data["beam"].get("length"), "m")[0]
    speed = unit_as_written(_speed_in(data.get("motion")), "rad/s")[0]
    return DisplayUnits(known_unit("speed", speed), known_unit("length", length))


def _speed_in(motion: Any) -> Any:
    """Return the speed in the table of a motion, or of the rotation nested in it."""
    if not isinstance(motion, Mapping):
        return motion
    return _speed_in(motion.get("speed", motion.get("rotation")))
