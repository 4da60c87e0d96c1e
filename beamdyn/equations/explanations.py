"""Why a term is in a scene, or why not: sentences for `beamdyn.terms`, and the conditions that they name."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from beamdyn.equations.root_motion import RootMotion, exact_cos_sin, root_motion
from beamdyn.scene.motion import Motion, MotionSample, SteadyRotation
from beamdyn.scene.scene import Scene

_TINY = 1e-15  # of the root's largest acceleration: the rounding of pi
_SAMPLES, _TURNS, _HORIZON = 501, 10, 100.0  # of the motion: times, turns at steady speed, else seconds


# A scene over its motion ----------------------------------------------------------------------------


@dataclass(frozen=True)
class SampledScene:
    """A scene with samples of its motion: by rotation at 1 rad/s if it has none."""

    scene: Scene

    @cached_property
    def sample(self) -> MotionSample:
        """The motion at times that show all of it."""
        motion = self.scene.motion or SteadyRotation(1.0)
        return motion.at(_sample_times(motion))

    @cached_property
    def root(self) -> RootMotion:
        """Motion of the root at these times, rounding set to 0."""
        root = root_motion(self.scene.mount, self.sample, self.scene.gravity)
        axial, transverse = (
            np.where(np.abs(a) > self.rounding, a, 0.0) for a in (root.root_axial, root.root_transverse)
        )
        return replace(root, root_axial=axial, root_transverse=transverse)

    @cached_property
    def rounding(self) -> float:
        """Acceleration of the root that is rounding [m/s2]."""
        sample, r = self.sample, self.scene.mount.radius
        turning = r * (sample.speed**2 + np.abs(sample.acceleration))
        size = (turning + np.abs(sample.carrier_acceleration).sum(axis=-1)).max()
        return _TINY * (float(size) + abs(self.scene.gravity))

    def varies_from_zero(self, quantity: str) -> bool:
        """Whether a quantity of the root's motion ever differs from 0."""
        return bool(getattr(self.root, quantity).any())

    def sources(self, quantity: str) -> list[str]:
        """What an acceleration of the root comes from: each source alone, by the same formula."""
        sizes = {
            name: np.abs(getattr(root_motion(self.scene.mount, sample, gravity), quantity)).max()
            for name, sample, gravity in _single_sources(self.sample, self.scene.gravity)
        }
        return [name for name, size in sizes.items() if size > self.rounding]


def _single_sources(sample: MotionSample, gravity: float) -> Iterator[tuple[str, MotionSample, float]]:
    """The motion with one source of acceleration at a time."""
    still = replace(MotionSample.steady(0 * sample.speed), angle=sample.angle)
    yield "rotation", replace(still, speed=sample.speed), 0.0
    yield "angular acceleration", replace(still, acceleration=sample.acceleration), 0.0
    yield "translation", replace(still, carrier_acceleration=sample.carrier_acceleration), 0.0
    yield "gravity", still, gravity


def _sample_times(motion: Motion) -> np.ndarray:
    """Times that show all of a motion: until it is steady, and some turns on [s]."""
    known = min(motion.steady_start, motion.end)
    if not math.isfinite(known):
        known = max(_HORIZON, *motion.breakpoints, 0.0)
    speed = abs(motion.final_speed)
    beyond = _TURNS * 2 * math.pi / speed if speed > 0 else 0.0
    times = np.concatenate([np.linspace(0, known, _SAMPLES), known + np.linspace(0, beyond, _SAMPLES)])
    return np.unique(np.minimum(times, motion.end))


# Explanations ---------------------------------------------------------------------------------------

Sentence: TypeAlias = "str | Callable[[SampledScene], str]"


@dataclass(frozen=True)
class Condition:
    """What a term needs, and the sentence where it is not met."""

    is_met: Callable[[SampledScene], bool]
    otherwise: Sentence


@dataclass(frozen=True)
class Explanation:
    """How a term is written, why it is there, and what it needs.

    Parameters
    ----------
    symbol : str
        As in the equations of docs/conventions.md.
    reason : str or callable
        Why it is in a scene.
    conditions : tuple of Condition
        All of them are met where it is in a scene.
    """

    symbol: str
    reason: Sentence
    conditions: tuple[Condition, ...] = ()

    def sentence(self, scene: SampledScene, present: bool) -> str:
        """Why the term is in the scene, or the first condition that fails."""
        failed = [c.otherwise for c in self.conditions if not c.is_met(scene)]
        text = self.reason if present else [*failed, "its coefficient is zero"][0]
        return text if isinstance(text, str) else text(scene)


def say_tension(scene: SampledScene) -> str:
    """What accelerates the root along the beam."""
    sources = scene.sources("root_axial")
    if sources == ["rotation"]:
        return "the root's steady acceleration; no translation, so no parametric tension"
    return f"the root accelerates along the beam by {_enumerate(sources)}"


def say_static_load(scene: SampledScene) -> str:
    """What accelerates the root across the beam."""
    return (
        f"the root accelerates in the direction of bending by {_enumerate(scene.sources('root_transverse'))}"
    )


def _say_unloaded(scene: SampledScene) -> str:
    steady = "" if scene.varies_from_zero("acceleration") else ", no angular acceleration"
    if abs(math.sin(scene.scene.mount.setting_angle)) < _TINY:
        return f"no setting angle, so no static load{steady}, no translation or gravity across the beam"
    return f"the root has no acceleration in the direction of bending{steady}"


def _say_untensioned(scene: SampledScene) -> str:
    at_axis = "the root is on the axis" if not scene.scene.mount.radius else "the setting angle is 90 deg"
    return f"{at_axis}, and no translation or gravity acts along the beam"


def _enumerate(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1])] * (len(words) > 1) + words[-1:])


def _has_different_inertias(scene: SampledScene) -> bool:
    tip = scene.scene.beam.tip
    return tip is not None and tip.inertia_about_bending_direction != tip.axial_inertia


# Conditions that the terms of several fields name.

TURNS = Condition(lambda s: s.varies_from_zero("speed"), "the carrier does not turn")
ACCELERATES = Condition(
    lambda s: s.varies_from_zero("acceleration"), "constant speed: no angular acceleration"
)
IN_PLANE = Condition(
    lambda s: exact_cos_sin(s.scene.mount.bending_angle)[0] != 0,
    "the bending angle is 90 deg: the beam bends out of the plane of rotation",
)
OUT_OF_PLANE = Condition(
    lambda s: exact_cos_sin(s.scene.mount.bending_angle)[1] != 0,
    "the bending angle is 0: the beam bends in the plane of rotation",
)
DAMPED = Condition(lambda s: s.scene.damping_ratio > 0, "no damping: the damping ratio is 0")
TIP_BODY = Condition(lambda s: s.scene.beam.tip is not None, "no tip body")
TIP_INERTIA = Condition(
    _has_different_inertias,
    "the tip body's inertias about the beam and about the direction of bending are the same",
)
TENSIONED = Condition(lambda s: s.varies_from_zero("root_axial"), _say_untensioned)
LOADED = Condition(lambda s: s.varies_from_zero("root_transverse"), _say_unloaded)
