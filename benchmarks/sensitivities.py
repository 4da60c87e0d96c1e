"""Derivatives of frequencies by the numbers of a scene, compared with differences in 40 digits.

Run: python -m benchmarks.sensitivities [--scenes N] [--first N] [--workers N] [--save FILE]

Half of the scenes are slender beams in one plane, up to 0.999 of the critical speed and a tension of 1e5
EI/L^2.  The other half have every kind of input: two planes, twist, shear, rotary inertia, stretch, precone,
springs at the root and along the beam, point masses, tip bodies, and all kinds of damping, some of them 0.
The reference is differences of eigenvalues in 40 digits (`cases.reference.many_digits`).  Printed are the
largest error of relative derivatives (relative to the derivative where this exceeds 1, as near the critical
speed), the number of errors above the stated ones, and the kinds of numbers by which frequencies were
differentiated.
"""

from __future__ import annotations

import os
import re
from collections import Counter
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from time import process_time

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.common.results.statements import unannounced
from beamdyn.studies.sensitivities.sensitivity_result import SceneNumber
from benchmarks.cases.random_inputs import random_inputs_scene
from benchmarks.cases.random_scenes import random_scene
from benchmarks.cases.reference.many_digits.differences import Number, frequency_derivatives
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row

MODES = 3
_SAME = 1e-6  # largest relative distance of two frequencies of the same mode


@dataclass(frozen=True)
class Case:
    """Derivatives of one scene.

    Parameters
    ----------
    number : int
        Seed of the scene.
    names : tuple of str
        Name of the number by which each derivative is taken.
    errors, stated : tuple of float
        True errors of the relative changes, and stated errors plus those of the reference.
    seconds : float
        Processor time of the reference [s].
    refusal : str
        Reason why there is no answer, or no reference.
    """

    number: int
    names: tuple[str, ...] = ()
    errors: tuple[float, ...] = ()
    stated: tuple[float, ...] = ()
    seconds: float = 0.0
    refusal: str = ""


def measure(seed: int) -> list[Case]:
    """Compare the derivatives of the scene of a seed with the reference."""
    try:
        return [_measured(seed)]
    except (ValueError, ArithmeticError) as error:
        return [Case(seed, refusal=str(error))]


def _measured(seed: int) -> Case:
    rng = np.random.default_rng(seed)
    with unannounced():
        scene, speed = random_inputs_scene(rng) if seed % 2 else random_scene(rng)
        found = bd.frequency_sensitivities(scene, speed, MODES)
    known = np.isfinite(found.derivative)
    chosen = np.flatnonzero(known.any(axis=1))
    numbers = [at_its_size(found.inputs[k]) for k in chosen]
    start = process_time()
    values, truths, doubts = frequency_derivatives(found.scene, speed, MODES, numbers)
    seconds = process_time() - start
    # The reference leaves out modes that do not vibrate, such as free rotation about a hinge at the axis.
    apart = np.abs(found.value[:, None] - values) / values
    partner, same = apart.argmin(axis=1), np.nanmin(apart, axis=1, initial=np.inf) < _SAME
    known, truths, doubts = known & same, np.array(truths)[:, partner], np.array(doubts)[:, partner]
    names, errors, stated = [], [], []
    for k, number, truth, doubt in zip(chosen, numbers, truths, doubts, strict=True):
        there = known[k]
        size = number.size / found.value[there]
        size /= np.maximum(np.abs(truth[there]) * size, 1)
        errors.extend((np.abs(found.derivative[k] - truth)[there] * size).tolist())
        stated.extend(((found.error[k] + doubt)[there] * size).tolist())
        names.extend([number.name] * int(there.sum()))
    return Case(seed, (*names,), (*errors,), (*stated,), seconds)


def at_its_size(given: SceneNumber) -> Number:
    """Return the number for the reference, with a typical magnitude of its kind if it is near 0."""
    return Number(given.name, given.value, max(abs(given.value), 100 * given.step))


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the largest error, and the number of errors that exceed the stated ones."""
    answered = [case for case in cases if not case.refusal]
    pairs = [
        (case, *each) for case in answered for each in zip(case.names, case.errors, case.stated, strict=True)
    ]
    error, stated = (np.array([pair[k] for pair in pairs]) for k in (2, 3))
    yield f"derivatives of {MODES} modes of {len(answered)} random scenes", f"{error.size}", ""
    yield "scenes without an answer or a reference", f"{len(cases) - len(answered)}", ""
    yield "... largest error of a relative change", f"{error.max():.0e}", "1e-08"
    yield "... errors above the stated ones", f"{(error > stated).sum()}", "0"
    yield "... largest error over the stated one", f"{(error / stated).max():.2g}", "1"
    for kind, share in (("slender beams", 0), ("every kind of input", 1)):
        seconds = [case.seconds for case in answered if case.number % 2 == share]
        yield f"... reference, {kind}: processor time of a scene [s]", f"{np.mean(seconds or [0]):.1f}", ""
    kinds = Counter(re.sub(r"\[\d+\]", "", pair[1]) for pair in pairs)
    yield "kinds of numbers", f"{len(kinds)}", ""
    for kind, count in sorted(kinds.items()):
        most = max(pair[2] for pair in pairs if re.sub(r"\[\d+\]", "", pair[1]) == kind)
        yield f"... {kind}: derivatives, largest error", f"{count}, {most:.0e}", "1e-08"
    for case, name, each, bound in pairs:
        if each > min(bound, 1e-8):
            yield f"... seed {case.number}, {name}", f"{each:.1e}, stated {bound:.1e}", ""
    for case in cases:
        if case.refusal:
            yield f"... seed {case.number}", case.refusal, ""


def measure_sample() -> Iterator[Row]:
    """Measure the first six scenes."""
    yield from summarize(Cases(measure, Case).measure_all(range(6)))


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(__doc__, "Sensitivities", lambda _: Cases(measure, Case), summarize, 200, 0)
