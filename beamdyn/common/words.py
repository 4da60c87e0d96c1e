"""Texts made of parts that each medium (Python, files, forms) words in its own way, and numbers in them."""

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


# Numbers with the digits that their error justifies --------------------------------------------------

_MOST_DIGITS = 10  # largest number of digits that a table shows


def supported(value: float, error: float, most: int = _MOST_DIGITS) -> str:
    """Round a number so that half a unit of its last digit is not below its error.

    Parameters
    ----------
    value : float
        The number.
    error : float
        Absolute error of the number.
    most : int
        Largest number of significant digits.

    Returns
    -------
    str
        "0 ± error" where the error is half the number or more, "number ± error" where else no digit is sure,
        "unresolved" where the error is not known.
    """
    if not math.isfinite(value):
        return "none" if math.isnan(value) else str(value)
    if not math.isfinite(error):
        return "unresolved"
    if value == 0 and error == 0:
        return "0"
    if 2 * error >= abs(value):
        return f"0 ± {abs(value) + error:.1g}"
    lead = math.floor(math.log10(abs(value)))
    decimals = most - 1 - lead
    if error > 0:
        decimals = min(decimals, math.floor(-math.log10(2 * error)))
    if decimals + lead < 0:
        return _with_error(value, error)
    return f"{value:.{decimals}f}" if lead > -4 and decimals >= 0 else f"{value:.{decimals + lead}e}"


def supported_or_range(value: float, error: float, most: int = _MOST_DIGITS) -> str:
    """Format a number like `supported`, but as "number ± error" where only one digit is sure."""
    text = supported(value, error, most)
    if "±" in text or not (0 < 2 * error < abs(value) < math.inf):
        return text
    lead = math.floor(math.log10(abs(value)))
    return _with_error(value, error) if math.floor(-math.log10(2 * error)) + lead <= 0 else text


def _with_error(value: float, error: float) -> str:
    """Format a number with the digits up to the first of its error, and that error with one digit."""
    last = math.floor(math.log10(error))
    digits = max(math.floor(math.log10(abs(value))) - last, 0) + 1
    return f"{value:#.{digits}g} ± {error:.1g}".replace(". ", " ").replace(".e", "e")


def told_from(value: float, limit: float) -> str:
    """Format a number with two digits, or as many as tell it from a limit beside it."""
    texts = (f"{value:.{digits}g}" for digits in range(2, 18))
    return next((text for text in texts if float(text) != limit), f"{value:g}")


def percent(value: float, sign: str = "") -> str:
    """Format a relative number in percent with two digits, never with a positive exponent."""
    digits = f"{100 * value:{sign}.2g}"
    return f"{100 * value:{sign}.0f} %" if "e+" in digits else f"{digits} %"


def at_any(count: int, noun: str) -> str:
    """Say where something is not, of what is asked for one by one: "at any of 3 speeds", "at this speed"."""
    return f"at this {noun}" if count == 1 else f"at any of {count} {noun}s"


def count_sure(text: str, error: float) -> int:
    """Count the characters of a number's text up to the last digit that its error supports.

    Parameters
    ----------
    text : str
        A number as `supported` writes it.
    error : float
        Absolute error; nan or inf leaves no digit sure.

    Returns
    -------
    int
        The whole length if all digits are sure; a sign or decimal point counts only before a sure digit.
    """
    mantissa, _, exponent = text.partition("e")
    digits = mantissa.lstrip("-").replace(".", "", 1)
    if "±" in text or not digits.isdigit() or error == 0:
        return len(text)
    point = mantissa.find(".") if "." in mantissa else len(mantissa)
    scale = int(exponent or 0)
    sure = 0
    for i, character in enumerate(mantissa):
        place = scale + (point - i - 1 if i < point else point - i)  # power of ten of the digit
        if character.isdigit() and not 2 * error <= 10.0**place:
            break
        if character.isdigit():
            sure = i + 1
    else:
        return len(text)
    return sure
