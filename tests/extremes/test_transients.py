"""Motions at the ends of the ranges: spin-ups of a millisecond and of a week, many periods, stiff stretch."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.scenes import steel_strip

BLADE = replace(
    steel_strip(1000.0, length=100.0, hub=0.02, setting=math.pi / 3), damping_ratio=0.02
)  # 2 minutes


def test_after_a_week_of_spin_up_the_blade_is_in_static_equilibrium() -> None:
    week = 7 * 86400.0
    run = bd.simulate(replace(BLADE, motion=bd.SpinUp(0.02, duration=week)), 1.1 * week, tolerance=1e-4)
    static = bd.natural_modes(BLADE, 0.02).static_deflection
    np.testing.assert_allclose(run.tip[-1], static, rtol=2e-4)  # steps and modes: 1e-4 each


def test_a_millisecond_of_spin_up_is_a_blow() -> None:
    """What a blow leaves is a velocity: the angular load times the speed, in each mode at rest."""
    still = steel_strip(length=100.0, setting=math.pi / 3)  # the first period is 12 s
    modes = bd.natural_modes(still, 0.0, 4)
    start = np.concatenate([np.zeros(4), 0.2 * modes.angular_load])
    slow, blow = bd.SpinUp(0.2, duration=1e-3), bd.SteadyRotation(0.2)
    t = np.linspace(1e-3, 60.0, 200)
    spun = bd.simulate(replace(still, motion=slow), 60.0, modes=4, t_eval=t)
    struck = bd.simulate(replace(still, motion=blow), 60.0, modes=4, initial=start, t_eval=t)
    # The millisecond is 1e-4 of the first period, 3e-3 of the fourth.
    np.testing.assert_allclose(spun.tip, struck.tip, rtol=0, atol=3e-3 * spun.largest)


def test_twenty_thousand_periods_of_one_mode() -> None:
    made = replace(steel_strip(), motion=bd.SteadyRotation(20.0))
    run = bd.simulate(made, 1.0, modes=1, initial=np.array([1e-6, 0.0]))
    _, K, _ = run.system.coefficients(np.zeros(1))
    omega = math.sqrt(K[0, 0, 0])
    end = 2e4 * 2 * math.pi / omega
    t = np.linspace(0.9 * end, end, 1001)
    load = replace(made, mount=bd.Mount(0.0, math.pi))
    run = bd.simulate(load, end, modes=1, initial=np.array([1e-6, 0.0]), tolerance=1e-9, t_eval=t)
    exact = 1e-6 * np.cos(omega * t) * run.system.tip[0]
    assert np.abs(run.tip - exact).max() <= run.time_error + 1e-9 * run.largest


def test_nothing_moves_at_rest() -> None:
    tangential = steel_strip(hub=1.0, setting=math.pi / 2)
    assert bd.simulate(replace(tangential, motion=bd.SteadyRotation(0.0)), 1.0).largest == 0


def test_turning_back_mirrors_a_beam_without_static_load() -> None:
    inward = steel_strip(hub=1.0, setting=0.0)
    forth, back = (bd.simulate(replace(inward, motion=bd.SpinUp(v, 0.5)), 1.0, 3) for v in (9.0, -9.0))
    np.testing.assert_allclose(back.tip, -forth.tip, rtol=0, atol=1e-12 * forth.largest)


@pytest.mark.filterwarnings("ignore:axial_stiffness:UserWarning")  # no material is so stiff
@pytest.mark.parametrize("ratio", [1e8, 1e12, 1e16])
def test_stretch_of_a_beam_that_hardly_stretches(ratio: float) -> None:
    thin = steel_strip(hub=1.0, setting=math.pi / 3).beam
    stiffness = ratio * float(thin.bending_stiffness(np.zeros(1))[0]) / thin.length**2
    beam = bd.Beam.from_stiffness(
        thin.length, thin.mass_per_length, thin.bending_stiffness, axial_stiffness=stiffness
    )
    plain = bd.Scene(beam, bd.Mount(1.0, math.pi / 3), bd.SpinUp(10.0, 0.5))
    t = np.linspace(0, 1, 101)
    runs = [
        bd.simulate(replace(plain, physics=bd.Physics(stretch=s)), 1.0, 3, t_eval=t) for s in (False, True)
    ]
    # What stretch changes is of the order of gamma^2 / ratio.
    np.testing.assert_allclose(runs[1].tip, runs[0].tip, rtol=0, atol=3e-5 * runs[0].largest)


@pytest.mark.parametrize("length", [1e-5, 100.0])
def test_size_alone_changes_nothing(length: float) -> None:
    """Lengths by c, times by c: the tip moves by c."""
    made = [steel_strip(length=c, hub=1.0, setting=math.pi / 3) for c in (1.0, length)]
    runs = [
        bd.simulate(replace(s, motion=bd.SpinUp(10.0 / c, 0.5 * c)), c, 3, t_eval=np.linspace(0, c, 51))
        for s, c in zip(made, (1.0, length), strict=True)
    ]
    np.testing.assert_allclose(runs[1].tip / length, runs[0].tip, rtol=0, atol=1e-9 * runs[0].largest)
