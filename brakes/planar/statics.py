"""Equilibrium of a mechanism: forces at S positions of n bodies, R rows of joints, loads and friction."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from beamdyn.common.inputs.checks import count, kind, one_of
from beamdyn.common.results.statements import joined
from beamdyn.common.words import Words
from brakes.planar.kinematics import assemble
from brakes.planar.mechanism import Mechanism, Position, check_mechanism, close_joints
from brakes.planar.part import OneWay, Part
from brakes.planar.rows import GROUND, Row
from brakes.planar.system import (
    Decomposition,
    Rows,
    System,
    decompose,
    describe,
    join_names,
    names_of_moving,
    rank_tolerance,
    times,
)

_BALANCED = 1e-9  # largest residual of equilibrium that counts as zero, over the largest force
_UNDETERMINED = 1e-7  # component of a self-stress above which a reaction counts as undetermined
_BESIDE = 1e-2  # step off a toggle position, over the mechanism's length, to test if it is held there
_WEAK = 1e-5  # relative singular value below which the result counts as ill-conditioned


@dataclass(frozen=True)
class Equilibrium:
    """Forces of a mechanism in equilibrium; values that are not determined are nan.

    Arrays have the shape () for one position or (S,) for several; vectors have a last axis (x, y).

    Parameters
    ----------
    position : Position
        The position or positions of the bodies.
    status : str
        The worst status of all positions: "no equilibrium"; "near a toggle", where rounding of the drawing
        decides whether there is equilibrium; "undetermined"; "loose": in balance, but not held; "contact
        opens" or "cable slackens": a part would have to act in its impossible direction, so that the forces
        are not those of the mechanism; "self-locking" (see `solve_with_friction`); "determined".
    message : str
        The status as a sentence, with the names of bodies and joints.
    reactions : dict of ndarray
        Force of each joint on the body that it names first [N]; couples, as of a `RotationLock`, are in
        `magnitudes` only.
    magnitudes : dict of ndarray
        Size of each joint's reaction: tension of a bar or cable, push of a contact, couple of a rotation lock
        on the body named first [N m], component of a slot's force to the left of its direction; absolute
        value for a pin.
    amplitudes : dict of ndarray
        Magnitude of each load, known or solved for [N, N m].
    friction : dict of ndarray
        Friction couple [N m] or force [N] of each joint that has friction, on the body named first.
    mobility, indeterminacy, uncontrolled : ndarray of int
        Numbers of independent motions, of independent self-stresses, and of motions that no joint or unknown
        load opposes.
    movable, loose : tuple of str
        Bodies that the joints let move, and bodies with uncontrolled motion, at any of the positions.
    undetermined : tuple of str
        Joints and loads whose forces equilibrium does not determine.
    open_or_slack : tuple of str
        Contacts that would have to pull and cables that would have to push, at any of the positions.
    virtual_work : ndarray
        Largest virtual work of loads and friction in a free motion, over the largest force.  With mobility 0
        there is no free motion: it is then the sum of all forces, or of all moments, on the ground, whichever
        is larger, over the largest force.  In equilibrium it is zero up to rounding.
    residual : ndarray
        Largest residual force or moment on a body, over the largest force.
    error : ndarray
        Error of the forces relative to the largest (couples over the length of the mechanism): rounding of
        the coordinates and the residual, both over the smallest singular value of the equations with their
        friction, but not less than `virtual_work`; nan where there are no forces.
    kept, dropped : ndarray
        Smallest singular value above the rank tolerance and largest below it, over the largest of all: a
        wide gap makes the rank certain.
    warnings : tuple of str
        Reasons to doubt the forces: positions close to a toggle position or to indeterminacy, and joints
        with friction that jam when disturbed.
    multiplier : ndarray, shape (..., rows)
        Multiplier of every row of joints, loads and friction [N, N m].

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> hand = planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0)
    >>> found = planar.solve(planar.Mechanism(("lever",), (hinge,), (hand,)))
    >>> found.has_answer, found.loose  # nothing holds the lever
    (False, ('lever',))
    """

    position: Position = field(repr=False)
    status: str
    message: str
    reactions: dict[str, np.ndarray]
    magnitudes: dict[str, np.ndarray] = field(repr=False)
    amplitudes: dict[str, np.ndarray]
    friction: dict[str, np.ndarray] = field(repr=False)
    mobility: np.ndarray
    indeterminacy: np.ndarray
    uncontrolled: np.ndarray
    movable: tuple[str, ...]
    loose: tuple[str, ...]
    undetermined: tuple[str, ...]
    open_or_slack: tuple[str, ...]
    virtual_work: np.ndarray
    residual: np.ndarray
    error: np.ndarray
    kept: np.ndarray = field(repr=False)
    dropped: np.ndarray = field(repr=False)
    warnings: tuple[str, ...]
    multiplier: np.ndarray = field(repr=False)

    @property
    def is_determined(self) -> bool:
        """Whether statics determines every force, even if a contact pulls or a cable pushes."""
        return not (self.undetermined or self.loose or np.isnan(self.multiplier).any())

    @property
    def largest_error(self) -> float:
        """Largest error over all positions; nan if there are no forces."""
        return float(np.fmax.reduce(self.error, axis=None))

    @property
    def has_answer(self) -> bool:
        """Whether the forces are possible in the mechanism; see `is_answer`."""
        return self.is_determined and is_answer(self.status, self.multiplier)


class Balance(NamedTuple):
    """Terms of the equilibrium equations at S positions, in scaled units.

    rows : values and gradients of the rows of joints, loads and friction.
    unknown : indices of the rows whose multipliers are unknown.
    given : (S, R), multipliers of the known loads, 0 for all others.
    matrix : (S, 3 n, unknowns), the matrix [J^T G] of `solve`.
    """

    rows: Rows
    unknown: np.ndarray
    given: np.ndarray
    matrix: np.ndarray

    def forces_on_bodies(self, multiplier: np.ndarray) -> np.ndarray:
        """Compute the generalised forces on the bodies at each position from all rows' multipliers."""
        return times(self.rows.gradient.swapaxes(1, 2), multiplier)


