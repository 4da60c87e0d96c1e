"""Motions: consistent in angle, speed and acceleration, as published."""

import math
import pickle

import mpmath as mp
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

import beamdyn
from beamdyn.scene.motion.base import Line, check_consistent, check_picklable
from beamdyn.scene.motion.rolling import RoadWave, RollingWheel, UserMotion
from beamdyn.scene.motion.rotations import Rotation, RotationFunction, SampledRotation, SpinUp, SteadyRotation
from tests.unit.motions import (
    CORNERS,
    HEIGHT,
    MOTIONS,
    PUBLISHED,
    ROTATIONS,
    TABLE,
    USER,
    gauss,
    name,
    pieces_of,
    shaken,
)
from tests.unit.refusals import refused

# Consistency ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_speed_and_acceleration_integrate_to_angle_and_speed(motion):
    for a, b in pieces_of(motion):
        ends = motion.at(np.array([a, b]))
        turned = gauss(lambda t: motion.at(t).speed, a, b)
        gained = gauss(lambda t: motion.at(t).acceleration, a, b)
        assert np.diff(ends.angle)[0] == pytest.approx(turned, rel=1e-12, abs=1e-12)
        assert np.diff(ends.speed)[0] == pytest.approx(gained, rel=1e-12, abs=1e-12)


LAWS = st.sampled_from(["smooth", "linear"])
DURATIONS = st.floats(-3, math.log10(6e5)).map(lambda x: 10**x)  # a millisecond to a week


@given(LAWS, DURATIONS, st.floats(-200, 200), st.floats(0, 1), st.floats(0, 1))
def test_spin_up_integrates(law, duration, speed, x, y):
    motion, (a, b) = SpinUp(speed, duration, law), sorted([x * duration, y * duration])
    ends = motion.at(np.array([a, b]))
    assert np.diff(ends.angle)[0] == pytest.approx(
        gauss(lambda t: motion.at(t).speed, a, b), rel=1e-10, abs=1e-14 * (1 + abs(speed)) * duration
    )
    assert np.diff(ends.speed)[0] == pytest.approx(
        gauss(lambda t: motion.at(t).acceleration, a, b), rel=1e-10, abs=1e-14 * (1 + abs(speed))
    )


@given(LAWS, DURATIONS, st.floats(1, 3))
def test_any_spin_up_passes_the_check(law, duration, length):
    check_consistent(SpinUp(55.0, duration, law), length * duration)


@pytest.mark.parametrize("duration", [1e-3, 0.1])
@pytest.mark.parametrize("law", ["smooth", "linear"])
def test_short_spin_up_is_no_jump(law, duration):
    check_consistent(SpinUp(55.0, duration, law), 30.0)


@given(DURATIONS, st.floats(-6, 0).map(lambda x: 10**x))
def test_smooth_law_keeps_all_digits(duration, x):
    t = x * duration
    sample = SpinUp(1.0, duration).at(np.array(t))
    with mp.workdps(60):
        T, X = mp.mpf(duration), mp.mpf(t) / mp.mpf(duration)
        angle = T * (X**2 / 2 + (mp.cos(2 * mp.pi * X) - 1) / (4 * mp.pi**2))
        speed = X - mp.sin(2 * mp.pi * X) / (2 * mp.pi)
    assert float(sample.angle / angle) == pytest.approx(1, abs=4e-15)
    assert float(sample.speed / speed) == pytest.approx(1, abs=4e-15)


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_angle_and_speed_continue_at_breakpoints(motion):
    for t in motion.breakpoints:
        before, after = (motion.at(np.nextafter(t, t + side)) for side in (-1, 1))
        assert before.angle == pytest.approx(float(after.angle), rel=1e-13)
        assert before.speed == pytest.approx(float(after.speed), rel=1e-13)


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
@pytest.mark.parametrize("shape", [(), (3,), (2, 3), (0,)])
def test_any_shape_of_times(motion, shape):
    t = np.linspace(0.1, 3.9, math.prod(shape)).reshape(shape)
    sample = motion.at(t)
    assert sample.angle.shape == sample.speed.shape == sample.acceleration.shape == shape
    assert sample.carrier_acceleration.shape == (*shape, 3)
    alone = [motion.at(one).angle for one in t.ravel()]
    np.testing.assert_allclose(sample.angle.ravel(), alone, rtol=1e-14)


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_speed_is_constant_from_the_steady_start(motion):
    if motion.steady_start < math.inf:
        start = motion.steady_start
        sample = motion.at(start + np.linspace(0, min(20.0, motion.end - start), 7))
        assert (sample.speed == motion.final_speed).all()
        assert (sample.acceleration == 0).all()


