"""Chain and vehicle by second routes: free bodies solved as equations, virtual work, and forwards again."""

import dataclasses

import numpy as np
import pytest
from mpmath import mp, mpf
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

from brakes import chain, vehicle

CASES = 1000
SAME = 1e-9  # of two routes, each with some ten sums
BACK = 1e-10  # forwards again after backwards


def random_vehicles(rng, n=CASES):
    wheelbase = rng.uniform(0.9, 4.0, n)
    arm = wheelbase * rng.uniform(0.1, 0.9, n)
    return vehicle.Vehicle(rng.uniform(50, 2e4, n), arm, rng.uniform(0.2, 1.5, n), wheelbase)


def one(v, i):
    return vehicle.Vehicle(*(float(x[i]) for x in vars(v).values()))


def free_body(v, slope, front, rear, leading):
    """Axle loads and acceleration down the slope from three equations in vertical axes, x downhill.

    Braking forces up the slope are front + front_mu N_A and likewise at the rear, given as pairs.
    """
    sense = 1.0 if leading == "rear" else -1.0
    down = np.array([np.cos(slope), -np.sin(slope)])
    up = np.array([np.sin(slope), np.cos(slope)])
    places = [-sense * v.cg_behind_front * down - v.cg_height * up]
    places.append(sense * (v.wheelbase - v.cg_behind_front) * down - v.cg_height * up)
    columns, constant = [], np.array([0.0, -v.mass * 9.806, 0.0])
    for place, (fixed, mu) in zip(places, (front, rear), strict=True):
        per_load, force = up - mu * down, -fixed * down
        columns.append([*per_load, place[0] * per_load[1] - place[1] * per_load[0]])
        constant += [*force, place[0] * force[1] - place[1] * force[0]]
    matrix = np.array([*columns, [*(-v.mass * down), 0.0]]).T
    return np.linalg.solve(matrix, -constant)


@pytest.mark.parametrize("leading", ["front", "rear"])
def test_load_transfer_and_slipping_are_those_of_the_free_body(leading):
    rng = np.random.default_rng(1)
    many, mu = random_vehicles(rng), rng.uniform(0.1, 0.5, CASES)
    for i in range(0, CASES, 25):
        v = one(many, i)
        for braked in ("front", "rear", "both"):
            slope = float(np.arctan(v.slipping_ratio(mu[i], braked, leading)))
            grips = [(0.0, mu[i] if braked in (axle, "both") else 0.0) for axle in ("front", "rear")]
            front, rear, acceleration = free_body(v, slope, *grips, leading)
            assert abs(acceleration) < SAME * 9.806  # at the slipping slope gravity and grip are equal
            weight = v.mass * 9.806 * np.cos(slope)
            loads = [weight * v.load_share(axle, np.tan(slope), leading) for axle in ("front", "rear")]
            assert loads == pytest.approx([front, rear], abs=SAME * weight)


@pytest.mark.parametrize("leading", ["front", "rear"])
def test_tipping_by_virtual_work(leading):
    """Past the largest slope a turn about where the lower tyre stands lowers the centre of gravity."""
    many = random_vehicles(np.random.default_rng(2))
    found = vehicle.hold(many, vehicle.Road(0.1, 2.0), "both", leading).tipping_slope
    arm = many.cg_behind_front if leading == "front" else many.wheelbase - many.cg_behind_front
    step = 1e-30  # of a complex step: exact
    lever = arm + 1j * many.cg_height  # from the lower tyre, up the slope and normal to it
    work = np.array([
        ((x * np.sin(b - 1j * step) + h * np.cos(b - 1j * step)).imag / step)
        for x, h, b in zip(lever.real, lever.imag, found, strict=True)
    ])  # fmt: skip
    assert np.abs(work) == pytest.approx(0.0, abs=SAME * float(np.max(np.abs(lever))))


