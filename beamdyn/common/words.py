"""Texts made of parts that each medium (Python, files and commands, forms) words in its own way."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from typing import Any, Self

_NAMES = {"youngs": "Young's", "poissons": "Poisson's"}  # words with an apostrophe, which keys lack
_LONG = 10.0  # lengths from this one on are worded in m everywhere [m]


def name_in_words(path: str) -> str:
    """Write the path of an input as forms and pictures do: "root stiffness" for "root_stiffness"."""
    words = path.replace(".", " ").replace("_", " ").split(" ")
    return " ".join(_NAMES.get(word, word) for word in words)


class Words(str):
    """A text made of parts, some of which each medium words in its own way.

    Parameters
    ----------
    *parts : str
        The parts, one after the other; those that are `Words` keep their own parts.
    """

    parts: tuple[str, ...]

    def __new__(cls, *parts: str) -> Self:  # noqa: D102
        made = super().__new__(cls, "".join(parts))
        made.parts = parts
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return arguments by position and by name that make an equal object, for pickles and files."""
        return self.parts, {}

    def __reduce__(self) -> tuple[Any, ...]:
        given, named = self.arguments()
        return partial(type(self), *given, **named), ()

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the text with each part as a medium words it."""
        return "".join(worded(part, word) for part in self.parts)


class Part(Words):
    """A part of a text that each medium words in its own way."""

    def in_units(self, units: Any) -> str:
        """Return the part in `DisplayUnits`, if it has a quantity in such units."""
        return str(self)

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the part as a medium words it."""
        return word(self)


class InputName(Part):
    """The name of an input: its path, as files and commands have it, and on a form the words of its field."""

    @property
    def on_form(self) -> str:
        """The name of its field on a form: "thickness" for "beam.thickness"."""
        return name_in_words(self.removeprefix("beam."))


class Named(Part):
    """A text worded in one way for Python, and in another for files and commands, such as "a RollingWheel".

    Parameters
    ----------
    in_python, elsewhere : str
        Both wordings.
    """

    elsewhere: str

    def __new__(cls, in_python: str, elsewhere: str) -> Self:  # noqa: D102
        made = super().__new__(cls, in_python)
        made.elsewhere = elsewhere
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return both words, as arguments that make an equal object."""
        return (str(self), self.elsewhere), {}


class Setting(Named):
    """Keys of a table of a scene's file, and their values: "[physics] shear = true", `Physics(shear=True)`.

    Parameters
    ----------
    table : str
        Name of the table.
    **keys : bool, int or str
        Values by their keys.
    """

    table: str
    keys: dict[str, Any]

    def __new__(cls, table: str, **keys: Any) -> Self:  # noqa: D102
        python = ", ".join(f"{key}={value!r}" for key, value in keys.items())
        made = super().__new__(cls, f"{table.capitalize()}({python})", f"[{table}] {_as_toml(keys)}")
        made.table, made.keys = table, keys
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return the table, and its keys by name, as arguments that make an equal object."""
        return (self.table,), self.keys

    def on_form(self, heading: str) -> str:
        """Write the setting as a form does, under the heading of its table."""
        return f"{heading}: {_as_toml({key.replace('_', ' '): value for key, value in self.keys.items()})}"


def amount(*values: Any, unit: str = "m", digits: int = 6) -> Named:
    """Format a length, an angle or the coordinates of a point [m or rad]; files and drawings have mm or deg.

    Lengths from 10 m on are in m everywhere.
    """
    small, factor = {"m": ("mm", 1e3), "rad": ("deg", 180 / math.pi)}[unit]
    if unit == "m" and max(map(abs, values), default=0.0) >= _LONG:
        small, factor = "m", 1.0
    return Named(_placed(values, digits, unit), _placed([factor * value for value in values], 6, small))


def _placed(numbers: Sequence[float], digits: int, unit: str) -> str:
    said = ", ".join(f"{number:.{digits}g}" for number in numbers)
    return f"({said}) {unit}" if len(numbers) > 1 else f"{said} {unit}"


def _as_toml(keys: Mapping[str, Any]) -> str:
    """Write keys and values as a file has them."""
    return ", ".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())


def worded(text: str, word: Callable[[Part], str]) -> str:
    """Return a text with each of its parts as a medium words it."""
    return text.worded(word) if isinstance(text, Words) else text
