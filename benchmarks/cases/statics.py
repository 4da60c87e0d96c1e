"""Textbook problems of statics as mechanisms, solved by the package in the books' units.

`brakes/published/statics.toml` has the results printed in the books.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from brakes.planar import (
    GROUND,
    Bar,
    CablePair,
    Contact,
    Equilibrium,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    solve,
)

DOWN, UP, LEFT, RIGHT = (0, -1), (0, 1), (-1, 0), (1, 0)
Answers = dict[str, tuple[float, ...]]


def at_angle(degrees: float, length: float = 1.0) -> tuple[float, float]:
    return length * math.cos(math.radians(degrees)), length * math.sin(math.radians(degrees))


@dataclass(frozen=True)
class Problem:
    """A mechanism, and the results of its equilibrium that a book prints."""

    mechanism: Callable[[], Mechanism]
    read: Callable[[Equilibrium], dict[str, np.ndarray]]

    def answers(self) -> Answers:
        """Solve the problem; return each answer, a value or the components of a force, by name."""
        read = self.read(solve(self.mechanism()))
        return {name: tuple(map(float, np.atleast_1d(found))) for name, found in read.items()}


def _compound_bolt_cutter() -> Mechanism:
    """Build a compound bolt cutter, not fixed to the ground; the bolt is a bar."""
    return Mechanism(
        ("upper handle", "lower handle", "upper jaw", "lower jaw"),
        (
            Pin("handles", "upper handle", "lower handle", (0, 0)),
            Pin("upper jaw pin", "upper jaw", "upper handle", (-1.25, 0.4)),
            Pin("lower jaw pin", "lower jaw", "lower handle", (-1.25, -0.4)),
            Bar("link", "upper jaw", "lower jaw", (-3.75, 0.4), (-3.75, -0.4)),
            Bar("bolt", "upper jaw", "lower jaw", (-4.5, 0.2), (-4.5, -0.2)),
        ),
        (
            Force("upper hand", "upper handle", (7, 1), DOWN, 45.0),
            Force("lower hand", "lower handle", (7, -1), UP, 45.0),
        ),
    )


def _toggle_clamp() -> Mechanism:
    """Build a toggle clamp with a = F = 1: link CD at 30 degrees from the vertical, arm ABE."""
    link = at_angle(60)
    return Mechanism(
        ("handle", "arm"),
        (
            Pin("B", "arm", "handle", (0, 0)),
            Bar("CD", "handle", GROUND, (0.5, 0.5), (0.5 + link[0], 0.5 + link[1])),
            Pin("A", "arm", GROUND, (0, -1)),
            Contact("E", "arm", GROUND, (1.5, -1), UP),
        ),
        (Force("F", "handle", (2, 0.3), DOWN, 1.0),),
    )


def _vise_grip() -> Mechanism:
    """Build vise grips with the jaw force at 20 degrees to the jaw's normal."""
    normal = (-math.sin(math.radians(20)), -math.cos(math.radians(20)))
    return Mechanism(
        ("grip", "jaw"),
        (
            Pin("E", "grip", "jaw", (0, 0)),
            Bar("CD", "grip", GROUND, (1, 0), (4, 1.75)),
            Pin("B", "jaw", GROUND, (0, 1.75)),
            Contact("A", "jaw", GROUND, (-1.5, 2.5), normal),
        ),
        (Force("hand", "grip", (4, 0), UP, 5.0),),
    )


def _slotted_lever() -> Mechanism:
    """Build a lever with a slot on the pin of a crank of 0.1 m."""
    return Mechanism(
        ("lever", "crank"),
        (
            Pin("lever pivot", "lever", GROUND, (0, 0)),
            Pin("crank pivot", "crank", GROUND, (0, 0.4)),
            Slot("slot", "crank", "lever", (0, 0.5), along=UP),
        ),
        (Force("P", "lever", (0, 0.7), LEFT, 1200.0), Moment("M", "crank")),
    )


def _frame_with_link() -> Mechanism:
    """Build a frame of ACE and BCD with the link DE, in mm."""
    a, b, c, d, e = (0, 0), (0, -160), (0, -220), (250, -220), (100, -300)
    return Mechanism(
        ("ACE", "BCD"),
        (
            Pin("A", "ACE", GROUND, a),
            Contact("B", "BCD", GROUND, b, RIGHT),
            Pin("C", "BCD", "ACE", c),
            Bar("DE", "BCD", "ACE", d, e),
        ),
        (Force("load", "BCD", (100, -220), DOWN, 480.0),),
    )


def _frame_of_three() -> Mechanism:
    """Build a frame of ABE, ACF and BCD with 2400 N at D."""
    return Mechanism(
        ("ABE", "ACF", "BCD"),
        (
            Pin("A", "ABE", "ACF", (0, 4.8)),
            Pin("B", "ABE", "BCD", (0, 2.4)),
            Pin("C", "BCD", "ACF", (2.4, 2.4)),
            Pin("E", "ABE", GROUND, (0, 0)),
            Contact("F", "ACF", GROUND, (4.8, 0), UP),
        ),
        (Force("load", "BCD", (3.6, 2.4), DOWN, 2400.0),),
    )


