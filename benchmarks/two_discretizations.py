"""Test whether assumed modes and finite elements agree within the sum of their stated errors.

Run: python -m benchmarks.two_discretizations [--scenes N] [--save FILE].  The random beams have properties
given by tables with kinks and jumps, springs at the root and along the beam, point masses and tip bodies.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.modes.modal.model import Model
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row

SEED = 8
_MODES = 3


@dataclass(frozen=True)
class Case:
    """Relative difference of both answers for each mode, and the sum of stated errors, or a refusal."""

    number: int
    distance: tuple[float, ...] = ()
    stated: tuple[float, ...] = ()
    of_elements: tuple[float, ...] = ()
    refusal: str = ""


def random_table_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a beam of two to eight stations, whose stiffness varies a hundredfold, and a speed."""
    places = np.unique(np.concatenate([[0.0, 1.0], rng.uniform(0.01, 0.99, int(rng.integers(0, 7)))]))
    jumps = places[1:-1][rng.random(len(places) - 2) < 0.3]
    stations = np.sort(np.concatenate([places, jumps])).tolist()
    mass, stiffness = (
        bd.Table(stations, (10 ** rng.uniform(-decades, decades, len(stations))).tolist())
        for decades in (0.5, 1)
    )
    beam = bd.Beam.from_stiffness(
        1.0,
        mass,
        stiffness,
        tip=bd.TipMass(10 ** rng.uniform(-2, 0), rng.uniform(-0.05, 0.1)) if rng.random() < 0.4 else None,
        point_masses=[bd.PointMass(rng.uniform(0.1, 0.9), 10 ** rng.uniform(-2, 0))]
        if rng.random() < 0.3
        else (),
        point_springs=[bd.PointSpring(rng.uniform(0.1, 0.9), 10 ** rng.uniform(-1, 3))]
        if rng.random() < 0.3
        else (),
    )
    spring = rng.choice([np.inf, 10 ** rng.uniform(-2, 3)])
    mount = bd.Mount(rng.uniform(0, 2), rng.choice([0.0, np.pi]), rng.choice([0.0, np.pi / 2, 0.7]), spring)
    scene = bd.Scene(beam, mount)
    solver = Model(scene, bd.Ritz(10)).solver
    share = rng.choice([0.0, rng.uniform(0, 0.95)])
    return scene, float(share * min(solver.critical_speed, 20 * np.sqrt(abs(solver.lowest_at_rest))))


def measure(number: int, seed: int) -> list[Case]:
    """Solve the scene with a number by both discretizations, and compare the frequencies."""
    with warnings.catch_warnings(action="ignore"):  # warnings of beams without a real material
        scene, speed = random_table_scene(np.random.default_rng([seed, number]))
        try:
            ritz, fem = (bd.natural_modes(scene, speed, _MODES, name) for name in ("ritz", "fem"))
        except (ValueError, ArithmeticError) as error:
            return [Case(number, refusal=str(error))]
    distance = np.abs(fem.eigenvalue / ritz.eigenvalue - 1)
    return [Case(number, *(tuple(each.tolist()) for each in (distance, ritz.error + fem.error, fem.error)))]


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the number of scenes that agree, and the differences of the others."""
    found = [case for case in cases if not case.refusal]
    ratio = np.array([np.max(np.array(case.distance) / np.array(case.stated)) for case in found])
    yield "random scenes; refused", f"{len(cases)}; {len(cases) - len(found)}", "2000"
    yield "agree within both stated errors", f"{np.mean(ratio <= 1):.2%}", "99.9 %"
    yield "distance over stated errors: median, largest", f"{np.median(ratio):.1g}, {ratio.max():.3g}", "1"
    yield "stated by elements, median", f"{np.median([case.of_elements for case in found]):.1e}", ""
    yield "unresolved", f"{np.isinf([case.stated for case in found]).mean():.2%}", ""
    for case, by in zip(found, ratio, strict=True):
        if by > 1:
            yield f"not: scene {case.number}", f"{max(case.distance):.1e}", f"{by:.2f}"
    yield from ((f"refused: scene {case.number}", case.refusal, "") for case in cases if case.refusal)


def cases(seed: int = SEED) -> Cases[Case]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Case)


def measure_sample() -> Iterator[Row]:
    """Measure the first 100 scenes."""
    yield from summarize(cases().measure_all(range(100)))


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(__doc__, "assumed modes beside finite elements", cases, summarize, 2000, SEED)
