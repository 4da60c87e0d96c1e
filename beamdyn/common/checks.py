"""Checks of input values.  Each refusal is an `InvalidValue`, which carries what its message says."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

_LONGEST = 60  # characters of a value that a message shows


@dataclass(eq=False)
class InvalidValue(ValueError):
    """A value that is refused.  Its message is composed from its attributes, which callers may replace.

    Parameters
    ----------
    field : str
        Name of the argument, such as "radius"; "tip[0]" is the first number of a pair.  It may be empty.
    value : object
        The refused value; a number is in `unit`.
    bound : str
        What is wrong, or what to give.  In it and in `remedy`, ``{unit}``, ``{limit}`` and ``{other}``
        stand for the attributes of these names.
    remedy : str
        What to do, beyond keeping the bound.
    unit : str
        SI unit of `value` and `limit`.
    limit : float, optional
        The bound, where it is a number [unit].
    other : str
        Name of another argument that the message mentions.
    where : str
        Said after the value: where it is refused, or in how many cases.
    """

    field: str
    value: object
    bound: str
    remedy: str = ""
    unit: str = ""
    limit: float | None = None
    other: str = ""
    where: str = ""

    def __str__(self) -> str:
        name, remedy = self.field and f"{self.field} = ", self.remedy and f"; {self.remedy}"
        return f"{name}{self.shown}{self.where}: {self._filled(self.bound + remedy)}"

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), tuple(getattr(self, attribute.name) for attribute in fields(self))

    @property
    def shown(self) -> str:
        """The value in the message: a number with its unit, anything else as Python writes it."""
        if isinstance(self.value, float):
            return self._with_unit(self.value)
        text = repr(self.value)
        return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."

    def _with_unit(self, number: float) -> str:
        return f"{number:.6g} {self.unit}".rstrip()

    def _filled(self, text: str) -> str:
        limit = "" if self.limit is None else self._with_unit(self.limit)
        return text.replace("{limit}", limit).replace("{unit}", self.unit).replace("{other}", self.other)


def refuse(
    bad: Any,
    name: str,
    value: Any,
    unit: str,
    bound: str,
    remedy: str = "",
    *,
    limit: Any = None,
    other: str = "",
) -> None:
    """Raise an `InvalidValue` if any case is bad.

    Parameters
    ----------
    bad : bool or array of bool
        Which cases are refused.
    name, unit, bound, remedy, other : str
        As for `InvalidValue`.
    value, limit : float or array
        Value and limit of each case [unit]; they broadcast to the shape of `bad`.

    Raises
    ------
    InvalidValue
        With the first bad case, and how many there are.
    """
    bad = np.asarray(bad)
    if not bad.any():
        return
    more = f" (and {int(bad.sum()) - 1} more of {bad.size} cases)" if bad.sum() > 1 else ""
    past = None if limit is None else _first(limit, bad)
    raise InvalidValue(name, _first(value, bad), bound, remedy, unit, past, other, more)


def _first(values: Any, bad: np.ndarray) -> float:
    """The value of the first bad case."""
    return float(np.broadcast_to(values, bad.shape)[bad][0])


# Single values ------------------------------------------------------------------------------------


def real(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """A finite real number as a float."""
    try:
        number = float(value)  # pyright: ignore[reportArgumentType]  (anything else is refused below)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if isinstance(value, str | bool) or not math.isfinite(number):
        raise InvalidValue(name, value, "give a finite number" + in_unit(unit), remedy, unit)
    return number


def positive(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """A finite number above zero."""
    number = real(name, value, unit, remedy)
    refuse(number <= 0, name, number, unit, "it must be greater than 0", remedy)
    return number


def not_negative(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """A finite number of zero or more."""
    number = real(name, value, unit, remedy)
    refuse(number < 0, name, number, unit, "it must be 0 or more", remedy)
    return number


def within(name: str, value: object, least: float, most: float) -> float:
    """A number from `least` to `most`."""
    number = real(name, value)
    bound = f"give a number from {least:g} to {most:g}"
    refuse(not least <= number <= most, name, number, "", bound)
    return number


def angle(name: str, value: object) -> float:
    """An angle within one turn either way [rad]."""
    number = real(name, value, "rad")
    remedy = f"if {number:g} degrees were meant, give math.radians({number:g})"
    refuse(abs(number) > 2 * math.pi, name, number, "rad", "it is beyond one turn (2 pi)", remedy)
    return number


def count(name: str, value: object, least: int = 1) -> int:
    """A whole number of at least `least`."""
    number = real(name, value)
    if number != int(number) or number < least:
        raise InvalidValue(name, value, f"give a whole number of {least} or more")
    return int(number)


def kind(name: str, value: object, wanted: type, remedy: str = "") -> None:
    """Refuse what is not of the wanted class."""
    if not isinstance(value, wanted):
        raise InvalidValue(name, value, f"give a {wanted.__name__}", remedy)


def one_of(name: str, value: object, choices: Sequence[str]) -> None:
    """Refuse what is not one of a few words."""
    if value not in choices:
        *others, last = map(repr, choices)
        raise InvalidValue(name, value, f"give {', '.join(others)} or {last}")


# Sequences ----------------------------------------------------------------------------------------


def real_array(name: str, values: Sequence[float] | np.ndarray) -> np.ndarray:
    """A one-dimensional array of finite floats."""
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise InvalidValue(name, values, "give a sequence of numbers") from None
    if array.ndim != 1:
        raise InvalidValue(name, values, f"give a one-dimensional sequence; its shape is {array.shape}")
    refuse(~np.isfinite(array), name, array, "", "every value must be finite")
    return array


def ascending(name: str, values: Sequence[float] | np.ndarray) -> np.ndarray:
    """A one-dimensional array of finite floats, each greater than the one before, at least one."""
    array = real_array(name, values)
    if not array.size:
        raise InvalidValue(name, values, "it is empty; give at least one value")
    bound, remedy = "it follows {limit}; values must ascend without repeats", "pass numpy.unique({other})"
    refuse(np.diff(array) <= 0, name, array[1:], "", bound, remedy, limit=array[:-1], other=name)
    return array


def in_unit(unit: str) -> str:
    """The unit in a sentence, such as " in m"; empty if there is none."""
    return " in {unit}" if unit else ""
