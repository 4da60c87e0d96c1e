"""Tables in CSV files: a line of heads with units, such as "r [m], EI flap [N m2]", then lines of numbers."""

from __future__ import annotations

import csv
import difflib
import re
from collections.abc import Mapping
from dataclasses import dataclass

from beamdyn.common.edge.data_text import DataText, as_decimal, number_at, plain_name, quote, to_number
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput, usual_unit

_INNER = r"(?:[^\[\]()]|\([^\[\]()]*\))*"  # a unit, such as (m/s2)2/Hz
_HEAD = re.compile(rf"\s*([^\[\]()]*?)\s*(?:[\[(]({_INNER})[\])]\s*)?")
_DELIMITERS = ",;\t"


@dataclass(frozen=True)
class CsvColumn:
    """A column of a CSV file.

    Parameters
    ----------
    head : str
        Its head, without the unit.
    name : str
        Name of its quantity, among those asked for; empty if it is none of them.
    unit : str
        Its unit, as written.
    values : tuple of float
        Numbers: in SI where `name` is not empty, else as written.
    """

    head: str
    name: str
    unit: str
    values: tuple[float, ...]


@dataclass(frozen=True)
class CsvTable:
    """The columns of a CSV file.

    Parameters
    ----------
    text : DataText
        The file.
    head_line : int
        Line of the heads.
    lines : tuple of int
        Line of each row.
    columns : tuple of CsvColumn
        The columns, in their order.
    """

    text: DataText
    head_line: int
    lines: tuple[int, ...]
    columns: tuple[CsvColumn, ...]

    def named(self) -> dict[str, CsvColumn]:
        """The columns whose quantity is known, by its name."""
        return {column.name: column for column in self.columns if column.name}


def read_csv(text: DataText, known: Mapping[str, Quantity], names: Mapping[str, str]) -> CsvTable:
    """Read a CSV file.

    Lines that are empty or begin with # or ! are comments.  Columns are separated by commas, semicolons
    or tabs.

    Parameters
    ----------
    text : DataText
        The file.
    known : mapping
        Quantities that columns may have, by name.
    names : mapping
        Names of quantities by the plain names of heads: several heads may stand for one quantity.

    Raises
    ------
    ConfigError
        At the first head or cell that is wrong; the message names file, line, and what was expected.
    """
    lines = [line for line in range(1, len(text.lines) + 1) if not text.is_comment(line)]
    if not lines:
        raise text.lacking("expected a line of heads with units, such as 'x [m], mass [kg/m]'")
    head_line, *rest = lines
    delimiter = _delimiter(text.lines[head_line - 1])
    heads = [
        _ColumnHead.read(text, head_line, cell, known, names) for cell in _cells(text, head_line, delimiter)
    ]
    _check_heads(text, head_line, heads)
    if len(rest) < 2:
        raise text.lacking("expected two rows of numbers at least below the heads")
    rows = [_read_row(text, line, _cells(text, line, delimiter), heads) for line in rest]
    columns = zip(heads, zip(*rows, strict=True), strict=True)
    made = tuple(CsvColumn(head.head, head.name, head.unit, tuple(values)) for head, values in columns)
    return CsvTable(text, head_line, tuple(rest), made)


def _delimiter(heads: str) -> str:
    """The delimiter of the columns: the one that occurs most often outside the brackets of units."""
    outside = re.sub(r"[\[(][^\])]*[\])]", "", heads)
    return max(_DELIMITERS, key=outside.count)


def _cells(text: DataText, line: int, delimiter: str) -> list[str]:
    (cells,) = csv.reader([text.lines[line - 1]], delimiter=delimiter, skipinitialspace=True)
    return [cell.strip() for cell in cells]


