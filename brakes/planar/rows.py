"""The rows of which every joint and every load is made: `Line`, `Path`, `Turn` and `Round`.

A row is a scalar function of the position.  Its gradient is at the same time a set of forces on the bodies:
those of a unit multiplier (a joint) or of a unit magnitude (a load).  Each kind of row has

- `is_couple`: whether it is a couple [N m] on an angle [rad], rather than a force [N] on a length [m];
- `bodies`, on which it acts, and `ends`, its points, which set the scales of the mechanism;
- `add`, which evaluates all rows of its kind at once from columns, and `entries`, what one row contributes to
  these after its index;
- `constant`: the part of its value that does not depend on the position, lengths over that of the mechanism;
- `effects`: what it does to a body at a given size, for free-body diagrams.
"""

from __future__ import annotations

import difflib
import math
from abc import ABC, abstractmethod
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from itertools import pairwise
from typing import Any, NamedTuple, Protocol

import numpy as np

from beamdyn.common.inputs.checks import real
from beamdyn.common.words import Words, amount

# Points and directions in the drawing of a mechanism, and their checks -----------------------------------


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
            raise ValueError(Words(f"{key} has zero length at ", amount(*p), f": {remedy}"))


def suggest(name: object, known: Iterable[str]) -> str:
    """The remedy for an unknown name: the known one nearest to it, or all of them."""
    known = tuple(known)
    near = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(map(repr, known))}"


# All rows of one kind, evaluated at many positions at once ------------------------------------------------


_TINY = 1e-200  # keeps a direction finite where two points of a path meet


class Pose(NamedTuple):
    """Where all bodies and the ground are, arrays of shape (n + 1, S).

    centre : complex, the centres of their points.
    angle, spin : the angles by which they have turned [rad], and exp(i angle).
    """

    centre: np.ndarray
    angle: np.ndarray
    spin: np.ndarray


class Totals(NamedTuple):
    """Value (R, S) of each row, and its force (complex) and couple on each body, (R, n + 1, S)."""

    value: np.ndarray
    force: np.ndarray
    couple: np.ndarray

    def push(self, row: np.ndarray, body: np.ndarray, arm: np.ndarray, force: np.ndarray) -> None:
        """Add forces on bodies, each at an arm from the body's centre; a body may occur more than once."""
        np.add.at(self.force, (row, body), force)
        np.add.at(self.couple, (row, body), np.imag(arm.conj() * force))


Arm = Callable[[str, Point], complex]  # distance from the centre of a body to a point of it, over L
Effect = tuple[np.ndarray, np.ndarray, float]  # point [m] (nan for a couple), force [N], couple [N m]


class Place(Protocol):
    """Where the bodies are at one instant: a `Position`."""

    def point(self, body: str, at: Point) -> np.ndarray:
        """Where a point of a body is [m], shape (2,)."""
        ...

    def angle(self, body: str) -> np.ndarray:
        """Angle by which a body has turned from the drawing [rad], shape ()."""
        ...


@dataclass(frozen=True)
class _AtPoint(ABC):
    """A row whose force acts at a point of a body, and back on another body that has a line or a circle."""

    body: str
    at: Point
    other: str
    on: Point

    is_couple = False

    @property
    def bodies(self) -> tuple[str, str]:
        """The body of the point and the other one."""
        return self.body, self.other

    @property
    def ends(self) -> tuple[End, End]:
        """The point, and that of the line or the centre of the circle."""
        return (self.body, self.at), (self.other, self.on)

    @abstractmethod
    def unit_force(self, place: Place) -> complex:
        """The force on the body of a unit row."""

    def effects(self, size: float, place: Place, body: str) -> Iterator[Effect]:
        """A force at the point, and its opposite on the other body."""
        if body in self.bodies:
            force = (size if body == self.body else -size) * self.unit_force(place)
            yield place.point(self.body, self.at), np.array((force.real, force.imag)), 0.0


@dataclass(frozen=True)
class Line(_AtPoint):
    """n.(p - o): distance of a point p of a body from a line through o of another, along its normal n.

    A unit row pushes the body along +n.  The normal turns with the body `frame`.
    """

    frame: str
    normal: Point

    def constant(self, length: float) -> float:
        """None."""
        return 0.0

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """One tuple."""
        bodies = index[self.body], index[self.other], index[self.frame]
        return [(*bodies, arm(self.body, self.at), arm(self.other, self.on), complex(*self.normal))]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """n.(p - o), with the couple n' x (p - o) on the body with which n turns."""
        a, b, frame, *vectors = columns
        turned = (pose.spin[k] * vector[:, None] for k, vector in zip((a, b, frame), vectors, strict=True))
        arm, arm_other, normal = turned
        gap = pose.centre[a] + arm - pose.centre[b] - arm_other
        totals.value[row] += np.real(normal.conj() * gap)
        totals.push(row, a, arm, normal)
        totals.push(row, b, arm_other, -normal)
        # A force that follows its body (frame = body) is not a gradient: it has no such couple.
        totals.couple[row, frame] += np.where((frame == a)[:, None], 0.0, np.imag(normal.conj() * gap))

    def unit_force(self, place: Place) -> complex:
        """The normal."""
        return complex(complex(*self.normal) * np.exp(1j * place.angle(self.frame)))


