"""A planar mechanism, made of bodies, joints and loads, and the positions of its bodies.

The curve of positions of a mechanism with one degree of freedom is found by pseudo-arclength continuation.

In shapes of arrays, S counts positions and n bodies, which have 3 coordinates each.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import kind, set_fields, several
from brakes.planar.part import Joint, Load, Part, Shape
from brakes.planar.rows import GROUND, FrictionLaw, Point, suggest
from brakes.planar.system import OutOfReachError, System, decompose


@dataclass(frozen=True)
class Mechanism:
    """Rigid bodies in a plane, with joints and loads.

    All points are given in one drawing of the mechanism [m]: x to the right, y up, angles anticlockwise.

    Parameters
    ----------
    bodies : tuple of str
        Names of the bodies; `GROUND` always exists and is not listed.
    joints : tuple of Joint
        The joints, such as a `Pin`; `JOINTS` lists all kinds.
    loads : tuple of Load
        The loads, such as a `Force`; `LOADS` lists all kinds.

    Raises
    ------
    ValueError
        If a name is used twice, or a joint or load is on a body that does not exist, or on nothing.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> loads = (
    ...     planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0),
    ...     planar.Force("work", "lever", at=(0.1, 0.0), direction=(0, 1)),
    ... )
    >>> found = planar.solve(planar.Mechanism(("lever",), (hinge,), loads))
    >>> round(float(found.amplitudes["work"]), 6)  # N: 100 * 0.3 / 0.1
    300.0
    """

    bodies: tuple[str, ...]
    joints: tuple[Joint, ...] = ()
    loads: tuple[Load, ...] = ()

    def __post_init__(self) -> None:
        if isinstance(self.bodies, str):
            raise ValueError(f"bodies = {self.bodies!r}: give a sequence of names, ({self.bodies!r},)")
        for key, wanted in {"bodies": str, "joints": Joint, "loads": Load}.items():
            set_fields(self, **{key: several(key, getattr(self, key), wanted)})
        if not self.bodies or GROUND in self.bodies:
            raise ValueError(f"bodies = {self.bodies!r}: name one or more; {GROUND!r} always exists")
        for what, names in (("body", self.bodies), ("joint or load", [part.name for part in self.parts])):
            if twice := [name for name, times in Counter(names).items() if times > 1]:
                raise ValueError(f"{what} {twice[0]!r} occurs twice: give each its own name")
        for part in self.parts:
            if unknown := [name for name in part.acts_on if name not in (*self.bodies, GROUND)]:
                remedy = suggest(unknown[0], (*self.bodies, GROUND))
                raise ValueError(f"{part.title} is on body {unknown[0]!r}, which does not exist; {remedy}")
            if len(set(part.acts_on)) == 1:
                alone = f"{part.title} acts on {part.acts_on[0]!r} alone"
                raise ValueError(f"{alone}: name two different bodies, one of them movable")

    @property
    def parts(self) -> tuple[Part, ...]:
        """All joints, then all loads."""
        return (*self.joints, *self.loads)

    @property
    def unknown_loads(self) -> list[Load]:
        """Loads without a given magnitude, which equilibrium determines."""
        return [load for load in self.loads if load.amplitude(np.zeros(1)) is None]

    @cached_property
    def friction(self) -> dict[str, tuple[str, FrictionLaw]]:
        """Joint and friction law, by the joint's name, with the label of the law if there are several."""
        laws = ((joint.name, law) for joint in self.joints for law in joint.friction_laws())
        return {f"{name} {law.label}".strip(): (name, law) for name, law in laws if law.coefficient}

    @cached_property
    def system(self) -> System:
        """Constraints of all joints, and coordinates of all loads, as arrays."""
        joints = {joint.name: joint.rows() for joint in self.joints}
        return System(self.bodies, joints, {load.name: load.row() for load in self.loads}, self.friction)

    @cached_property
    def shapes(self) -> tuple[tuple[str, Shape], ...]:
        """Name and shape of each drawn part of joints and loads."""
        return tuple((part.name, shape) for part in self.parts for shape in part.shapes())

    @cached_property
    def points(self) -> dict[str, list[Point]]:
        """Points of each body and of the ground at which joints and loads act, without repetition [m]."""
        found: dict[str, list[Point]] = {body: [] for body in (*self.bodies, GROUND)}
        for owner, (x, y) in dict.fromkeys(end for _, shape in self.shapes for end in shape.ends):
            found[owner].append((float(x), float(y)))
        return found

    @cached_property
    def drawing(self) -> Position:
        """Position of the bodies in the drawing, whether or not the joints are closed in it."""
        return Position(self, np.zeros(self.system.size))

    def load(self, name: str) -> Load:
        """Return the load with a name; raise a ValueError that suggests a known name if there is none."""
        kind("load", name, str)
        known = {load.name: load for load in self.loads}
        if name not in known:
            raise ValueError(f"load {name!r} does not exist; {suggest(name, known)}")
        return known[name]


