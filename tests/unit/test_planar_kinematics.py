"""Assembly, strokes, turning points and toggle positions of linkages whose motion is known in closed form."""

from __future__ import annotations

import math

import numpy as np
import pytest

from brakes.planar import (
    GROUND,
    AssemblyError,
    Bar,
    Cable,
    CablePair,
    Contact,
    Force,
    Mechanism,
    Moment,
    OutOfReachError,
    Pin,
    RotationLock,
    Slot,
    Spring,
    TorsionSpring,
    assemble,
    solve,
    stroke,
    trace,
)

CRANK, ROD = 0.1, 0.3
ROUNDING = 1e-14  # of sums of a dozen lengths below 1


def slider(angle):
    return CRANK * np.cos(angle) + np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2)


def slider_crank(start: float = 1.0) -> Mechanism:
    """Crank at an angle, rod, and a slider on the x axis that is pushed by 1 N."""
    pin, end = (CRANK * math.cos(start), CRANK * math.sin(start)), (float(slider(start)), 0.0)
    return Mechanism(
        ("crank", "rod", "slider"),
        (
            Pin("A", "crank", GROUND, (0, 0)),
            Pin("B", "rod", "crank", pin),
            Pin("C", "slider", "rod", end),
            Slot("guide", "slider", GROUND, end, along=(1, 0)),
            RotationLock("upright", "slider", GROUND),
        ),
        (Moment("turn", "crank"), Force("push", "slider", end, (1, 0), 1.0)),
    )


def four_bar(*, redundant: bool = False, base: float = 2.0) -> Mechanism:
    """A parallelogram, and with a third parallel crank if `redundant`."""
    cranks = ("one", "two", "three")[: 3 if redundant else 2]
    joints = [
        pin
        for x, name in zip((0.0, base, 3.0), cranks, strict=False)
        for pin in (Pin(f"{name} foot", name, GROUND, (x, 0)), Pin(f"{name} head", "coupler", name, (x, 1)))
    ]
    return Mechanism(
        (*cranks, "coupler"),
        tuple(joints),
        (Moment("turn", "one"), Force("push", "coupler", (0.5, 1), (1, 0), 1.0)),
    )


def test_a_turn_of_the_crank_against_the_closed_form():
    run = stroke(slider_crank(), "turn", np.linspace(0, 2 * math.pi, 73))
    angle = 1.0 + run.values
    assert np.allclose(run.travel["push"], slider(angle) - slider(1.0), rtol=0, atol=ROUNDING)
    rate = (
        -CRANK * np.sin(angle) * (1 + CRANK * np.cos(angle) / np.sqrt(ROD**2 - (CRANK * np.sin(angle)) ** 2))
    )
    assert np.allclose(run.ratio["push"], rate, rtol=0, atol=ROUNDING)
    assert (run.mobility == 1).all()
    assert run.closure < ROUNDING


def test_values_in_any_order_and_of_either_sign():
    values = [0.4, -0.7, 0.0, 1.1, -0.1]
    run = stroke(slider_crank(), "turn", values)
    assert np.allclose(run.values, values, rtol=0, atol=ROUNDING)
    assert np.allclose(
        run.travel["push"], slider(1.0 + np.array(values)) - slider(1.0), rtol=0, atol=ROUNDING
    )
    for k, value in enumerate(values):
        assert run.position[k].angle("crank") == pytest.approx(value, abs=ROUNDING)
    with pytest.raises(ValueError, match="values is empty"):
        stroke(slider_crank(), "turn", [])


def test_dead_centres_are_found_and_named():
    run = stroke(slider_crank(), "turn", np.linspace(0, 2 * math.pi, 5))
    first, second = run.toggles
    assert (first.load, first.still) == ("push", ("slider",))
    assert 1.0 + first.value == pytest.approx(math.pi, abs=ROUNDING)
    assert 1.0 + second.value == pytest.approx(2 * math.pi, abs=ROUNDING)
    assert "toggle position of 'push'" in first.message
    assert "slider stands still" in first.message


