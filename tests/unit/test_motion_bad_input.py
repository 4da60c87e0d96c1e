"""Motions: clear about bad input, and about functions that contradict each other."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from beamdyn.scene.motion.base import MotionSample, check_consistent
from beamdyn.scene.motion.rolling import RoadWave, RollingWheel, UserMotion
from beamdyn.scene.motion.rotations import RotationFunction, SampledRotation, SpinUp, SteadyRotation
from tests.unit.motions import (
    FUNCTION,
    PUBLISHED,
    TABLE,
    USER,
    acceleration_of,
    angle_of,
    name,
    shaken,
    speed_of,
)
from tests.unit.refusals import refused


@pytest.mark.parametrize("motion", [TABLE, FUNCTION, USER, RollingWheel(0.3, TABLE)], ids=name)
def test_past_the_end(motion):
    end = motion.end
    motion.at(np.array([0.0, end, end * (1 + 1e-15)]))
    refused(lambda: motion.at(np.array([0, end + 1])), f"t = {end + 1:g} s", f"ends at {end:g} s", "t_end =")
    refused(lambda: motion.at(np.array(-0.5)), "t = -0.5 s", "begins at 0")


@pytest.mark.parametrize(
    ("times", "speeds", "parts"),
    [
        ([0, 2, 1], [0, 1, 2], ("times = 1 s", "follows 2 s", "sort")),
        ([0, 1, 1], [0, 1, 2], ("times = 1 s", "follows 1 s", "drop repeats")),
        ([3, 4], [0, 1], ("times = 3 s", "subtract 3 s")),
        ([0, 1], [0, 1, 2], ("2 times and 3 speeds", "as many")),
        ([0], [1], ("at least two",)),
        ([0, math.nan], [0, 1], ("times = nan", "finite")),
        ([0, 1], ["a", "b"], ("speeds", "give a sequence of numbers")),
    ],
)
def test_bad_table(times, speeds, parts):
    refused(lambda: SampledRotation(times, speeds), *parts)


@pytest.mark.parametrize(
    ("build", "parts"),
    [
        (lambda: SteadyRotation(math.nan), ("speed = nan", "rad/s")),
        (lambda: SpinUp(55.0, -10.0), ("duration = -10 s", "SteadyRotation")),
        (lambda: SpinUp(55.0, 0.0), ("duration = 0 s",)),
        (lambda: SpinUp(math.inf, 1.0), ("speed = inf",)),
        (lambda: SpinUp(55.0, 1.0, "odd"), ("law = 'odd'", "'smooth' or 'linear'")),
        (lambda: SampledRotation([0, 1], [0, 1], "odd"), ("interpolation = 'odd'", "'cubic' or 'pchip'")),
        (lambda: RoadWave(-0.3, 0.01), ("wavelength = -0.3 m",)),
        (lambda: RoadWave(0.3), ("neither velocity_amplitude nor height", "exactly one")),
        (lambda: RoadWave(0.3, 0.01, 0.02), ("velocity_amplitude = 0.01 and height = 0.02", "exactly one")),
        (lambda: RoadWave(0.3, height=math.nan), ("height = nan", "in m")),
        (lambda: RollingWheel(0.0, 5.0), ("rolling_radius = 0 m",)),
        (lambda: RollingWheel(0.3, "5"), ("speed = '5'", "or a rotation")),
        (lambda: RollingWheel(0.3, PUBLISHED), ("speed = RollingWheel", "or a rotation")),
        (lambda: RollingWheel(0.3, 5.0, 0.01), ("road = 0.01", "RoadWave")),
        (lambda: UserMotion(5.0), ("function = 5: give a function", "MotionSample")),
        (lambda: UserMotion(shaken, t_end=-1.0), ("t_end = -1 s",)),
        (lambda: UserMotion(shaken, breakpoints=[[1]]), ("breakpoints", "one-dimensional")),
        (lambda: UserMotion(np.sin, t_end=1.0), ("function(t)", "MotionSample")),
        (lambda: RotationFunction(5.0, speed_of, acceleration_of, 1.0), ("angle = 5", "function")),
        (lambda: RotationFunction(angle_of, speed_of, acceleration_of, 0.0), ("t_end = 0 s",)),
    ],
)
def test_bad_value(build, parts):
    refused(build, *parts)


def function_of(angle=angle_of, speed=speed_of, acceleration=acceleration_of, breakpoints=()):
    return lambda: RotationFunction(angle, speed, acceleration, 8.0, breakpoints)


@pytest.mark.parametrize(
    ("build", "parts"),
    [
        (function_of(speed=lambda t: 50 + 1.001 * np.sin(3 * t)), ("speed is not the derivative of angle",)),
        (function_of(acceleration=lambda t: 0), ("acceleration is not the derivative of speed", "misfit")),
        (
            function_of(angle=lambda t: angle_of(t) + 1.0 * (t > 4)),
            ("derivative of angle at t = 4", "jumps by 1"),
        ),
        (
            function_of(lambda t: angle_of(t) + 1.0 * (t > 4), breakpoints=(4,)),
            ("derivative of angle at t = 4", "jumps by 1"),
        ),
        (
            function_of(lambda t: t, lambda t: np.where(t < 5, 1, 2.0), lambda t: 0),
            ("speed is not the derivative of angle at t = ",),
        ),
        (
            function_of(speed=lambda t: speed_of(t)[..., :1]),
            ("speed: the function returned shape", "vectorised"),
        ),
        (function_of(angle=lambda t: 1 if t < 0 else 2), ("angle: the function failed", "use numpy")),
        (function_of(angle=lambda t: np.where(t < 4, t, np.inf)), ("angle = inf at t = 4", "finite")),
    ],
)
def test_inconsistent_functions(build, parts):
    refused(build, *parts)


def test_inconsistent_user_motion():
    def wrong(t):
        return MotionSample(t**2, t, np.ones_like(t), np.zeros((*t.shape, 3)))

    refused(lambda: UserMotion(wrong, t_end=4.0), "speed is not the derivative of angle at t = ", "misfit")
    refused(lambda: check_consistent(UserMotion(wrong), 4.0), "speed is not the derivative of angle at t = ")
    assert math.isnan(UserMotion(wrong).final_speed)


def test_user_motion_of_wrong_shape():
    def wrong(t):
        return MotionSample(t, np.ones_like(t), 0.0 * t, np.zeros(3))

    refused(lambda: UserMotion(wrong).at(np.zeros(5)), "carrier_acceleration has shape (3,)", "(5, 3)")


def test_jumps_of_acceleration_are_allowed_at_breakpoints():
    def piecewise(before, after):
        return lambda t: np.where(t < 3, before(t), after(t))

    angle = piecewise(lambda t: t**2 / 2, lambda t: 4.5 + 3 * (t - 3))
    speed = piecewise(lambda t: t, lambda t: 3.0)
    motion = RotationFunction(angle, speed, piecewise(lambda t: 1.0, lambda t: 0.0), 8.0, (3.0,))
    assert motion.final_speed == 3


@given(st.floats(-2, 5).map(lambda x: 10**x), st.floats(0.1, 300), st.floats(0.1, 50))
def test_consistent_functions_are_accepted(t_end, mean, frequency):
    RotationFunction(
        lambda t: mean * t - np.cos(frequency * t) / frequency,
        lambda t: mean + np.sin(frequency * t),
        lambda t: frequency * np.cos(frequency * t),
        t_end,
    )