def solve(mechanism: Mechanism, position: Position | None = None) -> Equilibrium:
    """Compute the reactions of joints and the unknown magnitudes of loads, at one position or many.

    The equations [J^T G][lambda; s] = -Q, 3 rows per body, are solved by singular value decomposition. J is
    the gradient of the joints' constraints and lambda their multipliers, G the gradient of the coordinates of
    loads with unknown magnitudes s, and Q the known loads.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism.
    position : Position, optional
        Position of the bodies, by default the assembled drawing. A position of a mechanism with the same
        bodies and joints but other loads will do.

    Returns
    -------
    Equilibrium

    Raises
    ------
    AssemblyError
        If no position is given and the joints cannot be brought together.

    References
    ----------
    Virtual work (standard): the transposed Jacobian of the constraints balances the loads.  Which bodies are
    loose and which forces undetermined follows from its null spaces (derived here).

    Examples
    --------
    >>> hinge = planar.Pin("hinge", "lever", "ground", at=(0.0, 0.0))
    >>> hand = planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0)
    >>> held = planar.Moment("held", "lever")
    >>> found = planar.solve(planar.Mechanism(("lever",), (hinge,), (hand, held)))
    >>> round(float(found.amplitudes["held"]), 6), found.reactions["hinge"].round(6)
    (30.0, array([  0., 100.]))
    """
    check_mechanism(mechanism, position)
    position = assemble(mechanism) if position is None else position.of(mechanism)
    balance = balance_at(mechanism, position)
    forces = decompose(balance.matrix, mechanism.system.rounding)
    multiplier = balance.given.copy()
    multiplier[:, balance.unknown] = forces.solve(-balance.forces_on_bodies(balance.given))
    return collect_result(position, balance, forces, multiplier)