def test_settled():
    assert [m.steady_start for m in ROTATIONS] == [0, 4, 4, math.inf, 1, math.inf]
    assert SampledRotation([0, 2], [5, 5]).steady_start == 0
    assert SampledRotation([0, 2, 3], [0, 5, 5]).steady_start == math.inf  # a spline overshoots
    assert (PUBLISHED.steady_start, USER.steady_start) == (10, math.inf)


# Rotations ------------------------------------------------------------------------------------------


@pytest.mark.parametrize("law", ["smooth", "linear"])
def test_spin_up_starts_from_rest(law):
    sample = SpinUp(55.0, 10.0, law).at(np.array([-5.0, -1e-9]))
    assert not any(a.any() for a in (sample.angle, sample.speed, sample.acceleration))


def test_published_spin_up():
    sample = SpinUp(55.0, 10.0).at(np.array([2.5, 5.0, 10.0, 30.0]))
    quarter = 55 * (0.25 - 1 / (2 * math.pi))
    np.testing.assert_allclose(sample.speed, [quarter, 27.5, 55, 55], rtol=1e-15)
    np.testing.assert_allclose(sample.angle[2:], [275, 275 + 1100], rtol=1e-15)
    np.testing.assert_allclose(sample.acceleration, [5.5, 11, 0, 0], rtol=1e-15)


def test_linear_spin_up():
    sample = SpinUp(6.0, 2.0, "linear").at(np.array([0.0, 1.0, 2.0, 3.0]))
    np.testing.assert_array_equal(sample.angle, [0, 1.5, 6, 12])
    np.testing.assert_array_equal(sample.speed, [0, 3, 6, 6])
    np.testing.assert_array_equal(sample.acceleration, [3, 3, 0, 0])


def test_large_angles_are_not_reduced():
    assert SteadyRotation(1e3).at(np.array(1e5)).angle == 1e8
    assert SpinUp(1e3, 10.0).at(np.array(1e5)).angle == 1e8 - 5e3


@pytest.mark.parametrize("interpolation", ["cubic", "pchip"])
def test_table_meets_its_speeds(interpolation):
    times, speeds = [0, 1, 2.5, 3, 5], [0, 4, 9, 9.5, 11]
    motion = SampledRotation(np.array(times), speeds, interpolation)
    np.testing.assert_allclose(motion.at(np.array(times)).speed, speeds, rtol=1e-14)
    assert (motion.final_speed, motion.end, motion.breakpoints) == (11, 5, (1, 2.5, 3))
    assert motion.at(np.array(0.0)).angle == 0


def test_table_of_a_cubic_is_exact():
    t = np.linspace(0, 4, 6)
    sample = SampledRotation(t, t**3 - 2 * t).at(np.array(3.3))
    assert sample.angle == pytest.approx(3.3**4 / 4 - 3.3**2, rel=1e-13)
    assert sample.acceleration == pytest.approx(3 * 3.3**2 - 2, rel=1e-13)


def test_pchip_does_not_overshoot():
    assert CORNERS.at(np.linspace(0, 4, 401)).speed.max() == 5
    cubic = SampledRotation(CORNERS.times, CORNERS.speeds)
    assert cubic.at(np.linspace(0, 4, 401)).speed.max() > 5


def test_constants_will_do_as_functions():
    motion = RotationFunction(lambda t: 5 * t, lambda t: 5, lambda t: 0, 10.0)
    assert (motion.at(np.array([1.0, 2.0])).acceleration == 0).all()


# Translations ---------------------------------------------------------------------------------------


def travel(sample, radius=0.3):
    return radius * sample.angle


