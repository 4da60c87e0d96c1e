"""Conversion between the entries of a form (text by path) and the nested tables of a TOML file."""

from __future__ import annotations

import json
import re
import tomllib
from collections.abc import Iterator, Mapping, Sequence
from types import MappingProxyType
from typing import Any, get_args, get_origin

from beamdyn.common.edge.config import ConfigError, path_of, said_of
from beamdyn.common.edge.inputs import Input, Quantity, parts_of
from beamdyn.common.inputs.checks import InvalidValue, reason_of

Entries = dict[str, str]  # text of each field by the path of its input; "" if empty

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
    """The entries for these tables; values without a field are kept as entries, too."""
    leaves = {entry.path for entry in inputs}
    return {entry.path: "" for entry in inputs} | dict(_flat(tables, leaves, ""))


def _flat(tables: Mapping[str, Any], leaves: set[str], prefix: str) -> Iterator[tuple[str, str]]:
    for key, value in tables.items():
        path = prefix + key
        if isinstance(value, dict) and path not in leaves:
            yield from _flat(value, leaves, f"{path}.")
        else:
            yield path, value if isinstance(value, str) else _lined(value)


def _lined(value: Any) -> str:
    """A value as TOML; a list of tables or of rows with a line for each."""
    if _is_tables(value) or _is_rows(value):
        return "[{}]".format(",\n ".join(toml_value(item) for item in value))
    return toml_value(value)


def _is_tables(value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, dict) for item in value)


def _is_rows(value: Any) -> bool:
    """Whether a value is a table of plain numbers; points, whose coordinates have units, are none."""
    rows = isinstance(value, list) and bool(value) and all(isinstance(item, list) for item in value)
    return rows and any(isinstance(cell, int | float) for cell in value[-1])


def has_rows(entry: Input) -> bool:
    """Whether an input is a list of tables or of rows, which takes several lines."""
    parts = (part for kind in parts_of(entry.kind) if get_origin(kind) is list for part in get_args(kind))
    return any(part is dict or get_origin(part) is list for part in parts)


def tables_of(
    entries: Mapping[str, str], inputs: Sequence[Input], names: Sequence[str] = ()
) -> dict[str, Any]:
    """The tables for these entries, as tomllib would read them; empty fields are left out.

    Parameters
    ----------
    entries : mapping
        Text by path.
    inputs : sequence of Input
        Their descriptions, which tell numbers from words.
    names : sequence of str
        Tables wanted; all if empty.
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
    """The text as a TOML value: a number, list or table if the input is one, else a string."""
    if entry is not None and (entry.choices or _is_text(entry.kind)):
        return next((choice for choice in entry.choices if str(choice) == text), text)
    if entry is not None and entry.quantity.unit and text[0] not in "[{":
        return text
    try:
        return tomllib.loads(f"value = {text}")["value"]
    except (ValueError, RecursionError):
        return text


def _is_text(kind: Any) -> bool:
    return kind is str or (get_origin(kind) is not list and str in get_args(kind))


def toml_of(tables: Mapping[str, Any], heading: str = "") -> str:
    """Tables as the text of a TOML file."""
    return "\n".join([*([f"# {heading}", ""] if heading else []), *_lines(tables, "")]).strip() + "\n"


def _lines(tables: Mapping[str, Any], prefix: str) -> Iterator[str]:
    for key, value in tables.items():
        if not isinstance(value, dict) and not _is_tables(value):
            yield f"{_key(key)} = {_lined(value)}"
    for key, value in tables.items():
        path = prefix + _key(key)
        if isinstance(value, dict):
            yield from ("", f"[{path}]", *_lines(value, f"{path}."))
        elif _is_tables(value):
            for item in value:
                yield from ("", f"[[{path}]]", *_lines(item, f"{path}."))


def _key(name: str) -> str:
    """A key, in quotes where it needs them."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml_value(name)


def toml_value(value: Any) -> str:
    """A value on one line of TOML."""
    match value:
        case bool():
            return str(value).lower()
        case str():
            return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
        case list() | tuple():
            return f"[{', '.join(toml_value(item) for item in value)}]"
        case dict():
            return f"{{ {', '.join(f'{_key(key)} = {toml_value(item)}' for key, item in value.items())} }}"
    return repr(value)


def by_field(
    error: Exception, inputs: Sequence[Input], entries: Mapping[str, str] = MappingProxyType({})
) -> dict[str, list[str]]:
    """The sentences of an error by the path of the field that each is about; "" for no single field.

    One on the value of a field has it as it stands there, among the entries.
    """
    paths = [entry.path for entry in inputs]
    if not isinstance(error, ConfigError):
        path = path_of(error, paths)
        if isinstance(error, InvalidValue) and path in entries:
            return {path: [said_of(error, path, entries[path])]}
        return {path: [reason_of(error)]}
    sentences: dict[str, list[str]] = {}
    for sentence, place in zip(error.mistakes, error.paths, strict=True):
        sentences.setdefault(_field(place, paths), []).append(sentence)
    return sentences


def _field(place: str, paths: Sequence[str]) -> str:
    """The field in which a place lies, which may be a key within an input."""
    around = [path for path in paths if f"{place}.".startswith(f"{path}.")]
    return max(around, key=len, default="")


def units_for(unit: str) -> tuple[str, ...]:
    """Units in common use for an SI unit."""
    return _UNITS.get(unit, (unit,) if unit else ())


def units_of(entry: Input) -> tuple[str, ...]:
    """Units in common use for an input."""
    return *units_for(entry.quantity.unit), *entry.quantity.further_units


def in_unit(text: str, quantity: Quantity, target: str) -> str:
    """The quantity, or list of quantities, in another unit; the text unchanged if it is no such quantity."""
    try:
        if text.startswith("["):
            return toml_value([in_unit(part, quantity, target) for part in tomllib.loads(f"v = {text}")["v"]])
        value = quantity.in_unit(quantity.convert(text), target)
    except (ValueError, RecursionError, AttributeError):
        return text
    return f"{value:.10g} {target}"
