"""Frequencies of a scene by the second method: its profiles as plain functions, made nondimensional."""

from __future__ import annotations

import math

import numpy as np

import beamdyn as bd
from beamdyn.scene.profile import Profile
from benchmarks.cases.reference.twisted_beam import Blade, Body, constant, converged
from benchmarks.cases.reference.twisted_beam.blade import Function, Pair
from benchmarks.cases.reference.twisted_beam.coned import coned_frequencies


def squared_frequencies(
    scene: bd.Scene, speed: float, count: int = 3, rtol: float = 1e-12
) -> tuple[np.ndarray, float]:
    """The lowest lambda^2 [1/s^2] of a scene without stretch and damping, and how far two meshes differ."""
    blade, unit = blade_of_scene(scene)
    squares, change = converged(blade, speed * unit, count, rtol)
    return squares / unit**2, change


def coned_frequencies_of(
    scene: bd.Scene, speed: float, count: int = 3, rtol: float = 1e-10
) -> tuple[np.ndarray, float]:
    """The lowest angular frequencies [rad/s] of a scene with precone, and how far two meshes differ."""
    blade, unit = blade_of_scene(scene)
    found, change = coned_frequencies(blade, speed * unit, count, rtol)
    return found / unit, change


def blade_of_scene(scene: bd.Scene) -> tuple[Blade, float]:
    """The blade over length, and mass and stiffness at the root; and its unit of time [s]."""
    beam, mount, physics = scene.beam, scene.mount, scene.physics
    length, root = beam.length, np.zeros(1)
    mass, stiffness = (float(p(root)[0]) for p in (beam.mass_per_length, beam.bending_stiffness))

    def pair(name: str, unit: float, default: float, modelled: bool = True) -> Pair:
        first, second = (getattr(beam, key) if modelled else None for key in (name, f"second_{name}"))
        return _over(first, unit, default), _over(second, unit, default)

    stiff = pair("shear_stiffness", stiffness / length**2, math.inf, physics.shear)
    blade = Blade(
        mass=_over(beam.mass_per_length, mass, 1.0),
        stiffness=pair("bending_stiffness", stiffness, 1.0),
        twist=_over(beam.twist if physics.planes == 2 else None, 1.0, 0.0),
        flexibility=(_inverse(stiff[0]), _inverse(stiff[1])),
        rotary=pair("rotary_inertia", mass * length**2, 0.0, physics.rotary_inertia),
        hub=0.0 if _right_angle(mount) else -math.cos(mount.setting_angle) * mount.radius / length,
        bending_angle=mount.bending_angle,
        springs=(mount.root_stiffness * length / stiffness, mount.second_root_stiffness * length / stiffness),
        body=_body(beam.tip, mass, length),
        planes=physics.planes,
        breakpoints=beam.breakpoints[1:-1],
        precone=mount.precone,
    )
    return blade, length**2 * math.sqrt(mass / stiffness)


def _over(profile: Profile | None, unit: float, default: float) -> Function:
    return constant(default) if profile is None else lambda x: profile(x) / unit


def _inverse(function: Function) -> Function:
    return lambda x: 1 / function(x)


def _right_angle(mount: bd.Mount) -> bool:
    return abs(math.cos(mount.setting_angle)) < 2e-16


def _body(tip: bd.TipMass | None, mass: float, length: float) -> Body:
    if tip is None:
        return Body()
    inertias = (tip.inertia, tip.inertia_about_bending_direction, tip.axial_inertia)
    return Body(tip.mass / (mass * length), tip.offset / length, *(j / (mass * length**3) for j in inertias))