@pytest.mark.parametrize("rotation", ROTATIONS, ids=name)
@pytest.mark.parametrize("road", [RoadWave(0.7, velocity_amplitude=0.01), RoadWave(0.7, height=0.002)])
def test_carrier_acceleration_is_that_of_the_travel(rotation, road):
    k, wheel = 2 * math.pi / 0.7, RollingWheel(0.3, rotation, road)

    def velocity(t):
        sample = wheel.at(t)
        phase = k * travel(sample)
        if road.height is None:
            return np.stack([0.3 * sample.speed, 0.01 * np.sin(phase)], axis=-1)
        return np.stack([0.3 * sample.speed, 0.002 * k * 0.3 * sample.speed * np.cos(phase)], axis=-1)

    t, h = np.linspace(0.2, 3.95, 37) + 1e-3, 1e-4
    difference = (8 * (velocity(t + h) - velocity(t - h)) - (velocity(t + 2 * h) - velocity(t - 2 * h))) / (
        12 * h
    )
    given = wheel.at(t).carrier_acceleration
    np.testing.assert_allclose(given[:, :2], difference, rtol=1e-7, atol=1e-6)
    assert not given[:, 2].any()


def test_height_is_the_integral_of_a_velocity_amplitude_at_steady_speed():
    k, speed = 2 * math.pi / 0.3, 20.0
    height = RollingWheel(0.3, speed, RoadWave(0.3, height=0.01 / (k * 0.3 * speed)))
    velocity = RollingWheel(0.3, speed, RoadWave(0.3, velocity_amplitude=0.01))
    quarter = math.pi / 2 / (k * 0.3 * speed)  # the height's velocity is a cosine
    t = np.linspace(1, 2, 50)
    np.testing.assert_allclose(
        height.at(t).carrier_acceleration, velocity.at(t + quarter).carrier_acceleration, atol=1e-11
    )


def test_road_acceleration_of_the_paper():
    """3.46 m/s2; 1190 m/s2 where the velocity is taken for a height."""
    assert PUBLISHED.road_acceleration(55) == pytest.approx(3.4558, rel=1e-4)
    mistaken = RollingWheel(0.3, 55.0, RoadWave(0.3, height=0.01))
    assert mistaken.road_acceleration(55) == pytest.approx(1194.2, rel=1e-4)
    assert RollingWheel(0.3, 55.0).road_acceleration(55) == SteadyRotation(55).road_acceleration(55) == 0


@pytest.mark.parametrize("road", [PUBLISHED.road, HEIGHT])
def test_road_acceleration_is_the_largest(road):
    wheel = RollingWheel(0.3, -21.0, road)
    vertical = wheel.at(np.linspace(0, 3, 20001)).carrier_acceleration[:, 1]
    assert wheel.road_acceleration(-21.0) == pytest.approx(abs(vertical).max(), rel=1e-4)


def test_lines():
    kappa = 2 * math.pi
    assert PUBLISHED.road_multiple == pytest.approx(kappa, rel=1e-15)
    assert [line.name for line in PUBLISHED.lines] == ["road +", "road -"]
    np.testing.assert_allclose([line.multiple for line in PUBLISHED.lines], [kappa + 1, kappa - 1])
    assert RollingWheel(0.3, 1.0, RoadWave(2 * math.pi * 0.6, height=1e-3)).lines[1] == Line("road -", 0.5)
    assert RollingWheel(0.3, 1.0).lines == SpinUp(1.0, 1.0).lines == ()
    assert RollingWheel(0.3, 1.0).road_multiple is None


@pytest.mark.parametrize("road", [None, PUBLISHED.road, HEIGHT])
def test_steady_acceleration_is_that_of_the_motion(road):
    wheel, t = RollingWheel(0.3, 17.0, road), np.linspace(0, 3, 11)
    sample = wheel.at(t)
    chi = (wheel.road_multiple or 0.0) * sample.angle
    acceleration = wheel.steady_acceleration(17.0, sample.angle, chi)
    np.testing.assert_allclose(acceleration, sample.carrier_acceleration, atol=1e-11)


