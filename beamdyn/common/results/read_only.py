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


def make_read_only(value: Any) -> Any:
    """Return a read-only view of an array, or of the arrays in a container; other values as they are.

    In a dataclass, the arrays in the public fields are replaced by such views.
    """
    if isinstance(value, np.ndarray):
        view = value.view()
        view.flags.writeable = False
        return view
    if type(value) is tuple and any(map(_may_hold_arrays, value)):
        return tuple(map(make_read_only, value))
    if type(value) is dict:
        return {key: make_read_only(item) for key, item in value.items()}
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        for each in (field for field in dataclasses.fields(value) if field.repr):
            held = getattr(value, each.name)
            # The arrays of a result within another one cannot be written already.
            if not isinstance(held, ReadOnlyArrays) and (viewed := make_read_only(held)) is not held:
                object.__setattr__(value, each.name, viewed)
    return value


def _may_hold_arrays(value: Any) -> bool:
    return isinstance(value, np.ndarray | tuple | dict) or dataclasses.is_dataclass(value)


class ReadOnlyArrays:
    """Base of frozen dataclasses whose public fields hold arrays that cannot be written.

    The fields are read-only views, so that arrays which others hold, too, stay as they are.
    """

    __post_init__ = make_read_only

    def __setstate__(self, state: dict[str, Any]) -> None:
        self.__dict__.update(state)
        make_read_only(self)
