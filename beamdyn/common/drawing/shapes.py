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

NORMAL = 9.0  # default font size [pt]


@dataclass(frozen=True, eq=False)
class Outline:
    """An open or closed line through points, with or without a filled area.

    Parameters
    ----------
    points : ndarray, shape (points, 2)
        The points; the line has a gap at points that are nan.
    role : str
        Role that determines the colour: a name in `beamdyn.common.drawing.strokes`.
    width : float
        Width of the line [pt]; 0 for none.
    dash : tuple of float
        Lengths of dashes and gaps [pt]; empty for a solid line.
    closed, filled : bool
        Whether the line is closed, and whether the enclosed area is filled.
    """

    points: Any
    role: str
    width: float = 1.6
    dash: tuple[float, ...] = ()
    closed: bool = False
    filled: bool = False


@dataclass(frozen=True, eq=False)
class Disc:
    """A circle; its parameters `role`, `width`, `dash` and `filled` are as for `Outline`."""

    centre: Any
    radius: float
    role: str
    width: float = 1.6
    dash: tuple[float, ...] = ()
    filled: bool = False

    @property
    def around(self) -> np.ndarray:
        """Return points on the circle, shape (73, 2)."""
        return arc(self.centre, self.radius, 0.0, 2 * np.pi, 73)


@dataclass(frozen=True, eq=False)
class Symbol:
    """A symbol whose size on paper is fixed.

    Parameters
    ----------
    kind : {"pin", "ground", "dot", "cross", "diamond"}
        Meaning: a pin joint, a fixed support of a pin joint, a point, a centre, a contact point.
    at : array of two floats
        Position of the symbol.
    role : str
        Role that determines the colour.
    size : float
        Width of the symbol [pt].
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
        End points of the arrow.
    role : str
        Role that determines the colour.
    name : str
        Name of the quantity that the arrow shows, such as a force.
    width : float
        Width of the shaft [pt].
    both : bool
        Whether both ends have arrowheads, as in a dimension line.
    """

    foot: Any
    tip: Any
    role: str
    name: str = ""
    width: float = 1.8
    both: bool = False

    @property
    def vector(self) -> np.ndarray:
        """Return the vector from foot to tip."""
        return np.subtract(self.tip, self.foot)


