"""Equilibrium at the onset of motion, with Coulomb friction in pivots, slots and contacts.

In shapes of arrays, S counts positions, F joints with friction, and n bodies.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from beamdyn.common.results.statements import IN_LINE, Statement, joined
from beamdyn.common.words import Words
from brakes.planar.kinematics import assemble
from brakes.planar.mechanism import Mechanism, Position, check_mechanism
from brakes.planar.statics import Balance, Equilibrium, balance_at, collect_result, solve, tell_where
from brakes.planar.system import System, check_moves, decompose, join_names, rank_tolerance, times

_RISE = (0.25, 0.5, 0.75, 1.0)  # fractions of the friction coefficients, as load steps
# Relative size of Newton's last step; where friction nearly jams, rounding makes smaller steps impossible.
_SETTLED = 1e-6
# Ratio of the forces with friction to those without, above which the mechanism counts as jammed.
_JAMMED = 1e9
_TINY = np.finfo(float).tiny
_UNPRESSED = 1e-7  # pressing force of a joint, relative to the largest force, below which it counts as zero
_NOTHING = 1e-12  # force, over the largest, below which rounding errors make its direction meaningless
_DISTURBANCE = 1e-3  # couple that disturbs a body, over the largest force and the length of the mechanism


@dataclass(frozen=True)
class FrictionalEquilibrium:
    """Equilibrium of a mechanism with friction, for both directions of motion, and without friction.

    Parameters
    ----------
    squeeze, release : Equilibrium
        Equilibria with friction while the driver's coordinate grows, and while it decreases.  The status is
        "self-locking" if the unknown load, in the direction that it has without friction, cannot cause this
        motion.  The load then acts in the opposite direction; if the mechanism jams, so that no load
        moves it, all forces are nan.
    without : Equilibrium
        Equilibrium without friction.

    Examples
    --------
    >>> axle = planar.Pin("axle", "drum", "ground", at=(0.0, 0.0), radius=0.01, friction=0.1)
    >>> loads = (planar.Force("weight", "drum", (0.1, 0.0), (0, -1), 100.0), planar.Moment("lift", "drum"))
    >>> found = planar.solve_with_friction(planar.Mechanism(("drum",), (axle,), loads), "lift")
    >>> found.squeeze.has_answer, found.release.has_answer
    (True, True)
    """

    squeeze: Equilibrium
    release: Equilibrium
    without: Equilibrium

    @property
    def ways(self) -> dict[str, Equilibrium]:
        """Three equilibria by name: "without friction", "squeezing", "releasing"."""
        return {"without friction": self.without, "squeezing": self.squeeze, "releasing": self.release}


def solve_with_friction(
    mechanism: Mechanism, driver: str, position: Position | None = None
) -> FrictionalEquilibrium:
    """Compute reactions and unknown magnitudes of loads while the mechanism begins to move, or moves slowly.

    A pivot of radius r resists with the couple r mu/sqrt(1 + mu^2) |reaction|, a contact or slot with the
    force mu |reaction|, each against the relative velocity of the motion that the driver causes.  The
    equations are solved by Newton's method with friction that grows from zero, so that a branch which ends in
    self-locking is noticed.

    Parameters
    ----------
    mechanism : Mechanism
        The mechanism, of mobility 1 and statically determined without friction.
    driver : str
        Name of the load whose coordinate grows while squeezing.
    position : Position, optional
        Position of the bodies; by default the assembled drawing.

    Returns
    -------
    FrictionalEquilibrium

    Raises
    ------
    ValueError
        If the mobility is not 1, or equilibrium without friction is not determined.

    References
    ----------
    Coulomb's law; pins by their friction circle (standard).

    Examples
    --------
    >>> axle = planar.Pin("axle", "drum", "ground", at=(0.0, 0.0), radius=0.01, friction=0.1)
    >>> loads = (
    ...     planar.Force("weight", "drum", at=(0.1, 0.0), direction=(0, -1), magnitude=100.0),
    ...     planar.Moment("lift", "drum"),
    ... )
    >>> found = planar.solve_with_friction(planar.Mechanism(("drum",), (axle,), loads), "lift")
    >>> ways = found.release, found.without, found.squeeze
    >>> [round(float(way.amplitudes["lift"]), 3) for way in ways]  # N m
    [9.9, 10.0, 10.1]
    """
    check_mechanism(mechanism, position)
    mechanism.load(driver)
    position = assemble(mechanism) if position is None else position.of(mechanism)
    without = solve(mechanism, position)
    if not without.is_determined or (without.mobility != 1).any():
        needs = "friction needs mobility 1 and a determined equilibrium; here the mobility is "
        raise ValueError(Words(needs, f"{np.max(without.mobility)}, and ", without.message))
    balance, system = balance_at(mechanism, position), mechanism.system
    gradient = balance.rows.gradient
    motion = decompose(gradient[:, : system.constraints], system.rounding).vt[:, -1]
    rate = times(gradient, motion)  # rates of the rows' values per unit of the mechanism's motion
    driven, slip = rate[:, [system.loads[driver]]], rate[:, list(system.friction.values())]
    check_moves(system, driver, driven)
    still = rank_tolerance(system.rounding)
    # Signs of the sliding velocities while the driver's coordinate grows.
    sliding = np.where(np.abs(slip) > still, np.sign(slip * driven), 0.0)
    squeeze, release = (_branch(mechanism, position, balance, without, s * sliding) for s in (1.0, -1.0))
    return FrictionalEquilibrium(squeeze, release, without)


def _branch(
    mechanism: Mechanism, position: Position, balance: Balance, without: Equilibrium, sliding: np.ndarray
) -> Equilibrium:
    """Solve the equilibrium with friction that opposes sliding with the given signs."""
    system = mechanism.system
    start = np.atleast_2d(without.multiplier / system.unit)
    load = int(balance.unknown[-1])  # with mobility 1 and a determined equilibrium, one load is unknown
    law = -sliding * system.coefficient
    unpressed, jams = _jams_when_disturbed(system, balance, start, law)
    law = np.where(unpressed, 0.0, law)
    multiplier, jammed = _newton(system, balance, start, law)
    # The mechanism locks where friction reverses the unknown load. Loads below `zero` count as zero.
    zero = rank_tolerance(system.rounding) * np.maximum(*(np.abs(x).max(axis=1) for x in (start, multiplier)))
    reversed_ = (np.abs(start[:, load]) > zero) & (multiplier[:, load] * np.sign(start[:, load]) < -zero)
    multiplier[jammed] = start[jammed]  # finite placeholders, which the result replaces by nan
    forces = decompose(balance.matrix, system.rounding)
    regularity = decompose(_friction(system, balance, multiplier, law)[1], system.rounding).s
    kept = regularity[:, -1] / regularity[:, 0]
    jammed |= kept <= rank_tolerance(system.rounding)  # rounding decides whether it jams
    multiplier[jammed] = start[jammed]
    result = collect_result(position, balance, forces, multiplier, jammed, kept)
    if (jams & ~jammed).any():
        warning = _warn_of_jamming(mechanism, unpressed, jams & ~jammed)
        result = replace(result, warnings=(*result.warnings, warning))
    name = mechanism.loads[load - system.constraints].name
    names, words = join_names(map(repr, mechanism.friction)) if mechanism.friction else "", []
    if jammed.any():
        words.append(
            f"self-locking{tell_where(jammed)}: with the friction of {names} no size of {name!r} moves the "
            "mechanism this way; reduce friction or the radius of the pivots"
        )
    if (reversed_ := reversed_ & ~jammed).any():
        words.append(
            f"self-locking{tell_where(reversed_)}: the friction of {names} holds the mechanism, and {name!r} "
            "has to act the other way to move it this way"
        )
    if not words:
        return result
    # If only the locking load is a cable that would have to push, `words` already say so.
    if set(result.open_or_slack) - {name}:
        return replace(result, message=joined("; ", (result.message, *words)))
    return replace(result, status="self-locking", message="; ".join(words))


def _jams_when_disturbed(
    system: System, balance: Balance, start: np.ndarray, law: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Find joints with friction but no pressing force, and positions where a disturbance jams the mechanism.

    If loads act exactly in line, a joint may press with no force, whose direction is then meaningless.
    There can be two equilibria: without pressure, and jammed.  The jammed one needs a disturbance, however
    small, such as an offset of a load. It is modelled by a couple on one body after another, in either sense.
    """
    small = _pressing(system, start) <= _UNPRESSED
    multiplier, jammed = _newton(system, balance, start, np.where(small, 0.0, law))
    force = _pressing(system, multiplier)
    unpressed = small & (force <= _UNPRESSED) & (law != 0) & ~jammed[:, None]
    jams = np.zeros(len(start), bool)
    if not unpressed.any():
        return unpressed, jams
    size = _DISTURBANCE * np.abs(start).max(axis=1, keepdims=True)
    for coordinate in range(2, system.size, 3):
        for sense in (-1.0, 1.0):
            offset = np.zeros((len(start), system.size))
            offset[:, [coordinate]] = sense * size
            without = _newton(system, balance, multiplier, np.where(unpressed, 0.0, law), offset)[0]
            pressed = unpressed & (_pressing(system, without) > _UNPRESSED)
            if pressed.any():  # no friction at other joints without pressure: it has no direction
                rubbing = np.where(unpressed & ~pressed, 0.0, law)
                jams |= pressed.any(axis=1) & _newton(system, balance, multiplier, rubbing, offset)[1]
    return unpressed & (jams[:, None] | (force <= _rounding(system))), jams


