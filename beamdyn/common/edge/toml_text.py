"""Writing of tables as TOML text."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator, Mapping
from typing import Any


def toml_of(tables: Mapping[str, Any]) -> str:
    """Write tables as the text of a TOML file."""

    def lines(tables: Mapping[str, Any], prefix: str) -> Iterator[str]:
        nested = {key: value for key, value in tables.items() if isinstance(value, dict)}
        listed = {key: value for key, value in tables.items() if _is_list_of(dict, value)}
        for key, value in tables.items():
            if key not in nested and key not in listed:
                yield f"{_key(key)} = {lined(value)}"
        for key in (key for key in tables if key in nested or key in listed):
            path = prefix + _key(key)
            head = f"[{path}]" if key in nested else f"[[{path}]]"
            for item in [nested[key]] if key in nested else listed[key]:
                yield from ("", head, *lines(item, f"{path}."))

    return "\n".join(lines(tables, "")).strip() + "\n"


def _key(name: str) -> str:
    """Return a TOML key, in quotes if necessary."""
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else toml_value(name)


def toml_value(value: Any) -> str:
    """Return a value as TOML text on one line."""
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


def lined(value: Any) -> str:
    """Return a value as TOML; a list of tables, or of rows of numbers, has one line per item.

    A point such as ["26.9 mm", "4 mm"] counts as a list of texts, not of numbers; thus a list of points has
    only one line.
    """
    rows = _is_list_of(list, value) and any(isinstance(cell, int | float) for cell in value[-1])
    if rows or _is_list_of(dict, value):
        return "[{}]".format(",\n ".join(toml_value(item) for item in value))
    return toml_value(value)


def _is_list_of(kind: type, value: Any) -> bool:
    return isinstance(value, list) and bool(value) and all(isinstance(item, kind) for item in value)
