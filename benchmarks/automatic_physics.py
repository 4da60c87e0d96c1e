"""Test whether `physics="auto"` adds the effects that matter, and no others.

Run: python -m benchmarks.automatic_physics [--scenes N] [--first N] [--save FILE].  Random scenes are solved
with automatically chosen physics and with the largest set of effects that can be combined; in half of the
scenes an effect matters, in half of these large deflection.  Large deflection excludes some effects: the
changes by the excluded ones, solved alone, count as errors, too.
"""

from __future__ import annotations

import os
import warnings
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from time import perf_counter
from typing import Any

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.equations.effects import NAMED, add_effects
from beamdyn.modes.modal.model import Model
from beamdyn.modes.model_error.left_out_changes import bends
from beamdyn.scene.physics import PhysicsChoice
from benchmarks.cases.random_physics import Section, random_twist, speed_of_deflection
from benchmarks.cases.scenes import time_unit
from benchmarks.resumable import Cases, measure_random
from benchmarks.rows import Row, time_text
from benchmarks.stated_model_errors import solved_change

SEED = 1515
TOLERANCE = 1e-3
_MODES = 3
_WITHIN, _NEEDED = 0.99, 0.8  # target fractions of scenes: within the tolerance, and without useless effects
_USELESS = 1e-4  # change of frequencies below which an added effect was not needed
_STEEL = 200e9, 7850.0  # Young's modulus [Pa] and density [kg/m3]
_QUARTER = np.pi / 2
_DEFLECTION = 0.03, 0.4  # least and largest linear static deflection of bent beams, over the length
_ALL = bd.Physics(planes=2, shear=True, rotary_inertia=True, stretch=True)


@dataclass(frozen=True)
class Answer:
    """The chosen physics of one scene, and the true changes of frequencies (relative, largest of all modes).

    `needed` is the error of the plain beam, `error` that of the chosen physics, `stated` the estimate of the
    latter; nan if unknown, inf if other modes appear.  `removed` is the change without an added effect.
    """

    number: int
    time: float
    needed: float = 0.0
    error: float = 0.0
    stated: float = 0.0
    said: bool = False
    removed: dict[str, float] = field(default_factory=dict)
    refusal: str = ""


def measure(number: int, seed: int) -> list[Answer]:
    """Compute the `Answer` for the scene with a number; scenes with odd numbers need an effect."""
    with warnings.catch_warnings(action="ignore"):  # warnings of beams without a real material
        scene, speed, needed = _draw(np.random.default_rng([seed, number]), number)
        start = perf_counter()
        try:
            modes = bd.natural_modes(replace(scene, physics="auto"), speed, _MODES, tolerance=TOLERANCE)
        except (ValueError, ArithmeticError) as error:
            return [Answer(number, perf_counter() - start, refusal=str(error))]
        time, choice = perf_counter() - start, modes.physics_choice
        assert choice is not None
        answer = Answer(
            number=number,
            time=time,
            needed=needed,
            error=true_error(bd.natural_modes(modes.scene, speed, _MODES)),
            stated=choice.model_error,
            said=not choice.is_met,
            removed={name: _change_without(name, scene, speed, choice) for name in choice.included},
        )
        return [answer]


def _draw(rng: np.random.Generator, number: int) -> tuple[bd.Scene, float, float]:
    """Draw a scene, its speed, and the error of the plain beam, above tolerance if an effect is needed."""
    while True:
        kinds = random_kinds(rng, number)
        scene, speed = random_scene(rng, kinds)
        needed = true_error(bd.natural_modes(scene, speed, _MODES))
        if not kinds or not needed <= TOLERANCE:
            return scene, speed, needed


def true_error(modes: bd.Modes) -> float:
    """Compute the change of frequencies by all left-out effects, by solving with them."""
    physics = modes.scene.physics
    if physics.large_deflection:
        within = bd.Physics(rotary_inertia=True, large_deflection=True)
        straight = bd.natural_modes(replace(modes.scene, physics=bd.Physics()), modes.speed, _MODES)
        return _direct(modes, within) + _solved(straight, replace(_ALL, rotary_inertia=False))
    oblique = min(abs(np.cos(modes.scene.mount.bending_angle)), abs(np.sin(modes.scene.mount.bending_angle)))
    bent = 0.0
    # In all other cases the effect cannot be modelled, or is negligible.
    if oblique < 1e-12 and bends(Model(modes.scene, bd.Ritz(5))):
        alone = replace(modes.scene, physics=bd.Physics(rotary_inertia=physics.rotary_inertia))
        straight = bd.natural_modes(alone, modes.speed, _MODES)
        bent = _direct(straight, replace(alone.physics, large_deflection=True))
    return _solved(modes, _ALL) + bent


def _direct(modes: bd.Modes, physics: bd.Physics) -> float:
    """Compute the largest change of frequencies with other physics in one plane, in unchanged order."""
    try:
        other = bd.natural_modes(replace(modes.scene, physics=physics), modes.speed, _MODES)
    except ArithmeticError:  # there is no equilibrium
        return float(np.nan)
    return float(np.abs(other.frequency / modes.frequency - 1).max())


def _solved(modes: bd.Modes, physics: bd.Physics) -> float:
    """Compute the largest change of modes with more physics; inf if a mode cannot be identified."""
    change = solved_change(modes, replace(modes.scene, physics=physics))
    return float(np.nan_to_num(np.abs(change), nan=np.inf).max())


