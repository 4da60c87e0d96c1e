"""What is loose and what is undetermined has a name."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from benchmarks.cases import mechanisms as ee
from brakes.planar import (
    GROUND,
    Bar,
    Cable,
    CablePair,
    Contact,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    assemble,
    free_body,
    solve,
    stroke,
)

RIMS = (Contact("rim R", "R", GROUND, ee.PAD_R, (1, 0)), Contact("rim L", "L", GROUND, ee.PAD_L, (-1, 0)))


def without(name: str) -> tuple:
    return tuple(joint for joint in ee.JOINTS if joint.name != name)


def on_panel(tension: float | None = None, left: float = 1.0) -> Mechanism:
    """The eeBrake on a panel that turns on the mount bolt; the pad forces come from the rim."""
    free = ee.eebrake(tension, left=left)
    joints = tuple(replace(j, other="P") if j.other == GROUND else j for j in free.joints)
    loads = tuple(replace(load, other="P") if isinstance(load, CablePair) else load for load in free.loads)
    return Mechanism(("P", *free.bodies), (*joints, Pin("bolt", "P", GROUND, ee.BOLT)), loads)


def test_strut_removed_leaves_the_right_lever_loose():
    answer = solve(ee.eebrake(joints=without("S")))
    assert answer.status == "no equilibrium"
    assert (answer.loose, answer.undetermined) == (("R",), ())
    assert answer.movable == ("R", "L", "V")
    assert (answer.mobility, answer.uncontrolled, answer.indeterminacy) == (2, 1, 0)
    assert "R turns about (0.0175, -0.019) m" in answer.message
    assert all(np.isnan(size).all() for size in answer.reactions.values())


def test_strut_removed_without_a_load_on_the_right_lever_is_in_balance_but_loose():
    answer = solve(ee.eebrake(right=0.0, joints=without("S")))
    assert (answer.status, answer.loose) == ("loose", ("R",))
    assert answer.residual < 1e-14
    assert answer.amplitudes["cable"] > 0


def test_link_removed_lets_all_three_move():
    answer = solve(ee.eebrake(joints=without("K")))
    assert answer.status == "no equilibrium"
    assert answer.loose == ("R", "L", "V")
    assert (answer.mobility, answer.uncontrolled) == (2, 1)


def test_both_pads_rigid_is_indeterminate_in_all_but_the_tension():
    answer = solve(ee.eebrake(1.0, 0.0, 0.0, (*ee.JOINTS, *RIMS)))
    assert answer.status == "undetermined"
    assert (answer.mobility, answer.indeterminacy, answer.uncontrolled) == (0, 1, 0)
    assert answer.undetermined == (*(j.name for j in ee.JOINTS), "rim R", "rim L")
    assert all(np.isnan(size).all() for size in answer.reactions.values())
    assert answer.amplitudes["cable"] == 1.0
    assert answer.loose == answer.movable == ()


def test_a_determined_part_is_given_beside_an_undetermined_one():
    """A beam on two pins: the forces along it are undetermined, those of the arm on it are not."""
    mechanism = Mechanism(
        ("beam", "arm"),
        (
            Pin("left", "beam", GROUND, (0, 0)),
            Pin("right", "beam", GROUND, (1, 0)),
            Pin("hinge", "arm", "beam", (0.5, 0)),
            Bar("stay", "arm", GROUND, (0.5, 1), (1.5, 1)),
        ),
        (Force("load", "arm", (0.5, 2), (1, 0), 3.0),),
    )
    answer = solve(mechanism)
    assert answer.undetermined == ("left", "right")
    assert answer.magnitudes["stay"] == pytest.approx(-6.0, rel=1e-14)
    assert answer.reactions["hinge"] == pytest.approx((3.0, 0.0), abs=1e-14)
    assert np.isnan(answer.reactions["left"]).all()


def test_one_pad_rigid_is_determined():
    answer = solve(ee.eebrake(1.0, 0.0, 0.0, (*ee.JOINTS, RIMS[0])))
    assert (answer.status, answer.mobility) == ("determined", 0)
    assert answer.magnitudes["rim R"] == pytest.approx(1 / 0.3894391536, rel=1e-9)  # ten digits given
    assert answer.virtual_work < 1e-14  # mobility 0: closure on the ground


def test_panel_free_on_its_bolt_turns_with_all_that_is_on_it():
    balanced, unbalanced = solve(on_panel()), solve(on_panel(0.8))
    turns = "P, R, L and V turn together about (0, 0) m"
    assert (balanced.status, balanced.loose, balanced.mobility) == ("loose", ("P", "R", "L", "V"), 2)
    assert turns in balanced.message
    assert balanced.amplitudes["cable"] == pytest.approx(0.7615204477374768, abs=1e-12)
    assert balanced.reactions["bolt"] == pytest.approx((0, 0), abs=1e-14)
    assert unbalanced.status == "no equilibrium"
    assert unbalanced.loose == ("P", "R", "L", "V")


def test_panel_on_its_bolt_is_held_by_the_balance_of_the_pads():
    """With the force of the left pad unknown, the moments about the bolt make the pads equal."""
    panel = on_panel()
    loads = tuple(replace(load, magnitude=None) if load.name == "pad L" else load for load in panel.loads)
    answer = solve(replace(panel, loads=loads))
    assert answer.status == "determined"
    assert answer.amplitudes["pad L"] == pytest.approx(1.0, abs=1e-13)


def test_a_sliding_body_and_one_without_joints():
    mechanism = Mechanism(
        ("sledge", "stone"),
        (Slot("rail", "sledge", GROUND, (0, 0), along=(1, 0)), RotationLock("upright", "sledge", GROUND)),
        (Force("push", "sledge", (0, 0), (1, 0), 1.0), Force("weight", "stone", (1, 1), (0, -1), 0.0)),
    )
    answer = solve(mechanism)
    assert answer.loose == ("sledge", "stone")
    assert "sledge slides along (1, 0)" in answer.message
    assert "stone moves in 3 independent ways" in answer.message


def test_the_ranks_say_how_sure_they_are():
    sure = solve(ee.eebrake(1.0, 0.0, 0.0, (*ee.JOINTS, *RIMS)))
    assert sure.kept > 1e-3
    assert sure.dropped < 1e-14


def test_a_nearly_parallel_pair_of_bars_is_named_as_weak():
    angle = 3e-6
    bars = (
        Bar("one", "plate", GROUND, (0, 0), (0, -1)),
        Bar("two", "plate", GROUND, (1, 0), (1, -1)),
        Bar("three", "plate", GROUND, (2, 0), (2 + angle, -1)),
    )
    answer = solve(Mechanism(("plate",), bars, (Force("load", "plate", (0.5, 0), (0, -1), 1.0),)))
    assert answer.status == "determined"
    assert any("last digits of the drawing" in warning for warning in answer.warnings)


def test_a_contact_that_pulls_and_a_cable_that_pushes_are_named():
    beam = Mechanism(
        ("beam",),
        (
            Pin("hinge", "beam", GROUND, (0, 0)),
            Contact("stop", "beam", GROUND, (1, 0), (0, -1)),
        ),
        (Force("load", "beam", (2, 0), (0, -1), 1.0),),
    )
    answer = solve(beam)
    assert (answer.status, answer.open_or_slack) == ("contact opens", ("stop",))
    assert answer.message.startswith("contact 'stop' would have to pull with 2 N")
    cable = Cable("stay", ("beam", GROUND), ((1, 0), (1, -1)))
    answer = solve(replace(beam, joints=(beam.joints[0], cable)))
    assert (answer.status, answer.open_or_slack) == ("cable slackens", ("stay",))
    assert answer.message.startswith("cable 'stay' would have to push with 2 N")


def test_what_opens_over_a_stroke_says_at_how_many_positions():
    """A heavy arm leans on a block as long as it leans to the block's side."""
    swing = Mechanism(
        ("arm", "block"),
        (
            Pin("hinge", "arm", GROUND, (0, 0)),
            Slot("rail", "block", GROUND, (0, 1), (1, 0)),
            RotationLock("flat", "block", GROUND),
            Contact("tip", "block", "arm", (0, 1), (1, 0)),
        ),
        (Force("push", "block", (0, 1), (-1, 0)), Force("weight", "arm", (0, 0.5), (0, -1), 1.0)),
    )
    moved = solve(swing, stroke(swing, "push", np.linspace(-0.2, 0.2, 5)).position)
    assert moved.status == "contact opens"
    assert "at 2 of 5 positions" in moved.message


