"""Forklift at the limits: a hundred thousand brakes, ten thousand trucks, forces at the edge of locking."""

from __future__ import annotations

import numpy as np
import pytest

from brakes import forklift
from brakes.forklift import BENDIX_12_5, Levers, StopConditions, Truck, internal_forces

N = 100_000


def random_levers(rng: np.random.Generator, largest_arm: float) -> Levers:
    r = rng.uniform(0.05, 0.4, N)
    arm = lambda: r * rng.uniform(0.02, largest_arm, N)  # noqa: E731
    b1 = arm()
    b2 = np.where(rng.random(N) < 0.5, b1, b1 * rng.uniform(0.8, 1.25, N))
    angles = rng.uniform(-np.pi / 4, np.pi / 4, (3, N))  # sums and differences reach a right angle
    return Levers(r, arm(), arm(), b1, b2, *angles)


@pytest.mark.parametrize("largest_arm", [0.99, 2.0])
def test_a_hundred_thousand_brakes_given_the_torque(largest_arm: float) -> None:
    rng = np.random.default_rng(97370090)
    levers = random_levers(rng, largest_arm)
    P_T = 10 ** rng.uniform(0, 6, N)
    T = P_T * levers.drum_radius * 10 ** rng.uniform(-4, 4, N)
    found = internal_forces(levers, torque=T, piston_force=P_T)
    solved = found.status == "equilibrium"
    forces = np.array([found.A, found.B, found.C, found.D, found.Q, found.P_L])
    assert (forces[:, solved] > 0).all() and np.isnan(forces[:, ~solved]).all()
    assert (found.residual[solved] < 1e-9).all()
    beyond = (levers.a1 > levers.drum_radius) & (levers.b2 > levers.drum_radius)
    assert set(found.status[~solved]) <= {"no solution"} and beyond[~solved].all()
    assert solved.all() == (largest_arm < 1)


def test_a_hundred_thousand_brakes_given_the_friction() -> None:
    rng = np.random.default_rng(19971997)
    levers = random_levers(rng, 1.5)
    P_T = 10 ** rng.uniform(0, 6, N)
    mu = 10 ** rng.uniform(-3, 1, N)
    found = internal_forces(levers, friction=mu, piston_force=P_T)
    locked = found.status == "locked"
    assert (locked == (mu >= levers.locking_friction)).all() and 0.05 < locked.mean() < 0.95
    forces = np.array([found.A, found.B, found.C, found.D, found.Q, found.P_L, found.torque])
    assert (forces[:, ~locked] > 0).all() and np.isnan(forces[:, locked]).all()
    closeness = 1 - mu[~locked] / levers.locking_friction[~locked]
    assert (found.residual[~locked] < 1e-9 / np.minimum(1, closeness * 1e3)).all()


def test_ten_thousand_designs_through_all_stages() -> None:
    rng = np.random.default_rng(10_000)
    n = 10_000
    truck = Truck(
        empty_mass=rng.uniform(5000, 6500, n),
        empty_cg=(rng.uniform(1.0, 1.1, n), rng.uniform(0.3, 0.5, n)),
        load_mass=rng.uniform(0, 3500, n),
        load_cg=(-1.20, 0.450),
        front_wheel_radius=rng.uniform(0.35, 0.45, n),
        wheelbase=1.89,
    )
    conditions = StopConditions(
        slope=rng.uniform(0, 0.3, n),
        speed=rng.uniform(2, 7, n),
        friction=rng.uniform(0.5, 0.8, n),
        reaction_time=0.5,
        rise_time=0.3,
    )
    piston_force, motion = rng.uniform(1e4, 1.3e4, n), BENDIX_12_5.move_shoes(rng.uniform(0.005, 0.021, n))
    found = forklift.brake_procedure(truck, conditions, motion, piston_force=piston_force)
    assert (found.forces.status == "equilibrium").all() and 0 < found.stop.stops.mean() <= 1
    assert (np.isfinite(found.stop.distance) == found.stop.stops).all()


@pytest.mark.parametrize("rise_time", [0.0, 1e-9])
def test_no_rise_time_leaves_the_plain_stop(rise_time: float) -> None:
    truck = Truck(5950.0, (1.049, 0.359), 3500.0, (-1.20, 0.450), 0.40, 1.89)
    found = forklift.stop(truck, StopConditions(0.0, 5.0, 0.7, reaction_time=0.0, rise_time=rise_time))
    assert found.distance == pytest.approx(25 / (2 * -found.acceleration), rel=1e-8)
    assert found.time == pytest.approx(5 / -found.acceleration, rel=1e-8)


def test_distance_grows_without_bound_towards_the_slope_that_holds_no_more() -> None:
    """acceleration = 0 at tan(beta) = mu b / (L + mu h); the distance has a pole there."""
    truck = Truck(5950.0, (1.049, 0.359), 0.0, (0.0, 0.0), 0.40, 1.89)
    limit = np.arctan(0.7 * (1.89 - 1.049) / (1.89 + 0.7 * 0.759))
    gap = 10.0 ** -np.arange(3, 9)
    case = {"speed": 5.0, "friction": 0.7, "reaction_time": 0.5, "rise_time": 0.3}
    short = forklift.stop(truck, StopConditions(slope=limit - gap, **case))
    assert short.stops.all() and np.polyfit(np.log(gap), np.log(short.distance), 1)[0] == pytest.approx(
        -1, abs=0.02
    )
    assert not forklift.stop(truck, StopConditions(slope=limit + gap, **case)).stops.any()


def test_clearance_towards_zero_seats_the_shoes_where_they_are() -> None:
    c = 10.0 ** -np.arange(4, 10)
    found = BENDIX_12_5.move_shoes(c)
    assert np.polyfit(np.log(c), np.log(found.seating_turn), 1)[0] == pytest.approx(1, abs=0.01)
    assert (found.lining_penetration < c).all() and (found.drum_turn > 0).all()


def test_tiny_torque_and_tiny_piston_force() -> None:
    levers = BENDIX_12_5.find_levers(0.0106)
    weak = internal_forces(levers, torque=1e-6, piston_force=1e4)
    assert weak.status == "equilibrium" and weak.residual < 1e-12
    assert pytest.approx(1e4 * levers.a2 / levers.b2, rel=1e-9) == weak.Q
    strong = internal_forces(levers, torque=1e4, piston_force=1e-6)
    assert strong.status == "equilibrium" and strong.margin < 1e-6 and strong.residual < 1e-12
