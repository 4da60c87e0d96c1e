"""Parts of a screen: sliders, points that the user can drag, and the most important results.

They are separate from `Screen`, so that a command can use them without importing the modules that draw a
screen.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import NamedTuple


@dataclass(frozen=True)
class Slider:
    """A slider above the drawing, which affects the drawing but not the result.

    Parameters
    ----------
    label : str
        Name of the quantity that the slider sets.
    marks : tuple of str
        Labels of the positions 0, 1, ...
    step : float
        Step between positions when the user moves the slider.
    seconds : float
        Duration of the animation from one end to the other [s].
    onward : bool
        Whether the animation runs at a constant rate and starts again at 0 after the end; else it runs back
        and forth, slowly near both ends.
    """

    label: str
    marks: tuple[str, ...]
    step: float = 0.05
    seconds: float = 2.5
    onward: bool = False

    @property
    def last(self) -> float:
        """Return the largest position of the slider."""
        return len(self.marks) - 1.0

    def place(self, elapsed: float) -> float:
        """Compute the slider's position at a time [s] after the start of the animation."""
        if self.onward:
            return self.last * (elapsed / self.seconds % 1.0)
        return self.last * (1 - math.cos(math.pi * elapsed / self.seconds)) / 2

    def elapsed(self, place: float) -> float:
        """Compute the time after the start of the animation [s] at which a position is first reached."""
        if self.onward:
            return self.seconds * place / self.last
        if place >= self.last:
            return self.seconds
        return self.seconds / math.pi * math.acos(1 - 2 * max(place, 0.0) / self.last)


@dataclass(frozen=True)
class Drag:
    """A slider below a field of the form, which sets the field's text.

    Parameters
    ----------
    path : str
        Path of the input of the field.
    low, high, step : float
        Smallest value, largest value and step, in `unit`.
    unit : str
        Unit of the values.
    """

    path: str
    low: float
    high: float
    step: float
    unit: str


@dataclass(frozen=True)
class Preset:
    """A list above the fields of a table; each choice fills in several fields, such as those of a material.

    Parameters
    ----------
    table : str
        Name of the table.
    words : str
        Name of the list, such as "material".
    choices : mapping
        For each choice, by name: the texts of fields, by path of the input.
    """

    table: str
    words: str
    choices: Mapping[str, Mapping[str, str]]

    def chosen(self, texts: Callable[[str], str]) -> str | None:
        """Return the name of the choice that matches the texts of all its fields; None if there is none."""
        return next(
            (
                name
                for name, each in self.choices.items()
                if all(texts(path) == text for path, text in each.items())
            ),
            None,
        )


class KeyResult(NamedTuple):
    """One of a screen's most important results: name and value, as in ("stopping distance", "13.4 m").

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
        Position of the point (x, y) [m].
    moved : callable
        ``moved(x, y)`` returns the inputs that a new position of the point [m] sets: values by path of the
        input, in SI units; a value is a number, or a pair of numbers if the input is a point.
    scale : float
        Length units of the drawing per metre: 1000 if it is drawn in mm.
    step : float
        Distance by which an arrow key moves the point [m].
    grain : float
        Increment to which lengths are rounded [m].
    """

    label: str
    at: tuple[float, float]
    moved: Callable[[float, float], Mapping[str, float | tuple[float, float]]]
    scale: float = 1.0
    step: float = 5e-4
    grain: float = 1e-4
