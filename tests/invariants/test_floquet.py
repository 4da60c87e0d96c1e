"""Monodromy matrices against a second method, reciprocal multipliers, charts against single points."""

from __future__ import annotations

from dataclasses import replace

import mpmath
import numpy as np
import pytest

import beamdyn as bd
from beamdyn.studies.floquet.monodromy import PeriodicScenes
from beamdyn.transient.system import ModalSystem

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
UNIT = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
BLADE = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=4.0)
COLUMNS = 9  # of the extrapolation: order 18
KINDS = "pulsating", "shaken", "heavy", "two planes", "rolling"


def random_scene(generator, kind):
    """A scene of order 1 in all numbers, near a principal or combination resonance as often as not."""
    speed, rate = (
        generator.uniform(0.5, 2.5),
        generator.choice([7.0, 7.6, 22.0, 25.5, generator.uniform(3, 30)]),
    )
    mount = bd.Mount(generator.uniform(0.0, 1.5), generator.uniform(0, np.pi), generator.choice([0.0, 0.7]))
    frequency, amplitude = rate / (2 * np.pi), generator.uniform(0.02, 0.5)
    damping = {"damping_ratio": generator.choice([0.0, 0.002, 0.03])}
    pulsating = bd.PulsatingRotation(speed, amplitude, frequency)
    if kind == "shaken":
        return bd.Scene(UNIT, mount, bd.ShakenCarrier(frequency, along_n1=10 * amplitude), **damping)
    if kind == "heavy":
        motion = bd.PulsatingRotation(speed, amplitude, 3 * speed / (2 * np.pi))
        return bd.Scene(UNIT, mount, motion, gravity=2.0, **damping)
    if kind == "two planes":
        mount = replace(mount, bending_angle=0.4)
        return bd.Scene(BLADE, mount, pulsating, physics=bd.Physics(planes=2), **damping)
    if kind == "rolling":
        road = bd.RoadWave(2 * np.pi * 0.5 / 3, height=0.005)  # three waves a turn
        return bd.Scene(UNIT, mount, bd.RollingWheel(0.5, speed, road), gravity=1.0, **damping)
    return bd.Scene(UNIT, mount, pulsating, **damping)


def second_method(scene, modes):
    """Growth rate [1/s] by the extrapolated midpoint rule in extended precision, eigenvalues in 30 digits."""
    scenes = PeriodicScenes(scene, modes, "ritz")
    _, equations = scenes.modal(scene)
    system = ModalSystem(replace(equations, mount=scene.mount, gravity=scene.gravity), scene.motion)
    period = bd.floquet_multipliers(scene, modes).period
    n = system.size
    fastest = float(np.sqrt(np.abs(system.coefficients(np.zeros(1))[1]).max()))
    steps = int(np.ceil(max(24, 1.2 * period * fastest)))
    state = np.eye(2 * n, dtype=np.longdouble)
    for k in range(steps):
        state = extrapolated(system, np.longdouble(k) * period / steps, np.longdouble(period) / steps, state)
    matrix = mpmath.matrix([[exact(each) for each in row] for row in state])
    with mpmath.workdps(30):
        values = mpmath.eig(matrix, left=False, right=False)
        return float(max(mpmath.log(abs(value)) for value in values) / period)


def exact(number):
    high = float(number)
    return mpmath.mpf(high) + mpmath.mpf(float(number - np.longdouble(high)))


def extrapolated(system, start, step, state):
    """A step of the midpoint rule with 2, 4, 6, ... parts, extrapolated to infinitely many."""
    table = []
    for count in range(1, COLUMNS + 1):
        parts = 2 * count
        h = step / parts
        derivative = derivatives(system, start + h * np.arange(parts + 1))
        before, now = state, state + h * derivative(0, state)
        for k in range(1, parts):
            before, now = now, before + 2 * h * derivative(k, now)
        row = [(before + now + h * derivative(parts, now)) / 2]
        for j in range(1, count):
            ratio = np.longdouble(count) / (count - j)
            row.append(row[-1] + (row[-1] - table[-1][j - 1]) / (ratio**2 - 1))
        table.append(row)
    return table[-1][-1]


def derivatives(system, times):
    C, K, _ = system.coefficients(times.astype(float))
    n = system.size
    C, K = (None if each is None else each.astype(np.longdouble) for each in (C, K))

    def derivative(k, state):
        force = -K[k] @ state[:n]
        return np.concatenate([state[n:], force if C is None else force - C[k] @ state[n:]])

    return derivative


def check_growth_rates(seeds):
    missed = []
    for seed in seeds:
        generator = np.random.default_rng(seed)
        kind, modes = KINDS[seed % len(KINDS)], int(generator.integers(1, 3))
        scene = random_scene(generator, kind)
        found, expected = bd.floquet_multipliers(scene, modes), second_method(scene, modes)
        if not abs(found.growth_rate - expected) <= found.growth_rate_error + 1e-14:
            missed.append((seed, kind, found.growth_rate, expected, found.growth_rate_error))
        assert found.growth_rate_error < 1e-6
        assert (found.status == "unstable") == (expected > found.growth_rate_error + 1e-14), (seed, expected)
    assert not missed, missed


