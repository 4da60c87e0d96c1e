"""Whether the stated errors of frequencies hold.  Run: python -m benchmarks.coverage [--scenes N]

Random scenes of the range in which nothing is refused, against the power series in mpmath.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: the workers share the processors

import numpy as np

import beamdyn as bd
from benchmarks.cases.random_scenes import random_scene
from benchmarks.cases.reference.of_scene import exact, relative_errors
from benchmarks.rows import Row, show

_BOUND, _OVER = 0.999, 30.0
SEED = 5
_DIGITS = 22  # of the reference: enough for errors down to the last bit


@dataclass(frozen=True)
class Case:
    """One random scene: stated and true errors of its first three frequencies, or why it was refused."""

    number: int
    stated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    refusal: str = ""


def measured(number: int, seed: int) -> Case:
    """One case, told by its number."""
    scene, speed = random_scene(np.random.default_rng([seed, number]))
    try:
        found = bd.natural_modes(scene, speed)
    except (ValueError, ArithmeticError) as error:
        return Case(number, refusal=str(error))
    return Case(
        number,
        tuple(found.error.tolist()),
        tuple(relative_errors(found, exact(scene, speed, digits=_DIGITS))),
    )


def coverage(cases: Sequence[Case]) -> Iterator[Row]:
    """Share of errors covered, and by how much."""
    answered = [case for case in cases if not case.refusal]
    stated, true = (np.array([getattr(case, name) for case in answered]) for name in ("stated", "true"))
    covered = stated >= true
    yield "random scenes, first three frequencies", str(len(cases)), "10000"
    yield "refused", str(len(cases) - len(answered)), "0"
    yield "stated error covers the true one", f"{covered.mean():.2%}", f"{_BOUND:.1%}"
    yield "median over-estimate", f"{np.median(stated / true):.1f}", f"{_OVER:g}"
    for mode, over in enumerate(np.median(stated / true, axis=0), 1):
        yield f"... of mode {mode}", f"{over:.1f}", ""
    yield "largest ratio of true to stated error", f"{(true / stated).max():.2g}", "1"
    yield "largest true error", f"{true.max():.1e}", ""
    for case in (case for case, hit in zip(answered, covered, strict=True) if not hit.all()):
        yield f"not covered: scene {case.number}", f"{max(case.true):.1e} > {max(case.stated):.1e}", ""


def run(first: int, scenes: int, workers: int, seed: int) -> list[Case]:
    """Measure so many cases."""
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(partial(measured, seed=seed), range(first, first + scenes), chunksize=8))


def sample() -> Iterator[Row]:
    """The first 200 scenes."""
    yield from coverage(run(0, 200, 2, SEED))


PARTS = (sample,)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case, to go on in parts")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=SEED, help="4 was used to fit the estimate of rounding")
    options = parser.parse_args()
    cases = run(options.first, options.scenes, options.workers, options.seed)
    show("stated errors of frequencies", lambda: coverage(cases))


if __name__ == "__main__":
    main()
