"""Positions of a mechanism: assembly, strokes, velocity ratios and toggle positions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from beamdyn.common.inputs.checks import count, positive, real_array
from beamdyn.common.words import Named, Words, amount
from brakes.planar.mechanism import (
    Mechanism,
    Node,
    Position,
    check_mechanism,
    find_zero,
    follow,
    node_at,
    solve_at_arc_lengths,
    solve_at_sum,
    solve_at_values,
)
from brakes.planar.system import (
    AssemblyError,
    OppositeTravelError,
    OutOfReachError,
    System,
    check_moves,
    decompose,
    describe,
    join_names,
    names_of_moving,
    rank_tolerance,
    times,
)

# Largest number of positions of a stroke: they take some seconds for the smallest mechanisms.
MOST_POSITIONS = 100_000
_CLOSED = 1e-11  # largest gap of a closed joint, over the length of the mechanism


@dataclass(frozen=True)
class Toggle:
    """A position at which the motion of a load's coordinate reverses, or at which motions branch.

    Parameters
    ----------
    load : str or None
        The load whose coordinate has an extreme value: there its force does no work, so that no other load is
        needed to balance it, however large it is.  None at a branch point, where the mechanism may change to
        another motion (as with bars in line).
    value : float
        Value of the driver's coordinate at the toggle position [m or rad].
    position : Position
        Position of the bodies.
    still : tuple of str
        Bodies with zero velocity at this position while others move.
    message : str
        Sentence that describes the toggle position.

    Examples
    --------
    >>> joints = (
    ...     planar.Pin("A", "arm", "ground", at=(0, -0.04)),
    ...     planar.Pin("B", "arm", "handle", at=(0, 0)),
    ...     planar.Bar("CD", "handle", "ground", at=(0.02, 0.02), to=(0.04, 0.0546)),
    ... )
    >>> hand = planar.Force("hand", "handle", at=(0.08, 0.012), direction=(0, -1))
    >>> clamp = planar.Mechanism(("handle", "arm"), joints, (hand,))
    >>> path = planar.trace(clamp, "hand", length=0.06, points=41)
    >>> [round(1e3 * toggle.value, 1) for toggle in path.toggles]  # mm of the hand, where it stands still
    [14.3]
    """

    load: str | None
    value: float
    position: Position = field(repr=False)
    still: tuple[str, ...]
    message: str


@dataclass(frozen=True)
class Stroke:
    """Positions of a mechanism over values of a driver's coordinate.

    Parameters
    ----------
    driver : str
        Name of the load whose coordinate drives the mechanism.
    values : ndarray, shape (S,)
        Coordinate of the driver from the assembled position [m or rad].
    position : Position
        The S positions of the bodies.
    travel : dict of ndarray, shape (S,)
        Coordinate of each load from the assembled position [m or rad]; nan for a force that turns with its
        body.
    ratio : dict of ndarray, shape (S,)
        Velocity of each load's coordinate over that of the driver, from the null space of the constraints;
        nan where the driver stands still or motions branch.
    mobility : ndarray of int, shape (S,)
        Number of independent motions at each position; above 1 at a branch point.
    toggles : tuple of Toggle
        Toggle positions passed between the least and the greatest value.
    closure : float
        Largest remaining gap of a joint, over the length of the mechanism.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> turn = planar.Moment("turn", "lever")
    >>> run = planar.stroke(planar.Mechanism(("lever",), (hinge,), (turn,)), "turn", [0.0, 0.1, 0.2])
    >>> run.driver, run.values, run.toggles
    ('turn', array([0. , 0.1, 0.2]), ())
    """

    driver: str
    values: np.ndarray
    position: Position = field(repr=False)
    travel: dict[str, np.ndarray] = field(repr=False)
    ratio: dict[str, np.ndarray] = field(repr=False)
    mobility: np.ndarray = field(repr=False)
    toggles: tuple[Toggle, ...]
    closure: float


def assemble(mechanism: Mechanism) -> Position:
    """Assemble the joints by the smallest motion from the drawing (damped Newton method).

    Raises
    ------
    AssemblyError
        If the joints cannot be assembled; the message states the largest gap and its joint.

    References
    ----------
    Constraint equations by Newton's method (standard): Nikravesh (1988), Computer-Aided Analysis of
    Mechanical Systems.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> float(planar.assemble(planar.Mechanism(("lever",), (hinge,))).angle("lever"))  # rad: as drawn
    0.0
    """
    check_mechanism(mechanism)
    system = mechanism.system
    m = system.constraints
    y = np.zeros((1, system.size))
    rows = system.rows(y)
    for _ in range(100):
        gap = np.linalg.norm(rows.value[:, :m])
        if gap < _CLOSED * 1e-3:
            return Position(mechanism, y[0])
        step = decompose(rows.gradient[:, :m], system.rounding).solve(rows.value[:, :m])
        step *= min(1.0, 0.5 / max(np.abs(step).max(), 0.5))
        for _ in range(30):
            trial = system.rows(y - step)
            if np.linalg.norm(trial.value[:, :m]) < gap:
                break
            step /= 2
        else:
            break
        y, rows = y - step, trial
    if np.abs(rows.value[:, :m]).max(initial=0.0) > _rounding(system):
        gaps = {name: np.linalg.norm(rows.value[0, own]) for name, own in system.joints.items()}
        worst = max(gaps, key=lambda name: gaps[name])
        apart = amount(gaps[worst] * system.length)
        remedy = "check its points and the lengths of the bars and cables in its loop"
        said = f"the joints cannot be brought together: {worst!r} stays "
        raise AssemblyError(Words(said, apart, f" apart; {remedy}"))
    return Position(mechanism, y[0])


def _rounding(system: System) -> float:
    """Return the relative gap of a joint, or distance past a toggle, below which it counts as rounding."""
    return max(_CLOSED, 100 * system.rounding)


def stroke(mechanism: Mechanism, driver: str, values: Sequence[float] | np.ndarray) -> Stroke:
    """Find the positions at which a driver's coordinate has given values.

    The curve of positions is followed by arc length from the assembled position (tangent predictor, Newton,
    step halving); then the positions of all values are solved at once, to rounding.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism, of mobility 1.
    driver : str
        Name of the driving load. The coordinate of a cable pair is its shortening, of a moment the rotation
        of its body, of a force the travel of its point along its direction.  A load of magnitude 0 may drive,
        too.
    values : sequence of S floats
        Coordinates of the driver from the assembled position [m or rad], in any order.

    Returns
    -------
    Stroke

    Raises
    ------
    AssemblyError
        If the joints cannot be brought together.
    OutOfReachError
        If the driver turns back before a value; the message states where.
    ValueError
        If the mobility is not 1, or the driver does not move.

    References
    ----------
    As `assemble`, from one position to the next.

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> turn = planar.Moment("turn", "lever")
    >>> run = planar.stroke(planar.Mechanism(("lever",), (hinge,), (turn,)), "turn", [0.0, 0.1, 0.2])  # rad
    >>> run.position.angle("lever").round(9)
    array([0. , 0.1, 0.2])
    """
    system, start, k = _start(mechanism, driver, driver)
    target = real_array("values", values) / _units(system)[k]
    if not target.size:
        raise ValueError("values is empty: give at least one value of the driver")
    up = _reach(mechanism, start, k, target.max(initial=0.0), driver)
    down = _reach(mechanism, start.reversed(), k, target.min(initial=0.0), driver)
    nodes = [node.reversed() for node in reversed(down[1:])] + up
    try:
        ends = (min(0.0, target.min()), max(0.0, target.max()))
        wanted = start.value[k] + np.append(target, ends)
        # Wanted values are clipped: due to rounding the curve may end just before one, at a toggle position.
        within = nodes[0].value[k], nodes[-1].value[k]
        y = solve_at_values(system, nodes, k, np.clip(wanted, *within))
    except np.linalg.LinAlgError:
        raise OutOfReachError(
            f"no position is found at one of the values of {driver!r}: it turns back or motions branch there",
            "end the stroke before it, or follow the motion with trace",
        ) from None
    if len(nodes) > 1:  # make the curve end exactly at the extreme values
        nodes[0], nodes[-1] = (node_at(system, y[i], nodes[end].tangent) for i, end in ((-2, 0), (-1, -1)))
    return _finish(mechanism, k, start, nodes, y[:-2])


def trace(mechanism: Mechanism, driver: str, length: float, points: int = 101) -> Stroke:
    """Find positions at equal distances along the curve of positions, also past turning points of the driver.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism, of mobility 1.
    driver : str
        Name of the load whose coordinate grows at first.
    length : float
        Length of the curve [m]: root of the summed squares of all changes of coordinates, with rotations
        times the greatest distance of the body's points from their centre.
    points : int
        Number of positions; the first is the assembled one.

    Returns
    -------
    Stroke

    References
    ----------
    As `assemble`, along the arc of the motion (standard continuation).

    Examples
    --------
    >>> joints = (
    ...     planar.Pin("A", "crank", "ground", at=(0.0, 0.0)),
    ...     planar.Pin("B", "crank", "coupler", at=(0.0, 0.04)),
    ...     planar.Pin("C", "coupler", "rocker", at=(0.12, 0.09)),
    ...     planar.Pin("D", "rocker", "ground", at=(0.1, 0.0)),
    ... )
    >>> linkage = planar.Mechanism(("crank", "coupler", "rocker"), joints, (planar.Moment("drive", "crank"),))
    >>> path = planar.trace(linkage, "drive", length=0.1, points=5)
    >>> np.hypot(*path.position.point("crank", (0.0, 0.04)).T).round(9)  # the pin B stays on its circle
    array([0.04, 0.04, 0.04, 0.04, 0.04])
    """
    system, start, k = _start(mechanism, driver)
    end = positive("length", length, "m") / system.length
    s = np.linspace(0.0, end, count("points", points, 2, MOST_POSITIONS))
    nodes, chords = [start], 0.0
    for node in follow(system, start):
        chords += float(np.linalg.norm(node.y - nodes[-1].y))
        nodes.append(node)
        if chords > s[-1]:
            break
    y = solve_at_arc_lengths(system, nodes, s)
    nodes[-1] = node_at(system, y[-1], nodes[-1].tangent)
    return _finish(mechanism, k, start, nodes, y)


def driver_at_travel(mechanism: Mechanism, driver: str, weights: Mapping[str, float], value: float) -> float:
    """Find the driver's travel [m or rad] at which a weighted sum of the loads' travels reaches a value.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism, of mobility 1.
    driver : str
        Name of the load whose coordinate grows.
    weights : mapping
        Weight of each load in the sum, which must grow with the driver at first.
    value : float
        The wanted value of the sum, above 0 [m or rad].

    Raises
    ------
    AssemblyError, OutOfReachError
        If the joints cannot be brought together, or the driver or the sum turns back before that.
    OppositeTravelError
        If the sum falls while the driver grows.
    ValueError
        If the mobility is not 1, the driver does not move, or a load has no coordinate.
    """
    system, start, k = _start(mechanism, driver, driver, *weights)
    unit = _units(system)
    weight = np.array([weights.get(name, 0.0) for name in system.loads]) * unit
    if weight @ start.rate <= 0:
        raise OppositeTravelError(f"the travel of {join_names(weights)} falls while {driver!r} grows")
    target, before = float(weight @ start.value) + value, start
    for node in follow(system, start):
        turning = [
            find_zero(system, before, node, lambda n, w=w: float(n.rate @ w))
            for w in (np.eye(len(unit))[k], weight)
            if node.rate @ w <= 0
        ]
        last = min(turning, key=lambda n, a=before: float((n.y - a.y) @ a.tangent), default=node)
        slack = 0.0 if last is node else _rounding(system) * system.length
        if weight @ last.value >= target - slack:
            y = solve_at_sum(system, before, last, weight, min(target, float(weight @ last.value)))
            return float((node_at(system, y, last.tangent).value[k] - start.value[k]) * unit[k])
        if last is not node:
            reached, moved = weight @ (last.value - start.value), (last.value[k] - start.value[k]) * unit[k]
            said = f"the travel of {join_names(weights)} cannot reach ", amount(value), ": it is "
            where = f" where it or the driver {driver!r} turns back, at ", _amount(mechanism, driver, moved)
            raise OutOfReachError(Words(*said, amount(reached, digits=9), *where), "give less")
        before = node
    raise AssertionError("a curve is followed until it ends with an error")


def _start(mechanism: Mechanism, driver: str, *measured: str) -> tuple[System, Node, int]:
    """Return the start of a curve of positions: system, assembled position, and index of the driving load.

    `measured` are loads that must have a coordinate; else there is a ValueError.
    """
    check_mechanism(mechanism)
    for name in measured:
        if not mechanism.load(name).has_coordinate:
            said = "turns with its body, so that its travel depends on the path: choose another"
            raise ValueError(f"load {name!r} {said}")
    mechanism.load(driver)
    system = mechanism.system
    y = assemble(mechanism).batch
    k = list(system.loads).index(driver)
    free = decompose(system.rows(y).gradient[:, : system.constraints], system.rounding).null()
    if not (mobility := free.shape[1]):
        raise ValueError("the mechanism does not move: mobility 0; a stroke needs 1: remove a joint")
    if mobility > 1:
        needs = f"the mechanism has mobility {mobility}; a stroke needs 1: "
        more = f"{mobility - 1} joint{'s' if mobility > 2 else ''} (a rotation lock, a bar, a contact)"
        raise ValueError(Words(needs, describe(system, y, free), f"; add {more}"))
    node = node_at(system, y[0], free[:, 0])
    check_moves(system, driver, node.rate[k])
    return system, node if node.rate[k] > 0 else node.reversed(), k


def _reach(mechanism: Mechanism, start: Node, k: int, value: float, driver: str) -> list[Node]:
    """Follow the curve from a node until the k-th load's coordinate has changed by a value; return nodes."""
    system, unit = mechanism.system, _units(mechanism.system)[k]
    wanted = _amount(mechanism, driver, value * unit, 6)
    nodes, target, sense = [start], start.value[k] + value, np.sign(value)
    for node in follow(system, start) if value else ():
        if node.rate[k] * sense <= 0:
            turning = find_zero(system, nodes[-1], node, lambda n: n.rate[k])
            if (target - turning.value[k]) * sense > _rounding(system):
                reached = (turning.value[k] - start.value[k]) * unit
                near = f"{reached:.4g}" == f"{value * unit:.4g}"
                where = f": it turns back {'just short of it, ' * near}at "
                there = _amount(mechanism, driver, reached)
                raise OutOfReachError(
                    Words(f"driver {driver!r} cannot reach ", wanted, where, there, " (toggle position)"),
                    "stay below it, drive another load, or follow the motion past it with trace",
                )
            return [*nodes, turning]
        nodes.append(node)
        if (node.value[k] - target) * sense >= 0:
            return nodes
    if value:
        raise OutOfReachError(Words(f"driver {driver!r} stops before ", wanted), "give a smaller value")
    return nodes


