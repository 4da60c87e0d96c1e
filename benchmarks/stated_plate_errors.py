"""Test whether the stated errors of strips as plates cover the true errors.

Run: python -m benchmarks.stated_plate_errors [--scenes N] [--save FILE].  The random cantilevers of
`benchmarks.solids` are solved as plates at tolerances from 0.1 to 1e-3.  The reference has 14 trial functions
on each segment and across the width.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.peers.solids import random_strip
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row

SEED, _MODES = 31, 3
_REFERENCE = bd.Ritz(14)


@dataclass(frozen=True)
class Case:
    """Stated and true errors of the modes of one strip, relative to their frequencies."""

    number: int
    tolerance: float
    stated: tuple[float, ...]
    true: tuple[float, ...]


def measure(number: int, seed: int) -> list[Case]:
    """Compute stated and true errors of the strip with a number."""
    rng = np.random.default_rng([seed, number])
    strip = random_strip(rng)
    scene = replace(strip.scene(), physics=bd.Physics(camber=True, torsion=True))
    tolerance = 10 ** rng.uniform(-3, -1)
    with warnings.catch_warnings(action="ignore"):  # warnings about speeds at which deflections are large
        modes = bd.natural_modes(scene, strip.speed, _MODES, tolerance=tolerance)
        true = bd.natural_modes(scene, strip.speed, _MODES, discretization=_REFERENCE).frequency
    errors = np.abs(modes.frequency / true - 1)
    return [Case(number, tolerance, tuple(modes.error.tolist()), tuple(errors.tolist()))]


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and ratios of stated to true errors."""
    stated, true = (np.concatenate([getattr(case, name) for case in cases]) for name in ("stated", "true"))
    tolerance = np.repeat([case.tolerance for case in cases], _MODES)
    yield "random strips; modes", f"{len(cases)}; {len(stated)}", "300"
    yield "stated error covers the true one", f"{np.mean(true <= stated):.2%}", "99.9 %"
    yield (
        "true over stated error: median, largest",
        f"{np.median(true / stated):.2g}, {(true / stated).max():.2g}",
        "",
    )
    yield "tolerance met", f"{np.mean(stated <= tolerance):.1%}", ""


def cases(seed: int = SEED) -> Cases[Case]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Case)


if __name__ == "__main__":
    measure_random(__doc__, "stated errors of plates", cases, summarize, 300, SEED)
