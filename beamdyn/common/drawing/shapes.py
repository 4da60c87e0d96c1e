"""What a drawing consists of: outlines, discs, symbols, arrows and labels, in the machine's coordinates."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from types import MappingProxyType
from typing import Any

import numpy as np

NORMAL = 9.0  # size of letters [pt]


@dataclass(frozen=True, eq=False)
class Outline:
    """A line through points, or an area.

    Parameters
    ----------
    points : ndarray, shape (k, 2)
        The points; the line has a gap where they are not numbers.
    role : str
        What it is: a name in `beamdyn.common.drawing.style`.
    width : float
        Of the line [pt]; 0 for none.
    dash : tuple of float
        Lengths of dashes and gaps [pt]; of a solid line none.
    closed, filled : bool
        Whether the line comes back to its start, and whether the area within is coloured.
    """

    points: Any
    role: str
    width: float = 1.6
    dash: tuple[float, ...] = ()
    closed: bool = False
    filled: bool = False


@dataclass(frozen=True, eq=False)
class Disc:
    """A circle; parameters as of `Outline`."""

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
    """A sign of one size on paper.

    Parameters
    ----------
    kind : {"pin", "ground", "dot", "cross", "diamond"}
        A pin, a pin's support, a point, a centre, a place of contact.
    at : array of two floats
        Where.
    role : str
        As of `Outline`.
    size : float
        Its width [pt].
    """

    kind: str
    at: Any
    role: str
    size: float = 6.0


@dataclass(frozen=True, eq=False)
class Arrow:
    """An arrow.

    Parameters
    ----------
    foot, tip : array of two floats
        Its ends.
    role : str
        As of `Outline`.
    name : str
        Of what it shows, such as a force.
    width : float
        Of its shaft [pt].
    both : bool
        Whether its foot has a head, too, as in a dimension line.
    """

    foot: Any
    tip: Any
    role: str
    name: str = ""
    width: float = 1.8
    both: bool = False

    @property
    def vector(self) -> np.ndarray:
        """From foot to tip."""
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
        As of `Outline`.
    towards : tuple of float
        Direction in which it should stand from its point; (0, 0) on it.
    symbol : str
        Symbol before it, such as "N_1".
    priority : int
        Labels of higher priority choose first.
    size : float
        Of its letters [pt].
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
        """Symbol and text."""
        return f"{self.symbol.replace('_', '')} {self.text}".strip()


DrawnShape = Outline | Disc | Symbol | Arrow


@dataclass(frozen=True, eq=False)
class Drawing:
    """A drawing.

    Parameters
    ----------
    shapes : sequence
        What is drawn, the lowest first.
    labels : sequence of Label
        Texts.
    title : str
        Above it.
    words : str
        What it shows, for those who do not see it.
    unit : {"m", "mm", ""}
        Of its coordinates; none of a sketch that has no scale.
    newton : float
        Length of an arrow for 1 N, in the drawing's unit; 0 where there are no forces.
    key : mapping
        What roles mean, in words; only those of its shapes are listed.
    points : mapping
        Points (x, y) that can be moved, by their names.
    room : ndarray, shape (k, 2)
        Points for which there is room beside what is drawn, such as those of other positions.
    own_scale : bool
        Whether it has a scale of its own beside others, as a detail has.
    scale : str
        In words, that of deflections, where they are not drawn to that of lengths.
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
        """Meaning of the roles that are drawn."""
        drawn = {shape.role for shape in self.shapes}
        return {role: words for role, words in self.key.items() if role in drawn}

    @property
    def arrows(self) -> dict[str, np.ndarray]:
        """Vectors of named arrows, in the drawing's unit."""
        return {s.name: s.vector for s in self.shapes if isinstance(s, Arrow) and s.name}

    def extent(self) -> tuple[np.ndarray, np.ndarray]:
        """Least and greatest coordinates (2,) of what needs room; a unit square where there is nothing."""
        room = np.reshape(np.asarray(self.room, dtype=float), (-1, 2))
        points = np.vstack([room, *map(points_of_shape, self.shapes)])
        points = points[np.isfinite(points).all(axis=1)]
        if not len(points):
            return np.zeros(2), np.ones(2)
        return points.min(axis=0), points.max(axis=0)


def points_of_shape(shape: DrawnShape) -> np.ndarray:
    """Points along a shape, shape (k, 2)."""
    if isinstance(shape, Outline):
        return np.asarray(shape.points, dtype=float).reshape(-1, 2)
    if isinstance(shape, Disc):
        return shape.around
    if isinstance(shape, Symbol):
        return np.asarray(shape.at, dtype=float).reshape(1, 2)
    return np.array([shape.foot, shape.tip], dtype=float)


def arc(centre: Any, radius: float, start: float, end: float, count: int = 41) -> np.ndarray:
    """Points (count, 2) of an arc between two angles from x towards y [rad]."""
    angle = np.linspace(start, end, count)
    return np.asarray(centre, dtype=float) + radius * np.stack([np.cos(angle), np.sin(angle)], axis=-1)