def _finish(mechanism: Mechanism, k: int, start: Node, nodes: list[Node], y: np.ndarray) -> Stroke:
    """Make the stroke from coordinates of the bodies, in rows of y; k is the driver's index among loads."""
    system = mechanism.system
    rows, m, unit = system.rows(y), system.constraints, _units(system)
    constraints = decompose(rows.gradient[:, :m], system.rounding)
    names, index = [*system.loads], [*system.loads.values()]
    rate = times(rows.gradient[:, index], constraints.vt[:, -1])
    # Limit below which velocities per unit of motion, and relative singular values, count as zero.
    still = rank_tolerance(system.rounding)
    single = (constraints.rank == system.size - 1)[:, None] & (np.abs(rate[:, [k]]) > still)
    ratio = np.divide(rate, rate[:, [k]], out=np.full_like(rate, np.nan), where=single)
    known = [load.has_coordinate for load in mechanism.loads]
    travel = np.where(known, (rows.value[:, index] - start.value) * unit, np.nan)
    reversing = {load: lambda n, j=j: n.rate[j] for j, load in enumerate(names)}
    toggles = [
        _toggle(mechanism, node, float((node.value[k] - start.value[k]) * unit[k]), names[k], load)
        for load, function in (*reversing.items(), (None, lambda n: n.regularity))
        for node in _zeros(system, nodes, function, still)
    ]
    return Stroke(
        driver=names[k],
        values=travel[:, k].copy(),
        position=Position(mechanism, y),
        travel=dict(zip(names, travel.T, strict=True)),
        ratio=dict(zip(names, (ratio * unit / unit[k]).T, strict=True)),
        mobility=system.size - constraints.rank,
        toggles=tuple(toggles),
        closure=float(np.abs(rows.value[:, :m]).max(initial=0.0)),
    )


