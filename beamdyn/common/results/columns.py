"""Columns of results as data: name, unit and values, from which files, data frames and tables follow."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from operator import attrgetter
from typing import Any

import numpy as np

from beamdyn.common.results.display_units import DisplayUnits


@dataclass(frozen=True)
class Column:
    """A column of a result, from which its place in tables, files and data frames follows.

    Parameters
    ----------
    name : str
        Name as in the heads of files: "relative_error".
    values : sequence
        Numbers in the unit, or words.
    unit : str
        Unit of the values, in SI for a quantity that display units change: "rad/s"; empty of a pure number.
    number : object
        Text after the unit in the head, which tells columns of one name apart, such as the number of a mode.
    error : ndarray, optional
        Absolute errors of the values [unit]: tables show the digits that these support.
    beyond : ndarray, optional
        Larger errors [unit], such as the model errors: tables dim the digits that these do not support.
    form : str or callable, optional
        How tables write a value: a format, or ``form(value, error)``; by default with the digits that its
        error supports, or six.
    cells : sequence, optional
        What tables show in place of the values, whatever their unit; None shows the value itself.
    words : str, optional
        Head in tables, without the unit; if "", the name in words and the number.  None keeps the column out
        of tables.
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
        """Head of the column in files: "frequency_Hz_1"."""
        return "_".join(filter(None, (self.name, unit_in_heads(self.unit), str(self.number))))

    @property
    def title(self) -> str:
        """Head of the column in tables: "frequency [Hz]"."""
        words = self.words or f"{self.name.replace('_', ' ')} {self.number}".rstrip()
        return f"{words} [{self.unit}]" if self.unit else words

    @property
    def plain(self) -> list[Any]:
        """Values as Python's numbers and words."""
        return self.values.tolist() if isinstance(self.values, np.ndarray) else [*self.values]

    def in_units(self, units: DisplayUnits, usual: str = "m") -> Column:
        """Convert the column to the display unit of its quantity; lengths to `usual` if none is set."""
        shown = {"rad/s": units.speed_unit, "m": lambda: units.length_unit(usual)}.get(self.unit)
        return self if shown is None else self.times(shown().per_si, shown().name)

    def times(self, factor: float, unit: str) -> Column:
        """Multiply the values, if they are numbers, by a factor; name the unit that they then have."""
        if factor == 1.0:
            return self
        values = [each * factor if isinstance(each, float | int) else each for each in self.plain]
        error, beyond = (None if each is None else each * factor for each in (self.error, self.beyond))
        return replace(self, values=values, unit=unit, error=error, beyond=beyond)

    def at(self, rows: Sequence[int] | np.ndarray) -> Column:
        """Return the column with only some rows, which count from 0."""
        values, cells = (each and [each[row] for row in rows] for each in (self.plain, self.cells))
        error, beyond = (None if each is None else each[rows] for each in (self.error, self.beyond))
        return replace(self, values=values, error=error, beyond=beyond, cells=cells)


class Columns:
    """Columns of equal lengths, which are also the rows of a file, heads first.

    Parameters
    ----------
    *columns : Column
        The columns.
    title, note : str
        Title of their table, and the sentences below it, a line each.
    """

    def __init__(self, *columns: Column, title: str = "", note: str = "") -> None:
        self.columns, self.title, self.note = columns, title, note

    def __iter__(self) -> Iterator[Sequence[Any]]:
        yield [column.head for column in self.columns]
        yield from zip(*(column.plain for column in self.columns), strict=True)

    def at(self, rows: Sequence[int] | np.ndarray) -> Columns:
        """Return the columns with only some rows, which count from 0."""
        return Columns(*(column.at(rows) for column in self.columns), title=self.title, note=self.note)

    def in_units(self, units: DisplayUnits) -> Columns:
        """Convert to display units; a column is kept where another has its quantity in the display unit."""
        heads = {column.head for column in self.columns}
        shown = ((column, column.in_units(units)) for column in self.columns)
        return Columns(*(column if new.head in heads else new for column, new in shown))


def columns_of_rows(names: Iterable[tuple[str, str] | str], rows: Iterable[Sequence[Any]]) -> Columns:
    """Make columns from rows; names with a unit are given as pairs."""
    heads = [(name, "") if isinstance(name, str) else name for name in names]
    cells = [*zip(*rows, strict=True)] or [()] * len(heads)
    return Columns(*(Column(name, each, unit) for (name, unit), each in zip(heads, cells, strict=True)))


def column_named(
    name: str, values: np.ndarray | Sequence[Any], unit: str, number: object = "", **shown: Any
) -> Column:
    """Make a column with the name of its quantity, such as an input; in 1/s its head ends with "1_per_s"."""
    return Column(f"{name}_1" if unit.startswith("1") else name, values, unit, number, **shown)


def attributes(things: Iterable[Any], path: str) -> list[Any]:
    """Return an attribute, such as "line.name", of each of several objects."""
    return [*map(attrgetter(path), things)]


def unit_in_heads(unit: str) -> str:
    """Return a unit as a part of a head, such as "m_per_N"; empty for a pure number."""
    words = unit.replace("/", " per ").split()
    return "_".join(words[1:] if words[:1] == ["1"] else words)


def name_in_heads(name: str, signs: str = ".") -> str:
    """Return a name as a part of a head: all but letters, digits and given signs become "_"."""
    kept = (c if (c.isascii() and c.isalnum()) or c in signs else " " for c in name)
    return "_".join("".join(kept).split())
