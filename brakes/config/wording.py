"""What the core says about a value, in the words of a file: its keys, and degrees for radians."""

from __future__ import annotations

import math
import re
from collections.abc import Iterator, Mapping
from contextlib import contextmanager

import numpy as np

_ANGLE = re.compile(r"([-+]?\d[\d.]*(?:e[-+]?\d+)?) rad\b(?!/)")


@contextmanager
def of_file(keys: Mapping[str, str]) -> Iterator[None]:
    """Within it, a ValueError names the keys of a file in place of the core's names, and degrees.

    Parameters
    ----------
    keys : mapping
        Names of the core and the keys that stand for them, e.g. ``{"lining[0]": "lining_start"}``.
    """
    try:
        yield
    except ValueError as error:
        message = str(error)
        for name, key in keys.items():
            message = message.replace(name, key)
        raise ValueError(in_degrees(message)) from None


@contextmanager
def in_range() -> Iterator[None]:
    """Within it, numbers that overflow are a ValueError: a mistyped exponent has no answer."""
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            yield
    except (OverflowError, FloatingPointError, ZeroDivisionError) as error:
        raise ValueError(f"the numbers are out of range ({error}); check the size of each value") from None


def in_degrees(message: str) -> str:
    """A message with its angles in degrees."""
    degrees = _ANGLE.sub(lambda found: f"{math.degrees(float(found[1])):.6g} deg", message)
    return re.sub(r"\brad\b(?!/)", "deg", degrees)
