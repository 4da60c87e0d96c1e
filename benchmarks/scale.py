"""A million designs, and ten thousand speeds, on a Dask cluster of processes of this machine.

Run: python -m benchmarks.scale   (--designs 20000 --speeds 50: reduced, a minute; --save FILE: in parts)

Random designs, each with a random speed, are solved in this process and on the cluster, where one worker is
killed during the run.  The sweep is that of the wheel of Table 3 (Lee and Yoo 2019), with 5 modes and a
tolerance of 1e-3.  Efficiency is the time in one process over the product of time on the cluster and number
of workers; the time in one process is extrapolated from a sample.  Memory is the largest of each process.
"""

from __future__ import annotations

import argparse
import os
import resource
import signal
from collections.abc import Callable, Iterator
from concurrent.futures import Executor
from contextlib import contextmanager
from dataclasses import dataclass, field
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter
from typing import Any

import numpy as np

import beamdyn as bd
from benchmarks.cases.scenes import ROLLING
from benchmarks.resumable import SavedRows
from benchmarks.rows import Row, show

SAMPLE, SPEED_SAMPLE = 20_000, 40  # numbers of designs and of speeds that are also solved in one process
COMPARED = 100  # number of designs that are compared with single calls
SCENE = bd.Scene(bd.Beam.rectangular(0.05, 0.01, 2e-4, 200e9, 7850.0, bd.TipMass(0.0)), bd.Mount())
RANGES = {
    "beam.thickness": (1e-4, 4e-4),
    "beam.tip.mass": (0.0, 1e-3),
    "mount.radius": (0.0, 0.3),
    "speed": (0.0, 80.0),
}


def peak_memory() -> float:
    """Return the largest memory that this process has had [MB]."""
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def designs(count: int) -> dict[str, np.ndarray]:
    """Draw random designs."""
    random = np.random.default_rng(17)
    return {name: random.uniform(*ends, count) for name, ends in RANGES.items()}


@dataclass
class Accident:
    """A progress callback that kills a worker when half is done, and records the workers' memory.

    Parameters
    ----------
    client : Client
        The cluster's client.
    victim : int
        Identifier of the process that is killed.
    """

    client: Any
    victim: int
    calls: list[int] = field(default_factory=list)
    killed: bool = False
    memory: float = 0.0  # largest memory of a worker reported to the scheduler [MB]

    def __call__(self, done: int, total: int) -> None:
        self.calls.append(done)
        workers = self.client.scheduler_info()["workers"].values()
        held = (worker["metrics"].get("memory", 0) for worker in workers if "metrics" in worker)
        self.memory = max([self.memory, *(size / 2**20 for size in held)])
        if not self.killed and total / 2 <= done < total:
            self.killed = True
            os.kill(self.victim, signal.SIGKILL)


@contextmanager
def cluster(workers: int) -> Iterator[Accident]:
    """Start a cluster of processes on this machine; yield the `Accident` that will kill one."""
    from distributed import Client, LocalCluster

    options: dict[str, Any] = {"threads_per_worker": 1, "processes": True, "dashboard_address": None}
    with LocalCluster(n_workers=workers, **options) as made, Client(made) as client:
        client.run(_import)
        yield Accident(client, min(client.run(os.getpid).values()))


def _import() -> None:
    import beamdyn.studies.study
    import beamdyn.transient.sweep  # noqa: F401


def timed(action: Callable[[], Any]) -> tuple[float, Any]:
    """Run an action; return wall time [s] and result."""
    start = perf_counter()
    result = action()
    return perf_counter() - start, result


