"""Bad input is refused by a sentence that names the joint and the remedy."""

from __future__ import annotations

import math

import pytest

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
    Spring,
    TorsionSpring,
)

PIN = Pin("pivot", "arm", GROUND, (0, 0))
P, Q = (0.0, 0.0), (1.0, 0.0)


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (
            lambda: Bar("link", "arm", GROUND, P, P),
            r"bar 'link' has zero length at \(0, 0\) m: move one of its ends",
        ),
        (
            lambda: Bar("link", "arm", GROUND, P, Q, length=0),
            "bar 'link': length = 0 m: it must be greater than 0",
        ),
        (lambda: Cable("rope", ("arm",), (P,)), "cable 'rope' has 1 bodies and 1 points: give two or more"),
        (lambda: Cable("rope", ("arm", "b"), (P, P)), "cable 'rope' has zero length"),
        (
            lambda: CablePair("cable", "arm", GROUND, Q, Q),
            "cable pair 'cable' has zero length .* no direction",
        ),
        (lambda: Spring("coil", "arm", GROUND, Q, Q, 1, 1), "spring 'coil' has zero length"),
        (
            lambda: Spring("coil", "arm", GROUND, P, Q, -1, 1),
            "spring 'coil': stiffness = -1 N/m: it must be at least 0 N/m",
        ),
        (lambda: TorsionSpring("coil", "arm", -1, 0), "torsion spring 'coil': stiffness = -1 N m/rad"),
        (
            lambda: Pin("pivot", "arm", GROUND, P, radius=1, friction=-0.1),
            "pin 'pivot': friction = -0.1: .*its absolute value",
        ),
        (lambda: Pin("pivot", "arm", GROUND, P, radius=-1), "pin 'pivot': radius = -1 m"),
        (
            lambda: Pin("pivot", "arm", GROUND, P, friction=0.1),
            "pin 'pivot' has friction but no radius: give",
        ),
        (
            lambda: Pin("pivot", "arm", GROUND, (0, math.nan)),
            "pin 'pivot': at: y = nan m: give a finite number in m",
        ),
        (
            lambda: Pin("pivot", "arm", GROUND, 3.0),
            r"pin 'pivot': at = 3.0: give two coordinates \(x, y\) in m",
        ),
        (lambda: Contact("pad", "arm", GROUND, P, (1, 0), friction=-1), "contact 'pad': friction = -1"),
        (
            lambda: Contact("pad", "arm", GROUND, P, (0, 0)),
            r"contact 'pad': normal = \(0, 0\) has no direction",
        ),
        (lambda: Slot("guide", "arm", GROUND, P, (0, 0)), r"slot 'guide': along = \(0, 0\) has no direction"),
        (lambda: RotationLock("lock", "arm", GROUND, "1"), "rotation lock 'lock': ratio = '1'"),
        (lambda: Force("push", "arm", P, (0, 0)), r"force 'push': direction = \(0, 0\) has no direction"),
        (
            lambda: Force("push", "arm", P, (1, 0), math.inf),
            "force 'push': magnitude = inf N: give a finite number in N; or None for an unknown",
        ),
        (lambda: Moment("turn", "arm", "5 N m"), "moment 'turn': magnitude = '5 N m'"),
    ],
)
def test_joints_and_loads(make, message: str):
    with pytest.raises(ValueError, match=message):
        make()


@pytest.mark.parametrize(
    ("bodies", "joints", "loads", "message"),
    [
        (
            ("arm",),
            [Pin("pivot", "amr", GROUND, P)],
            [],
            "pin 'pivot' is on body 'amr', .*did you mean 'arm'",
        ),
        (
            ("arm",),
            [Pin("p", "arm", "floor", P)],
            [],
            "pin 'p' is on body 'floor', .* known: 'arm', 'ground'",
        ),
        (
            ("arm",),
            [PIN],
            [Force("push", "leg", P, (1, 0))],
            "force 'push' is on body 'leg', which does not exist",
        ),
        (("arm",), [PIN], [Force("push", GROUND, P, (1, 0))], "force 'push' acts on 'ground' alone"),
        (("arm",), [PIN], [CablePair("c", GROUND, GROUND, P, Q)], "cable pair 'c' acts on 'ground' alone"),
        (("arm",), [RotationLock("lock", "arm", "arm")], [], "rotation lock 'lock' acts on 'arm' alone"),
        (("arm",), [Cable("rope", ("arm", "arm"), (P, Q))], [], "cable 'rope' acts on 'arm' alone"),
        (("arm", "arm"), [], [], "body 'arm' occurs twice"),
        (("arm",), [PIN, PIN], [], "joint or load 'pivot' occurs twice: give each its own name"),
        (("arm",), [PIN], [Moment("pivot", "arm")], "joint or load 'pivot' occurs twice"),
        ((), [], [], "name one or more; 'ground' always exists"),
        (("arm", "ground"), [], [], "'ground' always exists"),
        ("arm", [], [], "bodies = 'arm': give a sequence of names"),
    ],
)
def test_mechanisms(bodies, joints, loads, message: str):
    with pytest.raises(ValueError, match=message):
        Mechanism(bodies, joints, loads)
