"""Test whether the stated errors of loads along the span cover the true errors, in random transients.

Run: python -m benchmarks.stated_load_errors [--scenes N] [--physics | --cycles] [--save FILE].  The random
scenes in motion are those of `benchmarks.stated_transient_errors`; with --physics they have two planes,
twist, shear, rotary inertia and springs in all combinations.  With --cycles, damage-equivalent ranges of the
root's moment are compared with ranges counted from 200 001 samples of the same run.  Otherwise the reference
has twice as many modes at three speeds, at least 24 shapes, in a large basis, and finer time steps, so that
the errors by modes and by time integration are tested together.  Modes contribute to shear forces as k^-2
after a sudden load: there the error of the reference is not negligible.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.loads.cycles import TURNING_POINTS
from beamdyn.loads.load_path import LoadPath
from beamdyn.modes.modal.model import ModalBasis, find_speed_range
from beamdyn.transient.simulate import Transient
from benchmarks.resumable import Cases, add_options
from benchmarks.rows import Row, show
from benchmarks.stated_transient_errors import random_physics_run, random_run

_BOUND, _MOST_OVER = 0.99, 10.0
_FUNCTIONS = 120  # number of trial functions of the reference
_TIMES = 1000  # number of times at which loads are compared
_MORE, _MANY = 2, 8  # ratio of the reference's modes to the run's at each speed, and least number of modes
_ROUNDING = 1e-8  # rounding error of the reference, relative to the largest load along the span
_FINER, _FINEST = 1e-2, 1e-9  # tolerance of the reference over that of the run, and smallest tolerance
# Number of samples of the run from which cycles are counted, and number evaluated at once.
_SAMPLES, _PARTS = 200_001, 400
_EXPONENTS = 3.0, 10.0
_QUANTITIES = "force", "moment", "strain"
_STATIONS = np.linspace(0, 0.9, 7)  # positions x/L; at the tip only the loads of a tip body are not 0
SEED = 18


@dataclass(frozen=True)
class Case:
    """One random run: stated and true errors of each load component, or the reason of a refusal.

    Errors are relative to the component's largest value along the span, at the station with the largest ratio
    of true to stated error; the over-estimate is that of the largest errors along the span.
    """

    number: int
    stated: dict[str, float]
    true: dict[str, float]
    over: dict[str, float]
    refusal: str = ""


def of_few_modes(rng: np.random.Generator, draw: Callable[[np.random.Generator], dict]) -> dict:
    """Draw arguments of `simulate`, with one to six modes."""
    return draw(rng) | {"modes": int(rng.integers(1, 7))}


def measure(number: int, seed: int, draw: Callable[[np.random.Generator], dict] = random_run) -> list[Case]:
    """Compute stated and true errors of the run with a number."""
    given = of_few_modes(np.random.default_rng([seed, number]), draw)
    try:
        run = bd.simulate(**given)
        loads = bd.transient_loads(run, at=_STATIONS * run.scene.beam.length, t=_times(run))
        exact = _values(_reference(run), loads)
    except (ValueError, ArithmeticError) as error:
        return [Case(number, {}, {}, {}, str(error))]
    found = dict(_errors(loads, exact))
    stated, true, over = ({name: each[which] for name, each in found.items()} for which in range(3))
    return [Case(number, stated, true, over)]


def measure_cycles(number: int, seed: int) -> list[Case]:
    """Compute stated and true errors of equivalent ranges of the root's moment, for the run with a number."""
    from rainflow import extract_cycles

    given = of_few_modes(np.random.default_rng([seed, number]), random_run)
    try:
        loads = bd.transient_loads(bd.simulate(**given), at=[0.0])
    except (ValueError, ArithmeticError) as error:
        return [Case(number, {}, {}, {}, str(error))]
    cycles, times = bd.count_cycles(loads, "moment"), np.linspace(0, given["t_end"], _SAMPLES)
    values = np.concatenate([loads.at("moment", some)[:, 0, 0] for some in np.array_split(times, _PARTS)])
    counted = np.array([cycle[:3] for cycle in extract_cycles(values)]).reshape(-1, 3).T
    exact = replace(cycles, ranges=counted[0], means=counted[1], counts=counted[2])
    of_time = loads.run.time_error / (loads.run.largest or 1.0) * float(np.abs(values).max())
    of_each = 2 * (of_time + TURNING_POINTS * float(cycles.ranges.max(initial=0.0)))
    stated, true, over = {}, {}, {}
    for found in replace(cycles, error=of_each).equivalents(_EXPONENTS, 1.0):
        size = exact.equivalent_range(found.exponent) or 1.0
        name = f"equivalent-ranges, exponent {found.exponent:g}"
        stated[name] = found.error / size
        true[name] = abs(found.range - exact.equivalent_range(found.exponent)) / size
        over[name] = stated[name] / max(true[name], 1e-300)
    return [Case(number, stated, true, over)]


