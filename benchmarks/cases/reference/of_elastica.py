"""Equilibrium and frequencies of a scene by the second method for large deflection."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

import beamdyn as bd
from beamdyn.scene.profile import Profile
from benchmarks.cases.reference.elastica import Answer, Body, Elastica, bent, constant, converged, from_rest
from benchmarks.cases.reference.elastica.beam import Function


@dataclass(frozen=True)
class SceneAnswer:
    """Equilibrium and frequencies of a scene by collocation (`reference.elastica`).

    Parameters
    ----------
    tip
        Position of the tip from the root along b1, b2, b3 [m].
    frequency
        The lowest frequencies [Hz], nan where a mode diverges.
    stable
        Whether no motion about the equilibrium grows.
    change
        Change of the nondimensional answer between the last two meshes.
    """

    tip: np.ndarray
    frequency: np.ndarray
    stable: bool
    change: float


def answer(
    scene: bd.Scene, speed: float, count: int = 3, breakpoints: Sequence[float] | None = None
) -> SceneAnswer:
    """Solve a scene on the branch of equilibria from rest; breakpoints as in `elastica_of_scene`."""
    beam, unit = elastica_of_scene(scene, breakpoints)
    return _dimensional(scene, unit, converged(from_rest(beam, abs(speed) * unit), count))


def bent_answer(scene: bd.Scene, speed: float, side: int = 1, count: int = 3) -> SceneAnswer:
    """Solve a scene on the branch that does not start at rest, with the tip on a given side."""
    beam, unit = elastica_of_scene(scene)
    return _dimensional(scene, unit, converged(bent(beam, abs(speed) * unit, side), count))


def _dimensional(scene: bd.Scene, unit: float, found: Answer) -> SceneAnswer:
    along, sideways = found.tip * scene.beam.length
    c, s = _cosine_and_sine(scene.mount.bending_angle)
    tip = np.array([along, sideways * c, sideways * s])
    return SceneAnswer(tip, found.frequency / (2 * math.pi * unit), found.growth == 0, found.change)


def elastica_of_scene(scene: bd.Scene, breakpoints: Sequence[float] | None = None) -> tuple[Elastica, float]:
    """Return the nondimensional beam (units: length, mass and stiffness at the root), unit of time [s]."""
    beam, mount, length, root = scene.beam, scene.mount, scene.beam.length, np.zeros(1)
    mass, stiffness = (float(p(root)[0]) for p in (beam.mass_per_length, beam.bending_stiffness))
    (along, across), (c, s) = map(_cosine_and_sine, (mount.setting_angle, mount.bending_angle))
    if c * s != 0:
        raise ValueError("the bending angle must be a multiple of 90 deg")
    rotary = beam.rotary_inertia if scene.physics.rotary_inertia else None
    radius = mount.radius / length
    model = Elastica(
        mass=_over(beam.mass_per_length, mass),
        stiffness=_over(beam.bending_stiffness, stiffness),
        rotary=constant(0) if rotary is None else _over(rotary, mass * length**2),
        centre=(radius * along, radius * across * c),
        in_plane=int(c != 0),
        spring=mount.root_stiffness * length / stiffness,
        body=_body(beam.tip, mass, length),
        breakpoints=beam.breakpoints[1:-1] if breakpoints is None else breakpoints,
    )
    return model, length**2 * math.sqrt(mass / stiffness)


def _over(profile: Profile, unit: float) -> Function:
    return lambda x: profile(x) / unit


def _cosine_and_sine(angle: float) -> tuple[float, float]:
    """Compute cosine and sine, exact at multiples of a quarter turn."""
    c, s = math.cos(angle), math.sin(angle)
    return (0.0 if abs(c) < 5e-16 else c), (0.0 if abs(s) < 5e-16 else s)


def _body(tip: bd.TipMass | None, mass: float, length: float) -> Body:
    if tip is None:
        return Body()
    turning = mass * length**3
    spin = tip.inertia_about_bending_direction - tip.axial_inertia
    return Body(tip.mass / (mass * length), tip.offset / length, tip.inertia / turning, spin / turning)
