"""What a picture of a mechanism shows: outlines of its bodies, two-force members, outer forces."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from brakes.planar import (
    GROUND,
    Bar,
    Cable,
    CablePair,
    Equilibrium,
    Force,
    Mechanism,
    Pin,
    Position,
    RotationLock,
    Spring,
    free_body,
)


class Member(NamedTuple):
    """A bar or cable: its name, points (k, 2) [m], and force [N], tension positive, nan if not known."""

    name: str
    ends: np.ndarray
    force: float


class Arrow(NamedTuple):
    """A force: name, where it acts (2,) [m], its components (2,) [N], and whether the ground gives it."""

    name: str
    at: np.ndarray
    force: np.ndarray
    reaction: bool


def points_of(mechanism: Mechanism, body: str) -> list[tuple[float, float]]:
    """Points of a body in the drawing at which joints and loads act, without repeats [m]."""
    found = [at for part in mechanism.parts for owner, at in _ends(part) if owner == body]
    return list(dict.fromkeys((float(x), float(y)) for x, y in found))


def _ends(part: object) -> Iterator[tuple[str, tuple[float, float]]]:
    """The bodies and points of a joint or load that has points."""
    if isinstance(part, Pin):
        yield part.body, part.at
        yield part.other, part.at if part.at_other is None else part.at_other
    elif isinstance(part, Cable):
        yield from zip(part.bodies, part.points, strict=True)
    elif isinstance(part, Bar | CablePair | Spring):
        yield part.body, part.at
        yield part.other, part.to
    elif hasattr(part, "at"):
        yield part.body, part.at  # pyright: ignore[reportAttributeAccessIssue]


def outline(position: Position, body: str) -> np.ndarray:
    """Corners of a body where it is now, in turn around their centre, (k, 2) [m]."""
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
    on_it = [part for part in mechanism.parts if body in _bodies(part)]
    return len(on_it) == 2 and all(isinstance(part, Pin) for part in on_it)


def _bodies(part: object) -> tuple[str, ...]:
    if isinstance(part, Cable):
        return tuple(part.bodies)
    return tuple(getattr(part, key) for key in ("body", "other") if hasattr(part, key))


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
    mechanism = position.mechanism
    for joint in mechanism.joints:
        if isinstance(joint, Bar):
            ends = position.point(joint.body, joint.at), position.point(joint.other, joint.to)
            force = np.nan if equilibrium is None else float(np.ravel(equilibrium.magnitudes[joint.name])[0])
            yield Member(joint.name, np.array(ends), force)
    for body in two_force_bodies(mechanism):
        ends = np.array([position.point(body, at) for at in points_of(mechanism, body)])
        yield Member(body, ends, np.nan if equilibrium is None else _axial(equilibrium, body, ends))


def _axial(equilibrium: Equilibrium, body: str, ends: np.ndarray) -> float:
    """Tension of a body that two pins hold."""
    along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
    at_end = [a.force @ along for a in free_body(equilibrium, body) if np.allclose(a.at, ends[1], rtol=1e-9)]
    return float(at_end[0])


def cables(position: Position, equilibrium: Equilibrium | None = None) -> Iterator[Member]:
    """Cables and cable pairs, with their points (k, 2) and tensions."""
    for part in position.mechanism.parts:
        if isinstance(part, Cable | CablePair):
            points = np.array([position.point(body, at) for body, at in _ends(part)])
            sizes = {} if equilibrium is None else equilibrium.magnitudes | equilibrium.amplitudes
            yield Member(part.name, points, float(np.ravel(sizes.get(part.name, np.nan))[0]))


def springs(position: Position) -> Iterator[tuple[str, np.ndarray]]:
    """Names and ends (2, 2) of springs."""
    for part in position.mechanism.loads:
        if isinstance(part, Spring):
            yield part.name, np.array([position.point(body, at) for body, at in _ends(part)])


def pins(position: Position) -> Iterator[tuple[np.ndarray, bool]]:
    """Places of the pins and of the ends of bars, and whether they are on the ground."""
    for joint in position.mechanism.joints:
        if isinstance(joint, Pin):
            yield position.point(joint.body, joint.at), GROUND in (joint.body, joint.other)
        elif isinstance(joint, Bar):
            for body, at in _ends(joint):
                yield position.point(body, at), body == GROUND


def outer_forces(equilibrium: Equilibrium) -> list[Arrow]:
    """Loads on the bodies, and what the ground does to them."""
    mechanism = equilibrium.position.mechanism
    loads = {load.name for load in mechanism.loads}
    outer = {
        part.name
        for part in mechanism.parts
        if isinstance(part, Force) or (GROUND in _bodies(part) and not isinstance(part, RotationLock))
    }
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
