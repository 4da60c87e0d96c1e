"""CSV files that a scene names: stations of the beam, and records of its motion."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from functools import cache
from os import PathLike
from pathlib import Path
from typing import Any, get_origin

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.csv_columns import CsvTable, check_places, read_csv
from beamdyn.common.edge.data_text import DataText, named_file, plain_name, read_data
from beamdyn.common.edge.inputs import Quantity, SiNumber
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import described_hints, description, kinds_of
from beamdyn.files.scene_inputs import PLACES, VARYING
from beamdyn.scene.motion import KINDS
from beamdyn.scene.motion.records import check_record_times

RADIUS = "r"  # head in CSV files of the distance from the axis of rotation
# Heads of CSV files, beside the keys of the beam.
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
    """Read stations from a CSV file: its columns by the keys of the beam, checked to ascend.

    Parameters
    ----------
    text : DataText
        The file.
    more : mapping, optional
        Further places or properties, by name.

    Raises
    ------
    ConfigError
        At the first mistake: names file, line, and what was expected.
    """
    known = PLACES | VARYING | dict(more or {})
    table = read_csv(text, known, _STATION_NAMES | {plain_name(name): name for name in more or ()})
    places = [name for name in table.named() if name in PLACES or name == RADIUS]
    if len(places) != 1:
        wanted = "x/L, x [m] or r [m]" if more else "x/L or x [m]"
        found = ", ".join(column.head for column in table.columns)
        said = f"expected one column of positions, {wanted}; the heads are {found}"
        raise text.refusal(table.head_line, said)
    check_places(table, places[0])
    return table


def with_station_file(data: dict[str, Any], path: str | PathLike[str]) -> dict[str, Any]:
    """The tables of a scene with the rows of the CSV file that `beam.stations` names, if it names one."""
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


# Records of motions -------------------------------------------------------------------------------


class RecordedQuantity(Quantity):
    """A number of a record, of which there are many in one unit: its conversion is found once."""

    def parse(self, given: object) -> float:
        """Convert to SI."""
        number, _, unit = str(given).partition(" ")
        return float(Decimal(number) * _si_value(unit, self.unit))


@cache
def _si_value(unit: str, of: str) -> Decimal:
    """Size of a unit in SI."""
    return Decimal(repr(quantity(f"1 {unit}", of)))


FILE = "file"
_TIMES = "times"
# Heads beside the keys of the motion.
_RECORD_HEADS = {
    "times": ("t", "time"),
    "speeds": ("speed", "omega"),
    "along_n1": ("n1", "a1"),
    "along_n2": ("n2", "a2"),
    "along_n3": ("n3", "a3"),
}


def with_record_file(data: dict[str, Any], path: str | PathLike[str]) -> dict[str, Any]:
    """The tables of a scene with the columns of the CSV files that its motion names, if it names any.

    Raises
    ------
    ConfigError
        At the first mistake of a file, with the line and what was expected; or if a motion that has no lists
        names a file, or has a list beside it.
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
    """A table of a motion with its lists from the file that it names."""
    if not isinstance(motion.get(FILE), str):
        return motion
    name, known = motion[FILE], _lists_of(motion.get("kind"))
    if not known:
        kinds = " or ".join(f'"{kind}"' for kind in KINDS if _lists_of(kind))
        raise InvalidInput(f"{place}.{FILE}", name, f"this kind of motion has no record; give kind = {kinds}")
    if given := [key for key in known if key in motion]:
        raise InvalidInput(f"{place}.{given[0]}", "", f"the file {name} has it, too; give it once")
    columns = read_record(named_file(path, f"{place}.{FILE}", name), known)
    rest = {key: value for key, value in motion.items() if key != FILE}
    return rest | {key: [SiNumber(value) for value in values] for key, values in columns.items()}


def _lists_of(kind: object) -> dict[str, RecordedQuantity]:
    """The lists of a kind of motion that a record may give, by key."""
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
    """Read the columns of a record, in SI: evenly spaced times, and numbers at each.

    Parameters
    ----------
    path : Path
        The CSV file: a line of heads with units, such as "t [s], n2 [m/s2]", then lines of numbers.
    known : mapping
        What the columns may be, by name; "times" is one.

    Raises
    ------
    ConfigError
        If a head lacks its unit, a cell is no number, or samples are missing: with the line.
    """
    text = read_data(path)
    names = {plain_name(head): key for key in known for head in (key, *_RECORD_HEADS.get(key, ()))}
    table = read_csv(text, known, names)
    columns = {name: column.values for name, column in table.named().items()}
    if unknown := next((column.head for column in table.columns if not column.name), ""):
        raise text.refusal(table.head_line, f"unknown column '{unknown}'; known are {', '.join(known)}")
    if _TIMES not in columns or len(columns) < 2:
        raise text.refusal(table.head_line, f"expected a column t [s], and one of {', '.join(known)}")
    _check_times(table, columns[_TIMES])
    return columns


def _check_times(table: CsvTable, times: tuple[float, ...]) -> None:
    """Refuse times that do not ascend evenly from 0, with the line of the first."""
    try:
        check_record_times("t", times)
    except InvalidValue as error:
        row = times.index(error.value) if error.value in times else 0
        raise table.text.refusal(table.lines[row], str(error)) from None
