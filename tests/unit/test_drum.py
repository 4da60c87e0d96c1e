"""Drum brakes: what they refuse, what locks, assemblies, arrays, hydraulics and heat."""

from __future__ import annotations

import math

import numpy as np
import pytest

from brakes import chain, drum, machines
from tests.unit.refusals import refused

SHOE = {
    "drum_radius": 0.138,
    "face_width": 0.05,
    "lining": (0.5, 1.9),
    "pivot": (0.02, -0.11),
    "force_arm": 0.115,
}


def shoe(**changes) -> drum.Shoe:
    return drum.Shoe(**(SHOE | changes))


# What is refused --------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "0.1 m", None, True])
@pytest.mark.parametrize("name", ["drum_radius", "face_width"])
def test_lengths_are_positive(name, value):
    refused(lambda: shoe(**{name: value}), name)


@pytest.mark.parametrize(
    "changes, parts",
    [
        ({"lining": (1.0, 1.0)}, ["lining[1]", "empty"]),
        ({"lining": (1.9, 0.5)}, ["lining[1] = 0.5", "empty"]),
        ({"lining": (0.1, 1.9)}, ["lining[0] = 0.1", "overlaps the pin", "0.179853"]),
        ({"lining": (30, 110)}, ["lining[1] = 110", "leaves the drum", "rad"]),
        ({"lining": (0.5, 3.4)}, ["lining[1] = 3.4", "leaves the drum; end it before; angles are in rad"]),
        (
            {"lining": (-0.1, 1.0), "pivot": (-0.05, -0.11), "pressure_zero": "axis"},
            ["lining[0]", "negative"],
        ),
        ({"lining": (0.5, 2.8), "pivot": (-0.05, -0.11)}, ["lining[1] = 2.8", "leaves the drum"]),
        ({"lining": (-0.5, 1.0), "pivot": (-0.05, -0.11)}, ["overlaps the pin"]),
        ({"lining": 1.0}, ["lining", "two numbers"]),
        ({"pivot": (0.0, 0.11)}, ["pivot[1]", "below"]),
        ({"pivot": (20.0, -110.0)}, ["pivot", "more than two drum radii, 0.2", "check units"]),
        ({"force_arm": -0.11}, ["force_arm", "above the pin"]),
        ({"pressure_zero": "pin"}, ["pressure_zero = 'pin'", "'axis'", "'pivot'"]),
        ({"lining": (0.5, np.array([1.0, 1.5])), "force_arm": np.ones(3)}, ["broadcast", "(2,)", "(3,)"]),
        ({"lining": (0.5, np.array([1.0, 0.4, 0.3]))}, ["0.4", "1 more of 3 cases"]),
    ],
)
def test_geometry_is_refused(changes, parts):
    refused(lambda: shoe(**changes), *parts)


@pytest.mark.parametrize(
    "inputs, parts",
    [
        ({}, ["exactly one of force, peak_pressure, torque", "none"]),
        ({"force": 1.0, "torque": 1.0}, ["exactly one", "force and torque"]),
        ({"force": 0.0}, ["force = 0 N", "greater than 0"]),
        ({"force": -5.0}, ["force = -5 N"]),
        ({"peak_pressure": math.nan}, ["peak_pressure"]),
        ({"force": 1.0, "friction": -0.1}, ["friction = -0.1"]),
        ({"torque": 1.0, "friction": 0.0}, ["friction", "no torque"]),
        ({"torque": 1.0, "friction": 5.0}, ["friction = 5", "locks", "give a force"]),
        ({"force": np.ones(2), "friction": np.ones(3)}, ["broadcast"]),
    ],
)
def test_loads_are_refused(inputs, parts):
    inputs = {"friction": 0.35} | inputs
    refused(lambda: drum.shoe_torque(shoe(), **inputs), *parts)
    if "broadcast" not in parts:
        refused(lambda: drum.brake_torque(drum.simplex(shoe()), **inputs), *parts[:1])


def test_torque_is_refused_exactly_from_locking():
    limit = drum.shoe_torque(shoe(), force=1.0, friction=0.1).locking_friction
    refused(lambda: drum.shoe_torque(shoe(), torque=10.0, friction=limit), "locks")
    below = drum.shoe_torque(shoe(), torque=10.0, friction=limit * (1 - 1e-6))
    assert 0 < below.force < 1e-3
    assert drum.shoe_torque(shoe(), torque=10.0, friction=limit, leading=False).status == "slides"


def test_brakes_are_refused():
    refused(lambda: drum.DrumBrake((), ()), "at least one")
    refused(lambda: drum.DrumBrake((shoe(),), (True, False)), "number of shoes: 1, of entries of leading: 2")
    refused(lambda: drum.simplex(shoe(), shoe(drum_radius=0.139)), "drum_radius")


