"""The curve of positions of a mechanism with one degree of freedom, by pseudo-arclength continuation."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from brakes.planar.system import OutOfReachError, System, decompose

# Newton step at which the iteration ends: by quadratic convergence the next one is below rounding.
_SMALL_STEP = 1e-9
# Last Newton step for nodes, which only guide: requested positions are solved to rounding.
_GUIDING_STEP = 1e-5
_CLOSED = 1e-14  # rounding gap of a closed joint, over the length of the mechanism
_TURN = 0.15  # largest angle between the tangents of neighbouring nodes [rad]
_FIRST, _LARGEST, _LEAST = 0.02, 0.25, 1e-9  # step sizes along the curve, over the length of the mechanism
_NODES = 20_000
_HALVINGS = 12  # bisections of a segment: finer than the distance of its cubic from the curve


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
                raise OutOfReachError(
                    "the curve of positions ends: two joints meet, or motions branch there", "end it before"
                )
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
    """Close the joints of positions (S, 3 n) by moves in the plane normal to each one's tangent (S, 3 n)."""
    return newton(system, y, lambda v, g, moved: (((moved - y) * tangent).sum(axis=1), tangent), last_step)


Equation = Callable[[np.ndarray, np.ndarray, np.ndarray], tuple[np.ndarray, np.ndarray]]


def newton(system: System, y: np.ndarray, equation: Equation, last_step: float = _SMALL_STEP) -> np.ndarray:
    """Solve the joints' constraints and one more equation by Newton's method, for positions (S, 3 n) at once.

    `equation` takes the values (S, loads) and gradients (S, loads, 3 n) of the loads, and y; it returns a
    residual (S,) and its gradient (S, 3 n).  The iteration ends after a step below `last_step`; the remaining
    error is about the square of the last step.
    """
    m, loads = system.constraints, list(system.loads.values())
    for tries in range(20):
        rows = system.rows(y)
        residual, gradient = equation(rows.value[:, loads], rows.gradient[:, loads], y)
        residual = np.concatenate((rows.value[:, :m], residual[:, None]), axis=1)
        if tries > 6 and np.abs(residual).max() < _CLOSED:  # convergence is slow near a branch point
            return y
        slope = np.concatenate((rows.gradient[:, :m], gradient[:, None]), axis=1)
        try:  # where the matrix is singular or not square, the step of least norm is taken
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
        except np.linalg.LinAlgError:  # Newton's method gets no nearer to a branch point
            break
        node = node_at(system, y, a.tangent)
        f = function(node)
        if abs(f) < 1e-15 or abs(high - low) < 1e-15:
            break
        low, f_low = (high, f_high) if f * f_high < 0 else (low, f_low / 2)
        high, f_high = middle, f
    return node


def solve_at_values(system: System, nodes: list[Node], k: int, target: np.ndarray) -> np.ndarray:
    """Find positions (S, 3 n) at which the k-th load's coordinate, growing along the curve, has values."""
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
    """Find the position (3 n,) between two nodes at which a weighted sum of load coordinates has a value."""
    low, high = a.value @ weight, b.value @ weight
    start = a.y + (target - low) / (high - low) * (b.y - a.y)
    return newton(system, start[None], lambda v, g, _: (v @ weight - target, weight @ g))[0]


def solve_at_arc_lengths(system: System, nodes: list[Node], target: np.ndarray) -> np.ndarray:
    """Find coordinates (S, 3 n) at given arc lengths along the curve from the first node."""
    half = np.array([_angle(a, b) / 2 for a, b in pairwise(nodes)])
    # Between the nodes the curve is approximated by circles.
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
