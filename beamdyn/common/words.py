"""Texts with parts that Python, files and forms word differently, and formatting of numbers in texts."""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Mapping, Sequence
from decimal import ROUND_CEILING, ROUND_FLOOR, Context
from functools import partial
from typing import Any, Self

_NAMES = {"youngs": "Young's", "poissons": "Poisson's"}  # words whose apostrophe is missing in keys
_LONG = 10.0  # lengths of this size or more are shown in m in all media [m]


def name_in_words(path: str) -> str:
    """Return the path of an input as shown in forms and pictures: "root stiffness" for "root_stiffness"."""
    words = path.replace(".", " ").replace("_", " ").split(" ")
    return " ".join(_NAMES.get(word, word) for word in words)


class Words(str):
    """A text with parts that each medium (Python, files, forms) words differently.

    Parameters
    ----------
    *parts : str
        Parts of the text in their order; a part that is a `Words` object keeps its own parts.
    """

    parts: tuple[str, ...]

    def __new__(cls, *parts: str) -> Self:  # noqa: D102
        made = super().__new__(cls, "".join(parts))
        made.parts = parts
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return arguments by position and by name that make an equal object, for pickling and saving."""
        return self.parts, {}

    def __reduce__(self) -> tuple[Any, ...]:
        given, named = self.arguments()
        return partial(type(self), *given, **named), ()

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the text, with the function `word` applied to each part."""
        return "".join(worded(part, word) for part in self.parts)


class Part(Words):
    """A part of a text that each medium (Python, files, forms) words differently."""

    def in_units(self, units: Any) -> str:
        """Return the part in the given `DisplayUnits`, if it contains a quantity with such units."""
        return str(self)

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the wording of the part that the function `word` of a medium gives."""
        return word(self)


class InputName(Part):
    """The name of an input: its path in files and commands, and the name of its field in forms."""

    @property
    def on_form(self) -> str:
        """Return the name of the input's field in a form: "thickness" for "beam.thickness"."""
        return name_in_words(self.removeprefix("beam."))


class Named(Part):
    """A text with one wording in Python, and another in files and commands, such as "a RollingWheel".

    Parameters
    ----------
    in_python, elsewhere : str
        Wording in Python, and in all other media.
    """

    elsewhere: str

    def __new__(cls, in_python: str, elsewhere: str) -> Self:  # noqa: D102
        made = super().__new__(cls, in_python)
        made.elsewhere = elsewhere
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return both wordings, as arguments that make an equal object."""
        return (str(self), self.elsewhere), {}


class Setting(Named):
    """Settings: "[physics] shear = true" in a scene file, the call `Physics(shear=True)` in Python.

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
        """Return the table name, and its keys by name, as arguments that make an equal object."""
        return (self.table,), self.keys

    def on_form(self, heading: str) -> str:
        """Return the setting as a form shows it, under the heading of its table."""
        return f"{heading}: {_as_toml({key.replace('_', ' '): value for key, value in self.keys.items()})}"


def amount(*values: Any, unit: str = "m", digits: int = 6) -> Named:
    """Format a length, an angle or a point's coordinates [m or rad]; files and drawings use mm or deg.

    Lengths of 10 m or more are shown in m in all media.
    """
    small, factor = {"m": ("mm", 1e3), "rad": ("deg", 180 / math.pi)}[unit]
    if unit == "m" and max(map(abs, values), default=0.0) >= _LONG:
        small, factor = "m", 1.0
    return Named(_placed(values, digits, unit), _placed([factor * value for value in values], 6, small))


def _placed(numbers: Sequence[float], digits: int, unit: str) -> str:
    said = ", ".join(f"{number:.{digits}g}" for number in numbers)
    return f"({said}) {unit}" if len(numbers) > 1 else f"{said} {unit}"


def _as_toml(keys: Mapping[str, Any]) -> str:
    """Return keys and values in the notation of files."""
    return ", ".join(f"{key} = {json.dumps(value)}" for key, value in keys.items())


def worded(text: str, word: Callable[[Part], str]) -> str:
    """Return a text, with the function `word` applied to each of its parts."""
    return text.worded(word) if isinstance(text, Words) else text


# Numbers with the digits that their errors justify --------------------------------------------------

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
        The rounded number; "0 ± bound" if the error is at least half the number's magnitude, where the bound
        is their sum; "number ± error" if the error is smaller, but the first digit is uncertain; "unresolved"
        if the error is not finite; "none" if the number is nan.
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
    """Format a number like `supported`, but as "number ± error" if only one digit is certain."""
    text = supported(value, error, most)
    if "±" in text or not (0 < 2 * error < abs(value) < math.inf):
        return text
    lead = math.floor(math.log10(abs(value)))
    return _with_error(value, error) if math.floor(-math.log10(2 * error)) + lead <= 0 else text


def lower_bound(value: float, error: float = 0.0) -> str:
    """Format a number minus its error, rounded down to the digits of a table, so that it is a lower bound."""
    return _rounded(value - error, ROUND_FLOOR)


def upper_bound(value: float, error: float = 0.0) -> str:
    """Format a number plus its error, rounded up to the digits of a table, so that it is an upper bound."""
    return _rounded(value + error, ROUND_CEILING)


def _rounded(value: float, rounding: str) -> str:
    if not math.isfinite(value):
        return "none" if math.isnan(value) else str(value)
    return f"{float(Context(_MOST_DIGITS, rounding).create_decimal(value)):.{_MOST_DIGITS}g}"


def _with_error(value: float, error: float) -> str:
    """Format a number with digits down to the first digit of its error, and the error with one digit."""
    last = math.floor(math.log10(error))
    digits = max(math.floor(math.log10(abs(value))) - last, 0) + 1
    return f"{value:#.{digits}g} ± {error:.1g}".replace(". ", " ").replace(".e", "e")


def told_from(value: float, limit: float) -> str:
    """Format a number with two digits, or with more if these are needed to distinguish it from a limit."""
    texts = (f"{value:.{digits}g}" for digits in range(2, 18))
    return next((text for text in texts if float(text) != limit), f"{value:g}")


def percent(value: float, sign: str = "") -> str:
    """Format a fraction in percent with two digits, never with a positive exponent.

    With the `sign` "+", positive numbers have a plus sign.
    """
    digits = f"{100 * value:{sign}.2g}"
    return f"{100 * value:{sign}.0f} %" if "e+" in digits else f"{digits} %"


def at_any(count: int, noun: str) -> str:
    """Return words for where a result is missing: "at any of 3 speeds", or "at this speed" for one."""
    return f"at this {noun}" if count == 1 else f"at any of {count} {noun}s"


def count_sure(text: str, error: float) -> int:
    """Count the characters of a number's text up to the last digit that its error supports.

    Parameters
    ----------
    text : str
        A number as formatted by `supported`.
    error : float
        Absolute error of the number; for nan or inf, no digit is certain.

    Returns
    -------
    int
        The length of the text if all digits are certain; a sign or decimal point counts only before a certain
        digit.
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
