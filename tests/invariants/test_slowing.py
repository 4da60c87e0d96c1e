"""Stops of two braked axles: moments, energy, change-overs, and the motion while the force rises."""

from dataclasses import replace

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import solve_ivp

from brakes import vehicle
from brakes.vehicle.rise import to_rest

BICYCLE = vehicle.Vehicle(80.0, cg_behind_front=0.62, cg_height=1.10, wheelbase=1.02)
AT_ONCE = vehicle.Approach(speed=8.0)
LEVEL = vehicle.Road(slope=0.0, friction=0.8)


def random_stops(leading):
    rng = np.random.default_rng(3)
    length = rng.uniform(0.8, 4, 1000)
    any_vehicle = vehicle.Vehicle(
        rng.uniform(50, 5e3, 1000), rng.uniform(0.1, 0.9, 1000) * length, rng.uniform(0.2, 2, 1000), length
    )
    road = vehicle.Road(rng.uniform(0, 0.4, 1000), rng.uniform(0.2, 1.2, 1000))
    force = rng.uniform(0.05, 2, 1000) * any_vehicle.mass * 9.806
    share = rng.uniform(0, 1, 1000)
    found = vehicle.slow_down(any_vehicle, road, AT_ONCE, force, share, leading)
    return found, force, share


@pytest.mark.parametrize("leading", ["front", "rear"])
def test_a_stop_is_in_equilibrium_and_no_wheel_gives_more_than_road_or_brake(leading):
    """The equation that the closed form solves, and moments about the centre of gravity."""
    found, force, share = random_stops(leading)
    v, mu, weight = found.vehicle, found.road.friction, found.front_load + found.rear_load
    given = found.front_force + found.rear_force
    sense = 1 if leading == "front" else -1
    moment = (
        found.front_load * v.cg_behind_front
        - found.rear_load * (v.wheelbase - v.cg_behind_front)
        - sense * given * v.cg_height
    )
    np.testing.assert_allclose(moment / (weight * v.wheelbase), 0, atol=1e-14)  # rounding of three terms
    eased = found.status == "at the limit of pitching over"
    front = np.minimum(share * force, mu * found.front_load)
    rear = np.minimum((1 - share) * force, mu * found.rear_load)
    np.testing.assert_allclose(given[~eased], (front + rear)[~eased], rtol=1e-12)
    assert (given[eased] <= (front + rear)[eased] * (1 + 1e-12)).all()
    lifted = np.minimum(found.front_load, found.rear_load)[eased]
    np.testing.assert_allclose(lifted / weight[eased], 0, atol=1e-14)
    assert len({*found.status.tolist()}) == 5  # each state is there


@pytest.mark.parametrize("leading", ["front", "rear"])
def test_the_work_of_the_brakes_is_the_energy(leading):
    found, _, _ = random_stops(leading)
    ends, v, road = found.stops, found.vehicle, found.road
    assert 500 < ends.sum() < 1000 and np.isinf(found.distance[~ends]).all()
    way = found.distance[ends]
    work = (found.front_force + found.rear_force)[ends] * way
    put_in = v.mass[ends] * (8.0**2 / 2 + 9.806 * np.sin(road.slope[ends]) * way)
    np.testing.assert_allclose(work, put_in, rtol=1e-10)  # where slope and brakes nearly balance, less


def test_wheels_lock_at_the_ratios_that_are_stated():
    weight = 80.0 * 9.806
    limits = vehicle.braking_limits(BICYCLE, 0.8, front_share=0.5)
    for part, status in ((1 - 1e-8, "no wheel locks"), (1 + 1e-8, "rear wheels locked")):
        found = vehicle.slow_down(BICYCLE, LEVEL, AT_ONCE, part * limits.rear_locks * weight, 0.5)
        assert found.status == status
        assert found.ratio == pytest.approx(limits.rear_locks, rel=2e-8)
    truck = replace(BICYCLE, cg_height=0.3)  # which locks all wheels before it could pitch over
    found = vehicle.slow_down(truck, LEVEL, AT_ONCE, 1e5, 0.5)
    assert (found.status, found.ratio) == ("all wheels locked", 0.8)