def _change_without(name: str, scene: bd.Scene, speed: float, choice: PhysicsChoice) -> float:
    """Compute the change of frequencies if one of the added effects is left out."""
    others = add_effects(scene, [NAMED[other] for other in choice.included if other != name])
    without = bd.natural_modes(others, speed, _MODES)
    if choice.physics.large_deflection:
        return _direct(without, choice.physics)
    return _solved(without, choice.physics)


# Scenes -------------------------------------------------------------------------------------------


def random_kinds(rng: np.random.Generator, number: int) -> list[str]:
    """Draw the reasons why the scene with a number needs an effect; every other scene needs none.

    Every fourth beam is bent by rotation in its plane, so far that large deflection matters.  The others have
    one or two of these reasons: stocky, twisted, an oblique bending angle, or any setting angle.
    """
    if number % 2 == 0:
        return []
    if number % 4 == 1:
        return rng.permutation(["stocky", "twisted", "oblique", "turned"])[: rng.integers(1, 3)].tolist()
    return ["bent", *rng.permutation(["stocky", "twisted", ""])[:1].tolist()]


def random_scene(rng: np.random.Generator, kinds: Sequence[str]) -> tuple[bd.Scene, float]:
    """Draw a steel beam with given reasons (`random_kinds`), and a speed.

    Without a reason, the beam is slender, straight and points towards the axis or away from it.
    """
    low, high = (5, 60) if "stocky" in kinds else (300, 2000)
    ratio, slenderness = 10 ** rng.uniform(0.3, 2.0), 10 ** rng.uniform(np.log10(low), np.log10(high))
    length = 10 ** rng.uniform(-2, 1)
    section: dict[str, Any] = Section(length, slenderness, ratio).properties()
    axial = section["mass_per_length"] * _STEEL[0] / _STEEL[1]
    twist = random_twist(rng) if "twisted" in kinds else None
    beam = bd.Beam.from_stiffness(length, **section, axial_stiffness=axial, twist=twist)
    turned = rng.uniform(0.0, np.pi) if {"turned", "bent"} & {*kinds} else rng.choice([0.0, np.pi])
    bending = rng.uniform(0.1, _QUARTER) if "oblique" in kinds else rng.choice([0.0, _QUARTER])
    bending = 0.0 if "bent" in kinds else bending
    scene = bd.Scene(beam, bd.Mount(length * rng.uniform(0, 5), float(turned), float(bending)))
    if "bent" in kinds:
        return scene, speed_of_deflection(scene, 10 ** rng.uniform(*np.log10(_DEFLECTION)))
    critical = Model(scene, bd.Ritz(12)).solver.critical_speed
    gamma = 10 ** rng.uniform(-1.5, 0.4) / time_unit(beam)
    return scene, float(min(gamma, 0.8 * critical))


def cases(seed: int = SEED) -> Cases[Answer]:
    """Return the random scenes of a seed, as resumable cases."""
    return Cases(partial(measure, seed=seed), Answer)


# Report -------------------------------------------------------------------------------------------


def summarize(answers: Sequence[Answer]) -> Iterator[Row]:
    """Yield the fractions of scenes within the tolerance or with a warning, and without useless effects."""
    found = [a for a in answers if not a.refusal]
    yield "random scenes", str(len(answers)), "200"
    yield "... refused", str(len(answers) - len(found)), "0"
    yield (
        "... in which the plain beam is not within 1e-3",
        str(sum(not a.needed <= TOLERANCE for a in found)),
        "",
    )
    good = [a.error <= TOLERANCE or a.said for a in found]
    yield "within 1e-3 of all effects, or said not to be", f"{np.mean(good):.1%}", f"{_WITHIN:.0%}"
    yield "... of these said not to be", str(sum(a.said for a in found)), ""
    yield "... said, but within 1e-3", str(sum(a.said and a.error <= TOLERANCE for a in found)), ""
    lean = [all(change >= _USELESS for change in a.removed.values()) for a in found]
    yield "no added effect changes less than 1e-4", f"{np.mean(lean):.1%}", f"{_NEEDED:.0%}"
    yield "effects added, in all", str(sum(len(a.removed) for a in found)), ""
    for name in sorted({name for a in found for name in a.removed}):
        yield f"... {name}", str(sum(name in a.removed for a in found)), ""
    times = np.array([a.time for a in answers])
    yield "median and longest time", f"{time_text(np.median(times))}, {time_text(times.max())}", ""
    for a, ok in zip(found, good, strict=True):
        if not ok:
            yield f"... scene {a.number}", f"true {a.error:.1e}, stated {a.stated:.1e}, {[*a.removed]}", ""
    for a, ok in zip(found, lean, strict=True):
        if not ok:
            yield f"... not needed in scene {a.number}", f"{min(a.removed, key=a.removed.__getitem__)}", ""
    for a in (a for a in answers if a.refusal):
        yield f"... refused: scene {a.number}", a.refusal, ""


def measure_sample() -> Iterator[Row]:
    """Measure the first 24 scenes."""
    yield from summarize(cases().measure_all(range(24)))


PARTS = (measure_sample,)


if __name__ == "__main__":
    measure_random(__doc__, "automatic physics", cases, summarize, 200, SEED)
