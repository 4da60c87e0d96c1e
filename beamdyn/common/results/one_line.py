"""What objects are, in one line: ``repr`` of results and of what a user describes."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Iterable, Iterator, Sequence
from typing import Any

import numpy as np

LONGEST = 100  # letters of a line
_FEW = 4  # numbers that are listed
_DIGITS = 4


class OneLine:
    """Base of classes whose ``repr`` is one line: the class, and in brackets what `headline` says.

    It serves dataclasses and their subclasses, too: it takes the place of the ``repr`` that they would get.
    """

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        if "__repr__" not in vars(cls):  # a dataclass keeps a method that its class has
            cls.__repr__ = OneLine.__repr__

    def headline(self) -> Iterable[str]:
        """Parts of the line that shows an object; a class that defines none shows the fields it was given."""
        return given_fields(self)

    def __repr__(self) -> str:
        try:
            parts = [" ".join(part.split()) for part in self.headline() if part]
        except Exception:  # an incomplete object may raise anything, in a debugger or amid an error
            parts = ["..."]
        return _fitted(type(self).__name__, parts)


def _fitted(name: str, parts: list[str]) -> str:
    """As many parts as a line takes, the first one cut if it is longer."""
    line = f"{name}({', '.join(parts)})"
    for kept in range(len(parts) - 1, 0, -1):
        if len(line) <= LONGEST:
            return line
        line = f"{name}({', '.join(parts[:kept])}, ...)"
    return line if len(line) <= LONGEST else f"{name}({shortened(parts[0], LONGEST - len(name) - 2)})"


def shortened(text: str, most: int) -> str:
    """A text, cut with three points after at most so many letters."""
    return text if len(text) <= most else f"{text[: most - 3].rstrip(' ,')}..."


def given_fields(thing: Any) -> Iterator[str]:
    """Name and value of each field of a dataclass that has not its default value, in few letters."""
    if not dataclasses.is_dataclass(thing):
        return
    for each in dataclasses.fields(thing):
        value = getattr(thing, each.name)
        if each.repr and not _is_default(each, value):
            yield f"{each.name}={brief(value)}"


def _is_default(each: dataclasses.Field[Any], value: object) -> bool:
    try:
        return each.default is not dataclasses.MISSING and bool(value == each.default)
    except ValueError:  # the truth of an array is not defined
        return False


def brief(value: object) -> str:
    """A value in few letters: arrays and containers by their size."""
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


# Parts of lines -------------------------------------------------------------------------------------


def number(value: Any, unit: str = "") -> str:
    """A number with four digits and its unit."""
    size = float(value) if not isinstance(value, complex) else abs(value)
    if not math.isfinite(size):
        return f"{size:g}{unit and ' ' + unit}" if not math.isnan(size) else "none"
    size += 0.0  # a negative zero becomes 0
    text = f"{size:.0f}" if 1e3 <= abs(size) < 1e6 else f"{size:.{_DIGITS}g}"
    return f"{text}{unit and ' ' + unit}"


def listed(values: Iterable[Any], unit: str = "") -> str:
    """Numbers, the first of many: "66.02, 413.8, 1158, ... Hz"."""
    each = [*values]
    more = ", ..." if len(each) > _FEW else ""
    return f"{', '.join(map(number, each[:_FEW]))}{more}{unit and ' ' + unit}" if each else ""


def spanned(values: np.ndarray | Sequence[float], unit: str = "") -> str:
    """From where to where numbers go: "0 to 150 rad/s"."""
    known = np.asarray(values, dtype=float).ravel()
    known = known[np.isfinite(known)]
    if not known.size:
        return "none"
    low, high = number(known.min()), number(known.max())
    return f"{low} to {high}{unit and ' ' + unit}" if low != high else f"{low}{unit and ' ' + unit}"


def counted(count: int, word: str, many: str = "") -> str:
    """A number of things: "1 mode", "3 modes"."""
    return f"{count} {word if count == 1 else many or word + 's'}"


def error_at_most(error: Any, unit: str = "") -> str:
    """The largest error with one digit, rounded up: "error <= 2e-12"; in words where it is not known."""
    each = np.ravel(np.asarray(error, dtype=float))
    each = each[~np.isnan(each)]
    if not each.size:
        return "error not known"
    largest = float(np.abs(each).max())
    if math.isinf(largest):
        return "error unresolved"
    return f"error <= {rounded_up(largest)}{unit and ' ' + unit}"


_ROUNDED = 1 - 1e-12  # 5e-8 with an error in its last bit is no 6e-8


def rounded_up(value: float) -> str:
    """A number that is not negative with one digit, not below it but for rounding."""
    if not value:
        return "0"
    place = math.floor(math.log10(value))
    return next(f"{top:.0e}" for k in range(1, 12) if (top := float(f"{k}e{place}")) >= value * _ROUNDED)


def states(status: Iterable[Any], usual: Sequence[str]) -> str:
    """How many are in which state other than the usual ones: "2 divergence"."""
    names, counts = np.unique([str(s).partition(":")[0] for s in np.ravel([*status])], return_counts=True)
    others = [f"{c} {n}" for n, c in zip(names.tolist(), counts.tolist(), strict=True) if n not in usual]
    return ", ".join(others)


def warned(warnings: Sequence[str]) -> str:
    """How many warnings there are; nothing without."""
    return counted(len(warnings), "warning") if len(warnings) else ""
