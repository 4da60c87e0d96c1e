"""Points and directions in the drawing of a mechanism, and their checks."""

from __future__ import annotations

import difflib
import math
from collections.abc import Iterable
from itertools import pairwise

from beamdyn.common.checks import real

GROUND = "ground"
Point = tuple[float, float]
End = tuple[str, Point]  # a body and a point of it, given by its place in the drawing [m]


def path_length(points: Iterable[Point]) -> float:
    """Length of a polyline [m]."""
    return sum(math.dist(p, q) for p, q in pairwise(points))


def check_point(key: str, value: object) -> Point:
    """Two finite coordinates [m], or a ValueError that names the key."""
    try:
        x, y = value  # pyright: ignore[reportGeneralTypeIssues]  (anything else is refused below)
    except (TypeError, ValueError):
        raise ValueError(f"{key} = {value!r}: give two coordinates (x, y) in m") from None
    return real(f"{key}: x", x, "m"), real(f"{key}: y", y, "m")


def unit_vector(key: str, value: object) -> Point:
    """The unit vector along two components, or a ValueError that names the key."""
    x, y = check_point(key, value)
    size = math.hypot(x, y)
    if not size:
        raise ValueError(f"{key} = (0, 0) has no direction: give a vector that is not zero")
    return x / size, y / size


def check_distinct(key: str, points: Iterable[Point], remedy: str) -> None:
    """A ValueError if two successive points coincide."""
    for p, q in pairwise(tuple(map(float, point)) for point in points):
        if p == q:
            raise ValueError(f"{key} has zero length at {p} m: {remedy}")


def suggest(name: object, known: Iterable[str]) -> str:
    """The remedy for an unknown name: the known one nearest to it, or all of them."""
    known = tuple(known)
    near = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(map(repr, known))}"
