"""Measurements of beamdyn on the cases that are also solved by other programs."""

from __future__ import annotations

import math
from collections.abc import Iterator
from functools import lru_cache

import numpy as np

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER, ROLLING
from benchmarks.peers import measure
from benchmarks.peers.measure import ALONE, DEFAULT, OURS, Point, best_threads

TOLERANCES = (None, 1e-7, 1e-4)  # tolerances of frequencies
BLADE_SCENE = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0, math.pi, math.pi / 2))
# Number of modes and tolerance.
TRANSIENTS = ((3, 1e-1), (5, 1e-2), (5, 1e-5), ("auto", 1e-2), ("auto", 1e-5))


def version() -> str:
    return bd.__version__


def points() -> Iterator[Point]:
    yield from measure_frequencies(measure.HARVESTER, HARVESTER, measure.harvester_frequencies(), 1001)
    exact = {speed: f / (2 * math.pi) for speed, f in measure.blade_frequencies().items()}
    yield from measure_frequencies(measure.BLADE, BLADE_SCENE, exact, 1201)
    for modes, tolerance in TRANSIENTS:
        yield measure_transient(modes, tolerance)


def measure_frequencies(case: str, scene: bd.Scene, exact: dict[float, float], count: int) -> Iterator[Point]:
    """Measure frequencies over many speeds at once, and at each speed with a known frequency alone."""
    speeds = np.linspace(0, max(exact), count)
    for tolerance in TOLERANCES:
        yield measure_locus(case, scene, speeds, exact, tolerance)
    for tolerance in TOLERANCES:
        yield measure_alone(case, scene, exact, tolerance)


def measure_locus(
    case: str, scene: bd.Scene, speeds: np.ndarray, exact: dict[float, float], tolerance: float | None
) -> Point:
    """Measure the time per speed of frequencies over many speeds at once."""
    time, locus = best_threads(lambda: bd.frequency_locus(scene, speeds, 1, tolerance=tolerance))
    rows = [int(np.abs(speeds - speed).argmin()) for speed in exact]
    error = measure.largest_error(dict(zip(exact, locus.frequency[rows, 0], strict=True)), exact)
    return Point(case, OURS, f"locus of {len(speeds)} speeds, {name(tolerance)}", time / len(speeds), error)


def measure_alone(case: str, scene: bd.Scene, exact: dict[float, float], tolerance: float | None) -> Point:
    """Measure the time of frequencies at a single speed."""
    time, results = best_threads(
        lambda: [bd.natural_modes(scene, speed, 1, tolerance=tolerance) for speed in exact]
    )
    error = measure.largest_error({m.speed: m.frequency[0] for m in results}, exact)
    return Point(case, OURS, f"{ALONE}, {name(tolerance)}", time / len(exact), error)


def name(tolerance: float | None) -> str:
    return DEFAULT if tolerance is None else f"tolerance {tolerance:g}"


def measure_transient(modes: int | str, tolerance: float) -> Point:
    """Measure the time of a transient, and the error of its largest deflection."""
    time, largest = best_threads(
        lambda: bd.simulate(ROLLING, measure.T_END, modes, tolerance).peak(*measure.WINDOW)
    )
    error = abs(largest / largest_deflection() - 1)
    basis = "modes by tolerance" if modes == "auto" else f"{modes} modes at rest, tolerance"
    return Point(measure.ROLLING, OURS, f"{basis} {tolerance:g}", time, error)


@lru_cache
def largest_deflection() -> float:
    """Compute the largest deflection of the linear model [m], accurate to 1e-8."""
    return bd.simulate(ROLLING, measure.T_END, tolerance=1e-8).peak(*measure.WINDOW)
