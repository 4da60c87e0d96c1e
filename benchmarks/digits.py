"""Computing time of each further digit in each analysis.  Run: python -m benchmarks.digits

Takes two minutes.
Each analysis is run for the published scene at 55 rad/s with one tolerance after another; the time of a
call is over that with the loosest tolerance.  `benchmarks.tradeoff` writes the table into docs/tradeoff.md.
"""

from __future__ import annotations

import math
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import partial
from time import process_time

import numpy as np

import beamdyn as bd
from beamdyn.common.parallel.workers import one_blas_thread
from benchmarks import rows
from benchmarks.cases.scenes import HARVESTER, ROLLING, STEADY_ROLLING
from benchmarks.rows import Row, markdown_table, show, time_text

RUNS = 3
TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9)
SPEED = 55.0
DAMPED = replace(HARVESTER, damping_ratio=0.01)
BENT = replace(HARVESTER, mount=bd.Mount(0.215, math.pi / 4))
FREQUENCIES = np.geomspace(20.0, 500.0, 200)
BENDING = bd.PowerSpectrum([5.0, 500.0], [1.0, 1.0])
Call = Callable[..., object]  # function of a tolerance that runs an analysis

ANALYSES: dict[str, Call] = {
    "natural_modes, 3 modes": partial(bd.natural_modes, HARVESTER, SPEED, 3),
    "frequency_locus, 101 speeds": partial(bd.frequency_locus, HARVESTER, np.linspace(0, SPEED, 101), 3),
    "critical_speed": partial(bd.critical_speed, HARVESTER),
    "setting_angle_limits": partial(bd.setting_angle_limits, HARVESTER, SPEED),
    "resonance_speeds": partial(bd.resonance_speeds, STEADY_ROLLING, SPEED, 3),
    "equilibrium, at 45 deg": partial(bd.equilibrium, BENT, SPEED),
    "backbone, at 45 deg": partial(bd.backbone, BENT, SPEED),
    "static_loads": partial(bd.static_loads, BENT, [SPEED]),
    "matrices": partial(bd.matrices, HARVESTER, SPEED),
    "frequency_response, 200 frequencies": partial(bd.frequency_response, DAMPED, SPEED, FREQUENCIES),
    "random_response": partial(bd.random_response, DAMPED, SPEED, BENDING, "bending"),
    "steady_response, 100 speeds": partial(
        bd.steady_response, replace(STEADY_ROLLING, damping_ratio=0.01), np.linspace(1, SPEED, 100)
    ),
    "simulate, 30 s": partial(bd.simulate, ROLLING, 30.0),
}


@one_blas_thread()
def measure(call: Call) -> list[float]:
    """Measure the times of an analysis at each tolerance [s]."""
    with warnings.catch_warnings(action="ignore"):
        return [rows.best_time(partial(call, tolerance=each), RUNS, process_time) for each in TOLERANCES]


def tabulate() -> str:
    """Make the table of the page: a row for each analysis, a column for each tolerance."""
    head = ("analysis", *(f"{each:.0e}" for each in TOLERANCES))
    return markdown_table(head, ((name, *_cells(measure(call))) for name, call in ANALYSES.items()))


def _cells(times: list[float]) -> Iterator[str]:
    yield time_text(times[0])
    yield from (f"{time / times[0]:.2f}" for time in times[1:])


def compare() -> Iterator[Row]:
    """Yield the time at the tightest tolerance over that at the loosest."""
    for name, call in ANALYSES.items():
        times = measure(call)
        yield f"{name}: {TOLERANCES[-1]:.0e} over {TOLERANCES[0]:.0e}", f"{times[-1] / times[0]:.1f}", ""


PARTS = (compare,)


if __name__ == "__main__":
    show("the cost of digits", *PARTS)
