"""Random scenes with two planes of bending, twist, shear, rotary inertia and springs, in all combinations.

The inputs are in a range that `reference.of_two_planes` solves in seconds.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.equations.mass import axial_tension
from beamdyn.modes.modal.model import Model
from beamdyn.scene.profile import Profile, to_profile
from benchmarks.cases.scenes import time_unit

MOST_TENSION = 1e4  # largest tension, over the smallest EI / L^2
_QUARTER = np.pi / 2
_STEEL = 200e9, 7850.0
_POISSONS_RATIO = 0.3
_FUNCTIONS = 20  # number of trial functions on all segments, for the critical speed


@dataclass(frozen=True)
class Section:
    """A uniform rectangular steel section.

    Parameters
    ----------
    length : float
        Length of the beam [m].
    slenderness : float
        Length over thickness.
    ratio : float
        Second bending stiffness over the first; the width is the square root of this times the thickness.
    """

    length: float
    slenderness: float
    ratio: float

    def properties(self) -> dict[str, float]:
        """Return arguments of `Beam.from_stiffness`; shear stiffness and rotary inertia suit the bending."""
        (E, rho), h = _STEEL, self.length / self.slenderness
        area, nu = h**2 * np.sqrt(self.ratio), _POISSONS_RATIO
        inertia = area * h**2 / 12
        return {
            "mass_per_length": rho * area,
            "bending_stiffness": E * inertia,
            "second_bending_stiffness": E * inertia * self.ratio,
            "shear_stiffness": 10 * (1 + nu) / (12 + 11 * nu) * E / (2 * (1 + nu)) * area,
            "rotary_inertia": rho * inertia,
            "second_rotary_inertia": rho * inertia * self.ratio,
        }


def random_physics_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a scene and a speed up to 0.999 of the critical speed, with any physics except stretch.

    Stiffness ratios 0.05 to 1e4, slenderness 5 to 1000 of the stockier plane where it shears or has rotary
    inertia, springs 1e-6 to 1e6 EI/L, hinges, gamma <= 50.
    """
    scene = random_still_scene(rng)
    return scene, random_speed(rng, scene)


def random_still_scene(rng: np.random.Generator) -> bd.Scene:
    """Draw a scene as `random_physics_scene` does, without a speed; three in four have two planes."""
    planes, shear, rotary = int(rng.integers(1, 3)), bool(rng.integers(2)), bool(rng.integers(2))
    planes = 2 if rng.random() < 0.5 else planes
    beam = random_physics_beam(rng, stocky=shear or rotary)
    mount = random_mount(rng, beam)
    return bd.Scene(beam, mount, physics=bd.Physics(planes, shear=shear, rotary_inertia=rotary))


def random_physics_beam(rng: np.random.Generator, stocky: bool, slenderest: float = 1000.0) -> bd.Beam:
    """Draw a beam: uniform, tapered or by stations; half with a tip body, two of three twisted."""
    length = 10 ** rng.uniform(-2, 1)
    ratio = 10 ** rng.uniform(np.log10(0.05), 4)
    slenderness = 10 ** rng.uniform(np.log10(5), np.log10(slenderest))
    slenderness *= max(1.0, np.sqrt(ratio)) if stocky else 1.0
    section = Section(length, slenderness, ratio).properties()
    vary = (_keep, _taper, _stations)[rng.integers(3)]
    tip = _random_tip(rng, section["mass_per_length"] * length, length) if rng.integers(2) else None
    twist = random_twist(rng) if rng.integers(3) else None
    properties = vary(rng, section)
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", "twist reaches")  # twist by several turns is intended
        return bd.Beam.from_stiffness(length, **properties, tip=tip, twist=twist)


# Variation along the beam -------------------------------------------------------------------------

_POWERS = {  # powers of width and thickness in each property
    "mass_per_length": (1, 1),
    "bending_stiffness": (1, 3),
    "second_bending_stiffness": (3, 1),
    "shear_stiffness": (1, 1),
    "rotary_inertia": (1, 3),
    "second_rotary_inertia": (3, 1),
}


def _keep(rng: np.random.Generator, section: dict[str, float]) -> dict[str, float]:
    return section


def _taper(rng: np.random.Generator, section: dict[str, float]) -> dict[str, Polynomial]:
    """Draw a linear taper of width and thickness, to a fifth at the least."""
    width, thickness = (Polynomial([1.0, -taper]) for taper in rng.uniform(0, 0.8, 2))
    return {name: section[name] * width**a * thickness**b for name, (a, b) in _POWERS.items()}


def _stations(rng: np.random.Generator, section: dict[str, float]) -> dict[str, bd.Table]:
    """Draw properties that are linear between three to six stations; half of the beams have a jump."""
    stations = _random_stations(rng, int(rng.integers(3, 7)), jump=bool(rng.integers(2)))
    width, thickness = rng.uniform(0.5, 1.5, (2, len(stations)))
    return {
        name: bd.Table(stations, (section[name] * width**a * thickness**b).tolist())
        for name, (a, b) in _POWERS.items()
    }


