"""Paths, circles and letters of a layout on paper, with their colours, for every picture format.

Lengths are in [pt], from the top left corner of the paper.  The modules for SVG and matplotlib draw these
simple elements only, so that neither has to handle shapes of machines.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.drawing.layout import Fit, Layout, Text
from beamdyn.common.drawing.shapes import Arrow, Disc, DrawnShape, Outline, Symbol


class Ink(NamedTuple):
    """Colours of a role: one for lines and letters, one for areas, each for light and for dark background."""

    line: str
    dark_line: str
    area: str = "none"
    dark_area: str = "none"


# The palette of Okabe and Ito, which colour-blind people can tell apart; lighter on a dark background.
BLACK = Ink("#000000", "#f2f2f2", "#000000", "#f2f2f2")
BLUE = Ink("#0072b2", "#62b8ee", "#0072b2", "#62b8ee")
VERMILION = Ink("#c65000", "#ff9350", "#c65000", "#ff9350")
GREEN = Ink("#00805c", "#3ecfa0", "#00805c", "#3ecfa0")
GREY = Ink("#4d4d4d", "#c4c4c4", "#4d4d4d", "#c4c4c4")
AREA = 0.7  # opacity of filled areas: shapes behind them remain visible
INKS = {
    "paper": Ink("#ffffff", "#16191d", "#ffffff", "#16191d"),
    "text": Ink("#333333", "#dddddd"),
    "body": Ink("#80868f", "#969daa", "#dfe1e5", "#343a44"),
    "second": Ink("#8a8a8a", "#a0a0a0", "#f2f2f2", "#292d33"),
    "wheel": Ink("#595959", "#b5b5b5", "#c4c6ca", "#4b515b"),
    "ghost": Ink("#c9ccd1", "#4a5059"),
    "rim": Ink("#9a9683", "#8d8a78", "#f1ead2", "#3a3729"),
    "pin": Ink("#1a1a1a", "#eeeeee", "#ffffff", "#16191d"),
    "ground": Ink("#595959", "#b5b5b5", "#595959", "#b5b5b5"),
    "contact": Ink("#1a1a1a", "#eeeeee", "#1a1a1a", "#eeeeee"),
    "support": Ink("#8c8c8c", "#8c8c8c", "#8c8c8c", "#8c8c8c"),
    "axis": Ink("#7f7f7f", "#9b9b9b"),
    "dimension": GREY,
    "neutral": GREY,
    "spring": GREY,
    "cable": GREY,
    "load": BLACK,
    "force": BLACK,
    "weight": BLACK,
    "reaction": GREEN,
    "tension": BLUE,
    "compression": VERMILION,
    "normal": BLUE,
    "friction": VERMILION,
    "leading": BLUE,
    "trailing": VERMILION,
    "beam": Ink("#0072b2", "#62b8ee", "#cfe5f4", "#1d3d54"),
    "mark": BLACK,
    "other": Ink("#a0527f", "#e29bc4"),
    "inside": Ink("#a00000", "#ff6b6b"),
}


def ink(role: str) -> Ink:
    """Return the colours of a role; raise ValueError for an unknown role."""
    if role not in INKS:
        raise ValueError(f"role is {role!r}; it must be one of {', '.join(INKS)}")
    return INKS[role]


def colour(name: str) -> str:
    """Return a colour on light background: of lines for the name of a role, of areas for "ROLE-area"."""
    role = name.removesuffix("-area")
    return ink(role).line if name == role else ink(role).area


GROUND = "paper-area"
HALO = 2.6  # width of the background-coloured outline of letters [pt]
_HEAD, _HALF = 9.0, 3.3  # length and half the width of an arrowhead [pt]
_THIN = 1.2  # width of the lines of symbols [pt]


class Pen(NamedTuple):
    """Style of a line and of a filled area: names of colours (see `colour`), "" for no line or no fill."""

    line: str = ""
    width: float = 1.0
    dash: tuple[float, ...] = ()
    fill: str = ""
    opacity: float = 1.0  # opacity of the fill


@dataclass(frozen=True, eq=False)
class Polylines:
    """Lines through points, each an array with points in rows; a closed line returns to its first point."""

    runs: Sequence[np.ndarray]
    pen: Pen
    closed: bool = False


@dataclass(frozen=True, eq=False)
class Circle:
    """A circle on paper."""

    centre: np.ndarray
    radius: float
    pen: Pen


class Letters(NamedTuple):
    """A line of text: symbol, text after it, centre of the baseline (x, y), font size [pt], colour."""

    symbol: str
    words: str
    middle: float
    baseline: float
    size: float
    colour: str


Stroke = Polylines | Circle


def strokes_of(layout: Layout) -> Iterator[Stroke]:
    """Yield all lines and areas of a layout in drawing order."""
    for shape in layout.drawing.shapes:
        yield from _SHAPES[type(shape)](shape, layout.fit)
    for rule in layout.rules:
        yield Polylines([rule.ends], Pen(rule.role, rule.width))


def letters_of(text: Text) -> list[Letters]:
    """Return the lines of a text that are not blank."""
    made = [
        Letters(text.symbol if i == 0 else "", line, float(text.centre[0]), y, text.letters, text.role)
        for i, (line, y) in enumerate(zip(text.lines, text.baselines, strict=True))
    ]
    return [each for each in made if each.symbol or each.words]


def _pen(shape: Outline | Disc) -> Pen:
    """Return the line style of a shape; discs are opaque, and hide shapes below them."""
    line, fill = shape.role if shape.width else "", f"{shape.role}-area" if shape.filled else ""
    return Pen(line, shape.width, shape.dash, fill, AREA if isinstance(shape, Outline) else 1.0)


def _outline(shape: Outline, fit: Fit) -> Iterator[Stroke]:
    points = fit.to_paper(shape.points)
    breaks = np.flatnonzero(~np.isfinite(points).all(axis=1))
    runs = (run[np.isfinite(run).all(axis=1)] for run in np.split(points, breaks))
    if whole := [run for run in runs if len(run)]:
        yield Polylines(whole, _pen(shape), shape.closed)


def _disc(shape: Disc, fit: Fit) -> Iterator[Stroke]:
    yield Circle(fit.to_paper(shape.centre), shape.radius * fit.scale, _pen(shape))


def _arrow(shape: Arrow, fit: Fit) -> Iterator[Stroke]:
    foot, tip = fit.to_paper([shape.foot, shape.tip])
    length = float(np.hypot(*(tip - foot)))
    if not 0 < length < np.inf:
        return
    along = (tip - foot) / length
    head = min(_HEAD, 0.6 * length)
    start = foot + head * along if shape.both else foot
    ends = [(tip, along), (foot, -along)] if shape.both else [(tip, along)]
    yield Polylines([np.array([start, tip - 0.8 * head * along])], Pen(shape.role, shape.width))
    across = _HALF * head / _HEAD * np.array([-along[1], along[0]])
    heads = [np.array([end, end - head * to + across, end - head * to - across]) for end, to in ends]
    yield Polylines(heads, Pen(fill=shape.role), closed=True)


def _symbol(shape: Symbol, fit: Fit) -> Iterator[Stroke]:
    at, half, line = fit.to_paper(shape.at), shape.size / 2, shape.role
    if shape.kind in _ROUND:
        yield Circle(at, half, _ROUND[shape.kind](line))
    else:
        ways, closed, pen = _ANGULAR[shape.kind]
        yield Polylines([at + half * np.array(way) for way in ways], pen(line), closed)


_ROUND: dict[str, Callable[[str], Pen]] = {
    "pin": lambda line: Pen(line, _THIN, fill=f"{line}-area"),
    "dot": lambda line: Pen(fill=line),
}
# Symbols made of straight lines, for half width 1: points, whether the line is closed, and line style.
_ANGULAR: dict[str, tuple[Any, bool, Callable[[str], Pen]]] = {
    "ground": ([[(0, 0), (1, 1.7), (-1, 1.7)]], True, lambda line: Pen(fill=line)),
    "cross": ([[(-1, 0), (1, 0)], [(0, -1), (0, 1)]], False, lambda line: Pen(line, _THIN)),
    "diamond": ([[(0, -1), (1, 0), (0, 1), (-1, 0)]], True, lambda line: Pen(GROUND, fill=line)),
}
_Draw = Callable[[Any, Fit], Iterator[Stroke]]
_SHAPES: dict[type[DrawnShape], _Draw] = {Outline: _outline, Disc: _disc, Symbol: _symbol, Arrow: _arrow}
