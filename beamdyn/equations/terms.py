"""What the model of a scene contains: every term of the equations, whether it is there, and why."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from time import perf_counter
from typing import TypeAlias

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.results import Provenance, Result
from beamdyn.equations.equations_of_motion import Equations, Load, RootMotion, Term, equations, root_motion
from beamdyn.equations.operators import assemble
from beamdyn.equations.ritz import Ritz
from beamdyn.scene.beam import TipMass
from beamdyn.scene.motion import Line, Motion, MotionSample, SteadyRotation
from beamdyn.scene.scene import Mount, Scene

_BASIS = Ritz(3)  # the list does not depend on it
_TINY = 1e-15  # of the root's largest acceleration: the rounding of pi
_SAMPLES, _TURNS, _HORIZON = 501, 10, 100.0  # of the motion: times, turns at steady speed, else seconds


@dataclass(frozen=True)
class Entry:
    """One term of the equations.

    Parameters
    ----------
    name : str
        What it is.
    symbol : str
        How it is written in the equations.
    quantity : str
        The quantity of motion that multiplies it.
    largest : float
        Largest absolute value of its coefficient over the motion [SI]; 0 where it is not in the scene.
    present : bool
        Whether it is in the scene.
    reason : str
        Why, or why not.
    """

    name: str
    symbol: str
    quantity: str
    largest: float
    present: bool
    reason: str


@dataclass(frozen=True)
class Terms(Result):
    """Terms of the equations of a scene; iterates over them, and prints as a table.

    Parameters
    ----------
    entries : tuple of Entry
        All terms that the equations know.
    lines : tuple of Line
        Frequencies that translation and gravity excite, as multiples of the speed.
    provenance : Provenance
        How it was found.
    """

    entries: tuple[Entry, ...]
    lines: tuple[Line, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    def __iter__(self) -> Iterator[Entry]:
        return iter(self.entries)

    def __len__(self) -> int:
        return len(self.entries)

    def __getitem__(self, name: str) -> Entry:
        return next(entry for entry in self.entries if entry.name == name)

    @property
    def present(self) -> tuple[str, ...]:
        """Names of the terms that are in the scene."""
        return tuple(entry.name for entry in self if entry.present)

    def rows(self) -> list[tuple[str, str, str, str, str]]:
        """Cells of the table: in or out, name, symbol, largest coefficient, reason."""
        return [
            ("in" if e.present else "-", e.name, e.symbol, f"{e.largest:.4g}" if e.present else "", e.reason)
            for e in self
        ]

    def excited(self) -> str:
        """The lines, in words."""
        named = ", ".join(f"{line.name} at {line.multiple:.6g} times the speed" for line in self.lines)
        return f"Lines: {named or 'none'}."

    def __str__(self) -> str:
        rows = [("", "term", "symbol", "largest", "reason"), *self.rows()]
        widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
        cells = [[c.ljust(w) for c, w in zip(row, widths, strict=True)] for row in rows]
        return "\n".join(["  ".join(row).rstrip() for row in cells] + [self.excited()])


def terms(scene: Scene) -> Terms:
    """Every term of the equations of motion, whether it is in a scene, and why.

    A term is in the scene if it is assembled and its coefficient does not vanish over the motion.

    Parameters
    ----------
    scene : Scene
        The scene; without a motion it turns steadily, at 1 rad/s.

    Returns
    -------
    Terms
    """
    start = perf_counter()
    facts = _Facts(scene)
    entries = tuple(_entry(term, facts) for term in _all(_complete(scene)))
    lines = scene.motion.lines if scene.motion is not None else ()
    gravity = (Line("gravity", 1.0),) if scene.gravity else ()
    provenance = Provenance(__version__, str(_BASIS), "", perf_counter() - start)
    return Terms(entries, (*lines, *gravity), provenance, scene)


def _complete(scene: Scene) -> Scene:
    """The same scene with all that it could have: its equations hold every term."""
    beam, body = scene.beam, TipMass(1.0, inertia=1.0, axial_inertia=0.5)
    beam = replace(beam, axial_stiffness=beam.axial_stiffness or beam.bending_stiffness, tip=body)
    return replace(scene, beam=beam, mount=Mount(1.0, 1.0, 1.0), damping_ratio=0.5, stretch=True)


def _assembled(scene: Scene) -> Equations:
    return equations(scene, assemble(scene.beam, _BASIS, scene.stretch))


def _all(scene: Scene) -> tuple[Term | Load, ...]:
    found = _assembled(scene)
    return (*found.terms, *found.loads)


# Is it there? ---------------------------------------------------------------------------------------


@dataclass(frozen=True)
class _Facts:
    """A scene, and what its root does."""

    scene: Scene

    @cached_property
    def sample(self) -> MotionSample:
        """The motion at many times."""
        motion = self.scene.motion or SteadyRotation(1.0)
        return motion.at(_times(motion))

    @cached_property
    def root(self) -> RootMotion:
        """Motion of the root at these times, without its rounding."""
        root = root_motion(self.scene.mount, self.sample, self.scene.gravity)
        axial, transverse = (
            np.where(np.abs(a) > self.small, a, 0.0) for a in (root.root_axial, root.root_transverse)
        )
        return replace(root, root_axial=axial, root_transverse=transverse)

    @cached_property
    def assembled(self) -> dict[str, Term | Load]:
        """The terms that are assembled, by name."""
        return {term.name: term for term in _all(self.scene)}

    @cached_property
    def small(self) -> float:
        """Acceleration of the root that is rounding [m/s2]."""
        sample, r = self.sample, self.scene.mount.radius
        turning = r * (sample.speed**2 + np.abs(sample.acceleration))
        size = (turning + np.abs(sample.carrier_acceleration).sum(axis=-1)).max()
        return _TINY * (float(size) + abs(self.scene.gravity))

    def moves(self, quantity: str) -> bool:
        """Whether a quantity of the root's motion ever differs from 0."""
        return bool(getattr(self.root, quantity).any())

    def sources(self, quantity: str) -> list[str]:
        """What an acceleration of the root comes from: each source alone, by the same formula."""
        sizes = {
            name: np.abs(getattr(root_motion(self.scene.mount, sample, gravity), quantity)).max()
            for name, sample, gravity in _alone(self.sample, self.scene.gravity)
        }
        return [name for name, size in sizes.items() if size > self.small]


