"""Free-body diagrams: all forces and couples that act on one body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import count, kind, one_of
from brakes.planar.mechanism import Position
from brakes.planar.rows import GROUND, Row
from brakes.planar.statics import Equilibrium


class Action(NamedTuple):
    """A force or a couple that a joint or load exerts on a body.

    name : str
        Name of the joint or load; "friction of" and the name for its friction.
    at : ndarray, shape (2,)
        Point of application [m]; nan for a couple.
    force : ndarray, shape (2,)
        The force [N]; nan if it is not determined.
    couple : float
        The couple [N m], positive anticlockwise.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> loads = (planar.Force("hand", "lever", (0.3, 0.0), (0, -1), 100.0), planar.Moment("held", "lever"))
    >>> actions = planar.free_body(planar.solve(planar.Mechanism(("lever",), (hinge,), loads)), "lever")
    >>> [action.name for action in actions]
    ['hinge', 'hand', 'held']
    """

    name: str
    at: np.ndarray
    force: np.ndarray
    couple: float


def free_body(equilibrium: Equilibrium, body: str, index: int = 0) -> tuple[Action, ...]:
    """List all forces and couples on a body, or on `GROUND`, at one position of an equilibrium.

    Parameters
    ----------
    equilibrium : Equilibrium
        Result of `solve` or `solve_with_friction`.
    body : str
        The body.
    index : int
        Index of the position, if there are several.

    Returns
    -------
    tuple of Action
        Actions of joints, then of loads, then of friction; all forces and moments add up to zero.

    References
    ----------
    Standard: Newton's third law at each joint.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> loads = (
    ...     planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0),
    ...     planar.Force("work", "lever", at=(0.1, 0.0), direction=(0, 1)),
    ... )
    >>> actions = planar.free_body(planar.solve(planar.Mechanism(("lever",), (hinge,), loads)), "lever")
    >>> sum(action.force for action in actions).round(9)  # N: in balance
    array([0., 0.])
    """
    kind("equilibrium", equilibrium, Equilibrium, "solve(mechanism) gives one")
    mechanism = equilibrium.position.mechanism
    one_of("body", body, (*mechanism.bodies, GROUND))
    index = count("index", index, most=len(equilibrium.position.batch) - 1, least=0)
    place = Position(mechanism, equilibrium.position.batch[index])
    size = np.atleast_2d(equilibrium.multiplier)[index]
    system = mechanism.system

    def act(name: str, row: Row, size: float) -> list[Action]:
        return [Action(name, *effect) for effect in row.effects(size, place, body)]

    actions = []
    for joint in mechanism.joints:
        parts = zip(joint.rows(), size[system.joints[joint.name]], strict=True)
        actions += _sum(joint.name, [action for row, s in parts for action in act(joint.name, row, s)])
    for load in mechanism.loads:
        actions += act(load.name, load.row(), size[system.loads[load.name]])
    for name, (_, law) in mechanism.friction.items():
        actions += act(f"friction of {name}", law.row, size[system.friction[name]])
    return tuple(actions)


def _sum(name: str, actions: list[Action]) -> list[Action]:
    """Add the two components of a pin to one force; leave all else as it is."""
    if len(actions) != 2 or not np.array_equal(actions[0].at, actions[1].at):
        return actions
    return [Action(name, actions[0].at, actions[0].force + actions[1].force, 0.0)]