def check_mechanism(mechanism: object, position: object = None) -> None:
    """Check that arguments of an analysis are a mechanism and, if given, a position."""
    kind("mechanism", mechanism, Mechanism)
    kind("position", position, Position | None, "assemble(mechanism) gives one")


@dataclass(frozen=True)
class Position:
    """Positions of a mechanism's bodies at one instant, or at S instants.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism.
    coordinates : ndarray, shape (3 n,) or (S, 3 n)
        Displacements of the n bodies from the drawing, nondimensional: x and y divided by the mechanism's
        length, and the angle times the greatest distance of the body's points from their centre, over that
        length.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> place = planar.assemble(planar.Mechanism(("lever",), (hinge,)))
    >>> place.point("lever", (0.3, 0.0)).round(9)
    array([0.3, 0. ])
    """

    mechanism: Mechanism
    coordinates: np.ndarray

    @property
    def batch(self) -> np.ndarray:
        """Coordinates in one row for each instant, 3 for each body."""
        return np.atleast_2d(self.coordinates)

    def __getitem__(self, index: int | slice) -> Position:
        return Position(self.mechanism, self.batch[index])

    def of(self, mechanism: Mechanism) -> Position:
        """Return the same position for another mechanism with the same bodies and drawing."""
        if mechanism is self.mechanism:
            return self
        if mechanism.bodies != self.mechanism.bodies:
            raise ValueError(
                f"the position is one of bodies {self.mechanism.bodies}, not of {mechanism.bodies}"
            )
        new, old, y = mechanism.system, self.mechanism.system, self.batch
        parts = []
        for body, centre, radius in zip(mechanism.bodies, new.centre, new.radius, strict=False):
            drawn = new.origin + new.length * centre
            moved = old.place(y, body, (drawn.real, drawn.imag)) - (drawn.real, drawn.imag)
            parts += [*(moved.T / new.length), old.angle(y, body) * radius]
        return Position(mechanism, np.stack(parts, axis=-1).reshape(self.coordinates.shape))

    def point(self, body: str, at: Point) -> np.ndarray:
        """Position [m] of a body's point given by its position in the drawing; one row for each instant."""
        return self.mechanism.system.place(self.batch, body, at).reshape(*self.coordinates.shape[:-1], 2)

    def angle(self, body: str) -> np.ndarray:
        """Return the angle by which a body has turned from the drawing [rad], at each instant."""
        return self.mechanism.system.angle(self.batch, body).reshape(self.coordinates.shape[:-1])


# The curve of positions ------------------------------------------------------------------------------

# Newton step below which the iteration ends: with quadratic convergence the next step is below rounding.
_SMALL_STEP = 1e-9
# Newton step below which the iteration for nodes ends; requested positions are solved to rounding.
_GUIDING_STEP = 1e-5
_CLOSED = 1e-14  # gap of a closed joint due to rounding, over the length of the mechanism
_TURN = 0.15  # largest angle between the tangents of neighbouring nodes [rad]
_FIRST, _LARGEST, _LEAST = 0.02, 0.25, 1e-9  # steps along the curve, over the mechanism's length
_NODES = 20_000
_HALVINGS = 12  # bisections of a segment; more would not help, as its cubic is only near the curve


