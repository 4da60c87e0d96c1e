"""Free-body diagrams: all that acts on one body."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import count, kind, one_of
from brakes.planar.mechanism import Position
from brakes.planar.rows import GROUND, Row
from brakes.planar.statics import Equilibrium


class Action(NamedTuple):
    """Force or couple of a joint or load on a body.

    name : str
        The joint or load; "friction of" it for its friction.
    at : ndarray, shape (2,)
        The point of the force [m]; nan for a couple.
    force : ndarray, shape (2,)
        The force [N]; nan where it is not determined.
    couple : float
        The couple, anticlockwise positive [N m].

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
    """The two components of a pin as one force; anything else as it is."""
    if len(actions) != 2 or not np.array_equal(actions[0].at, actions[1].at):
        return actions
    return [Action(name, actions[0].at, actions[0].force + actions[1].force, 0.0)]