def test_toggles_beyond_the_stroke_are_not_reported():
    short = math.pi - 1.01
    assert stroke(slider_crank(), "turn", [0.0, short]).toggles == ()
    assert stroke(slider_crank(), "turn", [-0.99]).toggles == ()
    assert len(stroke(slider_crank(), "turn", [-1.01, 0.3]).toggles) == 1


def test_a_driver_past_its_toggle_is_refused_with_the_place():
    reach = CRANK + ROD - slider(1.0)
    with pytest.raises(
        OutOfReachError, match=r"'push' cannot reach 0\.1 m: it turns back at 0\.0580127139 m"
    ):
        stroke(slider_crank(), "push", [0.0, 0.1])
    run = stroke(slider_crank(), "push", [reach * (1 - 1e-6)])
    assert slider(1.0 + run.travel["turn"][0]) == pytest.approx(
        slider(1.0) + reach * (1 - 1e-6), abs=ROUNDING
    )


def test_arc_length_passes_the_turning_points():
    run = trace(slider_crank(), "push", length=2.0, points=401)
    angle = 1.0 + run.travel["turn"]
    assert angle[-1] < -2 * math.pi
    assert np.allclose(run.travel["push"], slider(angle) - slider(1.0), rtol=0, atol=ROUNDING)
    assert {toggle.load for toggle in run.toggles} == {"push"}
    step = np.linalg.norm(np.diff(run.position.coordinates, axis=0), axis=1)
    assert step == pytest.approx(
        np.full(400, step.mean()), rel=0.01
    )  # arcs between nodes are circles to third order
    assert step.sum() * slider_crank().system.length == pytest.approx(2.0, rel=1e-4)  # chords


def test_a_drawing_that_does_not_close_is_assembled():
    joints = (
        Pin("A", "crank", GROUND, (0, 0)),
        Bar("rod", "crank", "slider", (0.05, 0.09), (0.33, 0.01), length=ROD),
        Slot("guide", "slider", GROUND, (0.33, 0.01), along=(1, 0), on=(0, 0)),
        RotationLock("upright", "slider", GROUND),
    )
    place = assemble(Mechanism(("crank", "slider"), joints))
    pin, end = place.point("crank", (0.05, 0.09)), place.point("slider", (0.33, 0.01))
    assert np.linalg.norm(end - pin) == pytest.approx(ROD, abs=ROUNDING)
    assert end[1] == pytest.approx(0.0, abs=ROUNDING)
    assert np.linalg.norm(pin) == pytest.approx(math.hypot(0.05, 0.09), abs=ROUNDING)


def test_pins_that_lie_apart_in_the_drawing_are_brought_together():
    joints = Pin("A", "arm", GROUND, (0, 0)), Pin("B", "arm", GROUND, (1, 0), at_other=(0.6, 0.8))
    place = assemble(Mechanism(("arm",), joints))
    assert place.angle("arm") == pytest.approx(math.atan2(0.8, 0.6), abs=ROUNDING)


def test_what_cannot_be_assembled_says_by_how_much():
    joints = (
        Pin("A", "arm", GROUND, (0, 0)),
        Bar("stay", "arm", GROUND, (1, 0), (3, 0), length=1.5),
    )
    with pytest.raises(AssemblyError, match=r"'stay' stays 0\.5 m apart|'A' stays 0\.\d+ m apart") as error:
        assemble(Mechanism(("arm",), (*joints, RotationLock("stop", "arm", GROUND))))
    assert "check its points" in str(error.value)


