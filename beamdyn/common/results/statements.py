"""Warnings, error messages and remarks as data: sentences with a kind that programs can test.

A statement is a string with the sentence in SI units.  It also stores speeds and inputs as numbers, so that a
table or page can convert them to its display units.  This module also issues Python warnings for results
outside linear theory.
"""

from __future__ import annotations

import functools
import math
import warnings
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from typing import Any, ParamSpec, Self, SupportsFloat, TypeVar

from beamdyn.common.words import InputName, Part, Words, worded

# Kinds of statements that programs can test.
OUTSIDE = "outside linear theory"  # the beam bends further than the theory of the analysis allows
MODEL_ERROR = "model error"  # effects that the model neglects change the result too much, or may do so
TOLERANCE = "tolerance"  # a numerical error exceeds the requested tolerance
GROWING = "unstable"  # the motion grows: it is unstable
NO_ANSWER = "no answer"  # some of many cases, or a part of the requested result, have no solution
INPUT = "input"  # an input has no effect, or is doubtful
EXCITATION = "excitation"  # no excitation moves the beam, or the excitation is doubtful
IN_LINE = "in line"  # loads act exactly along one line: any offset of a load would change the result
LIMITS = "limits"  # other limits of validity, such as large strain


class Speeds(Part):
    """Speeds in a sentence: "20 rad/s", or a range, "20 to 35 rad/s".

    Parameters
    ----------
    *values : float
        One speed, or both ends of a range [rad/s].
    digits : int
        Significant digits of each speed.
    """

    values: tuple[float, ...]
    digits: int

    def __new__(cls, *values: SupportsFloat, digits: int = 6) -> Self:  # noqa: D102
        numbers = tuple(map(float, values))
        made = super().__new__(cls, _spanning(numbers, digits, "rad/s"))
        made.values, made.digits = numbers, digits
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return the arguments (speeds, and the digits by name) that make an equal object."""
        return self.values, {"digits": self.digits}

    def in_units(self, units: Any) -> str:
        """Format the speeds in the given display units."""
        unit = units.speed_unit()
        return _spanning([unit.of(value) for value in self.values], self.digits, unit.name)


class InputValue(Part):
    """An input and its value in a sentence: "beam.thickness = 0.0002 m".

    Parameters
    ----------
    name : str
        Name of the input.
    value : float
        Value of the input, in SI units.
    unit : str
        The unit; empty for a pure number.
    digits : int
        Significant digits of the value.
    """

    name: str
    value: float
    unit: str
    digits: int

    def __new__(cls, name: str, value: SupportsFloat, unit: str, digits: int = 6) -> Self:  # noqa: D102
        made = super().__new__(cls, f"{name} = {float(value):.{digits}g} {unit}".rstrip())
        made.name, made.value, made.unit, made.digits = name, float(value), unit, digits
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return the arguments (name, value and unit; digits by name) that make an equal object."""
        return (self.name, self.value, self.unit), {"digits": self.digits}

    def in_units(self, units: Any) -> str:
        """Format the input with its value; a speed in the given display units."""
        if self.unit == "rad/s":
            return self.said(units.speed_unit().say(self.value))
        return self.said(f"{self.value:.{self.digits}g} {self.unit}".rstrip())

    def said(self, value: str) -> Words:
        """Join the name of the input and a text for the value: "name = text"."""
        return Words(InputName(self.name), f" = {value}")


def _spanning(numbers: Iterable[float], digits: int, unit: str) -> str:
    return " to ".join(dict.fromkeys(f"{number:.{digits}g}" for number in numbers)) + f" {unit}"


