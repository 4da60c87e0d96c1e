"""Guaranteed bounds against the power-series reference.  Run: python -m benchmarks.bounds [scenes]

Prints how many of the first three exact eigenvalues of random scenes lie between their bounds, how
many lower bounds are missing, how wide the bounds are, and the time for a scene.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from time import perf_counter

import numpy as np

from beamdyn.modes.bounds import frequency_bounds
from benchmarks.cases.enclosure import encloses, random_nondimensional_scene, relative_width
from benchmarks.rows import Row, show

MODES = 3
FIRST_SEED = 10_000


def measure(seed: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Compute whether the bounds of one random scene hold, their relative widths, and the time [s]."""
    case = random_nondimensional_scene(np.random.default_rng(seed))
    start = perf_counter()
    bounds = frequency_bounds(case.scene, case.gamma, MODES)
    time = perf_counter() - start
    return encloses(bounds, case.exact(MODES)), relative_width(bounds), time


def summarize(scenes: int) -> Iterator[Row]:
    """Yield the number of exact frequencies outside their bounds, the bounds' widths, and the time."""
    measurements = map(measure, range(FIRST_SEED, FIRST_SEED + scenes))
    held, width, time = map(np.array, zip(*measurements, strict=True))
    yield "random scenes with guaranteed bounds of three modes", f"{scenes}", "1000"
    yield "... frequencies outside their bounds", f"{(~held).sum()} of {held.size}", "0"
    yield "... lower bounds missing", f"{np.isnan(width).sum()}", ""
    median, most = np.nanquantile(width, [0.5, 0.99])
    yield "... relative width of the squares, median and 99 %", f"{median:.0e}, {most:.0e}", ""
    yield "... time a scene, median [ms]", f"{np.median(time) * 1e3:.0f}", ""


def measure_sample() -> Iterator[Row]:
    """Measure the first 100 random scenes."""
    yield from summarize(100)


PARTS = (measure_sample,)


def main() -> None:
    scenes = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    show("guaranteed bounds", lambda: summarize(scenes))


if __name__ == "__main__":
    main()
