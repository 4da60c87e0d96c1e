"""Random beams in space with large deflection, twist, sweep, shear, stretch and offsets, at any angles."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd

_OFF = 0.4  # fraction of the scenes that lack an effect


def random_space_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a beam of unit length, mass and first bending stiffness, and a speed."""

    def maybe(value: object) -> object:
        return value if rng.random() > _OFF else None

    slender = 10 ** rng.uniform(-2.5, -1.5)  # radius of gyration over the length
    wide, softness = 10 ** rng.uniform(0, 1.2), 10 ** rng.uniform(-0.5, 0.5)
    taper = 1.0 - rng.uniform(0, 0.9)
    thinner = Polynomial([1.0, taper - 1.0])
    beam = bd.Beam.from_stiffness(
        1.0,
        thinner,
        thinner,
        second_bending_stiffness=wide * thinner,
        torsion_stiffness=softness * thinner,
        rotary_inertia=slender**2 * thinner,
        second_rotary_inertia=wide * slender**2 * thinner,
        axial_stiffness=slender**-2 * thinner,
        shear_stiffness=0.3 * slender**-2 * thinner,
        twist=maybe(Polynomial([0.0, rng.uniform(-3, 3)])),
        sweep=maybe(Polynomial([0.0, rng.uniform(-0.8, 0.8)])),
        prebend=maybe(Polynomial([0.0, rng.uniform(-0.8, 0.8)])),
        mass_offset=maybe(rng.uniform(-2, 2) * slender),
        tension_offset=maybe(rng.uniform(-2, 2) * slender),
        tip=maybe(bd.TipMass(rng.uniform(0, 0.5), rng.uniform(0, 0.1), 1e-3, 1e-3, 1e-3)),
    )  # pyright: ignore[reportArgumentType]
    mount = bd.Mount(rng.uniform(0, 1), rng.uniform(0.3, 1) * np.pi, rng.uniform(0, np.pi / 2))
    stiff = bool(rng.random() < _OFF)
    physics = bd.Physics(
        2, shear=not stiff, rotary_inertia=True, stretch=not stiff, torsion=True, large_deflection=True
    )
    return bd.Scene(beam, mount, physics=physics), float(rng.uniform(0, 10))
