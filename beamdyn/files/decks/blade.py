"""Descriptions of blades in the terms of this package, whatever program wrote the input file (deck)."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

from beamdyn.common.edge.data_text import (
    DataText,
    NamedValue,
    named_count,
    number_at,
    plain_name,
    quote,
    to_number,
)

_COMMENT = re.compile(r"[!#].*")
_UNIT = re.compile(r"\(([^()]*)\)")


@dataclass(frozen=True)
class DeckColumn:
    """A column that a program's input files may have.

    Parameters
    ----------
    name : str
        Heading of the column in the program's manual.
    unit : str
        Unit that the program assumes; "-" for a dimensionless number.
    required : bool
        Whether the program requires the column.
    positive : bool
        Whether the values must be greater than zero.
    """

    name: str
    unit: str
    required: bool = False
    positive: bool = False


@dataclass(frozen=True)
class Stations:
    """The table of stations (cross-sections along the blade) in a deck.

    Parameters
    ----------
    columns : dict of ndarray, shape (n,)
        Values by name of the column, in the unit of the program.
    units : dict of str
        Unit of each column.
    lines : tuple of int, shape (n,)
        Line number of each row in the file.
    """

    columns: dict[str, np.ndarray]
    units: dict[str, str]
    lines: tuple[int, ...]


def read_stations(text: DataText, known: Sequence[DeckColumn], count: NamedValue) -> Stations:
    """Read the table of stations (cross-sections along the blade) in a file.

    Parameters
    ----------
    text : DataText
        Text of the file.
    known : sequence of DeckColumn
        Columns that the program knows; the first one is the position, from 0 at the root to 1 at the tip.
    count : NamedValue
        Number of rows according to the file.

    Raises
    ------
    ConfigError
        If headings, units, rows or the number of rows are invalid.
    """
    head_line = _find_heads(text, known, count)
    heads = _read_heads(text, head_line, {plain_name(column.name): column for column in known})
    _check_units(text, head_line + 1, heads)
    rows, lines = _read_rows(text, head_line + 2, heads, count)
    columns = {column.name: rows[:, place].copy() for place, column in enumerate(heads)}
    check_order(text, lines, heads[0].name, columns[heads[0].name])
    for column in heads:
        values = columns[column.name]
        if column.positive and (bad := np.flatnonzero(values <= 0)).size:
            found = f"{values[bad[0]]:g} {column.unit}"
            raise text.refusal(lines[bad[0]], f"expected {column.name} above 0, found {found}")
    return Stations(columns, {column.name: column.unit for column in heads}, lines)


def _find_heads(text: DataText, known: Sequence[DeckColumn], count: NamedValue) -> int:
    """Find the line of the column headings: its first word is the heading of the position."""
    first = plain_name(known[0].name)
    for line in range(count.line + 1, len(text.lines) + 1):
        if [plain_name(word) for word in text.words(line)[:1]] == [first]:
            return line
    wanted = " ".join(column.name for column in known if column.required)
    raise text.lacking(f"expected a line of headings below line {count.line}, such as '{wanted}'")


def _read_heads(text: DataText, line: int, known: Mapping[str, DeckColumn]) -> list[DeckColumn]:
    words = _COMMENT.sub("", text.lines[line - 1]).split()
    heads = [known.get(plain_name(word), DeckColumn(word, "?")) for word in words]
    names = [column.name for column in heads]
    if twice := next((name for name in names if names.count(name) > 1), ""):
        raise text.refusal(line, f"{twice} stands twice; expected each column heading once")
    if missing := [c.name for c in known.values() if c.required and c.name not in names]:
        raise text.refusal(
            line, f"expected a column {missing[0]}; the headings are {', '.join(names)}{_rest(missing)}"
        )
    return heads


def _rest(missing: Sequence[str]) -> str:
    return f" ({', '.join(missing[1:])} missing, too)" if len(missing) > 1 else ""


def _check_units(text: DataText, line: int, heads: Sequence[DeckColumn]) -> None:
    """Raise an error if the line below the headings does not contain their units.

    The programs ignore this line, and always assume their own units.
    """
    content = text.lines[line - 1] if line <= len(text.lines) else ""
    units = _UNIT.findall(content)
    if not units:
        said = "expected the units of the columns in brackets, such as '(-) (deg) (kg/m)'"
        raise text.refusal(min(line, len(text.lines)), f"{said}; the program skips this line unread")
    if len(units) != len(heads):
        raise text.refusal(line, f"expected {len(heads)} units for the headings above, found {len(units)}")
    for column, unit in zip(heads, units, strict=True):
        if column.unit != "?" and _plain_unit(unit) != _plain_unit(column.unit):
            said = f"expected ({column.unit or '-'}) for {column.name}, found ({unit})"
            raise text.refusal(line, f"{said}; the program takes the numbers in its own unit in any case")


def _plain_unit(unit: str) -> str:
    """Return a unit in a uniform notation: N-m^2 becomes Nm2."""
    return re.sub(r"[\s^*·.-]", "", unit).lower().replace("²", "2")


def _read_rows(
    text: DataText, first: int, heads: Sequence[DeckColumn], count: NamedValue
) -> tuple[np.ndarray, tuple[int, ...]]:
    """Read the numbers of the table, shape (rows, columns), and the line number of each row."""
    wanted = named_count(text, count)
    said = f"{count.name} = {wanted} in line {count.line}"
    rows: list[list[float]] = []
    lines: list[int] = []
    for line in range(first, len(text.lines) + 1):
        words = _COMMENT.sub("", text.lines[line - 1]).replace(",", " ").split()
        if not words:
            continue
        if len(rows) == wanted:
            if len(words) >= len(heads) and all(to_number(word) is not None for word in words[: len(heads)]):
                raise text.refusal(line, f"a row of numbers after the last of {wanted} stations: {said}")
            break
        if to_number(words[0]) is None and to_number(words[-1]) is None:
            raise text.refusal(
                line, f"expected row {len(rows) + 1} of the stations, found {quote(words[0])}: {said}"
            )
        rows.append(_read_row(text, line, words, heads))
        lines.append(line)
    if len(rows) < wanted:
        raise text.lacking(f"expected row {len(rows) + 1} of the stations: {said}")
    return np.array(rows), tuple(lines)


def _read_row(text: DataText, line: int, words: Sequence[str], heads: Sequence[DeckColumn]) -> list[float]:
    numbers = len(words) if len(words) > len(heads) and to_number(words[len(heads)]) is not None else 0
    if len(words) < len(heads) or numbers:
        comma = "; write decimal points: a comma separates numbers" if "," in text.lines[line - 1] else ""
        found = numbers or len(words)
        raise text.refusal(line, f"expected {len(heads)} numbers under the headings, found {found}{comma}")
    return [number_at(text, line, word, column.name) for word, column in zip(words, heads, strict=False)]


def check_order(text: DataText, lines: Sequence[int], name: str, stations: np.ndarray) -> None:
    """Raise an error unless the stations ascend from 0 at the root to 1 at the tip without repetition."""
    for k in range(1, len(stations)):
        here, before = stations[k], stations[k - 1]
        if here <= before:
            what = "repeats the station" if here == before else f"follows {before:g}"
            said = f"{name} = {here:g} {what} of line {lines[k - 1]}; expected stations that ascend"
            raise text.refusal(lines[k], said)
    if stations[0] != 0:
        raise text.refusal(lines[0], f"expected {name} = 0, the root, found {stations[0]:g}")
    if stations[-1] != 1:
        raise text.refusal(lines[-1], f"expected {name} = 1, the tip, found {stations[-1]:g}")


# Blades -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class IgnoredProperty:
    """A property in a deck that the scene cannot hold.

    Parameters
    ----------
    name : str
        Name of the property in the deck.
    low, high : float
        Smallest and largest value [unit].
    unit : str
        Unit, as written in the deck.
    reason : str
        Why the property is ignored, or how it can be included.

    Examples
    --------
    >>> left_out = bd.IgnoredProperty("torsional stiffness", 1e5, 5e9, "N m2", "no torsion is modelled")
    >>> left_out.sentence()
    'torsional stiffness (100000 to 5e+09 N m2): no torsion is modelled'
    """

    name: str
    low: float
    high: float
    unit: str
    reason: str

    @property
    def values(self) -> str:
        """Return the value or the range of values, with the unit."""
        ends = dict.fromkeys(f"{value:.6g}" for value in (self.low, self.high))
        return f"{' to '.join(ends)} {self.unit}".rstrip()

    def sentence(self) -> str:
        """Describe the property: name, values and reason."""
        return f"{self.name} ({self.values}): {self.reason}"


@dataclass(frozen=True)
class BladeMatrices:
    """Stiffness and mass matrices (6 x 6) of a blade's cross-sections, ordered as in `SectionMatrices`.

    Parameters
    ----------
    stations : ndarray, shape (n,)
        Positions x/L.
    stiffness, mass : ndarray, shape (n, 6, 6)
        Stiffness and mass matrices, in SI units.
    """

    stations: np.ndarray
    stiffness: np.ndarray
    mass: np.ndarray


@dataclass(frozen=True)
class Blade:
    """A blade as described in a deck (input file of another program).

    Parameters
    ----------
    kind : str
        Kind of deck.
    title : str
        Title in the deck; may be empty.
    sources : tuple of Path
        The files that were read, the main file first.
    length, hub_radius : float
        Length of the blade and distance of its root from the axis of rotation [m].
    stations : ndarray, shape (n,)
        Positions x/L.
    columns : dict of ndarray, shape (n,)
        Properties, by name of the argument of `Beam.from_stiffness`, in SI units, but angles in degrees.
    tip : dict of float
        Arguments of `TipMass`, for a body at the tip.
    pitch : float
        Pitch angle of the whole blade, positive towards feather [deg].
    precone : float
        Angle between the blade and the plane of rotation, positive downwind [deg].
    speed : float
        Rotational speed in the deck [rpm]; 0 if none is given.
    damping : float
        Damping ratio of all modes; 0 if the deck gives none, or different ones.
    polynomials : dict of ndarray, shape (5,)
        Coefficients of x/L to the powers 2 to 6 of the mode shapes in the deck, by name of the mode, such as
        "flap 1".
    ignored : tuple of IgnoredProperty
        Properties in the deck that this object cannot hold.
    doubts : tuple of str
        Sentences on data that the program for which the deck was written would read differently.
    matrices : BladeMatrices, optional
        Matrices of the cross-sections, which replace the properties.
    """

    kind: str
    title: str
    sources: tuple[Path, ...]
    length: float
    hub_radius: float
    stations: np.ndarray
    columns: dict[str, np.ndarray]
    tip: dict[str, float] = field(default_factory=dict)
    pitch: float = 0.0
    precone: float = 0.0
    speed: float = 0.0
    damping: float = 0.0
    polynomials: dict[str, np.ndarray] = field(default_factory=dict)
    ignored: tuple[IgnoredProperty, ...] = ()
    doubts: tuple[str, ...] = ()
    matrices: BladeMatrices | None = None


def ignore(name: str, values: float | Sequence[float] | np.ndarray, unit: str, reason: str) -> tuple:
    """Record an ignored property with its range; return an empty tuple if all its values are zero."""
    array = np.atleast_1d(np.asarray(values, dtype=float))
    if not array.any():
        return ()
    return (IgnoredProperty(name, float(array.min()), float(array.max()), unit, reason),)


def ignore_columns(
    table: Stations, used: Sequence[str], reasons: Mapping[str, str]
) -> tuple[IgnoredProperty, ...]:
    """Record the columns of a table that the scene cannot hold: all except those in `used`."""
    return tuple(
        entry
        for name, values in table.columns.items()
        if name not in used
        for entry in ignore(
            name, values, table.units[name].replace("?", "").strip("-"), reasons.get(name, "unknown column")
        )
    )
