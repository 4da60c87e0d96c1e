"""The three kinds of row that every joint and every load is made of.

A row is a scalar function of the position.  Its gradient is at the same time a set of forces on the bodies:
those of a unit multiplier (a joint) or of a unit magnitude (a load).
"""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from itertools import pairwise
from typing import NamedTuple

from beamdyn.common.checks import real

GROUND = "ground"
Point = tuple[float, float]


class Line(NamedTuple):
    """n.(p - o): distance of a point p of a body from a line through o of another, along its normal n.

    A unit row pushes the body along +n.  The normal turns with the body `frame`.
    """

    body: str
    at: Point
    other: str
    on: Point
    frame: str
    normal: Point


class Path(NamedTuple):
    """Shortening of a polyline over points of bodies below a length [m]; a unit row pulls it together."""

    bodies: tuple[str, ...]
    points: tuple[Point, ...]
    length: float


class Turn(NamedTuple):
    """Angle of a body less `ratio` times that of another and an offset [rad]; a unit row is a couple."""

    body: str
    other: str = GROUND
    ratio: float = 1.0
    offset: float = 0.0


Row = Line | Path | Turn


class Friction(NamedTuple):
    """A row along which friction acts, and its size per unit of the joint's force [m for a couple, or 1]."""

    row: Row
    coefficient: float


def bodies_of(row: Row) -> tuple[str, ...]:
    """The bodies on which a row acts."""
    return row.bodies if isinstance(row, Path) else (row.body, row.other)


def polyline(points: Iterable[Point]) -> float:
    """Length of a polyline [m]."""
    return sum(math.dist(p, q) for p, q in pairwise(points))


def point(key: str, value: object) -> Point:
    """Two finite coordinates [m], or a ValueError that names the key."""
    try:
        x, y = value  # pyright: ignore[reportGeneralTypeIssues]  (anything else is refused below)
    except (TypeError, ValueError):
        raise ValueError(f"{key} = {value!r}: give two coordinates (x, y) in m") from None
    return real(f"{key}: x", x, "m"), real(f"{key}: y", y, "m")


def direction(key: str, value: object) -> Point:
    """A unit vector along two components."""
    x, y = point(key, value)
    size = math.hypot(x, y)
    if not size:
        raise ValueError(f"{key} = (0, 0) has no direction: give a vector that is not zero")
    return x / size, y / size


def apart(key: str, points: tuple[Point, ...], what: str) -> None:
    """A ValueError if two successive points coincide."""
    for p, q in pairwise(points):
        if p == q:
            raise ValueError(f"{key} has zero length at {p}: {what}")


def suggestion(name: object, known: Iterable[str]) -> str:
    """The remedy for a name that is not known."""
    known = tuple(known)
    near = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(map(repr, known))}"
