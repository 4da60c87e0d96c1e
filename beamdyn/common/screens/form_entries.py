"""Texts of form fields: conversion from and to TOML tables, reading of typed texts, names and defaults."""

from __future__ import annotations

import math
import re
import tomllib
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from html import escape
from types import MappingProxyType
from typing import Any, get_args, get_origin

from beamdyn.common.drawing.text_width import symbol_html
from beamdyn.common.edge.config import ConfigError, said_of
from beamdyn.common.edge.file_words import say
from beamdyn.common.edge.inputs import Input, Lines, Quantity, parts_of, path_of
from beamdyn.common.edge.toml_text import lined, toml_value
from beamdyn.common.edge.units import show
from beamdyn.common.inputs.checks import InvalidValue, reason_of
from beamdyn.common.words import name_in_words

Entries = dict[str, str]  # text of each field, by path of the input; "" for an empty field

_UNITS = {
    "m": ("m", "cm", "mm", "in"),
    "kg": ("kg", "t", "g", "lb"),
    "rad": ("deg", "rad"),
    "s": ("s", "ms"),
    "m/s": ("km/h", "m/s", "mph"),
    "N": ("N", "kN", "lbf"),
    "N m": ("N m", "kN m"),
    "Pa": ("Pa", "kPa", "MPa", "GPa", "bar"),
    "rad/s": ("rad/s", "rpm"),
    "kg m2": ("kg m2", "g mm2"),
}


def entries_of(tables: Mapping[str, Any], inputs: Sequence[Input]) -> Entries:
    """Return the field texts for TOML tables, also for values that have no field in the form."""
    found = {entry.path: "" for entry in inputs}
    leaves = {*found}

    def flatten(tables: Mapping[str, Any], prefix: str) -> None:
        for key, value in tables.items():
            path = prefix + key
            if isinstance(value, dict) and path not in leaves:
                flatten(value, f"{path}.")
            else:
                found[path] = value if isinstance(value, str) else lined(value)

    flatten(tables, "")
    return found


def has_rows(entry: Input) -> bool:
    """Return whether an input needs several lines: a list of tables or of rows, or a long text."""
    if isinstance(entry.quantity, Lines):
        return True
    parts = (part for kind in parts_of(entry.kind) if get_origin(kind) is list for part in get_args(kind))
    return any(part is dict or get_origin(part) is list for part in parts)


def tables_of(
    entries: Mapping[str, str], inputs: Sequence[Input], names: Sequence[str] = ()
) -> dict[str, Any]:
    """Return the TOML tables for field texts, as tomllib would return them; empty fields are omitted.

    Parameters
    ----------
    entries : mapping
        Field texts, by path of the input.
    inputs : sequence of Input
        Descriptions of the inputs, which say whether a text is a number.
    names : sequence of str
        Names of the requested tables; all if empty.
    """
    known = {entry.path: entry for entry in inputs}
    tables: dict[str, Any] = {}
    for path, text in entries.items():
        if text.strip() and (not names or path.partition(".")[0] in names):
            *parents, key = path.split(".")
            place = tables
            for parent in parents:
                place = place.setdefault(parent, {})
            place[key] = _value(text.strip(), known.get(path))
    return tables


def _value(text: str, entry: Input | None) -> Any:
    """Convert a field text to a TOML value: a number, list or table if the input is one, else a string."""
    if entry is not None:
        is_text = entry.kind is str or (get_origin(entry.kind) is not list and str in get_args(entry.kind))
        if text in map(str, entry.choices):
            return next(choice for choice in entry.choices if str(choice) == text)
        if is_text or (entry.choices and not _takes_numbers(entry)):
            return text
        if entry.quantity.unit and text[0] not in "[{":
            return text
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text


def _takes_numbers(entry: Input) -> bool:
    """Return whether the input may be a number, even if it offers words to choose from."""
    return bool({float, int} & {*parts_of(entry.kind)})


def by_field(
    error: Exception, inputs: Sequence[Input], entries: Mapping[str, str] = MappingProxyType({})
) -> dict[str, list[str]]:
    """Return the sentences of an error message, by path of the field that each sentence is about.

    Sentences that are not about a single field are at the path "".  A sentence about the value of a field
    quotes the field's text.
    """
    paths = [entry.path for entry in inputs]
    if not isinstance(error, ConfigError):
        path = path_of(error, paths)
        if isinstance(error, InvalidValue) and path in entries:
            return {path: [said_of(error, path, entries[path])]}
        return {path: [reason_of(error) if isinstance(error, ArithmeticError) else say(error)]}
    sentences: dict[str, list[str]] = {}
    for sentence, place in zip(error.mistakes, error.paths, strict=True):
        # The path in the error may be that of a part of an input, such as one coordinate of a point.
        around = [path for path in paths if f"{place}.".startswith(f"{path}.")]
        sentences.setdefault(max(around, key=len, default=""), []).append(sentence)
    return sentences


def units_for(unit: str) -> tuple[str, ...]:
    """Return common units for the quantity with a given SI unit."""
    return _UNITS.get(unit, (unit,) if unit else ())


def units_of(entry: Input) -> tuple[str, ...]:
    """Return common units for an input."""
    return *units_for(entry.quantity.unit), *entry.quantity.further_units


