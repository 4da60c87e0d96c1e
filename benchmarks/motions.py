"""Computing times of recorded, oscillating and abrupt motions, relative to the transient of Table 3.

Run: python -m benchmarks.motions

The transient of Table 3 (Lee and Yoo 2019) is measured in the same run.  The record is a minute of a spin-up
with some ripple, sampled at 1 kHz; `noise` adds random errors to the samples.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from time import process_time

import numpy as np

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER, ROLLING, STEADY_ROLLING
from benchmarks.rows import Row, best_time, show

TILTED = replace(HARVESTER, mount=bd.Mount(0.215, 0.3))  # tilted, so that rotation bends the beam
MINUTE = np.arange(60_001) / 1000
RUNS = 3


def record(noise: float = 0.0) -> bd.Scene:
    """Make a record of a minute of rotation at 1 kHz, with normal errors of a given size [rad/s]."""
    x = np.minimum(MINUTE / 10, 1)
    speed = 55 * x**2 * (3 - 2 * x) + 0.2 * np.sin(3 * MINUTE) ** 2
    speed = speed + noise * np.random.default_rng(1).standard_normal(len(MINUTE))
    return replace(TILTED, motion=bd.SampledRotation(MINUTE, speed))


def jump() -> bd.Scene:
    """Make a record of 10 s in 5000 samples, with a jump of the speed by 5 rad/s at half time."""
    t = np.linspace(0, 10.0, 5000)
    x = np.minimum(t / (10.0 / 3), 1)
    return replace(TILTED, motion=bd.SampledRotation(t, 50 * x**2 * (3 - 2 * x) + 5.0 * (t > 5.0)))


MOTIONS = {  # scene, end [s], tolerance, bound over Table 3's transient
    "a minute of a 1 kHz record, tolerance 1e-3": (record(), 60.0, 1e-3, "20"),
    "... with errors of 0.001 rad/s": (record(0.001), 60.0, 1e-3, ""),
    "10 s of a record of 5000 samples with a jump, tolerance 1e-5": (jump(), 10.0, 1e-5, ""),
    "30 s of ringing at constant coefficients, tolerance 1e-3": (
        replace(TILTED, motion=bd.SteadyRotation(55.0)),
        30.0,
        1e-3,
        "",
    ),
    "30 s at steady speed on the road, tolerance 1e-3": (STEADY_ROLLING, 30.0, 1e-3, ""),
    "30 s with a spin-up within 1 ms, tolerance 1e-3": (
        replace(TILTED, motion=bd.SpinUp(5.0, duration=1e-3)),
        30.0,
        1e-3,
        "",
    ),
}


def time_motions() -> Iterator[Row]:
    """Yield the time of each kind of motion, measured in turn with that of Table 3's transient."""
    for name, (scene, t_end, tolerance, bound) in MOTIONS.items():
        runs = [time_beside_table_3(scene, t_end, tolerance) for _ in range(RUNS)]
        time, table_3 = np.min(runs, axis=0)
        yield f"{name}: CPU time [s]", f"{time:.2f}", ""
        yield "... over Table 3's transient, 5 modes, 1e-5", f"{time / table_3:.0f}", bound


def time_beside_table_3(scene: bd.Scene, t_end: float, tolerance: float) -> tuple[float, float]:
    """Measure processor times [s] of a transient, and of Table 3's transient before it."""
    table_3 = best_time(lambda: bd.simulate(ROLLING, 30.0, 5, tolerance=1e-5), 2, process_time)
    return best_time(lambda: bd.simulate(scene, t_end, tolerance=tolerance), 1, process_time), table_3


def check_record() -> Iterator[Row]:
    """Yield errors of the record's transient, against a finer run with more modes."""
    scene, _, tolerance, _ = MOTIONS["a minute of a 1 kHz record, tolerance 1e-3"]
    run, fine = (bd.simulate(scene, 20.0, tolerance=each) for each in (tolerance, 1e-2 * tolerance))
    t = np.linspace(0, 20.0, 20_001)
    error = np.abs(run.deflection(t) - fine.deflection(t)).max() / fine.largest
    stated = run.time_error / run.largest + run.mode_error
    yield (
        "largest error in its first 20 s, over the largest deflection",
        f"{error:.1e}",
        f"{stated:.1e} stated",
    )


PARTS = time_motions, check_record


if __name__ == "__main__":
    show("motions of other kinds", *PARTS)
