"""A mechanism as arrays over many positions: values and gradients of its rows, ranks, diagnoses.

Vectors are complex numbers.  Lengths are divided by one length L of the mechanism and taken from its centre;
the angle of a body is multiplied by the radius l of its points, so that the coordinates y = (x, y, l angle)
of all bodies are of one size, whatever the unit, place and size of the drawing.  The ground is the last body.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from itertools import chain
from typing import NamedTuple

import numpy as np

from beamdyn.common.results.statements import joined
from beamdyn.common.words import Words, amount
from brakes.planar.rows import GROUND, FrictionLaw, Point, Pose, Row, Totals

# Rank, null spaces and least-squares solutions of many small matrices at once, by singular values --------


RANK_TOLERANCE = 1e-7  # relative singular value that counts as 0; toggle positions are solved to 1e-8


class Decomposition(NamedTuple):
    """Singular values of matrices (S, m, n): u (S, m, m), s (S, min(m, n)), vt (S, n, n), ranks (S,).

    `kept` and `dropped` (S,) are the smallest singular value within the rank and the largest beyond it, over
    the largest of all: the wider the gap, the surer the rank.
    """

    u: np.ndarray
    s: np.ndarray
    vt: np.ndarray
    rank: np.ndarray
    kept: np.ndarray
    dropped: np.ndarray

    def null(self, index: int = 0) -> np.ndarray:
        """Basis of the null space of one matrix, (n, n - rank)."""
        return self.vt[index, self.rank[index] :].T

    def left_null(self, index: int = 0) -> np.ndarray:
        """Basis of the left null space of one matrix, (m, m - rank)."""
        return self.u[index, :, self.rank[index] :]

    def null_rows(self) -> np.ndarray:
        """Rows of vt, those outside the null space set to zero, (S, n, n)."""
        outside = np.arange(self.vt.shape[1]) < self.rank[:, None]
        return np.where(outside[:, :, None], 0.0, self.vt)

    def solve(self, b: np.ndarray) -> np.ndarray:
        """Least-squares solution of least norm, b of shape (S, m)."""
        k = self.s.shape[1]
        keep = np.arange(k) < self.rank[:, None]
        inverse = np.divide(1.0, self.s, out=np.zeros_like(self.s), where=keep)
        parts = inverse * times(self.u.swapaxes(1, 2)[:, :k], b)
        return times(self.vt[:, :k].swapaxes(1, 2), parts)


def times(a: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Products of matrices (S, m, n) and vectors (S, n) or (n,)."""
    return (a @ x[..., None])[..., 0]


def rank_tolerance(rounding: float) -> float:
    """Size, relative to the largest, up to which singular values and motions count as zero."""
    return max(RANK_TOLERANCE, 100 * rounding)


def decompose(a: np.ndarray, rounding: float) -> Decomposition:
    """Singular values, vectors and rank of matrices (S, m, n) whose entries have a relative rounding."""
    u, s, vt = np.linalg.svd(a)
    padded = np.concatenate((s, np.zeros((len(s), 1))), axis=1)
    largest = np.maximum(padded[:, :1], np.finfo(float).tiny)
    relative = padded / largest
    rank = (relative > rank_tolerance(rounding)).sum(axis=1)
    each = np.arange(len(s))
    return Decomposition(u, s, vt, rank, relative[each, np.maximum(rank - 1, 0)], relative[each, rank])


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


