"""Geometry for drawings of a mechanism: outlines of bodies, members, external forces."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import NamedTuple

import numpy as np

from brakes.planar import GROUND, Equilibrium, Mechanism, Position, Shape, free_body

_FLAT = 1e-12  # triangle area over squared extent of all points, below which three points count as collinear


class Member(NamedTuple):
    """A bar or cable: name, points (rows of x, y) [m], and force [N], positive in tension, nan if unknown."""

    name: str
    ends: np.ndarray
    force: float


class OuterForce(NamedTuple):
    """External force: name, point (2,) [m], components (2,) [N], and two flags.

    `reaction` tells whether the ground exerts the force, `along_bar` whether it acts along a bar.
    """

    name: str
    at: np.ndarray
    force: np.ndarray
    reaction: bool
    along_bar: bool = False


def shapes(position: Position, style: str) -> Iterator[tuple[str, Shape, np.ndarray]]:
    """Yield the drawn shapes of one style: name of joint or load, shape, and points (rows of x, y) [m]."""
    for name, shape in position.mechanism.shapes:
        if shape.style == style:
            yield name, shape, np.array([position.point(*end) for end in shape.ends])


def outline(position: Position, body: str) -> np.ndarray:
    """Return corners (rows) of the convex hull of a body's points at a position, anticlockwise [m]."""
    drawn = position.mechanism.points[body]
    now = np.array([position.point(body, at) for at in drawn]).reshape(-1, 2)
    return now if len(now) < 3 else _hull(now)


def _hull(points: np.ndarray) -> np.ndarray:
    """Find the convex hull of points (rows of x, y), or return the sorted points if they are in line.

    The method is Andrew's monotone chain (Inf. Process. Lett. 9, 1979). It is written out here so that a
    drawing of a few points does not wait for a geometry library to be loaded.
    """
    ordered = points[np.lexsort(points.T)]
    flat = _FLAT * float(np.ptp(points, axis=0).max()) ** 2
    corners = [*_chain(ordered, flat), *_chain(ordered[::-1], flat)]
    return np.array(corners) if len(corners) > 2 else ordered


def _chain(points: np.ndarray, flat: float) -> list[np.ndarray]:
    """Find the corners of one side of the hull of sorted points, without the last corner."""
    kept: list[np.ndarray] = []
    for point in points:
        while len(kept) > 1:
            (x, y), (u, v) = kept[-1] - kept[-2], point - kept[-2]
            if x * v - y * u > flat:  # twice the area of the triangle, positive anticlockwise
                break
            kept.pop()
        kept.append(point)
    return kept[:-1]


def two_force_bodies(mechanism: Mechanism) -> tuple[str, ...]:
    """Return the bodies on which two pins act, at different points, and nothing else."""
    found = []
    for body in mechanism.bodies:
        joints = [joint for joint in mechanism.joints if body in joint.acts_on]
        loaded = any(body in load.acts_on for load in mechanism.loads)
        straight = len(joints) == len(mechanism.points[body]) == 2
        if straight and all(joint.is_hinge for joint in joints) and not loaded:
            found.append(body)
    return tuple(found)


def label_place(outlines: Mapping[str, np.ndarray], body: str) -> np.ndarray:
    """Find a position (2,) [m] for a body's name, near the corner farthest from the other bodies' centres.

    The position is within the body if the outline is convex.
    """
    mine = outlines[body]
    others = [corners for other, corners in outlines.items() if other != body and len(corners)]
    centre = mine.mean(axis=0)
    if not others:
        return centre
    middles = np.array([corners.mean(axis=0) for corners in others])
    far = np.linalg.norm(mine[:, None] - middles, axis=2).min(axis=1).argmax()
    return 0.6 * centre + 0.4 * mine[far]


def members(position: Position, equilibrium: Equilibrium | None = None) -> Iterator[Member]:
    """Yield the bars and the bodies with only two pins, with their forces if `equilibrium` is given."""
    yield from _members("bar", position, equilibrium)
    for body in two_force_bodies(position.mechanism):
        ends = np.array([position.point(body, at) for at in position.mechanism.points[body]])
        force = np.nan
        if equilibrium is not None:
            along = (ends[1] - ends[0]) / np.linalg.norm(ends[1] - ends[0])
            acting = (a for a in free_body(equilibrium, body) if np.allclose(a.at, ends[1], rtol=1e-9))
            force = float(next(acting).force @ along)
        yield Member(body, ends, force)


def cables(position: Position, equilibrium: Equilibrium | None = None) -> Iterator[Member]:
    """Yield the cables and cable pairs, with their tensions if `equilibrium` is given."""
    return _members("cable", position, equilibrium)


def _members(style: str, position: Position, equilibrium: Equilibrium | None) -> Iterator[Member]:
    """Yield the joints and loads drawn in a style, such as "bar", with the sizes of their forces."""
    sizes = {} if equilibrium is None else equilibrium.magnitudes | equilibrium.amplitudes
    for name, _, points in shapes(position, style):
        yield Member(name, points, float(np.ravel(sizes.get(name, np.nan))[0]))


def outer_forces(equilibrium: Equilibrium) -> list[OuterForce]:
    """List the external forces on a mechanism: loads, and reactions and friction of the ground.

    The reaction on a bar is drawn at its end on the ground, where the arrow does not hide the bar.
    """
    mechanism = equilibrium.position.mechanism
    on_ground = {
        name: points[k]
        for name, shape, points in shapes(equilibrium.position, "bar")
        for k, (body, _) in enumerate(shape.ends)
        if body == GROUND
    }
    loads = {load.name for load in mechanism.loads}
    outer = {part.name for part in mechanism.parts if GROUND in part.acts_on}
    outer |= {f"friction of {name}" for name in outer & {*mechanism.friction}}
    return [
        OuterForce(name, on_ground.get(name, action.at), action.force, name not in loads, name in on_ground)
        for body in mechanism.bodies
        for action in free_body(equilibrium, body)
        if (name := action.name) in outer and np.isfinite(action.at).all()
    ]


def extent(*positions: Position) -> tuple[np.ndarray, np.ndarray]:
    """Find the least and the greatest coordinates (2,) [m] of all points at some positions."""
    points = [
        np.asarray(position.point(body, at)).reshape(-1, 2)
        for position in positions
        for body, drawn in position.mechanism.points.items()
        for at in drawn
    ]
    if not points:
        return np.zeros(2), np.zeros(2)
    every = np.concatenate(points)
    return every.min(axis=0), every.max(axis=0)
