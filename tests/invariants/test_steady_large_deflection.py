"""Steady response about the equilibria of large deflection, and what steady answers say is left out."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd

HARVESTER = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
LARGE = bd.Physics(large_deflection=True)
SCENE = bd.Scene(
    HARVESTER, bd.Mount(0.215, math.radians(45)), gravity=9.81, damping_ratio=0.02, physics=LARGE
)


def _at(angle: float, **changes: object) -> bd.Scene:
    return replace(SCENE, mount=bd.Mount(0.215, math.radians(angle)), **changes)  # pyright: ignore[reportArgumentType]


def test_about_the_straight_beam_it_is_the_linear_response() -> None:
    """A beam that points outward is not bent: the same equations, to the error of the modes."""
    speeds = [20.0, 60.0, 90.0]
    large = bd.steady_response(_at(180.0), speeds)
    linear = bd.steady_response(_at(180.0, physics=bd.Physics()), speeds)
    np.testing.assert_allclose(large.amplitude, linear.amplitude, rtol=2e-5)  # 1e-5 each, the tolerance
    np.testing.assert_allclose(large.growth_rate, linear.growth_rate, rtol=1e-4)


def test_without_excitation_the_beam_stands_in_equilibrium() -> None:
    response = bd.steady_response(replace(SCENE, gravity=0.0), [50.0, 100.0, 200.0])
    tips = [bd.equilibrium(SCENE, speed).tip[1] for speed in response.speeds]
    np.testing.assert_allclose(response.amplitude, np.abs(tips), rtol=1e-11)
    assert response.status.tolist() == ["stable"] * 3


@pytest.mark.parametrize("bending_angle", [0.0, math.pi / 2])
def test_against_a_transient_of_large_deflection(bending_angle: float) -> None:
    """What is left is quadratic: the vibration is 1e-2 of the deflection, and 0.4 % of the length."""
    mount = bd.Mount(0.215, math.radians(45), bending_angle)
    scene = replace(SCENE, mount=mount, damping_ratio=0.25, motion=bd.SteadyRotation(100.0))
    response = bd.steady_response(scene, [100.0])
    run = bd.simulate(scene, 0.3, modes=6, tolerance=1e-6, initial="equilibrium")
    phase = 100.0 * (t := np.linspace(0.2, 0.3, 400))
    # The start decays by exp(-0.2 s * 0.25 * 350 1/s) = 1e-8.
    np.testing.assert_allclose(response.tip(phase)[0], run.deflection(t), atol=3e-5 * response.amplitude[0])


@pytest.mark.slow
def test_speeds_without_an_equilibrium_have_a_status_of_their_own() -> None:
    bent = replace(LARGE, branch="bent")
    response = bd.steady_response(_at(5.0, physics=bent), [100.0, 190.0, 200.0])
    assert response.status.tolist() == ["no equilibrium", "stable", "stable"]
    assert np.isnan(response.amplitude[0])
    assert np.isnan(response.growth_rate[0])
    tip = bd.equilibrium(_at(5.0), 200.0, branch="bent").tip[1]
    assert response.line_amplitude[2, 0].real == pytest.approx(tip, rel=1e-3)  # gravity bends it by 1e-4 L
    none = bd.steady_response(_at(5.0, physics=bent), [50.0, 100.0])
    assert none.status.tolist() == ["no equilibrium"] * 2


def test_past_the_critical_speed_the_straight_equilibrium_repels_and_the_bent_does_not() -> None:
    straight, bent = (
        bd.steady_response(_at(0.0, physics=replace(LARGE, branch=branch)), [200.0])
        for branch in ("straight", "bent")
    )
    assert straight.status.tolist() == ["unstable equilibrium"]
    assert straight.growth_rate[0] > 0
    assert "unstable equilibrium" in straight.warnings[0]
    assert bent.status.tolist() == ["stable"]


def test_mode_error_is_the_distance_from_more_modes() -> None:
    coarse, fine = (bd.steady_response(SCENE, [30.0, 100.0], modes=n) for n in (3, 12))
    distance = np.abs(coarse.amplitude - fine.amplitude) / coarse.bound
    assert (distance <= coarse.mode_error).all()
    assert (coarse.mode_error < 20 * distance + 1e-9).all()


def test_large_vibration_about_the_equilibrium_is_warned_of() -> None:
    strong = bd.steady_response(replace(SCENE, gravity=2000.0), [100.0])
    assert any("linear theory of vibration does not hold" in warning for warning in strong.warnings)
    weak = bd.steady_response(SCENE, [100.0])  # bent by a third of its length, but it vibrates little
    assert not weak.warnings


# What is left out ---------------------------------------------------------------------------------

STUBBY = bd.Beam.rectangular(0.5, 0.06, 0.03, 200e9, 7850.0, poissons_ratio=0.3)
RIGID = bd.Scene(STUBBY, bd.Mount(0.2, math.radians(150)), gravity=9.81)


def test_amplitudes_say_what_large_deflection_changes() -> None:
    linear = bd.steady_response(replace(SCENE, physics=bd.Physics()), [30.0, 100.0])
    large = bd.steady_response(SCENE, [30.0, 100.0])
    change = linear.left_out["large deflection"]
    np.testing.assert_allclose(
        1 + change, large.amplitude / linear.amplitude, rtol=2e-5
    )  # the tolerance, twice
    assert change[1] < -0.1
    assert "large deflection" not in large.left_out
    assert "as of the straight beam" in large.left_out_effects.assumed["shear deformation"]


def test_amplitudes_say_what_shear_changes() -> None:
    plain = bd.steady_response(RIGID, [50.0, 100.0])
    shear = bd.steady_response(replace(RIGID, physics=bd.Physics(shear=True)), [50.0, 100.0])
    change = shear.amplitude / plain.amplitude - 1
    np.testing.assert_allclose(plain.left_out["shear deformation"], change, atol=2e-5)  # the tolerance, twice
    assert (change > 1e-3).all()
    np.testing.assert_array_equal(plain.model_error, np.abs(sum(plain.left_out.values())))


def test_resonances_say_what_shear_changes() -> None:
    plain, shear = (
        bd.resonance_speeds(replace(RIGID, mount=bd.Mount(0.2, math.pi), physics=physics), 500.0, 2, 6)
        for physics in (bd.Physics(), bd.Physics(shear=True))
    )
    assert len(plain) == len(shear) > 2
    change = np.array([b.speed / a.speed - 1 for a, b in zip(plain, shear, strict=True)])
    np.testing.assert_allclose(
        plain.left_out["shear deformation"], change, rtol=0.02
    )  # second order: 1e-2 squared
    assert np.abs(change).max() > 1e-3


@pytest.mark.slow
def test_a_short_transient_says_what_large_deflection_and_shear_change() -> None:
    moving = replace(SCENE, gravity=0.0, physics=bd.Physics(), motion=bd.SpinUp(100.0, duration=0.1))
    run, bent = bd.simulate(moving, 0.3), bd.simulate(replace(moving, physics=LARGE), 0.3)
    change = run.left_out["large deflection"]
    assert change == pytest.approx(bent.largest / run.largest - 1, abs=2e-5)
    assert change < -0.05
    spun = replace(RIGID, motion=bd.SpinUp(100.0, duration=0.1), gravity=0.0)
    plain, sheared = bd.simulate(spun, 0.2), bd.simulate(replace(spun, physics=bd.Physics(shear=True)), 0.2)
    expected = sheared.largest / plain.largest - 1
    assert plain.left_out["shear deformation"] == pytest.approx(expected, abs=3e-5)  # the tolerance of each


def test_a_sweep_is_judged_at_its_largest_peak() -> None:
    spun = replace(RIGID, motion=bd.SpinUp(100.0, duration=0.05), gravity=0.0)
    result = bd.sweep(spun, [50.0, 100.0], (0.05, 0.1))
    assert result.left_out_speeds == pytest.approx([100.0])
    sheared = bd.sweep(replace(spun, physics=bd.Physics(shear=True)), [50.0, 100.0], (0.05, 0.1))
    expected = sheared.peaks[1] / result.peaks[1] - 1
    assert result.left_out["shear deformation"] == pytest.approx([expected], abs=3e-5)


def test_in_space_a_motion_in_one_plane_has_the_response_of_that_plane() -> None:
    """The two lowest modes of either are those in the plane."""
    planar, in_space = (
        bd.steady_response(
            _at(45.0, physics=bd.Physics(planes, large_deflection=True)), [60.0, 100.0], modes=2
        )
        for planes in (1, 2)
    )
    np.testing.assert_allclose(in_space.amplitude, planar.amplitude, rtol=1e-8)  # of modes to 1e-11