def _alone(sample: MotionSample, gravity: float) -> Iterator[tuple[str, MotionSample, float]]:
    """The motion with one source of acceleration at a time."""
    still = replace(MotionSample.steady(0 * sample.speed), angle=sample.angle)
    yield "rotation", replace(still, speed=sample.speed), 0.0
    yield "angular acceleration", replace(still, acceleration=sample.acceleration), 0.0
    yield "translation", replace(still, carrier_acceleration=sample.carrier_acceleration), 0.0
    yield "gravity", still, gravity


def _times(motion: Motion) -> np.ndarray:
    """Times that show all of a motion: until it settles, and some turns on [s]."""
    known = min(motion.settled, motion.end)
    if not math.isfinite(known):
        known = max(_HORIZON, *motion.breakpoints, 0.0)
    speed = abs(motion.final_speed)
    beyond = _TURNS * 2 * math.pi / speed if speed > 0 else 0.0
    run = np.concatenate([np.linspace(0, known, _SAMPLES), known + np.linspace(0, beyond, _SAMPLES)])
    return np.unique(np.minimum(run, motion.end))


def _entry(term: Term | Load, facts: _Facts) -> Entry:
    kept = facts.assembled.get(term.name)
    largest = 0.0 if kept is None else float(np.abs(kept.coefficient(facts.root)).max())
    symbol, reason, conditions = _MEANING.get(term.name, (term.name, "it is assembled", ()))
    failed = [condition.sentence for condition in conditions if not condition.holds(facts)]
    why = reason if largest else [*failed, "its coefficient is zero"][0]
    why = why if isinstance(why, str) else why(facts)
    return Entry(term.name, symbol, _QUANTITY[term.quantity], largest, bool(largest), why)


# Why? -----------------------------------------------------------------------------------------------


_Reason: TypeAlias = "str | Callable[[_Facts], str]"


@dataclass(frozen=True)
class _Condition:
    """What a term needs, and what to say where it is not so."""

    holds: Callable[[_Facts], bool]
    sentence: _Reason


def _tension(facts: _Facts) -> str:
    found = facts.sources("root_axial")
    if found == ["rotation"]:
        return "the root's steady acceleration; no translation, so no parametric tension"
    return f"the root accelerates along the beam by {_list(found)}"


def _static_load(facts: _Facts) -> str:
    return f"the root accelerates in the direction of bending by {_list(facts.sources('root_transverse'))}"


def _unloaded(facts: _Facts) -> str:
    steady = "" if facts.moves("acceleration") else ", no angular acceleration"
    if abs(math.sin(facts.scene.mount.setting_angle)) < _TINY:
        return f"no setting angle, so no static load{steady}, no translation or gravity across the beam"
    return f"the root has no acceleration in the direction of bending{steady}"


