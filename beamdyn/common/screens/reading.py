"""How a form reads what people type: bare numbers, a decimal comma, numbers in the unit shown."""

from __future__ import annotations

import re
from dataclasses import dataclass

from beamdyn.common.edge.inputs import Input, parts_of
from beamdyn.common.screens.form_entries import toml_value

_NUMBER = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?"
_BARE = re.compile(_NUMBER, re.ASCII)
_QUANTITY = re.compile(rf"({_NUMBER})(\s*[^\d\s.,+-].*|\s+1/.*)?", re.ASCII | re.DOTALL)
_PAIR = re.compile(r"\s*;\s*|\s*,\s+")  # between the coordinates of a point
_USUAL = {"m": "mm", "rad": "deg"}  # units shown before one has been chosen


@dataclass(frozen=True)
class Reading:
    """A text as it was read.

    Parameters
    ----------
    text : str
        The text as a file has it.
    remark : str
        How it was read, if that differs from what was typed.
    """

    text: str
    remark: str = ""


def read_entry(typed: str, entry: Input, unit: str) -> Reading:
    """Read what was typed into a field.

    Parameters
    ----------
    typed : str
        The text.
    entry : Input
        The input of the field.
    unit : str
        The unit shown, which a bare number is given.
    """
    if isinstance(entry.default, tuple) and len(parts := _PAIR.split(typed.strip("() "))) == 2:
        return _read_pair(typed, parts, unit)
    match = _QUANTITY.fullmatch(typed.strip())
    if match is None or entry.choices or not _is_number(entry):
        return Reading(typed)
    number, given = match[1].replace(",", "."), (match[2] or "").strip()
    needed = unit if entry.quantity.unit and not given else given
    text = f"{number} {needed}".strip()
    as_typed = number == match[1] and needed == given
    return Reading(typed) if as_typed else Reading(text, f"read as {text}")


def _read_pair(typed: str, parts: list[str], unit: str) -> Reading:
    """Read the two coordinates of a point, such as "26.9, 4" or "26.9 mm, 4 mm"."""
    each = [_QUANTITY.fullmatch(part.strip()) for part in parts]
    made = [f"{m[1].replace(',', '.')} {(m[2] or '').strip() or unit}".strip() for m in each if m]
    text = toml_value(made)
    return Reading(text, f"read as {text}") if len(made) == 2 else Reading(typed)


def is_bare(typed: str) -> bool:
    """Whether a text is a number without a unit."""
    return _BARE.fullmatch(typed.strip()) is not None


def unit_of(text: str, entry: Input) -> str:
    """The unit of a text, if it is a quantity of its input; "" if it is not."""
    match = _QUANTITY.fullmatch(text.strip())
    unit = (match[2] or "").strip() if match else ""
    try:
        entry.quantity.convert(f"1 {unit}")
    except ValueError:
        return ""
    return unit


def usual_unit(entry: Input) -> str:
    """The unit of a field as long as none has been chosen."""
    unit = entry.quantity.unit
    return _USUAL.get(unit, unit)


def _is_number(entry: Input) -> bool:
    return bool(entry.quantity.unit) or bool({float, int} & {*parts_of(entry.kind)})