def _frame_with_pulley() -> Mechanism:
    """Build a frame with 400 kg on a cable over a pulley of 0.5 m, in kN."""
    return Mechanism(
        ("AD", "BF", "CE", "pulley"),
        (
            Pin("A", "AD", GROUND, (0, 0)),
            Contact("D", "AD", GROUND, (0, 5), LEFT),
            Pin("B", "BF", "AD", (0, 3)),
            Pin("C", "CE", "AD", (0, 1.5)),
            Pin("E", "CE", "BF", (3, 3)),
            Pin("F", "pulley", "BF", (5, 3)),
        ),
        (
            Force("weight", "pulley", (5.5, 3), DOWN, 0.4 * 9.81),
            CablePair("cable", "pulley", "AD", (5, 3.5), (0, 3.5)),
        ),
    )


def _compound_beam() -> Mechanism:
    """Build a beam fixed at A, hinged at B, on a roller at C, with 10 kN on a 3-4-5 slope and 4 kN/m."""
    return Mechanism(
        ("AB", "BC"),
        (
            Pin("A", "AB", GROUND, (0, 0)),
            RotationLock("fixed end", "AB", GROUND),
            Pin("B", "BC", "AB", (4, 0)),
            Contact("C", "BC", GROUND, (6, 0), UP),
        ),
        (Force("10 kN", "AB", (2, 0), (-3, -4), 10.0), Force("4 kN/m", "BC", (5, 0), DOWN, 8.0)),
    )


def _frame_of_two() -> Mechanism:
    """Build beam BC with 2000 N at its middle, and strut AB at 60 degrees."""
    return Mechanism(
        ("BC", "AB"),
        (
            Pin("C", "BC", GROUND, (4, 0)),
            Pin("B", "BC", "AB", (0, 0)),
            Pin("A", "AB", GROUND, at_angle(-120, 3 / math.sin(math.radians(60)))),
        ),
        (Force("2 kN", "BC", (2, 0), DOWN, 2000.0),),
    )


PROBLEMS = {
    "compound_bolt_cutter": Problem(
        _compound_bolt_cutter,
        lambda s: {"jaw_pin": s.magnitudes["upper jaw pin"], "bolt": -s.magnitudes["bolt"]},
    ),
    "toggle_clamp": Problem(
        _toggle_clamp,
        lambda s: {
            "link_CD": s.magnitudes["CD"],
            "pin_B": s.reactions["B"][0],
            "work": s.magnitudes["E"],
        },
    ),
    "vise_grip": Problem(
        _vise_grip,
        lambda s: {
            "link_CD": np.abs(s.magnitudes["CD"]),
            "pin_E": np.abs(s.reactions["E"][0]),
            "jaw": np.abs(s.magnitudes["A"]),
        },
    ),
    "slotted_lever": Problem(
        _slotted_lever,
        lambda s: {"slot": np.abs(s.magnitudes["slot"]), "crank_moment": np.abs(s.amplitudes["M"])},
    ),
    "frame_with_link": Problem(
        _frame_with_link,
        lambda s: {
            "link_DE": s.magnitudes["DE"],
            "pin_C": s.reactions["C"],
            "pin_A": s.reactions["A"],
            "support_B": s.magnitudes["B"],
        },
    ),
    "frame_of_three": Problem(
        _frame_of_three,
        lambda s: {
            **{f"pin_{name}": s.reactions[name] for name in "ABCE"},
            "support_F": s.reactions["F"],
        },
    ),
    "frame_with_pulley": Problem(
        _frame_with_pulley,
        lambda s: {
            "cable": s.amplitudes["cable"],
            "pin_A": s.reactions["A"],
            "support_D": s.magnitudes["D"],
            "pin_E": np.abs(s.reactions["E"]),
            "pin_B": np.abs(s.reactions["B"][1]),
        },
    ),
    "compound_beam": Problem(
        _compound_beam,
        lambda s: {
            "fixed_end": s.reactions["A"],
            "fixed_moment": s.magnitudes["fixed end"],
            "hinge_B": s.reactions["B"],
            "roller_C": s.magnitudes["C"],
        },
    ),
    "frame_of_two": Problem(
        _frame_of_two,
        lambda s: {"pin_C": np.abs(s.reactions["C"]), "pin_B": s.magnitudes["B"]},
    ),
}


def answers() -> dict[str, Answers]:
    """Solve all problems; return their answers by name."""
    return {name: problem.answers() for name, problem in PROBLEMS.items()}


def cantilever_brake(angle: float) -> tuple[Mechanism, float]:
    """Build a cantilever brake with yoke legs at an angle [deg], and compute pad force over tension, N/T.

    N/T = PC / (2 PS sin(angle)): the arm PC normal to the leg, the arm PS of the pad.
    """
    pivot, pad_arm = (0.04, 0.0), 0.025
    anchor, yoke = (0.08, 0.05), (0.0, 0.05 + 0.08 * math.tan(math.radians(angle)))
    brake = Mechanism(
        ("arm", "yoke"),
        (
            Pin("P", "arm", GROUND, pivot),
            Slot("symmetry", "yoke", GROUND, yoke, along=UP),
            RotationLock("upright", "yoke", GROUND),
            Bar("leg", "arm", "yoke", anchor, yoke),
        ),
        (Force("main cable", "yoke", yoke, UP, 0.5), Force("pad", "arm", (0.03, pad_arm), RIGHT)),
    )
    cosine, sine = at_angle(angle)
    arm = abs((anchor[0] - pivot[0]) * sine + (anchor[1] - pivot[1]) * cosine)
    return brake, arm / (2 * pad_arm * sine)