@pytest.mark.parametrize("leading", ["front", "rear"])
def test_the_first_axle_to_lock_is_that_of_the_free_body(leading):
    rng = np.random.default_rng(3)
    many, mu, share = random_vehicles(rng), rng.uniform(0.2, 1.0, CASES), rng.uniform(0.05, 0.95, CASES)
    found, kinds = vehicle.braking_limits(many, mu, share, leading), set()
    for i in range(0, CASES, 25):
        v, weight = one(many, i), float(many.mass[i]) * 9.806

        def used(ratio, v=v, weight=weight, i=i):
            parts = share[i] * ratio * weight, (1 - share[i]) * ratio * weight
            front, rear, _ = free_body(v, 0.0, (parts[0], 0.0), (parts[1], 0.0), leading)
            return np.array([mu[i] * front - parts[0], mu[i] * rear - parts[1], front, rear]) / weight

        end = brentq(lambda ratio, used=used: used(ratio).min(), 0.0, 20.0, xtol=1e-14)
        assert found.largest[i] == pytest.approx(end, rel=SAME)
        kinds.add(str(found.first[i]))
        first = {"front": 0, "rear": 1}.get(str(found.first[i]))
        lifted = min(used(end)[2:])
        assert lifted < SAME if first is None else used(end)[first] == pytest.approx(0.0, abs=SAME)
    assert {"front", "rear"} <= kinds


def trucks(rng, n=CASES):
    base = rng.uniform(1.5, 3.0, n)
    return vehicle.Truck(
        rng.uniform(3e3, 1e4, n), (base * rng.uniform(0.5, 0.7, n), rng.uniform(0.2, 0.5, n)),
        rng.uniform(0.0, 2e3, n), (-rng.uniform(0.5, 1.0, n), rng.uniform(0.2, 0.6, n)),
        front_wheel_radius=rng.uniform(0.3, 0.5, n), wheelbase=base,
    )  # fmt: skip


def conditions(rng, direction="reverse", n=CASES, steep=0.1):
    return vehicle.StopConditions(
        rng.uniform(0.0, steep, n), rng.uniform(2.0, 10.0, n), rng.uniform(0.3, 0.55, n),
        rng.uniform(0.0, 1.0, n), rng.uniform(0.0, 1.5, n), direction=direction,
    )  # fmt: skip


def test_the_smaller_of_brake_and_road_brakes_and_the_change_over_is_exact():
    """Over friction and slope; the second route of the acceleration is the free body."""
    rng = np.random.default_rng(4)
    truck, c = trucks(rng), conditions(rng, steep=0.3)
    locked = vehicle.stop(truck, c)
    enough = vehicle.stop(truck, c, locked.torque_per_brake)
    assert np.array_equal(enough.distance, locked.distance) and np.all(enough.limited_by == "road")
    factor = rng.uniform(0.2, 1.8, CASES)
    found = vehicle.stop(truck, c, factor * locked.torque_per_brake)
    strong = factor >= 1
    assert np.array_equal(strong, found.limited_by == "road")
    for name in ("distance", "acceleration", "front_load", "torque_per_brake"):
        assert np.array_equal(getattr(found, name)[strong], getattr(locked, name)[strong])
    for i in np.flatnonzero(~strong)[::25]:
        force = float(found.brake_force[i])
        front, rear, acceleration = free_body(
            one(truck.vehicle, i), float(c.slope[i]), (force, 0.0), (0.0, 0.0), "rear"
        )
        assert found.acceleration[i] == pytest.approx(acceleration, abs=SAME * 9.806)
        assert [found.front_load[i], found.rear_load[i]] == pytest.approx([front, rear], rel=SAME)
    least = vehicle.stop(truck, c, locked.torque_per_brake * (1 - 1e-12))
    assert np.all(least.limited_by == "brake")
    assert least.acceleration == pytest.approx(locked.acceleration, abs=1e-10)


@pytest.mark.parametrize("friction", [0.5, 0.7228915662650602, 0.75, 1.2])
def test_weak_brakes_do_not_hang_on_a_road_that_no_wheel_of_a_tall_truck_locks_on(friction):
    """Forwards the front axle presses the harder it brakes: at h = 1.66 m it never locks from L / h on."""
    truck = vehicle.Truck(2000.0, (0.6, 1.2), 500.0, (-0.3, 2.0), front_wheel_radius=0.3, wheelbase=1.2)
    c = vehicle.StopConditions(0.05, 4.0, friction, 0.5, 0.3, direction="forward")
    found = vehicle.stop(truck, c, most_torque=300.0)
    assert (found.torque_per_brake, found.limited_by) == (300.0, "brake")
    pull = 9.806 * np.sin(0.05)
    assert found.acceleration == pytest.approx(pull - 2 * 300.0 / 0.3 / 2500.0, rel=1e-13)


