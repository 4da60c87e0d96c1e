"""Drawings and charts as data, in the coordinates of the machine and of the curves.

A drawing has outlines, discs, symbols, arrows and labels; a chart has curves over a common x, with points,
vertical marks and grey bands.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import count
from types import MappingProxyType
from typing import Any

import numpy as np

NORMAL = 9.0  # size of letters where a drawing asks for no other size [pt]


@dataclass(frozen=True, eq=False)
class Outline:
    """A line through points, or an area.

    Parameters
    ----------
    points : ndarray, shape (k, 2)
        The points; the line has a gap where they are not numbers.
    role : str
        Role that gives its colour: a name in `beamdyn.common.drawing.strokes`.
    width : float
        Width of the line [pt]; 0 for none.
    dash : tuple of float
        Lengths of dashes and gaps [pt]; empty for a solid line.
    closed, filled : bool
        Whether the line is closed, and whether the area within is coloured.
    """

    points: Any
    role: str
    width: float = 1.6
    dash: tuple[float, ...] = ()
    closed: bool = False
    filled: bool = False


@dataclass(frozen=True, eq=False)
class Disc:
    """A circle; its parameters are as for `Outline`."""

    centre: Any
    radius: float
    role: str
    width: float = 1.6
    dash: tuple[float, ...] = ()
    filled: bool = False

    @property
    def around(self) -> np.ndarray:
        """Points of the circle, shape (73, 2)."""
        return arc(self.centre, self.radius, 0.0, 2 * np.pi, 73)


@dataclass(frozen=True, eq=False)
class Symbol:
    """A symbol of a fixed size on paper.

    Parameters
    ----------
    kind : {"pin", "ground", "dot", "cross", "diamond"}
        For a pin, a pin's support, a point, a centre, a contact.
    at : array of two floats
        Its position.
    role : str
        As for `Outline`.
    size : float
        Its width [pt].
    """

    kind: str
    at: Any
    role: str
    size: float = 6.0


@dataclass(frozen=True, eq=False)
class Arrow:
    """An arrow of a drawing.

    Parameters
    ----------
    foot, tip : array of two floats
        Its ends.
    role : str
        As for `Outline`.
    name : str
        Name of what it shows, such as a force.
    width : float
        Width of its shaft [pt].
    both : bool
        Whether both ends have heads, as in a dimension line.
    """

    foot: Any
    tip: Any
    role: str
    name: str = ""
    width: float = 1.8
    both: bool = False

    @property
    def vector(self) -> np.ndarray:
        """Vector from foot to tip."""
        return np.subtract(self.tip, self.foot)


@dataclass(frozen=True, eq=False)
class Label:
    """A text at a point, for which the layout finds a free place.

    Parameters
    ----------
    text : str
        The text, of one or more lines.
    anchors : ndarray, shape (k, 2)
        Points at one of which it may stand, the best first.
    role : str
        As for `Outline`.
    towards : tuple of float
        Direction in which it should stand from its point; (0, 0) for on it.
    symbol : str
        Symbol before the text, such as "N_1".
    priority : int
        Labels of higher priority choose first.
    size : float
        Size of its letters [pt].
    """

    text: str
    anchors: Any
    role: str = "text"
    towards: tuple[float, float] = (0.0, 0.0)
    symbol: str = ""
    priority: int = 0
    size: float = NORMAL

    @property
    def said(self) -> str:
        """Symbol and text of the label."""
        return f"{self.symbol.replace('_', '')} {self.text}".strip()


DrawnShape = Outline | Disc | Symbol | Arrow


@dataclass(frozen=True, eq=False)
class Drawing:
    """A drawing: shapes and labels in the machine's coordinates.

    Parameters
    ----------
    shapes : sequence
        Shapes, the lowest first.
    labels : sequence of Label
        Texts.
    title : str
        Title.
    words : str
        Description for screen readers.
    unit : {"m", "mm", ""}
        Unit of its coordinates; "" for a sketch without a scale.
    newton : float
        Length of an arrow for 1 N, in the drawing's unit; 0 where there are no forces.
    key : mapping
        Meaning of roles, in words; only roles of its shapes are listed.
    points : mapping
        Points (x, y) that can be moved, by their names.
    room : ndarray, shape (k, 2)
        Further points that must fit into the picture, such as those of other positions.
    own_scale : bool
        Whether its scale differs from that of others in its row, as in a detail.
    scale : str
        Scale of the deflections in words, where it differs from that of lengths.
    """

    shapes: Sequence[DrawnShape]
    labels: Sequence[Label] = ()
    title: str = ""
    words: str = ""
    unit: str = "m"
    newton: float = 0.0
    key: Mapping[str, str] = field(default_factory=lambda: MappingProxyType({}))
    points: Mapping[str, Any] = field(default_factory=lambda: MappingProxyType({}))
    room: Any = ()
    own_scale: bool = False
    scale: str = ""

    @property
    def legend(self) -> dict[str, str]:
        """Meaning of each role that is drawn."""
        drawn = {shape.role for shape in self.shapes}
        return {role: words for role, words in self.key.items() if role in drawn}

    @property
    def arrows(self) -> dict[str, np.ndarray]:
        """Vectors of named arrows, in the drawing's unit, by name."""
        return {s.name: s.vector for s in self.shapes if isinstance(s, Arrow) and s.name}

    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Compute least and greatest coordinates (2,) of shapes and `room`.

        Without any, they are those of a unit square.
        """
        room = np.reshape(np.asarray(self.room, dtype=float), (-1, 2))
        points = np.vstack([room, *map(points_of_shape, self.shapes)])
        points = points[np.isfinite(points).all(axis=1)]
        if not len(points):
            return np.zeros(2), np.ones(2)
        return points.min(axis=0), points.max(axis=0)


def points_of_shape(shape: DrawnShape) -> np.ndarray:
    """Return points (k, 2) along a shape."""
    if isinstance(shape, Outline):
        return np.asarray(shape.points, dtype=float).reshape(-1, 2)
    if isinstance(shape, Disc):
        return shape.around
    if isinstance(shape, Symbol):
        return np.asarray(shape.at, dtype=float).reshape(1, 2)
    return np.array([shape.foot, shape.tip], dtype=float)


def arc(centre: Any, radius: float, start: float, end: float, count: int = 41) -> np.ndarray:
    """Return points (count, 2) of an arc between two angles from x towards y [rad]."""
    angle = np.linspace(start, end, count)
    return np.asarray(centre, dtype=float) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


# Charts ----------------------------------------------------------------------------------------------

# Largest number of points of a curve on the page: more cannot be seen, and take time to send.
_MOST_POINTS = 400


@dataclass(frozen=True)
class ChartAxis:
    """An axis of a chart.

    Parameters
    ----------
    name : str
        Name of its quantity.
    unit : str
        Unit of its numbers; "" for none.
    logarithmic : bool
        Whether its scale is logarithmic.
    low, high : float, optional
        Its limits; chosen by the curves if not given.
    """

    name: str
    unit: str = ""
    logarithmic: bool = False
    low: float | None = None
    high: float | None = None

    @property
    def title(self) -> str:
        """Name and unit of the axis."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class ChartCurve:
    """A curve of a chart.

    Parameters
    ----------
    name : str
        Name in the legend and beside the mouse pointer.
    x, y : ndarray, shape (n,)
        Its points, in the units of the axes; a gap where y is not finite.
    dashed : bool
        Whether it is dashed.
    pale : bool
        Whether it is grey and thin, as a reference for others.
    points : bool
        Whether its points are marked.
    most : int
        Largest number of points drawn; a curve with more keeps its ends and the extremes of its parts.
    """

    name: str
    x: Any
    y: Any
    dashed: bool = False
    pale: bool = False
    points: bool = False
    most: int = _MOST_POINTS


