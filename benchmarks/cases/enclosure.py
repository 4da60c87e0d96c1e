"""Random nondimensional scenes with exact eigenvalues, and whether guaranteed bounds enclose them."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from mpmath import mpf
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.bounds import FrequencyBounds
from benchmarks.cases.reference.power_series import Tip, bending_eigenvalues


@dataclass(frozen=True)
class NondimensionalScene:
    """A scene of unit length, mass and stiffness with its speed, for beamdyn and for the reference."""

    scene: bd.Scene
    gamma: float
    delta: float
    mass: list[float]
    stiffness: list[float]
    tip: Tip | None

    def exact(self, modes: int) -> list[mpf]:
        """Compute the eigenvalues lambda^2 to 25 digits."""
        psi = self.scene.mount.bending_angle
        return bending_eigenvalues(
            self.gamma, self.delta, psi, self.mass, self.stiffness, self.tip, modes, digits=25
        )


def random_nondimensional_scene(rng: np.random.Generator) -> NondimensionalScene:
    """Draw a scene: uniform or tapered, with or without tip body, inward or outward, some past buckling."""
    taper, delta = _random_taper(rng), round(rng.uniform(-10, 5), 4)
    mass, stiffness = ([1.0, -taper], _power(taper, 3)) if rng.random() < 0.7 else ([1.0], [1.0])
    tip = _random_tip(rng) if rng.random() < 0.5 else None
    body = bd.TipMass(*(float(v) for v in vars(tip).values())) if tip else None
    beam = bd.Beam.from_stiffness(1.0, Polynomial(mass), Polynomial(stiffness), tip=body)
    phi = rng.uniform(-1.2, 1.2) if rng.random() < 0.3 else 0.0
    mount = bd.Mount(
        abs(delta) / math.cos(phi), phi if delta < 0 else math.pi - phi, float(rng.uniform(0, 1.57))
    )
    scene = bd.Scene(beam, mount)
    return NondimensionalScene(scene, _random_speed(rng, scene), delta, mass, stiffness, tip)


def _random_taper(rng: np.random.Generator) -> float:
    return round(rng.uniform(-0.5, 0.85), 3)


def _power(taper: float, exponent: int) -> list[float]:
    """Return coefficients of (1 - taper x)^exponent, rounded to 12 digits, as definition of the beam."""
    return [round(float(c), 12) for c in (Polynomial([1.0, -taper]) ** exponent).coef]


def _random_tip(rng: np.random.Generator) -> Tip:
    mass, offset = round(10 ** rng.uniform(-2, 1), 4), round(rng.uniform(-0.2, 0.3), 3)
    inertia = round(mass * rng.uniform(0, 0.1), 6)
    return Tip(mass, offset, inertia, inertia, round(inertia * rng.uniform(0, 2), 6))


def _random_speed(rng: np.random.Generator, scene: bd.Scene) -> float:
    """Draw a speed up to 12 and six times the critical speed; half of the speeds are near critical."""
    critical = bd.critical_speed(scene)
    near = rng.random() < 0.5 and critical < 12
    return float(critical * rng.uniform(0, 1.5) if near else rng.uniform(0, min(12, 6 * critical)))


def encloses(bounds: FrequencyBounds, exact: list[mpf]) -> np.ndarray:
    """Decide whether each exact value lies between its bounds; a missing (nan) bound excludes nothing."""
    low, high = bounds.lower_squared, bounds.upper_squared
    below = [np.isnan(a) or mpf(float(a)) <= z for a, z in zip(low, exact, strict=True)]
    return np.array(below) & [z <= mpf(float(b)) for b, z in zip(high, exact, strict=True)]


def relative_width(bounds: FrequencyBounds) -> np.ndarray:
    """Compute the relative width of the bounds of the squared frequencies."""
    return (bounds.upper_squared - bounds.lower_squared) / np.abs(bounds.upper_squared)
