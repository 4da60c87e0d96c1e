"""Reading of text files with numbers: input files of other programs (FORTRAN notation), and CSV files.

A CSV file has a line of column headings with units, such as "r [m], EI flap [N m2]".  Error messages name the
file, the line and what was expected there.
"""

from __future__ import annotations

import csv
import difflib
import math
import re
import unicodedata
from collections.abc import Collection, Mapping
from dataclasses import dataclass
from io import StringIO
from os import PathLike
from pathlib import Path
from typing import NamedTuple

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput, show, usual_unit
from beamdyn.common.inputs.checks import MOST
from beamdyn.common.results.files import as_path

# FORTRAN reads 1.0D+03 and 1.0+03 as 1.0e+03.
_NUMBER = re.compile(r"([+-]?(?:\d+\.?\d*|\.\d+))(?:(?:[eEdDqQ]|(?=[+-]))([+-]?\d+))?", re.ASCII)
_WORD = re.compile(r"'[^']*'|\"[^\"]*\"|[^\s,]+")
_MOST_BYTES = 20_000_000  # largest size of a file in bytes; typical input files have some 10,000 bytes
# Encodings by the byte order mark at the start of a file.
_ENCODINGS = {b"\xff\xfe": "utf-16", b"\xfe\xff": "utf-16"}


@dataclass(frozen=True)
class DataText:
    """A text file, line by line.

    Parameters
    ----------
    path : Path
        The file.
    lines : tuple of str
        Lines of the file; the first one is line 1.
    """

    path: Path
    lines: tuple[str, ...]

    @classmethod
    def of(cls, path: Path, text: str) -> DataText:
        """Split a text into lines at line feeds and carriage returns alone, as other programs do.

        `str.splitlines` also splits at characters such as U+0085, an ellipsis of Windows read as Latin-1.
        """
        return cls(path, tuple(line.rstrip("\n") for line in StringIO(text, newline=None)))

    def refusal(self, line: int, sentence: str) -> ConfigError:
        """Return an error about a line: file, line number and sentence."""
        return ConfigError(str(self.path), [f"line {line}: {sentence}"])

    def lacking(self, sentence: str) -> ConfigError:
        """Return an error that the file ends before some content, which `sentence` says was expected."""
        return self.refusal(len(self.lines), f"the file ends here, {sentence}")

    def is_comment(self, line: int) -> bool:
        """Return whether a line is empty, or a comment that begins with # or !."""
        plain = self.lines[line - 1].lstrip()
        return not plain or plain[0] in "#!"

    def words(self, line: int) -> list[str]:
        """Split a line into words as FORTRAN does, at blanks, tabs and commas; quoted text is not split."""
        return _WORD.findall(self.lines[line - 1])


def read_data(path: str | PathLike[str]) -> DataText:
    """Read a text file line by line.

    Comments may be in any encoding: a file that is not UTF-8 is read as Latin-1.

    Parameters
    ----------
    path : str or path-like
        The file.

    Raises
    ------
    InvalidValue
        If `path` is neither text nor a path.
    ConfigError
        If the file cannot be read, is no text or is empty.
    """
    file = as_path("path", path, "a file")
    try:
        with file.open("rb") as opened:
            content = opened.read(_MOST_BYTES + 1)
    except FileNotFoundError:
        raise ConfigError(str(file), ["there is no such file; check the name and the folder"]) from None
    except (OSError, ValueError) as error:
        reason = getattr(error, "strerror", None) or error
        raise ConfigError(str(file), [f"it cannot be read ({reason}); give a text file"]) from None
    if len(content) > _MOST_BYTES:
        raise ConfigError(str(file), ["it is longer than 20 MB; give an input file or a table"])
    try:
        text = content.decode(_ENCODINGS.get(content[:2], "utf-8-sig"))
    except UnicodeDecodeError:
        text = content.decode("latin-1")
    if "\0" in text:
        raise ConfigError(str(file), ["it is no text; give an input file or a table saved as text"])
    if not text.strip():
        raise ConfigError(str(file), ["the file is empty; give an input file or a table"])
    return DataText.of(file, text)


def named_file(path: str | PathLike[str], key: str, name: str) -> Path:
    """Return the path of a file that is named in another file, relative to that other file.

    Raises
    ------
    ConfigError
        If the file does not exist; the message names the key, the file and the folder.
    """
    folder = Path(path).parent
    if not (folder / name).exists():
        said = f"{key} = {show(name)}: there is no such file in the folder {folder.resolve()}"
        raise ConfigError(str(path), [f"{said}; check the name, which is relative to this file"], [key])
    return folder / name


# Numbers ------------------------------------------------------------------------------------------


def to_number(word: str) -> float | None:
    """Convert a word such as 1.0D+03 to a float as FORTRAN does; None if it is no number, or too large."""
    match = _NUMBER.fullmatch(word)
    if match is None:
        return None
    number = float(f"{match[1]}e{match[2] or 0}")
    return number if math.isfinite(number) else None


