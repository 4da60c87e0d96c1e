"""Numerical tables in TOML files: a row of headings with units ("twist [deg]"), then rows of numbers."""

from __future__ import annotations

import difflib
import math
import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import Any

from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput, usual_unit

_HEAD = re.compile(r"\s*([^\s\[\]]+)\s*(?:\[([^\[\]]*)\]\s*)?")


def read_columns(place: str, rows: Any, known: Mapping[str, Quantity]) -> dict[str, list[Any]]:
    """Read the columns of a numerical table in a TOML file.

    Parameters
    ----------
    place : str
        Key of the table in the file, for messages.
    rows : list of list
        The row of headings, followed by rows of numbers.
    known : mapping
        The known quantities, by name.

    Returns
    -------
    dict
        Values in SI units, by name of the quantity.

    Raises
    ------
    InvalidInput
        At the first mistake; its `field` is the position, such as "stations[2][0]", counted from 0.
    """
    if not isinstance(rows, list) or len(rows) < 2:
        remedy = 'give a row of headings, ["x/L", "twist [deg]"], then rows of numbers'
        raise InvalidInput(place, rows, remedy)
    for r, row in enumerate(rows):
        if not isinstance(row, list) or not row:
            raise InvalidInput(f"{place}[{r}]", row, "give a row in brackets")
        if len(row) != len(rows[0]):
            raise InvalidInput(f"{place}[{r}]", row, f"{len(row)} cells under {len(rows[0])} headings")
    units: dict[str, str] = {}
    for c, head in enumerate(rows[0]):
        name, unit = _read_head(f"{place}[0][{c}]", head, known)
        if name in units:
            raise InvalidInput(f"{place}[0][{c}]", head, "a second column of this name", "drop one")
        units[name] = unit
    columns: dict[str, list[Any]] = {name: [] for name in units}
    for r, row in enumerate(rows[1:], 1):
        for c, ((name, unit), cell) in enumerate(zip(units.items(), row, strict=True)):
            at = f"{place}[{r}][{c}]"
            if isinstance(cell, bool) or not isinstance(cell, int | float) or not math.isfinite(cell):
                raise InvalidInput(at, cell, f"give a finite number{f', in {unit}' if unit else ''}")
            try:
                columns[name].append(known[name].parse(f"{cell!r} {unit}" if unit else cell))
            except InvalidInput as error:
                raise replace(error, field=at, value=cell) from None
    return columns


def _similar(name: str, known: Iterable[str]) -> list[str]:
    """Return a list with the known name that is most similar to a given name; empty if none is similar.

    A known name that differs only in the digits at its end, such as EI1 from EI2, is another quantity and is
    returned only if the last two digits are swapped.
    """
    letters, swapped = name.rstrip("0123456789"), re.sub(r"(\d)(\d)$", r"\2\1", name)
    others = [
        each for each in known if each == swapped or not letters or each.rstrip("0123456789") != letters
    ]
    return difflib.get_close_matches(name, others, n=1)


def _read_head(place: str, head: Any, known: Mapping[str, Quantity]) -> tuple[str, str]:
    """Read the name of the quantity and the unit of a column from its heading.

    Raise `InvalidInput` with the position `place` if the quantity is not `known`, or its unit is wrong.
    """
    match = _HEAD.fullmatch(head) if isinstance(head, str) else None
    name = match[1] if match else ""
    if match is None or name not in known:
        near = _similar(name, known)
        remedy = f"did you mean {near[0]}?" if near else f"known are {', '.join(known)}"
        raise InvalidInput(place, head, "unknown column", remedy)
    unit, wanted = (match[2] or "").strip(), known[name].unit
    try:
        if bool(unit) == bool(wanted):
            known[name].convert(f"1 {unit}" if unit else 1)
            return name, unit
    except InvalidInput:
        pass
    example = f'"{name} [{usual_unit(wanted)}]"' if wanted else f'it without a unit, "{name}"'
    raise InvalidInput(place, head, f"give {example}")
