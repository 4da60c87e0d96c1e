"""Published problems of statics, solved by `brakes.planar` and compared to the printed digits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from brakes.planar import (
    GROUND,
    Bar,
    CablePair,
    Contact,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    solve,
    stroke,
)

DOWN, UP, LEFT, RIGHT = (0, -1), (0, 1), (-1, 0), (1, 0)


def at_angle(degrees: float, length: float = 1.0) -> tuple[float, float]:
    return length * math.cos(math.radians(degrees)), length * math.sin(math.radians(degrees))


def determined(mechanism: Mechanism):
    answer = solve(mechanism)
    assert answer.status == "determined"
    assert answer.virtual_work < 1e-13  # rounding of some ten sums
    return answer


def test_compound_bolt_cutter():
    """45 lb on each handle give 252 lb at the jaw pins and 840 lb on the bolt; nothing holds it in space."""
    cutter = Mechanism(
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
    answer = solve(cutter)
    assert answer.status == "loose"
    assert answer.loose == cutter.bodies
    assert answer.magnitudes["upper jaw pin"] == pytest.approx(252, rel=1e-12)  # exact in the problem
    assert answer.magnitudes["bolt"] == pytest.approx(-840, rel=1e-12)


def test_hibbeler_14e_6_80_toggle_clamp():
    """a = F = 1: link CD at 30 degrees from the vertical, arm ABE."""
    link = at_angle(60)
    clamp = Mechanism(
        ("handle", "arm"),
        (
            Pin("B", "arm", "handle", (0, 0)),
            Bar("CD", "handle", GROUND, (0.5, 0.5), (0.5 + link[0], 0.5 + link[1])),
            Pin("A", "arm", GROUND, (0, -1)),
            Contact("E", "arm", GROUND, (1.5, -1), UP),
        ),
        (Force("F", "handle", (2, 0.3), DOWN, 1.0),),
    )
    answer = determined(clamp)
    assert answer.magnitudes["CD"] == pytest.approx(10.9282, abs=5e-5)  # printed digits
    assert answer.reactions["B"][0] == pytest.approx(5.4641, abs=5e-5)
    assert answer.magnitudes["E"] == pytest.approx(3.6427, abs=5e-5)


def test_hibbeler_14e_6_82_vise_grip():
    """5 lb on the grip; jaw force along a normal 20 degrees off."""
    x, y = at_angle(70)
    grip = Mechanism(
        ("grip", "jaw"),
        (
            Pin("E", "grip", "jaw", (0, 0)),
            Bar("CD", "grip", GROUND, (1, 0), (4, 1.75)),
            Pin("B", "jaw", GROUND, (0, 1.75)),
            Contact("A", "jaw", GROUND, (-1.5, 1.75 + 0.75), (-y, -x)),
        ),
        (Force("hand", "grip", (4, 0), UP, 5.0),),
    )
    grip_normal = (-math.sin(math.radians(20)), -math.cos(math.radians(20)))
    grip = Mechanism(
        grip.bodies, (*grip.joints[:3], Contact("A", "jaw", GROUND, (-1.5, 2.5), grip_normal)), grip.loads
    )
    answer = determined(grip)
    assert abs(answer.magnitudes["CD"]) == pytest.approx(39.693, abs=5e-4)
    assert abs(answer.reactions["E"][0]) == pytest.approx(34.286, abs=5e-4)
    assert abs(answer.magnitudes["A"]) == pytest.approx(36.013, abs=5e-4)


def test_beer_johnston_6_133a_whitworth():
    """A lever with a slot over the pin of a crank of 0.1 m."""
    mechanism = Mechanism(
        ("lever", "crank"),
        (
            Pin("lever pivot", "lever", GROUND, (0, 0)),
            Pin("crank pivot", "crank", GROUND, (0, 0.4)),
            Slot("slot", "crank", "lever", (0, 0.5), along=UP),
        ),
        (Force("P", "lever", (0, 0.7), LEFT, 1200.0), Moment("M", "crank")),
    )
    answer = determined(mechanism)
    assert abs(answer.magnitudes["slot"]) == pytest.approx(1680, rel=1e-12)  # exact in the problem
    assert abs(answer.amplitudes["M"]) == pytest.approx(168, rel=1e-12)


def test_beer_johnston_sample_6_4_frame():
    """Frame of ACE and BCD with the link DE, mm and N: Vector Mechanics, Statics, Sample Problem 6.4."""
    a, b, c, d, e = (0, 0), (0, -160), (0, -220), (250, -220), (100, -300)
    frame = Mechanism(
        ("ACE", "BCD"),
        (
            Pin("A", "ACE", GROUND, a),
            Contact("B", "BCD", GROUND, b, RIGHT),
            Pin("C", "BCD", "ACE", c),
            Bar("DE", "BCD", "ACE", d, e),
        ),
        (Force("load", "BCD", (100, -220), DOWN, 480.0),),
    )
    answer = determined(frame)
    assert answer.magnitudes["DE"] == pytest.approx(-561, abs=0.5)
    assert answer.reactions["C"] == pytest.approx((-795, 216), abs=0.5)
    assert answer.reactions["A"] == pytest.approx((-300, 480), abs=0.5)
    assert answer.magnitudes["B"] == pytest.approx(300, abs=0.5)


def test_beer_johnston_sample_6_5_frame():
    """Frame of ABE, ACF and BCD with 2400 N at D: Vector Mechanics, Statics, Sample Problem 6.5."""
    frame = Mechanism(
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
    answer = determined(frame)
    expected = {"A": (0, -1800), "B": (0, 1200), "C": (0, 3600), "E": (0, 600), "F": (0, 1800)}
    for name, force in expected.items():
        assert answer.reactions[name] == pytest.approx(force, abs=1e-9), name  # exact in the problem


def test_meriam_kraige_sample_4_6_frame_with_pulley():
    """400 kg on a cable over a pulley of 0.5 m: Engineering Mechanics, Statics, Sample Problem 4/6."""
    weight = 0.4 * 9.81  # kN
    frame = Mechanism(
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
            Force("weight", "pulley", (5.5, 3), DOWN, weight),
            CablePair("cable", "pulley", "AD", (5, 3.5), (0, 3.5)),
        ),
    )
    answer = determined(frame)
    assert answer.amplitudes["cable"] == pytest.approx(3.92, abs=5e-3)
    assert answer.reactions["A"] == pytest.approx((4.32, 3.92), abs=5e-3)
    assert answer.magnitudes["D"] == pytest.approx(4.32, abs=5e-3)
    assert np.abs(answer.reactions["E"]) == pytest.approx((13.08, 6.54), abs=5e-3)
    assert abs(answer.reactions["B"][1]) == pytest.approx(2.62, abs=5e-3)


def test_hibbeler_compound_beam():
    """Beam fixed at A, hinged at B, roller at C: 10 kN on a slope of 3-4-5 and 8 kN (section 6.6)."""
    beam = Mechanism(
        ("AB", "BC"),
        (
            Pin("A", "AB", GROUND, (0, 0)),
            RotationLock("fixed end", "AB", GROUND),
            Pin("B", "BC", "AB", (4, 0)),
            Contact("C", "BC", GROUND, (6, 0), UP),
        ),
        (Force("10 kN", "AB", (2, 0), (-3, -4), 10.0), Force("4 kN/m", "BC", (5, 0), DOWN, 8.0)),
    )
    answer = determined(beam)
    assert answer.mobility == 0
    assert answer.reactions["A"] == pytest.approx((6, 12), abs=1e-12)  # exact in the problem
    assert answer.magnitudes["fixed end"] == pytest.approx(32, rel=1e-12)
    assert answer.reactions["B"] == pytest.approx((0, 4), abs=1e-12)
    assert answer.magnitudes["C"] == pytest.approx(4, rel=1e-12)


def test_hibbeler_frame_of_two_members():
    """Beam BC with 2000 N at its middle, strut AB at 60 degrees: C is 577 N and 1000 N (section 6.6)."""
    frame = Mechanism(
        ("BC", "AB"),
        (
            Pin("C", "BC", GROUND, (4, 0)),
            Pin("B", "BC", "AB", (0, 0)),
            Pin("A", "AB", GROUND, at_angle(-120, 3 / math.sin(math.radians(60)))),
        ),
        (Force("2 kN", "BC", (2, 0), DOWN, 2000.0),),
    )
    answer = determined(frame)
    assert np.abs(answer.reactions["C"]) == pytest.approx((577, 1000), abs=0.5)
    assert answer.magnitudes["B"] == pytest.approx(1154.7, abs=0.05)


@pytest.mark.parametrize("angle", [25.0, 45.0, 70.0])
def test_cantilever_brake_by_hand(angle: float):
    """N/T = PC/(2 PS sin(alpha)): yoke legs at alpha from the horizontal, arm PC normal to the leg."""
    pivot, pad_arm = (0.04, 0.0), 0.025
    anchor, yoke = (0.08, 0.05), (0.0, 0.05 + 0.08 * math.tan(math.radians(angle)))
    pad = (0.03, pad_arm)
    brake = Mechanism(
        ("arm", "yoke"),
        (
            Pin("P", "arm", GROUND, pivot),
            Slot("symmetry", "yoke", GROUND, yoke, along=UP),
            RotationLock("upright", "yoke", GROUND),
            Bar("leg", "arm", "yoke", anchor, yoke),
        ),
        (Force("main cable", "yoke", yoke, UP, 0.5), Force("pad", "arm", pad, RIGHT)),
    )
    answer = determined(brake)
    cosine, sine = at_angle(angle)
    arm = abs((anchor[0] - pivot[0]) * sine + (anchor[1] - pivot[1]) * cosine)
    expected = arm / (2 * pad_arm * sine)
    assert answer.amplitudes["pad"] == pytest.approx(expected, rel=1e-13)  # rounding
    rate = stroke(brake, "main cable", [0.0]).ratio["pad"][0]
    assert 2 * expected * rate == pytest.approx(-1.0, rel=1e-13)
