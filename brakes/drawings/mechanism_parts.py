"""Geometry of the pictures of a mechanism: outlines of bodies, members, outer forces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from brakes.planar import GROUND, Equilibrium, Mechanism, Position, Shape, free_body


class Member(NamedTuple):
    """A bar or cable: its name, points (k, 2) [m], and force [N], tension positive, nan if not known."""

    name: str
    ends: np.ndarray
    force: float


class Arrow(NamedTuple):
    """A force: name, where it acts (2,) [m], its components (2,) [N], and whether it is a reaction."""

    name: str
    at: np.ndarray
    force: np.ndarray
    reaction: bool


def points_of(mechanism: Mechanism, body: str) -> list[tuple[float, float]]:
    """Points of a body in the drawing at which joints and loads act, without repeats [m]."""
    ends = [end for part in mechanism.parts for shape in part.shapes() for end in shape.ends]
    return list(dict.fromkeys((float(x), float(y)) for owner, (x, y) in ends if owner == body))


def shapes(position: Position, style: str) -> Iterator[tuple[str, Shape, np.ndarray]]:
    """Shapes of a style: the name of the joint or load, the shape, and its points (k, 2) [m]."""
    for part in position.mechanism.parts:
        for shape in part.shapes():
            if shape.style == style:
                yield part.name, shape, np.array([position.point(*end) for end in shape.ends])


def outline(position: Position, body: str) -> np.ndarray:
    """Corners of the convex hull of a body's points at a position, anticlockwise, (k, 2) [m]."""
    drawn = points_of(position.mechanism, body)
    now = np.array([position.point(body, at) for at in drawn]).reshape(-1, 2)
    return now if len(now) < 3 else _hull(now)


def _hull(points: np.ndarray) -> np.ndarray:
    """The convex hull, or the points themselves where they lie on a line."""
    from scipy.spatial import ConvexHull, QhullError

    try:
        return points[ConvexHull(points).vertices]
    except QhullError:
        return points[np.lexsort(points.T)]


def two_force_bodies(mechanism: Mechanism) -> tuple[str, ...]:
    """Bodies on which two pins act and nothing else."""
    return tuple(body for body in mechanism.bodies if _is_two_force(mechanism, body))


def _is_two_force(mechanism: Mechanism, body: str) -> bool:
    joints = [joint for joint in mechanism.joints if body in joint.acts_on]
    loaded = any(body in load.acts_on for load in mechanism.loads)
    return len(joints) == 2 and all(joint.is_hinge for joint in joints) and not loaded


def label_place(position: Position, body: str) -> np.ndarray:
    """A place within a body for its name, away from the other bodies (2,) [m]."""
    mine = outline(position, body)
    others = [outline(position, other) for other in position.mechanism.bodies if other != body]
    centre = mine.mean(axis=0)
    if not others:
        return centre
    middles = np.array([corners.mean(axis=0) for corners in others])
    far = np.linalg.norm(mine[:, None] - middles, axis=2).min(axis=1).argmax()
    return 0.6 * centre + 0.4 * mine[far]


def members(position: Position, equilibrium: Equilibrium | None = None) -> Iterator[Member]:
    """Bars and bodies with two pins."""
    yield from _members("bar", position, equilibrium)
    for body in two_force_bodies(position.mechanism):
        ends = np.array([position.point(body, at) for at in points_of(position.mechanism, body)])
        yield Member(body, ends, np.nan if equilibrium is None else _axial(equilibrium, body, ends))


def cables(position: Position, equilibrium: Equilibrium | None = None) -> Iterator[Member]:
    """Cables and cable pairs."""
    return _members("cable", position, equilibrium)


def _members(style: str, position: Position, equilibrium: Equilibrium | None) -> Iterator[Member]:
    """Joints and loads drawn in a style, with the size of their force."""
    sizes = {} if equilibrium is None else equilibrium.magnitudes | equilibrium.amplitudes
    for name, _, points in shapes(position, style):
        yield Member(name, points, float(np.ravel(sizes.get(name, np.nan))[0]))


def _axial(equilibrium: Equilibrium, body: str, ends: np.ndarray) -> float:
    """Tension of a body that two pins hold."""
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    at_end = [a.force @ along for a in free_body(equilibrium, body) if np.allclose(a.at, ends[1], rtol=1e-9)]
    return float(at_end[0])


def outer_forces(equilibrium: Equilibrium) -> list[Arrow]:
    """Forces on the mechanism from outside: loads, and reactions of the ground."""
    mechanism = equilibrium.position.mechanism
    loads = {load.name for load in mechanism.loads}
    outer = {part.name for part in mechanism.parts if GROUND in part.acts_on}
    return [
        Arrow(action.name, action.at, action.force, action.name not in loads)
        for body in mechanism.bodies
        for action in free_body(equilibrium, body)
        if action.name in outer and np.isfinite(action.at).all()
    ]


def extent(*positions: Position) -> tuple[np.ndarray, np.ndarray]:
    """Least and greatest coordinates (2,) of all points at some positions [m]."""
    points = np.concatenate(
        [
            np.asarray(position.point(body, at)).reshape(-1, 2)
            for position in positions
            for body in (*position.mechanism.bodies, GROUND)
            for at in points_of(position.mechanism, body)
        ]
    )
    return points.min(axis=0), points.max(axis=0)
