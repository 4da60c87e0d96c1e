"""A mechanism as arrays over many positions: values and gradients of its rows, ranks, diagnoses.

Vectors are complex numbers.  Lengths are divided by one length L of the mechanism and taken from its centre;
the angle of a body is multiplied by the radius l of its points, so that the coordinates y = (x, y, l angle)
of all bodies are of one size, whatever the unit, place and size of the drawing.  The ground is the last body.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from itertools import chain
from typing import Any, NamedTuple

import numpy as np

from brakes.planar.rows import GROUND, Arm, Arrays, FrictionLaw, Point, Pose, Row, Totals

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
        What is not reached, and where it ends.
    remedy : str
        What to do.

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


def moving_bodies(motions: np.ndarray) -> np.ndarray:
    """Which bodies move in motions of shape (3 n, k): shape (n,)."""
    size = np.linalg.norm(motions.reshape(len(motions) // 3, 3, motions.shape[1]), axis=(1, 2))
    return size > _STILL * max(size.max(initial=0.0), 1e-300)


def names_of_moving(system: System, motions: np.ndarray) -> tuple[str, ...]:
    """Names of the bodies that move in motions of shape (3 n, k)."""
    return tuple(name for name, moves in zip(system.bodies, moving_bodies(motions), strict=False) if moves)


def describe(system: System, y: np.ndarray, motions: np.ndarray) -> str:
    """Describe motions (3 n, k) in words; bodies without relative motion are named together."""
    twists = _twists(system, y, motions)
    groups: list[tuple[list[str], np.ndarray]] = []
    for name, twist, moves in zip(system.bodies, twists, moving_bodies(motions), strict=False):
        if moves:
            _join(groups, name, twist)
    return ", ".join(f"{join_names(names)} {_motion(system, names, twist)}" for names, twist in groups)


def explain_mobility(system: System, y: np.ndarray, free: np.ndarray) -> str:
    """Explain why a mechanism with free motions (3 n, k), k other than 1, has no stroke."""
    k = free.shape[1]
    if not k:
        return "the mechanism does not move: mobility 0; a stroke needs 1: remove a joint"
    return (
        f"the mechanism has mobility {k}; a stroke needs 1: {describe(system, y, free)}; "
        f"add {k - 1} joint{'s' if k > 2 else ''} (a rotation lock, a bar, a contact)"
    )


def describe_loose(system: System, y: np.ndarray, motions: np.ndarray) -> str:
    """Describe what is loose, and the remedy."""
    return f"{describe(system, y, motions)}; add a joint, or give a load that moves it an unknown amplitude"


def describe_near_toggle(system: System, y: np.ndarray, motions: np.ndarray, margin: float) -> str:
    """Say that rounding decides what holds a mechanism, by which margin, and the remedy."""
    return (
        "too near a toggle position to decide whether the loads are in balance: "
        f"{describe(system, y, motions)} there, which only forces beyond all bounds could stop "
        f"(smallest singular value {margin:.1g}, at least {rank_tolerance(system.rounding):.1g} is needed); "
        "draw it further from that position, or give a load that moves it an unknown amplitude"
    )


def check_moves(system: System, driver: str, rates: np.ndarray) -> None:
    """Refuse a driver whose velocity, per unit of the mechanism's motion, cannot be told from zero."""
    margin, least = np.abs(rates).min(), rank_tolerance(system.rounding)
    if margin < least:
        raise ValueError(
            f"driver {driver!r} stands still while the mechanism moves, or is too near a toggle position to "
            f"decide (velocity {margin:.1g} of the mechanism's, at least {least:.1g} is needed): "
            "choose another driver, or draw the mechanism further from that position"
        )


def describe_self_stress(names: tuple[str, ...]) -> str:
    """Say what equilibrium does not determine, and the remedy."""
    return (
        f"statically indeterminate: equilibrium alone does not give {join_names(names)}; "
        "remove a joint among them, or give a load of unknown amplitude its magnitude"
    )


def join_names(names: Iterable[str]) -> str:
    """Names as a list in a sentence."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last


def _twists(system: System, y: np.ndarray, motions: np.ndarray) -> np.ndarray:
    """Twist of each body: velocity (complex) of its point at the origin, and angular velocity, (n, 2, k)."""
    parts = motions.reshape(len(motions) // 3, 3, motions.shape[1])
    pose = y.reshape(-1, 3)
    centre = system.centre[:-1] + pose[:, 0] + 1j * pose[:, 1]
    rate = parts[:, 2] / system.radius[:-1, None]
    return np.stack((parts[:, 0] + 1j * parts[:, 1] - 1j * rate * centre[:, None], rate), axis=1)


def _join(groups: list[tuple[list[str], np.ndarray]], name: str, twist: np.ndarray) -> None:
    """Add a body to the group that has its twist, or to a new one."""
    for names, other in groups:
        if np.abs(twist - other).max() < 1e-7 * np.abs(other).max():
            names.append(name)
            return
    groups.append(([name], twist))


def _motion(system: System, names: list[str], twist: np.ndarray) -> str:
    """Describe the motions (2, k) of a group; a single one has a centre or a direction."""
    real = np.stack((twist[0].real, twist[0].imag, twist[1].real))
    left, size, _ = np.linalg.svd(real, full_matrices=False)
    ways = int((size > 1e-7 * size[0]).sum())
    one, together = len(names) == 1, "" if len(names) == 1 else " together"
    if ways > 1:
        return f"{'moves' if one else 'move'}{together} in {ways} independent ways"
    vx, vy, rate = left[:, 0]
    if abs(rate) < 1e-7:
        vx, vy = np.array((vx, vy)) * np.sign(vx if abs(vx) > 1e-9 else vy)
        x, y = (round(float(v), 9) + 0.0 for v in (vx, vy))
        return f"{'slides' if one else 'slide'}{together} along ({x:.3g}, {y:.3g})"
    centre = system.origin + system.length * (1j * (vx + 1j * vy) / rate)
    x, y = (0.0 if abs(v) < 1e-9 * system.length else v for v in (centre.real, centre.imag))
    return f"{'turns' if one else 'turn'}{together} about ({x:.6g}, {y:.6g}) m"
