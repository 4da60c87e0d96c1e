"""Parts of a screen that an answer describes: sliders, points to drag, and the results that come first.

They are apart from `Screen`, so that a command can describe them without loading what draws a screen.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True)
class Slider:
    """A slider above the drawing, which changes nothing but the drawing.

    Parameters
    ----------
    label : str
        Name of the quantity that it sets.
    marks : tuple of str
        Labels of its positions 0, 1, ...
    step : float
        Step between positions when it is moved by hand.
    seconds : float
        Time to play it from one end to the other [s].
    onward : bool
        Whether it is played at a constant rate, and from 0 again after the end; else back and forth, slowly
        at both ends.
    """

    label: str
    marks: tuple[str, ...]
    step: float = 0.05
    seconds: float = 2.5
    onward: bool = False

    @property
    def last(self) -> float:
        """The slider's largest position."""
        return len(self.marks) - 1.0

    def place(self, elapsed: float) -> float:
        """Compute the position at a time [s] after play began."""
        if self.onward:
            return self.last * (elapsed / self.seconds % 1.0)
        return self.last * (1 - math.cos(math.pi * elapsed / self.seconds)) / 2

    def elapsed(self, place: float) -> float:
        """Compute the time after the start of play [s] at which a position is reached first."""
        if self.onward:
            return self.seconds * place / self.last
        if place >= self.last:
            return self.seconds
        return self.seconds / math.pi * math.acos(1 - 2 * max(place, 0.0) / self.last)


@dataclass(frozen=True)
class Drag:
    """A slider below a field of the form, which writes into the field.

    Parameters
    ----------
    path : str
        Path of the field's input.
    low, high, step : float
        Its range and step, in `unit`.
    unit : str
        Unit in which it writes.
    """

    path: str
    low: float
    high: float
    step: float
    unit: str


@dataclass(frozen=True)
class Preset:
    """A list above the fields of a table; each of its choices fills in some of them.

    Parameters
    ----------
    table : str
        Name of the table.
    words : str
        Name of the list, such as "material".
    choices : mapping
        By the name of a choice: texts by the path of their field.
    """

    table: str
    words: str
    choices: Mapping[str, Mapping[str, str]]

    def chosen(self, texts: Callable[[str], str]) -> str | None:
        """Return the name of the choice whose texts all fields have; None if there is no such choice."""
        return next(
            (
                name
                for name, each in self.choices.items()
                if all(texts(path) == text for path, text in each.items())
            ),
            None,
        )


class KeyResult(NamedTuple):
    """A result that comes first on a screen, such as ("stopping distance", "13.4 m").

    Parameters
    ----------
    words : str
        Name of the result.
    value : str
        The number with its unit, or a word.
    """

    words: str
    value: str


@dataclass(frozen=True)
class Handle:
    """A draggable point of a drawing, which writes into fields of the form.

    Parameters
    ----------
    label : str
        Name of the point.
    at : tuple of float
        Its place (x, y) [m].
    moved : callable
        ``moved(x, y)``: values in SI for a new place [m], by the path of their input: a number, or a pair for
        a point.
    scale : float
        Units of the drawing in a metre: 1000 where it is in mm.
    step : float
        Distance by which an arrow key moves it [m].
    grain : float
        Step to which a length is rounded [m].
    """

    label: str
    at: tuple[float, float]
    moved: Callable[[float, float], Mapping[str, float | tuple[float, float]]]
    scale: float = 1.0
    step: float = 5e-4
    grain: float = 1e-4
