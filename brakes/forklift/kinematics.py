"""The two stages of a duo-servo brake's motion as planar mechanisms, followed position by position.

Stage 1, on each side: shoe, dummy, piston (9 unknowns); the dummy is a small body between shoe and piston.
The shoe is pinned at the adjuster (2 equations) and to the dummy at its tip (2), the dummy slides on the
piston's face (2), the piston in the cylinder (2): one degree of freedom is left, and is followed until the
contact point reaches the drum.

Stage 2: drum, two shoes, adjuster, two dummies, two pistons (24 unknowns). The drum is pinned (2), the
right shoe welded to it (3), the left one pinned at the drum's centre with its lining seated (2); the adjuster
has two pins (4), and each side has 6 equations as above: 23 independent ones, followed until the right piston
reaches its bottom. Welding both shoes would make an equation redundant; pinning them at their contact points
only would leave two degrees of freedom.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.checks import count, kind, positive
from beamdyn.common.results.one_line import number, warned
from beamdyn.common.results.result import Result, plain
from brakes.forklift.duo_servo import DuoServo
from brakes.planar import (
    GROUND,
    CablePair,
    Force,
    Joint,
    Mechanism,
    Moment,
    Pin,
    Position,
    RotationLock,
    Slot,
    stroke,
)
from brakes.planar.kinematics import MOST_POSITIONS

_RANK_TOLERANCE = 1e-9  # ratio of a singular value to the largest, below which it counts as zero
_ORIGIN = (0.0, 0.0)

Point = tuple[float, float]


@dataclass(frozen=True)
class Stage:
    """One stage of the motion of a duo-servo brake, at S positions.

    Attributes
    ----------
    mechanism : Mechanism
        The mechanism, described in its position at the start of the stage.
    position : Position
        Positions of the bodies.
    travel : dict of ndarray, shape (S,)
        Piston travels ``"right"``, ``"left"`` from the start of the stage, outward [m].
    turn : ndarray, shape (S,)
        Turn of the shoe, clockwise (stage 1), or of the drum, counter-clockwise (stage 2) [rad].
    rank : ndarray of int, shape (S,)
        Rank of the constraints' Jacobian.
    least_singular_value : ndarray, shape (S,)
        Smallest over largest singular value of the constraints: near 0, a constraint is nearly redundant.

    Examples
    --------
    >>> stage = forklift.follow_shoes(forklift.BENDIX_12_5, clearance=0.0106, positions=5).drum
    >>> bool((stage.rank == stage.constraints).all())  # no redundant constraint on the way
    True
    """

    field_units: ClassVar[dict[str, str]] = {"m": "travel", "rad": "turn"}

    mechanism: Mechanism = field(repr=False)
    position: Position = field(repr=False)
    travel: dict[str, np.ndarray]
    turn: np.ndarray
    rank: np.ndarray
    least_singular_value: np.ndarray

    @property
    def constraints(self) -> int:
        """Number of constraint equations; it equals the rank if none is redundant."""
        return self.mechanism.system.constraints


@dataclass(frozen=True)
class Event:
    """An event of the shoes' motion: its stage, the turn [rad] at which it happens, and a sentence.

    Examples
    --------
    >>> followed = forklift.follow_shoes(forklift.BENDIX_12_5, clearance=0.0106, positions=5)
    >>> all(isinstance(event, forklift.Event) for event in followed.events)
    True
    """

    name: str
    stage: int
    turn: float
    message: str


@dataclass(frozen=True)
class Kinematics(Result):
    """Motion of a duo-servo brake in both stages, with its events.

    Attributes
    ----------
    geometry : DuoServo
        The brake.
    clearance : float
        Clearance between lining and drum at rest [m].
    right, left : Stage
        Stage 1 on the right and on the left side.
    drum : Stage
        Stage 2, in which the shoes turn with the drum.
    events : tuple of Event
        Events: each lining reaches the drum; the right piston reaches its bottom.
    interference : tuple of str
        One sentence for each pair of parts that collide.

    Examples
    --------
    >>> followed = forklift.follow_shoes(forklift.BENDIX_12_5, clearance=0.0106, positions=5)
    >>> followed.clearance
    0.0106
    """

    field_units: ClassVar[dict[str, str]] = {"m": "clearance"}

    geometry: DuoServo
    clearance: float
    right: Stage
    left: Stage
    drum: Stage
    events: tuple[Event, ...]
    interference: tuple[str, ...]

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"clearance {number(1e3 * self.clearance, 'mm')}"
        yield from (f"{each.name} at {number(np.degrees(each.turn), 'deg')}" for each in self.events)
        yield warned(self.interference)

    def to_dict(self) -> dict[str, Any]:
        """Convert the result to plain numbers, lists and strings."""
        made = super().to_dict()
        for name in ("right", "left", "drum"):
            stage = getattr(self, name)
            travel = {side: values.tolist() for side, values in stage.travel.items()}
            made[name] = plain(stage) | {"travel": travel}
        return made


def follow_shoes(geometry: DuoServo, clearance: float, positions: int = 21) -> Kinematics:
    """Follow the parts of a duo-servo brake through both stages of its motion.

    Parameters
    ----------
    geometry : DuoServo
        The brake; a single one, without arrays.
    clearance : float
        Clearance between lining and drum at rest [m].
    positions : int
        Number of positions in each stage.

    Returns
    -------
    Kinematics
        Positions, rank of the constraints, events and interference.

    Raises
    ------
    ValueError
        If the clearance is not positive, or larger than the drum allows.

    References
    ----------
    Yoo et al. (1997), section 3.

    Examples
    --------
    >>> followed = forklift.follow_shoes(forklift.BENDIX_12_5, clearance=0.0106, positions=5)
    >>> followed.right.turn.shape
    (5,)
    """
    kind("geometry", geometry, DuoServo)
    c, n = positive("clearance", clearance, "m"), count("positions", positions, 2, MOST_POSITIONS)
    interference = geometry.move_shoes(c).interference
    seated, tips, events = {}, [], []
    for side in ("right", "left"):
        mechanism = build_seating_mechanism(geometry, c, side)
        path = stroke(mechanism, "clearance", np.linspace(0.0, -c, n))
        turn = path.position.angle(f"{side} shoe") * (-1 if side == "right" else 1)
        rank = constraint_rank(path.position)
        seated[side] = Stage(mechanism, path.position, {side: path.travel[side]}, turn, *rank)
        x, y = path.position.point(f"{side} shoe", _on_side(side, geometry.tip))[-1]
        tips.append((float(x), float(y)))
        message = (
            f"the {side} lining reaches the drum after {np.degrees(turn[-1]):.4f} deg, "
            f"the piston {1e3 * path.travel[side][-1]:.3f} mm out"
        )
        events.append(Event("lining reaches the drum", 1, float(turn[-1]), message))
    mechanism = build_turning_mechanism(geometry, *tips)
    bottom = -float(seated["right"].travel["right"][-1]) - geometry.piston_bottom
    path = stroke(mechanism, "right", np.linspace(0.0, bottom, n))
    travel, turn = {side: path.travel[side] for side in ("right", "left")}, path.travel["drum"]
    drum = Stage(mechanism, path.position, travel, turn, *constraint_rank(path.position))
    out = seated["left"].travel["left"][-1] + travel["left"][-1]
    message = (
        f"the right piston reaches its bottom after the drum turns {np.degrees(turn[-1]):.4f} deg; "
        f"the left piston is {1e3 * out:.3f} mm out"
    )
    events.append(Event("piston bottoms", 2, float(turn[-1]), message))
    return Kinematics(geometry, c, **seated, drum=drum, events=tuple(events), interference=interference)


def build_seating_mechanism(geometry: DuoServo, clearance: float, side: str = "right") -> Mechanism:
    """Build the mechanism of stage 1 of one side, ``"right"`` or ``"left"``.

    Two loads of zero magnitude measure the travel of the piston, and the distance of the contact point from
    the drum's centre.

    References
    ----------
    Yoo et al. (1997), section 3, stage 1.

    Examples
    --------
    >>> len(forklift.build_seating_mechanism(forklift.BENDIX_12_5, 0.0106).joints) > 0
    True
    """
    drawn = geometry.tip, geometry.adjuster, _contact(geometry, clearance)
    tip, adjuster, contact = (_on_side(side, p) for p in drawn)
    names = f"{side} shoe", f"{side} dummy", f"{side} piston"
    joints = Pin(f"{side} adjuster pin", names[0], GROUND, adjuster), *_piston_side(geometry, side, tip)
    loads = _measure(side, tip), CablePair("clearance", names[0], GROUND, contact, _ORIGIN, 0.0)
    return Mechanism(names, joints, loads)


def build_turning_mechanism(geometry: DuoServo, right_tip: Point, left_tip: Point) -> Mechanism:
    """Build the mechanism of stage 2, drawn with seated linings and with the tips at given points [m].

    References
    ----------
    Yoo et al. (1997), section 3, stage 2.

    Examples
    --------
    >>> motion = forklift.BENDIX_12_5.move_shoes(0.0106)
    >>> tips = tuple(map(float, motion.right_tip)), tuple(map(float, motion.left_tip))
    >>> len(forklift.build_turning_mechanism(forklift.BENDIX_12_5, *tips).bodies) > 0
    True
    """
    sides = {"right": right_tip, "left": left_tip}
    parts = [f"{side} {part}" for side in sides for part in ("shoe", "dummy", "piston")]
    joints: list[Joint] = [
        Pin("drum bearing", "drum", GROUND, _ORIGIN),
        Pin("weld", "right shoe", "drum", _contact(geometry, 0.0)),
        RotationLock("weld angle", "right shoe", "drum"),
        Pin("seated lining", "left shoe", GROUND, _ORIGIN),
    ]
    for side, tip in sides.items():
        at = _on_side(side, geometry.adjuster)
        joints.append(Pin(f"{side} adjuster pin", f"{side} shoe", "adjuster", at))
        joints += _piston_side(geometry, side, tip)
    loads = (*(_measure(side, tip) for side, tip in sides.items()), Moment("drum", "drum", 0.0))
    return Mechanism(("drum", "adjuster", *parts), tuple(joints), loads)


def _piston_side(geometry: DuoServo, side: str, tip: Point) -> tuple[Joint, ...]:
    """Make one side's joints from shoe to cylinder: tip pin, sliders on tilted face and in cylinder."""
    tilt, dummy, piston = geometry.face_tilt, f"{side} dummy", f"{side} piston"
    face = _on_side(side, (np.sin(tilt), np.cos(tilt)))
    return (
        Pin(f"{side} tip", f"{side} shoe", dummy, tip),
        Slot(f"{side} face", dummy, piston, tip, face),
        RotationLock(f"{side} face angle", dummy, piston),
        Slot(f"{side} cylinder", piston, GROUND, tip, (1.0, 0.0)),
        RotationLock(f"{side} cylinder angle", piston, GROUND),
    )


