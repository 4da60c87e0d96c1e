"""Free-body diagrams: all that acts on one body."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np

from brakes.planar.mechanism import Position
from brakes.planar.rows import GROUND, Line, Path, Row, Turn, bodies_of
from brakes.planar.statics import Equilibrium


class Action(NamedTuple):
    """What a joint or load does to a body.

    name : str
        The joint or load; "friction of" it for its friction.
    at : ndarray, shape (2,)
        The point of the force [m]; nan for a couple.
    force : ndarray, shape (2,)
        The force [N]; nan where it is not determined.
    couple : float
        The couple, anticlockwise positive [N m].
    """

    name: str
    at: np.ndarray
    force: np.ndarray
    couple: float


def free_body(equilibrium: Equilibrium, body: str, index: int = 0) -> tuple[Action, ...]:
    """All that acts on a body, or on `GROUND`, at one position of an equilibrium.

    Parameters
    ----------
    equilibrium : Equilibrium
        From `solve` or `solve_with_friction`.
    body : str
        The body.
    index : int
        Which of several positions.

    Returns
    -------
    tuple of Action
        Joints, then loads, then friction; forces and moments of all add up to zero.
    """
    mechanism = equilibrium.position.mechanism
    place = Position(mechanism, equilibrium.position.batch[index])
    size = np.atleast_2d(equilibrium.multiplier)[index]
    system = mechanism.system
    actions = []
    for joint in mechanism.joints:
        parts = zip(joint.rows(), size[system.joints[joint.name]], strict=True)
        actions += _sum(joint.name, [a for row, s in parts for a in _of_row(joint.name, row, s, place, body)])
    for load in mechanism.loads:
        actions += _of_row(load.name, load.row(), size[system.loads[load.name]], place, body)
    for name, row in mechanism.rubbing.items():
        actions += _of_row(f"friction of {name}", row.row, size[system.rubbing[name]], place, body)
    return tuple(actions)


def _sum(name: str, actions: list[Action]) -> list[Action]:
    """The two components of a pin as one force; anything else as it is."""
    if len(actions) != 2 or not np.array_equal(actions[0].at, actions[1].at):
        return actions
    return [Action(name, actions[0].at, actions[0].force + actions[1].force, 0.0)]


def _of_row(name: str, row: Row, size: float, place: Position, body: str) -> Iterator[Action]:
    """What a row of a given size does to a body."""
    if isinstance(row, Path):
        yield from _pulls(name, row, size, place, body)
    elif isinstance(row, Turn):
        share = {row.body: 1.0, row.other: -row.ratio}
        share[GROUND] = share.get(GROUND, 0.0) + row.ratio - 1.0
        if share.get(body):
            yield Action(name, np.full(2, np.nan), np.zeros(2), size * share[body])
    elif body in bodies_of(row):
        yield _push(name, row, size if body == row.body else -size, place)


def _push(name: str, row: Line, size: float, place: Position) -> Action:
    """A force along the normal at the point."""
    angle = place.angle(row.frame)
    (x, y), cos, sin = row.normal, np.cos(angle), np.sin(angle)
    normal = np.array((cos * x - sin * y, sin * x + cos * y))
    return Action(name, place.point(row.body, row.at), size * normal, 0.0)


def _pulls(name: str, row: Path, size: float, place: Position, body: str) -> Iterator[Action]:
    """At each point of the body, the pull towards its neighbours on the path."""
    points = np.array([place.point(b, p) for b, p in zip(row.bodies, row.points, strict=True)])
    span = np.diff(points, axis=0)
    pull = size * span / np.linalg.norm(span, axis=1, keepdims=True)
    force = np.vstack((pull, np.zeros(2))) - np.vstack((np.zeros(2), pull))
    for k, owner in enumerate(row.bodies):
        if owner == body:
            yield Action(name, points[k], force[k], 0.0)