def test_a_redundant_parallelogram_moves_and_is_undetermined():
    mechanism = four_bar(redundant=True)
    run = stroke(mechanism, "turn", np.linspace(0, -1.2, 7))
    assert np.allclose(run.travel["push"], np.sin(-run.values), rtol=0, atol=ROUNDING)
    answer = solve(mechanism, run.position)
    assert answer.status == "undetermined"
    assert (answer.indeterminacy == 1).all()
    assert "one foot" in answer.undetermined
    assert -answer.amplitudes["turn"] == pytest.approx(run.ratio["push"], abs=ROUNDING)


def test_cables_of_fixed_length_and_springs():
    """A block and tackle of three falls lifts a third of what is hauled; a spring follows its law."""
    block, hand = (0.0, -1.0), (0.5, 0.0)
    eyes = ((0.0, 0.0), block, (0.0, 0.0), block)
    guides = tuple(
        guide
        for body, at in (("block", block), ("hand", hand))
        for guide in (
            Slot(f"{body} rail", body, GROUND, at, along=(0, 1)),
            RotationLock(f"{body} lock", body, GROUND),
        )
    )
    rope = Cable("rope", (GROUND, "block", GROUND, "hand"), (eyes[0], block, (0.0, 0.0), (0.0, 1.0)))
    rail = Slot("hand rail", "hand", GROUND, (0.0, 1.0), along=(0, 1))
    guides = (*guides[:2], rail, guides[3])
    mechanism = Mechanism(
        ("block", "hand"),
        (*guides, rope),
        (
            Force("haul", "hand", (0.0, 1.0), (0, 1)),
            Force("lift", "block", block, (0, 1), 0.0),
            Spring("spring", "block", GROUND, block, (0.0, -3.0), stiffness=10.0, free_length=1.5),
        ),
    )
    run = stroke(mechanism, "haul", [0.0, 0.3])
    assert run.travel["lift"] == pytest.approx([0.0, 0.15], abs=ROUNDING)
    answer = solve(mechanism, run.position)
    assert answer.amplitudes["spring"] == pytest.approx([5.0, 6.5], abs=1e-13)
    assert answer.magnitudes["rope"] == pytest.approx([2.5, 3.25], abs=1e-13)
    assert answer.amplitudes["haul"] == pytest.approx([2.5, 3.25], abs=1e-13)


def test_torsion_spring_and_gear():
    """Two wheels that turn against each other, one on a spring: the ground holds the gear's housing."""
    mechanism = Mechanism(
        ("one", "two"),
        (
            Pin("one", "one", GROUND, (0, 0)),
            Pin("two", "two", GROUND, (1, 0)),
            RotationLock("gear", "one", "two", ratio=-2.0),
        ),
        (Moment("turn", "one"), TorsionSpring("spring", "two", stiffness=3.0, free_angle=-0.1)),
    )
    run = stroke(mechanism, "turn", [0.0, 0.4])
    assert run.position.angle("two") == pytest.approx([0.0, -0.2], abs=ROUNDING)
    answer = solve(mechanism, run.position)
    assert answer.amplitudes["spring"] == pytest.approx([-0.3, 0.3], abs=ROUNDING)
    assert answer.amplitudes["turn"] == pytest.approx([-0.15, 0.15], abs=ROUNDING)


def test_a_force_that_follows_its_body_stays_at_right_angles():
    lever = Mechanism(
        ("lever",),
        (Pin("pivot", "lever", GROUND, (0, 0)),),
        (Force("hand", "lever", (1, 0), (0, 1), 2.0, follows=True), Moment("turn", "lever")),
    )
    run = stroke(lever, "turn", [0.0, 1.0, 2.0])
    assert solve(lever, run.position).amplitudes["turn"] == pytest.approx([-2.0] * 3, abs=ROUNDING)
    assert run.ratio["hand"] == pytest.approx([1.0] * 3, abs=ROUNDING)
    assert np.isnan(run.travel["hand"]).all()
    with pytest.raises(ValueError, match="'hand' turns with its body"):
        stroke(lever, "hand", [0.1])


