"""Reading of blades from CSV files with units in the column headings."""

from __future__ import annotations

import math

import numpy as np

from beamdyn.common.edge.data_text import CsvTable, DataText
from beamdyn.common.edge.inputs import Quantity
from beamdyn.files.decks.blade import Blade, ignore
from beamdyn.files.scenes import RADIUS, read_station_file

_STRUCTURAL_TWIST = ("StrcTwst", "str_tw")  # headings of other programs, whose twist has the opposite sign
_MORE = {RADIUS: Quantity("m"), **dict.fromkeys(_STRUCTURAL_TWIST, Quantity("rad"))}
_NEEDED = ("mass_per_length", "bending_stiffness")
_SECTION = ("width", "thickness")


def is_csv(text: DataText) -> bool:
    """Return whether a text is a table, by its suffix or units in brackets in the first non-comment line."""
    first = next((line for n, line in enumerate(text.lines, 1) if not text.is_comment(n)), "")
    return text.path.suffix.lower() in (".csv", ".tsv") or ("[" in first and any(c in first for c in ",;\t"))


def needs_length(text: DataText) -> bool:
    """Return whether positions are fractions of the length, so that the length must be given."""
    return "x/L" in read_station_file(text, _MORE).named()


def needs_hub_radius(text: DataText) -> bool:
    """Return whether positions are not measured from the axis of rotation: the hub radius is then needed."""
    return RADIUS not in read_station_file(text, _MORE).named()


def read_csv_blade(text: DataText, length: float, hub_radius: float) -> Blade:
    """Read a blade from a CSV table.

    Parameters
    ----------
    text : DataText
        Text of the file.
    length, hub_radius : float
        Length of the blade and radius of the hub [m], if they do not follow from the table.

    Raises
    ------
    ConfigError
        If data are missing or invalid.
    """
    table = read_station_file(text, _MORE)
    stations, length, hub_radius = _positions(table, length, hub_radius)
    return Blade(
        kind="CSV table",
        title="",
        sources=(text.path,),
        length=length,
        hub_radius=hub_radius,
        stations=stations,
        columns=_properties(table),
        ignored=tuple(
            entry
            for column in table.columns
            if not column.name
            for entry in ignore(column.head, column.values, column.unit, "no property of a beam")
        ),
    )


def _positions(table: CsvTable, length: float, hub_radius: float) -> tuple[np.ndarray, float, float]:
    """Return stations x/L, the length, and the radius of the hub [m]."""
    named, text = table.named(), table.text
    if RADIUS in named:
        r = np.array(named[RADIUS].values)
        if r[0] < 0:
            raise text.refusal(table.lines[0], f"expected r of 0 or more at the root, found {r[0]:g} m")
        return _fractions(r - r[0], r[-1] - r[0]), float(r[-1] - r[0]), float(r[0])
    name = "x" if "x" in named else "x/L"
    x = np.array(named[name].values, dtype=float)
    last = 1.0 if name == "x/L" else float(x[-1])
    if x[0] != 0:
        raise text.refusal(table.lines[0], f"expected {name} = 0, the root, found {x[0]:g}")
    if x[-1] != last:
        raise text.refusal(table.lines[-1], f"expected {name} = 1, the tip, found {x[-1]:g}")
    return _fractions(x, last), (last if name == "x" else length), hub_radius


def _fractions(x: np.ndarray, length: float) -> np.ndarray:
    """Compute positions as fractions of the length, rounded like those in scene files."""
    return np.array([round(float(each) / length, 14) for each in x])


def _properties(table: CsvTable) -> dict[str, np.ndarray]:
    named, text = table.named(), table.text
    if given := [named[name].head for name in _SECTION if name in named]:
        said = f"expected columns of stiffness, found {given[0]}; a scene may name this file as beam.stations"
        raise text.refusal(table.head_line, said)
    if missing := [name for name in _NEEDED if name not in named]:
        words = {"mass_per_length": "mass [kg/m]", "bending_stiffness": "EI flap [N m2]"}
        found = ", ".join(column.head for column in table.columns)
        raise text.refusal(table.head_line, f"expected a column {words[missing[0]]}; headings: {found}")
    columns = {name: np.array(column.values, dtype=float) for name, column in named.items()}
    for name in (RADIUS, "x", "x/L"):
        columns.pop(name, None)
    return _with_twist(table, columns)


def _with_twist(table: CsvTable, columns: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Return the columns with the twist in degrees, with the sign convention of this package."""
    senses = {"twist": 1.0, **dict.fromkeys(_STRUCTURAL_TWIST, -1.0)}
    given = [name for name in senses if name in columns]
    if len(given) > 1:
        raise table.text.refusal(table.head_line, f"expected one twist, found {' and '.join(given)}")
    for name in given:
        if "second_bending_stiffness" not in columns:
            said = f"expected a column EI edge [N m2], too, as {name} turns both directions of bending"
            raise table.text.refusal(table.head_line, said)
        degrees = [round(senses[name] * math.degrees(value), 12) for value in columns.pop(name)]
        columns["twist"] = np.array(degrees)
    return columns
