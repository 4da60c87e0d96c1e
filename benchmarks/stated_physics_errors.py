"""Test whether the stated errors of frequencies cover the true errors, with all combinations of physics.

Run: python -m benchmarks.stated_physics_errors [--scenes N] [--stations] [--discretization fem] [--save
FILE].  Random scenes have two planes, twist, shear, rotary inertia and springs at the root; with --stations
they are blades of 10 to 100 stations.  They are solved at three tolerances, and compared with collocation of
the differential equations, which uses no code of the package.
"""

from __future__ import annotations

import argparse
import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from time import process_time
from typing import TypeAlias

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.cases.random_physics import random_physics_scene
from benchmarks.cases.random_stations import random_station_scene
from benchmarks.cases.reference.resolved import Known, known_frequencies
from benchmarks.resumable import Cases, add_options
from benchmarks.rows import Row, show, time_text

_OVER_ESTIMATE = 30.0  # target median over-estimate
_LONGEST = 10.0  # target of the longest computing time, over the median
SEED = 6
Draw: TypeAlias = "Callable[[np.random.Generator], tuple[bd.Scene, float]]"  # draws a scene and a speed
TOLERANCES = (None, 1e-3, 1e-6)
_MODES = {1: 3, 2: 5}  # numbers of modes by the number of planes
_KNOWN = 1e-9  # relative uncertainty above which a reference is not used


@dataclass(frozen=True)
class Answer:
    """Modes of one scene at one tolerance: stated and true errors, or the reason of a refusal.

    `known` are the uncertainties of the true errors, due to the reference.
    """

    number: int
    tolerance: float | None
    time: float
    stated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    known: tuple[float, ...] = ()
    refusal: str = ""

    @property
    def covered(self) -> np.ndarray:
        """Whether each stated error is at least the true error, within its uncertainty; false for nan."""
        stated, true, known = map(np.array, (self.stated, self.true, self.known))
        return (stated == np.inf) | (true <= stated + known)

    @property
    def resolved(self) -> np.ndarray:
        """Whether each true error exceeds the reference's uncertainty, and an error is stated."""
        stated, true, known = map(np.array, (self.stated, self.true, self.known))
        return np.isfinite(stated) & (true > known) & (stated > 0)


def measure(
    number: int,
    seed: int,
    discretization: str,
    tolerances: Sequence[float | None],
    draw: Draw = random_physics_scene,
) -> list[Answer]:
    """Compute the answers for the scene with a number."""
    with warnings.catch_warnings(action="ignore"):  # warnings of beams without a real material
        scene, speed = draw(np.random.default_rng([seed, number]))
        count = _MODES[scene.physics.planes]
        try:
            known = known_frequencies(scene, speed, count)
        except ArithmeticError as error:
            return [Answer(number, None, 0.0, refusal=f"reference: {error}")]
        return [answer(number, scene, speed, discretization, tolerance, known) for tolerance in tolerances]


def answer(
    number: int, scene: bd.Scene, speed: float, discretization: str, tolerance: float | None, known: Known
) -> Answer:
    """Solve a scene, and compare the result with the reference."""
    start = process_time()
    try:
        modes = bd.natural_modes(scene, speed, len(known.eigenvalue), discretization, tolerance)
    except (ValueError, ArithmeticError) as error:
        return Answer(number, tolerance, process_time() - start, refusal=str(error))
    time = process_time() - start
    with np.errstate(divide="ignore", invalid="ignore"):
        true = np.abs(modes.eigenvalue / known.eigenvalue - 1)
    is_zero = np.abs(modes.eigenvalue) < known.zero
    true = np.where(known.eigenvalue == 0, np.where(is_zero, 0.0, np.inf), true)
    stated, true, uncertain = (tuple(v.tolist()) for v in (modes.error, true, known.uncertainty))
    return Answer(number, tolerance, time, stated, true, uncertain)


