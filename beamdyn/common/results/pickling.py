"""How objects are pickled that keep what they have computed."""

from __future__ import annotations

import dataclasses
from typing import Any


class FieldsOnly:
    """Base of dataclasses that are pickled by their fields, without what they have computed and kept."""

    def __reduce__(self) -> tuple[type, tuple[Any, ...]]:
        fields = dataclasses.fields(self)  # pyright: ignore[reportArgumentType]  (subclasses are dataclasses)
        return type(self), tuple(getattr(self, f.name) for f in fields)