def as_decimal(word: str) -> str:
    """Rewrite a number with the exponent letter e, where FORTRAN may write another letter or none."""
    match = _NUMBER.fullmatch(word)
    assert match is not None
    return match[1] + (f"e{match[2]}" if match[2] else "")


def number_at(text: DataText, line: int, word: str, name: str) -> float:
    """Convert a word in a line to a number; raise an error that names the expected quantity."""
    number, advice = to_number(word), ""
    if number is not None and abs(number) <= MOST:
        return number
    if number is not None:
        raise text.refusal(line, f"expected a number up to {MOST:g} for {name}, found {quote(word)}")
    if strange := next((c for c in word if not c.isascii()), ""):
        known = unicodedata.name(strange, "no name").lower()
        advice = f" with the character U+{ord(strange):04X} ({known}); write it in plain characters"
    elif to_number(word.replace(",", ".", 1)) is not None:
        advice = "; write a decimal point"
    elif word.lower().lstrip("+-") in ("nan", "inf", "infinity"):
        advice = "; give a finite one"
    raise text.refusal(line, f"expected a number for {name}, found {quote(word)}{advice}")


def quote(word: str) -> str:
    """Put a word in quotation marks for a message, shortened if it is long."""
    return f"'{word if len(word) <= 40 else word[:37] + '...'}'"


# Lines with a value followed by its name ----------------------------------------------------------


@dataclass(frozen=True)
class NamedValue:
    """A value with its name and line number in an input file.

    Parameters
    ----------
    name : str
        Name of the value, as written.
    word : str
        The value, as written, without quotes.
    line : int
        Number of the line.
    """

    name: str
    word: str
    line: int


def plain_name(name: str) -> str:
    """Return a name in lower case, without brackets, colons, underscores and blanks: files differ in them."""
    return re.sub(r"[^a-z0-9]", "", name.lower())


def named_values(text: DataText, names: Collection[str]) -> dict[str, NamedValue]:
    """Read values followed by names: ``0.48  BldFlDmp(1) - damping`` or ``1.75 hub_rad: hub radius``.

    Parameters
    ----------
    text : DataText
        The file.
    names : collection of str
        The names to be found, as `plain_name` returns them.

    Returns
    -------
    dict
        The values that the file has, by names as `plain_name` returns them.

    Raises
    ------
    ConfigError
        If a name occurs twice.
    """
    found: dict[str, NamedValue] = {}
    bare: dict[str, NamedValue] = {}
    for line in range(1, len(text.lines) + 1):
        words = [word for word in text.words(line) if word not in (":", "-")][:2]
        keys = [plain_name(word) for word in words]
        if len(keys) == 2 and (key := keys[1]) in names:
            if key in found:
                there = f"{words[1].rstrip(':')} stands in line {found[key].line}, too"
                raise text.refusal(line, f"{there}; expected each name once")
            found[key] = NamedValue(words[1].rstrip(":"), words[0].strip("'\""), line)
        elif keys and keys[0] in names:  # either the value is missing, or the line is a comment
            bare.setdefault(keys[0], NamedValue(words[0].rstrip(":"), "", line))
    return bare | found


def check_all_there(text: DataText, found: Mapping[str, NamedValue], names: Mapping[str, str]) -> None:
    """Raise an error if a file lacks some of the required names, or the values of these names.

    Parameters
    ----------
    text : DataText
        The file.
    found : mapping
        Values of the file, by names as `plain_name` returns them.
    names : mapping
        Required names as shown in messages, by names as `plain_name` returns them.

    Raises
    ------
    ConfigError
        If a name or its value is missing.
    """
    for key in names:
        if key in found and not found[key].word:
            raise text.refusal(found[key].line, f"expected a value before {found[key].name}, found none")
    if missing := [shown for key, shown in names.items() if key not in found]:
        some = ", ".join(missing[:4]) + (f" and {len(missing) - 4} more" if len(missing) > 4 else "")
        raise text.lacking(f"and it has no line for {some}; expected a value followed by this name")


def named_number(text: DataText, named: NamedValue) -> float:
    """Convert the word of a named value to a float."""
    return number_at(text, named.line, named.word, named.name)


def check_named(text: DataText, named: NamedValue, good: bool, wanted: str) -> None:
    """Raise an error about a named value if `good` is false; `wanted` describes valid values."""
    if not good:
        raise text.refusal(named.line, f"expected {named.name} {wanted}, found {quote(named.word)}")


def named_count(text: DataText, named: NamedValue, least: int = 2) -> int:
    """Convert the word of a named value to a whole number; raise an error if it is less than `least`."""
    number = named_number(text, named)
    if number != int(number) or number < least:
        said = f"expected a whole number of {least} or more for {named.name}, found {quote(named.word)}"
        raise text.refusal(named.line, said)
    return int(number)


# CSV files -------------------------------------------------------------------------------------------