@dataclass(frozen=True)
class _ColumnHead:
    head: str
    name: str
    unit: str
    quantity: Quantity

    @classmethod
    def read(
        cls, text: DataText, line: int, cell: str, known: Mapping[str, Quantity], names: Mapping[str, str]
    ) -> _ColumnHead:
        match = _HEAD.fullmatch(cell)
        if match is None or not match[1] or to_number(cell) is not None:
            raise text.refusal(line, f"expected a head such as 'mass [kg/m]', found {quote(cell)}")
        head, unit = match[1], _usual_spelling((match[2] or "").strip())
        plain = plain_name(head)
        name = names.get(plain, "")
        if not name:
            if near := difflib.get_close_matches(plain, names, n=1, cutoff=0.8):
                meant = names[near[0]]
                raise text.refusal(line, f"unknown column {quote(head)}; did you mean {meant}?")
            return cls(head, "", unit, Quantity())
        _check_unit(text, line, head, unit, known[name])
        return cls(head, name, "" if unit in ("-", "1") else unit, known[name])


def _usual_spelling(unit: str) -> str:
    """A unit in the spelling read elsewhere: N m2 for Nm^2 and N-m^2, as in files on wind turbines."""
    return re.sub(r"\b([kMG]?N)m(?![a-z])", r"\1 m", re.sub(r"(?<=[A-Za-z])-(?=[A-Za-z])", " ", unit))


def _check_unit(text: DataText, line: int, head: str, unit: str, quantity: Quantity) -> None:
    """Refuse a unit that is missing, unknown or of another kind."""
    wanted = quantity.unit
    if not wanted:
        if unit not in ("", "-", "1"):
            raise text.refusal(line, f"expected {head} without a unit, found [{unit}]")
        return
    expected = f"expected a unit like [{usual_unit(wanted)}] for {head}"
    if not unit:
        raise text.refusal(line, f"{expected}, found none")
    try:
        quantity.convert(f"1 {unit}")
    except InvalidInput as error:
        said = error.bound.partition(";")[0]
        raise text.refusal(line, f"{expected}, found [{unit}]: {said}") from None


def _check_heads(text: DataText, line: int, heads: list[_ColumnHead]) -> None:
    names = [head.name or plain_name(head.head) for head in heads]
    for k, name in enumerate(names):
        if name in names[:k]:
            first = heads[names.index(name)].head
            raise text.refusal(line, f"{quote(heads[k].head)} is the same column as {quote(first)}; give one")


def _read_row(text: DataText, line: int, cells: list[str], heads: list[_ColumnHead]) -> list[float]:
    if len(cells) == len(heads) + 1 and not cells[-1]:  # some programs end each line with a separator
        cells = cells[:-1]
    if len(cells) != len(heads):
        raise text.refusal(line, f"expected {len(heads)} cells under the heads, found {len(cells)}")
    return [_read_cell(text, line, cell, head) for cell, head in zip(cells, heads, strict=True)]


def _read_cell(text: DataText, line: int, cell: str, head: _ColumnHead) -> float:
    """A number: in SI where the column is known."""
    number = number_at(text, line, cell, f"{head.head} [{head.unit}]" if head.unit else head.head)
    if not head.name:
        return number
    try:
        written = as_decimal(cell)
        return head.quantity.parse(f"{written} {head.unit}" if head.quantity.unit else number)
    except InvalidInput as error:
        raise text.refusal(line, f"{head.head} = {cell} {head.unit}".rstrip() + f": {error.bound}") from None


def check_places(table: CsvTable, name: str) -> None:
    """Refuse positions that do not ascend; a position given twice with other values is a jump.

    Parameters
    ----------
    table : CsvTable
        The table.
    name : str
        Name of the column of positions.

    Raises
    ------
    ConfigError
        If a position follows a greater one, is repeated without a jump, or is given three times.
    """
    column, rows = table.named()[name], list(zip(*(c.values for c in table.columns), strict=True))
    x, last = column.values, len(rows) - 1
    for k in range(1, len(rows)):
        if x[k] > x[k - 1]:
            continue
        here, before = f"{column.head} = {x[k]:g}", table.lines[k - 1]
        if x[k] < x[k - 1]:
            said = f"{here} follows {x[k - 1]:g} in line {before}; expected positions that ascend"
        elif rows[k] == rows[k - 1]:
            said = (
                f"it repeats line {before}; expected each position once, or twice with a jump in a property"
            )
        elif k in (1, last) or x[k] == x[k - 2]:
            said = f"{here} stands in line {before}, too; expected a jump to stand between other stations"
        else:
            continue
        raise table.text.refusal(table.lines[k], said)
