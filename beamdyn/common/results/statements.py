"""Warnings, refusals and remarks as data: sentences with a kind that programs can ask for.

As a string, each is the sentence in SI units; speeds and inputs in it are numbers, which a medium converts to
the units that it shows.  Python's warnings of results outside linear theory are issued here, too.
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

# Kinds of statements that programs ask for.
OUTSIDE = "outside linear theory"  # the beam bends further than the theory of the answer allows
MODEL_ERROR = "model error"  # what the model leaves out changes the answer too much, or may
TOLERANCE = "tolerance"  # a numerical error exceeds what was asked for
GROWING = "unstable"  # the motion grows
NO_ANSWER = "no answer"  # no answer to some of many cases, or to a part of the question
INPUT = "input"  # something given has no effect, or is doubtful
EXCITATION = "excitation"  # nothing moves the beam, or what moves it is doubtful
IN_LINE = "in line"  # loads act exactly in line, where any offset changes the answer
LIMITS = "limits"  # other limits of validity: large strain, few vibrations


class Speeds(Part):
    """Speeds in a text: "20 rad/s", or a range of them, "20 to 35 rad/s".

    Parameters
    ----------
    *values : float
        One speed or two [rad/s].
    digits : int
        Digits of each.
    """

    values: tuple[float, ...]
    digits: int

    def __new__(cls, *values: SupportsFloat, digits: int = 6) -> Self:  # noqa: D102
        numbers = tuple(map(float, values))
        made = super().__new__(cls, _spanning(numbers, digits, "rad/s"))
        made.values, made.digits = numbers, digits
        return made

    def arguments(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """Return the speeds, and the digits by name, as arguments that make an equal object."""
        return self.values, {"digits": self.digits}

    def in_units(self, units: Any) -> str:
        """Format the speeds in a display unit."""
        unit = units.speed_unit()
        return _spanning([unit.of(value) for value in self.values], self.digits, unit.name)


class InputValue(Part):
    """An input and its value in a text: "beam.thickness = 0.0002 m".

    Parameters
    ----------
    name : str
        Name of the input.
    value : float
        Its value, in SI.
    unit : str
        The unit; empty for a pure number.
    digits : int
        Digits of the value.
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
        """Return name, value and unit, and the digits by name, as arguments that make an equal object."""
        return (self.name, self.value, self.unit), {"digits": self.digits}

    def in_units(self, units: Any) -> str:
        """Format the input with its value, in a display unit if it is a speed."""
        if self.unit == "rad/s":
            return self.said(units.speed_unit().say(self.value))
        return self.said(f"{self.value:.{self.digits}g} {self.unit}".rstrip())

    def said(self, value: str) -> Words:
        """Join the name of the input and a text for its value: "name = text"."""
        return Words(InputName(self.name), f" = {value}")


def _spanning(numbers: Iterable[float], digits: int, unit: str) -> str:
    return " to ".join(dict.fromkeys(f"{number:.{digits}g}" for number in numbers)) + f" {unit}"


class Statement(Words):
    """A warning, refusal or remark: its sentence, and what it says as data.

    Parameters
    ----------
    *parts : str
        Parts of the sentence.
    kind : str
        Subject; one of the kinds in `beamdyn.common.results.statements`.
    quantity : str
        The quantity that it is about, such as "tip deflection over the length"; empty if it is about none.
    value, limit : float
        The quantity, and what it should not pass; nan where there is no such number.
    remedy : str
        Advice; empty where there is none.

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
        """Return the parts, and the data by name, as arguments that make an equal object."""
        data = {"kind": self.kind, "quantity": self.quantity, "value": self.value, "limit": self.limit}
        return self.parts, data | {"remedy": self.remedy}


def kind_of(sentence: str) -> str:
    """Return the kind of a statement; empty for a plain sentence, as in files of older versions."""
    return sentence.kind if isinstance(sentence, Statement) else ""


def of_kind(sentences: Iterable[str], *kinds: str) -> list[str]:
    """Return those sentences that are statements of given kinds."""
    return [said for said in sentences if kind_of(said) in kinds]


def after(words: str, sentence: str) -> str:
    """Return a sentence with words before it, such as the name of a scene; a statement stays a statement."""
    given, data = sentence.arguments() if isinstance(sentence, Statement) else ((sentence,), {})
    return Statement(words, *given, **data) if data else Words(words, *given)


def joined(separator: str, texts: Iterable[str]) -> Words:
    """Join texts with a separator; parts with speeds stay convertible."""
    parts = [part for text in texts for part in (separator, text)]
    return Words(*parts[1:])


def said_in(units: Any, text: str) -> str:
    """Return a text with its speeds in display units."""
    return worded(text, lambda part: part.in_units(units))


_REMEDY = '; Scene(..., physics="auto") adds what matters'

Arguments = ParamSpec("Arguments")
Answer = TypeVar("Answer")
_within_another: ContextVar[bool] = ContextVar("within_another", default=False)


class OutsideLinearTheory(UserWarning):
    """Warning that a number of linear theory is about a beam that bends further than this theory allows.

    Analyses issue this warning of Python, once each, where the beam bends by more than a
    tenth of its length; the result says so in its ``warnings``, too.  With ``physics="auto"`` of the scene,
    analyses add the effects that matter instead.

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
    """Make an analysis warn, as Python does, where its result says that it lies outside linear theory.

    So a script that reads one number of the result is told, too.  An analysis that calls another warns once.
    """
    return _announcing(analysis, _REMEDY)


def announced_of_plain_beam(analysis: Callable[Arguments, Answer]) -> Callable[Arguments, Answer]:
    """Make an analysis of the straight beam alone warn, without advice on physics "auto"."""
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
    """Issue statements that a result lies outside linear theory as warnings to the caller's caller."""
    if not _within_another.get():
        for sentence in of_kind(sentences, OUTSIDE):
            warnings.warn(f"{sentence}{remedy}", OutsideLinearTheory, stacklevel=3)


@contextmanager
def unannounced() -> Iterator[None]:
    """Suppress warnings of results outside linear theory in this context, for analyses within others."""
    before = _within_another.set(True)
    try:
        yield
    finally:
        _within_another.reset(before)
