"""Test whether the stated errors of frequencies cover the true errors.

Run: python -m benchmarks.stated_frequency_errors [--scenes N] [--save FILE].  Random scenes, from a range in
which every scene has an answer, against the power series in mpmath.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.cases.random_scenes import random_scene
from benchmarks.cases.reference.of_scene import exact, relative_errors
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row

_COVERED, _OVER_ESTIMATE = 0.999, 30.0  # target fraction of covered errors, and target median over-estimate
SEED = 5  # not seed 4, which was used to fit the estimate of rounding errors
_DIGITS = 22  # digits of the reference, which resolve errors down to the last bit of a double


@dataclass(frozen=True)
class Case:
    """One random scene: stated and true errors of the first three frequencies, or the reason of a refusal."""

    number: int
    stated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    refusal: str = ""


def measure(number: int, seed: int) -> list[Case]:
    """Compute stated and true errors of the scene with a number."""
    scene, speed = random_scene(np.random.default_rng([seed, number]))
    try:
        modes = bd.natural_modes(scene, speed)
    except (ValueError, ArithmeticError) as error:
        return [Case(number, refusal=str(error))]
    true = relative_errors(modes, exact(scene, speed, digits=_DIGITS))
    return [Case(number, tuple(modes.error.tolist()), tuple(true))]


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and the over-estimate."""
    answered = [case for case in cases if not case.refusal]
    stated, true = (np.array([getattr(case, name) for case in answered]) for name in ("stated", "true"))
    covered = stated >= true
    yield "random scenes, first three frequencies", str(len(cases)), "10000"
    yield "refused", str(len(cases) - len(answered)), "0"
    yield "stated error covers the true one", f"{covered.mean():.2%}", f"{_COVERED:.1%}"
    yield "median over-estimate", f"{np.median(stated / true):.1f}", f"{_OVER_ESTIMATE:g}"
    for mode, over in enumerate(np.median(stated / true, axis=0), 1):
        yield f"... of mode {mode}", f"{over:.1f}", ""
    yield "largest ratio of true to stated error", f"{(true / stated).max():.2g}", "1"
    yield "largest true error", f"{true.max():.1e}", ""
    for case in (case for case, hit in zip(answered, covered, strict=True) if not hit.all()):
        yield f"not covered: scene {case.number}", f"{max(case.true):.1e} > {max(case.stated):.1e}", ""


def cases(seed: int = SEED) -> Cases[Case]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Case)


def measure_sample() -> Iterator[Row]:
    """Measure the first 200 scenes."""
    yield from summarize(cases().measure_all(range(200)))


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(__doc__, "stated errors of frequencies", cases, summarize, 10_000, SEED)
