"""Columns of results as data: files, data frames and display units follow from name, unit and values."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from beamdyn.common.results.display_units import DisplayUnits


@dataclass(frozen=True)
class Column:
    """A column of a result.

    Parameters
    ----------
    name : str
        Name as in the heads of files: "relative_error".
    values : sequence
        Numbers in the unit, or words.
    unit : str
        Unit of the values, in SI for a quantity that display units change: "rad/s"; empty of a pure number.
    number : object
        What follows the unit in the head where there are several of a name, such as the number of a mode.
    """

    name: str
    values: np.ndarray | Sequence[Any]
    unit: str = ""
    number: object = ""

    @property
    def head(self) -> str:
        """The head in files: "frequency_Hz_1"."""
        return "_".join(filter(None, (self.name, unit_in_heads(self.unit), str(self.number))))

    def in_units(self, units: DisplayUnits) -> Column:
        """A column of the same values in the display unit of their quantity."""
        shown = {"rad/s": units.speed_unit, "m": lambda: units.length_unit("m")}.get(self.unit)
        if shown is None or (unit := shown()).per_si == 1.0:
            return self
        return replace(self, values=[_scaled(each, unit.per_si) for each in self.cells()], unit=unit.name)

    def cells(self) -> list[Any]:
        """The values as Python's numbers and words."""
        return self.values.tolist() if isinstance(self.values, np.ndarray) else [*self.values]


class Columns:
    """Columns of equal lengths, which are also the rows of a file, heads first.

    Parameters
    ----------
    *columns : Column
        The columns.
    """

    def __init__(self, *columns: Column) -> None:
        self.columns = columns

    def __iter__(self) -> Iterator[Sequence[object]]:
        yield [column.head for column in self.columns]
        yield from zip(*(column.cells() for column in self.columns), strict=True)

    def in_units(self, units: DisplayUnits) -> Columns:
        """A copy in display units; a column stays where another has its quantity in that unit."""
        heads = {column.head for column in self.columns}
        shown = ((column, column.in_units(units)) for column in self.columns)
        return Columns(*(column if new.head in heads else new for column, new in shown))


def columns_of_rows(names: Iterable[tuple[str, str] | str], rows: Iterable[Sequence[Any]]) -> Columns:
    """Columns from rows; names with a unit are pairs of both."""
    heads = [(name, "") if isinstance(name, str) else name for name in names]
    cells = [*zip(*rows, strict=True)] or [()] * len(heads)
    return Columns(*(Column(name, each, unit) for (name, unit), each in zip(heads, cells, strict=True)))


def column_named(name: str, values: np.ndarray | Sequence[Any], unit: str, number: object = "") -> Column:
    """A column of a quantity with a name of its own, such as an input; the head of a rate has "1_per_s"."""
    return Column(f"{name}_1" if unit.startswith("1") else name, values, unit, number)


def unit_in_heads(unit: str) -> str:
    """A unit as a part of a head: "m_per_N"; empty of a pure number."""
    words = unit.replace("/", " per ").split()
    return "_".join(words[1:] if words[:1] == ["1"] else words)


def name_in_heads(name: str, signs: str = ".") -> str:
    """A name as a part of a head: what is no letter, digit or one of the signs becomes "_"."""
    kept = (c if (c.isascii() and c.isalnum()) or c in signs else " " for c in name)
    return "_".join("".join(kept).split())


def _scaled(cell: Any, factor: float) -> Any:
    return cell * factor if isinstance(cell, float | int) else cell


def in_display_units(rows: Iterable[Sequence[object]], units: DisplayUnits) -> Iterable[Sequence[object]]:
    """Rows of a file, heads first, whose columns, if they are known, are in display units in place of SI."""
    return rows.in_units(units) if isinstance(rows, Columns) else rows
