"""One-line summaries: ``repr`` of results and of objects that a user makes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any

import numpy as np

LONGEST = 100  # most characters of a summary
_FEW = 4  # largest number of values that a summary lists one by one
_DIGITS = 4


class OneLine:
    """Base of classes whose ``repr`` is one line: the name of the class, and `headline` in brackets.

    In dataclasses and their subclasses, this ``repr`` replaces the one that dataclasses generate.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__repr__" not in vars(cls):  # the decorator `dataclass` keeps a `__repr__` that the class defines
            cls.__repr__ = OneLine.__repr__

    def headline(self) -> Iterable[str]:
        """Return the parts of the one-line summary; by default, the fields that differ from defaults."""
        return given_fields(self)

    def __repr__(self) -> str:
        name = type(self).__name__
        try:
            parts = [" ".join(part.split()) for part in self.headline() if part]
        except Exception:  # an incomplete object, in a debugger or during an error, may raise any exception
            parts = ["..."]
        line = f"{name}({', '.join(parts)})"
        for kept in range(len(parts) - 1, 0, -1):  # keeps only as many parts as fit on a line
            if len(line) <= LONGEST:
                return line
            line = f"{name}({', '.join(parts[:kept])}, ...)"
        return line if len(line) <= LONGEST else f"{name}({shortened(parts[0], LONGEST - len(name) - 2)})"


def shortened(text: str, most: int) -> str:
    """Shorten a text to a number of characters; three dots mark the omitted end."""
    return text if len(text) <= most else f"{text[: most - 3].rstrip(' ,')}..."


def given_fields(thing: Any) -> Iterator[str]:
    """Yield name and short value of each field of a dataclass that differs from its default."""
    for each in dataclasses.fields(thing) if dataclasses.is_dataclass(thing) else ():
        value = getattr(thing, each.name)
        try:
            usual = each.default is not dataclasses.MISSING and bool(value == each.default)
        except ValueError:  # the comparison of arrays has no single truth value
            usual = False
        if each.repr and not usual:
            yield f"{each.name}={brief(value)}"


def brief(value: object) -> str:
    """Format a value in few characters; arrays and containers by their size."""
    match value:
        case bool() | None:
            return str(value)
        case str():
            return repr(shortened(value, 30))
        case float() | np.number() | int():
            return number(value)
        case np.ndarray():
            return (
                number(value[()]) if value.ndim == 0 and value.dtype.kind in "iuf" else f"<{_shape(value)}>"
            )
        case list() | tuple() | dict() if len(value) > _FEW or any(
            not isinstance(v, float | int) for v in value
        ):
            return f"<{len(value)}>"
        case list() | tuple():
            return f"({', '.join(map(brief, value))})"
    if callable(value) and hasattr(value, "__name__"):
        return str(value.__name__)
    return repr(value)


def _shape(value: np.ndarray) -> str:
    return "x".join(map(str, value.shape)) or str(value)


# Parts of summaries ---------------------------------------------------------------------------------


_IS_PRELIMINARY: ContextVar[bool] = ContextVar("numbers are preliminary", default=False)
_OF_PRELIMINARY = 3  # significant digits of a preliminary number, whose relative error is some thousandths


@contextmanager
def few_digits() -> Iterator[None]:
    """In this context, format numbers with the few digits that a preliminary result has."""
    token = _IS_PRELIMINARY.set(True)
    try:
        yield
    finally:
        _IS_PRELIMINARY.reset(token)


def known_digits(value: float) -> float:
    """Return a number; within the context `few_digits`, rounded to the digits of a preliminary result."""
    return float(f"{value:.{_OF_PRELIMINARY}g}") if _IS_PRELIMINARY.get() else value


def number(value: Any, unit: str = "") -> str:
    """Format a number with four significant digits and its unit; with fewer digits within `few_digits`."""
    size = float(value) if not isinstance(value, complex) else abs(value)
    if not math.isfinite(size):
        return f"{size:g}{unit and ' ' + unit}" if not math.isnan(size) else "none"
    size = known_digits(size) + 0.0  # a negative zero becomes 0
    text = f"{size:.0f}" if 1e3 <= abs(size) < 1e6 else f"{size:.{_DIGITS}g}"
    return f"{text}{unit and ' ' + unit}"


def listed(values: Iterable[Any], unit: str = "") -> str:
    """Format numbers; of many numbers, only the first ones: "66.02, 413.8, 1158, ... Hz"."""
    each = [*values]
    more = ", ..." if len(each) > _FEW else ""
    return f"{', '.join(map(number, each[:_FEW]))}{more}{unit and ' ' + unit}" if each else ""


def spanned(values: np.ndarray | Sequence[float], unit: str = "") -> str:
    """Format the range of several numbers: "0 to 150 rad/s"."""
    known = np.asarray(values, dtype=float).ravel()
    known = known[np.isfinite(known)]
    if not known.size:
        return "none"
    low, high = number(known.min()), number(known.max())
    return f"{low} to {high}{unit and ' ' + unit}" if low != high else f"{low}{unit and ' ' + unit}"


def counted(count: int, word: str, many: str = "") -> str:
    """Format a count with its noun: "1 mode", "3 modes"; `many` is the plural if it does not just add s."""
    return f"{count} {word if count == 1 else many or word + 's'}"


def error_at_most(error: Any, unit: str = "") -> str:
    """Format the largest error with one digit, rounded up: "error <= 2e-12"; or say that it is unknown."""
    each = np.ravel(np.asarray(error, dtype=float))
    each = each[~np.isnan(each)]
    if not each.size:
        return "error not known"
    largest = float(np.abs(each).max())
    if math.isinf(largest):
        return "error unresolved"
    return f"error <= {rounded_up(largest)}{unit and ' ' + unit}"


# Factor on a number before it is rounded up, so that its rounding error does not turn 5e-8 into 6e-8.
_ROUNDED = 1 - 1e-12


def rounded_up(value: float) -> str:
    """Format a non-negative number with one significant digit, rounded up."""
    if not value:
        return "0"
    place = math.floor(math.log10(value))
    return next(f"{top:.0e}" for k in range(1, 12) if (top := float(f"{k}e{place}")) >= value * _ROUNDED)


def states(status: Iterable[Any], usual: Sequence[str]) -> str:
    """Count each status that is not among the `usual` ones, such as "2 divergence"; "" if there is none."""
    names, counts = np.unique([str(s).partition(":")[0] for s in np.ravel([*status])], return_counts=True)
    others = [f"{c} {n}" for n, c in zip(names.tolist(), counts.tolist(), strict=True) if n not in usual]
    return ", ".join(others)


def warned(warnings: Sequence[str]) -> str:
    """Format the number of warnings; empty if there are none."""
    return counted(len(warnings), "warning") if len(warnings) else ""
