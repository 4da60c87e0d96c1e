"""Charts as data: curves over a common x, with points, vertical marks and grey bands."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

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