def _pressing(system: System, multiplier: np.ndarray) -> np.ndarray:
    """Compute pressing forces (positions, joints with friction) over the largest force at the position."""
    force = np.zeros((len(multiplier), len(system.pressing)))
    for k, rows in enumerate(system.pressing):
        force[:, k] = np.linalg.norm(multiplier[:, rows], axis=1)
    return force / np.maximum(np.abs(multiplier).max(axis=1, keepdims=True), _TINY)


def _rounding(system: System) -> float:
    """Return the force, relative to the largest force, below which a force counts as rounding."""
    return max(_NOTHING, 100 * system.rounding)


def _warn_of_jamming(mechanism: Mechanism, unpressed: np.ndarray, jams: np.ndarray) -> Statement:
    """Warn that any offset of a load jams the joints marked in `unpressed` at the positions `jams`."""
    names = [name for k, name in enumerate(mechanism.friction) if unpressed[jams, k].any()]
    press = "press" if len(names) > 1 else "presses"
    remedy = "reduce friction, or guide the body over a greater length"
    return Statement(
        f"{join_names(map(repr, names))} {press} with no force{tell_where(jams)} because "
        "the loads act exactly in line; any offset of a load, however small, jams the mechanism: ",
        remedy,
        kind=IN_LINE,
        quantity=", ".join(names),
        remedy=remedy,
    )