class System:
    """Arrays of a mechanism; rows are numbered joints first, then loads, then friction.

    Parameters
    ----------
    bodies : sequence of str
        Names of the bodies, without the ground.
    joints, loads : mapping
        Rows of each joint, and row of each load.
    friction : mapping
        Name of the joint and law of each friction.

    Attributes
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
    size, constraints : int
        Number of coordinates 3 n, and of rows of joints.
    kinds : list of (callable, list of ndarray)
        What evaluates the rows of each kind, and the columns that it takes.
    """

    def __init__(
        self,
        bodies: Sequence[str],
        joints: Mapping[str, Sequence[Row]],
        loads: Mapping[str, Row],
        friction: Mapping[str, tuple[str, FrictionLaw]],
    ) -> None:
        self.bodies = {name: k for k, name in enumerate((*bodies, GROUND))}
        self.size, first = 3 * len(bodies), 0
        self.joints: dict[str, slice] = {}
        for name, rows in joints.items():
            self.joints[name] = slice(first, first := first + len(rows))
        self.constraints = first
        self.loads = {name: first + k for k, name in enumerate(loads)}
        self.friction = {name: first + len(loads) + k for k, name in enumerate(friction)}
        laws = [law for _, law in friction.values()]
        table = [*chain(*joints.values()), *loads.values(), *(law.row for law in laws)]
        self._set_scales([(self.bodies[body], complex(*at)) for row in table for body, at in row.ends])
        self.unit = np.array([self.length if row.is_couple else 1.0 for row in table])
        self.constant = np.array([row.constant(self.length) for row in table])
        own = [np.arange(self.joints[joint].start, self.joints[joint].stop) for joint, _ in friction.values()]
        self.pressing = [
            rows[list(law.pressing or range(len(rows)))] for rows, law in zip(own, laws, strict=True)
        ]
        self.coefficient = np.array([law.coefficient for law in laws]) / self.unit[first + len(loads) :]
        entries = defaultdict(list)
        for r, row in enumerate(table):
            entries[type(row)] += [(r, *entry) for entry in row.entries(self.bodies, self._arm)]
        self.kinds = [
            (kind.add, [np.array(column) for column in zip(*rows, strict=True)])
            for kind, rows in entries.items()
        ]

    def _set_scales(self, points: Sequence[tuple[int, complex]]) -> None:
        """Origin, length L, and the centre, radius and rounding of the points (body, place) of each body."""
        self.origin = complex(np.mean([p for _, p in points])) if points else 0j
        self.length = max((abs(p - self.origin) for _, p in points), default=0.0) or 1.0
        self.centre, self.radius = np.zeros(len(self.bodies), complex), np.ones(len(self.bodies))
        for k in range(len(self.bodies) - 1):
            own = np.array([(p - self.origin) / self.length for body, p in points if body == k])
            if own.size:
                self.centre[k] = own.mean()
                spread = np.abs(own - self.centre[k]).max()
                self.radius[k] = spread if spread > _ONE_POINT else 1.0
        far = 1 + abs(self.origin) / self.length
        self.rounding = float(np.finfo(float).eps * far / self.radius.min())

    def _arm(self, body: str, at: Point) -> complex:
        """From the centre of a body to a point of it in the drawing, over L."""
        return (complex(*at) - self.origin) / self.length - self.centre[self.bodies[body]]

    def rows(self, y: np.ndarray) -> Rows:
        """Values and gradients at coordinates y of shape (S, 3 n)."""
        moved = np.zeros((len(self.bodies), 3, len(y)))
        moved[:-1] = y.T.reshape(-1, 3, len(y))
        angle = moved[:, 2] / self.radius[:, None]
        pose = Pose(self.centre[:, None] + moved[:, 0] + 1j * moved[:, 1], angle, np.exp(1j * angle))
        value = np.repeat(self.constant[:, None], len(y), axis=1)
        force = np.zeros((len(value), len(self.bodies), len(y)), complex)
        couple = np.zeros(force.shape)
        for add, columns in self.kinds:
            add(pose, Totals(value, force, couple), *columns)
        parts = np.stack((np.real(force), np.imag(force), couple / self.radius[:, None]), axis=-1)
        gradient = parts[:, :-1].transpose(2, 0, 1, 3).reshape(len(y), len(value), self.size)
        return Rows(value.T, force.transpose(2, 0, 1), couple.transpose(2, 0, 1), gradient)

    def place(self, y: np.ndarray, body: str, at: Point) -> np.ndarray:
        """Where a point of a body is [m], shape (S, 2)."""
        k = self.bodies[body]
        if 3 * k == self.size:  # the ground
            return np.tile(np.array(at, dtype=float), (len(y), 1))
        # The displacement is added to the drawing, so that a point far from (0, 0) keeps its digits.
        shift = y[:, 3 * k] + 1j * y[:, 3 * k + 1]
        moved = (shift + self._arm(body, at) * (np.exp(1j * self.angle(y, body)) - 1)) * self.length
        return np.array(at) + moved.view(float).reshape(-1, 2)

    def angle(self, y: np.ndarray, body: str) -> np.ndarray:
        """Angle of a body [rad], shape (S,)."""
        k = self.bodies[body]
        return y[:, 3 * k + 2] / self.radius[k] if 3 * k < self.size else np.zeros(len(y))


