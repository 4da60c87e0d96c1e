"""Laws that every caliper keeps: work, symmetry, scale, friction's sign."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest

from beamdyn.common.inputs.described import descriptions
from brakes import calipers
from brakes.planar import Bar, Spring

BUILT = {name: design().build() for name, design in calipers.NAMED.items()}
SYMMETRIC = ("single-pivot", "centre-pull", "cantilever", "v-brake")
named = pytest.mark.parametrize("name", BUILT)


@named
def test_work_of_the_finger_is_that_of_the_pads(name):
    """The pads' work by their slopes from differences of travels, not from the null space."""
    run = BUILT[name].stroke(points=801)
    steps = np.diff(run.pad_travel, axis=0)
    force = (run.pad_force[1:] + run.pad_force[:-1]) / 2
    work = (force * steps).sum()
    assert work == pytest.approx(run.finger_force * run.finger[-1], rel=1e-6)  # trapezoid, 800 steps


@named
def test_virtual_work_and_balance(name):
    run = BUILT[name].stroke()
    assert run.status == "determined" and run.warnings == ()
    assert run.virtual_work.max() < 1e-13 and run.residual.max() < 1e-13  # rounding of some ten sums
    power = (run.pad_force * run.pad_ratio).sum(axis=1)
    assert np.allclose(power, run.tension, rtol=1e-12, atol=0)


@pytest.mark.parametrize("name", SYMMETRIC)
def test_symmetric_calipers_are_symmetric(name):
    run = BUILT[name].stroke()
    assert np.allclose(run.travel_symmetry, 1.0, rtol=0, atol=1e-12)  # rounding
    assert np.allclose(run.force_symmetry, 1.0, rtol=0, atol=1e-11)


@named
def test_the_size_of_a_caliper_does_not_matter(name):
    """Twice the dimensions: the same advantage at twice the travel."""
    design = calipers.NAMED[name]
    units = {key: described.unit for key, described in descriptions(design).items()}
    values = {key: getattr(design(), key) for key in units}
    assert list(units) == [field.name for field in dataclasses.fields(design)]
    doubled = {
        k: tuple(2 * x for x in v) if isinstance(v, tuple) else 2 * v for k, v in values.items() if units[k]
    }
    small, large = BUILT[name].stroke(points=5), design(**doubled).build().stroke(points=5)
    assert large.cable == pytest.approx(2 * small.cable, rel=1e-9, abs=1e-15)  # that of Newton's last step
    assert large.advantage == pytest.approx(small.advantage, rel=1e-9)


@named
def test_forces_grow_with_the_finger(name):
    caliper = BUILT[name]
    one, many = (caliper.stroke(points=3, finger=finger) for finger in (1.0, 250.0))
    assert many.pad_force == pytest.approx(250 * one.pad_force, rel=1e-12)
    assert many.advantage == pytest.approx(one.advantage, rel=1e-12)


@named
def test_friction_takes_force_when_squeezed_and_holds_when_released(name):
    caliper = BUILT[name]
    weak, strong = caliper.friction(0.01), caliper.friction(0.1)
    assert 1 > weak.squeeze > strong.squeeze > 0
    assert 1 > weak.release > strong.release > 0
    # A small friction loses alike both ways, to second order.
    assert 1 - weak.squeeze == pytest.approx(1 - weak.release, rel=0.05)
    assert caliper.friction(0.0).squeeze == pytest.approx(1.0, rel=1e-12)


@named
def test_wear_delays_contact_by_what_is_lost(name):
    wear = BUILT[name].wear([0.0, 0.5e-3])
    assert wear.cable[0] == pytest.approx(BUILT[name].contact, rel=1e-12)
    assert wear.cable[1] > wear.cable[0]
    worn = BUILT[name].worn(0.5e-3)
    travel = worn.stroke([wear.cable[1]]).pad_travel
    assert travel.mean() == pytest.approx(1.75e-3, rel=1e-9)  # clearance and loss
    assert (wear.finger == wear.cable * BUILT[name].lever_ratio).all()


@pytest.mark.parametrize("split", ["equal force", "equal work"])
def test_split_of_the_load(split):
    run = calipers.EeBrake(split=split).build().stroke(points=7)
    parts = run.pad_force if split == "equal force" else run.pad_force * run.pad_ratio
    assert np.allclose(parts[:, 0], parts[:, 1], rtol=1e-12, atol=0)


def test_equilibrium_at_a_travel_is_the_stroke_there():
    for caliper in (*BUILT.values(), calipers.EeBrake(split="equal work").build()):
        run, single = caliper.stroke([1e-3]), caliper.equilibrium(1e-3)
        for name, force in run.reactions.items():
            assert single.reactions[name] == pytest.approx(force[0], rel=1e-9, abs=1e-9)


def test_a_return_spring_takes_its_part():
    """With a spring the pads get what the tension leaves: work, by differences of the spring's energy."""
    plain = BUILT["v-brake"]
    spring = Spring("spring", "right arm", "left arm", (0.035, 0.06), (-0.035, 0.06), 2e3, 0.1)
    sprung = dataclasses.replace(
        plain, mechanism=dataclasses.replace(plain.mechanism, loads=(*plain.mechanism.loads, spring))
    )
    run, free = sprung.stroke(points=401), plain.stroke(points=401)
    assert (run.pad_force < free.pad_force).all()
    steps = np.diff(run.pad_travel, axis=0)
    work = ((run.pad_force[1:] + run.pad_force[:-1]) / 2 * steps).sum()
    ends = [run.position.point(body, at) for body, at in (("right arm", spring.at), ("left arm", spring.to))]
    length = np.linalg.norm(ends[0] - ends[1], axis=1)
    energy = 0.5 * spring.stiffness * (length[[0, -1]] - spring.free_length) ** 2
    assert run.finger_force * run.finger[-1] == pytest.approx(
        work + energy[1] - energy[0], rel=1e-6
    )  # trapezoid


def test_a_bar_for_the_strut_is_the_same():
    """The strut and link as bars instead of bodies with two pins."""
    eebrake = BUILT["eebrake"]
    m = eebrake.mechanism
    pins = {joint.name: joint for joint in m.joints}
    bars = (
        Bar("strut", "right lever", "upper-left lever", pins["strut end"].at, pins["pin B"].at),
        Bar("link", "upper-left lever", "ground", pins["pin A"].at, pins["pin G"].at),
    )
    joints = (*(pins[name] for name in ("right pivot", "left pivot", "pin O")), *bars)
    fewer = dataclasses.replace(m, bodies=m.bodies[:3], joints=joints)
    run, other = eebrake.stroke(points=9), dataclasses.replace(eebrake, mechanism=fewer).stroke(points=9)
    assert other.pad_force == pytest.approx(run.pad_force, rel=1e-12)
    assert -other.magnitudes["strut"] == pytest.approx(run.magnitudes["strut end"], rel=1e-12)
