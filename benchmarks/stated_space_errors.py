"""Test whether the stated errors of frequencies of beams in space cover the true errors.

Run: python -m benchmarks.stated_space_errors [--scenes N] [--seed N] [--save FILE].  Random beams with twist,
sweep, prebend, shear, stretch and offsets are solved about their equilibria under rotation, at three
tolerances.  The reference solves the same equations with many trial functions; its uncertainty is the
difference from a solution with fewer.  So the stated error of the discretization is tested, not the
equations.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.cases.random_space import random_space_scene
from benchmarks.cases.reference.resolved import Known
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row
from benchmarks.stated_physics_errors import TOLERANCES, Answer, answer, summarize

SEED, _MODES, _SCENES, _COVERED = 33, 4, 300, 0.995
_REFERENCE = 24, 20  # numbers of trial functions of the reference and of a coarser reference


def measure(number: int, seed: int) -> list[Answer]:
    """Compute the answers for the scene with a number."""
    with warnings.catch_warnings(action="ignore"):
        scene, speed = random_space_scene(np.random.default_rng([seed, number]))
        try:
            known = _known(scene, speed)
        except ArithmeticError as error:
            return [Answer(number, None, 0.0, refusal=f"reference: {error}")]
        return [answer(number, scene, speed, "ritz", tolerance, known) for tolerance in TOLERANCES]


def _known(scene: bd.Scene, speed: float) -> Known:
    """Compute reference eigenvalues, with their change by fewer functions, and rounding errors."""
    fine, coarse = (bd.natural_modes(scene, speed, _MODES, bd.Ritz(n)).eigenvalue for n in _REFERENCE)
    uncertainty = np.abs(fine / coarse - 1) + 1e-13
    return Known(fine, uncertainty, 0.0)


def cases(seed: int = SEED) -> Cases[Answer]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Answer)


def measure_sample() -> Iterator[Row]:
    """Measure the first 12 scenes."""
    yield from summarize(cases().measure_all(range(12)), _SCENES, _COVERED)


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(
        __doc__,
        "stated errors of frequencies of beams in space",
        cases,
        lambda found: summarize(found, _SCENES, _COVERED),
        _SCENES,
        SEED,
    )