def test_a_gentle_pedal_stops_a_truck_that_locked_wheels_would_overturn():
    """Forwards with a load ahead: over the front axle before any wheel locks."""
    truck = vehicle.Truck(5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89)
    c = vehicle.StopConditions(0.02, 20 / 3.6, 0.7, 0.5, 0.3, direction="forward")
    line = chain.HydraulicLine(master_bore=0.02222, cylinder_bore=0.03175)
    found = chain.brake_from_pedal(truck, c, chain.Pedal(5.0, 60.0), line, 0.728)
    assert np.array_equal(found.stop.distance, vehicle.stop(truck, c, found.available_torque).distance)
    assert found.limited_by == "brake" and found.locking_torque == np.inf
    assert (
        found.locking.message == "none: the truck would overturn over its front axle before the wheels lock"
    )
    with pytest.raises(ValueError, match="or press less"):
        chain.brake_from_pedal(truck, c, chain.Pedal(5.0, 450.0, booster=3.0), line, 0.728)


@pytest.mark.parametrize("part", [0.3, 1 - 1e-4, 1 - 3.764597633626465e-09])
def test_the_stated_error_covers_that_of_a_slope_on_which_a_vehicle_rolls(part):
    """sin(beta) = R / (M g), in 30 digits: beside 90 deg its rounding counts by 1 / cos(beta)."""
    mass, gravity = 1893.7313, 9.8061
    force = np.float64(mass) * gravity * part * (1 + np.arange(-20, 20) * 1e-15)
    standing, road = vehicle.Vehicle(mass, 0.6, 1.0, 1.5), vehicle.Road(0.1, 0.8, gravity)
    found = vehicle.hold(standing, road, brake_force=force)
    with mp.workdps(30):
        exact = [mp.asin(mpf(float(each)) / (mpf(mass) * mpf(gravity))) for each in force]
        wrong = [
            abs(float(x - y)) for x, y in zip(map(mpf, found.rolling_slope.tolist()), exact, strict=True)
        ]
    assert max(wrong) < found.error < 1e-9


def test_the_energy_of_a_stop_is_that_of_speed_and_height():
    rng = np.random.default_rng(5)
    truck, c = trucks(rng), conditions(rng)
    for torque in (None, 0.8 * vehicle.stop(truck, c).torque_per_brake):
        stop = vehicle.stop(truck, c, torque)
        heat = chain.heat_of_stop(stop)
        done = stop.stops
        assert np.mean(done) > 0.9 and np.array_equal(done, np.isfinite(heat.energy))
        fall = np.sin(c.slope) * (stop.distance - stop.reaction_distance)
        by_height = truck.mass * (c.speed**2 / 2 + c.gravity * fall)
        assert heat.energy[done] == pytest.approx(by_height[done], rel=SAME)
        assert (heat.drum_energy + heat.tyre_energy)[done] == pytest.approx(heat.energy[done], rel=1e-14)
        rolling = (stop.limited_by == "brake") | (stop.braking_distance == 0)
        assert np.array_equal((heat.tyre_energy == 0)[done], rolling[done])


def test_friction_backwards_is_inverted_forwards():
    rng = np.random.default_rng(6)
    many, slope = random_vehicles(rng), rng.uniform(0.01, 0.7, CASES)
    for braked in ("front", "rear", "both"):
        for downhill in ("front", "rear"):
            found = vehicle.friction_to_hold(many, slope, braked, downhill)
            there = found.reason == ""
            again = vehicle.hold(
                many, vehicle.Road(slope, np.where(there, found.value, 1.0)), braked, downhill
            )
            assert again.slipping_slope[there] == pytest.approx(slope[there], rel=BACK)
            assert 0.2 * CASES < there.sum() < CASES
            for friction in np.linspace(0.05, 2.0, 40):  # none: no friction holds
                tried = vehicle.hold(many, vehicle.Road(slope, friction), braked, downhill)
                assert np.all(tried.largest_slope[~there] <= slope[~there] * (1 + BACK))


@pytest.mark.parametrize("direction", ["reverse", "forward"])
def test_a_stopping_distance_backwards_is_inverted_forwards(direction):
    rng = np.random.default_rng(7)
    truck, c = trucks(rng), conditions(rng, direction)
    wanted = c.speed * c.reaction_time + rng.uniform(0.2, 4.0, CASES) * c.speed**2 / 9.806
    found = vehicle.friction_to_stop(truck, c, wanted)
    there = found.reason == ""
    assert 0.3 * CASES < there.sum() < CASES
    again = vehicle.stop(truck, dataclasses.replace(c, friction=np.where(there, found.value, 0.3)))
    assert again.distance[there] == pytest.approx(wanted[there], rel=BACK)
    assert {"stops", "stops in the rise time"} <= set(again.status[there].tolist())
    a, h = truck.vehicle.cg_behind_front, truck.vehicle.cg_height
    for friction in np.linspace(0.05, 2.0, 20):  # none: the distance falls with friction, up to pitching over
        most = np.minimum(friction, 0.999 * a / h) if direction == "forward" else friction * np.ones(CASES)
        tried = vehicle.stop(truck, dataclasses.replace(c, friction=most))
        assert np.all(tried.distance[~there] > wanted[~there])


