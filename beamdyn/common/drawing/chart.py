"""Curves as data: over a common x, with points, upright marks and greyed stretches."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any

_MOST_POINTS = 400  # of a curve on the page: more are not seen, and take time to send


@dataclass(frozen=True)
class ChartAxis:
    """An axis of a chart.

    Parameters
    ----------
    name : str
        What it shows.
    unit : str
        Unit of its numbers; "" for none.
    logarithmic : bool
        Whether it has decades.
    low, high : float, optional
        Its ends; by the curves if not given.
    """

    name: str
    unit: str = ""
    logarithmic: bool = False
    low: float | None = None
    high: float | None = None

    @property
    def title(self) -> str:
        """Name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True, eq=False)
class ChartCurve:
    """A curve.

    Parameters
    ----------
    name : str
        In the legend and when pointed at.
    x, y : ndarray, shape (n,)
        Its points, in the units of the axes; a gap where y is not finite.
    dashed : bool
        Whether it is dashed.
    pale : bool
        Whether it is grey and thin, as what is only compared with.
    points : bool
        Whether its points are marked, too.
    most : int
        How many points are drawn: least and largest of parts, where there are more.
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
    """Points with a word each.

    Parameters
    ----------
    name : str
        In the legend.
    at : sequence of (x, y, words)
        Where they are, and what is said when one is pointed at.
    role : str
        Its colour: a name in `beamdyn.common.drawing.style`.
    """

    name: str
    at: Sequence[tuple[float, float, str]]
    role: str = "mark"


@dataclass(frozen=True)
class ChartMark:
    """An upright line with a text, at its head, or at its foot where curves pass the head.

    Parameters
    ----------
    at : float
        Its x.
    text : str
        What it says.
    at_foot : bool
        Whether it says so at its foot.
    curve : str
        Name of the curve that it is about, whose colour it has; "" for none.
    """

    at: float
    text: str
    at_foot: bool = False
    curve: str = ""


@dataclass(frozen=True)
class ChartBand:
    """A stretch of x, greyed, with a text."""

    low: float
    high: float
    text: str


@dataclass(frozen=True, eq=False)
class Chart:
    """Curves over a common x.

    Parameters
    ----------
    title : str
        What it shows.
    x, y : ChartAxis
        Its axes.
    curves : sequence of ChartCurve
        Curves.
    points : sequence of ChartPoints
        Single points.
    marks : sequence of ChartMark
        Upright lines.
    bands : sequence of ChartBand
        Greyed stretches.
    cursor : float, optional
        Where a player is.
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
        """Which of the colours each curve has, in turn; None for those that are pale."""
        numbers = count()
        return [None if curve.pale else next(numbers) for curve in self.curves]

    @property
    def words(self) -> str:
        """What it shows, for those who do not see it."""
        names = ", ".join(each.name for each in (*self.curves, *self.points))
        marks = "; ".join(mark.text.replace("\n", " ") for mark in self.marks)
        over = f"{self.y.title} over {self.x.title}"
        head = over if self.title == over else f"{self.title}: {over}"
        return "; ".join(filter(None, (head, names, marks)))