def cases(
    seed: int = SEED,
    discretization: str = "ritz",
    tolerances: Sequence[float | None] = TOLERANCES,
    draw: Draw = random_physics_scene,
) -> Cases[Answer]:
    """Return the random scenes of a seed, solved by a discretization to some tolerances."""
    each = partial(measure, seed=seed, discretization=discretization, tolerances=tolerances, draw=draw)
    return Cases(each, Answer)


# Report -------------------------------------------------------------------------------------------


def summarize(answers: Sequence[Answer], scenes: int = 3000, covered: float = 0.999) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and the over-estimate, at each tolerance.

    `scenes` and `covered` are the targets: number of scenes, and fraction of covered errors.
    """
    yield "random scenes", str(len({a.number for a in answers})), str(scenes)
    lost = [a for a in answers if a.refusal.startswith("reference")]
    yield "... of which the reference is not known", str(len(lost)), "0"
    for tolerance in dict.fromkeys(a.tolerance for a in answers):
        of_tolerance = [a for a in answers if a.tolerance == tolerance and a not in lost]
        yield from _summarize_tolerance(of_tolerance, f"{covered:.1%}")
    for a in lost:
        yield f"reference of scene {a.number}", a.refusal, ""


def _summarize_tolerance(answers: Sequence[Answer], aim: str) -> Iterator[Row]:
    found = [a for a in answers if not a.refusal]
    covered = np.concatenate([a.covered for a in found])
    whole = np.array([a.covered.all() for a in found])
    stated, true = (
        np.concatenate([np.array(getattr(a, name))[a.resolved] for a in found]) for name in ("stated", "true")
    )
    unresolved = np.mean(np.concatenate([np.isinf(a.stated) for a in found]))
    yield f"tolerance {answers[0].tolerance}: frequencies covered", f"{covered.mean():.2%}", aim
    yield "... scenes covered", f"{whole.mean():.2%} ({whole.sum()} of {whole.size})", aim
    yield "... refused", str(len(answers) - len(found)), "0"
    yield "... stated to be unresolved", f"{unresolved:.2%}", ""
    bound = f"{_OVER_ESTIMATE:g}" if answers[0].tolerance is None else ""
    yield "... median over-estimate", f"{np.median(stated / true):.1f}", bound
    yield "... largest ratio of true to stated error", f"{np.max(true / stated, initial=0):.2g}", "1"
    yield "... largest true error, where one is stated", f"{true.max(initial=0):.1e}", ""
    times = np.array([a.time for a in found])
    yield (
        "... median and longest processor time",
        f"{time_text(np.median(times))}, {time_text(times.max())}",
        "",
    )
    yield "... longest over median", f"{times.max() / np.median(times):.1f}", f"{_LONGEST:g}"
    for a in (a for a in found if not a.covered.all()):
        worst = int(np.argmax(np.array(a.true) - np.array(a.stated)))
        what = f"... not covered: scene {a.number}, mode {worst + 1}"
        yield what, f"{a.true[worst]:.1e} > {a.stated[worst]:.1e}", f"known to {a.known[worst]:.0e}"
    for a in (a for a in answers if a.refusal):
        yield f"... refused: scene {a.number}", a.refusal, ""


def measure_sample() -> Iterator[Row]:
    """Measure the first 100 scenes."""
    yield from summarize(cases().measure_all(range(100)))


PARTS = (measure_sample,)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, scenes=3000, seed=SEED)
    parser.add_argument("--discretization", choices=("ritz", "fem"), default="ritz")
    parser.add_argument("--stations", action="store_true", help="blades of many stations")
    given = parser.parse_args()
    draw = random_station_scene if given.stations else random_physics_scene
    answers = cases(given.seed, given.discretization, draw=draw).run(given)
    what = "many stations" if given.stations else "all physics"
    show(f"stated errors of frequencies with {what}, {given.discretization}", lambda: summarize(answers))


if __name__ == "__main__":
    main()
