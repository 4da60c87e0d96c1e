"""Checks of input values that may be arrays of many cases, with numpy's broadcasting."""

from __future__ import annotations

from collections.abc import Callable
from types import NoneType
from typing import Any, Literal, TypeVar, get_origin

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, as_floats, in_unit, refuse, set_fields
from beamdyn.common.inputs.described import described_hints, description, kinds_of

Numbers = Any  # a float, or an array of floats with one value for each case
Solved = TypeVar("Solved")


def numbers(name: str, value: Any, unit: str = "") -> Numbers:
    """Return a finite float, or an array of finite floats of any shape; raise an error for anything else."""
    array = as_floats(value)
    if array is None:
        raise InvalidValue(name, value, "give a finite number, or an array" + in_unit(unit), unit=unit)
    if not array.size:
        raise InvalidValue(name, value, "it is empty; give a number, or an array" + in_unit(unit), unit=unit)
    refuse(~np.isfinite(array), name, array, unit, "it must be a finite number")
    return array if array.ndim else float(array)


def positive(name: str, value: Any, unit: str = "", remedy: str = "") -> Numbers:
    """Return finite floats; raise an error if any of them is not greater than zero."""
    array = numbers(name, value, unit)
    refuse(np.asarray(array) <= 0, name, array, unit, "it must be greater than 0", remedy)
    return array


def not_negative(name: str, value: Any, unit: str = "", remedy: str = "") -> Numbers:
    """Return finite floats; raise an error if any of them is below zero."""
    array = numbers(name, value, unit)
    refuse(np.asarray(array) < 0, name, array, unit, "it must be 0 or more", remedy)
    return array


def pair(name: str, value: Any, unit: str = "") -> tuple[Numbers, Numbers]:
    """Return two finite floats or arrays; error messages name them by index, such as "tip[0]"."""
    try:
        first, second = value
    except (TypeError, ValueError):
        raise InvalidValue(name, value, "give two numbers" + in_unit(unit), unit=unit) from None
    return numbers(f"{name}[0]", first, unit), numbers(f"{name}[1]", second, unit)


def keep_checked(core: object) -> None:
    """Replace the numbers in a frozen dataclass by checked floats or arrays; None is not changed.

    Raises
    ------
    InvalidValue
        If a number is not finite, or outside the bounds of its description (pairs have no bounds).
    ValueError
        If the shapes of the numbers do not broadcast; fields that are lists may have any length.
    """
    found: dict[str, Any] = {}
    for name, hint in described_hints(type(core)).items():
        value, (kind, *others), described = getattr(core, name), kinds_of(hint), description(hint)
        if described is None or get_origin(kind) is Literal or (value is None and NoneType in others):
            continue
        if get_origin(kind) is tuple:
            checked = pair(name, value, described.unit)
            found |= {f"{name}[{k}]": each for k, each in enumerate(checked)}
        else:
            checked = numbers(name, value, described.unit)
            described.refuse_out_of_bounds(name, checked)
            found |= {} if get_origin(kind) is list else {name: checked}
        set_fields(core, **{name: checked})
    together(**found)


def together(**values: Any) -> None:
    """Raise a ValueError unless the shapes of all given values broadcast."""
    shapes = {name: np.shape(value) for name, value in values.items()}
    try:
        np.broadcast_shapes(*shapes.values())
    except ValueError:
        listed = ", ".join(f"{name} {shape}" for name, shape in shapes.items() if shape)
        raise ValueError(f"shapes do not broadcast: {listed}; give numbers, or arrays of one shape") from None


def solve_possible(
    solve: Callable[[np.ndarray], Solved], count: int
) -> tuple[Solved | None, np.ndarray, dict[int, InvalidValue]]:
    """Solve those cases among many whose inputs are valid.

    Parameters
    ----------
    solve : callable
        ``solve(rows)`` returns the result of the cases with these row numbers, as arrays.
    count : int
        Number of cases.

    Returns
    -------
    found : object
        Result of `solve`; None if all cases have invalid inputs.
    rows : ndarray of int
        Row numbers of the cases that are solved.
    refused : dict of int to InvalidValue
        The error of each invalid case, by row number.

    Raises
    ------
    InvalidValue
        If `solve` raises one that does not say which cases are invalid.
    """
    rows, refused = np.arange(count), dict[int, InvalidValue]()
    while rows.size:
        try:
            return solve(rows), rows, refused
        except InvalidValue as error:
            if error.cases is None or error.cases.bad.shape != rows.shape:
                raise
            refused |= {int(rows[i]): each for i, each in error.by_case().items()}
            rows = rows[~error.cases.bad]
    return None, rows, refused