def random_chains(rng, n=CASES):
    lines = (
        chain.HydraulicLine(
            rng.uniform(0.01, 0.03, n), rng.uniform(0.015, 0.04, n), pistons=4.0,
            piston_travel=rng.uniform(0, 1e-3, n), lost_travel=rng.uniform(0, 2e-3, n),
            compliance=rng.uniform(0, 1e-12, n), most_pressure=rng.uniform(5e6, 3e7, n),
        ),
        chain.BrakeCable(
            rng.uniform(1, 8, n), rng.uniform(0.5, 1, n), rng.uniform(0, 3e-3, n),
            lost_travel=rng.uniform(0, 3e-3, n), stretch=rng.uniform(0, 2e-6, n),
        ),
    )  # fmt: skip
    pedal = chain.Pedal(
        rng.uniform(3, 9, n), rng.uniform(50, 450, n), booster=rng.uniform(1, 5, n),
        runout=rng.uniform(500, 3000, n), travel=rng.uniform(0.1, 0.4, n),
    )  # fmt: skip
    return pedal, lines


@pytest.mark.parametrize("kind", [0, 1], ids=["line", "cable"])
def test_force_and_ratio_of_a_pedal_backwards_are_inverted_forwards(kind):
    rng = np.random.default_rng(8)
    pedal, lines = random_chains(rng)
    line, wanted = lines[kind], rng.uniform(500, 2e4, CASES)
    free = dataclasses.replace(pedal, travel=None)
    loose = line if kind else dataclasses.replace(line, most_pressure=None)
    for solve, name in ((chain.force_for, "force"), (chain.ratio_for, "ratio")):
        found = solve(pedal, line, wanted)
        there = found.reason == ""
        assert 0.05 * CASES < there.sum() < CASES
        with_it = dataclasses.replace(free, **{name: np.where(there, found.value, 1.0)})
        assert chain.actuate(with_it, loose).actuator_force[there] == pytest.approx(wanted[there], rel=BACK)
        for tried in np.geomspace(0.1, 20.0, 60)[:, None] * getattr(
            pedal, name
        ):  # none: all that reach it are refused
            made = chain.actuate(dataclasses.replace(free, **{name: tried}), loose)
            over = made.pedal_travel > pedal.travel * (1 - BACK)
            over |= np.zeros(CASES, bool) if kind else made.pressure > line.most_pressure * (1 - BACK)
            assert np.all(over[~there] | (made.actuator_force[~there] < wanted[~there]))


def test_a_line_does_no_work_of_its_own():
    """Force times travel of the pedal is that of the pistons, without lost travel, compliance and booster."""
    line = chain.HydraulicLine(0.02, 0.03, pistons=4.0, piston_travel=1e-3)
    found = chain.actuate(chain.Pedal(ratio=5.0, force=300.0), line)
    assert found.pedal_force * found.pedal_travel == pytest.approx(4 * 1e-3 * found.actuator_force, rel=1e-14)