@dataclass(frozen=True)
class Round(_AtPoint):
    """Distance of a point p of a body from a circle about a point c of another, or the sliding along it.

    A unit row pushes the body along n = (p - c)/|p - c|, turned by `direction`, and the other body back, both
    at p.  Along the circle its gradient is the velocity of p over the surface; its value is 0 there.

    on : tuple of float
        The centre c.
    direction : complex
        1: away from the centre; -1: towards it; 1j: along the circle, anticlockwise.
    """

    radius: float
    direction: complex

    def constant(self, length: float) -> float:
        """Minus the radius, where the row is normal to the circle."""
        return -self.direction.real * self.radius / length

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """One tuple."""
        ends = arm(self.body, self.at), arm(self.other, self.on)
        return [(index[self.body], index[self.other], *ends, self.direction)]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """|p - c| where the row is normal to the face, 0 where it is tangential; forces act at p on both."""
        a, b, arm, on, way = columns
        arm = pose.spin[a] * arm[:, None]
        span = pose.centre[a] + arm - pose.centre[b] - pose.spin[b] * on[:, None]
        length = np.maximum(np.abs(span), _TINY)
        push = way[:, None] * span / length
        totals.value[row] += np.real(way)[:, None] * length
        totals.push(row, a, arm, push)
        totals.push(row, b, pose.centre[a] + arm - pose.centre[b], -push)

    def unit_force(self, place: Place) -> complex:
        """The normal of the circle at the point, turned by the direction."""
        out = complex(*(place.point(self.body, self.at) - place.point(self.other, self.on)))
        return self.direction * out / abs(out)


@dataclass(frozen=True)
class Path:
    """Shortening of a polyline over points of bodies below a length [m]; a unit row pulls it together."""

    bodies: tuple[str, ...]
    points: tuple[Point, ...]
    length: float

    is_couple = False

    @property
    def ends(self) -> tuple[End, ...]:
        """All points."""
        return tuple(zip(self.bodies, self.points, strict=True))

    def constant(self, length: float) -> float:
        """Its length."""
        return self.length / length

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """One tuple a segment."""
        return [(index[a], index[b], arm(a, p), arm(b, q)) for (a, p), (b, q) in pairwise(self.ends)]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """Minus the length of the path, whose segments pull their ends together."""
        a, b, arm, arm_other = columns
        arm, arm_other = pose.spin[a] * arm[:, None], pose.spin[b] * arm_other[:, None]
        span = pose.centre[b] + arm_other - pose.centre[a] - arm
        length = np.maximum(np.abs(span), _TINY)
        pull = span / length
        np.add.at(totals.value, row, -length)  # a path has a row for all its segments: not +=
        totals.push(row, a, arm, pull)
        totals.push(row, b, arm_other, -pull)

    def effects(self, size: float, place: Place, body: str) -> Iterator[Effect]:
        """At each point of the body, the pull towards its neighbours on the path."""
        points = np.array([place.point(*end) for end in self.ends])
        span = np.diff(points, axis=0)
        pull = size * span / np.linalg.norm(span, axis=1, keepdims=True)
        force = np.diff(np.pad(pull, ((1, 1), (0, 0))), axis=0)
        yield from ((points[k], force[k], 0.0) for k, owner in enumerate(self.bodies) if owner == body)


@dataclass(frozen=True)
class Turn:
    """Angle of a body less `ratio` times that of another and an offset [rad]; a unit row is a couple."""

    body: str
    other: str = GROUND
    ratio: float = 1.0
    offset: float = 0.0

    is_couple = True
    ends = ()

    @property
    def bodies(self) -> tuple[str, ...]:
        """The two bodies."""
        return self.body, self.other

    def constant(self, length: float) -> float:
        """Minus the offset."""
        return -self.offset

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """One tuple."""
        return [(index[self.body], index[self.other], self.ratio)]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """Angle - ratio * other angle; what a gear does not pass on, its housing on the ground takes."""
        a, b, ratio = columns[0], columns[1], columns[2][:, None]
        totals.value[row] += pose.angle[a] - ratio * pose.angle[b]
        totals.couple[row, a] += 1.0
        totals.couple[row, b] -= ratio
        totals.couple[row, -1] += ratio - 1.0

    def effects(self, size: float, place: Place, body: str) -> Iterator[Effect]:
        """A couple; what a gear does not pass on, its housing on the ground takes."""
        share = {self.body: 1.0, self.other: -self.ratio}
        share[GROUND] = share.get(GROUND, 0.0) + self.ratio - 1.0
        if share.get(body):
            yield np.full(2, np.nan), np.zeros(2), size * share[body]


Row = Line | Path | Turn | Round


class FrictionLaw(NamedTuple):
    """Friction of a joint: |friction| = coefficient * |force of the joint|, against the motion.

    row : the row along which it acts; its value grows in the direction of sliding.
    coefficient : friction per unit of the joint's force [m if the row is a couple, else 1].
    pressing : which of the joint's rows make up that force, by their indices; all if empty.
    label : where it acts, in words, if the joint has several.
    """

    row: Row
    coefficient: float
    pressing: tuple[int, ...] = ()
    label: str = ""