_INNER = r"(?:[^\[\]()]|\([^\[\]()]*\))*"  # pattern of a text within brackets, such as the unit "(m/s2)2/Hz"
_HEAD = re.compile(rf"\s*([^\[\]()]*?)\s*(?:[\[(]({_INNER})[\])]\s*)?")
_DELIMITERS = ",;\t"


@dataclass(frozen=True)
class CsvColumn:
    """A column of a CSV file.

    Parameters
    ----------
    head : str
        Heading of the column, without the unit.
    name : str
        Name of the quantity in the column; empty if the quantity is not known.
    unit : str
        Unit of the column, as written.
    values : tuple of float
        Numbers: in SI units if the quantity is known, else as written; nan for an empty cell.
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
        Line number of the column headings.
    lines : tuple of int
        Line number of each row.
    columns : tuple of CsvColumn
        The columns, from left to right.
    """

    text: DataText
    head_line: int
    lines: tuple[int, ...]
    columns: tuple[CsvColumn, ...]

    def named(self) -> dict[str, CsvColumn]:
        """Return the columns with a known quantity, by the name of the quantity."""
        return {column.name: column for column in self.columns if column.name}


def read_csv(
    text: DataText,
    known: Mapping[str, Quantity],
    names: Mapping[str, str],
    may_lack: Collection[str] = (),
    least_rows: int = 2,
) -> CsvTable:
    """Read a CSV file that has column headings with units.

    Lines that are empty or begin with # or ! are comments.  Columns are separated by commas, semicolons
    or tabs.

    Parameters
    ----------
    text : DataText
        The file.
    known : mapping
        Known quantities, by name.
    names : mapping
        Names of quantities, by heading in the form that `plain_name` returns; several headings may mean the
        same quantity.
    may_lack : collection of str
        Quantities whose cells may be empty.
    least_rows : int
        Smallest number of rows of numbers.

    Raises
    ------
    ConfigError
        At the first wrong heading or cell; the message names the file, the line, and what was expected.
    """
    lines = [line for line in range(1, len(text.lines) + 1) if not text.is_comment(line)]
    if not lines:
        raise text.lacking("expected a line of column headings with units in brackets")
    head_line, *rest = lines
    # The heading line without units in brackets, as a unit may contain a column separator.
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
        raise text.lacking(f"expected at least {count} of numbers below the headings")
    cells = [_row_of_cells(text, line, _cells(text, line, delimiter), heads) for line in rest]
    rows = [_read_row(text, line, each, heads, may_lack) for line, each in zip(rest, cells, strict=True)]
    columns = zip(heads, zip(*rows, strict=True), zip(*cells, strict=True), strict=True)
    made = tuple(CsvColumn(head.head, head.name, head.unit, values, each) for head, values, each in columns)
    return CsvTable(text, head_line, tuple(rest), made)


def _cells(text: DataText, line: int, delimiter: str) -> list[str]:
    try:
        (cells,) = csv.reader([text.lines[line - 1]], delimiter=delimiter, skipinitialspace=True)
    except csv.Error:  # a cell exceeds the csv module's limit: a long line without separators
        most = csv.field_size_limit()
        raise text.refusal(line, f"a cell has more than {most} characters; give a number in each") from None
    return [cell.strip() for cell in cells]


class _ColumnHead(NamedTuple):
    """A column heading: its text, name of the quantity (empty if not known), unit as written, quantity."""

    head: str
    name: str
    unit: str
    quantity: Quantity


def _read_head(
    text: DataText, line: int, cell: str, known: Mapping[str, Quantity], names: Mapping[str, str]
) -> _ColumnHead:
    """Read a column heading; raise an error if its unit is missing, unknown or of another quantity."""
    match = _HEAD.fullmatch(cell)
    if match is None or not match[1] or to_number(cell) is not None:
        apart = "; separate columns by commas, semicolons or tabs" if cell.count("[") > 1 else ""
        raise text.refusal(line, f"expected a heading with its unit in brackets, found {quote(cell)}{apart}")
    # Wind-turbine files write N m2 also as Nm^2 or N-m^2.
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
    """Return the cells of a line; raise an error unless there is one cell for each column heading."""
    if len(cells) == len(heads) + 1 and not cells[-1]:  # some programs end each line with a separator
        cells = cells[:-1]
    if len(cells) != len(heads):
        why = "; are there decimal commas? Write points" if len(cells) > len(heads) else ""
        raise text.refusal(line, f"expected {len(heads)} cells under the headings, found {len(cells)}{why}")
    return cells


def _read_row(
    text: DataText, line: int, cells: list[str], heads: list[_ColumnHead], may_lack: Collection[str]
) -> list[float]:
    """Convert the cells of a line to numbers, in SI units if the quantity of the column is known."""
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
    """Raise an error if positions do not ascend; a position may occur twice, where another column jumps.

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
            said = f"{here} stands in line {before}, too; expected it twice only between other positions"
        else:
            continue
        raise table.text.refusal(table.lines[k], said)