def _newton(
    system: System, balance: Balance, start: np.ndarray, full: np.ndarray, offset: np.ndarray | float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Solve for the Lagrange multipliers (positions, rows) of joints and loads in equilibrium with friction.

    Also return at which positions the mechanism jams.  `start` contains the multipliers without friction,
    `full` (positions, joints) the signed friction over the pressing force of each joint, and `offset`
    additional generalised forces on the bodies.
    """
    multiplier = start.copy()
    sign = np.linalg.slogdet(balance.matrix).sign
    jammed = np.zeros(len(start), bool)
    for part in _RISE:
        size = np.inf
        for _ in range(40):
            residual, slope = _friction(system, balance, multiplier, part * full)
            # Where the determinant has changed its sign the solution is on another branch: this is jamming.
            jammed |= np.linalg.slogdet(slope).sign != sign
            slope[jammed] = np.eye(slope.shape[1])
            step = np.linalg.solve(slope, (residual + offset)[..., None])[..., 0]
            step[jammed] = 0.0
            multiplier[:, balance.unknown] -= step
            size = np.abs(step).max(axis=1) / np.maximum(np.abs(multiplier).max(axis=1), _TINY)
            if size.max() < 1e-13:
                break
        jammed |= size > _SETTLED
    jammed |= np.abs(multiplier).max(axis=1) > _JAMMED * np.abs(start).max(axis=1)
    _friction(system, balance, multiplier, full)
    return multiplier, jammed


def _friction(
    system: System, balance: Balance, multiplier: np.ndarray, law: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Set the multipliers of the friction forces, in place, to `law` times the pressing forces.

    `law` (positions, joints) is the signed friction over the pressing force of each joint.

    Return the residual of the equilibrium equations and its Jacobian with respect to the unknown multipliers.
    """
    slope = balance.matrix.copy()
    largest = np.abs(multiplier).max(axis=1, keepdims=True)
    for k, (row, normal) in enumerate(zip(system.friction.values(), system.pressing, strict=True)):
        size = np.linalg.norm(multiplier[:, normal], axis=1, keepdims=True)
        multiplier[:, row] = law[:, k] * size[:, 0]
        pressed = size > _rounding(system) * largest  # the direction of smaller forces is meaningless
        direction = np.where(pressed, law[:, [k]] * multiplier[:, normal] / np.maximum(size, _TINY), 0.0)
        slope[:, :, normal] += balance.rows.gradient[:, row, :, None] * direction[:, None, :]
    return balance.forces_on_bodies(multiplier), slope
