"""Stops that heat a brake: energy, a differential equation, closed forms, and where no stop ends."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from brakes import drum, machines

CURVE = np.array([[280.0, 0.4], [310.0, 0.45], [450.0, 0.2]])
BAND = machines.Band(0.2, 0.05, wrap=3.9, force_arm=0.5, first_arm=0.1)


def torque_of_band(friction):
    return machines.solve_brake(BAND, friction=friction, force=2000.0).torque


def drum_of(friction):
    shoe = drum.Shoe(0.138, 0.05, np.radians((30, 110)), pivot=(0.02, -0.11), force_arm=0.115)
    return drum.brake_torque(drum.simplex(shoe), friction=friction, force=5000.0).torque


@pytest.mark.parametrize("free", [0.0, 10.0])  # angle before the torque is there
@pytest.mark.parametrize("torque_at", [torque_of_band, drum_of])
def test_a_stop_is_that_of_its_differential_equation(torque_at, free):
    """Motion and heat, integrated in time, know nothing of the quadrature over the temperature."""
    load = 300.0
    duty = drum.Duty(60.0, 90.0, 8.0, load_torque=load, free_angle=free, stops=2, interval=30.0,
                     cooling=20.0, friction_curve=CURVE)  # fmt: skip
    found = drum.repeat_stops(duty, 0.4, torque_at)

    def rates(_, y):
        torque = float(torque_at(np.interp(y[2], *CURVE.T)))
        return [y[1], -(torque - load) / 60.0, torque * y[1] / duty.capacity]

    def standing(_, y):
        return y[1]

    standing.terminal = True
    start = [free, np.sqrt(90.0**2 + 2 * load * free / 60.0), found.start[1]]
    run = solve_ivp(rates, (0, 1e5), start, "DOP853", events=standing, rtol=1e-10, atol=1e-9)
    angle, _, end = run.y[:, -1]
    assert found.angle[1] == pytest.approx(angle, rel=1e-8)  # that of the integration over a knot
    assert found.end[1] == pytest.approx(end, rel=1e-9)
    assert found.error < 1e-12


def test_energy_is_kept_over_random_duties():
    rng = np.random.default_rng(7)
    inertia, speed, mass = rng.uniform(1, 30, 500), rng.uniform(5, 60, 500), rng.uniform(4, 20, 500)
    load = rng.uniform(0, 200, 500)
    duty = drum.Duty(inertia, speed, mass, load_torque=load, stops=3, cooling=30.0, interval=50.0,
                     friction_curve=CURVE)  # fmt: skip
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu)
    ended = found.status == "stops"
    assert ended.sum() > 300
    put_in = (inertia * speed**2 / 2 + load * found.angle)[:, ended]
    np.testing.assert_allclose(found.heat[:, ended], put_in, rtol=1e-10)  # sums of one quadrature
    cooled = 293.15 + (found.end[:-1] - 293.15) * duty.kept
    # The heights above the surroundings are kept, and rounded when added: one rounding of a temperature.
    np.testing.assert_allclose(found.start[1:][:, ended], cooled[:, ended], rtol=4e-16)


def test_angle_of_a_straight_curve_in_closed_form():
    """M falls in a straight line: the angle is the heat over the logarithmic mean of its ends."""
    duty = drum.Duty(40.0, 60.0, 5.0, friction_curve=[[293.15, 0.4], [393.15, 0.2]])
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu)
    rise = 40.0 * 60.0**2 / 2 / 2500.0
    first, last = 400.0, 400.0 - 2.0 * rise
    assert found.hottest == pytest.approx(rise, rel=1e-13)
    assert found.angle[0] == pytest.approx(2500.0 * rise * np.log(first / last) / (first - last), rel=1e-13)


def test_the_lining_fades_and_the_stops_lengthen():
    duty = drum.Duty(20.0, 50.0, 5.0, stops=5, friction_curve=[[293.15, 0.4], [393.15, 0.2]])
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu)
    assert (np.diff(found.angle) > 0).all()
    np.testing.assert_allclose(found.heat, 25000.0, rtol=1e-12)  # the energy is the same


def test_many_stops_settle_where_the_contraction_says():
    duty = drum.Duty(20.0, 50.0, 5.0, stops=200, interval=40.0, cooling=10.0)
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu)
    assert found.hottest == pytest.approx(found.settled, rel=1e-12)
    assert found.settled == pytest.approx(10.0 / -np.expm1(-10.0 * 40.0 / 2500.0), rel=1e-13)
    without = drum.repeat_stops(drum.Duty(20.0, 50.0, 5.0), 0.4, lambda mu: 1000.0 * mu)
    assert without.settled == np.inf


def test_a_stop_ends_up_to_the_load_at_which_the_lining_fades_before():
    """The largest load that is stopped: the speed vanishes where torque and load are equal, at the extremum.

    With M = 1000 mu, mu = 0.4 - (T - T0) / 500, C = 2500: the heat of the stop x rises until M = L, where
    x - L int dx / M is largest, and J w^2 / (2 C) must not exceed that.
    """
    load = 250.0
    most = 75.0 - load * np.log(400.0 / load) / 2.0  # K: x - L ln(M0 / M) / 2 at x = 75
    curve = [[293.15, 0.4], [443.15, 0.1]]
    for part, status in ((1 - 1e-9, "stops"), (1 + 1e-9, "never stops")):
        duty = drum.Duty(
            2 * 2500.0 * most * part / 50.0**2, 50.0, 5.0, load_torque=load, friction_curve=curve
        )
        assert drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu).status == status


@pytest.mark.parametrize("load", [0.0, 5.0])
def test_a_brake_without_friction_never_stops_without_a_warning(load):
    """Its torque is 0: the angle of a stop was a division by 0."""
    duty = drum.Duty(20.0, 50.0, 5.0, load_torque=load, stops=3)
    assert drum.repeat_stops(duty, 0.0, lambda mu: 1000.0 * mu).status == "never stops"


def test_cases_together_are_those_one_by_one():
    loads, stops = np.array([0.0, 100.0, 350.0]), np.array([1.0, 3.0, 2.0])
    given = {"inertia": 40.0, "speed": 50.0, "heated_mass": 6.0, "friction_curve": CURVE}
    both = drum.repeat_stops(drum.Duty(**given, load_torque=loads, stops=stops), 0.4, torque_of_band)
    for k, (load, number) in enumerate(zip(loads, stops, strict=True)):
        one = drum.repeat_stops(drum.Duty(**given, load_torque=load, stops=number), 0.4, torque_of_band)
        assert both.status[k] == one.status
        for name in ("hottest", "last_angle", "last_friction", "energy"):  # rounding of sums in another order
            np.testing.assert_allclose(getattr(both, name)[k], getattr(one, name), rtol=1e-14)


def test_the_stop_that_does_not_end_is_named():
    """Alone and among other cases, with its number if there are several."""
    curve = [[293.15, 0.4], [393.15, 0.15]]
    stops = np.array([2.0, 9.0, 1.0])
    duty = drum.Duty(20.0, np.array([50.0, 50.0, 500.0]), 5.0, stops=stops, friction_curve=curve)
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu)
    assert found.status.tolist() == ["stops", "stops", "too hot"]
    assert list(found.messages_of_cases(3)) == [2]
    assert found.messages_of_cases(3)[2].startswith("the brake gets hotter")  # of a single stop no number
    faded = drum.repeat_stops(replace(duty, load_torque=200.0), 0.4, lambda mu: 1000.0 * mu)
    said = faded.messages_of_cases(3)
    assert list(said) == [1, 2] and "never stops" in said[1]
    for k in (1, 2):
        alone = drum.repeat_stops(
            replace(duty, speed=duty.speed[k], stops=stops[k], load_torque=200.0), 0.4, lambda mu: 1000.0 * mu
        )
        assert alone.refusals == (said[k],)
    ended = np.isfinite(faded.end[:, 1])
    assert said[1].startswith(f"stop {ended.sum() + 1} of 9: ") and 1 <= ended.sum() < 8


def test_pressure_times_speed_is_compared_case_by_case():
    """A case that keeps its limit lends neither its product nor its limit to the sentence."""
    duty = drum.Duty(20.0, 50.0, 5.0, most_pv=np.array([20e6, 4e6, 30e6]))
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu, pv=np.array([10e6, 5e6, np.nan]))
    assert found.warnings == (
        "pressure times rubbing speed of the linings reaches 5 MW/m2, above most_pv = 4 MW/m2",
    )
    assert replace(found, pv=np.array([1e6, 1e6, np.nan])).warnings == ()


@pytest.mark.parametrize(
    ("given", "said"),
    [
        ({"stops": 1.5}, "stops = 1.5: give a whole number"),
        ({"friction_curve": [[300.0, 0.4], [290.0, 0.3]]}, "the temperatures must increase"),
        ({"friction_curve": [[300.0, 0.4], [400.0, 0.3]]}, "below the first temperature"),
        ({"friction_curve": [[290.0, 0.4]]}, "two or more"),
        ({"speed": 0.0}, "speed"),
    ],
)
def test_bad_duties_are_refused(given, said):
    with pytest.raises(ValueError, match=said):
        drum.Duty(**{"inertia": 20.0, "speed": 50.0, "heated_mass": 5.0} | given)


@pytest.mark.parametrize("change", [-1e-13, 0.0, 1e-13])
def test_the_thirteenth_digit_does_not_put_a_curve_above_the_surroundings(change):
    """Temperatures in two units differ by rounding: "it is below the first temperature ..., 293.15 K"."""
    curve = [[293.15 * (1 + change), 0.4], [393.15, 0.4]]
    found = drum.repeat_stops(
        drum.Duty(20.0, 1e-6, 5.0, friction_curve=curve), 0.4, lambda mu: 1000.0 * mu
    )  # it warms by less than that
    assert found.angle[0] == pytest.approx(2.5e-14, rel=1e-13)


def test_a_curve_at_which_the_band_locks_is_refused():
    differential = replace(BAND, second_arm=0.02)
    duty = drum.Duty(20.0, 50.0, 5.0, friction_curve=[[290.0, 0.3], [400.0, 0.6]])
    with pytest.raises(ValueError, match=r"friction_curve = 0\.6: at this friction the brake locks"):
        drum.repeat_stops(
            duty, 0.3, lambda mu: machines.solve_brake(differential, friction=mu, force=2000.0).torque
        )


@pytest.mark.parametrize("law", ["wear", "pressure"])
def test_pressure_times_radius_is_largest_at_the_rubbing_radius(law):
    disc = machines.Disc(0.08, 0.12, pad_angle=1.0, pressure_law=law)
    radius = np.linspace(0.08, 0.12, 101)
    assert disc.rubbing_radius == pytest.approx((disc.pressure(radius, 0.4) * radius).max(), rel=1e-14)


def test_no_rounding_makes_a_lining_of_constant_friction_too_hot():
    """A stop against a load L warms by J w^2/(2 m c) M/(M - L), whatever the 13th digit of the inputs."""
    for mass in np.geomspace(1e-3, 1e4, 200):
        for load in (0.0, 50.0):
            duty = drum.Duty(inertia=50.0, speed=10 * np.pi, heated_mass=float(mass), load_torque=load)
            found = drum.repeat_stops(duty, 0.35, lambda mu: 750.0 * np.asarray(mu))
            rise = duty.rise_of_a_stop * 262.5 / (262.5 - load)
            assert found.status == "stops"
            assert found.hottest == pytest.approx(rise, rel=1e-12, abs=1e-12)  # of temperatures near 293 K


@pytest.mark.parametrize("speed", [50.0, 1.0, 1e-2, 1e-6])
@pytest.mark.parametrize("part", [0.0, 0.99, 1 - 1e-6, 1 - 1e-9])  # of the torque, which the load has
@pytest.mark.parametrize("curve", [None, [[293.15, 0.4], [1e11, 0.4]]])
def test_angles_of_gentle_stops_and_of_stops_beside_a_load_keep_within_their_error(speed, part, curve):
    """A stop of constant friction: J w^2 / 2 = (M - L) q; a gentle one warms the brake by nanokelvins."""
    load = 400.0 * part
    duty = drum.Duty(20.0, speed, 5.0, load_torque=load, friction_curve=curve)
    found = drum.repeat_stops(duty, 0.4, lambda mu: 1000.0 * mu)
    exact = 20.0 * speed**2 / 2 / (400.0 - load)  # M - L has no rounding
    assert abs(found.angle[0] / exact - 1) <= found.error < 1e-14 / (1 - part)
    assert found.hottest == pytest.approx(400.0 * exact / 2500.0, rel=float(found.error))