# Sentences that say what is loose, undetermined or out of reach ------------------------------------------


_STILL = 1e-8  # relative motion that counts as rounding


class AssemblyError(ValueError):
    """The joints of a mechanism cannot be brought together.

    Examples
    --------
    >>> issubclass(planar.AssemblyError, ValueError)
    True
    """


class OppositeTravelError(ValueError):
    """A travel that should grow with the driver falls."""


class OutOfReachError(ValueError):
    """A driver does not reach a value: it turns back before it.

    Parameters
    ----------
    reason : str
        Motion that is not reached, and where it ends.
    remedy : str
        Advice.

    Examples
    --------
    >>> issubclass(planar.OutOfReachError, ValueError)
    True
    """

    def __init__(self, reason: str, remedy: str) -> None:
        super().__init__(reason, remedy)
        self.reason, self.remedy = reason, remedy

    def __str__(self) -> str:
        return f"{self.reason}; {self.remedy}"


def names_of_moving(system: System, motions: np.ndarray) -> tuple[str, ...]:
    """Names of the bodies that move in motions of shape (3 n, k)."""
    size = np.linalg.norm(motions.reshape(len(motions) // 3, 3 * motions.shape[1]), axis=1)
    moves = size > _STILL * max(size.max(initial=0.0), 1e-300)
    return tuple(name for name, moving in zip(system.bodies, moves, strict=False) if moving)


def describe(system: System, y: np.ndarray, motions: np.ndarray) -> Words:
    """Describe motions (3 n, k) in words; bodies without relative motion are named together."""
    parts, pose = motions.reshape(len(motions) // 3, 3, motions.shape[1]), y.reshape(-1, 3)
    centre = system.centre[:-1] + pose[:, 0] + 1j * pose[:, 1]
    rate = parts[:, 2] / system.radius[:-1, None]
    # The twist of a body: velocity (complex) of its point at the origin, and angular velocity, (n, 2, k).
    twists = np.stack((parts[:, 0] + 1j * parts[:, 1] - 1j * rate * centre[:, None], rate), axis=1)
    groups: list[tuple[list[str], np.ndarray]] = []
    for name in names_of_moving(system, motions):
        twist = twists[system.bodies[name]]
        same = (names for names, other in groups if np.abs(twist - other).max() < 1e-7 * np.abs(other).max())
        if (names := next(same, None)) is None:
            groups.append(([name], twist))
        else:
            names.append(name)
    each = (Words(f"{join_names(names)} ", _motion(system, len(names), twist)) for names, twist in groups)
    return joined(", ", each)


def _motion(system: System, bodies: int, twist: np.ndarray) -> str:
    """Describe the motions (2, k) of a group of bodies; a single one has a centre or a direction."""
    real = np.stack((twist[0].real, twist[0].imag, twist[1].real))
    left, size, _ = np.linalg.svd(real, full_matrices=False)
    ways = int((size > 1e-7 * size[0]).sum())
    end = "s" if bodies == 1 else " together"
    if ways > 1:
        return f"move{end} in {ways} independent ways"
    vx, vy, rate = left[:, 0]
    if abs(rate) < 1e-7:
        vx, vy = np.array((vx, vy)) * np.sign(vx if abs(vx) > 1e-9 else vy)
        x, y = (round(float(v), 9) + 0.0 for v in (vx, vy))
        return f"slide{end} along ({x:.3g}, {y:.3g})"
    centre = system.origin + system.length * (1j * (vx + 1j * vy) / rate)
    x, y = (0.0 if abs(v) < 1e-9 * system.length else v for v in (centre.real, centre.imag))
    return Words(f"turn{end} about ", amount(x, y))


def check_moves(system: System, driver: str, rates: np.ndarray) -> None:
    """Refuse a driver whose velocity, per unit of the mechanism's motion, cannot be told from zero."""
    margin, least = np.abs(rates).min(), rank_tolerance(system.rounding)
    if margin < least:
        raise ValueError(
            f"driver {driver!r} stands still while the mechanism moves, or is too near a toggle position to "
            f"decide (velocity {margin:.1g} of the mechanism's, at least {least:.1g} is needed): "
            "choose another driver, or draw the mechanism further from that position"
        )


def join_names(names: Iterable[str]) -> str:
    """Names as a list in a sentence."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last
