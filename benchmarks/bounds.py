"""Guaranteed bounds against the power-series reference.  Run: python -m benchmarks.bounds [scenes]

Prints how many of the first three exact eigenvalues of random scenes lie between their bounds, how
many lower bounds are missing, how wide the bounds are, and the time for a scene.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from time import perf_counter

import numpy as np

from beamdyn.spectrum.bounds import frequency_bounds
from benchmarks.cases.enclosure import encloses, random_nondimensional_scene, relative_width
from benchmarks.rows import Row, show

MODES = 3
FIRST_SEED = 10_000


def measured(seed: int) -> tuple[np.ndarray, np.ndarray, float]:
    """Whether the bounds of one scene hold, their relative widths, and the time [s]."""
    case = random_nondimensional_scene(np.random.default_rng(seed))
    start = perf_counter()
    found = frequency_bounds(case.scene, case.gamma, MODES)
    time = perf_counter() - start
    return encloses(found, case.exact(MODES)), relative_width(found), time


def rows(scenes: int) -> Iterator[Row]:
    """How the bounds of so many scenes hold."""
    found = map(measured, range(FIRST_SEED, FIRST_SEED + scenes))
    held, width, time = map(np.array, zip(*found, strict=True))
    yield "random scenes with guaranteed bounds of three modes", f"{scenes}", "1000"
    yield "... frequencies outside their bounds", f"{(~held).sum()} of {held.size}", "0"
    yield "... lower bounds missing", f"{np.isnan(width).sum()}", ""
    median, most = np.nanquantile(width, [0.5, 0.99])
    yield "... relative width of the squares, median and 99 %", f"{median:.0e}, {most:.0e}", ""
    yield "... time a scene, median [ms]", f"{np.median(time) * 1e3:.0f}", ""


def sample() -> Iterator[Row]:
    """The first 100 scenes."""
    yield from rows(100)


PARTS = (sample,)


def main() -> None:
    scenes = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    show("guaranteed bounds", lambda: rows(scenes))


if __name__ == "__main__":
    main()
