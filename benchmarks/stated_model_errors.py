"""Whether the stated model errors are right: what each left-out effect changes, estimated and solved.

Run: python -m benchmarks.stated_model_errors [--scenes N] [--first N] [--save FILE].  Random scenes; each
effect that a scene leaves out is estimated from the modes without it, then solved with it.  A mode with the
effect is that which overlaps most with the one without, by the mass; where none does by more than
half, the effect has made other modes of it, and there is no change to compare.
"""

from __future__ import annotations

import argparse
import json
import os
import warnings
from collections.abc import Iterable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, replace
from functools import partial
from pathlib import Path
from time import perf_counter
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: the workers share the processors

import numpy as np

import beamdyn as bd
from beamdyn.modal.model import Model
from beamdyn.model_error.effects import LARGE_DEFLECTION, Addition, list_effects
from benchmarks.cases.random_physics import random_mount, random_physics_beam, random_speed
from benchmarks.rows import Row, show, time_text

SEED = 15
_MODES = 3
_FUNCTIONS = 18  # for the reference, over all segments
_ELEMENTS = 40  # of the reference for large deflection
_MORE_MODES = 12  # solved with the effect, among which a mode may be
_LEAST, _MOST = 1e-3, 0.1  # sizes of changes that are judged
_FACTOR, _SHARE = 2.0, 0.95  # of the truth, within which this share is aimed at
_FIFTH = 0.2
_STEEL = 200e9, 7850.0  # Young's modulus [Pa] and density [kg/m3]
_KEPT = 0.2  # share of scenes that model an effect already
_OVERLAP = 0.5  # of the squared mass product, above which a mode is the same


@dataclass(frozen=True)
class Answer:
    """The changes by one effect in one scene.

    `estimated` and `true` are relative changes of each frequency; nan where there is none.
    """

    number: int
    effect: str
    time: float
    estimated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    refusal: str = ""


def measure(number: int, seed: int) -> list[Answer]:
    """Answers for the scene with this number."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of beams that no material has
        scene, speed = random_left_out_scene(np.random.default_rng([seed, number]))
        start = perf_counter()
        try:
            modes = bd.natural_modes(scene, speed, _MODES)
            left_out = modes.left_out
        except (ValueError, ArithmeticError) as error:
            return [Answer(number, "all", perf_counter() - start, refusal=str(error))]
        time = perf_counter() - start
        additions, _, _ = list_effects(scene)
        found = [_answer(number, modes, added, left_out[added.name], time) for added in additions]
        return [*found, *_bent_answer(number, modes, time)]


def _bent_answer(number: int, modes: bd.Modes, time: float) -> Iterator[Answer]:
    """The change by large deflection, where it can be combined with the rest, by finite elements."""
    scene, estimated = modes.scene, modes.left_out[LARGE_DEFLECTION]
    try:
        physics = replace(scene.physics, large_deflection=True)
        bent = bd.natural_modes(replace(scene, physics=physics), modes.speed, _MODES, bd.Fem(_ELEMENTS))
    except (ValueError, ArithmeticError):  # oblique, or more physics; or there is no such equilibrium
        return
    true = bent.frequency / modes.frequency - 1
    yield Answer(number, LARGE_DEFLECTION, time, tuple(estimated.tolist()), tuple(true.tolist()))


def random_left_out_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """A scene and a speed, as of `random_physics_scene`, with all properties and much physics left out.

    Three of five beams are twisted, the others bend obliquely: else a second plane would change nothing.
    """
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # of beams that no material has
        beam = random_physics_beam(rng, stocky=True)
    beam = replace(beam, axial_stiffness=beam.mass_per_length.scaled(_STEEL[0] / _STEEL[1]))
    mount, straight = random_mount(rng, beam), rng.random() < 0.4
    if straight:
        beam = replace(beam, twist=None)
        mount = replace(mount, bending_angle=rng.uniform(-np.pi, np.pi))
    planes, shear, rotary = rng.random(3) < _KEPT
    physics = bd.Physics(2 if planes else 1, shear=bool(shear), rotary_inertia=bool(rotary))
    scene = bd.Scene(beam, mount, physics=physics)
    return scene, random_speed(rng, scene)


def _answer(number: int, modes: bd.Modes, added: Addition, estimated: np.ndarray, time: float) -> Answer:
    try:
        true = solved_change(modes, added.scene)
    except (ValueError, ArithmeticError) as error:
        return Answer(number, added.name, time, refusal=str(error))
    return Answer(number, added.name, time, tuple(estimated.tolist()), tuple(true.tolist()))


def solved_change(modes: bd.Modes, scene: bd.Scene) -> np.ndarray:
    """Relative change of each frequency by solving the scene with an effect; nan where the mode is lost."""
    simple, full = _reference(modes.scene, scene.beam), _reference(scene, scene.beam)
    speeds, m = np.array([modes.speed]), len(modes.frequency)
    before, after = simple.solver.solve(speeds, m), full.solver.solve(speeds, _MORE_MODES)
    embedded = np.zeros((full.equations.size, m), dtype=complex)
    for name, place in simple.equations.blocks.items():
        embedded[full.equations.blocks[name]] = before.vector[0][place]
    product = np.abs(embedded.conj().T @ full.equations.steady().M @ after.vector[0]) ** 2
    norms = np.einsum("nk,nm,mk->k", embedded.conj(), full.equations.steady().M, embedded).real
    same, s, known = product.argmax(axis=1), after.eigenvalue[0], before.eigenvalue[0]
    overlap = product.max(axis=1) / norms
    change = s[same].imag / np.where(known.imag == 0, np.nan, known.imag) - 1
    lost = (overlap < _OVERLAP) | (known.imag <= 0) | (s[same].imag <= 0)
    return np.where(lost, np.nan, change)


def _reference(scene: bd.Scene, beam: bd.Beam) -> Model:
    """A model of given size on segments that suit both scenes."""
    functions = max(8, _FUNCTIONS // (len(beam.breakpoints) - 1))
    return _OverBeam(scene, bd.Ritz(functions), beam)


@dataclass(frozen=True)
class _OverBeam(Model):
    """A model over the function spaces of a beam with all its properties."""

    beam: bd.Beam

    @property
    def equations(self) -> Any:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Equations of motion."""
        from beamdyn.equations.equations_of_motion import assemble_over

        return assemble_over(self.scene, self.discretization.spaces(self.beam))


