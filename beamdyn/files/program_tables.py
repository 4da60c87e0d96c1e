"""Conversion of tables written by other programs to CSV with units, with unchanged line numbers.

This module reads lists of variables of ANSYS (PRVAR), tables with headings and units in two lines (FAST), CSV
files with title lines or with headings such as "X:Time(s)", and universal files (dataset 58).
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from importlib.util import find_spec
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.data_text import DataText, plain_name, to_number

_LIST = re.compile(r"[\s*]*ANSYS POST26 VARIABLE LISTING[\s*]*", re.IGNORECASE)
_VARIABLE = re.compile(r"\b\d+\s+([A-Za-z]\w*)")
_UNIT = re.compile(r"\(.*\)|\[.*\]")
_AXIS = re.compile(r"(^|[,;\t])(\s*\"?)[XY]:", re.IGNORECASE)
_CELL = re.compile(r"[^,;\t]+")
UNIVERSAL = (".uff", ".unv", ".58")
_RESPONSE, _HISTORY = 4, 1  # function types of dataset 58
# Measured quantities, by number of the data type in dataset 58.
_OBSERVED = {8: ("tip", "m"), 12: ("tip acceleration", "m/s2")}
_DRIVES = {13: ("tip force", "N"), 12: ("bending", "m/s2")}


def as_table(text: DataText, columns: Mapping[str, str]) -> DataText:
    """Return a file as CSV: column headings with units, and separators between cells.

    Parameters
    ----------
    text : DataText
        Text of the file.
    columns : mapping
        New headings, such as "tip" or "tip by tip force [mm/N]"; for each, the heading of the column in the
        file, without the unit.

    Raises
    ------
    ConfigError
        If a list has no numbers, or no column has one of the given headings.
    """
    head = next((k for k, line in enumerate(text.lines) if _LIST.fullmatch(line)), None)
    units = next((k for k, pair in enumerate(pairwise(text.lines), 1) if _units_below(*pair)), None)
    if head is not None:
        lines = _of_list(text, head)
    elif units is not None:
        lines = _of_two_heads(text, units)
    else:
        lines = _without_titles(text)
    return _renamed(replace(text, lines=tuple(lines)), columns)


def head_line(text: DataText) -> int:
    """Return the number of the heading line, the first line that is no comment; 0 if there is none."""
    return next((line for line in range(1, len(text.lines) + 1) if not text.is_comment(line)), 0)


def _without_titles(text: DataText) -> list[str]:
    """Return the lines of a CSV file without title lines, and without "X:" and "Y:" in headings."""
    lines = [*text.lines]
    first = next((k for k, line in enumerate(lines) if _AXIS.search(f",{line}") or _has_cells(line)), None)
    if first is None or text.is_comment(first + 1):
        return lines
    return [""] * first + [_AXIS.sub(r"\1\2", lines[first])] + lines[first + 1 :]


def _has_cells(line: str) -> bool:
    return line.lstrip()[:1] not in ("#", "!") and len(_CELL.findall(line)) > 1


def _units_below(heads: str, units: str) -> bool:
    """Return whether a line contains the units of the headings in the line above."""
    words = units.split()
    return len(words) > 1 and len(words) == len(heads.split()) and all(map(_UNIT.fullmatch, words))


def _of_two_heads(text: DataText, units: int) -> list[str]:
    names, below = (text.lines[k].split() for k in (units - 1, units))
    heads = ", ".join(f"{name} {unit}" for name, unit in zip(names, below, strict=True))
    return [""] * (units - 1) + [heads, ""] + [", ".join(line.split()) for line in text.lines[units + 1 :]]


def _of_list(text: DataText, head: int) -> list[str]:
    """Return the rows of an ANSYS list over time or frequency, whose headings repeat on each page."""
    rows = {
        k: words
        for k, line in enumerate(text.lines)
        if k > head and len(words := line.split()) > 1 and all(to_number(word) is not None for word in words)
    }
    if not rows:
        raise text.lacking("expected lines of numbers below ANSYS POST26 VARIABLE LISTING")
    first = min(rows)
    heading = " ".join(text.lines[head:first]).upper()
    names = re.findall(r"\b[A-Z]\w*_\d+\b", heading) or _VARIABLE.findall(heading)
    if "FREQ" in heading.split():
        if "PHASE" not in heading or len(rows[first]) != 3:
            raise text.refusal(head + 1, "expected amplitude and phase of one variable: PRCPLX,1, then PRVAR")
        heads = ["frequency [Hz]", names[0], "phase [deg]"]
    else:
        heads = ["time [s]", *names]
    lines = [", ".join(rows.get(k, ())) for k in range(len(text.lines))]
    lines[first - 1] = ", ".join(heads)
    return lines


def _renamed(text: DataText, columns: Mapping[str, str]) -> DataText:
    """Return the table with new headings; the unit in the file is kept if the new heading has none."""
    if not columns or not (line := head_line(text)):
        return text
    wanted = {plain_name(source): head for head, source in columns.items()}
    found: set[str] = set()

    def new(match: re.Match[str]) -> str:
        name, bracket, unit = re.fullmatch(r"\s*\"?([^\[\](]*)([\[(]?)(.*)", match[0]).groups()  # pyright: ignore
        if (plain := plain_name(name)) not in wanted:
            return match[0]
        found.add(plain)
        head = wanted[plain]
        return head if "[" in head else f"{head} {bracket}{unit}".rstrip('" ')

    changed = _CELL.sub(new, text.lines[line - 1])
    if missing := next((source for source in columns.values() if plain_name(source) not in found), ""):
        said = f"there is no column '{missing}'; the headings are {text.lines[line - 1].strip()}"
        raise text.refusal(line, said)
    return replace(text, lines=(*text.lines[: line - 1], changed, *text.lines[line:]))


# Universal files ----------------------------------------------------------------------------------


def universal_table(path: Path) -> DataText:
    """Return the only function in a universal file (dataset 58): a frequency response or a time history.

    Raises
    ------
    ConfigError
        If the package pyuff is not installed, or the file does not contain exactly one function of a known
        type.
    """
    if find_spec("pyuff") is None:
        said = "a universal file needs the package pyuff: pip install 'beamdyn[uff]'"
        raise ConfigError(str(path), [said])
    import pyuff  # pyright: ignore[reportMissingImports]  (an extra)

    try:
        sets = pyuff.UFF(str(path)).read_sets()
    except Exception as error:  # pyuff may raise errors of any class
        raise ConfigError(str(path), [f"it is no universal file that can be read ({error})"]) from None
    each = [found for found in (sets if isinstance(sets, list) else [sets]) if found["type"] == 58]
    if len(each) != 1 or each[0]["func_type"] not in (_RESPONSE, _HISTORY):
        said = f"expected one frequency response or history (dataset 58), found {len(each)} functions"
        raise ConfigError(str(path), [f"{said}; write the function of the tip into a file of its own"])
    (found,) = each
    return DataText(path, tuple(_lines_of_function(path, found)))


def _lines_of_function(path: Path, found: Mapping[str, Any]) -> list[str]:
    x, values = np.asarray(found["x"]), np.asarray(found["data"])
    name, unit = _kind_of(path, found, "ordinate", _OBSERVED)
    if found["func_type"] == _HISTORY:
        rows = zip(x, np.real(values), strict=True)
        return [f"time [s], {name} [{unit}]", *(f"{t:.9g}, {value:.6e}" for t, value in rows)]
    drive, per = _kind_of(path, found, "orddenom", _DRIVES)
    rows = zip(x, np.abs(values), np.degrees(np.angle(values)), strict=True)
    heads = f"frequency [Hz], {name} by {drive} [{unit} per {per}], phase [deg]"
    return [heads, *(f"{f:.9g}, {size:.6e}, {turned:.4f}" for f, size, turned in rows)]


def _kind_of(
    path: Path, found: Mapping[str, Any], axis: str, known: Mapping[int, tuple[str, str]]
) -> tuple[str, str]:
    """Return the name that this package has for the kind of data on an axis, and its unit."""
    number = int(found.get(f"{axis}_spec_data_type", 0))
    if number not in known:
        kinds = ", ".join(f"{k} ({words})" for k, (words, _) in known.items())
        said = f"expected data of the kinds {kinds} on its axis {axis}, found {number}"
        raise ConfigError(str(path), [said])
    name, usual = known[number]
    unit = str(found.get(f"{axis}_axis_units_lab", "")).strip()
    return name, usual if unit.upper() in ("", "NONE") else unit
