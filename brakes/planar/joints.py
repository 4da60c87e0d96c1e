"""Joints between two bodies, or a body and the ground: what they forbid and how they rub.

Coordinates [m] are those of the drawing.  The force of a joint is the one on the body named first; a bar or
cable in tension and a contact that pushes are positive.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from beamdyn.common.checks import not_negative, positive, real
from brakes.planar.rows import (
    GROUND,
    Friction,
    Line,
    Path,
    Point,
    Row,
    Turn,
    apart,
    direction,
    point,
    polyline,
)


@dataclass(frozen=True)
class Pin:
    """A pin: a point of a body stays on a point of another.

    Parameters
    ----------
    name, body, other : str
        Its name; the two bodies, of which `other` may be `GROUND`.
    at : tuple of 2 floats
        Where it is on the body in the drawing [m].
    at_other : tuple of 2 floats, optional
        Where it is on the other body, if not at the same place; `assemble` brings the two together.
    radius, friction : float
        Radius of the pivot [m] and coefficient of friction.
    """

    name: str
    body: str
    other: str
    at: Point
    at_other: Point | None = None
    radius: float = 0.0
    friction: float = 0.0

    def __post_init__(self) -> None:
        key = f"pin {self.name!r}"
        point(f"{key}: at", self.at)
        point(f"{key}: at_other", self._at_other)
        not_negative(f"{key}: radius", self.radius, "m", "give the radius of the pivot")
        _friction(key, self.friction)
        if self.friction and not self.radius:
            raise ValueError(f"{key} has friction but no radius: give the radius of the pivot in m")

    @property
    def _at_other(self) -> Point:
        return self.at if self.at_other is None else self.at_other

    def rows(self) -> tuple[Row, ...]:
        """Two rows, along x and y."""
        ends = self.body, self.at, self.other, self._at_other
        return Line(*ends, GROUND, (1.0, 0.0)), Line(*ends, GROUND, (0.0, 1.0))

    def rubbing(self) -> Friction:
        """A couple against the rotation: the force touches the circle of radius r mu/sqrt(1 + mu^2)."""
        return Friction(
            Turn(self.body, self.other), self.radius * self.friction / math.hypot(1.0, self.friction)
        )


@dataclass(frozen=True)
class Bar:
    """A two-force link of constant length between points of two bodies.

    Parameters
    ----------
    name, body, other : str
        Its name; the two bodies, of which one may be `GROUND`.
    at, to : tuple of 2 floats
        Its end on the body, and on the other, in the drawing [m].
    length : float, optional
        Its length [m] if not the drawing's.
    """

    name: str
    body: str
    other: str
    at: Point
    to: Point
    length: float | None = None

    def __post_init__(self) -> None:
        key = f"bar {self.name!r}"
        ends = point(f"{key}: at", self.at), point(f"{key}: to", self.to)
        apart(key, ends, "move one of its ends, or join the bodies by a pin")
        if self.length is not None:
            positive(f"{key}: length", self.length, "m")

    def rows(self) -> tuple[Row, ...]:
        """One row, positive in tension."""
        length = math.dist(self.at, self.to) if self.length is None else self.length
        return (Path((self.body, self.other), (self.at, self.to), length),)


@dataclass(frozen=True)
class Slot:
    """A point of a body slides along a straight slot of another; it holds both ways.

    Parameters
    ----------
    name, body, other : str
        Its name; the body that has the point, and the one that has the slot.
    at : tuple of 2 floats
        The point [m].
    along : tuple of 2 floats
        Direction of the slot.
    on : tuple of 2 floats, optional
        A point of the slot [m], if it does not pass through `at` in the drawing.
    friction : float
        Coefficient of friction.
    """

    name: str
    body: str
    other: str
    at: Point
    along: Point
    on: Point | None = None
    friction: float = 0.0

    def __post_init__(self) -> None:
        _check_line(f"slot {self.name!r}", self.at, self.on, self.friction)
        direction(f"slot {self.name!r}: along", self.along)

    def rows(self) -> tuple[Row, ...]:
        """One row: the force on the body, positive to the left of `along`."""
        x, y = direction("along", self.along)
        return (_line(self, (-y, x)),)

    def rubbing(self) -> Friction:
        """A force against the sliding."""
        return Friction(_line(self, direction("along", self.along)), self.friction)


@dataclass(frozen=True)
class Contact:
    """A point of a body pushes on a straight face of another.

    Parameters
    ----------
    name, body, other : str
        Its name; the body that has the point, and the one that has the face.
    at : tuple of 2 floats
        The point [m].
    normal : tuple of 2 floats
        Normal of the face, from the other body towards the body.
    on : tuple of 2 floats, optional
        A point of the face [m], if it does not pass through `at` in the drawing.
    friction : float
        Coefficient of friction.
    """

    name: str
    body: str
    other: str
    at: Point
    normal: Point
    on: Point | None = None
    friction: float = 0.0

    def __post_init__(self) -> None:
        _check_line(f"contact {self.name!r}", self.at, self.on, self.friction)
        direction(f"contact {self.name!r}: normal", self.normal)

    def rows(self) -> tuple[Row, ...]:
        """One row, positive when it pushes."""
        return (_line(self, direction("normal", self.normal)),)

    def rubbing(self) -> Friction:
        """A force against the sliding."""
        x, y = direction("normal", self.normal)
        return Friction(_line(self, (-y, x)), self.friction)


@dataclass(frozen=True)
class RotationLock:
    """The angle of a body is `ratio` times that of another (1: no relative rotation; -1: mirrored arms).

    Parameters
    ----------
    name, body, other : str
        Its name and the two bodies.
    ratio : float
        Ratio of the angles; other than 1 it is a gear, whose housing is on the ground.
    """

    name: str
    body: str
    other: str
    ratio: float = 1.0

    def __post_init__(self) -> None:
        real(f"rotation lock {self.name!r}: ratio", self.ratio)

    def rows(self) -> tuple[Row, ...]:
        """One row: the couple on the body [N m]."""
        return (Turn(self.body, self.other, self.ratio),)


@dataclass(frozen=True)
class Cable:
    """A taut cable of fixed length over frictionless eyes; one tension, pulling positive.

    Parameters
    ----------
    name : str
        Its name.
    bodies : tuple of str
        The body of each point.
    points : tuple of points
        Its points in the drawing [m], from end to end.
    length : float, optional
        Its length [m] if not the drawing's.
    """

    name: str
    bodies: tuple[str, ...]
    points: tuple[Point, ...]
    length: float | None = None

    def __post_init__(self) -> None:
        key = f"cable {self.name!r}"
        if len(self.bodies) != len(self.points) or len(self.points) < 2:
            raise ValueError(
                f"{key} has {len(self.bodies)} bodies and {len(self.points)} points: "
                "give two or more points, and the body of each"
            )
        apart(key, tuple(point(f"{key}: points", p) for p in self.points), "move one of its points")
        if self.length is not None:
            positive(f"{key}: length", self.length, "m")

    def rows(self) -> tuple[Row, ...]:
        """One row, positive in tension."""
        length = polyline(self.points) if self.length is None else self.length
        return (Path(tuple(self.bodies), tuple(self.points), length),)


Joint = Pin | Bar | Slot | Contact | RotationLock | Cable


def _line(joint: Slot | Contact, normal: Point) -> Line:
    on = joint.at if joint.on is None else joint.on
    return Line(joint.body, joint.at, joint.other, on, joint.other, normal)


def _check_line(key: str, at: Point, on: Point | None, friction: float) -> None:
    point(f"{key}: at", at)
    point(f"{key}: on", at if on is None else on)
    _friction(key, friction)


def _friction(key: str, value: float) -> None:
    not_negative(f"{key}: friction", value, "", "friction opposes the motion by itself; give its size")
