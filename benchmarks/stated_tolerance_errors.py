"""Test whether the stated errors at any tolerance cover the true errors, and no mode is missing.

Run: python -m benchmarks.stated_tolerance_errors [--scenes N] [--critical] [--save FILE].  Random beams with
a body at the tip, at speeds to 0.999 of the critical one and gamma to 3000, at tolerances from 0.1 to 1e-8,
alternately by assumed modes and by elements, against assumed modes on segments that shrink towards both ends,
which are doubled until they hold to a tenth of the stated error.
"""

from __future__ import annotations

import argparse
import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.cases.random_tip_bodies import (
    random_tip_scene,
    reference_critical_speed,
    reference_frequencies,
)
from benchmarks.resumable import Cases, add_options
from benchmarks.rows import Row, show

SEED = 7
_LOST = 0.02  # relative error above which a mode is a different one: the true mode is missing


@dataclass(frozen=True)
class Case:
    """Stated and true errors of one answer, relative to frequency or speed, or the reason of a refusal."""

    number: int
    discretization: str
    tolerance: float
    stated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    known: tuple[float, ...] = ()
    refusal: str = ""


def measure(number: int, seed: int, critical: bool) -> list[Case]:
    """Compute stated and true errors of the scene with a number."""
    rng = np.random.default_rng([seed, number])
    discretization = "fem" if number % 2 else "ritz"
    tolerance = 10 ** rng.uniform(-8, -1)
    with warnings.catch_warnings(action="ignore"):  # warnings about tolerances that elements do not meet
        scene, speed = random_tip_scene(rng)
        try:
            if critical:
                errors = _of_critical_speed(scene, discretization, tolerance)
            else:
                errors = _of_modes(scene, speed, int(rng.integers(1, 7)), discretization, tolerance)
        except (ValueError, ArithmeticError) as error:
            return [Case(number, discretization, tolerance, refusal=str(error))]
    return [Case(number, discretization, tolerance, *(tuple(np.ravel(each).tolist()) for each in errors))]


def _of_modes(
    scene: bd.Scene, speed: float, count: int, discretization: str, tolerance: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    modes = bd.natural_modes(scene, speed, count, discretization, tolerance)
    squared = np.real(-(modes.eigenvalue**2))
    accuracy = np.minimum(modes.error, 1.0) / 10
    true, known = reference_frequencies(scene, speed, count, accuracy)
    with np.errstate(divide="ignore", invalid="ignore"):
        return modes.error, np.abs(np.sqrt(np.abs(squared / true)) - 1), known / 2


def _of_critical_speed(scene: bd.Scene, discretization: str, tolerance: float) -> tuple[float, float, float]:
    point = bd.critical_point(scene, discretization, tolerance)
    true, known = reference_critical_speed(scene, min(point.error, 1.0) / 10)
    if point.speed == true or np.isinf(point.error):
        return point.error, 0.0, known
    return point.error, abs(point.speed / true - 1) if np.isfinite(true) else np.inf, known


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and ratios of stated to true errors."""
    refused = [case for case in cases if case.refusal]
    yield "random scenes; refused", f"{len(cases)}; {len(refused)}", ""
    for name in ("ritz", "fem"):
        answered = [case for case in cases if case.discretization == name and not case.refusal]
        stated, true, known = (
            np.concatenate([getattr(case, each) for case in answered]) for each in ("stated", "true", "known")
        )
        short = (true - known) / np.maximum(stated, np.finfo(float).tiny)
        yield f"{name}: answers", str(len(stated)), "10000"
        yield "... stated error covers the true one", f"{np.mean(short <= 1):.3%}", "99.95 %"
        yield "... true over stated error: largest", f"{short.max():.3g}", "1.5"
        yield "... lost", str(np.sum((short > 1) & (true > _LOST))), "0"
        yield "... unresolved", f"{np.isinf(stated).mean():.2%}", ""
        tolerance = np.concatenate([np.full(len(case.stated), case.tolerance) for case in answered])
        met = np.isfinite(stated) & (stated <= tolerance)
        yield (
            "... tolerance met; true error over it, median",
            (f"{met.mean():.1%}; {np.median((true / tolerance)[met]):.1g}"),
            "",
        )
    for case in cases:
        for mode, (a, b, c) in enumerate(zip(case.stated, case.true, case.known, strict=True), 1):
            if b - c > a:
                what = (
                    f"not covered: scene {case.number}, {mode}, {case.discretization}, {case.tolerance:.1e}"
                )
                yield what, f"{b:.1e} > {a:.1e}", f"{(b - c) / a:.2f}"
    yield from ((f"refused: scene {case.number}", case.refusal, "") for case in refused)


def measure_sample() -> Iterator[Row]:
    """Measure the first 400 scenes."""
    yield from summarize(Cases(partial(measure, seed=SEED, critical=False), Case).measure_all(range(400)))


PARTS = (measure_sample,)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, scenes=6000, seed=SEED)
    parser.add_argument("--critical", action="store_true", help="critical speeds in place of modes")
    given = parser.parse_args()
    found = Cases(partial(measure, seed=given.seed, critical=given.critical), Case).run(given)
    show(
        f"stated errors at any tolerance of {'critical speeds' if given.critical else 'modes'}",
        lambda: summarize(found),
    )


if __name__ == "__main__":
    main()