# Locking ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("given", ["force", "peak_pressure"])
def test_past_locking_is_an_answer(given):
    found = drum.shoe_torque(shoe(), friction=2.0, **{given: 1000.0})
    assert found.status == "locked" and found.margin < 0
    assert "self-locking" in found.message and "2 " in found.message
    gone = [found.torque, found.c_star, found.c_star_slope, *found.normal, *found.pin_reaction]
    assert np.isnan(gone).all()
    assert np.isfinite(found.locking_friction)


def test_margin_runs_from_one_to_zero():
    limit = drum.shoe_torque(shoe(), force=1.0, friction=0.0).locking_friction
    margin = drum.shoe_torque(shoe(), force=1.0, friction=limit * np.array([0.0, 0.25, 1.0])).margin
    np.testing.assert_allclose(margin, [1.0, 0.75, 0.0], atol=1e-15)


def test_trailing_shoe_never_locks():
    found = drum.shoe_torque(shoe(), force=1.0, friction=10.0, leading=False)
    assert found.locking_friction == math.inf and found.margin == 1.0 and found.status == "slides"


def test_shoes_swap_roles_where_the_friction_arm_is_negative():
    """A short lining near a pin beyond the drum's radius: the friction's moment about the pin turns round."""
    swapped = shoe(lining=(0.2, 0.5), pivot=(0.0, -0.2), force_arm=0.1)
    leading, trailing = (drum.shoe_torque(swapped, force=1.0, friction=0.3, leading=x) for x in (True, False))
    assert leading.c_star < trailing.c_star
    assert leading.locking_friction == math.inf > trailing.locking_friction


def test_status_of_many_cases():
    found = drum.shoe_torque(shoe(), force=1000.0, friction=np.array([0.3, 2.0, 3.0]))
    assert list(found.status) == ["slides", "locked", "locked"]
    assert "2 of 3 cases" in found.message
    assert np.isnan(found.torque).tolist() == [False, True, True]


def test_locked_brake():
    found = drum.brake_torque(drum.simplex(shoe()), peak_pressure=1e6, friction=2.0)
    assert found.status == "locked" and np.isnan([found.torque, found.force]).all()
    found = drum.brake_torque(drum.simplex(shoe()), force=1e3, friction=2.0)
    assert found.status == "locked" and np.isnan(found.torque) and found.shoes[1].status == "slides"
    assert "self-locking" in found.message


# Assemblies -------------------------------------------------------------------------------------------


def test_simplex_is_the_sum_of_its_shoes():
    other = shoe(pivot=(-0.01, -0.1), lining=(0.4, 1.5))
    found = drum.brake_torque(drum.simplex(shoe(), other), force=700.0, friction=0.3)
    own = [drum.shoe_torque(shoe(), force=700.0, friction=0.3)]
    own.append(drum.shoe_torque(other, force=700.0, friction=0.3, leading=False))
    assert found.torque == pytest.approx(sum(one.torque for one in own), rel=1e-14)
    assert found.c_star == pytest.approx(found.torque / (700.0 * 0.138), rel=1e-13)
    assert found.c_star_slope == pytest.approx(sum(one.c_star_slope for one in own), rel=1e-14)
    assert found.peak_pressure == max(one.peak_pressure for one in own)


def test_reverse_swaps_leading_and_trailing():
    duplex, simplex = drum.duplex(shoe()), drum.simplex(shoe())
    load = {"force": 500.0, "friction": 0.3}
    torque = {
        (name, back): drum.brake_torque(brake, reverse=back, **load).torque
        for name, brake in (("duplex", duplex), ("simplex", simplex))
        for back in (False, True)
    }
    assert torque["simplex", True] == pytest.approx(torque["simplex", False], rel=1e-14)
    trailing = drum.shoe_torque(shoe(), leading=False, **load).torque
    assert torque["duplex", True] == pytest.approx(2 * trailing, rel=1e-14)
    assert torque["duplex", False] > torque["simplex", False] > torque["duplex", True]


@pytest.mark.parametrize("reverse", [False, True])
def test_brake_from_torque_and_from_pressure(reverse):
    brake = drum.simplex(shoe(), shoe(pivot=(0.025, -0.11)))
    by_force = drum.brake_torque(brake, force=900.0, friction=0.35, reverse=reverse)
    by_torque = drum.brake_torque(brake, torque=by_force.torque, friction=0.35, reverse=reverse)
    limit = by_force.peak_pressure
    by_pressure = drum.brake_torque(brake, peak_pressure=limit, friction=0.35, reverse=reverse)
    assert by_torque.force == pytest.approx(900.0, rel=1e-13)
    assert by_pressure.force == pytest.approx(900.0, rel=1e-13)


