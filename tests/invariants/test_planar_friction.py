"""Friction gives the same forces wherever, however large and however turned the mechanism is drawn."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from brakes.planar import (
    GROUND,
    Contact,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    solve_with_friction,
)

EPS = np.finfo(float).eps
MU, RADIUS, FORCE = 0.4, 0.15, 500.0
ARM, BLOCK, OFFSET = 0.6, 0.25, 0.05  # of the force, of the block; the drum's surface off the lever's pin [m]


def block_brake() -> Mechanism:
    """A lever presses a block on a drum that a torque turns; without friction the torque is 0."""
    at = BLOCK, -OFFSET
    return Mechanism(
        ("lever", "drum"),
        (
            Pin("fulcrum", "lever", GROUND, (0, 0)),
            Pin("axle", "drum", GROUND, (BLOCK, -OFFSET - RADIUS)),
            Contact("block", "lever", "drum", at, (0, 1), friction=MU),
        ),
        (Force("hand", "lever", (ARM, 0), (0, -1), FORCE), Moment("torque", "drum")),
    )


def wedged_block() -> Mechanism:
    """A block on a slope of 0.1 rad with friction 0.2: it stays by itself, and is pulled down."""
    return Mechanism(
        ("block",),
        (
            Slot("ramp", "block", GROUND, (0, 0), (math.cos(0.1), math.sin(0.1)), friction=0.2),
            RotationLock("upright", "block", GROUND),
        ),
        (Force("push", "block", (0, 0), (1, 0)), Force("weight", "block", (0.1, 0), (0, -1), 100.0)),
    )


def turned(mechanism: Mechanism, length: float, angle: float, shift: complex) -> Mechanism:
    """The mechanism stretched, turned and shifted."""

    def change(part):
        def place(p):
            z = complex(*p) * length * np.exp(1j * angle) + shift
            return z.real, z.imag

        new = {"at": place(part.at)} if hasattr(part, "at") else {}
        for key in ("direction", "normal", "along"):
            if hasattr(part, key):
                z = complex(*getattr(part, key)) * np.exp(1j * angle)
                new[key] = z.real, z.imag
        return dataclasses.replace(part, **new)

    return Mechanism(
        mechanism.bodies, tuple(map(change, mechanism.joints)), tuple(map(change, mechanism.loads))
    )


WAYS = [
    (length, angle, distance)
    for length in (1e-3, 1.0, 1e3)
    for angle in (0.0, 0.3, 2.0, -math.pi / 2)
    for distance in (0.0, 0.1, 1.0, 1e3)
]


@pytest.mark.parametrize("length, angle, distance", WAYS)
def test_the_torque_of_a_block_brake(length: float, angle: float, distance: float):
    """mu r N, with N = P arm / (block - mu offset) while the drum turns anticlockwise, + the other way."""
    shift = distance * length * np.exp(0.7j)
    both = solve_with_friction(turned(block_brake(), length, angle, shift), "torque")
    for way, sign in ((both.squeeze, 1), (both.release, -1)):
        assert way.status == "determined", way.message
        torque = sign * MU * RADIUS * length * FORCE * ARM / (BLOCK - sign * MU * OFFSET)
        rounding = EPS * (1 + distance / RADIUS)
        assert way.amplitudes["torque"] == pytest.approx(torque, rel=1e4 * rounding)
    assert abs(both.without.amplitudes["torque"]) < 1e-9 * FORCE * length


@pytest.mark.parametrize("length, angle, distance", WAYS)
def test_the_force_past_self_locking(length: float, angle: float, distance: float):
    """Only a force that turns with the drawing is the same: the weight does, too."""
    block = turned(wedged_block(), length, angle, distance * length)
    release = solve_with_friction(block, "push").release
    assert release.status == "self-locking"
    expected = 100 * math.tan(0.1 - math.atan(0.2))
    assert release.amplitudes["push"] == pytest.approx(expected, rel=1e4 * EPS * (1 + 10 * distance))


@pytest.mark.parametrize("friction", np.linspace(0.05, 0.7, 14))
def test_self_locking_begins_where_the_force_changes_its_sign(friction: float):
    """tan(slope) is the friction at which the block begins to stay by itself."""
    slope = math.atan(0.3)
    along = math.cos(slope), math.sin(slope)
    ramp = Slot("ramp", "block", GROUND, (0, 0), along, friction=friction)
    block = dataclasses.replace(wedged_block(), joints=(ramp, wedged_block().joints[1]))
    release = solve_with_friction(block, "push").release
    assert (release.status == "self-locking") == (friction > 0.3 + 1e-12)
    assert release.amplitudes["push"] == pytest.approx(
        100 * math.tan(slope - math.atan(friction)), abs=1e-12 * 100
    )
