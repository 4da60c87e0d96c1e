"""Sketches that explain symbols: lengths, angles and forces in a schematic drawing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np

from beamdyn.common.drawing.layout import Paper, Rows
from beamdyn.common.drawing.shapes import Arrow, Drawing, DrawnShape, Label, Outline, Symbol, arc
from beamdyn.common.drawing.text_width import typeset

Sketcher = Callable[[Mapping[str, str]], Rows]  # function that makes rows of drawings from a form's texts

WIDTH = 272.0  # width of a sketch [pt]: the width of a form, so that both have letters of about the same size
_LETTERS = 11.0
# Smallest and largest height of a row, and space around the drawing [pt].
_LOWEST, _HIGHEST, _AROUND = 84.0, 200.0, 32.0
_THIN, _DASHED = 0.8, (4.0, 2.5)
_BEYOND = 0.15  # length of a dashed line beyond a dimension line, as a fraction of its length before it
_ALONG = np.array([0.5, 0.36, 0.64, 0.24, 0.76])  # fractions of a length beside which its symbol may stand

Point = tuple[float, float] | np.ndarray


class Sketch:
    """A schematic drawing, not to scale, to which shapes and symbols are added step by step.

    Attributes
    ----------
    shapes, labels : list
        Shapes and labels added so far.
    room : list of points
        Further points that must fit into the picture.
    """

    def __init__(self) -> None:
        self.shapes: list[DrawnShape] = []
        self.labels: list[Label] = []
        self.room: list[Point] = []

    def add(self, *shapes: DrawnShape) -> None:
        """Add shapes to the sketch."""
        self.shapes += shapes

    def say(self, symbol: str, at: Any, towards: Point = (0.0, 0.0), role: str = "text") -> None:
        """Write a symbol, such as "alpha1", beside one of the points `at`, the first if there is space."""
        way = float(towards[0]), float(towards[1])
        self.labels.append(Label("", at, role, way, typeset(symbol), priority=1, size=_LETTERS))

    def dashed(self, *points: Point) -> None:
        """Draw a thin dashed line through points."""
        self.add(Outline(np.array(points, dtype=float), "axis", _THIN, _DASHED))

    def length(self, symbol: str, start: Point, end: Point, towards: Point) -> None:
        """Draw a dimension line between two points, with a symbol beside it."""
        ends = np.array([start, end], dtype=float)
        self.add(Arrow(ends[0], ends[1], "dimension", symbol, 1.0, both=True))
        self.say(symbol, ends[0] + _ALONG[:, None] * (ends[1] - ends[0]), towards)

    def width(self, symbol: str, one: Point, other: Point, y: float) -> None:
        """Dimension how far two points are apart horizontally: at height y, with dashed lines from each."""
        self._dimension(symbol, one, other, 1, y)

    def height(self, symbol: str, one: Point, other: Point, x: float) -> None:
        """Dimension how far two points are apart vertically: at x, with dashed lines from each."""
        self._dimension(symbol, one, other, 0, x)

    def _dimension(self, symbol: str, one: Point, other: Point, k: int, at: float) -> None:
        """Dimension two points on the line on which coordinate k is `at`; the symbol is on its far side."""
        points, towards = np.array([one, other], dtype=float), np.zeros(2)
        ends, towards[k] = points.copy(), at - points[:, k].mean()
        ends[:, k] = at
        for point, end in zip(points, ends, strict=True):
            self.dashed(point, end + _BEYOND * (end - point))
        self.length(symbol, ends[0], ends[1], towards)

    def angle(self, symbol: str, centre: Point, radius: float, start: float, end: float) -> None:
        """Draw an arc from angle `start` to angle `end` [rad], with a symbol outside the arc."""
        way = arc(centre, radius, start, end)
        self.add(Outline(way[:-5], "dimension", 1.0), Arrow(way[-8], way[-1], "dimension", symbol, 1.0))
        middle = arc(centre, radius, start + 0.5 * (end - start), start + 0.3 * (end - start), 2)
        self.say(symbol, middle, middle[0] - np.asarray(centre, dtype=float))

    def arrow(self, symbol: str, foot: Point, tip: Point, role: str = "load") -> None:
        """Draw an arrow for a force or a direction of motion, with a symbol beside its foot."""
        ends = np.array([foot, tip], dtype=float)
        self.add(Arrow(ends[0], ends[1], role, symbol, 1.8))
        self.say(symbol, np.stack([ends[0], ends.mean(axis=0)]), ends[0] - ends[1], role)

    def moment(self, symbol: str, centre: Point, radius: float, start: float, end: float, role: str) -> None:
        """Draw an arc-shaped arrow for a moment or a rotation about a point, between two angles [rad]."""
        way = arc(centre, radius, start, end)
        self.add(Outline(way[:-5], role, 1.6), Arrow(way[-8], way[-1], role, symbol, 1.6))
        self.say(symbol, way[[20, 12, 28]], way[20] - np.asarray(centre, dtype=float), role)

    def axis(self, at: Point) -> None:
        """Draw the symbol of an axis of rotation that is normal to the drawing."""
        self.add(Symbol("cross", at, "axis", 9.0))

    def drawing(self, title: str, words: str) -> Drawing:
        """Return the finished drawing, with a title and a description for screen readers."""
        return Drawing(tuple(self.shapes), tuple(self.labels), title, words, unit="", room=self.room)


def wall(middle: Point, half: Point, back: Point) -> list[DrawnShape]:
    """Draw a hatched wall; `half` is the vector from its centre to an end, `back` along a hatch line."""
    at, way, behind = (np.asarray(each, dtype=float) for each in (middle, half, back))
    ends = np.array([at - way, at + way])
    ticks = ends[0] + np.linspace(0, 1, 6)[:, None] * (ends[1] - ends[0])
    return [Outline(ends, "ground", 2.4), *(Outline([tick, tick + behind], "ground", 0.9) for tick in ticks)]


def sketch_paper(rows: Rows) -> Paper:
    """Choose the sheet size for sketches: the width of a form, and only the height that is needed."""
    return Paper(WIDTH, tuple(_height(row, WIDTH / len(row)) for row in rows))


def _height(row: Sequence[Drawing], width: float) -> float:
    spans = [np.subtract(*drawing.extent()[::-1]) for drawing in row]
    highest = max(float((width - _AROUND) * up / across) if across else _HIGHEST for across, up in spans)
    return min(max(highest + _AROUND + 16.0, _LOWEST), _HIGHEST)
