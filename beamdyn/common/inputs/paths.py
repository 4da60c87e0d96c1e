"""Parts of nested objects by their paths, such as "beam.point_masses[0].mass" or "pad.x": read, and replaced.

The objects are dataclasses, whose fields go by their keys in files, mappings, sequences, and models of files.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass, replace
from functools import cache
from typing import Any, get_type_hints

from beamdyn.common.inputs.described import description

_STEP = re.compile(r"\[(\d+)\]|((?:(?!\[\d+\])[^.])+)")
_AXES = "xy"  # names of the coordinates of points


def part_at(whole: Any, path: str) -> Any:
    """The part of an object at a path; None if there is nothing."""
    for step in _steps(path):
        whole = _part(whole, step)
    return whole


def with_parts(whole: Any, parts: Mapping[str, Any]) -> Any:
    """A copy of an object with parts replaced, by their paths: all at once, as they may depend on each other.

    Dataclasses check the values; models of files do not.
    """
    tree = _Tree()
    for path, value in parts.items():
        *inner, last = _steps(path)
        node = tree
        for step in inner:
            node = node.setdefault(step, _Tree())
        node[last] = value
    return _replaced(whole, tree)


class _Tree(dict[Any, Any]):
    """New values by steps, those within a part as a tree of their own."""


def _steps(path: str) -> list[str | int]:
    return [int(place) if place else name for place, name in _STEP.findall(path)]


def _place(step: str | int) -> int:
    return _AXES.index(step) if isinstance(step, str) else step


def _part(whole: Any, step: str | int) -> Any:
    if isinstance(whole, Mapping):
        return whole.get(step)
    if isinstance(whole, list | tuple):
        return whole[_place(step)] if _place(step) < len(whole) else None
    return getattr(whole, field_of(type(whole), str(step)), None)


def _replaced(whole: Any, new: Any) -> Any:
    if not isinstance(new, _Tree):
        return new
    if isinstance(whole, list | tuple):
        places = {_place(step): part for step, part in new.items()}
        return type(whole)(
            _replaced(part, places[k]) if k in places else part for k, part in enumerate(whole)
        )
    made = {field_of(type(whole), step): _replaced(_part(whole, step), part) for step, part in new.items()}
    if is_dataclass(whole) and not isinstance(whole, type):
        return replace(whole, **made)
    whole = {} if whole is None else whole
    return (
        {**whole, **made} if isinstance(whole, Mapping) else type(whole).model_construct(**dict(whole) | made)
    )


def field_of(made: type, key: str) -> str:
    """The field of a dataclass with a key in files; of other classes the key itself."""
    return _fields_by_key(made).get(key, key)


@cache
def _fields_by_key(made: type) -> dict[str, str]:
    if not is_dataclass(made):
        return {}
    hints = get_type_hints(made, include_extras=True)
    found = {each.name: description(hints[each.name]) for each in fields(made)}
    return {(each and each.key) or name: name for name, each in found.items()}
