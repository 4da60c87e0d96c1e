"""Friction against closed forms: the friction circle, the inclined plane, self-locking on either branch."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from benchmarks.cases import mechanisms as ee
from brakes.planar import (
    GROUND,
    Contact,
    Force,
    Mechanism,
    Pin,
    RotationLock,
    Slot,
    free_body,
    solve,
    solve_with_friction,
    stroke,
)

ROUNDING = 1e-13  # of Newton's last step


def lever(friction: float, radius: float = 0.02) -> Mechanism:
    """A balance beam of arms 0.5 and 0.2 m: 10 N on the short arm lifted by the long one."""
    return Mechanism(
        ("lever",),
        (Pin("pivot", "lever", GROUND, (0, 0), radius=radius, friction=friction),),
        (Force("hand", "lever", (0.5, 0), (0, -1)), Force("weight", "lever", (-0.2, 0), (0, -1), 10.0)),
    )


def ramp(slope: float, friction: float, joint: type = Slot) -> Mechanism:
    """10 N pushed up a slope by a horizontal force."""
    along, normal = (math.cos(slope), math.sin(slope)), (-math.sin(slope), math.cos(slope))
    side = (
        Slot("ramp", "block", GROUND, (0, 0), along, friction=friction)
        if joint is Slot
        else Contact("ramp", "block", GROUND, (0, 0), normal, friction=friction)
    )
    return Mechanism(
        ("block",),
        (side, RotationLock("upright", "block", GROUND)),
        (Force("push", "block", (0, 0), (1, 0)), Force("weight", "block", (0, 0), (0, -1), 10.0)),
    )


def test_pivot_against_the_friction_circle():
    """The resultant P + Q is tangent to the circle of radius r sin(phi): P (a -+ r') = Q (b +- r')."""
    mu, radius = 0.3, 0.02
    circle = radius * math.sin(math.atan(mu))
    both = solve_with_friction(lever(mu), "hand")
    assert both.without.amplitudes["hand"] == pytest.approx(4.0, rel=ROUNDING)
    squeeze, release = both.squeeze.amplitudes["hand"], both.release.amplitudes["hand"]
    assert squeeze == pytest.approx(10 * (0.2 + circle) / (0.5 - circle), rel=ROUNDING)
    assert release == pytest.approx(10 * (0.2 - circle) / (0.5 + circle), rel=ROUNDING)
    assert both.squeeze.friction["pivot"] == pytest.approx(circle * (10 + squeeze), rel=ROUNDING)
    assert both.squeeze.virtual_work < 1e-14


@pytest.mark.parametrize("joint", [Slot, Contact])
def test_inclined_plane(joint: type):
    slope, mu = 0.4, 0.2
    both = solve_with_friction(ramp(slope, mu, joint), "push")
    phi = math.atan(mu)
    assert both.squeeze.amplitudes["push"] == pytest.approx(10 * math.tan(slope + phi), rel=ROUNDING)
    assert both.release.amplitudes["push"] == pytest.approx(10 * math.tan(slope - phi), rel=ROUNDING)


def test_self_locking_keeps_its_flag_and_gives_the_force():
    """A block that stays on its slope by itself is pulled down: tan(slope - phi) of its weight, below 0."""
    release = solve_with_friction(ramp(0.1, 0.2), "push").release
    assert release.status == "self-locking"
    assert "'ramp'" in release.message and "'push' has to act the other way" in release.message
    assert release.amplitudes["push"] == pytest.approx(10 * math.tan(0.1 - math.atan(0.2)), rel=ROUNDING)
    assert release.virtual_work < 1e-14


def test_a_wedge_that_stays_in_is_pulled_out_by_a_known_force():
    """A wedge of 10 deg between ground and a load of 5 kN that is guided upright, friction 0.3 on both faces:
    out with W (tan(phi - slope) + tan(phi)), in with W (tan(phi + slope) + tan(phi))."""
    slope, mu, weight = math.radians(10), 0.3, 5000.0
    face = math.sin(slope), math.cos(slope)
    wedge = Mechanism(
        ("wedge", "load"),
        (
            Contact("floor", "wedge", GROUND, (0, 0), (0, 1), friction=mu),
            RotationLock("flat", "wedge", GROUND),
            Contact("face", "load", "wedge", (0, 0.05), face, friction=mu),
            Slot("guide", "load", GROUND, (0, 0.05), (0, 1)),
            RotationLock("upright", "load", GROUND),
        ),
        (Force("push", "wedge", (0, 0), (1, 0)), Force("weight", "load", (0, 0.05), (0, -1), weight)),
    )
    both, phi = solve_with_friction(wedge, "push"), math.atan(mu)
    assert both.squeeze.amplitudes["push"] == pytest.approx(
        weight * (math.tan(phi + slope) + math.tan(phi)), rel=ROUNDING
    )
    assert both.release.status == "self-locking"
    assert both.release.amplitudes["push"] == pytest.approx(
        -weight * (math.tan(phi - slope) + math.tan(phi)), rel=ROUNDING
    )


@pytest.mark.parametrize("mu", [(1 - 1e-12) / math.tan(math.radians(50)), 1.2, 3.0, 30.0])
def test_jamming_on_squeeze_is_a_status(mu: float):
    """No push moves the block up if slope + phi is 90 degrees or more."""
    slope = math.radians(50)
    assert slope + math.atan(mu) > math.pi / 2 - 1e-11
    jammed = solve_with_friction(ramp(slope, mu), "push").squeeze
    assert jammed.status == "self-locking" and "no size of 'push'" in jammed.message
    assert np.isnan(jammed.amplitudes["push"])
    assert all(np.isnan(force).all() for force in jammed.reactions.values())
    below = solve_with_friction(ramp(slope, 0.83), "push").squeeze
    assert below.amplitudes["push"] == pytest.approx(10 * math.tan(slope + math.atan(0.83)), rel=1e-10)


def test_stroke_of_the_eebrake_between_squeeze_and_release():
    pins = [replace(j, radius=3e-3, friction=0.15) if isinstance(j, Pin) else j for j in ee.JOINTS]
    brake = ee.eebrake(joints=pins)
    run = stroke(brake, "cable", np.linspace(0, 3.5e-3, 7))
    both = solve_with_friction(brake, "cable", run.position)
    tension = [result.amplitudes["cable"] for result in (both.release, both.without, both.squeeze)]
    assert (np.diff(tension, axis=0) > 0).all()
    for result in (both.release, both.squeeze):
        assert result.virtual_work.max() < 1e-14
        assert result.residual.max() < 1e-14
        for name in ("pivot R", "pivot L", "O"):
            circle = 3e-3 * math.sin(math.atan(0.15))
            assert np.abs(result.friction[name]) == pytest.approx(
                circle * result.magnitudes[name], rel=ROUNDING
            )
    actions = free_body(both.squeeze, "V", 3)
    assert "friction of O" in [action.name for action in actions]
    assert sum(a.couple for a in actions) == pytest.approx(both.squeeze.friction["O"][3], rel=ROUNDING)
    moment = sum(a.at[0] * a.force[1] - a.at[1] * a.force[0] for a in actions if a.force.any())
    assert moment == pytest.approx(-both.squeeze.friction["O"][3], abs=1e-15)


def test_friction_vanishes_with_its_coefficient():
    both = solve_with_friction(lever(1e-9), "hand")
    assert both.squeeze.amplitudes["hand"] == pytest.approx(4.0, rel=1e-9)
    none = solve_with_friction(lever(0.0, radius=0.0), "hand")
    assert none.squeeze.amplitudes["hand"] == none.release.amplitudes["hand"] == pytest.approx(4.0, rel=1e-15)


def test_what_is_not_determined_without_friction_is_refused():
    rims = (Contact("rim R", "R", GROUND, ee.PAD_R, (1, 0)), Contact("rim L", "L", GROUND, ee.PAD_L, (-1, 0)))
    with pytest.raises(ValueError, match="here the mobility is 0, and statically indeterminate"):
        solve_with_friction(ee.eebrake(1.0, 0.0, 0.0, (*ee.JOINTS, *rims)), "cable")


def test_frictionless_solve_ignores_coefficients():
    assert solve(lever(0.5)).amplitudes["hand"] == pytest.approx(4.0, rel=1e-15)


def test_without_loads_there_is_no_friction():
    unloaded = replace(lever(0.3), loads=(lever(0.3).loads[0],))
    both = solve_with_friction(unloaded, "hand")
    assert both.squeeze.status == both.release.status == "determined"
    assert both.squeeze.amplitudes["hand"] == both.squeeze.friction["pivot"] == 0.0


def test_a_contact_that_friction_opens_is_named():
    """Pulled high up, a plank whose front rubs lifts its rear: N_f = 20, N_r = -10, pull 10 N."""
    plank = Mechanism(
        ("plank",),
        (
            Contact("rear", "plank", GROUND, (-0.1, 0), (0, 1)),
            Slot("front", "plank", GROUND, (0.1, 0), (1, 0), friction=0.5),
        ),
        (Force("pull", "plank", (0.1, 0.3), (1, 0)), Force("weight", "plank", (0, 0), (0, -1), 10.0)),
    )
    both = solve_with_friction(plank, "pull")
    assert both.without.status == "determined"
    assert (both.squeeze.status, both.squeeze.open_or_slack) == ("contact opens", ("rear",))
    assert "contact 'rear' would have to pull with 10 N" in both.squeeze.message
