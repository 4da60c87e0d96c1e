"""What the core says about a value, in the words of a file: its keys, and degrees for radians."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace

import numpy as np

from beamdyn.common.checks import InvalidValue, RefusedCases

_NUMBER = re.compile(r"-?\d+(?:\.\d+)?(?:e[-+]?\d+)?")
_AMOUNT = re.compile(
    rf"(?<![\w.])({_NUMBER.pattern}|\({_NUMBER.pattern}, {_NUMBER.pattern}\)) (m|rad)(?![\w/])"
)
_SMALLER = {"m": ("mm", 1e3), "rad": ("deg", 180 / math.pi)}


@contextmanager
def of_file(keys: Mapping[str, str]) -> Iterator[None]:
    """Within it, an `InvalidValue` names the keys of a file in place of the core's names, and degrees.

    Parameters
    ----------
    keys : mapping
        Names of the core and the keys that stand for them, e.g. ``{"lining[0]": "lining_start"}``.
    """
    try:
        yield
    except InvalidValue as error:
        named = replace(
            error, field=keys.get(error.field, error.field), other=keys.get(error.other, error.other)
        )
        raise (in_degrees(named) if error.unit == "rad" else named) from None


@contextmanager
def in_range() -> Iterator[None]:
    """Within it, numbers that overflow are a ValueError: a mistyped exponent has no answer."""
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            yield
    except (OverflowError, FloatingPointError, ZeroDivisionError) as error:
        raise ValueError(f"the numbers are out of range ({error}); check the size of each value") from None


def in_degrees(error: InvalidValue) -> InvalidValue:
    """The same about an angle in degrees."""
    value = math.degrees(error.value) if isinstance(error.value, float) else error.value
    limit = None if error.limit is None else math.degrees(error.limit)
    return replace(error, value=value, limit=limit, unit="deg", cases=_cases_in_degrees(error.cases))


def in_small_units(sentence: str) -> str:
    """A sentence of the core with its lengths and angles in mm and degrees, as drawings have them."""

    def convert(found: re.Match[str]) -> str:
        unit, factor = _SMALLER[found[2]]
        return _NUMBER.sub(lambda number: f"{factor * float(number[0]):.6g}", found[1]) + f" {unit}"

    return _AMOUNT.sub(convert, sentence)


def _cases_in_degrees(cases: RefusedCases | None) -> RefusedCases | None:
    if cases is None:
        return None
    limit = None if cases.limit is None else np.degrees(cases.limit)
    return RefusedCases(cases.bad, np.degrees(cases.value), limit)
