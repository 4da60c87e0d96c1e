"""The four kinds of rows of which all joints and loads are made: `Line`, `Path`, `Turn` and `Round`.

A row is a scalar function of the positions of the bodies.  Its gradient is at the same time a set of forces
on the bodies, for a unit multiplier (of a joint) or a unit magnitude (of a load).  Each kind of row has

- `is_couple`: whether it is a couple [N m] on an angle [rad], not a force [N] on a length [m];
- `bodies` on which it acts, and `ends`, its points, from which the scales of the mechanism are set;
- `add`, which evaluates all rows of this kind at once from columns of data, and `entries`, which returns the
  data of one row for these columns, without the row's index;
- `constant`: the part of its value that does not depend on the position, lengths divided by the mechanism's;
- `effects`: forces and couples on a body for a given multiplier of the row, for free-body diagrams.

In shapes of arrays, S counts positions, n bodies, and R rows.
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
End = tuple[str, Point]  # a body, and the drawn position of one of its points [m]


def path_length(points: Iterable[Point]) -> float:
    """Compute the length of a polyline [m]."""
    return sum(math.dist(p, q) for p, q in pairwise(points))


def check_point(key: str, value: object) -> Point:
    """Return two finite coordinates [m]; raise a ValueError that names the key for anything else."""
    try:
        x, y = value  # pyright: ignore[reportGeneralTypeIssues]  (anything else is refused below)
    except (TypeError, ValueError):
        raise ValueError(f"{key} = {value!r}: give two coordinates (x, y) in m") from None
    return real(f"{key}: x", x, "m"), real(f"{key}: y", y, "m")


def unit_vector(key: str, value: object) -> Point:
    """Return the unit vector of a direction (x, y); raise a ValueError that names `key` for (0, 0)."""
    x, y = check_point(key, value)
    size = math.hypot(x, y)
    if not size:
        raise ValueError(f"{key} = (0, 0) has no direction: give a vector that is not zero")
    return x / size, y / size


def check_distinct(key: str, points: Iterable[Point], remedy: str) -> None:
    """Raise a ValueError if two successive points coincide."""
    for p, q in pairwise(tuple(map(float, point)) for point in points):
        if p == q:
            raise ValueError(Words(f"{key} has zero length at ", amount(*p), f": {remedy}"))


def suggest(name: object, known: Iterable[str]) -> str:
    """Compose advice for an unknown name: suggest the most similar known name, or list all."""
    known = tuple(known)
    near = difflib.get_close_matches(str(name), known, n=1)
    return f"did you mean {near[0]!r}?" if near else f"known: {', '.join(map(repr, known))}"


# All rows of one kind, evaluated at many positions at once ------------------------------------------------


_TINY = 1e-200  # least length, so that a direction is finite where two points of a path coincide


class Pose(NamedTuple):
    """Positions of all bodies and of the ground (last): arrays (bodies, positions).

    centre : complex, centres of the bodies' points.
    angle, spin : angles by which the bodies have turned [rad], and exp(i angle).
    """

    centre: np.ndarray
    angle: np.ndarray
    spin: np.ndarray


class Totals(NamedTuple):
    """Value (rows, positions) of each row; force (complex) and couple on each body for unit multipliers.

    Forces and couples have the shape (rows, bodies, positions).
    """

    value: np.ndarray
    force: np.ndarray
    couple: np.ndarray

    def push(self, row: np.ndarray, body: np.ndarray, arm: np.ndarray, force: np.ndarray) -> None:
        """Add forces on bodies, each at an arm from the body's centre; a body may occur several times."""
        np.add.at(self.force, (row, body), force)
        np.add.at(self.couple, (row, body), np.imag(arm.conj() * force))


# Function: the vector from the centre of a body to a point of it, over the mechanism's length L.
Arm = Callable[[str, Point], complex]
Effect = tuple[np.ndarray, np.ndarray, float]  # point [m] (nan for a couple), force [N], couple [N m]


class Place(Protocol):
    """Interface of a position at one instant, such as `Position`."""

    def point(self, body: str, at: Point) -> np.ndarray:
        """Return the position of a body's point [m], shape (2,), given by its position in the drawing."""
        ...

    def angle(self, body: str) -> np.ndarray:
        """Return the angle by which a body has turned from the drawing [rad], shape ()."""
        ...


