"""Fig. 6 of Lee and Yoo (2019), transients at 151 speeds.  Run: python -m benchmarks.sweep

Prints the wall time, peak memory and the two resonance peaks, each beside its bound.
"""

from __future__ import annotations

import resource
import sys
from collections.abc import Iterator
from concurrent.futures import ProcessPoolExecutor
from multiprocessing import get_context
from time import perf_counter

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

import beamdyn as bd
from beamdyn.modes.modal.model import ModalBasis
from beamdyn.transient.chunks import SweepRequest, solve_chunk
from benchmarks.cases.scenes import ROLLING
from benchmarks.rows import Row, show

MODES, WORKERS = 5, 2


def run_sweep(modes: int | str) -> tuple[bd.Sweep, float]:
    """Run the sweep, and print its progress; return the result and the wall time [s]."""
    columns = TextColumn("speeds"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    with Progress(*columns, console=Console(stderr=True)) as bar:
        task = bar.add_task("speeds")
        start = perf_counter()
        sweep = bd.sweep(
            ROLLING,
            np.linspace(0, 150, 151),
            modes=modes,
            workers=WORKERS,
            progress=lambda done, total: bar.update(task, completed=done, total=total),
        )
        return sweep, perf_counter() - start


def measure_peak_memory() -> float:
    """Measure an upper bound of the memory that a process and its workers held for the sweep [GB]."""
    with ProcessPoolExecutor(1, get_context("spawn")) as alone:
        return alone.submit(_memory_of_sweep).result()


def _memory_of_sweep() -> float:
    """Measure an upper bound of the memory [GB] of this process, the first worker, and its children."""
    run_sweep(MODES)
    unit = 1 if sys.platform == "darwin" else 1024
    own, largest = (
        resource.getrusage(who).ru_maxrss for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)
    )
    return (own + (WORKERS - 1) * largest) * unit / 1e9


def find_two_largest(sweep: bd.Sweep) -> list[tuple[float, float]]:
    """Find the two largest peaks [m] that exceed their neighbours, with their speeds [rad/s]."""
    p = np.pad(sweep.peaks, 1, constant_values=-np.inf)
    tops = np.flatnonzero((p[1:-1] > p[:-2]) & (p[1:-1] >= p[2:]))
    best = sorted(tops, key=lambda k: -sweep.peaks[k])[:2]
    return [(float(sweep.peaks[k]), float(sweep.speeds[k])) for k in best]


def time_chunk() -> float:
    """Measure the time of the last chunk, the slowest, in this process [s]."""
    request = SweepRequest(ROLLING, (20.0, 30.0), 30.0, 1e-5, "ritz", ModalBasis(MODES))
    start = perf_counter()
    solve_chunk(request, tuple(np.arange(111.0, 151.0)))
    return perf_counter() - start


def measure_fig_6() -> Iterator[Row]:
    """Yield time, memory and peaks of Fig. 6, with five modes and with modes chosen by the tolerance."""
    for modes, bound in ((MODES, "8"), ("auto", "")):
        sweep, time = run_sweep(modes)
        name = f"151 transients of 30 s (Fig. 6), {modes if modes == 'auto' else f'{modes} rest'} modes"
        yield f"{name}: wall time, {WORKERS} workers [s]", f"{time:.2f}", bound
        error = (sweep.time_error[1:] / sweep.largest[1:]).max()
        yield f"{name}: largest estimated time-integration error", f"{error:.1e}", "1e-5"
        yield f"{name}: largest estimated modal truncation error", f"{sweep.mode_error:.1e}", ""
        for peak, speed in find_two_largest(sweep):
            yield f"{name}: peak at {speed:g} rad/s [mm]", f"{1e3 * peak:.4f}", "resonance at 53.086, 69.802"
    yield (
        f"{MODES} modes, alone: peak memory of all processes, at most [GB]",
        f"{measure_peak_memory():.2f}",
        "0.5",
    )
    yield "40 speeds, 111 to 150 rad/s, 5 modes, in one process [s]", f"{time_chunk():.2f}", ""


PARTS = (measure_fig_6,)


if __name__ == "__main__":
    show("sweep", *PARTS)