class Statement(Words):
    """A warning, error message or remark: a sentence that also stores its subject as data.

    Parameters
    ----------
    *parts : str
        Parts of the sentence.
    kind : str
        Kind of statement; one of the constants in `beamdyn.common.results.statements`.
    quantity : str
        The quantity that the sentence is about, such as "tip deflection over the length"; empty if there is
        none.
    value, limit : float
        Value and limit of the quantity; nan if there is no such number.
    remedy : str
        Advice to the user; empty if there is none.

    Examples
    --------
    >>> said = Statement("unstable at ", Speeds(50.0), kind=GROWING, quantity="growth rate", value=3.0)
    >>> said, said.kind, said.value
    ('unstable at 50 rad/s', 'unstable', 3.0)
    """

    kind: str
    quantity: str
    value: float
    limit: float
    remedy: str

    def __new__(  # noqa: D102
        cls,
        *parts: str,
        kind: str,
        quantity: str = "",
        value: SupportsFloat = math.nan,
        limit: SupportsFloat = math.nan,
        remedy: str = "",
    ) -> Self:
        made = super().__new__(cls, *parts)
        made.kind, made.quantity, made.remedy = kind, quantity, remedy
        made.value, made.limit = float(value), float(limit)
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return the arguments (parts; other data by name) that make an equal object."""
        data = {"kind": self.kind, "quantity": self.quantity, "value": self.value, "limit": self.limit}
        return self.parts, data | {"remedy": self.remedy}


def kind_of(sentence: str) -> str:
    """Return the kind of a statement; empty for a plain string, as in files of older versions."""
    return sentence.kind if isinstance(sentence, Statement) else ""


def of_kind(sentences: Iterable[str], *kinds: str) -> list[str]:
    """Return the sentences that are statements of the given kinds."""
    return [said for said in sentences if kind_of(said) in kinds]


def after(words: str, sentence: str) -> str:
    """Put words, such as the name of a scene, before a sentence; a statement keeps its data."""
    given, data = sentence.arguments() if isinstance(sentence, Statement) else ((sentence,), {})
    return Statement(words, *given, **data) if data else Words(words, *given)


def joined(separator: str, texts: Iterable[str]) -> Words:
    """Join texts with a separator; speeds in them can still be converted to display units."""
    parts = [part for text in texts for part in (separator, text)]
    return Words(*parts[1:])


def said_in(units: Any, text: str) -> str:
    """Return a text with its speeds converted to display units."""
    return worded(text, lambda part: part.in_units(units))


_REMEDY = '; Scene(..., physics="auto") adds the effects that matter'

Arguments = ParamSpec("Arguments")
Answer = TypeVar("Answer")
_within_another: ContextVar[bool] = ContextVar("within_another", default=False)


class OutsideLinearTheory(UserWarning):
    """Warning that a result of linear theory is for a beam that bends further than this theory allows.

    An analysis issues this Python warning once if the beam bends by more than a tenth of its length.  The
    ``warnings`` of the result contain the same sentence.  With ``physics="auto"`` in the scene, analyses
    include the effects that matter instead of warning.

    Examples
    --------
    To stop where this warning is issued, and to go on without it:

    >>> import warnings
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215, setting_angle=0.785))
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("error", bd.OutsideLinearTheory)
    ...     try:
    ...         modes = bd.natural_modes(scene, speed=100.0)
    ...     except bd.OutsideLinearTheory:
    ...         print("bent too far")
    bent too far
    >>> with warnings.catch_warnings():
    ...     warnings.simplefilter("ignore", bd.OutsideLinearTheory)
    ...     modes = bd.natural_modes(scene, speed=100.0)
    """


def announced(analysis: Callable[Arguments, Answer]) -> Callable[Arguments, Answer]:
    """Decorate an analysis so that it issues a Python warning if its result is outside linear theory.

    A script that reads only a number of the result then gets the warning, too.  An analysis that calls
    another analysis warns only once.
    """
    return _announcing(analysis, _REMEDY)


def announced_of_plain_beam(analysis: Callable[Arguments, Answer]) -> Callable[Arguments, Answer]:
    """Decorate an analysis like `announced`; its warning does not advise to use physics "auto"."""
    return _announcing(analysis, "")


def _announcing(analysis: Callable[Arguments, Answer], remedy: str) -> Callable[Arguments, Answer]:
    @functools.wraps(analysis)
    def announcing(*given: Arguments.args, **named: Arguments.kwargs) -> Answer:
        with unannounced():
            result = analysis(*given, **named)
        if sentences := getattr(result, "warnings", ()):
            announce(sentences, remedy)
        return result

    return announcing


def announce(sentences: tuple[str, ...], remedy: str = _REMEDY) -> None:
    """Issue statements that a result is outside linear theory as Python warnings.

    The warnings name the line that called the analysis: two calls above this one.
    """
    if not _within_another.get():
        for sentence in of_kind(sentences, OUTSIDE):
            warnings.warn(f"{sentence}{remedy}", OutsideLinearTheory, stacklevel=3)


@contextmanager
def unannounced() -> Iterator[None]:
    """In this context, issue no warnings of results outside linear theory; for analyses called by others."""
    before = _within_another.set(True)
    try:
        yield
    finally:
        _within_another.reset(before)
