"""Random scenes with every kind of input that a scene has, some at the ends of their ranges."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from benchmarks.cases.random_physics import Section, random_speed

_MATERIALS = ((200e9, 7850.0, 0.3), (70e9, 2700.0, 0.33), (5e9, 1200.0, 0.4))
_PROPERTIES = ("mass_per_length", "bending_stiffness", "second_bending_stiffness", "shear_stiffness")
_INERTIAS = ("rotary_inertia", "second_rotary_inertia")


def random_inputs_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a scene and a speed up to 0.999 critical: any physics, points, damping, twist, precone."""
    planes = int(rng.integers(1, 3))
    effects = [bool(rng.integers(2)) for _ in range(2)]
    physics = bd.Physics(
        planes, shear=effects[0], rotary_inertia=effects[1], stretch=planes == 1 and rng.random() < 0.2
    )
    beam = _beam(rng, planes)
    scene = bd.Scene(beam, _mount(rng, beam), physics=physics)
    speed = random_speed(rng, scene)
    return _damped(rng, scene), speed


# The beam -----------------------------------------------------------------------------------------


def _beam(rng: np.random.Generator, planes: int) -> bd.Beam:
    """Draw a beam: rectangular, constant, tapered or by stations; with tip body, masses and springs."""
    length, slenderness, ratio = (
        10 ** rng.uniform(-2, 1),
        10 ** rng.uniform(1, 2.5),
        10 ** rng.uniform(0.2, 2),
    )
    section = Section(length, slenderness, ratio).properties()
    mass = section["mass_per_length"] * length
    kind = rng.integers(4)
    given: dict[str, Any] = {
        "tip": _tip(rng, mass, length) if rng.integers(2) else None,
        "twist": _twist(rng) if planes == 2 else None,
    } | _points(rng, mass, section["bending_stiffness"], length, planes)
    if kind == 0:
        E, rho, nu = _MATERIALS[rng.integers(len(_MATERIALS))]
        h = length / slenderness
        return bd.Beam.rectangular(length, h * math.sqrt(ratio), h, E, rho, poissons_ratio=nu, **given)
    return bd.Beam.from_stiffness(
        length, **_varied(rng, section, kind), axial_stiffness=_axial(section), **given
    )


def _axial(section: dict[str, float]) -> float:
    return section["mass_per_length"] * 200e9 / 7850.0


def _varied(rng: np.random.Generator, section: dict[str, float], kind: int) -> dict[str, Any]:
    """Draw properties: constant, tapered (each differently), or linear between three stations."""
    if kind == 1:
        return dict(section)
    if kind == 2:
        return {name: value * Polynomial([1.0, -rng.uniform(0, 0.6)]) for name, value in section.items()}
    middle = round(float(rng.uniform(0.3, 0.7)), 2)
    return {
        name: bd.Table([0.0, middle, 1.0], (value * rng.uniform(0.6, 1.4, 3)).tolist())
        for name, value in section.items()
    }


def _tip(rng: np.random.Generator, mass: float, length: float) -> bd.TipMass:
    """Draw a tip body of up to three beam masses; a third of them are points, some have no mass."""
    body = mass * float(rng.choice([0.0, 10 ** rng.uniform(-3, 0.5)], p=[0.2, 0.8]))
    squares = (length * rng.uniform(0.02, 0.2, 3)) ** 2 * body / 2 * (rng.random() < 0.67)
    moments = squares.sum() - squares
    return bd.TipMass(body, length * rng.uniform(-0.1, 0.2), *moments)


def _twist(rng: np.random.Generator) -> Any:
    return (None, float(rng.uniform(-1, 1)), Polynomial([0.0, rng.uniform(-1, 1)]))[rng.integers(3)]


def _points(rng: np.random.Generator, mass: float, stiffness: float, length: float, planes: int) -> dict:
    """Draw up to two point masses and a spring at different positions; one mass in eight is at the tip."""
    count = int(rng.choice([0, 1, 2], p=[0.4, 0.4, 0.2]))
    # Positions at which there is no station.
    places = rng.choice(np.arange(5, 30), count + 1, replace=False) / 31 * length
    if count and rng.random() < 0.125:
        places[0] = length
    masses = [bd.PointMass(float(x), mass * float(_amount(rng, -2, 0))) for x in places[:count]]
    if rng.random() < 0.6:
        return {"point_masses": masses}
    direction = "across" if planes == 2 and rng.integers(2) else "bending"
    spring = bd.PointSpring(float(places[-1]), stiffness / length**3 * float(_amount(rng, -1, 3)), direction)
    return {"point_masses": masses, "point_springs": [spring]}


def _amount(rng: np.random.Generator, least: float, most: float) -> float:
    """Draw a power of ten between two exponents, or in one of eight cases 0."""
    return 0.0 if rng.random() < 0.125 else 10 ** rng.uniform(least, most)


# Mount and damping --------------------------------------------------------------------------------


def _mount(rng: np.random.Generator, beam: bd.Beam) -> bd.Mount:
    """Draw a mount: all directions, precone where allowed; clamped, on a spring or hinged."""
    unit = float(beam.bending_stiffness(np.zeros(1))[0]) / beam.length
    setting = float(rng.choice([0.0, math.pi, math.pi, rng.uniform(-math.pi, math.pi)]))
    springs = [float(rng.choice([math.inf, unit * _amount(rng, -2, 3)], p=[0.6, 0.4])) for _ in range(2)]
    return bd.Mount(
        beam.length * float(_amount(rng, -1, 1)),
        setting,
        float(rng.choice([0.0, math.pi / 2, rng.uniform(-math.pi, math.pi)])),
        *springs,
        precone=float(rng.uniform(-0.6, 0.6)) if setting == math.pi and rng.random() < 0.5 else 0.0,
    )


def _damped(rng: np.random.Generator, scene: bd.Scene) -> bd.Scene:
    """Add no damping, or one or two kinds of it, far from critical."""
    first = 2 * np.pi * float(bd.natural_modes(scene.undamped, 0.0, 3).frequency[-1])
    mass = float(scene.beam.mass_per_length(np.zeros(1))[0]) * scene.beam.length
    kind = rng.integers(6)
    if kind in (1, 2) and (scene.physics.planes == 2 or scene.physics.shear):
        kind += 3  # hundreds of modes at rest in 40 digits would take minutes
    if kind == 1:
        return bd.Scene(scene.beam, scene.mount, physics=scene.physics, damping_ratio=rng.uniform(0.001, 0.1))
    damping = (
        bd.Damping(),
        bd.Damping(),
        bd.Damping(ratios=rng.uniform(0.001, 0.1, 2)),
        bd.Damping(mass_factor=first * 10 ** rng.uniform(-4, -2)),
        bd.Damping(stiffness_factor=10 ** rng.uniform(-3, -1.5) / first, mass_factor=first * 1e-3),
        bd.Damping(tip_damper=mass * first * 10 ** rng.uniform(-4, -2)),
    )[kind]
    return bd.Scene(scene.beam, scene.mount, physics=scene.physics, damping=damping)