def _measure(side: str, tip: Point) -> Force:
    """Make a load of zero magnitude that measures the outward travel of a side's piston."""
    return Force(side, f"{side} piston", tip, _on_side(side, (1.0, 0.0)), 0.0)


def _on_side(side: str, p: Point) -> Point:
    """Return a point of the right side, or for the left side its mirror image."""
    return (float(p[0]), float(p[1])) if side == "right" else (-float(p[0]), float(p[1]))


def _contact(geometry: DuoServo, c: float) -> Point:
    """Compute the contact point of the right lining with the drum at a clearance c [m]."""
    radius, angle = geometry.drum_radius - c, geometry.contact_angle
    return radius * np.cos(angle), radius * np.sin(angle)


def constraint_rank(position: Position) -> tuple[np.ndarray, np.ndarray]:
    """Compute the rank of the constraints at each position, and their smallest singular value.

    Parameters
    ----------
    position : Position
        One position, or S of them.

    Returns
    -------
    rank : ndarray of int, shape (S,)
        Number of independent constraint equations.
    least : ndarray, shape (S,)
        Smallest singular value of the constraints over the largest.

    References
    ----------
    Standard: the rank of the constraints' Jacobian; Yoo et al. (1997), section 3.

    Examples
    --------
    >>> seating = forklift.build_seating_mechanism(forklift.BENDIX_12_5, 0.0106)
    >>> rank, least = forklift.constraint_rank(planar.assemble(seating))
    >>> bool((least > 0).all())
    True
    """
    system = position.mechanism.system
    rows = system.rows(position.batch).gradient[:, : system.constraints]
    values = np.linalg.svd(rows, compute_uv=False)
    relative = values / values[:, :1]
    return (relative > _RANK_TOLERANCE).sum(axis=1), relative[:, -1]