@dataclass(frozen=True, eq=False)
class Label:
    """A text at a point, for which the layout finds a free place.

    Parameters
    ----------
    text : str
        The text, of one or more lines.
    anchors : ndarray, shape (points, 2)
        Points beside which the text may stand, the best first.
    role : str
        Role that determines the colour.
    towards : tuple of float
        Preferred direction from the point to the text; (0, 0) to put the text on the point.
    symbol : str
        Symbol before the text, such as "N_1".
    priority : int
        Labels of higher priority are placed first.
    size : float
        Font size [pt].
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
        """Return symbol and text of the label as one string."""
        return f"{self.symbol.replace('_', '')} {self.text}".strip()


DrawnShape = Outline | Disc | Symbol | Arrow


@dataclass(frozen=True, eq=False)
class Drawing:
    """A drawing: shapes and labels in the machine's coordinates.

    Parameters
    ----------
    shapes : sequence
        Shapes in drawing order: later ones cover earlier ones.
    labels : sequence of Label
        Texts at points of the drawing.
    title : str
        Title.
    words : str
        Description of the drawing for screen readers.
    unit : {"m", "mm", ""}
        Unit of the coordinates; "" for a sketch that is not to scale.
    newton : float
        Length of an arrow that shows a force of 1 N, in the drawing's unit; 0 if there are no forces.
    key : mapping
        Meaning of each colour role in words; the key lists only roles that occur in the drawing.
    points : mapping
        Points (x, y) that the user can drag, by name.
    room : ndarray, shape (points, 2)
        Further points that must fit into the picture, such as points of other positions of the mechanism.
    own_scale : bool
        Whether the drawing has its own scale, different from other drawings in its row, as a detail does.
    scale : str
        Scale of the deflections in words, if deflections are drawn at another scale than lengths.
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
        """Return the meaning of each colour role that occurs in the drawing."""
        drawn = {shape.role for shape in self.shapes}
        return {role: words for role, words in self.key.items() if role in drawn}

    @property
    def arrows(self) -> dict[str, np.ndarray]:
        """Return the vectors of the named arrows, in the drawing's unit, by name."""
        return {s.name: s.vector for s in self.shapes if isinstance(s, Arrow) and s.name}

    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Compute the smallest and the largest coordinates (2,) of all shapes and of the points `room`.

        An empty drawing has the extent of a unit square.
        """
        room = np.reshape(np.asarray(self.room, dtype=float), (-1, 2))
        points = np.vstack([room, *map(points_of_shape, self.shapes)])
        points = points[np.isfinite(points).all(axis=1)]
        if not len(points):
            return np.zeros(2), np.ones(2)
        return points.min(axis=0), points.max(axis=0)


def points_of_shape(shape: DrawnShape) -> np.ndarray:
    """Return k points (k, 2) along the outline of a shape."""
    if isinstance(shape, Outline):
        return np.asarray(shape.points, dtype=float).reshape(-1, 2)
    if isinstance(shape, Disc):
        return shape.around
    if isinstance(shape, Symbol):
        return np.asarray(shape.at, dtype=float).reshape(1, 2)
    return np.array([shape.foot, shape.tip], dtype=float)


def arc(centre: Any, radius: float, start: float, end: float, count: int = 41) -> np.ndarray:
    """Return points (count, 2) on a circular arc between two angles [rad], measured from x towards y."""
    angle = np.linspace(start, end, count)
    return np.asarray(centre, dtype=float) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)


# Charts ----------------------------------------------------------------------------------------------

# Largest number of points of a curve sent to the page: more could not be seen, and would slow it down.
_MOST_POINTS = 400


@dataclass(frozen=True)
class ChartAxis:
    """An axis of a chart.

    Parameters
    ----------
    name : str
        Name of the quantity on the axis.
    unit : str
        Unit of the numbers; "" for a dimensionless quantity.
    logarithmic : bool
        Whether the scale is logarithmic.
    low, high : float, optional
        Limits of the axis; chosen to show all curves if not given.
    """

    name: str
    unit: str = ""
    logarithmic: bool = False
    low: float | None = None
    high: float | None = None

    @property
    def title(self) -> str:
        """Return name and unit of the quantity on the axis."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class ChartCurve:
    """A curve of a chart.

    Parameters
    ----------
    name : str
        Name in the legend and beside the mouse pointer.
    x, y : ndarray, shape (n,)
        Points of the curve, in the units of the axes; the curve has a gap where y is not finite.
    dashed : bool
        Whether the curve is dashed.
    pale : bool
        Whether the curve is thin and grey, as a reference for other curves.
    points : bool
        Whether each point has a marker.
    most : int
        Largest number of points drawn; of a curve with more points, the ends and local extremes are drawn.
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
    """Single points of a chart, each with a text.

    Parameters
    ----------
    name : str
        Name in the legend.
    at : sequence of (x, y, words)
        Coordinates of each point, and the text shown when the mouse pointer is on it.
    role : str
        Role that determines the colour: a name in `beamdyn.common.drawing.strokes`.
    """

    name: str
    at: Sequence[tuple[float, float, str]]
    role: str = "mark"


@dataclass(frozen=True)
class ChartMark:
    """A vertical line with a text at its top end, or at its bottom end where curves would cover the top.

    Parameters
    ----------
    at : float
        Position of the line on the x axis.
    text : str
        The text.
    at_foot : bool
        Whether the text is at the bottom end.
    curve : str
        Name of a curve whose colour the line gets; "" for a grey line.
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
    """A chart of curves over the same x axis.

    Parameters
    ----------
    title : str
        Title of the chart.
    x, y : ChartAxis
        The axes.
    curves : sequence of ChartCurve
        The curves.
    points : sequence of ChartPoints
        Single points.
    marks : sequence of ChartMark
        Vertical lines with texts.
    bands : sequence of ChartBand
        Grey bands over intervals of x.
    cursor : float, optional
        Position of a cursor on the x axis, such as the time at which an animation stands.
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
        """Return the number of each curve's colour, counted from 0; None for grey curves."""
        numbers = count()
        return [None if curve.pale else next(numbers) for curve in self.curves]

    @property
    def words(self) -> str:
        """Return a description of the chart for screen readers."""
        names = ", ".join(each.name for each in (*self.curves, *self.points))
        marks = "; ".join(mark.text.replace("\n", " ") for mark in self.marks)
        over = f"{self.y.title} over {self.x.title}"
        head = over if self.title == over else f"{self.title}: {over}"
        return "; ".join(filter(None, (head, names, marks)))
