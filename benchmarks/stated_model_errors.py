"""Test whether stated model errors are right: changes by each left-out effect, estimated and solved.

Run: python -m benchmarks.stated_model_errors [--scenes N] [--first N] [--save FILE].  For random scenes, the
change by each left-out effect is estimated from the modes without the effect, then solved with the effect.
Modes with and without the effect are paired by their overlap (mass product); a mode whose largest overlap is
below one half has no partner, and no change to compare.  In every fourth scene rotation bends the beam; large
deflection is solved by collocation that uses no code of the package.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial
from time import perf_counter
from typing import Any

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.equations.effects import LARGE_DEFLECTION
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.added_effects import Addition, list_effects
from benchmarks.cases.random_physics import (
    random_mount,
    random_physics_beam,
    random_speed,
    speed_of_deflection,
)
from benchmarks.cases.reference.elastica import converged, from_rest
from benchmarks.cases.reference.of_elastica import elastica_of_scene
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row, time_text

SEED = 15
_MODES = 3
_FUNCTIONS = 18  # number of trial functions of the reference, on all segments
_KNOWN = 1e-9  # relative error of the reference for large deflection
_MORE_MODES = 12  # number of further modes solved with the effect, among which a mode is searched
_LEAST, _MOST = 1e-3, 0.1  # least and largest changes that are compared
_FACTOR, _SHARE = 2.0, 0.95  # factor of the true change, within which this fraction of estimates should lie
_FIFTH = 0.2
_STEEL = 200e9, 7850.0  # Young's modulus [Pa] and density [kg/m3]
_BENT = 4  # one in this number of scenes has large deflection
_DEFLECTION = 0.02, 0.4  # least and largest linear static deflection of these scenes, over the length
_SLENDEREST = 40.0  # length over thickness of the stockier plane
_STRAIGHT = 0.85  # fraction of scenes without twist that bend obliquely, except those with large deflection
_KEPT = 0.1  # fraction of scenes that already model an effect
_OVERLAP = 0.5  # squared mass product of two mode shapes above which they are the same mode


@dataclass(frozen=True)
class Answer:
    """Changes of frequencies by one effect in one scene.

    `estimated` and `true` are relative changes of each frequency; nan where there is no such mode.
    """

    number: int
    effect: str
    time: float
    estimated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    refusal: str = ""


def measure(number: int, seed: int) -> list[Answer]:
    """Compute the answers for the scene with a number."""
    with warnings.catch_warnings(action="ignore"):  # warnings of beams without a real material
        draw = random_left_out_scene if number % _BENT else random_bent_scene
        scene, speed = draw(np.random.default_rng([seed, number]))
        start = perf_counter()
        try:
            modes = bd.natural_modes(scene, speed, _MODES)
            left_out = modes.left_out
        except (ValueError, ArithmeticError) as error:
            return [Answer(number, "all", perf_counter() - start, refusal=str(error))]
        time = perf_counter() - start
        additions, _, _ = list_effects(scene)
        found = [_answer(number, modes, added, left_out[added.name], time) for added in additions]
        return found if number % _BENT else [*found, _bent_answer(number, modes, time)]


def _bent_answer(number: int, modes: bd.Modes, time: float) -> Answer:
    """Compute the change by large deflection, about the equilibrium on the branch from rest."""
    beam, unit = elastica_of_scene(modes.scene)
    estimated = tuple(modes.left_out[LARGE_DEFLECTION.name].tolist())
    try:
        bent = converged(from_rest(beam, modes.speed * unit), _MODES, _KNOWN)
    except ArithmeticError as error:  # the branch of equilibria turns back
        return Answer(number, LARGE_DEFLECTION.name, time, estimated, (np.nan,) * _MODES, str(error))
    true = bent.frequency / (2 * np.pi * unit) / modes.frequency - 1
    return Answer(number, LARGE_DEFLECTION.name, time, estimated, tuple(true.tolist()))


# Scenes -------------------------------------------------------------------------------------------


def random_left_out_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a scene with all properties of the beam, of which the physics leaves out many, and a speed.

    Three beams of twenty may be twisted, the others bend obliquely: else a second plane would change nothing.
    """
    beam = _random_beam(rng)
    mount, straight = random_mount(rng, beam), rng.random() < _STRAIGHT
    if straight:
        beam = replace(beam, twist=None)
        mount = replace(mount, bending_angle=rng.uniform(-np.pi, np.pi))
    planes, shear, rotary = rng.random(3) < _KEPT
    physics = bd.Physics(2 if planes else 1, shear=bool(shear), rotary_inertia=bool(rotary))
    scene = bd.Scene(beam, mount, physics=physics)
    return scene, random_speed(rng, scene)


def random_bent_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a beam that rotation bends in its plane, by a few percent of the length or more, and its speed."""
    beam = _random_beam(rng)
    mount = replace(
        random_mount(rng, beam),
        radius=beam.length * 10 ** rng.uniform(-1, 1),
        setting_angle=rng.uniform(-np.pi, np.pi),
        bending_angle=rng.choice([0.0, np.pi]),
    )
    if mount.root_stiffness == 0:  # a hinge has no unique equilibrium at rest
        mount = replace(mount, root_stiffness=np.inf)
    scene = bd.Scene(beam, mount, physics=bd.Physics(rotary_inertia=bool(rng.random() < _KEPT)))
    return scene, speed_of_deflection(scene, 10 ** rng.uniform(*np.log10(_DEFLECTION)))


def _random_beam(rng: np.random.Generator) -> bd.Beam:
    with warnings.catch_warnings(action="ignore"):  # warnings of beams without a real material
        beam = random_physics_beam(rng, stocky=True, slenderest=_SLENDEREST)
    return replace(beam, axial_stiffness=beam.mass_per_length.scaled(_STEEL[0] / _STEEL[1]))


# True changes -------------------------------------------------------------------------------------


def _answer(number: int, modes: bd.Modes, added: Addition, estimated: np.ndarray, time: float) -> Answer:
    try:
        true = solved_change(modes, added.scene)
    except (ValueError, ArithmeticError) as error:
        return Answer(number, added.name, time, refusal=str(error))
    return Answer(number, added.name, time, tuple(estimated.tolist()), tuple(true.tolist()))


def solved_change(modes: bd.Modes, scene: bd.Scene) -> np.ndarray:
    """Compute the relative change of each frequency by an effect; nan if the mode is not found."""
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
    """Return a model of fixed size, on segments that suit the scene with and without the effect."""
    functions = max(8, _FUNCTIONS // (len(beam.breakpoints) - 1))
    return _OverBeam(scene, bd.Ritz(functions), beam)


@dataclass(frozen=True)
class _OverBeam(Model):
    """A model whose function spaces suit a beam with all its properties."""

    beam: bd.Beam

    @property
    def equations(self) -> Any:  # pyright: ignore[reportIncompatibleVariableOverride]
        """Equations of motion."""
        from beamdyn.equations.assembly import assemble_over

        return assemble_over(self.scene, self.discretization.spaces(self.beam))


def cases(seed: int = SEED) -> Cases[Answer]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Answer)


# Report -------------------------------------------------------------------------------------------


def summarize(answers: Sequence[Answer]) -> Iterator[Row]:
    """Yield for each effect the fraction of estimates within a factor of two, and the worst estimate."""
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
    """Measure the first 60 scenes."""
    yield from summarize(cases().measure_all(range(60)))


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(__doc__, "stated model errors", cases, summarize, 1500, SEED)
