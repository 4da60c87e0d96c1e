"""Random scenes whose root spring, thickness and tip mass are to be found from their frequencies."""

from __future__ import annotations

import numpy as np

import beamdyn as bd
from beamdyn.common.results.statements import unannounced
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene

STRIP = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
OUTWARD = bd.Scene(STRIP, bd.Mount(radius=0.215, setting_angle=np.pi))
SPEEDS, MODES = np.linspace(0.0, 150.0, 5), 3
STIFFNESS = 200e9 * 0.01 * 0.0002**3 / 12 / 0.05  # unit of the root spring, EI/L [N m/rad]
MASS = 7850.0 * 0.05 * 0.01 * 0.0002  # mass of the strip [kg]


def unknowns(seed: int) -> dict[str, float]:
    """Draw a spring of 0.3 to 30 EI/L, a thickness within 30 %, and a tip body of up to the beam's mass."""
    random = np.random.default_rng(seed)
    return {
        "mount.root_stiffness": STIFFNESS * float(np.exp(random.uniform(np.log(0.3), np.log(30.0)))),
        "beam.thickness": 0.0002 * random.uniform(0.7, 1.3),
        "beam.tip.mass": MASS * random.uniform(0.02, 1.0),
    }


def measured(true: dict[str, float], noise: float = 0.0, seed: int = 0) -> bd.MeasuredFrequencies:
    """Compute three frequencies at five speeds for given values, and add relative noise (normal)."""
    with unannounced():
        exact = bd.frequency_locus(with_numbers(OUTWARD, true), SPEEDS, MODES).frequency
    shown = exact * (1 + noise * np.random.default_rng([seed, 1]).standard_normal(exact.shape))
    return bd.MeasuredFrequencies(shown, SPEEDS, noise * exact if noise else np.nan)


def identify(
    true: dict[str, float], noise: float = 0.0, seed: int = 0, scene: Scene = OUTWARD
) -> bd.Identification:
    """Identify the numbers of a scene from simulated data, without an initial guess."""
    return bd.identify(scene, measured(true, noise, seed), dict.fromkeys(true))
