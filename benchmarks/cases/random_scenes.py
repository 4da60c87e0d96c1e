"""Random scenes in the range of inputs that the power-series reference solves in seconds."""

from __future__ import annotations

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.equations.mass import axial_tension
from benchmarks.cases.scenes import time_unit

# Young's modulus [Pa] and density [kg/m3] of each material.
_MATERIALS = ((200e9, 7850.0), (70e9, 2700.0), (5e9, 1200.0))
MOST_TENSION = 1e5  # largest tension, over EI / L^2, for which the power series converges in seconds


def random_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a scene of slenderness 20 to 2000, |delta| <= 10, and a speed: gamma <= 50, 0.999 critical.

    The tension is at most 1e5 EI / L^2: above, the power series of the reference takes minutes.
    """
    beam = random_beam(rng)
    mount = bd.Mount(
        radius=beam.length * rng.choice([0.0, rng.uniform(0, 10), 10 ** rng.uniform(-2, 1)]),
        setting_angle=rng.choice([0.0, np.pi, rng.uniform(-np.pi, np.pi)]),
        bending_angle=rng.choice([0.0, np.pi / 2, rng.uniform(-np.pi, np.pi)]),
    )
    scene = bd.Scene(beam, mount)
    share = rng.choice([rng.uniform(0, 0.999), 1 - 10 ** rng.uniform(-3, 0)])
    fastest = MOST_TENSION / largest_tension(scene)
    limits = rng.uniform(0, 50) / time_unit(beam), share * bd.critical_speed(scene), np.sqrt(fastest)
    return scene, float(min(limits))


def largest_tension(scene: bd.Scene) -> float:
    """Compute the largest tension over EI / L^2 at unit speed [s^2]."""
    beam, mount, xi = scene.beam, scene.mount, np.linspace(0, 1, 101)
    n_a, n_b = axial_tension(beam)
    force = n_b(xi) - np.cos(mount.setting_angle) * mount.radius * n_a(xi)
    return float(np.abs(force / beam.bending_stiffness(xi)).max()) * beam.length**2


def random_beam(rng: np.random.Generator) -> bd.Beam:
    """Draw a beam of rectangular section; half of them are tapered, half have a tip body."""
    length = 10 ** rng.uniform(-2, 1)
    thickness = length / 10 ** rng.uniform(np.log10(20), np.log10(2000))
    width = thickness * 10 ** rng.uniform(0.7, 1.5)
    modulus, density = _MATERIALS[rng.integers(len(_MATERIALS))]
    tapers = rng.uniform(0, 0.8, 2) * rng.integers(0, 2)
    sides = [
        Polynomial([side, -taper * side]) for side, taper in zip((width, thickness), tapers, strict=True)
    ]
    mass = density * length * width * thickness
    return bd.Beam.rectangular(length, *sides, modulus, density, tip=random_tip(rng, mass, length))


def random_tip(rng: np.random.Generator, beam_mass: float, length: float) -> bd.TipMass | None:
    """Draw no tip body, or a slender or stout one of up to ten beam masses."""
    if rng.integers(0, 2):
        return None
    mass = beam_mass * 10 ** rng.uniform(-3, 1)
    inertia = mass * (length * rng.uniform(0, 0.3)) ** 2
    return bd.TipMass(mass, length * rng.uniform(0, 0.2), inertia, axial_inertia=inertia * rng.uniform(0, 1))
