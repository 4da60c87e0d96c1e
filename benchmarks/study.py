"""Frequencies of many designs at once, over a loop of single calls.  Run: python -m benchmarks.study

10 000 designs: ten thicknesses, tip masses, radii and speeds each.  The loop makes the scene of each design
and calls `natural_modes`, of this commit, with the default tolerance, as the study has; it is timed on a
random sample of the designs, whose answers are compared.  Both run in one process with one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter

import numpy as np

import beamdyn as bd
from beamdyn.common.parallel.workers import one_blas_thread
from benchmarks.rows import Row, best_time, show

LENGTH, WIDTH, MODULUS, DENSITY = 0.05, 0.01, 200e9, 7850.0
VARY = {
    "beam.thickness": np.linspace(1e-4, 4e-4, 10),
    "beam.tip.mass": np.linspace(0.0, 1e-3, 10),
    "mount.radius": np.linspace(0.0, 0.3, 10),
    "speed": np.linspace(0.0, 80.0, 10),
}
SAMPLE = 300  # designs of the loop of single calls


def single(design: dict[str, float]) -> bd.Modes:
    """What a user would write for one design."""
    tip = bd.TipMass(design["beam.tip.mass"])
    beam = bd.Beam.rectangular(LENGTH, WIDTH, design["beam.thickness"], MODULUS, DENSITY, tip)
    return bd.natural_modes(bd.Scene(beam, bd.Mount(design["mount.radius"])), design["speed"], 3)


def compare() -> Iterator[Row]:
    """Time of a design by a study and by single calls, and how far they differ."""
    beam = bd.Beam.rectangular(LENGTH, WIDTH, 2e-4, MODULUS, DENSITY, bd.TipMass(0.0))
    scene, random = bd.Scene(beam, bd.Mount()), np.random.default_rng(17)
    study = bd.study(scene, VARY)
    number = study.value[..., 0].size
    at_once = best_time(lambda: bd.study(scene, VARY), runs=3) / number
    places = [tuple(random.integers(study.shape)) for _ in range(SAMPLE)]
    designs = [study.design(*place) for place in places]
    singles, each = [], []
    with one_blas_thread():
        for design in designs:
            start = perf_counter()
            singles.append(single(design))
            each.append(perf_counter() - start)
    # The least of each ten, as other programs only ever lengthen a call.
    one = float(np.mean(np.min(np.reshape(each, (-1, 10)), axis=1)))
    yield f"{number} designs, three modes: a design of a study [us]", f"{1e6 * at_once:.0f}", "-"
    yield "... one by one, this commit [us]", f"{1e6 * one:.0f}", "-"
    yield "... one by one over a study", f"{one / at_once:.0f}", "50"
    drawn = {name: random.uniform(values[0], values[-1], number) for name, values in VARY.items()}
    together = best_time(lambda: bd.study(scene, drawn, combine="zip"), runs=3) / number
    yield "... over random designs, each with a speed of its own", f"{one / together:.0f}", "-"
    worst = max(map(_deviation, singles, (study.value[p] for p in places), (study.error[p] for p in places)))
    yield f"{SAMPLE} of them: largest deviation over the stated errors of both", f"{worst:.2f}", "1"


def _deviation(modes: bd.Modes, frequency: np.ndarray, error: np.ndarray) -> float:
    return float(np.nanmax(np.abs(frequency / modes.frequency - 1) / (error + modes.error)))


PARTS = (compare,)


def main() -> None:
    show("many designs", *PARTS)


if __name__ == "__main__":
    main()
