"""The rows of a mechanism as arrays: their values and gradients at many positions at once.

Vectors are complex numbers.  Lengths are divided by one length L of the mechanism and taken from its centre;
the angle of a body is multiplied by the radius l of its points, so that the coordinates y = (x, y, l angle)
of all bodies are of one size, whatever the unit, place and size of the drawing.  The ground is the last body.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from brakes.planar.rows import GROUND, Line, Path, Point, Row, Turn

_TINY = 1e-200  # keeps a direction finite where two points of a path meet
_ONE_POINT = 1e-6  # radius below which the points of a body count as one


class Lines(NamedTuple):
    """Arrays of `Line`: rows, bodies and frames (indices), arms in the bodies and normals (complex)."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    frame: np.ndarray
    arm: np.ndarray
    arm_other: np.ndarray
    normal: np.ndarray


class Segments(NamedTuple):
    """Arrays of the segments of `Path`: rows, bodies (indices) and arms (complex) of their two ends."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    arm: np.ndarray
    arm_other: np.ndarray


class Turns(NamedTuple):
    """Arrays of `Turn`."""

    row: np.ndarray
    body: np.ndarray
    other: np.ndarray
    ratio: np.ndarray


class Rows(NamedTuple):
    """Rows at S positions.

    value : (S, R), lengths over L, angles in rad.
    force : (S, R, n + 1) complex, the force of a unit row on each body, the ground last.
    couple : (S, R, n + 1), its moment about the body's centre, over L.
    gradient : (S, R, 3 n), the derivatives of the values by the coordinates y: the same, ground left out.
    """

    value: np.ndarray
    force: np.ndarray
    couple: np.ndarray
    gradient: np.ndarray


@dataclass(frozen=True)
class System:
    """Arrays of a mechanism; rows are numbered joints first, then loads, then friction.

    Parameters
    ----------
    bodies : dict
        Index of each body; the ground has the last.
    joints : dict
        Rows of each joint (slice).
    loads, rubbing : dict
        Row of each load, and of the friction of each joint that has some.
    coefficient : ndarray
        Friction per unit of the joint's force, in the order of `rubbing`.
    length : float
        Length L of the mechanism [m].
    origin : complex
        Its centre [m].
    centre, radius : ndarray, shape (n + 1,)
        Centre (complex) of the points of each body, and their greatest distance l from it, over L.
    rounding : float
        Relative rounding of coordinates: that of the input, which grows with the distance from (0, 0).
    """

    bodies: dict[str, int]
    joints: dict[str, slice]
    loads: dict[str, int]
    rubbing: dict[str, int]
    coefficient: np.ndarray
    length: float
    origin: complex
    centre: np.ndarray
    radius: np.ndarray
    rounding: float
    constant: np.ndarray
    unit: np.ndarray
    lines: Lines
    segments: Segments
    turns: Turns

    @property
    def size(self) -> int:
        """Number of coordinates 3 n."""
        return 3 * (len(self.bodies) - 1)

    @property
    def constraints(self) -> int:
        """Number of rows of joints."""
        return max((rows.stop for rows in self.joints.values()), default=0)

    def rows(self, y: np.ndarray) -> Rows:
        """Values and gradients at coordinates y of shape (S, 3 n)."""
        shift, angle = self._pose(y)
        spin = np.exp(1j * angle)
        value = np.repeat(self.constant[:, None], len(y), axis=1)
        force = np.zeros((len(value), len(self.bodies), len(y)), complex)
        couple = np.zeros(force.shape)
        if self.lines.row.size:
            self._lines(shift, spin, value, force, couple)
        if self.segments.row.size:
            self._segments(shift, spin, value, force, couple)
        if self.turns.row.size:
            self._turns(angle, value, couple)
        parts = np.stack((np.real(force), np.imag(force), couple / self.radius[:, None]), axis=-1)
        gradient = np.moveaxis(parts[:, :-1], 2, 0).reshape(len(y), len(value), self.size)
        return Rows(value.T, np.moveaxis(force, 2, 0), np.moveaxis(couple, 2, 0), gradient)

    def place(self, y: np.ndarray, body: str, at: Point) -> np.ndarray:
        """Where a point of a body is [m], shape (S, 2)."""
        shift, angle = self._pose(y)
        k = self.bodies[body]
        arm = (complex(*at) - self.origin) / self.length - self.centre[k]
        # The displacement is added to the drawing, so that a point far from (0, 0) keeps its digits.
        moved = (shift[k] - self.centre[k] + arm * (np.exp(1j * angle[k]) - 1)) * self.length
        return np.array(at) + np.stack((moved.real, moved.imag), axis=-1)

    def angle(self, y: np.ndarray, body: str) -> np.ndarray:
        """Angle of a body [rad], shape (S,)."""
        return self._pose(y)[1][self.bodies[body]]

    def _pose(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Centres (complex) and angles of all bodies and the ground, each (n + 1, S)."""
        pose = np.zeros((len(self.bodies), 3, len(y)))
        pose[:-1] = y.T.reshape(-1, 3, len(y))
        return self.centre[:, None] + pose[:, 0] + 1j * pose[:, 1], pose[:, 2] / self.radius[:, None]

    def _lines(
        self, shift: np.ndarray, spin: np.ndarray, value: np.ndarray, force: np.ndarray, couple: np.ndarray
    ) -> None:
        """n.(p - o), with the couple n' x (p - o) on the body with which n turns; arrays have S last."""
        row, a, b, frame = self.lines[:4]
        arm, arm_other, normal = (
            spin[k] * vector[:, None] for k, vector in zip((a, b, frame), self.lines[4:], strict=True)
        )
        gap = shift[a] + arm - shift[b] - arm_other
        value[row] += np.real(normal.conj() * gap)
        force[row, a] += normal
        couple[row, a] += np.imag(arm.conj() * normal)
        force[row, b] -= normal
        couple[row, b] -= np.imag(arm_other.conj() * normal)
        # A force that follows its body (frame = body) is not a gradient: it has no such couple.
        couple[row, frame] += np.where((frame == a)[:, None], 0.0, np.imag(normal.conj() * gap))

    def _segments(
        self, shift: np.ndarray, spin: np.ndarray, value: np.ndarray, force: np.ndarray, couple: np.ndarray
    ) -> None:
        """Minus the length of the path, whose segments pull their ends together."""
        row, a, b, arm, arm_other = self.segments
        arm, arm_other = spin[a] * arm[:, None], spin[b] * arm_other[:, None]
        span = shift[b] + arm_other - shift[a] - arm
        length = np.maximum(np.abs(span), _TINY)
        pull = span / length
        np.add.at(value, row, -length)  # a path may have several segments on one body: not +=
        np.add.at(force, (row, a), pull)
        np.add.at(force, (row, b), -pull)
        np.add.at(couple, (row, a), np.imag(arm.conj() * pull))
        np.add.at(couple, (row, b), -np.imag(arm_other.conj() * pull))

    def _turns(self, angle: np.ndarray, value: np.ndarray, couple: np.ndarray) -> None:
        """Angle - ratio * other angle; what a gear does not pass on, its housing on the ground takes."""
        row, a, b, ratio = self.turns
        ratio = ratio[:, None]
        value[row] += angle[a] - ratio * angle[b]
        couple[row, a] += 1.0
        couple[row, b] -= ratio
        couple[row, -1] += ratio - 1.0