def many_designs(count: int, workers: int) -> Iterator[Row]:
    """Yield times and memory for random designs on the cluster, with a killed worker, and in one process."""
    sample = min(count, SAMPLE)
    alone, own = timed(lambda: bd.study(SCENE, designs(sample), combine="zip"))
    before = peak_memory()
    with cluster(workers) as accident:
        executor = accident.client.get_executor()
        options: dict[str, Any] = {"combine": "zip", "executor": executor, "progress": accident}
        time, found = timed(lambda: bd.study(SCENE, designs(count), **options))
    yield f"{count} random designs, {workers} workers, one of them killed: wall time [s]", f"{time:.1f}", "-"
    yield "... of a design [us]; in one process", f"{1e6 * time / count:.0f}; {1e6 * alone / sample:.0f}", "-"
    efficiency = alone / sample * count / (time * workers)
    yield "... efficiency against one process, with the killed worker", f"{efficiency:.2f}", "-"
    yield "... calls of progress; last", f"{len(accident.calls)}; {accident.calls[-1]} of {count}", "-"
    yield "... largest memory of a worker [MB]", f"{accident.memory:.0f}", "-"
    yield (
        "... largest memory of this process, before and after [MB]",
        f"{before:.0f}, {peak_memory():.0f}",
        "-",
    )
    yield (
        f"... {COMPARED} of them: largest deviation from single calls, over the stated errors",
        f"{worst(found):.2f}",
        "1",
    )
    if count == sample:
        same = all(
            np.array_equal(getattr(own, n), getattr(found, n), equal_nan=n == "value")
            for n in ("value", "error")
        )
        yield "... the same to the bit as in one process", "yes" if same else "no", "yes"


def worst(study: bd.Study) -> float:
    """Compute the largest deviation of designs from single calls, over the sum of their stated errors."""
    random, largest = np.random.default_rng(1), 0.0
    for place in random.integers(study.shape[0], size=COMPARED).tolist():
        single = bd.natural_modes(study.scene_at(place), study.design(place)["speed"])
        deviation = np.abs(study.value[place] / single.frequency - 1)
        largest = max(largest, float(np.nanmax(deviation / (study.error[place] + single.error), initial=0.0)))
    return largest


def many_speeds(count: int, workers: int) -> Iterator[Row]:
    """Yield times and memory for a sweep on the cluster, with a killed worker, and in one process."""
    sample = min(count, SPEED_SAMPLE)

    def run(number: int, executor: Executor | None = None, **more: Any) -> bd.Sweep:
        speeds = np.linspace(1.0, 140.0, number)
        options: dict[str, Any] = {"modes": 5, "tolerance": 1e-3, "executor": executor, **more}
        return bd.sweep(ROLLING, speeds, (20.0, 30.0), **options)

    alone, _ = timed(lambda: run(sample))
    with cluster(workers) as accident:
        time, found = timed(lambda: run(count, accident.client.get_executor(), progress=accident))
    done = sum(status == "done" for status in found.status)
    yield f"sweep of {count} speeds, {workers} workers, one killed: wall time [s]", f"{time:.1f}", "-"
    yield "... done", f"{done} of {count}", f"{count}"
    yield "... efficiency against one process", f"{alone / sample * count / (time * workers):.2f}", "-"
    yield "... largest memory of a worker [MB]", f"{accident.memory:.0f}", "-"


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--designs", type=int, default=1_000_000)
    parser.add_argument("--speeds", type=int, default=10_000)
    parser.add_argument("--workers", type=int, default=os.cpu_count() or 1)
    parser.add_argument("--save", type=Path, help="file of the two parts, to which a run adds what it lacks")
    given = parser.parse_args()
    if find_spec("distributed") is None:
        print('skipped: Dask is not installed; pip install "beamdyn[dask]"')
        return
    versions = f"beamdyn {bd.__version__}, numpy {np.__version__}, {given.workers} workers"
    saved = SavedRows(given.save, versions)
    for part, count in ((many_designs, given.designs), (many_speeds, given.speeds)):
        if count:
            title = f"{part.__name__.replace('_', ' ')}: {count}"
            rows = saved.rows(title, lambda _, part=part, count=count: [*part(count, given.workers)])
            show(title, rows.__iter__)


if __name__ == "__main__":
    main()