class Node(NamedTuple):
    """A point on the curve of positions, for n bodies.

    y, tangent : (3 n,), coordinates of the bodies, and unit tangent of the curve.
    value, rate : (loads,), coordinates of the loads, and their derivatives with respect to arc length.
    regularity : smallest over largest singular value of constraints and tangent, with the sign of their
        determinant: 0 at a branch point (and 1 if the matrix is not square).
    """

    y: np.ndarray
    tangent: np.ndarray
    value: np.ndarray
    rate: np.ndarray
    regularity: float

    def reversed(self) -> Node:
        """Return the node with the curve traversed in the opposite direction."""
        return Node(self.y, -self.tangent, self.value, -self.rate, -self.regularity)


def node_at(system: System, y: np.ndarray, before: np.ndarray) -> Node:
    """Make the node at coordinates y; its tangent is the constraints' null vector, oriented by `before`."""
    rows = system.rows(y[None])
    joints, loads = rows.gradient[0, : system.constraints], list(system.loads.values())
    tangent = np.linalg.svd(joints)[2][-1]
    tangent = tangent if tangent @ before > 0 else -tangent
    matrix, regularity = np.vstack((joints, tangent)), 1.0
    if matrix.shape[0] == matrix.shape[1]:
        size = np.linalg.svd(matrix, compute_uv=False)
        regularity = float(np.linalg.slogdet(matrix).sign * size[-1] / size[0])
    return Node(y, tangent, rows.value[0, loads], rows.gradient[0, loads] @ tangent, regularity)


def follow(system: System, node: Node) -> Iterator[Node]:
    """Follow the curve by pseudo-arclength (tangent predictor, Newton, step halving), and yield its nodes."""
    step = _FIRST
    for _ in range(_NODES):
        while (following := _advance(system, node, step)) is None:
            step /= 2
            if step < _LEAST:
                ends = "the curve of positions ends: two joints meet, or motions branch there"
                raise OutOfReachError(ends, "end it before")
        yield following
        step = min(_LARGEST, step * min(2.0, 0.7 * _TURN / max(_angle(node, following), 1e-3)))
        node = following


def _angle(a: Node, b: Node) -> float:
    """Compute the angle between the tangents of two nodes [rad]."""
    return float(np.arccos(min(1.0, a.tangent @ b.tangent)))


def _advance(system: System, node: Node, step: float) -> Node | None:
    """Find the node one step along the tangent; None if the step is too long."""
    ahead = node.y + step * node.tangent
    try:
        y = close_joints(system, ahead[None], node.tangent[None], _GUIDING_STEP)[0]
    except np.linalg.LinAlgError:
        return None
    following = node_at(system, y, node.tangent)
    near = np.linalg.norm(y - ahead) < step * _TURN and _angle(node, following) < _TURN
    return following if near else None


def close_joints(
    system: System, y: np.ndarray, tangent: np.ndarray, last_step: float = _SMALL_STEP
) -> np.ndarray:
    """Close the joints of positions (rows of y) by motions normal to the tangent at each position."""
    return newton(system, y, lambda v, g, moved: (((moved - y) * tangent).sum(axis=1), tangent), last_step)


Equation = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def newton(system: System, y: np.ndarray, equation: Equation, last_step: float = _SMALL_STEP) -> np.ndarray:
    """Solve the joints' constraints and one more equation by Newton's method, for many positions at once.

    Coordinates y have a row for each position.  `equation` takes the values (positions, loads) and gradients
    (positions, loads, coordinates) of the loads, and y; it returns a residual of each position and its
    gradient.  The iteration ends after a step below `last_step`; the remaining error is about the square of
    the last step.
    """
    m, loads = system.constraints, list(system.loads.values())
    for tries in range(20):
        rows = system.rows(y)
        residual, gradient = equation(rows.value[:, loads], rows.gradient[:, loads], y)
        residual = np.concatenate((rows.value[:, :m], residual[:, None]), axis=1)
        if tries > 6 and np.abs(residual).max() < _CLOSED:  # convergence is slow near a branch point
            return y
        slope = np.concatenate((rows.gradient[:, :m], gradient[:, None]), axis=1)
        try:  # if the matrix is singular or not square, the least-squares step of least norm is used
            step = np.linalg.solve(slope, residual[..., None])[..., 0]
        except np.linalg.LinAlgError:
            step = decompose(slope, system.rounding).solve(residual)
        y = y - step
        size = np.abs(step).max()
        if size < last_step:
            return y
        if not size < 10.0:
            break
    raise np.linalg.LinAlgError("Newton's method does not converge")


