"""A mechanism as arrays over many positions: values and gradients of its rows, ranks, and diagnoses in words.

Vectors are complex numbers.  Lengths are relative to the centre of the mechanism and to one length L of it;
the angle of a body is multiplied by the radius l of its points. So the coordinates y = (x, y, l angle)
of all bodies are of one order, whatever the unit, place and size of the drawing.  The ground is the last
body.

In shapes of arrays, S counts positions, n bodies, R rows, and k motions; matrices in general have m rows and
n columns.
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


RANK_TOLERANCE = 1e-7  # relative singular value that counts as 0: above the error of toggle positions, 1e-8


class Decomposition(NamedTuple):
    """Singular value decompositions u s vt of a batch of matrices, and the rank of each.

    `kept` and `dropped` (S,) are the smallest singular value within the rank and the largest beyond it, over
    the largest of all: a wide gap makes the rank certain.
    """

    u: np.ndarray
    s: np.ndarray
    vt: np.ndarray
    rank: np.ndarray
    kept: np.ndarray
    dropped: np.ndarray

    def null(self, index: int = 0) -> np.ndarray:
        """Return a basis of the null space of one of the matrices, (n, n - rank)."""
        return self.vt[index, self.rank[index] :].T

    def left_null(self, index: int = 0) -> np.ndarray:
        """Return a basis of the left null space of one of the matrices, (m, m - rank)."""
        return self.u[index, :, self.rank[index] :]

    def null_rows(self) -> np.ndarray:
        """Return the matrices vt with all rows outside of the null space set to zero."""
        outside = np.arange(self.vt.shape[1]) < self.rank[:, None]
        return np.where(outside[:, :, None], 0.0, self.vt)

    def solve(self, b: np.ndarray) -> np.ndarray:
        """Compute the least-squares solutions of least norm for right-hand sides b, one for each matrix."""
        k = self.s.shape[1]
        keep = np.arange(k) < self.rank[:, None]
        inverse = np.divide(1.0, self.s, out=np.zeros_like(self.s), where=keep)
        parts = inverse * times(self.u.swapaxes(1, 2)[:, :k], b)
        return times(self.vt[:, :k].swapaxes(1, 2), parts)


def times(a: np.ndarray, x: np.ndarray) -> np.ndarray:
    """Multiply a batch of matrices by one vector each, or all by the same vector."""
    return (a @ x[..., None])[..., 0]


def rank_tolerance(rounding: float) -> float:
    """Return the relative size below which singular values and motions count as zero, given the rounding."""
    return max(RANK_TOLERANCE, 100 * rounding)


def decompose(a: np.ndarray, rounding: float) -> Decomposition:
    """Decompose a batch of matrices whose entries have a relative rounding error, and find their ranks."""
    u, s, vt = np.linalg.svd(a)
    padded = np.concatenate((s, np.zeros((len(s), 1))), axis=1)
    relative = padded / np.maximum(padded[:, :1], np.finfo(float).tiny)
    rank = (relative > rank_tolerance(rounding)).sum(axis=1)
    each = np.arange(len(s))
    return Decomposition(u, s, vt, rank, relative[each, np.maximum(rank - 1, 0)], relative[each, rank])


_ONE_POINT = 1e-6  # radius, over the mechanism's length, up to which the points of a body count as one point


class Rows(NamedTuple):
    """Values and gradients of all rows at S positions.

    value : (S, R), lengths over the mechanism's length L, angles in rad.
    force : (S, R, n + 1) complex, the force on each body for a unit multiplier; the ground is last.
    couple : (S, R, n + 1), the moment about each body's centre for a unit multiplier, over L.
    gradient : (S, R, 3 n), derivatives of the values with respect to y: the same forces, without the
    ground.
    """

    value: np.ndarray
    force: np.ndarray
    couple: np.ndarray
    gradient: np.ndarray


class System:
    """A mechanism as arrays; rows are numbered joints first, then loads, then friction.

    Parameters
    ----------
    bodies : sequence of str
        Names of the bodies, without the ground.
    joints, loads : mapping
        Rows of each joint, and the row of each load.
    friction : mapping
        Joint and friction law by the name of the friction.

    Attributes
    ----------
    bodies : dict
        Index of each body; the ground is last.
    joints : dict
        Indices of the rows of each joint (slice).
    loads, friction : dict
        Index of the row of each load, and of each friction.
    pressing : list of ndarray of int
        Indices of the joint's rows that make up the pressing force of each friction, in the order of
        `friction`.
    coefficient : ndarray
        Friction divided by that pressing force, in the same order.
    length : float
        Length L of the mechanism [m].
    origin : complex
        Centre of the mechanism [m].
    centre, radius : ndarray, shape (n + 1,)
        Centre (complex) of the points of each body, and their greatest distance l from it, over L.
    rounding : float
        Relative rounding error of the coordinates, as they are given; it grows with the distance from (0, 0).
    constant : ndarray, shape (R,)
        Part of each row's value that does not depend on the position.
    unit : ndarray, shape (R,)
        Factor from multiplier to force or couple [N, N m] of each row: L for a couple, 1 for a force.
    size, constraints : int
        Number of coordinates 3 n, and number of rows of joints.
    kinds : list of (callable, list of ndarray)
        Function that evaluates all rows of one kind, with its columns, for each kind.
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
        pairs = zip(own, laws, strict=True)
        self.pressing = [rows[list(law.pressing or range(len(rows)))] for rows, law in pairs]
        self.coefficient = np.array([law.coefficient for law in laws]) / self.unit[first + len(loads) :]
        entries = defaultdict(list)
        for r, row in enumerate(table):
            entries[type(row)] += [(r, *entry) for entry in row.entries(self.bodies, self._arm)]
        self.kinds = [
            (kind.add, [np.array(column) for column in zip(*rows, strict=True)])
            for kind, rows in entries.items()
        ]

    def _set_scales(self, points: Sequence[tuple[int, complex]]) -> None:
        """Set origin, length, rounding, and the bodies' centres and radii, from points (body, position)."""
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
        """Return the vector from a body's centre to its point in the drawing, over the mechanism's length."""
        return (complex(*at) - self.origin) / self.length - self.centre[self.bodies[body]]

    def rows(self, y: np.ndarray) -> Rows:
        """Evaluate all rows, values and gradients, at coordinates y (one row for each position)."""
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
        """Compute the position [m] of a body's point for each row of coordinates y."""
        k = self.bodies[body]
        if 3 * k == self.size:  # index of the ground, which does not move
            return np.tile(np.array(at, dtype=float), (len(y), 1))
        # The displacement is added to the drawn position, so that a point far from (0, 0) keeps its digits.
        shift = y[:, 3 * k] + 1j * y[:, 3 * k + 1]
        moved = (shift + self._arm(body, at) * (np.exp(1j * self.angle(y, body)) - 1)) * self.length
        return np.array(at) + moved.view(float).reshape(-1, 2)

    def angle(self, y: np.ndarray, body: str) -> np.ndarray:
        """Compute the angle of a body [rad], at coordinates y."""
        k = self.bodies[body]
        return y[:, 3 * k + 2] / self.radius[k] if 3 * k < self.size else np.zeros(len(y))