def balance_at(mechanism: Mechanism, position: Position) -> Balance:
    """Compute the terms of the equilibrium equations at positions."""
    system = mechanism.system
    rows = system.rows(position.batch)
    given = np.zeros(rows.value.shape)
    unknown = list(range(system.constraints))
    for load, row in zip(mechanism.loads, system.loads.values(), strict=True):
        amplitude = load.amplitude(rows.value[:, row] * (system.length / system.unit[row]))
        if amplitude is None:
            unknown.append(row)
        else:
            given[:, row] = amplitude / system.unit[row]
    index = np.array(unknown, int)
    return Balance(rows, index, given, rows.gradient[:, index].swapaxes(1, 2))


def collect_result(
    position: Position,
    balance: Balance,
    forces: Decomposition,
    multiplier: np.ndarray,
    jammed: np.ndarray | bool = False,
    regularity: np.ndarray | None = None,
) -> Equilibrium:
    """Make the result from the scaled multipliers of all rows; forces at `jammed` positions are nan.

    `regularity` (S,) is the smallest singular value of the equations with friction, over the largest.
    """
    mechanism, system = position.mechanism, position.mechanism.system
    constraints = decompose(balance.rows.gradient[:, : system.constraints], system.rounding)
    scale = np.maximum(np.abs(multiplier).max(axis=1, initial=0.0), np.finfo(float).tiny)
    residual = np.abs(balance.forces_on_bodies(multiplier)).max(axis=1) / scale
    unbalanced = (residual > tolerance(system)) & ~np.asarray(jammed)
    # Equilibrium does not determine multipliers (S, R) that take part in a self-stress.
    stressed = np.zeros(multiplier.shape, bool)
    stressed[:, balance.unknown] = np.linalg.norm(forces.null_rows(), axis=1) > _UNDETERMINED
    shown = np.where(stressed | (unbalanced | jammed)[:, None], np.nan, multiplier)
    rows = np.any(stressed[~unbalanced], axis=0)
    undetermined = [name for name, own in system.joints.items() if rows[own].any()]
    undetermined += [name for name, row in system.loads.items() if rows[row]]
    sizes = _sizes(mechanism, balance.rows, shown)
    ways = one_way_parts(mechanism.parts)
    wrong_way = find_wrong_way(ways, sizes["magnitudes"] | sizes["amplitudes"], tolerance(system) * scale)
    # Check of the equilibrium.  In the motions that the joints allow, the virtual work of loads and friction
    # must be 0.  If they allow no motion, the sum of all forces and couples on the ground must be 0 instead.
    loads = np.where(np.arange(multiplier.shape[1]) < system.constraints, 0.0, multiplier)
    work = np.abs(times(constraints.null_rows(), balance.forces_on_bodies(loads))).max(axis=1)
    received = [np.abs((part[:, :, -1] * multiplier).sum(axis=1)) for part in balance.rows[1:3]]
    virtual_work = np.where(constraints.rank == system.size, np.maximum(*received), work) / scale
    kept = forces.kept if regularity is None else regularity
    missing = unbalanced | jammed | (kept == 0)  # positions without a solution, or without unknowns
    error = np.maximum((system.rounding + residual) / np.where(missing, np.nan, kept), virtual_work)
    verdict = _verdict(position, constraints, forces, unbalanced, undetermined, wrong_way.values())
    weak = (
        f"reactions depend on the last digits of the drawing (smallest singular value {forces.kept.min():.1g}"
        "): the position is close to a toggle position or to indeterminacy"
    )
    arrays: dict[str, Any] = {
        "mobility": system.size - constraints.rank,
        "indeterminacy": forces.vt.shape[-1] - forces.rank,
        "uncontrolled": system.size - forces.rank,
        "virtual_work": virtual_work,
        "residual": residual,
        "error": error,
        "kept": forces.kept,
        "dropped": forces.dropped,
        "multiplier": shown * system.unit,
    }
    shape = position.coordinates.shape[:-1]  # for a single position, results have no axis of positions
    return Equilibrium(
        position=position,
        **verdict,
        **{key: {n: v.reshape(shape + v.shape[1:]) for n, v in each.items()} for key, each in sizes.items()},
        movable=names_of_moving(system, constraints.null(int(constraints.rank.argmin()))),
        undetermined=tuple(undetermined),
        open_or_slack=tuple(wrong_way),
        warnings=(weak,) if forces.kept.min() < _WEAK else (),
        **{key: values.reshape(shape + values.shape[1:]) for key, values in arrays.items()},
    )