def _untensioned(facts: _Facts) -> str:
    at_axis = "the root is on the axis" if not facts.scene.mount.radius else "the setting angle is 90 deg"
    return f"{at_axis}, and no translation or gravity acts along the beam"


def _list(words: list[str]) -> str:
    return " and ".join([", ".join(words[:-1])] * (len(words) > 1) + words[-1:])


def _bends(facts: _Facts, quarter: Callable[[float], float]) -> bool:
    return abs(quarter(facts.scene.mount.bending_angle)) > 2e-16


_STRETCH = _Condition(lambda f: f.scene.stretch, "no stretch: the beam is modelled as inextensible")
_DAMPED = _Condition(lambda f: f.scene.damping_ratio > 0, "no damping: the damping ratio is 0")
_TURNS_ROUND = _Condition(lambda f: f.moves("speed"), "the carrier does not turn")
_ACCELERATES = _Condition(lambda f: f.moves("acceleration"), "constant speed: no angular acceleration")
_IN_PLANE = _Condition(
    lambda f: _bends(f, math.cos), "the bending angle is 90 deg: the beam bends out of the plane of rotation"
)
_OUT_OF_PLANE = _Condition(
    lambda f: _bends(f, math.sin), "the bending angle is 0: the beam bends in the plane of rotation"
)
_TIP = _Condition(lambda f: f.scene.beam.tip is not None, "no tip body")
_TIP_INERTIA = _Condition(
    lambda f: (tip := f.scene.beam.tip) is not None and tip.inertia_transverse != tip.axial_inertia,
    "the tip body's inertias about the beam and about the direction of bending are the same",
)
_TENSIONED = _Condition(lambda f: f.moves("root_axial"), _untensioned)
_LOADED = _Condition(lambda f: f.moves("root_transverse"), _unloaded)

_QUANTITY = {
    "unity": "1",
    "speed": "speed [rad/s]",
    "acceleration": "angular acceleration [rad/s2]",
    "speed_squared": "speed squared [rad2/s2]",
    "root_axial": "root acceleration along the beam [m/s2]",
    "root_transverse": "root acceleration in the direction of bending [m/s2]",
}

# What the terms mean, by their name: symbol, why it is there, what it needs.
_MEANING: dict[str, tuple[str, _Reason, tuple[_Condition, ...]]] = {
    "mass": ("M22 q2''", "always", ()),
    "bending stiffness": ("KB q2", "always", ()),
    "centrifugal stiffening": ("ω² KGB q2", "the carrier turns", (_TURNS_ROUND,)),
    "spin softening": ("-ω² c² S22 q2", "it bends in the plane of rotation", (_TURNS_ROUND, _IN_PLANE)),
    "spin of the tip body": (
        "ω² s² (Je - J1) D Dᵀ q2",
        "the tip body tilts out of the plane of rotation",
        (_TIP, _TIP_INERTIA, _OUT_OF_PLANE, _TURNS_ROUND),
    ),
    "tension by root acceleration": ("-aO1 KGA q2", _tension, (_TENSIONED,)),
    "damping": ("2 ζ Λ q2'", "the damping ratio is not 0", (_DAMPED,)),
    "angular acceleration": ("ω' c Q2", "the speed varies", (_ACCELERATES, _IN_PLANE)),
    "root acceleration": ("-(c aO2 + s aO3) P2", _static_load, (_LOADED,)),
    "stretch mass": ("M11 q1''", "stretch is modelled", (_STRETCH,)),
    "axial stiffness": ("KS q1", "stretch is modelled", (_STRETCH,)),
    "axial spin softening": ("-ω² M11 q1", "the carrier turns", (_STRETCH, _TURNS_ROUND)),
    "Coriolis coupling of stretch": (
        "2 ω c M12 q2'",
        "the carrier turns",
        (_STRETCH, _TURNS_ROUND, _IN_PLANE),
    ),
    "Coriolis coupling of bending": (
        "-2 ω c M21 q1'",
        "the carrier turns",
        (_STRETCH, _TURNS_ROUND, _IN_PLANE),
    ),
    "Euler coupling of stretch": ("ω' c M12 q2", "the speed varies", (_STRETCH, _ACCELERATES, _IN_PLANE)),
    "Euler coupling of bending": ("-ω' c M21 q1", "the speed varies", (_STRETCH, _ACCELERATES, _IN_PLANE)),
    "axial damping": ("2 ζ Λ q1'", "the damping ratio is not 0", (_STRETCH, _DAMPED)),
    "centrifugal stretching": ("ω² Q1", "the carrier turns", (_STRETCH, _TURNS_ROUND)),
    "axial root acceleration": ("-aO1 P1", _tension, (_STRETCH, _TENSIONED)),
}