@pytest.mark.parametrize("downhill", ["front", "rear"])
@pytest.mark.parametrize("braked", ["front", "rear", "both"])
def test_a_vehicle_that_does_not_hold_moves_as_its_free_body(braked, downhill):
    """Loads of the free body whose braked wheels are at the limit of friction, or of the brake."""
    rng = np.random.default_rng(11)
    seen = set()
    for _ in range(200):
        L, h, mu = 2.0, rng.uniform(0.3, 1.5), rng.uniform(0.2, 1.2)
        a, slope, most = rng.uniform(0.2, 1.8), rng.uniform(0.05, 0.78), rng.uniform(50.0, 900.0)
        v = vehicle.Vehicle(100.0, cg_behind_front=a, cg_height=h, wheelbase=L)
        found = vehicle.hold(v, vehicle.Road(slope, mu, gravity=10.0), braked, downhill, most)
        seen.add(str(found.status))
        if found.status not in ("slips", "rolls"):
            continue
        # N_front, N_rear, R: forces across the ground, moments about the centre of gravity, the law of R.
        sense = 1.0 if downhill == "front" else -1.0  # braking loads the lower axle
        law = [float(braked != "rear"), float(braked != "front")] if found.status == "slips" else [0.0, 0.0]
        matrix = [[1.0, 1.0, 0.0], [a, -(L - a), -sense * h], [-mu * law[0], -mu * law[1], 1.0]]
        given = [1000.0 * np.cos(slope), 0.0, 0.0 if found.status == "slips" else most]
        front, rear, force = np.linalg.solve(matrix, given)
        assert min(front, rear) > 0 and force < 1000.0 * np.sin(
            slope
        )  # it stands on both axles, and runs away
        assert force <= most * (1 + 1e-12)  # rounding: the brake can give it
        assert [found.front_load, found.rear_load, found.braking_force] == pytest.approx(
            [front, rear, force], rel=SAME
        )
    assert {"holds", "slips", "rolls"} <= seen


def faded(slope=0.1, rise_time=0.0, **repeated):
    """A truck's stops that follow each other, with a brake whose torque is in proportion to friction."""
    truck = vehicle.Truck(
        5950.0, (1.049, 0.359), 3500.0, (-1.2, 0.45), front_wheel_radius=0.4, wheelbase=1.89
    )
    conditions = vehicle.StopConditions(slope, 20 / 3.6, 0.7, reaction_time=0.0, rise_time=rise_time)
    line = chain.HydraulicLine(0.02222, 0.03175)
    braked = chain.brake_from_pedal(truck, conditions, chain.Pedal(5.0, 600.0), line, 0.728)
    drums = chain.Drums(18.0, 0.05)
    found = chain.fade_of_stops(braked, drums, 0.39, lambda mu: 0.728 * np.asarray(mu) / 0.39, **repeated)
    return braked, found


def test_heat_of_repeated_stops_is_the_energy_of_the_truck():
    curve = [[293.15, 0.39], [333.15, 0.3], [493.15, 0.2]]
    braked, found = faded(stops=4, interval=30.0, cooling=20.0, friction_curve=curve)
    truck, c = braked.stop.truck, braked.stop.conditions
    way = found.angle * truck.front_wheel_radius
    energy = truck.mass * (c.speed**2 / 2 + c.gravity * np.sin(c.slope) * way)
    assert 2 * found.heat == pytest.approx(energy, rel=1e-10)  # two brakes; the angle is a quadrature
    assert np.all(np.diff(way) > 0)


def test_a_fading_stop_is_that_of_its_equation_of_motion():
    curve = np.array([[293.15, 0.39], [333.15, 0.3], [493.15, 0.2]])
    braked, found = faded(stops=1, friction_curve=curve.tolist())
    truck, c, force = braked.stop.truck, braked.stop.conditions, braked.actuation.actuator_force
    r, pull = truck.front_wheel_radius, c.gravity * np.sin(c.slope)

    def slopes(t, y):
        torque = 0.728 * np.interp(y[2], *curve.T) / 0.39 * force
        return [y[1], pull - 2 * torque / r / truck.mass, torque * y[1] / r / (18.0 * 500.0)]

    def rest(t, y):
        return y[1]

    rest.terminal = True  # type: ignore[attr-defined]
    run = solve_ivp(slopes, (0, 60), [0.0, c.speed, 293.15], "DOP853", events=rest, rtol=1e-12, atol=1e-12)
    way, _, end = run.y_events[0][0]
    assert found.angle * r == pytest.approx(way, rel=1e-8)  # kinks of the curve within steps
    assert found.end == pytest.approx(end, rel=1e-9)


@pytest.mark.parametrize("rise_time", [0.0, 0.3, 30.0])  # it stops while the force rises in the last one
@pytest.mark.parametrize("slope", [0.0, 0.1])
def test_without_a_curve_repeated_stops_are_the_stop(slope, rise_time):
    braked, found = faded(slope, rise_time, stops=2)
    assert str(braked.stop.limited_by) == "brake"
    assert found.angle * 0.4 == pytest.approx(float(braked.stop.distance), rel=1e-12)
    energy = float(chain.heat_of_stop(braked.stop).energy)
    assert 2 * found.heat == pytest.approx(energy, rel=1e-12)  # differences of some hundred kelvins
