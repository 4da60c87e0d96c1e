"""Columns of results as data, and the units in which they are shown; all other values are in SI units.

A column has a name, a unit and values.  Tables, files, data frames and pictures are made from columns.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from functools import cache
from math import pi
from operator import attrgetter
from typing import Any, NamedTuple, Self, get_args, get_type_hints

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, one_of
from beamdyn.common.results.one_line import known_digits, spanned

# For each kind of quantity: how many of each display unit make one SI unit; the SI unit is first.
_PER_SI = {
    "speed": {"rad/s": 1.0, "rpm": 30 / pi, "deg/s": 180 / pi},
    "length": {"m": 1.0, "mm": 1e3, "cm": 1e2, "um": 1e6, "in": 1 / 0.0254, "ft": 1 / 0.3048},
}


class ShownUnit(NamedTuple):
    """A display unit and its conversion factor.

    Parameters
    ----------
    name : str
        Name of the unit, such as "rpm".
    per_si : float
        Number of this unit in one SI unit.
    """

    name: str
    per_si: float

    def of(self, values: Any) -> Any:
        """Convert values from SI units to this display unit."""
        return values * self.per_si

    def say(self, value: float, digits: int = 6) -> str:
        """Format a value, given in SI units, in this display unit."""
        return f"{known_digits(value * self.per_si):.{digits}g} {self.name}"


@dataclass(frozen=True)
class DisplayUnits:
    """Units in which speeds and lengths are shown.

    Parameters
    ----------
    speed : {"", "rad/s", "rpm", "deg/s"}
        Unit of rotational speeds; "" for the default, rad/s.
    length : {"", "m", "mm", "cm", "um", "in", "ft"}
        Unit of lengths; "" for the usual unit of each quantity, such as mm for deflections.

    Raises
    ------
    ValueError
        If a unit is not known.

    Examples
    --------
    >>> scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), units=bd.DisplayUnits(speed="rpm"))
    >>> scene.units.speed
    'rpm'
    """

    speed: str = ""
    length: str = ""

    def __post_init__(self) -> None:
        for kind, known in _PER_SI.items():
            one_of(f"units.{kind}", getattr(self, kind), ("", *known))

    @classmethod
    def of(cls, given: DisplayUnits | Mapping[str, str] | None) -> DisplayUnits:
        """Make display units from a mapping such as {"speed": "rpm"}.

        Raise a ValueError for a key other than "speed" and "length".
        """
        if isinstance(given, cls):
            return given
        kinds = [each.name for each in fields(cls)]
        remedy = 'give a dictionary such as {"speed": "rpm", "length": "mm"}'
        if given is not None and not isinstance(given, Mapping):
            raise InvalidValue("units", given, "", remedy)
        for kind in given or {}:
            if kind not in kinds:
                raise InvalidValue("units", kind, f"it is none of {', '.join(kinds)}", remedy)
        return cls(**(given or {}))

    def with_others(self, given: DisplayUnits | Mapping[str, str] | None) -> DisplayUnits:
        """Return a copy of the display units in which some are replaced by the given ones."""
        new = DisplayUnits.of(given)
        return DisplayUnits(new.speed or self.speed, new.length or self.length)

    def speed_unit(self) -> ShownUnit:
        """Return the display unit of rotational speeds; rad/s if none was chosen."""
        return self._unit("speed", "rad/s")

    def length_unit(self, usual: str = "mm") -> ShownUnit:
        """Return the display unit of lengths; the given usual unit if none was chosen."""
        return self._unit("length", usual)

    def _unit(self, kind: str, usual: str) -> ShownUnit:
        name = getattr(self, kind) or usual
        return ShownUnit(name, _PER_SI[kind][name])


SI_UNITS = DisplayUnits()


class InDisplayUnits:
    """Base of classes whose numbers are shown in display units, by default those of their scene."""

    @property
    def display_units(self) -> DisplayUnits:
        """Return the units of tables, columns and pictures: chosen by `in_units`, else those of the scene."""
        given = vars(self).get("_display_units")
        return given or getattr(getattr(self, "scene", None), "units", SI_UNITS)

    def say_speed(self, speeds: np.ndarray | float) -> str:
        """Format a speed [rad/s], or the range of several speeds, in its display unit."""
        unit = self.display_units.speed_unit()
        return spanned(np.multiply(speeds, unit.per_si), unit.name)

    def say_length(self, lengths: np.ndarray | float) -> str:
        """Format a length [m], or the range of several lengths, in its display unit."""
        unit = self.display_units.length_unit()
        return spanned(np.multiply(lengths, unit.per_si), unit.name)

    def in_units(self, speed: str = "", length: str = "") -> Self:
        """Return a copy with other units in tables, columns and pictures; its numbers stay in SI units.

        Parameters
        ----------
        speed : {"rad/s", "rpm", "deg/s"}, optional
            Unit of rotational speeds.
        length : {"m", "mm", "cm", "um", "in", "ft"}, optional
            Unit of lengths.

        Raises
        ------
        ValueError
            If a unit is not known.
        """
        shown = object.__new__(type(self))
        vars(shown).update(vars(self))
        units = self.display_units.with_others({"speed": speed, "length": length})
        object.__setattr__(shown, "_display_units", units)
        return shown


def known_unit(kind: str, name: str) -> str:
    """Return the name of a display unit of a kind of quantity; "" if the kind has no such unit."""
    name = name.replace(" ", "")
    return name if name in _PER_SI[kind] else ""


# Columns ---------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Column:
    """A column of a result, used in tables, files and data frames.

    Parameters
    ----------
    name : str
        Name as in the column headings of files: "relative_error".
    values : sequence
        Numbers in the unit, or words.
    unit : str
        Unit of the values; an SI unit such as "rad/s" for quantities with display units; empty for a pure
        number.
    number : object
        Text after the unit in the heading, such as the number of a mode, by which columns of the same name
        differ.
    error : ndarray, optional
        Absolute errors of the values [unit]: tables show no digits that are smaller than these errors.
    beyond : ndarray, optional
        Larger errors [unit], such as model errors: tables dim digits that are smaller than these errors.
    form : str or callable, optional
        How tables format a value: a format string, or a function ``form(value, error)``; by default with the
        digits that the error supports, or with six digits.
    cells : sequence, optional
        Texts that tables show in place of the values, in any display unit; None shows the value itself.
    words : str, optional
        Heading in tables, without the unit; "" for the name in words and the number.  None omits the column
        from tables.
    """

    name: str
    values: np.ndarray | Sequence[Any]
    unit: str = ""
    number: object = ""
    error: np.ndarray | None = None
    beyond: np.ndarray | None = None
    form: str | Callable[[float, float], str] | None = None
    cells: Sequence[Any] | None = None
    words: str | None = ""

    @property
    def head(self) -> str:
        """Return the heading of the column in files, such as "frequency_Hz_1"."""
        return "_".join(filter(None, (self.name, unit_in_heads(self.unit), str(self.number))))

    @property
    def title(self) -> str:
        """Return the heading of the column in tables, such as "frequency [Hz]"."""
        words = self.words or f"{self.name.replace('_', ' ')} {self.number}".rstrip()
        return f"{words} [{self.unit}]" if self.unit else words

    @property
    def plain(self) -> list[Any]:
        """Return the values as Python numbers and texts."""
        return self.values.tolist() if isinstance(self.values, np.ndarray) else [*self.values]

    def in_units(self, units: DisplayUnits, usual: str = "m") -> Column:
        """Convert the column to the display unit of its quantity; lengths to `usual` if none is chosen."""
        shown = {"rad/s": units.speed_unit, "m": lambda: units.length_unit(usual)}.get(self.unit)
        return self if shown is None else self.times(shown().per_si, shown().name)

    def times(self, factor: float, unit: str) -> Column:
        """Multiply the values, if they are numbers, by a factor; set the unit of the product."""
        if factor == 1.0:
            return self
        values = [each * factor if isinstance(each, float | int) else each for each in self.plain]
        error, beyond = (None if each is None else each * factor for each in (self.error, self.beyond))
        return replace(self, values=values, unit=unit, error=error, beyond=beyond)

    def at(self, rows: Sequence[int] | np.ndarray) -> Column:
        """Return the column with only the given rows, which are counted from 0."""
        values, cells = (each and [each[row] for row in rows] for each in (self.plain, self.cells))
        error, beyond = (None if each is None else each[rows] for each in (self.error, self.beyond))
        return replace(self, values=values, error=error, beyond=beyond, cells=cells)


class Columns:
    """Columns of equal length, which are also the rows of a file, headings first.

    Parameters
    ----------
    *columns : Column
        The columns.
    title, note : str
        Title of the table, and the text below it, one sentence per line.
    """

    def __init__(self, *columns: Column, title: str = "", note: str = "") -> None:
        self.columns, self.title, self.note = columns, title, note

    def __iter__(self) -> Iterator[Sequence[Any]]:
        yield [column.head for column in self.columns]
        yield from zip(*(column.plain for column in self.columns), strict=True)

    def at(self, rows: Sequence[int] | np.ndarray) -> Columns:
        """Return the columns with only the given rows, which are counted from 0."""
        return Columns(*(column.at(rows) for column in self.columns), title=self.title, note=self.note)

    def in_units(self, units: DisplayUnits) -> Columns:
        """Convert columns to display units, unless another column has the quantity in this unit already."""
        heads = {column.head for column in self.columns}
        shown = ((column, column.in_units(units)) for column in self.columns)
        return Columns(*(column if new.head in heads else new for column, new in shown))


def columns_of_rows(names: Iterable[tuple[str, str] | str], rows: Iterable[Sequence[Any]]) -> Columns:
    """Make columns from rows; the name of a column with a unit is given as a pair (name, unit)."""
    heads = [(name, "") if isinstance(name, str) else name for name in names]
    cells = [*zip(*rows, strict=True)] or [()] * len(heads)
    return Columns(*(Column(name, each, unit) for (name, unit), each in zip(heads, cells, strict=True)))


def column_named(
    name: str, values: np.ndarray | Sequence[Any], unit: str, number: object = "", **shown: Any
) -> Column:
    """Make a column; for a unit such as 1/s, the name gets "_1", so that its heading ends with "_1_per_s"."""
    return Column(f"{name}_1" if unit.startswith("1") else name, values, unit, number, **shown)


def attributes(things: Iterable[Any], path: str) -> list[Any]:
    """Return the value of an attribute path, such as "line.name", for each of several objects."""
    return [*map(attrgetter(path), things)]


def unit_in_heads(unit: str) -> str:
    """Return a unit as a part of a column heading, such as "m_per_N"; empty for a pure number."""
    words = unit.replace("/", " per ").split()
    return "_".join(words[1:] if words[:1] == ["1"] else words)


def name_in_heads(name: str, signs: str = ".") -> str:
    """Return a name as a part of a column heading: "_" replaces all but letters, digits and `signs`."""
    kept = (c if (c.isascii() and c.isalnum()) or c in signs else " " for c in name)
    return "_".join("".join(kept).split())


# Meanings of scalar results --------------------------------------------------------------------------


@dataclass(frozen=True)
class Meaning:
    """Meaning of a scalar result, for ``Annotated[float, Meaning("m", "stopping distance")]``.

    Parameters
    ----------
    unit : str
        SI unit; "" for a dimensionless number.
    words : str
        Meaning of the number: a phrase without a full stop.
    shown : str
        Display unit, if it is not the SI unit, such as "mm".
    """

    unit: str
    words: str
    shown: str = ""


@cache
def meanings(kind: type) -> dict[str, Meaning]:
    """Return the `Meaning` objects of the fields of a result's class, in order."""
    hints = get_type_hints(kind, include_extras=True).items()
    stated = ((name, part) for name, hint in hints for part in get_args(hint) if isinstance(part, Meaning))
    return dict(stated)


def evenly_spread(count: int, most: int) -> np.ndarray:
    """Select at most `most` of `count` indices: evenly spaced, ascending, with the first and the last."""
    return np.unique(np.linspace(0, count - 1, min(count, most)).round().astype(int))