def _random_stations(rng: np.random.Generator, count: int, jump: bool) -> list[float]:
    """Draw stations x/L, at least 1 % apart; for a jump, an inner station is repeated."""
    inner = np.sort(rng.choice(np.arange(1, 100), count - 2, replace=False)) / 100
    twice = rng.choice(inner, 1) if jump else []
    return np.sort(np.concatenate([[0.0, 1.0], inner, twice])).tolist()


def random_twist(rng: np.random.Generator) -> float | Polynomial | bd.Table | Profile:
    """Draw a twist: constant, linear, polynomial, or by stations with kinks and jumps."""
    most = rng.uniform(-1.5, 1.5) if rng.random() < 0.9 else rng.uniform(-20.0, 20.0)
    kind = rng.integers(5)
    if kind == 0:
        return float(most)
    if kind == 1:
        return Polynomial([0.0, most])
    if kind == 2:
        return Polynomial(most * rng.uniform(-1, 1, int(rng.integers(3, 6))))
    stations = _random_stations(rng, int(rng.integers(3, 7)), jump=kind == 4)
    table = bd.Table(stations, (most * rng.uniform(-1, 1, len(stations))).tolist())
    return to_profile("twist", table)


def _random_tip(rng: np.random.Generator, beam_mass: float, length: float) -> bd.TipMass:
    """Draw a tip body of up to ten beam masses, half of them points, with the moments of a cuboid."""
    mass = beam_mass * 10 ** rng.uniform(-3, 1)
    squares = (length * rng.uniform(0, 0.3, 3) * rng.integers(0, 2)) ** 2 * mass / 2
    moments = squares.sum() - squares
    return bd.TipMass(mass, length * rng.uniform(-0.1, 0.2), *moments)


# Mount and speed ----------------------------------------------------------------------------------


def random_mount(rng: np.random.Generator, beam: bd.Beam) -> bd.Mount:
    """Draw a mount in any direction; each plane is clamped, on a spring or, rarely, hinged."""
    unit = float(beam.bending_stiffness(np.zeros(1))[0]) / beam.length
    return bd.Mount(
        beam.length * rng.choice([0.0, rng.uniform(0, 10), 10 ** rng.uniform(-2, 1)]),
        rng.choice([0.0, np.pi, _QUARTER, -_QUARTER, rng.uniform(-np.pi, np.pi)]),
        rng.choice([0.0, _QUARTER, rng.uniform(-np.pi, np.pi)]),
        _random_spring(rng) * unit,
        _random_spring(rng) * unit,
    )


def _random_spring(rng: np.random.Generator) -> float:
    return float(rng.choice([np.inf, 0.0, 10 ** rng.uniform(-6, 6)], p=[0.55, 0.1, 0.35]))


def random_speed(rng: np.random.Generator, scene: bd.Scene) -> float:
    """Draw a speed up to 0.999 critical, gamma = 50 and a tension of `MOST_TENSION`; every tenth is 0."""
    share = rng.choice([0.0, rng.uniform(0, 0.999), 1 - 10 ** rng.uniform(-3, 0)], p=[0.1, 0.45, 0.45])
    gamma = rng.uniform(0, 50)
    fastest = np.sqrt(MOST_TENSION / largest_tension(scene))
    functions = max(6, _FUNCTIONS // (len(scene.beam.breakpoints) - 1))
    critical = Model(scene, bd.Ritz(functions)).solver.critical_speed
    return float(min(gamma / time_unit(scene.beam), share * min(critical, fastest)))


def speed_of_deflection(scene: bd.Scene, ratio: float) -> float:
    """Find the least speed at which the linear tip deflection is a given fraction of the length.

    The speed is at most 0.95 critical, gamma = 50, and that with a tension of `MOST_TENSION`.
    """
    model = Model(scene, bd.Ritz(max(6, _FUNCTIONS // (len(scene.beam.breakpoints) - 1))))
    fastest = np.sqrt(MOST_TENSION / largest_tension(scene))
    top = min(50 / time_unit(scene.beam), fastest, 0.95 * model.solver.critical_speed)
    speeds = top * np.geomspace(1e-4, 1, 400)
    deflection = np.linalg.norm(model.static_tips(speeds), axis=1) / scene.beam.length
    return float(np.interp(ratio, np.maximum.accumulate(deflection), speeds))


def largest_tension(scene: bd.Scene) -> float:
    """Compute the largest tension over the smaller EI / L^2 at unit speed [s^2]."""
    beam, mount, xi = scene.modelled_beam, scene.mount, np.linspace(0, 1, 101)
    stiffnesses = [p for p in (beam.bending_stiffness, beam.second_bending_stiffness) if p is not None]
    n_a, n_b = axial_tension(beam)
    force = n_b(xi) - np.cos(mount.setting_angle) * mount.radius * n_a(xi)
    smallest = np.minimum.reduce([stiffness(xi) for stiffness in stiffnesses])
    return float(np.abs(force / smallest).max()) * beam.length**2
