"""Base classes of dataclasses whose arrays cannot be written, and which are pickled by their fields."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np


class FieldsOnly:
    """Base of dataclasses that are pickled by their fields, without cached properties."""

    def __reduce__(self) -> tuple[type, tuple[Any, ...]]:
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return type(self), tuple(getattr(self, f.name) for f in fields)


class ReadOnlyArrays:
    """Base of frozen dataclasses whose public fields hold arrays that cannot be written.

    The fields are read-only views, so that arrays which others hold, too, stay as they are.
    """

    def __post_init__(self) -> None:
        make_read_only(self)

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        make_read_only(self)


def make_read_only(holder: Any) -> None:
    """Replace the arrays in the public fields of a dataclass by read-only views."""
    for each in dataclasses.fields(holder):
        if each.repr:
            value = getattr(holder, each.name)
            if (viewed := _viewed(value)) is not value:
                object.__setattr__(holder, each.name, viewed)


def _viewed(value: Any) -> Any:
    """Return a read-only view of an array, or of the arrays in a container; other values as they are."""
    if isinstance(value, np.ndarray):
        view = value.view()
        view.flags.writeable = False
        return view
    if type(value) is tuple and any(map(_may_hold_arrays, value)):
        return tuple(map(_viewed, value))
    if type(value) is dict:
        return {key: _viewed(item) for key, item in value.items()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type | ReadOnlyArrays):
        make_read_only(value)
    return value


def _may_hold_arrays(value: Any) -> bool:
    return isinstance(value, np.ndarray | tuple | dict) or dataclasses.is_dataclass(value)
