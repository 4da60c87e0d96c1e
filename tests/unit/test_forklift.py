"""Forklift: what is refused, statuses, warnings, arrays, and the chain of the three stages."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from brakes import forklift
from brakes.forklift import BENDIX_12_5, Levers, StopConditions, Truck, internal_forces
from brakes.reproduce.forklift_as_printed import newton_raphson, stop_as_printed
from tests.unit.refusals import refused

TRUCK = {
    "empty_mass": 5950.0,
    "empty_cg": (1.049, 0.359),
    "load_mass": 3500.0,
    "load_cg": (-1.20, 0.450),
    "front_wheel_radius": 0.40,
    "wheelbase": 1.89,
}
BASE = {"slope": 0.3019, "speed": 20 / 3.6, "friction": 0.7, "reaction_time": 0.5, "rise_time": 0.3}
LEVERS = {"drum_radius": 0.16, "a1": 0.128, "a2": 0.113, "b1": 0.122, "b2": 0.122}
LEVERS |= {"alpha1": 0.34, "alpha2": 0.34, "gamma": 0.17}


def stop(truck=None, **changes):
    return forklift.stop(Truck(**(TRUCK | (truck or {}))), StopConditions(**(BASE | changes)))


# Vehicle ----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [0.0, -1.0, math.nan, math.inf, "5 t", None])
@pytest.mark.parametrize("name", ["empty_mass", "front_wheel_radius", "wheelbase"])
def test_truck_needs_positive_numbers(name, value):
    refused(lambda: Truck(**(TRUCK | {name: value})), name)


@pytest.mark.parametrize(
    "changes, parts",
    [
        ({"empty_cg": (-0.1, 0.4)}, ["empty truck", "-0.1 m", "ahead of the front wheel", "empty_cg"]),
        ({"empty_cg": (0.0, 0.4)}, ["ahead of the front wheel"]),
        ({"empty_cg": (1.9, 0.4)}, ["behind the rear wheel", "1.89"]),
        ({"load_mass": 5300.0}, ["with the load", "ahead of the front wheel", "less load"]),
        ({"load_mass": -1.0}, ["load_mass = -1 kg"]),
        ({"empty_cg": (1.0, -0.4), "load_mass": 0.0}, ["below the ground"]),
        ({"empty_cg": 1.0}, ["empty_cg", "two numbers"]),
        ({"empty_mass": np.array([6e3, -1.0, -2.0])}, ["empty_mass = -1 kg", "1 more of 3 cases"]),
        ({"empty_mass": np.ones(2), "wheelbase": np.ones(3)}, ["broadcast", "empty_mass (2,)"]),
    ],
)
def test_truck_is_refused(changes, parts):
    refused(lambda: Truck(**(TRUCK | changes)), *parts)


def test_overload_is_refused_exactly_where_the_centre_passes_the_wheel():
    limit = 5950 * 1.049 / 1.20
    assert Truck(**(TRUCK | {"load_mass": limit * (1 - 1e-9)})).cg[0] > 0
    refused(lambda: Truck(**(TRUCK | {"load_mass": limit * (1 + 1e-9)})), "ahead of the front wheel")


@pytest.mark.parametrize(
    "changes, parts",
    [
        ({"speed": 0.0}, ["speed = 0 m/s"]),
        ({"friction": 0.0}, ["friction = 0"]),
        ({"friction": -0.7}, ["friction"]),
        ({"reaction_time": -0.1}, ["reaction_time = -0.1 s"]),
        ({"rise_time": -0.1}, ["rise_time"]),
        ({"gravity": 0.0}, ["gravity = 0 m/s2"]),
        ({"slope": 17.3}, ["slope = 17.3 rad", "rad"]),
        ({"slope": 1.2}, ["slope = 1.2 rad", "overturns", "rear axle"]),
        ({"slope": -0.5}, ["slope = -0.5 rad", "overturns", "front axle"]),
        ({"slope": -1.6}, ["slope = -1.6 rad: it must be greater than -1.5708 rad"]),
        ({"friction": 50.0}, ["friction = 50: it must be at most 2; 70 % is 0.7"]),
        ({"friction": np.array([0.5, 2.0, 2.1])}, ["friction = 2.1: it must be at most 2"]),
        ({"slope": np.zeros(2), "speed": np.ones(3)}, ["broadcast"]),
    ],
)
def test_stop_is_refused(changes, parts):
    refused(lambda: stop(**changes), *parts)


def test_slope_is_refused_exactly_where_the_standing_truck_loses_an_axle():
    front, rear = Truck(**TRUCK).overturning_slopes
    for limit, load in ((rear, "standing_front_load"), (front, "standing_rear_load")):
        near = stop(slope=limit * (1 - 1e-9))
        assert 0 < getattr(near, load) < 1e-8 * 9450 * 9.806
        refused(lambda s=limit * (1 + 1e-9): stop(slope=s), "overturns")


def test_message_names_the_limit_of_the_case_that_fails():
    truck = {"empty_cg": (np.array([1.049, 1.5, 1.6]), 0.359), "load_mass": 0.0}
    limit = Truck(**(TRUCK | truck)).overturning_slopes[1]
    refused(
        lambda: stop(truck, slope=0.6), "slope = 0.6 rad (and 1 more of 3 cases):", f"past {limit[1]:.6g} rad"
    )


def test_never_stops():
    found = stop({"load_mass": 0.0})
    assert not found.stops and found.status == "never stops" and "never stops" in found.message
    assert found.distance == math.inf and found.time == math.inf and found.acceleration > 0
    assert found.torque_per_brake > 0 and found.speed_lost_in_rise < 0


def test_stops_in_the_rise_time():
    found = stop(slope=0.0, speed=0.3)
    assert found.stops and found.status == "stops in the rise time" and "rising" in found.message
    assert found.speed_lost_in_rise == 0.3 and found.braking_distance == 0
    assert 0.5 < found.time < 0.8


def test_stop_joins_smoothly_where_it_just_lasts_the_rise_time():
    A = stop(slope=0.0).acceleration
    V = -A * BASE["rise_time"] / 2
    short, long = (stop(slope=0.0, speed=V * (1 + e)) for e in (-1e-7, 1e-7))
    assert (short.status, long.status) == ("stops in the rise time", "stops")
    assert long.distance == pytest.approx(short.distance, rel=1e-6)
    assert long.time == pytest.approx(short.time, rel=1e-3)  # like a root there


def test_parts_of_the_distance():
    found = stop()
    parts = found.reaction_distance + found.rise_distance + found.braking_distance
    assert found.distance == pytest.approx(parts, rel=1e-14)
    assert found.reaction_distance == pytest.approx(BASE["speed"] * 0.5)
    assert found.speed_gained_coasting == pytest.approx(9.806 * math.sin(0.3019) * 0.5)
    assert found.speed_lost_in_rise == pytest.approx(-found.acceleration * 0.15, rel=1e-12)


def test_as_printed_a_low_load_far_ahead_lifts_the_rear_wheels():
    """The printed arm y_cg - r1 is negative here, and moves load to the front axle."""
    truck = {"empty_cg": (0.05, -0.2), "load_mass": 0.0}
    found = stop_as_printed(Truck(**(TRUCK | truck)), StopConditions(**(BASE | {"slope": 0.0})))
    assert found.status == "rear wheel lifts" and not found.stops and found.distance == math.inf
    assert found.rear_load < 0 and "rear wheels lift" in found.message
    assert stop(truck, slope=0.0).status == "stops"


def test_no_axle_lifts_while_sliding_with_the_centre_between_them():
    rng = np.random.default_rng(5)
    truck = {"empty_cg": (rng.uniform(0.01, 1.88, 500), rng.uniform(0.0, 3.0, 500)), "load_mass": 0.0}
    found = stop(truck, slope=0.0, friction=rng.uniform(0.01, 2.0, 500))
    assert (found.front_load > 0).all() and (found.rear_load > 0).all()


def test_a_truck_that_drives_forwards_may_overturn_over_its_front_axle():
    """From mu = a / h on, whatever the slope; at rest past tan(beta) = a / h downhill."""
    truck = Truck(**TRUCK | {"load_mass": 0.0})
    limit = truck.cg[0] / (truck.cg[1] + truck.front_wheel_radius)
    road = {"speed": 3.0, "reaction_time": 0.5, "rise_time": 0.3, "direction": "forward"}
    found = forklift.stop(truck, StopConditions(0.1, friction=0.999 * limit, **road))
    assert 0 < found.rear_load < 0.01 * found.front_load
    for change in (0.0, -1e-14, 1e-14):
        conditions = StopConditions(0.1, friction=limit * (1 + change), **road)
        refused(
            lambda c=conditions: forklift.stop(truck, c),
            "friction",
            "overturns the truck over the front axle",
        )
    steep = StopConditions(1.001 * np.arctan(limit), friction=0.3, **road)
    refused(lambda: forklift.stop(truck, steep), "at rest, over the front axle")


def test_braking_loads_the_leading_rear_axle():
    found = stop(friction=np.array([1e-9, 0.3, 0.7]))
    assert (np.diff(found.rear_load) > 0).all() and (np.diff(found.front_load) < 0).all()


def test_sweep_gives_each_case():
    slope, mass = np.array([[0.0], [0.2], [0.3]]), np.array([0.0, 3500.0])
    many = stop({"load_mass": mass}, slope=slope)
    assert many.distance.shape == (3, 2) and many.status.shape == (3, 2)
    for i, j in np.ndindex(3, 2):
        one = stop({"load_mass": float(mass[j])}, slope=float(slope[i, 0]))
        assert many.distance[i, j] == one.distance and many.status[i, j] == one.status
    assert many.message == "1 of 6 cases do not stop"
    assert stop(slope=np.array([0.0, 0.1])).message == "every case stops"


def test_shoes_are_moved_once(monkeypatch):
    moved, move = [], forklift.DuoServo.move_shoes
    monkeypatch.setattr(forklift.DuoServo, "move_shoes", lambda *given: moved.append(given) or move(*given))
    forklift.internal_forces(forklift.BENDIX_12_5, torque=11000.0, piston_force=11650.0, clearance=0.0106)
    assert len(moved) == 1


# Forces -----------------------------------------------------------------------------------------------


@pytest.mark.parametrize("value", [0.0, -0.1, math.nan, "12 mm"])
@pytest.mark.parametrize("name", ["drum_radius", "a1", "a2", "b1", "b2"])
def test_levers_are_positive(name, value):
    refused(lambda: Levers(**(LEVERS | {name: value})), name)


def test_levers_with_degrees_are_refused():
    refused(lambda: Levers(**(LEVERS | {"alpha1": 19.7})), "alpha1 + gamma", "right angle", "rad")
    refused(lambda: Levers(**(LEVERS | {"gamma": -1.5})), "alpha2 - gamma")


@pytest.mark.parametrize(
    "inputs, parts",
    [
        ({}, ["torque", "friction"]),
        ({"torque": 0.0}, ["torque = 0 N m"]),
        ({"torque": -1.0}, ["torque"]),
        ({"friction": 0.0}, ["friction = 0"]),
        ({"torque": 1e4, "piston_force": 0.0}, ["piston_force = 0 N"]),
        ({"torque": 1e4, "friction": 2.0}, ["friction = 2", "locks", "no torque"]),
        ({"torque": 1e4, "clearance": 0.01}, ["clearance", "DuoServo"]),
        ({"torque": np.ones(2), "piston_force": np.ones(3)}, ["broadcast"]),
    ],
)
def test_forces_are_refused(inputs, parts):
    refused(lambda: internal_forces(Levers(**LEVERS), **({"piston_force": 11650.0} | inputs)), *parts)


def test_torque_is_refused_exactly_from_locking():
    levers = Levers(**LEVERS)
    limit = levers.locking_friction
    refused(lambda: internal_forces(levers, piston_force=1.0, torque=1.0, friction=limit), "locks")
    assert internal_forces(levers, piston_force=1.0, friction=limit).status == "locked"
    near = internal_forces(levers, piston_force=1.0, friction=limit * (1 - 1e-6))
    assert near.status == "equilibrium" and near.c_star > 1e5


def test_locked_is_an_answer():
    found = internal_forces(Levers(**LEVERS), piston_force=11650.0, friction=2.0)
    assert found.status == "locked" and "self-locking" in found.message
    assert np.isnan([found.torque, found.A, found.Q, found.c_star, *found.bolt_force]).all()


def test_arms_beyond_the_drum_may_have_no_solution():
    found = internal_forces(
        Levers(**(LEVERS | {"a1": 0.3, "b2": 0.3, "b1": 0.3})), piston_force=10.0, torque=1e5
    )
    assert found.status == "no solution" and np.isnan(found.A) and "no friction" in found.message


def test_unequal_arms_of_the_adjuster_are_warned_of():
    assert internal_forces(Levers(**LEVERS), piston_force=1e4, torque=1e4).warnings == ()
    (warning,) = internal_forces(Levers(**(LEVERS | {"b1": 0.12})), piston_force=1e4, torque=1e4).warnings
    assert "b1" in warning and "one line of action" in warning


def test_friction_that_the_lining_does_not_have_is_warned_of():
    case = {"piston_force": 11650.0, "torque": 11000.0, "clearance": 0.0106}
    needed = internal_forces(BENDIX_12_5, **case).lining_friction
    assert internal_forces(BENDIX_12_5, friction=needed, **case).warnings == ()
    (warning,) = internal_forces(BENDIX_12_5, friction=0.35, **case).warnings
    assert f"{needed / 0.35:.3g} times" in warning


def test_factors_and_shares():
    found = internal_forces(BENDIX_12_5, torque=11000.0, piston_force=11650.0, clearance=0.0106)
    assert found.c_star == pytest.approx(11000 / (11650 * 0.15875), rel=1e-14)
    assert found.leading_share == pytest.approx(found.B * 0.15875 / 11000, rel=1e-12)
    assert found.leading_share + found.trailing_share == pytest.approx(1, rel=1e-14)
    assert found.margin == pytest.approx(1 - found.lining_friction / found.locking_friction)
    alpha = np.radians(19.7)
    bolts = [-found.P_L + 11650, found.P_L + 11650] * np.array([np.cos(alpha), np.sin(alpha)])
    np.testing.assert_allclose(found.bolt_force, bolts, rtol=1e-12)


def test_sweep_of_forces_gives_each_case():
    clearance, torque = np.array([[0.005], [0.01]]), np.array([9e3, 1e4, 1.1e4])
    many = internal_forces(BENDIX_12_5, torque=torque, piston_force=11650.0, clearance=clearance)
    assert many.A.shape == (2, 3) and many.A_vector.shape == (2, 3, 2)
    assert many.message == "equilibrium: 6 cases"
    for i, j in np.ndindex(2, 3):
        one = internal_forces(
            BENDIX_12_5, torque=float(torque[j]), piston_force=11650.0, clearance=float(clearance[i, 0])
        )
        assert many.P_L[i, j] == pytest.approx(one.P_L, rel=1e-13)
        np.testing.assert_allclose(many.D_vector[i, j], one.D_vector, rtol=1e-10)


def test_mixed_statuses():
    found = internal_forces(Levers(**LEVERS), piston_force=1e4, friction=np.array([0.3, 5.0]))
    assert list(found.status) == ["equilibrium", "locked"]
    assert found.message == "equilibrium: 1 cases, locked: 1 cases"


def test_newton_says_how_it_ended():
    levers = Levers(**LEVERS)
    good = newton_raphson(levers, torque=1e4, piston_force=1e4)
    assert good.message == "converged"
    lost = newton_raphson(levers, torque=1e4, piston_force=1e4, start=np.ones(10), steps=1)
    assert not lost.converged and "no convergence" in lost.message
    x = np.array(good.unknowns) / 1e4 * 0.16
    e = np.array([x[0] + x[2], x[1] + x[3]]) / np.hypot(x[0] + x[2], x[1] + x[3])
    mirror = x.copy()
    for k in (0, 2):  # A and B mirrored in their sum
        mirror[k : k + 2] = 2 * (x[k : k + 2] @ e) * e - x[k : k + 2]
    wrong = newton_raphson(levers, torque=1e4, piston_force=1e4, start=mirror)
    assert wrong.converged and not wrong.physical and "mirror image" in wrong.message


# Kinematics -------------------------------------------------------------------------------------------


@pytest.mark.parametrize(
    "changes, parts",
    [
        ({"drum_radius": 0.0}, ["drum_radius"]),
        ({"tip": (-0.06, 0.1)}, ["tip[0]", "x > 0"]),
        ({"tip": (0.06, -0.1)}, ["tip[1]", "above"]),
        ({"adjuster": (0.05, 0.12)}, ["adjuster[1]", "below"]),
        ({"tip": (61.55, 102.29)}, ["tip", "inside the drum"]),
        ({"face_tilt": 19.7}, ["face_tilt = 19.7", "rad"]),
        ({"contact_angle": 56.5}, ["contact_angle", "rad"]),
        ({"piston_bottom": 0.0}, ["piston_bottom"]),
        ({"piston_stroke": -0.01}, ["piston_stroke"]),
    ],
)
def test_brake_is_refused(changes, parts):
    refused(lambda: replace(BENDIX_12_5, **changes), *parts)


@pytest.mark.parametrize(
    "clearance, parts",
    [
        (0.0, ["clearance = 0 m"]),
        (-0.01, ["clearance"]),
        (10.6, ["clearance = 10.6 m", "larger than the drum allows", "0.15875"]),
        (0.06, ["clearance = 0.06 m", "larger than the drum allows", "tip would leave"]),
    ],
)
def test_clearance_is_refused(clearance, parts):
    refused(lambda: BENDIX_12_5.move_shoes(clearance), *parts)
    refused(lambda: forklift.follow_shoes(BENDIX_12_5, clearance), *parts[:1])
    refused(
        lambda: internal_forces(BENDIX_12_5, torque=1e4, piston_force=1e4, clearance=clearance), *parts[:1]
    )


def test_lining_that_cannot_reach_the_drum():
    short = replace(BENDIX_12_5, adjuster=(0.01, -0.01), contact_angle=-0.7)
    refused(lambda: short.move_shoes(0.14), "clearance", "cannot reach")


def test_missing_clearance():
    refused(lambda: internal_forces(BENDIX_12_5, torque=1e4, piston_force=1e4), "clearance is missing")


def test_piston_stroke_is_checked_when_given():
    enough, short = (replace(BENDIX_12_5, piston_stroke=s).move_shoes(0.0106) for s in (0.043, 0.042))
    assert len(enough.interference) == 1
    assert "42.29 mm" in short.interference[1] and "42 mm" in short.interference[1]


def test_no_interference_without_penetration():
    """A lining that touches first where its circle's centre moves."""
    depth = BENDIX_12_5.move_shoes(0.0106)
    seated = replace(BENDIX_12_5, contact_angle=float(depth.penetration_angle)).move_shoes(0.0106)
    assert seated.lining_penetration < depth.lining_penetration / 20


# Chain ------------------------------------------------------------------------------------------------


def test_procedure_carries_results_forward():
    found = forklift.brake_procedure(
        Truck(**TRUCK), StopConditions(**BASE), BENDIX_12_5.move_shoes(0.0106), piston_force=11650.0
    )
    assert found.forces.torque == found.stop.torque_per_brake == stop().torque_per_brake
    assert found.forces.levers is found.motion.levers
    alone = internal_forces(
        BENDIX_12_5, torque=found.stop.torque_per_brake, piston_force=11650.0, clearance=0.0106
    )
    assert found.forces.A == alone.A and found.warnings == found.motion.interference


def test_procedure_gathers_warnings():
    found = forklift.brake_procedure(
        Truck(**(TRUCK | {"load_mass": 0.0})),
        StopConditions(**BASE),
        BENDIX_12_5.move_shoes(0.0106),
        piston_force=11650.0,
        lining_friction=0.3,
    )
    assert len(found.warnings) == 3
    assert "never stops" in found.warnings[0] and "enters the drum" in found.warnings[1]
    assert "friction" in found.warnings[2] and "or the stop that gives it" in found.warnings[2]