def test_steady_acceleration_broadcasts():
    speeds, theta, chi = np.arange(3.0)[:, None, None], np.zeros((4, 1)), np.zeros(5)
    for motion in (PUBLISHED, SteadyRotation(1.0)):
        assert motion.steady_acceleration(speeds, theta, chi).shape == (3, 4, 5, 3)
    refused(lambda: USER.steady_acceleration(1.0, 0.0, 0.0), "UserMotion", "simulate")


@pytest.mark.parametrize(
    "motion",
    [
        beamdyn.PulsatingRotation(50.0, fluctuation=0.1, frequency=5.0),
        beamdyn.ShakenCarrier(frequency=5.0, along_n1=2.0, rotation=50.0),
        beamdyn.SampledTranslation([0.0, 1.0, 2.0], along_n2=[0.0, 1.0, 0.0], rotation=50.0),
    ],
    ids=lambda motion: type(motion).__name__,
)
def test_motions_without_a_steady_state_say_so_and_what_to_do(motion):
    refused(
        lambda: motion.steady_acceleration(1.0, 0.0, 0.0),
        f"a {type(motion).__name__}",
        "no steady state",
        "RollingWheel",
    )
    assert motion.with_speed(20.0).final_speed == 20.0 and type(motion.with_speed(20.0)) is type(motion)


def test_wheel_takes_over_from_its_rotation():
    wheel = RollingWheel(0.3, TABLE)
    assert (wheel.final_speed, wheel.end, wheel.breakpoints) == (11, 5, TABLE.breakpoints)
    assert RollingWheel(0.3, 5) == RollingWheel(0.3, SteadyRotation(5.0))


# Other speeds; hashing and pickling -----------------------------------------------------------------


@pytest.mark.parametrize("motion", [m for m in MOTIONS if m is not USER], ids=name)
def test_with_speed(motion):
    t = np.linspace(0, min(6.0, motion.end), 9)
    other = motion.with_speed(7.25)
    assert type(other) is type(motion)
    assert other.final_speed == pytest.approx(7.25, rel=1e-15)
    ratio = 7.25 / motion.final_speed
    for what in ("angle", "speed", "acceleration"):
        scaled = ratio * getattr(motion.at(t), what)
        np.testing.assert_allclose(getattr(other.at(t), what), scaled, rtol=1e-12, atol=1e-12)
    assert (other.end, other.breakpoints) == (motion.end, motion.breakpoints)


def test_with_speed_is_refused_where_it_means_nothing():
    refused(lambda: USER.with_speed(3.0), "with_speed(3)", "one for each speed")
    refused(lambda: SampledRotation([0, 1], [5, 0]).with_speed(3.0), "ends at rest", "each speed")


@pytest.mark.parametrize("motion", MOTIONS, ids=name)
def test_hash_and_pickle(motion):
    before = pickle.dumps(motion)
    motion.at(np.array(1.0))
    copy = pickle.loads(pickle.dumps(motion))
    assert motion.picklable
    check_picklable(motion)
    assert pickle.dumps(motion) == before  # whatever was computed meanwhile
    assert copy == motion
    assert hash(copy) == hash(motion)


@pytest.mark.parametrize(
    "motion",
    [
        UserMotion(lambda t: shaken(t)),
        RotationFunction(lambda t: t, lambda t: 1, lambda t: 0, 1.0),
        RollingWheel(0.3, RotationFunction(lambda t: t, lambda t: 1, lambda t: 0, 1.0)),
    ],
    ids=name,
)
def test_lambdas_stay_in_this_process(motion):
    assert not motion.picklable
    refused(lambda: check_picklable(motion), name(motion), "with def at the top of a module")
    assert isinstance(hash(motion), int)


def test_numbers_become_floats():
    motion = SampledRotation(np.array([0, 1]), np.array([1, 2], dtype=np.float32))
    assert {type(v) for v in (*motion.times, *motion.speeds)} == {float}
    assert type(SpinUp(np.float64(3), 1).speed) is type(SpinUp(3, 1).duration) is float


def test_public_names():
    assert {beamdyn.SpinUp, beamdyn.SampledRotation, beamdyn.RotationFunction} < set(
        Rotation.__subclasses__()
    )
    assert (beamdyn.RollingWheel, beamdyn.RoadWave, beamdyn.UserMotion) == (
        RollingWheel,
        RoadWave,
        UserMotion,
    )
