"""Numbers of scenes identified from frequencies: exact without noise, within their intervals with noise.

Run: python -m benchmarks.identification [--exact N] [--noisy N] [--first N] [--workers N] [--save FOLDER]

Each scene has an unknown thickness, tip body, and spring of 0.3 to 30 EI/L at the root.  The data are the
frequencies of three modes at five speeds.  Seed k determines scene k.  Noise is normally distributed with a
known standard deviation of 0.5 %.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

from benchmarks.cases.identified import identify, unknowns
from benchmarks.resumable import Cases
from benchmarks.rows import Row, show

NOISE = 0.005
_FOUND = 1e-7  # largest relative error without noise
_MOST = 40  # largest number of solutions of the equations for each number


@dataclass(frozen=True)
class Answer:
    """Largest relative error of a scene's numbers, is each in its interval, and number of solutions."""

    number: int
    error: float
    inside: tuple[bool, ...]
    solves: int


def outcome(seed: int, noise: float) -> list[Answer]:
    """Identify the numbers of the scene of a seed, and return the outcome."""
    true = unknowns(seed)
    found, values = identify(true, noise, seed), np.array([*true.values()])
    error = np.abs(found.value / values - 1)
    inside = (found.low <= values) & (values <= found.high)
    largest = float(np.where(np.isnan(error), np.inf, error).max())
    return [Answer(seed, largest, tuple(inside.tolist()), found.solves)]


def _rows(seeds: range, noise: float, workers: int, folder: Path | None) -> Iterator[Row]:
    cases = Cases(partial(outcome, noise=noise), Answer)
    if folder:
        answers = cases.resume(folder / f"identification_{noise:g}.jsonl", seeds, workers)
    else:
        answers = cases.measure_all(seeds, workers)
    what = f"{len(seeds)} scenes, noise {100 * noise:g} %"
    if noise:
        each = np.array([answer.inside for answer in answers])
        shares = ", ".join(f"{100 * share:.1f}" for share in each.mean(axis=0))
        yield f"{what}: 95 % intervals cover", f"{100 * each.mean():.2f} % ({shares})", "93 to 97 %"
    else:
        errors = np.array([answer.error for answer in answers])
        found = f"{errors.max():.1e} ({(errors > _FOUND).sum()} missed)"
        yield f"{what}: largest relative error", found, f"{_FOUND:g}"
    most = max(answer.solves for answer in answers) / 3
    yield f"{what}: most solves a number", f"{most:.1f}", f"{_MOST}"


def main(arguments: Sequence[str] | None = None) -> list[Row]:
    """Print how accurately numbers are found."""
    parser = argparse.ArgumentParser(description=(__doc__ or "").partition("\n")[0])
    parser.add_argument("--exact", type=int, default=200, help="scenes without noise")
    parser.add_argument("--noisy", type=int, default=2000, help="scenes with noise")
    parser.add_argument("--first", type=int, default=0, help="first seed")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--save", type=Path, help="folder of answers, to which a run adds what it lacks")
    given = parser.parse_args(arguments)
    counts = (given.exact, 0.0), (given.noisy, NOISE)
    seeds = [(range(given.first, given.first + count), noise) for count, noise in counts if count]
    title = "Numbers of a scene from its frequencies"
    return show(title, *(partial(_rows, *each, given.workers, given.save) for each in seeds))


if __name__ == "__main__":
    main()
