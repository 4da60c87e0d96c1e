"""Checks of input values; each message names the key, the value, the bound and the remedy."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np


def real(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """A finite real number as a float, or a ValueError that names it."""
    try:
        number = float(value)  # pyright: ignore[reportArgumentType]  (anything else is refused below)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if isinstance(value, str | bool) or not math.isfinite(number):
        raise ValueError(f"{name} = {value!r}: give a finite number{_in(unit)}{_and(remedy)}")
    return number


def positive(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """A finite number above zero."""
    number = real(name, value, unit, remedy)
    if number <= 0:
        raise ValueError(f"{name} = {number:g}{_unit(unit)}: it must be greater than 0{_and(remedy)}")
    return number


def not_negative(name: str, value: object, unit: str = "", remedy: str = "") -> float:
    """A finite number of zero or more."""
    number = real(name, value, unit, remedy)
    if number < 0:
        raise ValueError(f"{name} = {number:g}{_unit(unit)}: it must be 0 or more{_and(remedy)}")
    return number


def within(name: str, value: object, least: float, most: float) -> float:
    """A number from `least` to `most`."""
    number = real(name, value)
    if not least <= number <= most:
        raise ValueError(f"{name} = {number:g}: give a number from {least:g} to {most:g}")
    return number


def angle(name: str, value: object) -> float:
    """An angle within one turn either way [rad]."""
    number = real(name, value, "rad")
    if abs(number) > 2 * math.pi:
        raise ValueError(
            f"{name} = {number:g} rad: beyond one turn (2 pi); "
            f"if {number:g} degrees were meant, give math.radians({number:g})"
        )
    return number


def kind(name: str, value: object, wanted: type, remedy: str = "") -> None:
    """A ValueError if a value is not of the wanted class."""
    if not isinstance(value, wanted):
        raise ValueError(f"{name} = {value!r}: give a {wanted.__name__}{_and(remedy)}")


def count(name: str, value: object, least: int = 1) -> int:
    """A whole number of at least `least`."""
    number = real(name, value)
    if number != int(number) or number < least:
        raise ValueError(f"{name} = {value!r}: give a whole number of {least} or more")
    return int(number)


def real_array(name: str, values: Sequence[float] | np.ndarray) -> np.ndarray:
    """A one-dimensional array of finite floats."""
    try:
        array = np.asarray(values, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} = {values!r}: give a sequence of numbers") from None
    if array.ndim != 1:
        raise ValueError(f"{name} has shape {array.shape}: give a one-dimensional sequence")
    if not np.isfinite(array).all():
        bad = array[~np.isfinite(array)][0]
        raise ValueError(f"{name} contains {bad}: every value must be finite")
    return array


def ascending(name: str, values: Sequence[float] | np.ndarray) -> np.ndarray:
    """A one-dimensional array of finite floats, each greater than the one before, at least one."""
    array = real_array(name, values)
    if not array.size:
        raise ValueError(f"{name} is empty: give at least one value")
    step = np.diff(array)
    if (step <= 0).any():
        k = int((step <= 0).argmax())
        raise ValueError(
            f"{name}: {array[k]:g} is followed by {array[k + 1]:g}; values must ascend without repeats: "
            f"pass numpy.unique({name})"
        )
    return array


def _in(unit: str) -> str:
    return f" in {unit}" if unit else ""


def _unit(unit: str) -> str:
    return f" {unit}" if unit else ""


def _and(remedy: str) -> str:
    return f"; {remedy}" if remedy else ""
