"""A block on a round drum, by hand: the friction turns the lever about its fulcrum.

500 N at 600 mm, the block at 250 mm, the fulcrum 50 mm beside the line of friction, coefficient 0.4, radius
150 mm: N = 500 * 600 / (250 -+ 0.4 * 50), torque 0.4 * 150 mm * N.
"""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from brakes.answers.caliper import MECHANISM
from brakes.planar import GROUND, Contact, Force, Mechanism, Moment, Pin, solve_with_friction, stroke

EXAMPLE = tomllib.loads(Path("examples/block_brake.toml").read_text())
PUSHED, PULLED = (0.4 * 0.15 * 500 * 0.6 / (0.25 + side * 0.4 * 0.05) for side in (-1, 1))  # N m


def without_friction_of_the_axle(**contact: Any) -> dict[str, Any]:
    """The example's tables, with its drum turned by 30 deg on an axle without friction."""
    axles = [
        {key: value for key, value in pin.items() if key not in ("radius", "friction")}
        for pin in EXAMPLE["pin"]
    ]
    block = {**EXAMPLE["contact"][0], **contact}
    block = {key: value for key, value in block.items() if value is not None}
    return EXAMPLE | {"pin": axles, "contact": [block], "run": {"driver": "torque", "travel": "30 deg"}}


def test_the_torque_stays_while_the_drum_turns():
    answer = MECHANISM.answer(without_friction_of_the_axle(), "test")
    assert np.isclose(PUSHED, 78.2608695652, rtol=1e-12) and np.isclose(PULLED, 66.6666666667, rtol=1e-12)
    over = answer.friction.over
    np.testing.assert_allclose(over.squeeze.amplitudes["torque"], PUSHED, rtol=1e-13)
    np.testing.assert_allclose(over.release.amplitudes["torque"], -PULLED, rtol=1e-13)
    assert not answer.warnings and not answer.refusals


def test_a_straight_face_that_turns_is_warned_of():
    tables = without_friction_of_the_axle(centre=None, normal=[0, 1])
    answer = MECHANISM.answer(tables, "test")
    assert any("straight face, which turns with 'drum' by 30 deg" in warning for warning in answer.warnings)
    unturned = MECHANISM.answer(tables | {"run": {"driver": "torque"}}, "test")
    assert not any("straight face" in warning for warning in unturned.warnings)


def test_a_block_within_a_hollow_drum_pushes_outward():
    """The block at the same place, on the other side of the face: the force of the hand is reversed."""
    joints = (
        Pin("fulcrum", "lever", GROUND, (0, 0)),
        Pin("axle", "drum", GROUND, (0.25, -0.2)),
        Contact("block", "lever", "drum", (0.25, -0.05), (0, -1), friction=0.4, centre=(0.25, -0.2)),
    )
    loads = (Force("hand", "lever", (0.6, 0), (0, 1), 500.0), Moment("torque", "drum"))
    drum = Mechanism(("lever", "drum"), joints, loads)
    turned = stroke(drum, "torque", np.linspace(0, 0.5, 5)).position
    found = solve_with_friction(drum, "torque", turned)
    np.testing.assert_allclose(found.without.magnitudes["block"], 500 * 0.6 / 0.25, rtol=1e-13)
    sizes = np.sort(np.abs([found.squeeze.amplitudes["torque"][-1], found.release.amplitudes["torque"][-1]]))
    np.testing.assert_allclose(sizes, sorted((PUSHED, PULLED)), rtol=1e-13)


@pytest.mark.parametrize(
    ("inputs", "said"),
    [
        ({}, "has no normal"),
        ({"radius": 0.1, "normal": (0, 1)}, "has a radius but no centre"),
        ({"centre": (0, 1), "on": (0, 2)}, "give no `on`"),
        ({"centre": (0, 1), "normal": (1, 0)}, "its normal must point from the centre"),
        ({"centre": (0, 0)}, "move the point or the centre"),
    ],
)
def test_faces_without_meaning_are_refused(inputs: dict[str, Any], said: str):
    with pytest.raises(ValueError, match=said):
        Contact("block", "lever", "drum", (0, 0), **inputs)