def _times(run: Transient) -> np.ndarray:
    return np.linspace(run.path.start, run.path.end, _TIMES)


def _reference(run: Transient) -> Transient:
    """Repeat a run with many more modes and a very small time-integration error."""
    ends = find_speed_range(run.request.motion, run.path.end)
    speeds = tuple(np.unique([*ends, np.mean(ends)]).tolist())
    modes = max(_MANY, _MORE * (run.request.basis.modes or 0))
    basis, large = ModalBasis(modes, speeds), bd.Ritz(_FUNCTIONS)
    tolerance = max(_FINEST, run.request.tolerance * _FINER)
    return replace(run.request, discretization=large, basis=basis, tolerance=tolerance, t_eval=None).run()


def _values(reference: Transient, like: bd.TransientLoads) -> dict[str, np.ndarray]:
    """Return the reference's loads at the same stations and times, without error estimates."""
    outputs = like.path.outputs
    return outputs.split(LoadPath(reference, like.path.stations, outputs).at(like.t))


def _errors(
    loads: bd.TransientLoads, exact: dict[str, np.ndarray]
) -> Iterator[tuple[str, tuple[float, ...]]]:
    """Yield stated and true error, and the over-estimate, of each component that is not zero."""
    for quantity in _QUANTITIES:
        difference = np.abs(loads.values(quantity) - exact[quantity]).max(axis=0)
        stated, largest = loads.error_of(quantity), np.abs(exact[quantity]).max(axis=(0, 1))
        for k in np.flatnonzero(largest > 0):
            worst = (difference[:, k] / np.maximum(stated[:, k], 1e-300)).argmax()
            over = stated[:, k].max() / max(difference[:, k].max(), 1e-300)
            pair = stated[worst, k] / largest[k], difference[worst, k] / largest[k]
            yield f"{quantity} {k}", (float(pair[0]), float(pair[1]), float(over))


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, the over-estimate, and refusals."""
    answered = [case for case in cases if not case.refusal]
    yield "random transients", str(len(cases)), "500"
    yield "refused", str(len(cases) - len(answered)), ""
    names = dict.fromkeys(name.split()[0] for case in answered for name in case.true)
    for quantity in names:
        pairs = [
            (case, name, case.stated[name], case.true[name], case.over[name])
            for case in answered
            for name in case.true
            if name.startswith(quantity)
        ]
        stated, true, over = (np.array([pair[which] for pair in pairs]) for which in (2, 3, 4))
        covered = stated + _ROUNDING >= true
        known = (true > _ROUNDING) & np.isfinite(stated)
        yield f"errors of {quantity} covered", f"{covered.mean():.1%} of {len(pairs)}", f"{_BOUND:.0%}"
        yield "... not known (infinite)", f"{np.isinf(stated).mean():.1%}", ""
        yield "... median over-estimate", f"{np.median(over[known]):.1f}", f"{_MOST_OVER:g}"
        yield "... largest true error, over the largest along the span", f"{true.max():.1e}", ""
        for (case, name, high, low, _), hit in zip(pairs, covered, strict=True):
            if not hit:
                yield f"... not covered: run {case.number}, {name}", f"{low:.1e} > {high:.1e}", ""
    for case in cases:
        if case.refusal:
            yield f"refused: run {case.number}", case.refusal, ""


def measure_sample() -> Iterator[Row]:
    """Measure the first 12 runs."""
    yield from summarize(Cases(partial(measure, seed=SEED), Case).measure_all(range(12)))


PARTS = (measure_sample,)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, scenes=500, seed=SEED)
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--physics", action="store_true", help="with all physics in all combinations")
    kind.add_argument("--cycles", action="store_true", help="of damage-equivalent ranges")
    given = parser.parse_args()
    draw = random_physics_run if given.physics else random_run
    of_loads = partial(measure, seed=given.seed, draw=draw)
    measure_one = partial(measure_cycles, seed=given.seed) if given.cycles else of_loads
    runs = Cases(measure_one, Case).run(given)
    show("stated errors of loads along the span", lambda: summarize(runs))


if __name__ == "__main__":
    main()