@dataclass(frozen=True)
class _AtPoint(ABC):
    """Base of rows whose force acts at a body's point, with a reaction on another body's line or circle."""

    body: str
    at: Point
    other: str
    on: Point

    is_couple = False

    @property
    def bodies(self) -> tuple[str, str]:
        """Names of the body at whose point the force acts, and of the body that takes the reaction."""
        return self.body, self.other

    @property
    def ends(self) -> tuple[End, End]:
        """The body's point, and a point of the other body's line or the centre of its circle."""
        return (self.body, self.at), (self.other, self.on)

    @abstractmethod
    def unit_force(self, place: Place) -> complex:
        """Return the force on the body for a unit multiplier, as a complex number."""

    def effects(self, size: float, place: Place, body: str) -> Iterator[Effect]:
        """Yield the force at the point on a body, if it is one of the two bodies; see `Effect`."""
        if body in self.bodies:
            force = (size if body == self.body else -size) * self.unit_force(place)
            yield place.point(self.body, self.at), np.array((force.real, force.imag)), 0.0


@dataclass(frozen=True)
class Line(_AtPoint):
    """Distance n.(p - o) of a body's point p, along the normal n, from a line of another body through o.

    A unit multiplier pushes the body along +n.  The normal turns with the body `frame`.
    """

    frame: str
    normal: Point

    def constant(self, length: float) -> float:
        """Return 0, the part of the value that does not change with the position."""
        return 0.0

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """Return the arguments of `add` in a tuple: indices of three bodies, two arms, and the normal."""
        bodies = index[self.body], index[self.other], index[self.frame]
        return [(*bodies, arm(self.body, self.at), arm(self.other, self.on), complex(*self.normal))]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """Add each n.(p - o) to its row's value, and the row's forces and couples to those on the bodies.

        A body `frame` other than that of p also receives the couple n x (p - o), as the normal turns with it.
        """
        a, b, frame, *vectors = columns
        turned = (pose.spin[k] * vector[:, None] for k, vector in zip((a, b, frame), vectors, strict=True))
        arm, arm_other, normal = turned
        gap = pose.centre[a] + arm - pose.centre[b] - arm_other
        totals.value[row] += np.real(normal.conj() * gap)
        totals.push(row, a, arm, normal)
        totals.push(row, b, arm_other, -normal)
        # A force that turns with its body (frame = body) is not a gradient of a value: it has no such couple.
        totals.couple[row, frame] += np.where((frame == a)[:, None], 0.0, np.imag(normal.conj() * gap))

    def unit_force(self, place: Place) -> complex:
        """Return the normal at a position as a complex number: the force on the body for unit multiplier."""
        return complex(complex(*self.normal) * np.exp(1j * place.angle(self.frame)))


@dataclass(frozen=True)
class Round(_AtPoint):
    """Distance of a body's point p from a circle about a point c of another body, or the sliding along it.

    A unit multiplier pushes the body along n = (p - c)/|p - c|, turned by `direction`, and the other body
    back, both at p.  Along the circle its gradient is the velocity of p over the surface, and its value is 0.

    on : tuple of float
        The centre c of the circle.
    direction : complex
        1: away from the centre; -1: towards it; 1j: along the circle, anticlockwise.
    """

    radius: float
    direction: complex

    def constant(self, length: float) -> float:
        """Return the constant term of the value: minus the radius over the mechanism's length, or 0.

        It is 0 unless the row is normal to the circle.
        """
        return -self.direction.real * self.radius / length

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """Return the arguments of `add` in a tuple: indices of two bodies, two arms, and the direction."""
        ends = arm(self.body, self.at), arm(self.other, self.on)
        return [(index[self.body], index[self.other], *ends, self.direction)]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """Add |p - c| to the value of each row normal to the circle, and the forces of all rows at p.

        |p - c| is subtracted if `direction` is -1; nothing is added to the value of a row along the circle.
        """
        a, b, arm, on, way = columns
        arm = pose.spin[a] * arm[:, None]
        span = pose.centre[a] + arm - pose.centre[b] - pose.spin[b] * on[:, None]
        length = np.maximum(np.abs(span), _TINY)
        push = way[:, None] * span / length
        totals.value[row] += np.real(way)[:, None] * length
        totals.push(row, a, arm, push)
        totals.push(row, b, pose.centre[a] + arm - pose.centre[b], -push)

    def unit_force(self, place: Place) -> complex:
        """Return the normal of the circle at the point, turned by `direction`, as a complex number."""
        out = complex(*(place.point(self.body, self.at) - place.point(self.other, self.on)))
        return self.direction * out / abs(out)