def measure_all(numbers: Iterable[int], workers: int, seed: int) -> Iterator[Answer]:
    """All answers, on several processes, as they come."""
    with ProcessPoolExecutor(workers) as pool:
        for answers in pool.map(partial(measure, seed=seed), numbers, chunksize=2):
            yield from answers


# Report -------------------------------------------------------------------------------------------


def summarize(answers: Sequence[Answer]) -> Iterator[Row]:
    """For each effect the share of estimates within a factor of two, and the worst."""
    yield "random scenes", str(len({a.number for a in answers})), "1000"
    for effect in sorted({a.effect for a in answers}):
        yield from _summarize_effect(effect, [a for a in answers if a.effect == effect])
    times = np.array([a.time for a in answers])
    found = f"{time_text(np.median(times))}, {time_text(times.max())}"
    yield "median and longest time, modes included", found, ""


def _summarize_effect(effect: str, answers: Sequence[Answer]) -> Iterator[Row]:
    judged = [(a, pair) for a in answers for pair in enumerate(zip(a.estimated, a.true, strict=True), 1)]
    worth = [(a, mode, e, t) for a, (mode, (e, t)) in judged if _LEAST <= abs(t) <= _MOST]
    scenes = len({a.number for a, *_ in worth})
    yield f"{effect}: scenes where it is worth 0.1 to 10 %", str(scenes), "200"
    yield "... refused or not converged", str(sum(bool(a.refusal) for a in answers)), ""
    if not worth:
        return
    estimate, truth = np.array([e for *_, e, _ in worth]), np.array([t for *_, t in worth])
    ratio = estimate / truth
    said = np.isnan(ratio)
    within = (ratio >= 1 / _FACTOR) & (ratio <= _FACTOR)
    yield "... frequencies within a factor of 2", f"{within.mean():.2%} of {len(ratio)}", f"{_SHARE:.0%}"
    yield "... said not to be known", f"{said.sum()}", ""
    low = ~said & (ratio < _FIFTH)
    yield "... below a fifth of the truth, unsaid", str(low.sum()), "0"
    known = np.abs(ratio[~said] - 1)
    yield (
        "... median and 95 % of the deviations",
        f"{np.median(known):.1e}, {np.quantile(known, 0.95):.1e}",
        "",
    )
    for (a, mode, e, t), bad in zip(worth, ~within & ~said, strict=True):
        if bad:
            yield f"... scene {a.number}, mode {mode}", f"estimated {e:+.2e}, true {t:+.2e}", ""
    for a in (a for a in answers if a.refusal):
        yield f"... refused: scene {a.number}", a.refusal, ""


def measure_sample() -> Iterator[Row]:
    """The first 60 scenes."""
    yield from summarize(list(measure_all(range(60), 2, SEED)))


PARTS = (measure_sample,)


# Answers in a file, so that a long run can go on ----------------------------------------------------


def load(path: Path) -> list[Answer]:
    """Answers that a run has saved."""
    lines = path.read_text(encoding="utf-8").splitlines() if path.exists() else []
    return [_answer_of(json.loads(line)) for line in lines]


def _answer_of(row: dict[str, Any]) -> Answer:
    values: dict[str, Any] = {k: tuple(v) if isinstance(v, list) else v for k, v in row.items()}
    return Answer(**values)


def measure_and_save(path: Path, numbers: Iterable[int], **options: Any) -> list[Answer]:
    """Measure what is not in the file yet, and add it there."""
    done = {a.number for a in load(path)}
    with path.open("a", encoding="utf-8") as file:
        for found in measure_all([n for n in numbers if n not in done], **options):
            file.write(json.dumps(asdict(found)) + "\n")
            file.flush()
    return load(path)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=1000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case, to go on in parts")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=SEED)
    parser.add_argument("--save", type=Path, help="file of answers, to which a run adds what it lacks")
    given = parser.parse_args()
    numbers = range(given.first, given.first + given.scenes)
    options: dict[str, Any] = {"workers": given.workers, "seed": given.seed}
    if given.save:
        answers = measure_and_save(given.save, numbers, **options)
    else:
        answers = list(measure_all(numbers, **options))
    show("stated model errors", lambda: summarize(answers))


if __name__ == "__main__":
    main()