def _zeros(system: System, nodes: list[Node], function: Callable[[Node], float], still: float) -> list[Node]:
    """Find the roots of a function of the nodes, one for each change of its sign.

    Values up to `still` count as zero: such a node has no sign, and there is no root before the first or
    after the last node that has a sign.
    """
    f = np.array([function(node) for node in nodes])
    signed = np.flatnonzero(np.abs(f) > still)
    changes = np.flatnonzero(f[signed[:-1]] * f[signed[1:]] < 0)
    return [find_zero(system, nodes[signed[i]], nodes[signed[i + 1]], function) for i in changes]


def _toggle(mechanism: Mechanism, node: Node, value: float, driver: str, load: str | None) -> Toggle:
    """Make the toggle position of a load, or of a branch point, at a driver's value [m or rad]."""
    position, there = Position(mechanism, node.y), _amount(mechanism, driver, value, 6)
    if load is None:
        message = "motions branch at driver value ", there, ": the mechanism may leave the drawn one there"
        return Toggle(None, value, position, (), Words(*message))
    moving = names_of_moving(mechanism.system, node.tangent[:, None])
    still = tuple(name for name in mechanism.bodies if name not in moving)
    resting = f"; {join_names(still)} stand{'s' if len(still) == 1 else ''} still there" if still else ""
    message = f"toggle position of {load!r} at driver value ", there, f": its motion reverses{resting}"
    return Toggle(load, value, position, still, Words(*message))


def _units(system: System) -> np.ndarray:
    """Return factors from nondimensional to SI coordinates of the loads: the mechanism's length, or 1.

    The factor is 1 for loads whose coordinate is an angle.
    """
    return system.length / system.unit[list(system.loads.values())]


def _amount(mechanism: Mechanism, load: str, moved: float, digits: int = 9) -> Named:
    """State the change of a load's coordinate as text, with its unit."""
    return amount(moved, unit="rad" if mechanism.load(load).is_couple else "m", digits=digits)