def test_free_bodies_are_in_balance():
    mechanism = ee.eebrake(joints=(*ee.JOINTS[:4], Cable("K", ("V", GROUND, GROUND), (ee.A, ee.G, (0, 0.1)))))
    answer = solve(mechanism)
    for body in (*mechanism.bodies, GROUND):
        actions = free_body(answer, body)
        moments = [a.couple + a.at[0] * a.force[1] - a.at[1] * a.force[0] for a in actions]
        assert np.abs(np.sum([a.force for a in actions], axis=0)).max() < 1e-14
        assert abs(sum(moments)) < 1e-15


def test_free_bodies_hold_couples():
    door = Mechanism(
        ("door",),
        (Pin("hinge", "door", GROUND, (0, 0)), RotationLock("stop", "door", GROUND)),
        (Moment("wind", "door", 2.0),),
    )
    couples = {action.name: action.couple for action in free_body(solve(door), "door")}
    assert couples == {"hinge": 0.0, "stop": -2.0, "wind": 2.0}


def test_the_housing_of_a_gear_is_on_the_ground():
    wheels = Mechanism(
        ("one", "two"),
        (
            Pin("left", "one", GROUND, (0, 0)),
            Pin("right", "two", GROUND, (1, 0)),
            RotationLock("gear", "one", "two", ratio=-2.0),
        ),
        (Moment("drive", "one", 3.0), Moment("load", "two")),
    )
    answer = solve(wheels)
    couples = {
        b: [a.couple for a in free_body(answer, b) if a.name == "gear"] for b in ("one", "two", GROUND)
    }
    assert couples == {
        "one": [pytest.approx(-3.0)],
        "two": [pytest.approx(-6.0)],
        GROUND: [pytest.approx(9.0)],
    }


def test_a_position_serves_mechanisms_with_other_loads():
    brake = ee.eebrake()
    other = replace(brake, loads=(*brake.loads, Force("far", "R", (5.0, 5.0), (1, 0), 0.0)))
    position = assemble(brake)
    assert solve(other, position).amplitudes["cable"] == pytest.approx(0.7615204477374768, abs=1e-12)
    with pytest.raises(ValueError, match="the position is one of bodies"):
        solve(on_panel(), position)


def test_a_body_alone_is_free():
    answer = solve(Mechanism(("stone",)))
    assert (answer.status, answer.mobility, answer.loose) == ("loose", 3, ("stone",))
    assert "stone moves in 3 independent ways" in answer.message
