"""Random beams with a body at the tip on fast carriers, whose modes live in short layers at the ends."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.modal.model import Model

# Ends x/L of the reference's segments, each with its trial functions: end layers are as short as 1e-3.
_PLACES = (0.003, 0.02, 0.1, 0.9, 0.98, 0.997)
_FEWEST, _MOST = 10, 80  # least and largest number of trial functions of the reference on each segment
MOST_GAMMA = 3000.0  # largest speed, over sqrt(EI / (rho A L^4)) at the root
_EPS = np.finfo(float).eps


def random_tip_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw a scene of unit length, mass and stiffness at the root, and a speed up to 0.999 critical."""
    wide, thick = (Polynomial([1.0, -taper]) for taper in rng.uniform(0, 0.8, 2) * rng.integers(0, 2, 2))
    beam = bd.Beam.from_stiffness(1.0, wide * thick, wide * thick**3, tip=_random_body(rng))
    radius = rng.choice([0.0, rng.uniform(0, 10), 10 ** rng.uniform(-2, 1)])
    setting = rng.choice([0.0, np.pi, rng.uniform(-np.pi, np.pi)])
    bending = rng.choice([0.0, np.pi / 2, rng.uniform(-np.pi, np.pi)])
    scene = bd.Scene(beam, bd.Mount(radius, setting, bending))
    share = rng.choice([0.0, rng.uniform(0, 0.999), 1 - 10 ** rng.uniform(-3, 0)], p=[0.05, 0.35, 0.6])
    gamma = rng.choice([rng.uniform(0, 50), 10 ** rng.uniform(0, np.log10(MOST_GAMMA))])
    return scene, float(min(gamma, share * reference_critical_speed(scene, 1e-4)[0]))


def _random_body(rng: np.random.Generator) -> bd.TipMass:
    """Draw a tip body of up to twenty beam masses; half of them are points, a fifth have no offset."""
    mass, size = 10 ** rng.uniform(-3, 1.3), rng.uniform(0, 0.3, 3) * rng.integers(0, 2)
    squares = mass * size**2 / 2
    offset = rng.choice([-1, 1]) * 10 ** rng.uniform(-3, -0.7) * rng.choice([0, 1], p=[0.2, 0.8])
    return bd.TipMass(mass, offset, *(squares.sum() - squares))


def reference_frequencies(
    scene: bd.Scene, speed: float, modes: int, accuracy: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Compute squared angular frequencies, and their relative uncertainties: shape (k,) each.

    The number of trial functions is doubled until frequencies have a relative `accuracy`, or to rounding.
    """
    found = []
    for functions in _doubled():
        eigen = _refined(scene, functions).solver.solve(np.array([speed]), modes)
        squared = np.real(-(eigen.eigenvalue[0] ** 2))
        found.append(squared)
        uncertainty = eigen.rounding[0] + (np.abs(found[-1] / found[-2] - 1) if len(found) > 1 else np.inf)
        if (uncertainty <= accuracy).all():
            break
    return squared, uncertainty


def reference_critical_speed(scene: bd.Scene, accuracy: float) -> tuple[float, float]:
    """Compute the critical speed, inf if there is none, and its relative uncertainty."""
    last = np.nan
    for functions in _doubled():
        solver = _refined(scene, functions).solver
        speed = solver.critical_speed
        uncertainty = abs(speed / last - 1) + solver.critical_rounding if np.isfinite(speed) else 0.0
        if uncertainty <= accuracy and not np.isnan(last):
            break
        last = speed
    return speed, uncertainty


def _doubled() -> list[int]:
    return [_FEWEST * 2**k for k in range(int(np.log2(_MOST / _FEWEST)) + 1)]


def _refined(scene: bd.Scene, functions: int) -> Model:
    """Build the scene's model by assumed modes, on segments that shrink towards both ends."""
    beam = scene.beam
    ends = (0.0, *_PLACES, 1.0)
    split = replace(
        beam,
        mass_per_length=beam.mass_per_length.split(ends),
        bending_stiffness=beam.bending_stiffness.split(ends),
    )
    return Model(replace(scene, beam=split), bd.Ritz(functions))