def test_a_truck_with_locked_front_wheels_is_that_of_its_own_room():
    truck = vehicle.Truck(5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89)
    road = vehicle.Road(0.3019, 0.7)
    for rise in (0.0, 0.3):
        found = vehicle.slow_down(
            truck.vehicle, road, vehicle.Approach(20 / 3.6, 0.0, rise), 1e6, 1.0, leading="rear"
        )
        own = vehicle.stop(truck, vehicle.StopConditions(0.3019, 20 / 3.6, 0.7, 0.5, rise))
        assert found.status == "front wheels locked"
        assert found.deceleration == pytest.approx(-own.acceleration, rel=1e-13)
        held = 20 / 3.6 * 0.5  # the truck's speed is held in the reaction time, the vehicle's is not
        assert found.distance + held == pytest.approx(own.pulled_distance, rel=1e-13)
    assert own.pulled_distance / own.distance == pytest.approx(15.054 / 13.425, rel=5e-5)  # 12 % longer
    level = vehicle.stop(truck, vehicle.StopConditions(0.0, 20 / 3.6, 0.7, 0.5, 0.3))
    assert level.pulled_distance == pytest.approx(level.distance, rel=1e-14)  # without pull they are one


@pytest.mark.parametrize(("heading", "reaction"), [("downhill", 0.8), ("uphill", 0.8), ("uphill", 4.0)])
def test_a_stop_on_a_slope_is_that_of_its_equation_of_motion(heading, reaction):
    """Uphill with a reaction time of 4 s it comes to rest before the brakes act."""
    road, speed, rise = vehicle.Road(0.2, 0.8), 6.0, 0.5
    approach = vehicle.Approach(speed, reaction, rise, heading=heading)
    found = vehicle.slow_down(BICYCLE, road, approach, 250.0, 0.7)
    pull = 9.806 * np.sin(0.2) * (1 if heading == "downhill" else -1)

    def standing(_, y):
        return y[1]

    standing.terminal = True
    force = lambda t: 250.0 * np.clip((t - reaction) / rise, 0.0, 1.0) / 80.0  # noqa: E731
    run = solve_ivp(lambda t, y: [y[1], pull - force(t)], (0, 60), [0.0, speed],
                    events=standing, max_step=0.01, rtol=1e-10, atol=1e-10)  # fmt: skip
    assert found.status == "no wheel locks"
    assert found.distance == pytest.approx(run.y[0, -1], rel=1e-5)  # that of a step over the kinks
    assert found.time == pytest.approx(run.t[-1], rel=1e-5)
    assert (found.time < reaction) == (reaction > 1)
    assert bool(found.warnings) == (pull + force(run.t[-1]) < 0)  # it rolls back until the brakes hold it


@pytest.mark.parametrize("rise_time", [0.3, 4.0])
def test_the_way_to_rest_is_that_of_its_differential_equation(rise_time):
    """In a rise time of 4 s it comes to rest while the force rises."""

    def standing(_, y):
        return y[1]

    standing.terminal = True
    found = to_rest(6.0, 1.5, 7.0, rise_time, True)
    run = solve_ivp(lambda t, y: [y[1], 1.5 - 7.0 * min(t / rise_time, 1.0)], (0, 10), [0, 6.0],
                    events=standing, max_step=0.01, rtol=1e-10, atol=1e-10)  # fmt: skip
    assert found[0] == pytest.approx(run.y[0, -1], rel=1e-6)  # that of a step over the kink
    assert found[1] == pytest.approx(run.t[-1], rel=1e-6)
    assert (found[1] < rise_time) == (rise_time > 1)


def test_stops_are_mirrored_by_the_other_axle():
    mirrored = replace(BICYCLE, cg_behind_front=1.02 - 0.62)
    for force in (100.0, 400.0, 900.0):
        one = vehicle.slow_down(BICYCLE, LEVEL, AT_ONCE, force, 0.3, "front")
        two = vehicle.slow_down(mirrored, LEVEL, AT_ONCE, force, 0.7, "rear")
        assert one.distance == pytest.approx(two.distance, rel=1e-14)
        assert one.front_force == pytest.approx(two.rear_force, rel=1e-13)


@pytest.mark.parametrize("pull", [-7.0, -0.3])
def test_a_stop_early_in_the_rise_keeps_its_digits(pull):
    """Speed V + p t - r t^2 / (2 t2) = 0 in 40 digits: uphill, p and the root of p^2 + ... nearly cancel."""
    speed, rate, rise_time = 0.05, 0.5, 150.0
    with mp.workdps(40):
        p, r, t2 = mpf(pull), mpf(rate), mpf(rise_time)
        time = (p + mp.sqrt(p**2 + 2 * r * mpf(speed) / t2)) * t2 / r
        way = mpf(speed) * time + p * time**2 / 2 - r * time**3 / (6 * t2)
        found = to_rest(speed, pull, rate, rise_time, True)
        np.testing.assert_allclose(
            [float(x / y) for x, y in zip(found, (way, time), strict=True)], 1, rtol=1e-14
        )
