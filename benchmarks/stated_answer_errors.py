"""Test whether the stated errors of answers at any tolerance cover the true errors.

Run: python -m benchmarks.stated_answer_errors [--scenes N] [--save FILE]

The answers are loads in equilibrium, responses and their peaks, random responses, poles, equilibria,
amplitude-frequency coefficients, setting-angle limits and resonance speeds of random scenes, at tolerances
from 0.1 to 1e-8.  They are compared with the same answers without a tolerance.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.cases.random_physics import random_physics_scene
from benchmarks.cases.random_scenes import random_scene
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row

SEED = 7
_NEGLIGIBLE = 1e-10  # fraction of the largest value, below which values are within the error of the reference
Found = tuple[np.ndarray, np.ndarray]  # values and stated errors
Answer = Callable[[bd.Scene, float, "float | None"], Found]


@dataclass(frozen=True)
class Case:
    """Stated and true errors of one answer, relative to its largest value, or the reason of a refusal."""

    number: int
    answer: str
    tolerance: float
    stated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    refusal: str = ""


def _static_loads(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = bd.static_loads(scene, [speed], tolerance=tolerance)
    return found.moment.ravel(), found.moment_error.ravel()


def _forces(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = bd.static_loads(scene, [speed], tolerance=tolerance)
    return found.force.ravel(), found.force_error.ravel()


def _response(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = _frequency_response(scene, speed, tolerance)
    return np.abs(found.response).ravel(), found.error.ravel()


def _peaks(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = _frequency_response(scene, speed, tolerance).peaks
    return found.size[:2], found.size_error[:2]


def _frequency_response(scene: bd.Scene, speed: float, tolerance: float | None) -> bd.FrequencyResponse:
    first = bd.natural_modes(scene, speed, 3, tolerance=1e-4).eigenvalue[:2].imag / (2 * np.pi)
    frequencies = np.linspace(0.1, 1.3, 13) * first[1]
    return bd.frequency_response(_damped(scene), speed, frequencies, tolerance=tolerance or 1e-9)


def _random_response(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    first = bd.natural_modes(scene, speed, 1, tolerance=1e-4).frequency[0]
    psd = bd.PowerSpectrum([0.2 * first, 20 * first], [1.0, 1.0])
    found = bd.random_response(_damped(scene), speed, psd, "bending", tolerance=tolerance or 1e-9)
    return np.array([found.rms]), np.array([found.rms_error])


def _damped(scene: bd.Scene) -> bd.Scene:
    return replace(scene, damping_ratio=0.01, damping=bd.Damping())


def _poles(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = bd.matrices(scene, speed, None, tolerance=tolerance)
    size = np.abs(found.poles)[:4]
    return size, found.error[:4] * size


def _equilibrium(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = bd.equilibrium(scene, speed, tolerance=tolerance)
    return found.tip, np.full(3, found.error)


def _backbone(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = bd.backbone(scene, speed, tolerance=tolerance)
    return np.array([found.coefficient]), np.array([found.error])


def _limits(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    found = bd.setting_angle_limits(scene, speed or 1.0, tolerance=tolerance)
    return np.array([*found]), np.full(2, found.error)


def _resonance(scene: bd.Scene, speed: float, tolerance: float | None) -> Found:
    turning = replace(scene, motion=bd.SteadyRotation(1.0), gravity=9.81)
    top = 2 * np.pi * bd.natural_modes(scene, 0.0, 1, tolerance=1e-4).frequency[0]
    found = bd.resonance_speeds(turning, 3 * top, 2, tolerance=tolerance)
    speeds, errors = np.array([c.speed for c in found]), np.array([c.error for c in found])
    return speeds, errors * speeds


IN_SPACE: dict[str, Answer] = {
    "moments in equilibrium": _static_loads,
    "forces in equilibrium": _forces,
    "frequency response": _response,
    "its two lowest peaks": _peaks,
    "random response": _random_response,
    "poles": _poles,
}
IN_A_PLANE: dict[str, Answer] = {
    "equilibrium": _equilibrium,
    "backbone": _backbone,
    "resonance speeds": _resonance,
    "setting-angle limits": _limits,
}


def measure(number: int, seed: int) -> list[Case]:
    """Compute stated and true errors of all answers of the scenes with a number."""
    rng = np.random.default_rng([seed, number])
    tolerance = 10 ** rng.uniform(-8, -1)
    plain, speed = random_scene(rng)
    angle = np.pi / 2 * round(plain.mount.bending_angle / (np.pi / 2))
    in_a_plane = replace(plain, mount=replace(plain.mount, bending_angle=angle))
    made = [(random_physics_scene(rng), IN_SPACE), ((in_a_plane, speed), IN_A_PLANE)]
    return [
        _measure(number, name, answer, *scene, tolerance)
        for scene, answers in made
        for name, answer in answers.items()
    ]


def _measure(number: int, name: str, answer: Answer, scene: bd.Scene, speed: float, tolerance: float) -> Case:
    with warnings.catch_warnings(action="ignore"):
        try:
            (value, stated), (true, _) = (answer(scene, speed, each) for each in (tolerance, None))
        except (ValueError, ArithmeticError) as error:
            return Case(number, name, tolerance, refusal=str(error)[:80])
    if value.shape != true.shape:
        return Case(number, name, tolerance, refusal=f"{len(value)} answers in place of {len(true)}")
    known = np.isfinite(value) & np.isfinite(true) & ~np.isnan(stated)
    largest = np.abs(true[known]).max(initial=0.0) or 1.0
    errors = (stated[known] / largest, np.abs(value - true)[known] / largest)
    return Case(number, name, tolerance, *(tuple(each.tolist()) for each in errors))


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and ratios of stated to true errors."""
    for name in (*IN_SPACE, *IN_A_PLANE):
        own = [case for case in cases if case.answer == name]
        answered = [case for case in own if not case.refusal and case.stated]
        if not answered:
            continue
        stated, true = (np.concatenate([getattr(c, key) for c in answered]) for key in ("stated", "true"))
        covered = true <= stated + _NEGLIGIBLE
        worst = [max(zip(case.stated, case.true, strict=True), key=lambda each: each[1]) for case in answered]
        over = [a / b for a, b in worst if b > _NEGLIGIBLE and np.isfinite(a)]
        yield f"{name}: scenes, refused", f"{len(own)}, {len(own) - len(answered)}", "300"
        yield "... stated errors that cover the true ones", f"{covered.mean():.2%} of {len(stated)}", "99.5 %"
        yield "... over-estimate, median of the largest", f"{np.median(over) if over else np.nan:.2g}", "10"
        met = np.mean([max(case.stated) <= case.tolerance for case in answered])
        yield "... tolerance met by the stated error", f"{met:.0%}", ""
    for case in cases:
        short = [(b, a) for a, b in zip(case.stated, case.true, strict=True) if b > a + _NEGLIGIBLE]
        if short:
            worst_of = max(short)
            said = f"not covered: {case.answer}, scene {case.number}, tolerance {case.tolerance:.1e}"
            yield said, f"{worst_of[0]:.1e} > {worst_of[1]:.1e}", f"{len(short)} of {len(case.stated)}"
    for why in sorted({(case.answer, case.refusal) for case in cases if case.refusal}):
        yield f"refused: {why[0]}", why[1], ""


def cases(seed: int = SEED) -> Cases[Case]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Case)


def measure_sample() -> Iterator[Row]:
    """Measure the first 40 scenes."""
    yield from summarize(cases().measure_all(range(40)))


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(__doc__, "stated errors of answers at any tolerance", cases, summarize, 300, SEED)