@dataclass(frozen=True)
class ChartPoints:
    """Points of a chart, each with a text.

    Parameters
    ----------
    name : str
        Name in the legend.
    at : sequence of (x, y, words)
        Coordinates of each point, and the text shown when the mouse pointer is on it.
    role : str
        Role that gives their colour: a name in `beamdyn.common.drawing.strokes`.
    """

    name: str
    at: Sequence[tuple[float, float, str]]
    role: str = "mark"


@dataclass(frozen=True)
class ChartMark:
    """A vertical line with a text at its top, or at its foot where curves pass the top.

    Parameters
    ----------
    at : float
        Its x.
    text : str
        The text.
    at_foot : bool
        Whether the text is at its foot.
    curve : str
        Name of the curve that it belongs to, whose colour it has; "" for none.
    """

    at: float
    text: str
    at_foot: bool = False
    curve: str = ""


@dataclass(frozen=True)
class ChartBand:
    """A grey band over an interval of x, with a text."""

    low: float
    high: float
    text: str


@dataclass(frozen=True, eq=False)
class Chart:
    """Curves over a common x.

    Parameters
    ----------
    title : str
        Title.
    x, y : ChartAxis
        The axes.
    curves : sequence of ChartCurve
        Curves.
    points : sequence of ChartPoints
        Single points.
    marks : sequence of ChartMark
        Vertical lines.
    bands : sequence of ChartBand
        Grey bands.
    cursor : float, optional
        The x of a cursor, such as the present time of a player.
    """

    title: str
    x: ChartAxis
    y: ChartAxis
    curves: Sequence[ChartCurve]
    points: Sequence[ChartPoints] = ()
    marks: Sequence[ChartMark] = ()
    bands: Sequence[ChartBand] = ()
    cursor: float | None = None

    @property
    def colour_numbers(self) -> list[int | None]:
        """Number of each curve's colour, counted from 0; None for pale curves."""
        numbers = count()
        return [None if curve.pale else next(numbers) for curve in self.curves]

    @property
    def words(self) -> str:
        """Description of the chart for screen readers."""
        names = ", ".join(each.name for each in (*self.curves, *self.points))
        marks = "; ".join(mark.text.replace("\n", " ") for mark in self.marks)
        over = f"{self.y.title} over {self.x.title}"
        head = over if self.title == over else f"{self.title}: {over}"
        return "; ".join(filter(None, (head, names, marks)))