def _sizes(mechanism: Mechanism, rows: Rows, multiplier: np.ndarray) -> dict[str, dict[str, np.ndarray]]:
    """Collect forces by name, from the Lagrange multipliers (positions, rows) in scaled units.

    They are reactions and force magnitudes of joints, magnitudes of loads, and friction forces [N, N m].
    """
    system, physical = mechanism.system, multiplier * mechanism.system.unit
    reactions, magnitudes = {}, {}
    for joint in mechanism.joints:
        own = system.joints[joint.name]
        magnitudes[joint.name] = joint.size(physical[:, own])
        if not joint.is_couple:
            force = (rows.force[:, own, system.bodies[joint.acts_on[0]]] * multiplier[:, own]).sum(axis=1)
            reactions[joint.name] = np.stack((force.real, force.imag), axis=-1)
    both = system.loads, system.friction
    amplitudes, friction = ({name: physical[:, row] for name, row in each.items()} for each in both)
    return {"reactions": reactions, "magnitudes": magnitudes, "amplitudes": amplitudes, "friction": friction}


def is_answer(status: str, forces: ArrayLike) -> bool:
    """Return whether forces are possible: none is nan, no contact pulls, and no cable pushes.

    A self-locking mechanism moves by the given forces, so that these count as possible.

    Parameters
    ----------
    status : str
        Status as in `Equilibrium`.
    forces : array_like
        Forces and moments from equilibrium [N, N m].
    """
    return status in ("determined", "self-locking") and bool(np.isfinite(forces).all())


def tolerance(system: System) -> float:
    """Return the force, relative to the largest, up to which a force counts as zero.

    It grows with the drawing's distance from (0, 0), as the rounding of coordinates does.
    """
    return max(_BALANCED, 1e3 * system.rounding)


def find_wrong_way(
    ways: Mapping[str, OneWay], sizes: Mapping[str, np.ndarray], least: np.ndarray
) -> dict[str, tuple[str, str]]:
    """Find contacts that would have to pull and cables that would have to push: status and message, by name.

    Parameters
    ----------
    ways : mapping
        Joints and loads that act in one direction only: see `one_way_parts`.
    sizes : mapping
        Size of each joint's or load's force at S positions [N]; other names are ignored.
    least : ndarray, shape (S,)
        Force below which a size counts as zero [N].
    """
    found = {}
    for name, way in ways.items():
        size = np.ravel(sizes[name])
        if (wrong := size < -least).any():
            force = f"{-np.nanmin(size):.6g} N{tell_where(wrong)}"
            sentence = f"{way.noun} {name!r} would have to {way.cannot} with {force}: {way.remedy}"
            found[name] = way.status, sentence
    return found


def tell_where(positions: np.ndarray) -> str:
    """State how many positions are marked, as " at 2 of 9 positions"; empty for a single position."""
    return f" at {positions.sum()} of {len(positions)} positions" if len(positions) > 1 else ""


def one_way_parts(parts: Iterable[Part]) -> dict[str, OneWay]:
    """Return the joints and loads that act in one direction only, by name."""
    return {part.name: part.one_way for part in parts if part.one_way is not None}


