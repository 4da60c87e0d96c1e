"""Reading of CSV files: a line of heads with units, such as "r [m], EI flap [N m2]", then numbers."""

from __future__ import annotations

import csv
import difflib
import math
import re
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from typing import NamedTuple

from beamdyn.common.edge.data_text import DataText, as_decimal, number_at, plain_name, quote, to_number
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput, usual_unit

_INNER = r"(?:[^\[\]()]|\([^\[\]()]*\))*"  # pattern of the text within brackets, such as the unit (m/s2)2/Hz
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
        Numbers: in SI where `name` is not empty, else as written; nan where a cell may be empty, and is.
    written : tuple of str
        The cells as written.
    """

    head: str
    name: str
    unit: str
    values: tuple[float, ...]
    written: tuple[str, ...]


@dataclass(frozen=True)
class CsvTable:
    """The columns of a CSV file.

    Parameters
    ----------
    text : DataText
        The file.
    head_line : int
        Number of the line with the heads.
    lines : tuple of int
        Line number of each row.
    columns : tuple of CsvColumn
        The columns, in their order.
    """

    text: DataText
    head_line: int
    lines: tuple[int, ...]
    columns: tuple[CsvColumn, ...]

    def named(self) -> dict[str, CsvColumn]:
        """Return the columns whose quantity is known, by its name."""
        return {column.name: column for column in self.columns if column.name}


def read_csv(
    text: DataText,
    known: Mapping[str, Quantity],
    names: Mapping[str, str],
    may_lack: Collection[str] = (),
    least_rows: int = 2,
) -> CsvTable:
    """Read a CSV file with heads and units.

    Lines that are empty or begin with # or ! are comments.  Columns are separated by commas, semicolons
    or tabs.

    Parameters
    ----------
    text : DataText
        The file.
    known : mapping
        Quantities that columns may have, by name.
    names : mapping
        Names of quantities by heads, as `plain_name` writes these; several may stand for one quantity.
    may_lack : collection of str
        Quantities whose cells may be empty.
    least_rows : int
        Fewest rows of numbers.

    Raises
    ------
    ConfigError
        At the first head or cell that is wrong; the message names file, line, and what was expected.
    """
    lines = [line for line in range(1, len(text.lines) + 1) if not text.is_comment(line)]
    if not lines:
        raise text.lacking("expected a line of heads with their units in brackets")
    head_line, *rest = lines
    # The head line without the brackets of units, in which separators do not count.
    outside = re.sub(r"[\[(][^\])]*[\])]", "", text.lines[head_line - 1])
    delimiter = max(_DELIMITERS, key=outside.count)
    heads = [_read_head(text, head_line, cell, known, names) for cell in _cells(text, head_line, delimiter)]
    plain = [head.name or plain_name(head.head) for head in heads]
    for k, name in enumerate(plain):
        if name in plain[:k]:
            same, first = quote(heads[k].head), quote(heads[plain.index(name)].head)
            raise text.refusal(head_line, f"{same} is the same column as {first}; give one")
    if len(rest) < least_rows:
        count = {1: "a row", 2: "two rows"}.get(least_rows, f"{least_rows} rows")
        raise text.lacking(f"expected {count} of numbers at least below the heads")
    cells = [_row_of_cells(text, line, _cells(text, line, delimiter), heads) for line in rest]
    rows = [_read_row(text, line, each, heads, may_lack) for line, each in zip(rest, cells, strict=True)]
    columns = zip(heads, zip(*rows, strict=True), zip(*cells, strict=True), strict=True)
    made = tuple(CsvColumn(head.head, head.name, head.unit, values, each) for head, values, each in columns)
    return CsvTable(text, head_line, tuple(rest), made)


def _cells(text: DataText, line: int, delimiter: str) -> list[str]:
    try:
        (cells,) = csv.reader([text.lines[line - 1]], delimiter=delimiter, skipinitialspace=True)
    except csv.Error:  # a cell longer than csv's limit, as in a long line of text without separators
        most = csv.field_size_limit()
        raise text.refusal(line, f"a cell has more than {most} characters; give a number in each") from None
    return [cell.strip() for cell in cells]


class _ColumnHead(NamedTuple):
    """A head as written: name of its quantity (empty if not known), unit, and the quantity itself."""

    head: str
    name: str
    unit: str
    quantity: Quantity


def _read_head(
    text: DataText, line: int, cell: str, known: Mapping[str, Quantity], names: Mapping[str, str]
) -> _ColumnHead:
    """Read a head; refuse a unit that is missing, unknown or of another kind."""
    match = _HEAD.fullmatch(cell)
    if match is None or not match[1] or to_number(cell) is not None:
        raise text.refusal(line, f"expected a head with its unit in brackets, found {quote(cell)}")
    # Spelling of units in wind-turbine files: N m2 is read for Nm^2 and N-m^2.
    head, unit = match[1], re.sub(r"(?<=[A-Za-z])-(?=[A-Za-z])", " ", (match[2] or "").strip())
    unit, plain = re.sub(r"\b([kMG]?N)m(?![a-z])", r"\1 m", unit), plain_name(head)
    if not (name := names.get(plain, "")):
        if near := difflib.get_close_matches(plain, names, n=1, cutoff=0.8):
            raise text.refusal(line, f"unknown column {quote(head)}; did you mean {names[near[0]]}?")
        return _ColumnHead(head, "", unit, Quantity())
    quantity, no_unit = known[name], unit in ("", "-", "1")
    if not quantity.unit and not no_unit:
        raise text.refusal(line, f"expected {head} without a unit, found [{unit}]")
    if quantity.unit:
        expected = f"expected a unit like [{usual_unit(quantity.unit)}] for {head}"
        if not unit:
            raise text.refusal(line, f"{expected}, found none")
        try:
            quantity.convert(f"1 {unit}")
        except InvalidInput as error:
            said = error.bound.partition(";")[0]
            raise text.refusal(line, f"{expected}, found [{unit}]: {said}") from None
    return _ColumnHead(head, name, "" if unit in ("-", "1") else unit, quantity)


def _row_of_cells(text: DataText, line: int, cells: list[str], heads: list[_ColumnHead]) -> list[str]:
    """Return the cells of a line, one for each head."""
    if len(cells) == len(heads) + 1 and not cells[-1]:  # some programs end each line with a separator
        cells = cells[:-1]
    if len(cells) != len(heads):
        raise text.refusal(line, f"expected {len(heads)} cells under the heads, found {len(cells)}")
    return cells


def _read_row(
    text: DataText, line: int, cells: list[str], heads: list[_ColumnHead], may_lack: Collection[str]
) -> list[float]:
    """Read the numbers of a line, in SI where the column is known."""
    row = []
    for cell, (head, name, unit, quantity) in zip(cells, heads, strict=True):
        if not cell and name in may_lack:
            row.append(math.nan)
            continue
        number = number_at(text, line, cell, f"{head} [{unit}]" if unit else head)
        try:
            given = f"{as_decimal(cell)} {unit}" if quantity.unit else number
            row.append(quantity.parse(given) if name else number)
        except InvalidInput as error:
            raise text.refusal(line, f"{head} = {cell} {unit}".rstrip() + f": {error.bound}") from None
    return row


def check_places(table: CsvTable, name: str) -> None:
    """Refuse positions that do not ascend; one given twice must be a jump in the values of other columns.

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
