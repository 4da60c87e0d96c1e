"""Times of transients, sweeps and steady responses, relative to one run of scipy's integrator.

Run: python -m benchmarks.ratios            (two minutes)

The reference time is that of Table 3's transient (Lee and Yoo 2019) by solve_ivp's Radau with hand-written
right-hand side and Jacobian, as in `benchmarks.transient`.  All times are measured in one run of this
program.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterator
from dataclasses import replace
from functools import cache
from statistics import median
from time import perf_counter

import numpy as np

import beamdyn as bd
from benchmarks import motions
from benchmarks.cases.scenes import ROLLING, STEADY_ROLLING
from benchmarks.rows import Row, best_time, show
from benchmarks.sweep import run_sweep
from benchmarks.transient import MODES, STOCK, T_END, solve_stock

TOLERANCE, RUNS = 1e-5, 5
ALTERNATING_RUNS = 20  # of each of two calls of some milliseconds that are compared
IMPORTS = {
    "import and first natural_modes": (
        "import beamdyn as bd; "
        "beam = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0); "
        "bd.natural_modes(bd.Scene(beam, bd.Mount(0.215)), 50.0, 3)"
    ),
    "import scipy.linalg": "import scipy.linalg",
}


@cache
def time_radau() -> float:
    """Measure the time of the transient by scipy's Radau [s]."""
    return solve_stock(*STOCK[0])[1]


def compare_transients() -> Iterator[Row]:
    """Yield the time of scipy's run over ours, and of `modes="auto"` over the modes chosen by it."""
    chosen = bd.simulate(ROLLING, T_END, tolerance=TOLERANCE).request
    runs = [
        (
            time_once(lambda: bd.simulate(ROLLING, T_END, MODES, TOLERANCE)),
            time_once(lambda: bd.simulate(ROLLING, T_END, tolerance=TOLERANCE)),
            time_once(chosen.run),
        )
        for _ in range(RUNS)
    ]
    ours, by_tolerance, plain = (median(times) for times in zip(*runs, strict=True))
    radau = time_radau()
    yield "Table 3's transient by solve_ivp Radau, rtol 1e-6 [s]", f"{radau:.1f}", ""
    yield f"... over ours, {MODES} modes, tolerance 1e-5, median of {RUNS}", f"{radau / ours:.0f}", "800"
    ratio = f"{by_tolerance / plain:.2f}"
    yield "modes by the tolerance, over the plain run of what they chose, medians", ratio, "1.5"


def compare_sweeps() -> Iterator[Row]:
    """Yield the times of sweeps of 151 speeds on two workers, over scipy's run."""
    for modes, name, bound in ((MODES, f"{MODES} modes", "0.10"), ("auto", "modes by the tolerance", "0.12")):
        ratio = f"{run_sweep(modes)[1] / time_radau():.3f}"
        yield f"sweep of 151 speeds, 1e-5, two workers, {name}, over the Radau run", ratio, bound


def compare_steady() -> Iterator[Row]:
    """Yield the time of the steady response at 1000 speeds, over scipy's run."""
    speeds = np.linspace(1, 150, 1000)
    time = best_time(lambda: bd.steady_response(STEADY_ROLLING, speeds, 3))
    ratio = f"{time / time_radau():.4f}"
    yield "steady response at 1000 speeds, 3 modes, over the Radau run", ratio, "0.006"


def compare_record() -> Iterator[Row]:
    """Yield the time for a record of a minute at 1 kHz, over that of Table 3's transient."""
    runs = [motions.time_beside_table_3(motions.record(), 60.0, 1e-3) for _ in range(3)]
    record, table_3 = np.min(runs, axis=0)
    name = "a minute of a 1 kHz record, 1e-3, modes by the tolerance, over Table 3's transient"
    yield name, f"{record / table_3:.0f}", "20"


def compare_import() -> Iterator[Row]:
    """Yield the time of import and a first answer, over that of importing scipy.linalg, in new processes."""
    first, scipy_linalg = time_programs(*(["-c", program] for program in IMPORTS.values()))
    yield f"{' over '.join(IMPORTS)}, least of {RUNS}", f"{first / scipy_linalg:.2f}", "1.4"


def compare_start() -> Iterator[Row]:
    """Yield the time of a command on a file, over that of importing scipy.linalg, in new processes."""
    command = ["-m", "beamdyn", "modes", "examples/tyre_harvester.toml"]
    start, scipy_linalg = time_programs(command, ["-c", IMPORTS["import scipy.linalg"]])
    yield f"beamdyn modes FILE over import scipy.linalg, least of {RUNS}", f"{start / scipy_linalg:.2f}", "3"


def time_programs(*arguments: list[str]) -> np.ndarray:
    """Measure the least wall time [s] of Python programs in new processes, which use compiled modules."""
    settings = {name: value for name, value in os.environ.items() if name != "PYTHONDONTWRITEBYTECODE"}
    quiet = {"check": True, "env": settings, "stdout": subprocess.DEVNULL}
    programs = [[sys.executable, *each] for each in arguments]
    runs = [[time_once(lambda p=p: subprocess.run(p, **quiet)) for p in programs] for _ in range(RUNS)]
    return np.min(runs, axis=0)


def compare_tolerances() -> Iterator[Row]:
    """Yield the time of a frequency response at a loose tolerance, over that at a tight tolerance."""
    scene, frequencies = replace(STEADY_ROLLING, damping_ratio=0.01), np.linspace(1.0, 2000.0, 200)
    calls = [lambda t=t: bd.frequency_response(scene, 50.0, frequencies, tolerance=t) for t in (1e-2, 1e-9)]
    runs = [
        [time_once(call) for call in calls] for _ in range(ALTERNATING_RUNS)
    ]  # both in the same conditions
    loose, tight = np.min(runs, axis=0)
    yield "frequency response at 200 frequencies, tolerance 1e-2 over 1e-9", f"{loose / tight:.2f}", "0.4"


def time_once(action: Callable[[], object]) -> float:
    """Measure the wall time of a call [s]."""
    start = perf_counter()
    action()
    return perf_counter() - start


PARTS = (
    compare_transients,
    compare_sweeps,
    compare_steady,
    compare_record,
    compare_import,
    compare_start,
    compare_tolerances,
)


if __name__ == "__main__":
    show("ratios", *PARTS)