def build(
    bodies: Sequence[str],
    joints: Sequence[tuple[str, tuple[Row, ...]]],
    loads: Sequence[tuple[str, tuple[Row, ...]]],
    rubbing: Sequence[tuple[str, Row, float]],
) -> System:
    """Arrays of named rows; `rubbing` holds (joint, row, coefficient [m for a couple, else 1])."""
    index = {name: k for k, name in enumerate((*bodies, GROUND))}
    table = [row for _, rows in (*joints, *loads) for row in rows] + [row for _, row, _ in rubbing]
    slices, first = {}, 0
    for name, rows in (*joints, *loads):
        slices[name] = slice(first, first := first + len(rows))
    origin, length, centre, radius, rounding = _scales(table, index)
    is_couple = np.array([isinstance(row, Turn) for row in table], bool)

    def arm(body: str, at: Point) -> complex:
        return (complex(*at) - origin) / length - centre[index[body]]

    return System(
        bodies=index,
        joints={name: slices[name] for name, _ in joints},
        loads={name: slices[name].start for name, _ in loads},
        rubbing={name: first + k for k, (name, _, _) in enumerate(rubbing)},
        coefficient=np.array([c / length if isinstance(row, Turn) else c for _, row, c in rubbing]),
        length=length,
        origin=origin,
        centre=centre,
        radius=radius,
        rounding=rounding,
        constant=np.array([_constant(row, length) for row in table]),
        unit=np.where(is_couple, length, 1.0),
        lines=Lines(*_columns(7, _line_entries(table, index, arm))),
        segments=Segments(*_columns(5, _segment_entries(table, index, arm))),
        turns=Turns(*_columns(4, _turn_entries(table, index))),
    )


def _constant(row: Row, length: float) -> float:
    if isinstance(row, Path):
        return row.length / length
    return -row.offset if isinstance(row, Turn) else 0.0


def _points(row: Row) -> list[tuple[str, Point]]:
    if isinstance(row, Path):
        return list(zip(row.bodies, row.points, strict=True))
    return [(row.body, row.at), (row.other, row.on)] if isinstance(row, Line) else []


def _scales(table: Sequence[Row], index: dict[str, int]):
    """Origin, length L, and the centre, radius and rounding of the points of each body."""
    points = [(index[body], complex(*at)) for row in table for body, at in _points(row)]
    origin = complex(np.mean([p for _, p in points])) if points else 0j
    length = max((abs(p - origin) for _, p in points), default=0.0) or 1.0
    centre, radius = np.zeros(len(index), complex), np.ones(len(index))
    for k in range(len(index) - 1):
        own = np.array([(p - origin) / length for body, p in points if body == k])
        if own.size:
            centre[k] = own.mean()
            spread = np.abs(own - centre[k]).max()
            radius[k] = spread if spread > _ONE_POINT else 1.0
    rounding = np.finfo(float).eps * (1 + abs(origin) / length) / radius.min()
    return origin, length, centre, radius, rounding


def _line_entries(table, index, arm):
    return [
        (
            r,
            index[w.body],
            index[w.other],
            index[w.frame],
            arm(w.body, w.at),
            arm(w.other, w.on),
            complex(*w.normal),
        )
        for r, w in enumerate(table)
        if isinstance(w, Line)
    ]


def _segment_entries(table, index, arm):
    return [
        (r, index[a], index[b], arm(a, p), arm(b, q))
        for r, w in enumerate(table)
        if isinstance(w, Path)
        for (a, p), (b, q) in zip(_points(w), _points(w)[1:], strict=False)
    ]


def _turn_entries(table, index):
    return [(r, index[w.body], index[w.other], w.ratio) for r, w in enumerate(table) if isinstance(w, Turn)]


def _columns(width: int, entries: list[tuple]) -> list[np.ndarray]:
    return (
        [np.array(column) for column in zip(*entries, strict=True)] if entries else [np.empty(0, int)] * width
    )
