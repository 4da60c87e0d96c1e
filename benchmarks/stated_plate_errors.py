"""Whether the errors stated of strips as plates cover the true ones.

Run: python -m benchmarks.stated_plate_errors [--scenes N] [--save FILE].  The random cantilevers that solids
are computed of, as plates at tolerances from 0.1 to 1e-3, against 14 functions on each segment and across.
"""

from __future__ import annotations

import argparse
import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: the workers share the processors

import numpy as np

import beamdyn as bd
from benchmarks.peers.solids import random_strip
from benchmarks.resumable import Cases, add_options
from benchmarks.rows import Row, show

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
    """Stated and true errors of the strip with this number."""
    rng = np.random.default_rng([seed, number])
    strip = random_strip(rng)
    scene = replace(strip.scene(), physics=bd.Physics(camber=True, torsion=True))
    tolerance = 10 ** rng.uniform(-3, -1)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of speeds at which a strip bends far
        modes = bd.natural_modes(scene, strip.speed, _MODES, tolerance=tolerance)
        true = bd.natural_modes(scene, strip.speed, _MODES, discretization=_REFERENCE).frequency
    errors = np.abs(modes.frequency / true - 1)
    return [Case(number, tolerance, tuple(modes.error.tolist()), tuple(errors.tolist()))]


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """How many of the true errors the stated ones cover, and how large they are beside these."""
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


def main() -> None:
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    add_options(parser, scenes=300, seed=SEED)
    given = parser.parse_args()
    cases = Cases(partial(measure, seed=given.seed), Case).run(given)
    show("stated errors of plates", lambda: summarize(cases))


if __name__ == "__main__":
    main()
