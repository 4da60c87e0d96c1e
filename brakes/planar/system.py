"""The rows of a mechanism as arrays: their values and gradients at many positions at once.

Vectors are complex numbers.  Lengths are divided by one length L of the mechanism and taken from its centre;
the angle of a body is multiplied by the radius l of its points, so that the coordinates y = (x, y, l angle)
of all bodies are of one size, whatever the unit, place and size of the drawing.  The ground is the last body.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from brakes.planar.points import GROUND, Point
from brakes.planar.row_arrays import Arrays, Pose, Totals
from brakes.planar.rows import Arm, FrictionLaw, Row

_ONE_POINT = 1e-6  # radius below which the points of a body count as one


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
    loads, friction : dict
        Row of each load, and of each friction.
    pressing : list of ndarray of int
        Rows of the joint that press where there is friction, in the order of `friction`.
    coefficient : ndarray
        Friction per unit of their resultant, in the same order.
    length : float
        Length L of the mechanism [m].
    origin : complex
        Its centre [m].
    centre, radius : ndarray, shape (n + 1,)
        Centre (complex) of the points of each body, and their greatest distance l from it, over L.
    rounding : float
        Relative rounding of coordinates: that of the input, which grows with the distance from (0, 0).
    constant : ndarray, shape (R,)
        Part of each row's value that does not depend on the position.
    unit : ndarray, shape (R,)
        Size [N, N m] of each row over its multiplier: L for a couple, 1 for a force.
    arrays : list of Arrays
        The rows of each kind.
    """

    bodies: dict[str, int]
    joints: dict[str, slice]
    loads: dict[str, int]
    friction: dict[str, int]
    pressing: list[np.ndarray]
    coefficient: np.ndarray
    length: float
    origin: complex
    centre: np.ndarray
    radius: np.ndarray
    rounding: float
    constant: np.ndarray
    unit: np.ndarray
    arrays: list[Arrays]

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
        centre, angle = self._pose(y)
        pose = Pose(centre, angle, np.exp(1j * angle))
        value = np.repeat(self.constant[:, None], len(y), axis=1)
        force = np.zeros((len(value), len(self.bodies), len(y)), complex)
        couple = np.zeros(force.shape)
        for arrays in self.arrays:
            arrays.add(pose, Totals(value, force, couple))
        parts = np.stack((np.real(force), np.imag(force), couple / self.radius[:, None]), axis=-1)
        gradient = parts[:, :-1].transpose(2, 0, 1, 3).reshape(len(y), len(value), self.size)
        return Rows(value.T, force.transpose(2, 0, 1), couple.transpose(2, 0, 1), gradient)

    def place(self, y: np.ndarray, body: str, at: Point) -> np.ndarray:
        """Where a point of a body is [m], shape (S, 2)."""
        k = self.bodies[body]
        if 3 * k == self.size:  # the ground
            return np.tile(np.array(at, dtype=float), (len(y), 1))
        arm = (complex(*at) - self.origin) / self.length - self.centre[k]
        # The displacement is added to the drawing, so that a point far from (0, 0) keeps its digits.
        shift = y[:, 3 * k] + 1j * y[:, 3 * k + 1]
        moved = (shift + arm * (np.exp(1j * self.angle(y, body)) - 1)) * self.length
        return np.array(at) + moved.view(float).reshape(-1, 2)

    def angle(self, y: np.ndarray, body: str) -> np.ndarray:
        """Angle of a body [rad], shape (S,)."""
        k = self.bodies[body]
        return y[:, 3 * k + 2] / self.radius[k] if 3 * k < self.size else np.zeros(len(y))

    def _pose(self, y: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Centres (complex) and angles of all bodies and the ground, each (n + 1, S)."""
        moved = np.zeros((len(self.bodies), 3, len(y)))
        moved[:-1] = y.T.reshape(-1, 3, len(y))
        return self.centre[:, None] + moved[:, 0] + 1j * moved[:, 1], moved[:, 2] / self.radius[:, None]


def build(
    bodies: Sequence[str],
    joints: Mapping[str, Sequence[Row]],
    loads: Mapping[str, Row],
    friction: Mapping[str, tuple[str, FrictionLaw]],
) -> System:
    """Arrays of named rows.

    Parameters
    ----------
    bodies : sequence of str
        Names of the bodies, without the ground.
    joints, loads : mapping
        Rows of each joint, and row of each load.
    friction : mapping
        Name of the joint and law of each friction.
    """
    index = {name: k for k, name in enumerate((*bodies, GROUND))}
    laws = [law for _, law in friction.values()]
    table = [*chain(*joints.values()), *loads.values(), *(law.row for law in laws)]
    slices, first = {}, 0
    for name, rows in joints.items():
        slices[name] = slice(first, first := first + len(rows))
    origin, length, centre, radius, rounding = _scales(table, index)

    def arm(body: str, at: Point) -> complex:
        return (complex(*at) - origin) / length - centre[index[body]]

    return System(
        bodies=index,
        joints=slices,
        loads={name: first + k for k, name in enumerate(loads)},
        friction={name: first + len(loads) + k for k, name in enumerate(friction)},
        pressing=[_pressing(slices[joint], law) for joint, law in friction.values()],
        coefficient=np.array([law.coefficient / (length if law.row.is_couple else 1.0) for law in laws]),
        length=length,
        origin=origin,
        centre=centre,
        radius=radius,
        rounding=rounding,
        constant=np.array([row.constant(length) for row in table]),
        unit=np.array([length if row.is_couple else 1.0 for row in table]),
        arrays=_arrays(table, index, arm),
    )


def _pressing(joint: slice, law: FrictionLaw) -> np.ndarray:
    """Indices of the rows that make up the force that presses."""
    rows = np.arange(joint.start, joint.stop)
    return rows[list(law.pressing)] if law.pressing else rows


def _arrays(table: Sequence[Row], index: Mapping[str, int], arm: Arm) -> list[Arrays]:
    """The rows of each kind as arrays."""
    entries: dict[type[Arrays], list[tuple[Any, ...]]] = defaultdict(list)
    for r, row in enumerate(table):
        entries[row.arrays] += [(r, *entry) for entry in row.entries(index, arm)]
    return [kind(*map(np.array, zip(*rows, strict=True))) for kind, rows in entries.items()]


def _scales(
    table: Sequence[Row], index: Mapping[str, int]
) -> tuple[complex, float, np.ndarray, np.ndarray, float]:
    """Origin, length L, and the centre, radius and rounding of the points of each body."""
    points = [(index[body], complex(*at)) for row in table for body, at in row.ends]
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