def find_zero(system: System, a: Node, b: Node, function: Callable[[Node], float]) -> Node:
    """Find the root of a function between two nodes at which its signs differ (regula falsi, Illinois)."""
    low, high = 0.0, float((b.y - a.y) @ a.tangent)
    f_low, f_high, node = function(a), function(b), b
    for _ in range(60):
        middle = (low * f_high - high * f_low) / (f_high - f_low)
        try:
            y = close_joints(system, (a.y + middle * a.tangent)[None], a.tangent[None])[0]
        except np.linalg.LinAlgError:  # Newton's method fails near a branch point
            break
        node = node_at(system, y, a.tangent)
        f = function(node)
        if abs(f) < 1e-15 or abs(high - low) < 1e-15:
            break
        low, f_low = (high, f_high) if f * f_high < 0 else (low, f_low / 2)
        high, f_high = middle, f
    return node


def solve_at_values(system: System, nodes: list[Node], k: int, target: np.ndarray) -> np.ndarray:
    """Find positions (rows of coordinates) at which the k-th load's growing coordinate has target values."""
    if len(nodes) == 1:
        return np.tile(nodes[0].y, (len(target), 1))
    value, slope = (np.array([getattr(node, key)[k] for node in nodes]) for key in ("value", "rate"))
    segment = np.clip(np.searchsorted(value, target, side="right") - 1, 0, len(nodes) - 2)
    chord = _chords(nodes)[segment]
    ends = value[segment], value[segment + 1], slope[segment] * chord, slope[segment + 1] * chord
    low, high = np.zeros(len(target)), np.ones(len(target))
    for _ in range(_HALVINGS):
        middle = (low + high) / 2
        below = _cubic(middle, *ends) < target
        low, high = np.where(below, middle, low), np.where(below, high, middle)
    start, _ = _between(nodes, segment, low)
    return newton(system, start, lambda v, g, _: (v[:, k] - target, g[:, k]))


def solve_at_sum(system: System, a: Node, b: Node, weight: np.ndarray, target: float) -> np.ndarray:
    """Find the position between two nodes at which a weighted sum of load coordinates has a value."""
    low, high = a.value @ weight, b.value @ weight
    start = a.y + (target - low) / (high - low) * (b.y - a.y)
    return newton(system, start[None], lambda v, g, _: (v @ weight - target, weight @ g))[0]


def solve_at_arc_lengths(system: System, nodes: list[Node], target: np.ndarray) -> np.ndarray:
    """Find coordinates (one row each) at given arc lengths along the curve from the first node."""
    half = np.array([_angle(a, b) / 2 for a, b in pairwise(nodes)])
    # Between the nodes the curve is approximated by circular arcs.
    arc = np.append(0.0, np.cumsum(_chords(nodes) / np.sinc(half / np.pi)))
    segment = np.clip(np.searchsorted(arc, target, side="right") - 1, 0, len(nodes) - 2)
    return close_joints(system, *_between(nodes, segment, (target - arc[segment]) / np.diff(arc)[segment]))


def _chords(nodes: list[Node]) -> np.ndarray:
    """Compute the distances between neighbouring nodes, which are the chords of the curve."""
    return np.linalg.norm(np.diff([node.y for node in nodes], axis=0), axis=1)


def _between(nodes: list[Node], segment: np.ndarray, part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Interpolate coordinates (cubic) and tangents (linear) at fractions of the segments between nodes."""
    y, tangent = np.array([node.y for node in nodes]), np.array([node.tangent for node in nodes])
    chord, x = _chords(nodes)[segment, None], part[:, None]
    ends = y[segment], y[segment + 1], tangent[segment] * chord, tangent[segment + 1] * chord
    along = (1 - x) * tangent[segment] + x * tangent[segment + 1]
    return _cubic(x, *ends), along / np.linalg.norm(along, axis=1, keepdims=True)


def _cubic(
    x: np.ndarray, a: np.ndarray, b: np.ndarray, slope_a: np.ndarray, slope_b: np.ndarray
) -> np.ndarray:
    """Evaluate the cubic on 0 <= x <= 1 with given values and slopes at its ends."""
    bend, twist = 3 * (b - a) - 2 * slope_a - slope_b, 2 * (a - b) + slope_a + slope_b
    return a + x * (slope_a + x * (bend + x * twist))
