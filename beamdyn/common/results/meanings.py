"""Meanings of the numbers of a result as plain data, from which outputs, files and tables are made."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from typing import get_args, get_type_hints


@dataclass(frozen=True)
class Meaning:
    """Meaning of a number of a result, for ``Annotated[float, Meaning("m", "stopping distance")]``.

    Parameters
    ----------
    unit : str
        SI unit; "" for a plain number.
    words : str
        Meaning for people: a phrase without a full stop.
    shown : str
        Unit in which people see it, if that is not the SI unit, such as "mm".
    """

    unit: str
    words: str
    shown: str = ""


@cache
def meanings(kind: type) -> dict[str, Meaning]:
    """Return the meanings of the fields of a result's class that have one, in order."""
    hints = get_type_hints(kind, include_extras=True).items()
    stated = ((name, part) for name, hint in hints for part in get_args(hint) if isinstance(part, Meaning))
    return dict(stated)
