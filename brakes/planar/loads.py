"""Loads, each with a known magnitude or an unknown amplitude (`magnitude=None`) that equilibrium gives.

Each load has a coordinate on which it does its work: the travel of the point along the force, the rotation,
the shortening of the cable.  A load of magnitude 0 measures a travel, and any load may drive a stroke.
"""

from __future__ import annotations

from dataclasses import dataclass

from beamdyn.common.checks import not_negative, real
from brakes.planar.rows import GROUND, Line, Path, Point, Row, Turn, apart, direction, point, polyline


@dataclass(frozen=True)
class Force:
    """A force on a point of a body.

    Parameters
    ----------
    name, body : str
        Its name and the body.
    at : tuple of 2 floats
        The point in the drawing [m].
    direction : tuple of 2 floats
        Its direction in the drawing.
    magnitude : float, optional
        Its size along the direction [N]; None: unknown.
    follows : bool
        Whether its direction turns with the body; otherwise it is fixed in space.
    """

    name: str
    body: str
    at: Point
    direction: Point
    magnitude: float | None = None
    follows: bool = False

    def __post_init__(self) -> None:
        point(f"force {self.name!r}: at", self.at)
        direction(f"force {self.name!r}: direction", self.direction)
        _magnitude(f"force {self.name!r}", self.magnitude, "N")

    def row(self) -> Row:
        """Travel of the point along the force [m]."""
        frame = self.body if self.follows else GROUND
        return Line(self.body, self.at, GROUND, self.at, frame, direction("direction", self.direction))


@dataclass(frozen=True)
class Moment:
    """A moment on a body, anticlockwise positive, and its opposite on another.

    Parameters
    ----------
    name, body : str
        Its name and the body.
    magnitude : float, optional
        Its size [N m]; None: unknown.
    other : str
        The body that has the opposite moment.
    """

    name: str
    body: str
    magnitude: float | None = None
    other: str = GROUND

    def __post_init__(self) -> None:
        _magnitude(f"moment {self.name!r}", self.magnitude, "N m")

    def row(self) -> Row:
        """Rotation of the body against the other [rad]."""
        return Turn(self.body, self.other)


@dataclass(frozen=True)
class CablePair:
    """A cable and its housing: equal and opposite forces that pull points of two bodies together.

    Parameters
    ----------
    name, body, other : str
        Its name and the two bodies.
    at, to : tuple of 2 floats
        The points on the body, and on the other, in the drawing [m].
    magnitude : float, optional
        Its tension [N]; None: unknown.
    """

    name: str
    body: str
    other: str
    at: Point
    to: Point
    magnitude: float | None = None

    def __post_init__(self) -> None:
        _check_ends(f"cable pair {self.name!r}", self.at, self.to)
        _magnitude(f"cable pair {self.name!r}", self.magnitude, "N")

    def row(self) -> Row:
        """Shortening of the distance between the points [m]."""
        ends = self.at, self.to
        return Path((self.body, self.other), ends, polyline(ends))


@dataclass(frozen=True)
class Spring:
    """A linear spring between points of two bodies, which pulls with stiffness * (length - free).

    Parameters
    ----------
    name, body, other : str
        Its name and the two bodies.
    at, to : tuple of 2 floats
        Its ends on the body, and on the other, in the drawing [m].
    stiffness : float
        Stiffness [N/m].
    free_length : float
        Length without force [m].
    """

    name: str
    body: str
    other: str
    at: Point
    to: Point
    stiffness: float
    free_length: float

    def __post_init__(self) -> None:
        _check_ends(f"spring {self.name!r}", self.at, self.to)
        not_negative(f"spring {self.name!r}: stiffness", self.stiffness, "N/m")
        not_negative(f"spring {self.name!r}: free_length", self.free_length, "m")

    def row(self) -> Row:
        """Shortening below the free length [m]."""
        return Path((self.body, self.other), (self.at, self.to), self.free_length)


@dataclass(frozen=True)
class TorsionSpring:
    """A linear spring between the angles of two bodies: moment -stiffness * (angle - free angle) on the body.

    Parameters
    ----------
    name, body : str
        Its name and the body.
    stiffness : float
        Stiffness [N m/rad].
    free_angle : float
        Relative angle without moment, counted from the drawing [rad].
    other : str
        The other body.
    """

    name: str
    body: str
    stiffness: float
    free_angle: float
    other: str = GROUND

    def __post_init__(self) -> None:
        not_negative(f"torsion spring {self.name!r}: stiffness", self.stiffness, "N m/rad")
        real(f"torsion spring {self.name!r}: free_angle", self.free_angle, "rad")

    def row(self) -> Row:
        """Rotation past the free angle [rad]."""
        return Turn(self.body, self.other, offset=self.free_angle)


Load = Force | Moment | CablePair | Spring | TorsionSpring


def _check_ends(key: str, at: Point, to: Point) -> None:
    ends = point(f"{key}: at", at), point(f"{key}: to", to)
    apart(key, ends, "it has no direction; move one of its ends")


def _magnitude(key: str, value: float | None, unit: str) -> None:
    if value is not None:
        real(f"{key}: magnitude", value, unit, "or None for an unknown amplitude")