def _verdict(
    position: Position,
    constraints: Decomposition,
    forces: Decomposition,
    unbalanced: np.ndarray,
    undetermined: Sequence[str],
    wrong_way: Iterable[tuple[str, str]],
) -> dict[str, Any]:
    """Find status, message and loose bodies of an `Equilibrium`, for its worst position."""
    system = position.mechanism.system
    worst = int(unbalanced.argmax()) if unbalanced.any() else int(forces.rank.argmin())
    loose, y = forces.left_null(worst), position.batch[worst]
    found: list[tuple[str, str]] = []
    how = describe(system, y, loose) if unbalanced.any() or loose.shape[1] else ""
    remedy = "add a joint, or give no magnitude to a load that moves it"
    if unbalanced.any():
        free, margin, least = constraints.null(worst), forces.dropped[worst], rank_tolerance(system.rounding)
        if free.shape[1] == 1 and _is_held_beside(position, worst, free[:, 0], int(forces.rank[worst])):
            sentence = Words(
                "too near a toggle position to decide whether the loads are in balance: ",
                how,
                f" there, which only infinitely large forces could stop (smallest singular value "
                f"{margin:.1g}, at least {least:.1g} is needed); draw it further from that position, or give "
                "no magnitude to a load that moves it",
            )
            found.append(("near a toggle", sentence))
        else:
            found.append(("no equilibrium", Words("the loads are not in balance: ", how, f"; {remedy}")))
    else:
        if undetermined:
            sentence = (
                "statically indeterminate: equilibrium alone does not give "
                f"{join_names(undetermined)}; remove a joint among them, or give the magnitude of a load "
                "that has none"
            )
            found.append(("undetermined", sentence))
        if loose.shape[1]:
            said = "the loads are in balance, but nothing keeps them so: "
            found.append(("loose", Words(said, how, f"; {remedy}")))
        found += wrong_way
    status, message = combine(found)
    return {"status": status, "message": message, "loose": names_of_moving(system, loose)}


def _is_held_beside(position: Position, index: int, motion: np.ndarray, rank: int) -> bool:
    """Return whether the equilibrium matrix has a higher rank after a small step of a free motion."""
    system, y = position.mechanism.system, position.batch[[index]]
    try:
        beside = close_joints(system, y + _BESIDE * motion, motion[None])
    except np.linalg.LinAlgError:  # the motion branches at this position
        return True
    matrix = balance_at(position.mechanism, Position(position.mechanism, beside[0])).matrix
    return int(decompose(matrix, system.rounding).rank[0]) > rank


def combine(found: Sequence[tuple[str, str]]) -> tuple[str, str]:
    """Combine pairs of status and message, in order of decreasing severity, to one status and message."""
    if not found:
        return "determined", "every reaction and load is determined"
    return found[0][0], joined("; ", (sentence for _, sentence in found))


class Action(NamedTuple):
    """A force or a couple that a joint or load exerts on a body.

    name : str
        Name of the joint or load; for friction, "friction of" and its name in `Mechanism.friction`.
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
    >>> hand = planar.Force("hand", "lever", at=(0.3, 0.0), direction=(0, -1), magnitude=100.0)
    >>> work = planar.Force("work", "lever", at=(0.1, 0.0), direction=(0, 1))
    >>> actions = planar.free_body(planar.solve(planar.Mechanism(["lever"], [hinge], [hand, work])), "lever")
    >>> sum(action.force for action in actions).round(9)  # N: in balance
    array([0., 0.])
    """
    kind("equilibrium", equilibrium, Equilibrium, "solve(mechanism) gives one")
    mechanism = equilibrium.position.mechanism
    one_of("body", body, (*mechanism.bodies, GROUND))
    index = count("index", index, most=len(equilibrium.position.batch) - 1, least=0)
    place = Position(mechanism, equilibrium.position.batch[index])
    size, system = np.atleast_2d(equilibrium.multiplier)[index], mechanism.system

    def act(name: str, row: Row, size: float) -> list[Action]:
        return [Action(name, *effect) for effect in row.effects(size, place, body)]

    actions = []
    for joint in mechanism.joints:
        parts = zip(joint.rows(), size[system.joints[joint.name]], strict=True)
        found = [action for row, s in parts for action in act(joint.name, row, s)]
        if len(found) == 2 and np.array_equal(found[0].at, found[1].at):  # two components of a pin's force
            found = [Action(joint.name, found[0].at, found[0].force + found[1].force, 0.0)]
        actions += found
    for load in mechanism.loads:
        actions += act(load.name, load.row(), size[system.loads[load.name]])
    for name, (_, law) in mechanism.friction.items():
        actions += act(f"friction of {name}", law.row, size[system.friction[name]])
    return tuple(actions)
