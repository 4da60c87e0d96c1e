"""Accuracy and speed of resonance speeds and harmonic balance.  Run: python -m benchmarks.steady

The published harvester on its road, with and without gravity.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

import beamdyn as bd
from benchmarks.cases.scenes import STEADY_ROLLING, STEADY_ROLLING_IN_GRAVITY
from benchmarks.rows import Row, best_time, show


def compare_crossings() -> Iterator[Row]:
    """Yield speeds at which excitation frequencies meet the first natural frequency."""
    expected = {
        ("road +", "forced"): "53.08584183",
        ("road -", "forced"): "69.80240337",
        ("rotation", "forced"): "148.9196",
        ("road +", "parametric"): "92.0443",
        ("road -", "parametric"): "111.3564",
    }
    for c in bd.resonance_speeds(STEADY_ROLLING_IN_GRAVITY, 150.0):
        if bound := expected.get((c.line.name, c.kind)):
            yield f"{c.line.name}, {c.kind} [rad/s]", f"{c.speed:.8f}", bound
    time = best_time(lambda: bd.resonance_speeds(STEADY_ROLLING, 150.0))
    yield "all crossings below 150 rad/s, 3 modes [s]", f"{time:.3f}", "-"


def compare_amplitudes() -> Iterator[Row]:
    """Yield amplitudes of the steady response at 55 rad/s."""
    for name, scene, modes, amplitude, bound in (
        ("undamped, 5 modes", STEADY_ROLLING, 5, "0.261876", "0.261951"),
        ("with gravity, 3 modes", STEADY_ROLLING_IN_GRAVITY, 3, "0.29895", "0.36868"),
    ):
        response = bd.steady_response(scene, [55.0], modes)
        yield f"amplitude at 55 rad/s, {name} [mm]", f"{response.amplitude[0] * 1e3:.6f}", amplitude
        yield f"sum of lines, {name} [mm]", f"{response.bound[0] * 1e3:.6f}", bound
        yield "... estimated error by neglected harmonics", f"{response.error[0]:.1e}", "1e-5"


def check_instability() -> Iterator[Row]:
    """Yield growth rates at two speeds of parametric instability."""
    for speed in (92.0443, 111.3564):
        response = bd.steady_response(STEADY_ROLLING, [speed])
        yield f"at {speed} rad/s", f"{response.status[0]}, {response.growth_rate[0]:.4f} 1/s", "unstable"


def time_responses() -> Iterator[Row]:
    """Yield the times of steady responses at 1000 speeds."""
    speeds = np.linspace(1, 150, 1000)
    for name, scene, bound in (
        ("undamped", STEADY_ROLLING, "0.5"),
        ("1 % damping", replace(STEADY_ROLLING, damping_ratio=0.01), "0.5"),
        ("with gravity", STEADY_ROLLING_IN_GRAVITY, "-"),
    ):
        time = best_time(lambda scene=scene: bd.steady_response(scene, speeds, 3), 5)
        yield f"1000 speeds x 3 modes, {name} [s]", f"{time:.3f}", bound


PARTS = compare_crossings, compare_amplitudes, check_instability, time_responses


if __name__ == "__main__":
    show("resonance and steady response", *PARTS)