def test_contact_face_on_a_moving_body():
    """A follower on the face of a wedge that slides: it rises by the slope."""
    slope = 0.25
    normal = (-slope, 1.0)
    mechanism = Mechanism(
        ("wedge", "follower"),
        (
            Slot("floor", "wedge", GROUND, (0, 0), along=(1, 0)),
            RotationLock("flat", "wedge", GROUND),
            Slot("rail", "follower", GROUND, (0.5, 0.5), along=(0, 1)),
            RotationLock("upright", "follower", GROUND),
            Contact("face", "follower", "wedge", (0.5, 0.5), normal),
        ),
        (Force("drive", "wedge", (0, 0), (-1, 0)), Force("weight", "follower", (0.5, 0.5), (0, -1), 8.0)),
    )
    run = stroke(mechanism, "drive", [0.0, 0.2])
    assert run.travel["weight"] == pytest.approx([0.0, -0.05], abs=ROUNDING)
    answer = solve(mechanism, run.position)
    assert answer.amplitudes["drive"] == pytest.approx([2.0, 2.0], abs=1e-13)
    assert answer.warnings == ()


def test_mobility_other_than_one_is_refused_by_name():
    loose = Mechanism(
        ("left", "right"),
        (Pin("pivot l", "left", GROUND, (0, 0)), Pin("pivot r", "right", GROUND, (1, 0))),
        (CablePair("cable", "left", "right", (0, 1), (1, 1)), Force("still", "left", (0, 0), (1, 0))),
    )
    with pytest.raises(ValueError, match=r"mobility 2; a stroke needs 1: left turns about \(0, 0\) m, right"):
        stroke(loose, "cable", [0.1])
    held = Mechanism(
        loose.bodies, (*loose.joints, RotationLock("mirror", "left", "right", -1.0)), loose.loads
    )
    assert stroke(held, "cable", [0.1]).position.angle("left") == pytest.approx(
        [-math.asin(0.05)], abs=ROUNDING
    )
    with pytest.raises(ValueError, match="driver 'still' stands still"):
        stroke(held, "still", [0.1])
    rigid = Mechanism(held.bodies, (*held.joints, RotationLock("stop", "left", GROUND)), held.loads)
    with pytest.raises(ValueError, match="does not move: mobility 0"):
        stroke(rigid, "cable", [0.1])
    with pytest.raises(ValueError, match="load 'cabel' does not exist; did you mean 'cable'"):
        stroke(held, "cabel", [0.1])


@pytest.mark.parametrize("base", [2.0, 1.0])
def test_bars_in_line_are_a_branch_point(base: float):
    """A parallelogram or rhombus keeps its motion through the position in line, and the branch is named."""
    run = stroke(four_bar(base=base), "turn", np.linspace(0, -2.5, 11))
    assert np.allclose(run.travel["push"], np.sin(-run.values), rtol=0, atol=ROUNDING)
    (branch,) = (toggle for toggle in run.toggles if toggle.load is None)
    assert branch.value == pytest.approx(-math.pi / 2, abs=1e-7)  # the root of rounding: a double root
    assert "motions branch" in branch.message


def test_at_a_branch_point_velocity_ratios_are_nan():
    there = stroke(four_bar(), "turn", [-math.pi / 2])
    assert there.mobility[0] == 2
    assert np.isnan(there.ratio["push"][0])


def test_a_drawing_almost_in_line_is_assembled_by_shortened_steps():
    """The full step from an arm 0.001 rad off the line is a hundred times too long."""
    tip = (math.cos(1e-3), math.sin(1e-3))
    arm = Mechanism(
        ("arm",), (Pin("A", "arm", GROUND, (0, 0)), Bar("stay", "arm", GROUND, tip, (3, 0), length=2.01))
    )
    expected = math.acos((1 + 9 - 2.01**2) / 6)
    assert assemble(arm).angle("arm") == pytest.approx(expected - 1e-3, abs=1e-12)