def test_arrays_of_arcs_and_frictions_give_each_case():
    ends, mu = np.array([1.0, 1.5, 2.0]), np.array([[0.2], [0.4]])
    found = drum.shoe_torque(shoe(lining=(0.5, ends)), force=1000.0, friction=mu)
    assert found.torque.shape == (2, 3) and found.pin_reaction.shape == (2, 3, 2)
    for i, j in np.ndindex(2, 3):
        one = drum.shoe_torque(shoe(lining=(0.5, float(ends[j]))), force=1000.0, friction=float(mu[i, 0]))
        assert found.torque[i, j] == pytest.approx(one.torque, rel=1e-14)
        np.testing.assert_allclose(found.pin_reaction[i, j], one.pin_reaction, rtol=1e-13)


def test_pressure_is_zero_off_the_lining():
    found = drum.shoe_torque(shoe(), force=1000.0, friction=0.35)
    p = found.pressure(np.array([0.49, 0.51, 1.89, 1.91]))
    assert (p == 0).tolist() == [True, False, False, True]


def test_results_are_frozen():
    found = drum.shoe_torque(shoe(), force=1000.0, friction=0.35)
    with pytest.raises(AttributeError):
        found.torque = 1.0  # pyright: ignore[reportAttributeAccessIssue]


# Hydraulics and heat ----------------------------------------------------------------------------------


def test_wheel_cylinder():
    """A piston of 25.4 mm at 5 MPa: 1 in2 is 6.4516 cm2."""
    assert drum.wheel_cylinder_force(0.0254, 5e6) == pytest.approx(5e6 * 6.4516e-4 * math.pi / 4, rel=1e-14)
    refused(lambda: drum.wheel_cylinder_force(0.0, 5e6), "bore")
    refused(lambda: drum.wheel_cylinder_force(0.02, -1.0), "line_pressure")


def test_energy_of_a_stop():
    assert drum.stop_energy(1000.0, 20.0) == pytest.approx(200e3)
    assert drum.stop_energy(1000.0, 20.0, 10.0) == pytest.approx(150e3)
    assert drum.stop_energy(1000.0, 20.0, descent=2.0, g=10.0) == pytest.approx(220e3)
    assert drum.stop_energy(1000.0, 20.0, inertia=4.0, rolling_radius=0.2) == pytest.approx(220e3)
    refused(lambda: drum.stop_energy(1000.0, 20.0, inertia=4.0), "rolling_radius")
    refused(lambda: drum.stop_energy(1000.0, 20.0, 30.0), "final_speed = 30")


def test_temperature_rise():
    assert drum.temperature_rise(100e3, 10.0) == pytest.approx(20.0)
    assert drum.temperature_rise(100e3, 10.0, 400.0, 0.9) == pytest.approx(22.5)
    refused(lambda: drum.temperature_rise(1.0, 1.0, share=1.1), "share")


@pytest.mark.parametrize("change", [-1e-13, 0.0, 1e-13])
def test_borders_of_a_shoe_do_not_hang_on_the_thirteenth_digit(change: float):
    given = {"drum_radius": 0.1, "face_width": 0.05, "lining": (0.5, 2.0), "force_arm": 0.1}
    drum.Shoe(**given, pivot=(0.0, -0.2 * (1 + change)))  # two radii from the centre
    for border, said in (
        ({"pivot": (0.0, -0.08), "force_arm": -0.08 * (1 + change)}, "above the pin"),
        ({"pivot": (0.0, -0.08), "lining": (0.5, 0.5 + change)}, "the arc is empty"),
        ({"pivot": (0.05, -0.1 * abs(change))}, "below the centre"),
    ):
        with pytest.raises(ValueError, match=said):
            drum.Shoe(**given | border)


@pytest.mark.parametrize(
    ("build", "named"),
    [
        (
            lambda: shoe(pivot=(np.full(2, 0.02), -0.11), drum_radius=np.full(3, 0.138)),
            ("pivot[0] (2,)", "drum_radius (3,)"),
        ),
        (
            lambda: shoe(lining=(0.5, np.full(2, 1.9)), face_width=np.full(3, 0.05)),
            ("lining[1] (2,)", "face_width (3,)"),
        ),
        (
            lambda: machines.Band(np.full(2, 0.2), 0.05, np.full(3, 3.9), force_arm=0.5, first_arm=0.1),
            ("(2,)", "(3,)"),
        ),
        (
            lambda: chain.HydraulicLine(np.full(2, 0.022), np.full(3, 0.032)),
            ("master_bore (2,)", "cylinder_bore (3,)"),
        ),
    ],
)
def test_numbers_of_a_part_that_do_not_broadcast_are_named_with_their_shapes(build, named):
    refused(build, "shapes do not broadcast", *named)
