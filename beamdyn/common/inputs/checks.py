"""Checks of input values. An invalid value raises `InvalidValue`, which holds the parts of its message."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, fields, replace
from types import NoneType, UnionType
from typing import Any, Self, get_args

import numpy as np

from beamdyn.common.words import Named, Part, Words, worded

MOST = 1e50  # largest input in SI units, so that products of six such numbers are far from overflow
_LONGEST = 60  # most characters of a value that a message shows


@dataclass(frozen=True)
class RefusedCases:
    """The invalid ones among N cases, with their values and limits.

    Parameters
    ----------
    bad : ndarray of bool, shape (N,)
        Whether each case is invalid.
    value : ndarray, shape (N,)
        The checked value in each case.
    limit : ndarray, shape (N,), optional
        The bound in each case, if it is a number.
    """

    bad: np.ndarray
    value: np.ndarray
    limit: np.ndarray | None

    def converted(self, convert: Callable[[float], float]) -> RefusedCases:
        """Return a copy with values and limits converted to another unit."""
        each = np.vectorize(convert, otypes=[float])
        return RefusedCases(self.bad, each(self.value), None if self.limit is None else each(self.limit))


@dataclass(eq=False)
class InvalidValue(ValueError):
    """Raised for an invalid input value; its message is made from its attributes, which callers may replace.

    Parameters
    ----------
    field : str
        Name of the argument, such as "radius"; "tip[0]" is the first number of a pair.  It may be empty.
    value : object
        The invalid value; if it is a number, it is in `unit`.
    bound : str
        What is wrong, or what to give.  In it and in `remedy`, ``{unit}``, ``{limit}``, ``{field}`` and
        ``{other}`` stand for the attributes of these names.
    remedy : str
        What to do, beyond keeping the bound.
    unit : str
        SI unit of `value` and `limit`.
    limit : float, optional
        The bound, if it is a number [unit].
    other : str
        Name of another argument that the message mentions.
    where : str
        Text after the value: the position at which it is invalid, or the number of invalid cases.
    cases : RefusedCases, optional
        The invalid cases, if the value is one of an array.
    """

    field: str
    value: object
    bound: str
    remedy: str = ""
    unit: str = ""
    limit: float | None = None
    other: str = ""
    where: str = ""
    cases: RefusedCases | None = None

    def __str__(self) -> str:
        return self.worded(str)

    def worded(self, word: Callable[[Part], str]) -> str:
        """Return the message, with the function `word` applied to each of its parts."""
        name = self.field and f"{self.field} = "
        return f"{name}{self.shown}{self.where}: {self.advice(word)}"

    def advice(self, word: Callable[[Part], str]) -> str:
        """Return bound and remedy, with the function `word` applied to each part."""
        remedy = self.remedy and f"; {worded(self.remedy, word)}"
        return self._filled(worded(self.bound, word) + remedy)

    def __reduce__(self) -> tuple[type, tuple[object, ...]]:
        return type(self), tuple(getattr(self, attribute.name) for attribute in fields(self))

    def in_unit(self, unit: str, convert: Callable[[float], float]) -> Self:
        """Return a copy of the error with its numbers converted to another unit."""
        value = convert(self.value) if isinstance(self.value, float) else self.value
        limit = None if self.limit is None else convert(self.limit)
        cases = None if self.cases is None else self.cases.converted(convert)
        return replace(self, value=value, limit=limit, unit=unit, cases=cases)

    def by_case(self) -> dict[int, InvalidValue]:
        """Return a separate error for each invalid case, by the index of the case."""
        if self.cases is None:
            return {}
        bad, value, limit = self.cases.bad, self.cases.value, self.cases.limit
        return {
            i: replace(
                self,
                value=float(value[i]),
                limit=None if limit is None else float(limit[i]),
                where="",
                cases=None,
            )
            for i in np.flatnonzero(bad).tolist()
        }

    @property
    def shown(self) -> str:
        """Return the value as shown in the message: a number with its unit, else as Python prints it."""
        if isinstance(self.value, float):
            return self._with_unit(self.value)
        text = " ".join(repr(self.value).split())  # the text of a matrix is put on one line
        return text if len(text) <= _LONGEST else text[: _LONGEST - 3] + "..."

    def _with_unit(self, number: float) -> str:
        return f"{number:.6g} {self.unit}".rstrip()

    def _filled(self, text: str) -> str:
        limit = "" if self.limit is None else self._with_unit(self.limit)
        named = text.replace("{field}", self.field).replace("{other}", self.other)
        return named.replace("{limit}", limit).replace("{unit}", self.unit)


OUT_OF_RANGE = (
    "the results leave the range of numbers: something is divided by zero, or past 1e308; check the size and "
    "the unit of each value"
)


def reason_of(error: Exception) -> str:
    """Return the message of an error; an overflow or division by zero is described in plain words."""
    beyond = isinstance(error, ZeroDivisionError | OverflowError | FloatingPointError)
    return OUT_OF_RANGE if beyond else str(error)


class NoModelAnswer(ValueError):
    """Raised for valid arguments for which the model has no solution, such as too high a speed."""


class BeyondModel(InvalidValue, NoModelAnswer):
    """Raised for a valid input value at which the model has no solution."""


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
    """Raise an `InvalidValue` if any case is invalid.

    Parameters
    ----------
    bad : bool or array of bool
        Which cases are invalid.
    name, unit, bound, remedy, other : str
        As for `InvalidValue`.
    value, limit : float or array
        Value and limit of each case [unit]; they broadcast to the shape of `bad`.

    Raises
    ------
    InvalidValue
        For the first invalid case; the message also has the number of invalid cases.
    """
    if not np.count_nonzero(bad):
        return
    bad = np.asarray(bad)
    more = f" (and {int(bad.sum()) - 1} more of {bad.size} cases)" if bad.sum() > 1 else ""
    values, limits = np.broadcast_to(value, bad.shape), None
    if limit is not None:
        limits = np.broadcast_to(limit, bad.shape)
    past = None if limits is None else float(limits[bad][0])
    cases = RefusedCases(bad, values, limits) if bad.ndim == 1 else None
    raise InvalidValue(name, float(values[bad][0]), bound, remedy, unit, past, other, more, cases)


# Single values ------------------------------------------------------------------------------------


def real(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """Return a float; raise an error unless it is a finite real number (of Python, numpy, Decimal ...)."""
    number = _as_float(value)
    if not math.isfinite(number):
        raise InvalidValue(name, value, "give a finite number" + in_unit(unit), remedy, unit)
    return number


def _as_float(value: Any) -> float:
    """Return a number as a float; nan for anything that is not a single real number."""
    of_numpy = hasattr(value, "dtype")
    if not hasattr(value, "__float__") or isinstance(value, bool) or (of_numpy and not _is_one(value)):
        return math.nan
    try:
        return float(value)
    except (TypeError, ValueError, ArithmeticError):
        return math.nan


def _is_one(value: Any) -> bool:
    """Return whether a numpy scalar or array holds exactly one real number."""
    return holds_reals(array := np.asanyarray(value)) and not array.ndim


def holds_reals(array: np.ndarray) -> bool:
    """Return whether an array holds real numbers only: no masked, boolean, text or complex entries."""
    if array.dtype.kind == "O":  # objects such as Decimal, or an integer of more than 64 bits
        return all(
            hasattr(each, "__float__") and not isinstance(each, bool | np.bool_) for each in array.flat
        )
    return array.dtype.kind in "iuf" and not hasattr(array, "mask")


def positive(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """Return a finite number; raise an error if it is not greater than zero."""
    number = real(name, value, unit, remedy)
    refuse(number <= 0, name, number, unit, "it must be greater than 0", remedy)
    return number


def moderate(name: str, value: object, unit: str = "") -> float:
    """Return a finite number; raise an error if it is so large that powers or products may overflow."""
    number = real(name, value, unit)
    refuse(abs(number) > MOST, name, number, unit, "give at most {limit} either way", limit=MOST)
    return number


def size(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """Return a number; raise an error unless above zero, or if so large or small that powers may overflow."""
    number = positive(name, value, unit, remedy)
    refuse(number < 1 / MOST, name, number, unit, "give a size of {limit} or more", remedy, limit=1 / MOST)
    refuse(number > MOST, name, number, unit, "give a size of at most {limit}", remedy, limit=MOST)
    return number


def not_negative(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """Return a finite number; raise an error if it is below zero."""
    number = real(name, value, unit, remedy)
    refuse(number < 0, name, number, unit, "it must be 0 or more", remedy)
    return number


def amount(name: str, value: object, unit: str = "") -> float:
    """Return a number; raise an error if it is below zero, or so large that powers may overflow."""
    number = not_negative(name, value, unit)
    refuse(number > MOST, name, number, unit, "give at most {limit}", limit=MOST)
    return number


def within(name: str, value: object, least: float, most: float) -> float:
    """Return a number; raise an error unless it is between `least` and `most`."""
    number = _as_float(value)
    if not least <= number <= most:
        raise InvalidValue(name, value, f"give a number from {least:g} to {most:g}")
    return number


def angle(name: str, value: object) -> float:
    """Return an angle [rad]; raise an error if it exceeds one turn in either direction."""
    number = real(name, value, "rad")
    degrees = Named(f"math.radians({number:g})", f'"{number:g} deg"')
    remedy = Words(f"if {number:g} degrees were meant, give ", degrees)
    refuse(abs(number) > 2 * math.pi, name, number, "rad", "it is beyond one turn (2 pi)", remedy)
    return number


def count(name: str, value: object, least: int = 1, most: float = math.inf, remedy: str = "") -> int:
    """Return a whole number; raise an error unless it is between `least` and `most`."""
    number = _as_float(value)
    if not (least <= number <= most and number.is_integer()):
        bounds = f"of {least} or more" if math.isinf(most) else f"from {least} to {most:.0f}"
        raise InvalidValue(name, value, f"give a whole number {bounds}", remedy)
    return int(number)


def flag(name: str, value: object) -> bool:
    """Return a bool; raise an error unless the value is True or False, of Python or numpy."""
    if not isinstance(value, bool | np.bool_):
        raise InvalidValue(name, value, "give True or False")
    return bool(value)


def kind(name: str, value: object, wanted: type | UnionType, remedy: str = "") -> None:
    """Raise an error unless an object is an instance of the given class, or of one of several classes."""
    if not isinstance(value, wanted):
        classes: tuple[Any, ...] = get_args(wanted) or (wanted,)
        known = {NoneType: "None", str: "text"}
        names = " or ".join(known.get(each, f"a {each.__name__}") for each in classes)
        raise InvalidValue(name, value, f"give {names}", remedy)


def several(name: str, values: Any, wanted: type, remedy: str = "") -> tuple[Any, ...]:
    """Return a sequence as a tuple; raise an error for an item that is not of the given class."""
    try:
        given = None if isinstance(values, str | bytes | dict) else tuple(values)
    except TypeError:
        given = None
    if given is None:
        raise InvalidValue(name, values, "give a sequence, such as a tuple", remedy)
    for k, each in enumerate(given):
        kind(f"{name}[{k}]", each, wanted, remedy)
    return given


def function(name: str, value: object, remedy: str = "") -> None:
    """Raise an error unless an object can be called."""
    if not callable(value):
        raise InvalidValue(name, value, "give a function", remedy)


def one_of(name: str, value: object, choices: Sequence[str]) -> None:
    """Raise an error unless a value is one of the given words."""
    if not isinstance(value, str) or value not in choices:
        *others, last = map(repr, choices)
        raise InvalidValue(name, value, f"give {', '.join(others)} or {last}")


def check_used(what: str, options: Mapping[str, Collection[str]], **given: object) -> None:
    """Raise an error for options that have no effect on the requested result.

    Parameters
    ----------
    what : str
        Name of the requested result.
    options : mapping of str to collection of str
        Names of the options that affect each result, by name of the result.
    **given : object
        The options; None for an option that is not given.

    Raises
    ------
    InvalidValue
        For an option without effect; the message names the results that depend on it.
    """
    for name, value in given.items():
        if value is not None and name not in options[what]:
            *others, last = (answer for answer, used in options.items() if name in used)
            users = f"{', '.join(others)} and {last} do" if others else f"{last} does"
            bound = f"{what} does not depend on it, only {users}"
            raise InvalidValue(name, value, bound, "leave it out, or ask for one that does")


# Sequences ----------------------------------------------------------------------------------------


def real_array(name: str, values: float | Sequence[float] | np.ndarray) -> np.ndarray:
    """Return a one-dimensional array of floats; raise an error unless all values are finite numbers."""
    array = as_floats(values)
    if array is None:
        raise InvalidValue(name, values, "give a sequence of numbers")
    if array.ndim != 1:
        raise InvalidValue(name, values, f"give a one-dimensional sequence; its shape is {array.shape}")
    refuse(~np.isfinite(array), name, array, "", "every value must be finite")
    return array


def as_floats(values: Any) -> np.ndarray | None:
    """Return an array of floats, of any shape; None unless all values are real numbers."""
    try:
        array = np.asanyarray(values)
        if (array.size and not holds_reals(array)) or _holds_truth(values):
            return None
        with np.errstate(over="ignore"):  # a number beyond the range of floats becomes inf
            return array.astype(float)
    # Raised by ragged lists, and by numbers beyond the range of float.
    except (TypeError, ValueError, ArithmeticError):
        return None


def _holds_truth(values: Any) -> bool:
    """Return whether a nested list holds True or False, which numpy would convert to a number."""
    return isinstance(values, list | tuple) and any(isinstance(each, bool | np.bool_) for each in values)


_UNIQUE, _IN_ORDER = "pass numpy.unique({field})", "give each once, in ascending order"


def ascending(name: str, values: float | Sequence[float] | np.ndarray) -> np.ndarray:
    """Return floats, shape (n,); raise an error unless they are finite and ascend without repeats.

    A single number gives length 1.
    """
    array = as_floats(values)
    array = real_array(name, array.reshape(1) if array is not None and not array.ndim else values)
    if not array.size:
        raise InvalidValue(name, values, "it is empty; give at least one value")
    bound, remedy = "it follows {limit}; values must ascend without repeats", Named(_UNIQUE, _IN_ORDER)
    refuse(array[1:] <= array[:-1], name, array[1:], "", bound, remedy, limit=array[:-1])
    return array


def set_fields(instance: object, **values: object) -> None:
    """Set fields of a frozen dataclass to their checked values while the object is constructed."""
    for name, value in values.items():
        object.__setattr__(instance, name, value)


def in_unit(unit: str) -> str:
    """Return " in {unit}", a placeholder to end a sentence; empty if the unit is empty."""
    return " in {unit}" if unit else ""