# Messages on loose bodies, undetermined forces and positions out of reach ---------------------------------


_STILL = 1e-8  # size of a body's motion, over the largest of all bodies, that counts as rounding


class AssemblyError(ValueError):
    """The joints of a mechanism cannot be brought together.

    Examples
    --------
    >>> issubclass(planar.AssemblyError, ValueError)
    True
    """


class OppositeTravelError(ValueError):
    """Raised if a travel that should grow with the driver decreases."""


class OutOfReachError(ValueError):
    """Raised if a driver does not reach a value because its motion turns back before that.

    Parameters
    ----------
    reason : str
        The travel that is not reached, and where the motion turns back.
    remedy : str
        Advice to the user.

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
    """Return the names of the bodies that move in given motions (columns)."""
    size = np.linalg.norm(motions.reshape(len(motions) // 3, 3 * motions.shape[1]), axis=1)
    moves = size > _STILL * max(size.max(initial=0.0), 1e-300)
    return tuple(name for name, moving in zip(system.bodies, moves, strict=False) if moving)


def describe(system: System, y: np.ndarray, motions: np.ndarray) -> Words:
    """Describe motions (columns) in words; bodies without relative motion are named together."""
    parts, pose = motions.reshape(len(motions) // 3, 3, motions.shape[1]), y.reshape(-1, 3)
    centre = system.centre[:-1] + pose[:, 0] + 1j * pose[:, 1]
    rate = parts[:, 2] / system.radius[:-1, None]
    # Twist of a body, (n, 2, k): complex velocity of its point at the origin, and angular velocity.
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
    """Describe the motions of bodies in words: a single motion by its centre or direction."""
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
    """Raise a ValueError if a driver's `rates`, relative to the mechanism's, are zero within rounding."""
    margin, least = np.abs(rates).min(), rank_tolerance(system.rounding)
    if margin < least:
        raise ValueError(
            f"driver {driver!r} stands still while the mechanism moves, or is too near a toggle position to "
            f"decide (velocity {margin:.1g} of the mechanism's, at least {least:.1g} is needed): "
            "choose another driver, or draw the mechanism further from that position"
        )


def join_names(names: Iterable[str]) -> str:
    """Join names to a list within a sentence."""
    *most, last = names
    return f"{', '.join(most)} and {last}" if most else last