@dataclass(frozen=True)
class Path:
    """Shortening of a polyline through points of bodies below a length [m]; its multiplier is the tension."""

    bodies: tuple[str, ...]
    points: tuple[Point, ...]
    length: float

    is_couple = False

    @property
    def ends(self) -> tuple[End, ...]:
        """Each point of the path with its body."""
        return tuple(zip(self.bodies, self.points, strict=True))

    def constant(self, length: float) -> float:
        """Return the constant part of the value: the length of the path over that of the mechanism."""
        return self.length / length

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """Return the arguments of `add`, a tuple for each segment: two indices of bodies, two arms."""
        return [(index[a], index[b], arm(a, p), arm(b, q)) for (a, p), (b, q) in pairwise(self.ends)]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """Subtract each path's length from the value of its row, and add the pulls of its segments.

        The pulls act on the bodies as forces, with couples about the centres of the bodies.
        """
        a, b, arm, arm_other = columns
        arm, arm_other = pose.spin[a] * arm[:, None], pose.spin[b] * arm_other[:, None]
        span = pose.centre[b] + arm_other - pose.centre[a] - arm
        length = np.maximum(np.abs(span), _TINY)
        pull = span / length
        # A path has one row for several segments: += with repeated indices would add only one segment.
        np.add.at(totals.value, row, -length)
        totals.push(row, a, arm, pull)
        totals.push(row, b, arm_other, -pull)

    def effects(self, size: float, place: Place, body: str) -> Iterator[Effect]:
        """Yield the force at each point of the body: the pull towards the neighbouring points of the path."""
        points = np.array([place.point(*end) for end in self.ends])
        span = np.diff(points, axis=0)
        pull = size * span / np.linalg.norm(span, axis=1, keepdims=True)
        force = np.diff(np.pad(pull, ((1, 1), (0, 0))), axis=0)
        yield from ((points[k], force[k], 0.0) for k, owner in enumerate(self.bodies) if owner == body)


@dataclass(frozen=True)
class Turn:
    """Angle of a body less `ratio` times the angle of another and less an offset [rad]; acts as a couple."""

    body: str
    other: str = GROUND
    ratio: float = 1.0
    offset: float = 0.0

    is_couple = True
    ends = ()

    @property
    def bodies(self) -> tuple[str, ...]:
        """The body that rotates, and the body relative to which it rotates."""
        return self.body, self.other

    def constant(self, length: float) -> float:
        """Return the part of the value that does not change with the position: minus the offset [rad]."""
        return -self.offset

    def entries(self, index: Mapping[str, int], arm: Arm) -> list[tuple[Any, ...]]:
        """Return the arguments of `add` in a tuple: indices of two bodies, and the ratio."""
        return [(index[self.body], index[self.other], self.ratio)]

    @staticmethod
    def add(pose: Pose, totals: Totals, row: np.ndarray, *columns: np.ndarray) -> None:
        """Add angle - ratio * other angle to the value of each row, and the couples to those on the bodies.

        The ground, as a gear's housing, receives the couple that balances those on the two bodies.
        """
        a, b, ratio = columns[0], columns[1], columns[2][:, None]
        totals.value[row] += pose.angle[a] - ratio * pose.angle[b]
        totals.couple[row, a] += 1.0
        totals.couple[row, b] -= ratio
        totals.couple[row, -1] += ratio - 1.0

    def effects(self, size: float, place: Place, body: str) -> Iterator[Effect]:
        """Yield the couple on a body; a gear's housing on the ground takes the couples' difference."""
        share = {self.body: 1.0, self.other: -self.ratio}
        share[GROUND] = share.get(GROUND, 0.0) + self.ratio - 1.0
        if share.get(body):
            yield np.full(2, np.nan), np.zeros(2), size * share[body]


Row = Line | Path | Turn | Round


class FrictionLaw(NamedTuple):
    """Friction law of a joint: |friction| = coefficient * |force of the joint|, against the motion.

    row : the row along which friction acts; its value grows in the direction of sliding.
    coefficient : friction divided by the joint's force [m if the row is a couple, else 1].
    pressing : indices of the joint's rows that make up that force; all of them if empty.
    label : where the friction acts, in words, if the joint has several laws.
    """

    row: Row
    coefficient: float
    pressing: tuple[int, ...] = ()
    label: str = ""
