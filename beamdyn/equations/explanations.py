"""Reasons why a term is in a scene's equations or not: sentences and conditions for `beamdyn.terms`."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TypeAlias

import numpy as np

from beamdyn.equations.root_motion import RootMotion, root_motion
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import section_tensor, tip_inertia

_ROUNDING = 1e-15  # rounding error of accelerations, for example from rounded angles, relative to the largest
_SAMPLES = 501  # number of instants sampled before the speed is steady, and again at steady speed
_TURNS = 10  # number of revolutions that are sampled at steady speed
_MOST_PLACES = 6  # largest number of point masses whose positions are listed
_HORIZON = 100.0  # sampled duration [s] of a motion that never becomes steady and has no end


# A scene with samples of its motion -------------------------------------------------------------------


@dataclass(frozen=True)
class SampledScene:
    """A scene with samples of its motion, or of steady rotation at 1 rad/s if it has none."""

    scene: Scene

    @cached_property
    def sample(self) -> MotionSample:
        """Motion of the carrier at representative times."""
        motion = self.scene.motion
        if motion is None:
            turned = np.linspace(0, _TURNS * 2 * math.pi, _SAMPLES)
            return replace(MotionSample.steady(np.ones(_SAMPLES)), angle=turned)
        start = min(motion.steady_start, motion.end)
        if not math.isfinite(start):
            start = max(_HORIZON, *motion.breakpoints, 0.0)
        speed = abs(motion.final_speed)  # also sample some revolutions at the final speed
        turns = np.linspace(0, _TURNS * 2 * math.pi / (speed or np.inf), _SAMPLES)
        times = np.linspace(0, start, _SAMPLES), turns
        return motion.at(np.unique(np.minimum(np.concatenate([times[0], start + times[1]]), motion.end)))

    @cached_property
    def root(self) -> RootMotion:
        """Motion of the root at the sampled times, with accelerations below rounding set to 0."""
        root = root_motion(self.scene.mount, self.sample, self.scene.gravity)
        names = ("root_axial", "root_transverse", "root_across")
        above = {name: np.abs(getattr(root, name)) > self.rounding for name in names}
        return replace(root, **{name: np.where(above[name], getattr(root, name), 0.0) for name in names})

    @cached_property
    def rounding(self) -> float:
        """Rounding error of the root's acceleration [m/s2]."""
        sample, r = self.sample, self.scene.mount.radius
        rotation = r * (sample.speed**2 + np.abs(sample.acceleration))
        size = (rotation + np.abs(sample.carrier_acceleration).sum(axis=-1)).max()
        return _ROUNDING * (float(size) + abs(self.scene.gravity))

    def is_nonzero(self, quantity: str) -> bool:
        """Whether a quantity of the root's motion differs from 0 at any sampled time."""
        return bool(getattr(self.root, quantity).any())

    def sources(self, quantity: str) -> list[str]:
        """List the sources (gravity, road ...) that contribute to an acceleration of the root."""
        rest = replace(MotionSample.steady(0 * self.sample.speed), angle=self.sample.angle)
        names = {
            "rotation": "speed", "angular acceleration": "acceleration", "translation": "carrier_acceleration"
        }  # fmt: skip
        single = {n: (replace(rest, **{f: getattr(self.sample, f)}), 0.0) for n, f in names.items()}
        single["gravity"] = rest, self.scene.gravity
        roots = {name: root_motion(self.scene.mount, *given) for name, given in single.items()}
        return [name for name, root in roots.items() if np.abs(getattr(root, quantity)).max() > self.rounding]


# Explanations ---------------------------------------------------------------------------------------

Sentence: TypeAlias = "str | Callable[[SampledScene], str]"


@dataclass(frozen=True)
class Condition:
    """Condition for the presence of a term, with the sentence that explains the absence."""

    is_met: Callable[[SampledScene], bool]
    otherwise: Sentence


@dataclass(frozen=True)
class Explanation:
    """Symbol of a term, the reason for its presence, and the conditions of its presence.

    Parameters
    ----------
    symbol : str
        The term as written in docs/conventions.md, for one plane of bending.
    reason : str or callable
        Why the term is present.
    conditions : tuple of Condition
        Conditions for the presence of the term, all of which must be met.
    """

    symbol: str
    reason: Sentence
    conditions: tuple[Condition, ...] = ()

    def sentence(self, scene: SampledScene, present: bool) -> str:
        """Explain why the term is present in the scene, or state the first condition that is not met."""
        failed = [c.otherwise for c in self.conditions if not c.is_met(scene)]
        text = self.reason if present else [*failed, "its coefficient is zero"][0]
        return text if isinstance(text, str) else text(scene)


def say_mass(scene: SampledScene) -> str:
    """State that mass is present in every scene, and which point masses contribute to it."""
    heavy = [lump for lump in scene.scene.beam.point_masses if lump.mass]
    if not heavy:
        return "always"
    total = f"{math.fsum(lump.mass for lump in heavy):.4g} kg of the mass"
    places = sorted({f"{lump.position:.4g}": lump.position for lump in heavy}.items(), key=lambda p: p[1])
    names = [name for name, _ in places]
    among = len(names) > _MOST_PLACES
    where = f"{len(heavy)} places from x = {names[0]} m to {names[-1]} m" if among else None
    return f"always; {total} is in point masses at {where or f'x = {_enumerate(names)} m'}"


def say_tension(scene: SampledScene) -> str:
    """State what accelerates the root along the beam and so causes tension."""
    sources = scene.sources("root_axial")
    if sources == ["rotation"]:
        return "the root has a steady acceleration; there is no translation, so no parametric tension"
    return f"the root accelerates along the beam, due to {_enumerate(sources)}"


