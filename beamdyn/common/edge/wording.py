"""Messages of the core, which takes SI floats, reworded for files: their keys, and degrees for radians."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace

import numpy as np
from pydantic import BaseModel

from beamdyn.common.edge.inputs import describe
from beamdyn.common.edge.units import last_quantity, unit_as_written
from beamdyn.common.inputs.checks import OUT_OF_RANGE, InvalidValue

_SUSPECT = 12.0  # number of decades from 1, above which a number may be mistyped
_FAR = "far too large or too small beside the others: the results leave the range of numbers"
_CHECK = "check its exponent and its unit"


@contextmanager
def of_file(keys: Mapping[str, str]) -> Iterator[None]:
    """Reword `InvalidValue` errors in this context: keys of a file for arguments, and angles in degrees.

    Parameters
    ----------
    keys : mapping
        Keys by the names of the arguments that they stand for, e.g. ``{"lining[0]": "lining_start"}``.
    """
    try:
        yield
    except InvalidValue as error:
        named = replace(
            error, field=keys.get(error.field, error.field), other=keys.get(error.other, error.other)
        )
        raise (in_degrees(named) if error.unit == "rad" else named) from None


@contextmanager
def in_range(design: BaseModel) -> Iterator[None]:
    """Raise a ValueError for an overflow in this context, of which a mistyped exponent is the likely cause.

    Parameters
    ----------
    design : BaseModel
        The design that is computed. The message names its number farthest from 1, if that is far enough.

    Raises
    ------
    ValueError
        In place of an overflow or a division by zero.
    """
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            yield
    except (OverflowError, FloatingPointError, ZeroDivisionError):
        path, number = max(_numbers(dict(design)), key=lambda found: _decades(found[1]), default=("", 1.0))
        if _decades(number) < _SUSPECT:
            raise ValueError(OUT_OF_RANGE) from None
        units = {entry.path: entry.quantity.unit for entry in describe(type(design))}
        raise InvalidValue(path, number, _FAR, _CHECK, units.get(path, "")) from None


def _numbers(given: object, path: str = "") -> Iterator[tuple[str, float]]:
    """Yield the numbers of a design, each with its path, such as "pad[0]"."""
    match given:
        case float():
            yield path, given
        case np.ndarray():
            yield from ((path, float(number)) for number in given.ravel())
        case BaseModel() | dict():
            for key, value in dict(given).items():
                yield from _numbers(value, f"{path}.{key}".removeprefix("."))
        case list() | tuple():
            for i, value in enumerate(given):
                yield from _numbers(value, f"{path}[{i}]")


def _decades(number: float) -> float:
    """Return how far a size is from 1, in decades; 0 for zero."""
    return abs(math.log10(abs(number))) if number and math.isfinite(number) else 0.0


def in_degrees(error: InvalidValue) -> InvalidValue:
    """Convert the numbers of an error about an angle to degrees."""
    return error.in_unit("deg", math.degrees)


def in_millimetres(error: InvalidValue) -> InvalidValue:
    """Convert the numbers of an error about a length below a metre to mm; others are unchanged."""
    short = error.unit == "m" and isinstance(error.value, float) and abs(error.value) < 1
    return error.in_unit("mm", lambda metres: 1e3 * metres) if short else error


def in_unit_of(error: InvalidValue, text: str) -> InvalidValue:
    """Convert an error's numbers to the unit at the end of a text, as in "+-2 g/cm3", if the unit fits."""
    return error.in_unit(*unit_as_written(last_quantity(text), error.unit))
