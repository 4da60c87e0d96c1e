"""The published tyre harvester on its road: resonance speeds and steady amplitudes."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

import beamdyn as bd
from benchmarks.cases.scenes import STEADY_ROLLING, STEADY_ROLLING_IN_GRAVITY


def speeds_of(scene: bd.Scene, kind: str) -> list[float]:
    return [c.speed for c in bd.resonance_speeds(scene, top_speed=150.0) if c.kind == kind]


def test_the_two_peaks_of_figure_6() -> None:
    np.testing.assert_allclose(speeds_of(STEADY_ROLLING, "forced"), [53.08584183, 69.80240337], rtol=1e-10)


def test_gravity_adds_a_crossing() -> None:
    np.testing.assert_allclose(
        speeds_of(STEADY_ROLLING_IN_GRAVITY, "forced"),
        [53.08584183, 69.80240337, 148.9196],
        rtol=0,
        atol=5e-5,
    )


def test_parametric_crossings() -> None:
    np.testing.assert_allclose(
        speeds_of(STEADY_ROLLING, "parametric"), [92.0443, 111.3564], rtol=0, atol=5e-5
    )


def test_steady_amplitude_is_a_seventh_of_the_published_peak() -> None:
    found = bd.steady_response(STEADY_ROLLING, [55.0], modes=5)
    assert abs(found.amplitude[0] - 0.261876e-3) < 5e-10
    assert abs(found.bound[0] - 0.261951e-3) < 5e-10
    assert found.stable[0] and found.error[0] < 1e-6 and not found.warnings


def test_steady_amplitude_with_gravity() -> None:
    found = bd.steady_response(STEADY_ROLLING_IN_GRAVITY, [55.0], modes=3)
    assert abs(found.amplitude[0] - 0.29895e-3) < 5.1e-8
    assert abs(found.bound[0] - 0.36868e-3) < 5e-9


def test_peaks_stand_at_the_resonance_speeds() -> None:
    damped = replace(STEADY_ROLLING, damping_ratio=1e-3)
    for speed in speeds_of(STEADY_ROLLING, "forced"):
        found = bd.steady_response(damped, speed + np.linspace(-1, 1, 401), modes=1)
        assert abs(found.speeds[found.amplitude.argmax()] - speed) < 0.011


def test_unstable_in_the_parametric_tongues() -> None:
    for speed in speeds_of(STEADY_ROLLING, "parametric"):
        found = bd.steady_response(STEADY_ROLLING, [speed - 0.2, speed, speed + 0.2])
        assert found.status.tolist() == ["stable", "parametric instability", "stable"]
        assert np.isnan(found.amplitude).tolist() == [False, True, False]
