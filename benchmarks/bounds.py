"""Guaranteed bounds against the power-series reference.  Run: python -m benchmarks.bounds [scenes]

Prints how many of the first three exact eigenvalues of random scenes lie between their bounds, how
many lower bounds are missing, how wide the bounds are, and the time for a scene.
"""

from __future__ import annotations

import sys
from time import perf_counter

import numpy as np

from beamdyn.bounds import frequency_bounds
from tests.invariants.test_bounds import draw, encloses, relative_width

MODES = 3
FIRST_SEED = 10_000


def measured(seed: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Whether the bounds of one scene hold, their relative widths, and the time [s]."""
    case = draw(np.random.default_rng(seed))
    start = perf_counter()
    found = frequency_bounds(case.scene, case.gamma, MODES)
    time = perf_counter() - start
    return encloses(found, case.exact(MODES)), relative_width(found), time


def main(scenes: int) -> int:
    held, width, time = map(
        np.array, zip(*map(measured, range(FIRST_SEED, FIRST_SEED + scenes)), strict=True)
    )
    print(f"{scenes} scenes, {held.size} eigenvalues: {held.sum()} enclosed, {(~held).sum()} not")
    print(f"lower bounds missing: {np.isnan(width).sum()}")
    known = width[~np.isnan(width)]
    quantiles = np.quantile(known, [0.5, 0.9, 0.99, 1.0])
    print("relative width of the squares, median, 90 %, 99 %, all:", *(f"{q:.1e}" for q in quantiles))
    print(f"time a scene: median {np.median(time) * 1e3:.0f} ms, longest {time.max() * 1e3:.0f} ms")
    return int(not held.all())


if __name__ == "__main__":
    sys.exit(main(int(sys.argv[1]) if len(sys.argv) > 1 else 1000))