def test_growth_rates_by_a_second_method():
    check_growth_rates(range(10))


@pytest.mark.slow
def test_growth_rates_of_many_scenes_by_a_second_method():
    check_growth_rates(range(10, 210))


@pytest.mark.parametrize("kind", KINDS)
def test_undamped_multipliers_come_in_reciprocal_pairs(kind):
    scene = replace(random_scene(np.random.default_rng(3), kind), damping_ratio=0.0)
    found = bd.floquet_multipliers(scene, 3)
    nearest = np.abs(found.multipliers[:, None] * found.multipliers - 1).min(axis=1)
    assert nearest.max() < 1e-10
    assert abs(np.prod(found.multipliers) - 1) < 1e-10  # Liouville


@pytest.mark.parametrize("physics", [bd.Physics(), bd.Physics(stretch=True)], ids=["bending", "stretch"])
def test_undamped_motion_keeps_its_form(physics):
    """With Coriolis forces between stretch and bending, too."""
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, axial_stiffness=400.0)
    scene = bd.Scene(beam, bd.Mount(1.0, np.pi), bd.PulsatingRotation(2.0, 0.3, 1.4), physics=physics)
    motion = PeriodicScenes(scene, 2, "ritz").monodromy({})
    matrix, form = motion.matrix[0], motion.form[0]
    np.testing.assert_allclose(
        matrix.T @ form @ matrix, form, rtol=0, atol=1e-11 * np.abs(form).max()
    )  # rounding
    half = len(form) // 2
    assert form[:half, :half].any() == physics.stretch


def test_damping_shrinks_the_product_of_multipliers():
    scene = random_scene(np.random.default_rng(1), "pulsating")
    scene = replace(scene, damping_ratio=0.02)
    found = bd.floquet_multipliers(scene, 3)
    trace = sum(2 * 0.02 * 2 * np.pi * bd.natural_modes(bd.Scene(UNIT), 0.0, 3).frequency)
    assert np.prod(found.multipliers).real == pytest.approx(
        np.exp(-trace * found.period), rel=1e-9
    )  # rounding


@pytest.mark.parametrize("ratio", [0.0, 0.01])
def test_charts_are_single_points(ratio):
    motion = bd.PulsatingRotation(50.0, 0.1, 124.0)
    scene = bd.Scene(STRIP, bd.Mount(0.215), motion, damping_ratio=ratio)
    vary = {"motion.frequency": np.linspace(110.0, 140.0, 61), "motion.fluctuation": np.linspace(0, 0.3, 41)}
    chart = bd.stability_chart(scene, vary, 2)
    assert chart.integrated < chart.status.size / 4
    assert (chart.status == "undecided").mean() <= 0.01
    assert {"stable", "unstable"} <= {*np.unique(chart.status)}
    edge = np.argwhere(np.diff((chart.status == "unstable").astype(int), axis=0))[::7]
    for i, j in (*edge.tolist(), (3, 5), (28, 40)):
        motion = bd.PulsatingRotation(50.0, vary["motion.fluctuation"][j], vary["motion.frequency"][i])
        point = bd.floquet_multipliers(replace(scene, motion=motion), 2)
        allowed = chart.growth_rate_error[i, j] + point.growth_rate_error
        assert abs(point.growth_rate - chart.growth_rate[i, j]) <= allowed
        assert chart.status[i, j] in (point.status, "undecided")


def test_charts_over_speed_and_setting_angle():
    scene = bd.Scene(STRIP, bd.Mount(0.215), bd.PulsatingRotation(50.0, 0.1, 124.0))
    vary = {"speed": np.linspace(20.0, 180.0, 12), "mount.setting_angle": [0.0, 1.0, 3.0]}
    chart = bd.stability_chart(scene, vary, 1)
    past = vary["speed"] > bd.critical_speed(scene) * 1.05
    assert past.any()
    assert (chart.status[past, 0] == "unstable").all()
    assert chart.growth_rate[-1, 0] > 10 * chart.growth_rate[:-4, 0].max()


def test_a_stiffness_that_does_not_vary_is_that_of_the_modes():
    scene = bd.Scene(STRIP, bd.Mount(0.215), bd.SteadyRotation(50.0))
    found = bd.floquet_multipliers(scene, 2)
    angle = 2 * np.pi * bd.natural_modes(scene, 50.0, 1).frequency[0] * found.period
    turned = np.abs(np.angle(found.multipliers * np.exp(-1j * angle))).min()
    assert turned < 1e-3  # two modes at rest, of those at 50 rad/s
    assert found.status == "stable"
    assert found.growth_rate == 0