def in_unit(text: str, quantity: Quantity, target: str) -> str:
    """Convert a quantity in a text, or a list of them, to another unit; return other texts unchanged."""
    try:
        if text.startswith("["):
            return toml_value([in_unit(part, quantity, target) for part in tomllib.loads(f"v = {text}")["v"]])
        value = quantity.in_unit(quantity.convert(text), target)
    except (ValueError, RecursionError, AttributeError):
        return text
    return f"{value:.10g} {target}"


_NUMBER = r"[+-]?(?:\d+[.,]?\d*|[.,]\d+)(?:[eE][+-]?\d+)?"
_BARE = re.compile(_NUMBER, re.ASCII)
_QUANTITY = re.compile(rf"({_NUMBER})(\s*[^\d\s.,+-].*|\s+1/.*)?", re.ASCII | re.DOTALL)
_PAIR = re.compile(r"\s*;\s*|\s*,\s+")  # pattern of the separator between the coordinates of a point
_USUAL = {"m": "mm", "rad": "deg"}  # units shown for each SI unit until the user chooses another unit


@dataclass(frozen=True)
class Reading:
    """A field text, and how it was understood.

    Parameters
    ----------
    text : str
        The text in the notation of files.
    remark : str
        Explanation, if the text as understood differs from the typed text.
    """

    text: str
    remark: str = ""


def read_entry(typed: str, entry: Input, unit: str) -> Reading:
    """Read a text typed into a field.

    Parameters
    ----------
    typed : str
        The typed text.
    entry : Input
        The input of the field.
    unit : str
        The unit shown at the field; it is used for a number without a unit.
    """
    if isinstance(entry.default, tuple) and len(parts := _PAIR.split(typed.strip("() "))) == 2:
        # The parts are the coordinates of a point, as in "26.9, 4" or "26.9 mm, 4 mm".
        each = [_QUANTITY.fullmatch(part.strip()) for part in parts]
        made = [f"{m[1].replace(',', '.')} {(m[2] or '').strip() or unit}".strip() for m in each if m]
        text = toml_value(made)
        return Reading(text, f"read as {text}") if len(made) == 2 else Reading(typed)
    match = _QUANTITY.fullmatch(typed.strip())
    is_number = entry.quantity.unit or _takes_numbers(entry)
    if match is None or entry.choices or not is_number:
        return Reading(typed)
    number, given = match[1].replace(",", "."), (match[2] or "").strip()
    needed = unit if entry.quantity.unit and not given else given
    text = f"{number} {needed}".strip()
    as_typed = number == match[1] and needed == given
    return Reading(typed) if as_typed else Reading(text, f"read as {text}")


def is_bare(typed: str) -> bool:
    """Return whether a text is a number without a unit."""
    return _BARE.fullmatch(typed.strip()) is not None


def unit_of(text: str, entry: Input) -> str:
    """Return the unit in a text if the text is a valid quantity for the input; else ""."""
    match = _QUANTITY.fullmatch(text.strip())
    unit = (match[2] or "").strip() if match else ""
    try:
        entry.quantity.convert(f"1 {unit}")
    except ValueError:
        return ""
    return unit


def usual_unit(unit: str) -> str:
    """Return the unit that a field shows for an SI unit until the user chooses another unit."""
    return _USUAL.get(unit, unit)


NOT_GIVEN = "not given"


def label(entry: Input) -> str:
    """Return the name and symbol of an input."""
    symbol = entry.quantity.symbol
    return f"{name_words(entry)}, {symbol}" if symbol and symbol != entry.name else name_words(entry)


def label_html(entry: Input) -> str:
    """Return the label as HTML, with the symbol typeset as in a sketch."""
    words, _, symbol = label(entry).rpartition(", ")
    return f"{escape(words)}, {symbol_html(symbol)}" if words else escape(symbol)


def help_of(entry: Input) -> str:
    """Return meaning, unit and bounds of an input, and whether it is optional."""
    return entry.help if entry.required else f"{entry.help}; not required"


def name_words(entry: Input) -> str:
    """Return the name of an input in words, without the name of the outermost table."""
    return name_in_words(entry.path.partition(".")[2] or entry.path)


def table_of(path: str) -> str:
    """Return the name of the table that contains an input; "" for an input outside any table."""
    return path.partition(".")[0] if "." in path else ""


def heading_of(section: str, headings: Mapping[str, str]) -> str:
    """Return the heading of a table of the form."""
    return headings.get(section, section.replace("_", " ").capitalize() or "General")


def options_of(entry: Input) -> tuple[str, ...]:
    """Return the options among which the user chooses an input; empty if the input is typed."""
    if entry.kind is bool:
        return ("true", "false")
    few = all(isinstance(choice, str | int) for choice in entry.choices) and not _takes_numbers(entry)
    return tuple(str(choice) for choice in entry.choices) if entry.choices and few else ()


def default_words(entry: Input) -> str:
    """Return the default value as a user would type it."""
    if entry.default is None or entry.default in ("", [], ()):
        return NOT_GIVEN
    value, unit = entry.default, entry.quantity.unit
    if value == math.inf and entry.quantity.infinite:
        return entry.quantity.infinite

    def in_words(number: float) -> str:
        short = unit == "m" and abs(number) < 1
        return f"{1e3 * number:.6g} mm" if short else f"{number:.6g} {unit}".rstrip()

    if isinstance(value, tuple):
        return toml_value([in_words(number) for number in value])
    if isinstance(value, bool) or not isinstance(value, int | float):
        return show(value).strip('"')
    return in_words(value)