def say_softening(scene: SampledScene) -> str:
    """Explain why rotation increases a deflection away from the rotation axis."""
    in_plane = IN_PLANE.is_met(scene)
    return "it bends in the plane of rotation" if in_plane else "the precone has it bend outward"


def say_static_load(scene: SampledScene) -> str:
    """State what accelerates the root in the direction of bending and so loads the beam."""
    sources = [source for name in _transverse(scene) for source in scene.sources(name)]
    where = "across the beam" if scene.scene.physics.planes == 2 else "in the direction of bending"
    return f"the root accelerates {where}, due to {_enumerate([*dict.fromkeys(sources)])}"


def _transverse(scene: SampledScene) -> tuple[str, ...]:
    """List the quantities of the root's motion that load the beam transversely."""
    return ("root_transverse", "root_across")[: scene.scene.physics.planes]


def _say_unloaded(scene: SampledScene) -> str:
    steady = "" if scene.is_nonzero("acceleration") else ", no angular acceleration"
    if abs(math.sin(scene.scene.mount.setting_angle)) < _ROUNDING:
        return f"the beam is radial, so no static load{steady}, no translation or gravity across the beam"
    return f"the root has no acceleration in the direction of bending{steady}"


def _say_untensioned(scene: SampledScene) -> str:
    at_axis = "the root is on the axis" if not scene.scene.mount.radius else "the setting angle is 90 deg"
    return f"{at_axis}, and no translation or gravity acts along the beam"


def _enumerate(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1])] * (len(words) > 1) + words[-1:])


def _has_different_inertias(scene: SampledScene) -> bool:
    """Return whether the tip body's rotational energy changes as it tilts out of the plane of rotation."""
    tip, planes = scene.scene.beam.tip, scene.scene.physics.planes
    if tip is None:
        return False
    inertia = tip_inertia(tip, scene.scene.modelled_beam.tip_twist).centrifugal
    if scene.scene.mount.precone:
        return bool(inertia[:planes, :planes].any())
    c, s = aligned_cos_sin(scene.scene.mount.bending_angle)
    out_of_plane = np.array([s, c]) if planes == 2 else np.array([s or 1.0, 0.0])
    return bool((inertia @ out_of_plane)[:planes].any())


def _has_oblique_inertia(scene: SampledScene) -> bool:
    """Return whether sections or tip body have a product of inertia about rotation axis and beam axis."""
    (c, s), beam = aligned_cos_sin(scene.scene.mount.bending_angle), scene.scene.modelled_beam
    d, n, xi = np.array([c, -s]), np.array([s, c]), np.linspace(0, 1, 101)
    sections = (d[p] * n[q] * R(xi) for (p, q), R in section_tensor(beam, "rotary_inertia").items())
    tip = beam.tip and d @ tip_inertia(beam.tip, beam.tip_twist).centrifugal @ n
    return bool(np.any(sum(sections, np.zeros(1))) or tip)


def _is_on_springs(scene: SampledScene) -> bool:
    """Return whether a spring supports the root in a direction that is modelled."""
    springs = scene.scene.mount.root_stiffnesses[: scene.scene.physics.planes]
    return any(0 < k < math.inf for k in springs)


def _say_root(scene: SampledScene) -> str:
    """State how the root is supported if there is no spring."""
    springs = scene.scene.mount.root_stiffnesses[: scene.scene.physics.planes]
    if math.inf not in springs:
        return "the root is a hinge: it turns freely"
    return "the root is clamped" if 0 not in springs else "root clamped in one plane, hinged in the other"


# Conditions shared by terms of several fields.

TURNS = Condition(lambda s: s.is_nonzero("speed"), "the carrier does not turn")
ACCELERATES = Condition(lambda s: s.is_nonzero("acceleration"), "constant speed: no angular acceleration")
IN_PLANE = Condition(
    lambda s: s.scene.physics.planes == 2 or aligned_cos_sin(s.scene.mount.bending_angle)[0] != 0,
    "the bending angle is 90 deg: the beam bends out of the plane of rotation",
)
OUT_OF_PLANE = Condition(
    lambda s: s.scene.physics.planes == 2 or aligned_cos_sin(s.scene.mount.bending_angle)[1] != 0,
    "the bending angle is 0: the beam bends in the plane of rotation",
)
PRECONED = Condition(lambda s: s.scene.mount.precone != 0, "no precone: the beam is in the plane of rotation")
BOTH = Condition(lambda s: s.scene.physics.planes == 2, "the beam bends in one plane")
SOFTENED = Condition(lambda s: PRECONED.is_met(s) or IN_PLANE.is_met(s), IN_PLANE.otherwise)
TILTED = Condition(lambda s: PRECONED.is_met(s) or OUT_OF_PLANE.is_met(s), OUT_OF_PLANE.otherwise)
DAMPED = Condition(lambda s: s.scene.is_damped, "no damping: the damping ratio is 0")
ON_POINTS = Condition(lambda s: bool(s.scene.beam.point_springs), "no springs along the beam")
TIP_BODY = Condition(lambda s: s.scene.beam.tip is not None, "no tip body")
_ROUND = "the tip body's inertias about the beam and about the direction of bending are the same"
TIP_INERTIA = Condition(_has_different_inertias, _ROUND)
TENSIONED = Condition(lambda s: s.is_nonzero("root_axial"), _say_untensioned)
LOADED = Condition(lambda s: any(map(s.is_nonzero, _transverse(s))), _say_unloaded)
_ALIGNED = "sections and tip body have no product of inertia about the axis of rotation"
OBLIQUE = Condition(_has_oblique_inertia, _ALIGNED)
ON_SPRINGS = Condition(_is_on_springs, _say_root)
