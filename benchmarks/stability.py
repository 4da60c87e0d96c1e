"""Charts of stability: time relative to a run of scipy's integrator, and verdicts point by point.

Run: python -m benchmarks.stability            (ten minutes)
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from time import perf_counter

import numpy as np
from scipy.integrate import solve_ivp

import beamdyn as bd
from beamdyn.studies.floquet.monodromy import PeriodicScenes
from beamdyn.transient.system import ModalSystem
from benchmarks.cases.scenes import HARVESTER
from benchmarks.rows import Row, show
from benchmarks.transient import STOCK, solve_stock

POINTS, MODES, CHECKED = 200, 3, 20
MOTION = bd.PulsatingRotation(50.0, 0.1, 124.0)  # pulsates at about twice the first frequency
VARY = {
    "frequency and amplitude": {"motion.frequency": (60.0, 260.0), "motion.fluctuation": (0.0, 0.5)},
    "speed and amplitude": {"speed": (5.0, 150.0), "motion.fluctuation": (0.0, 0.5)},
    "speed and setting angle": {"speed": (5.0, 150.0), "mount.setting_angle": (0.0, 3.1)},
}


def race_a_stock_integrator() -> Iterator[Row]:
    """Yield times of charts of 200 x 200 points with three modes, relative to one run of scipy's Radau."""
    method, rtol, atol = STOCK[0]
    _, stock = solve_stock(method, rtol, atol)
    yield f"one run of {method}, rtol {rtol:g}: time [s]", f"{stock:.1f}", ""
    for name, ranges in VARY.items():
        for ratio in (0.0, 0.01):
            yield from _rows(name, ranges, ratio, stock)


def _rows(name: str, ranges: dict[str, tuple[float, float]], ratio: float, stock: float) -> Iterator[Row]:
    scene = replace(HARVESTER, motion=MOTION, damping_ratio=ratio)
    vary = {path: np.linspace(*ends, POINTS) for path, ends in ranges.items()}
    start = perf_counter()
    chart = bd.stability_chart(scene, vary, MODES)
    time = perf_counter() - start
    head = f"{name}, damping ratio {ratio:g}"
    yield f"{head}: time over that run", f"{time / stock:.2f}", "0.5"
    yield "... scenes integrated", str(chart.integrated), ""
    yield "... undecided", f"{(chart.status == 'undecided').mean():.2%}", "1 %"
    wrong, missed = _compare(scene, vary, chart)
    yield (
        f"... of {CHECKED} points near limits and anywhere, other verdicts by DOP853 at 1e-12",
        str(wrong),
        "0",
    )
    yield "... growth rates beyond the stated error and that of DOP853", str(missed), "0"


def _compare(scene: bd.Scene, vary: dict[str, np.ndarray], chart: bd.StabilityChart) -> tuple[int, int]:
    """Count points with another verdict or growth rate by scipy's integrator."""
    generator, wrong, missed = np.random.default_rng(0), 0, 0
    edges = np.argwhere(np.diff((chart.status == "unstable").astype(int), axis=0))
    places = [*generator.permutation(edges)[: CHECKED // 2].tolist()]
    places += generator.integers(0, POINTS, (CHECKED - len(places), 2)).tolist()
    for i, j in places:
        numbers = {path: float(values[k]) for (path, values), k in zip(vary.items(), (i, j), strict=True)}
        radius, period = spectral_radius(scene, numbers)
        # Square root of the integrator's tolerance, for points at the limits of stability.
        rate, uncertain = np.log(radius) / period, 1e-5 / period
        unstable = chart.status[i, j] == "unstable"
        wrong += bool(abs(rate) > uncertain and unstable != (rate > 0) and chart.status[i, j] != "undecided")
        missed += bool(abs(rate - chart.growth_rate[i, j]) > chart.growth_rate_error[i, j] + uncertain)
    return wrong, missed


def spectral_radius(scene: bd.Scene, numbers: dict[str, float]) -> tuple[float, float]:
    """Compute the magnitude of the largest Floquet multiplier by DOP853 at 1e-12, and the period [s]."""
    scenes = PeriodicScenes(scene, MODES, "ritz")
    scene = scenes.at(numbers)
    _, equations = scenes.modal(scene)
    assert scene.motion is not None
    system = ModalSystem(replace(equations, mount=scene.mount), scene.motion)
    period, n = float(scenes.monodromy(numbers).period[0]), system.size
    scale = np.concatenate([np.ones(n), np.sqrt(np.diag(equations.matrices[0]["unity"]))])

    def free(t: float, y: np.ndarray) -> np.ndarray:
        return system.jacobian(t, y) @ y

    columns = [
        solve_ivp(free, (0, period), y, "DOP853", rtol=1e-12, atol=1e-13 * scale).y[:, -1]
        for y in np.diag(scale)
    ]
    return float(np.abs(np.linalg.eigvals(np.array(columns).T / scale[:, None])).max()), period


if __name__ == "__main__":
    show("Stability in periodic motion", race_a_stock_integrator)
