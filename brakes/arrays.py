"""Checks of numbers that may be arrays: one case or many, by numpy broadcasting."""

from __future__ import annotations

from typing import Any

import numpy as np

Numbers = Any  # a float, or an array of floats: one value a case


def numbers(name: str, value: Any, unit: str = "") -> Numbers:
    """Finite floats: a float, or an array of any shape."""
    try:
        if isinstance(value, str | bytes | bool):
            raise TypeError
        array = np.asarray(value, dtype=float)
    except (TypeError, ValueError, OverflowError):
        raise ValueError(f"{name} = {value!r}: give a finite number, or an array{_in(unit)}") from None
    refuse(~np.isfinite(array), name, array, unit, "it must be a finite number")
    return array if array.ndim else float(array)


def positive(name: str, value: Any, unit: str = "", remedy: str = "") -> Numbers:
    """Finite floats above zero."""
    array = numbers(name, value, unit)
    refuse(np.asarray(array) <= 0, name, array, unit, "it must be greater than 0", remedy)
    return array


def not_negative(name: str, value: Any, unit: str = "", remedy: str = "") -> Numbers:
    """Finite floats of zero or more."""
    array = numbers(name, value, unit)
    refuse(np.asarray(array) < 0, name, array, unit, "it must be 0 or more", remedy)
    return array


def pair(name: str, value: Any, unit: str = "") -> tuple[Numbers, Numbers]:
    """Two finite floats or arrays."""
    try:
        first, second = value
    except (TypeError, ValueError):
        raise ValueError(f"{name} = {value!r}: give two numbers{_in(unit)}") from None
    return numbers(f"{name}[0]", first, unit), numbers(f"{name}[1]", second, unit)


def one_of(name: str, value: object, known: tuple[str, ...]) -> None:
    """A ValueError unless the value is one of the known words."""
    if value not in known:
        raise ValueError(f"{name} = {value!r}: give one of {', '.join(map(repr, known))}")


def together(**values: Any) -> None:
    """A ValueError unless the shapes broadcast."""
    shapes = {name: np.shape(value) for name, value in values.items()}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise ValueError(f"shapes do not broadcast: {listed}; give numbers, or arrays of one shape") from None


def refuse(bad: Any, name: str, value: Any, unit: str, bound: str, remedy: str = "") -> None:
    """A ValueError that names the first bad value and how many there are."""
    bad = np.asarray(bad)
    if not bad.any():
        return
    first = np.broadcast_to(value, bad.shape)[bad][0]
    more = f" (and {int(bad.sum()) - 1} more of {bad.size} cases)" if bad.sum() > 1 else ""
    space = f" {unit}" if unit else ""
    end = f"; {remedy}" if remedy else ""
    raise ValueError(f"{name} = {first:.6g}{space}{more}: {bound}{end}")


def first_where(bad: Any, values: Any) -> float:
    """The value of the first bad case, for a message; nan if there is none."""
    bad = np.asarray(bad)
    return float(np.broadcast_to(values, bad.shape)[bad][0]) if bad.any() else np.nan


def _in(unit: str) -> str:
    return f" in {unit}" if unit else ""
