"""A uniform blade without hub, bending out of the plane of rotation: exact and computed eigenvalues."""

from __future__ import annotations

import numpy as np

import beamdyn as bd
from benchmarks.cases.reference.power_series import bending_eigenvalues
from benchmarks.cases.scenes import of_case

UNIFORM_BLADE = of_case(
    {"model": "bending", "delta": 0.0, "bending_angle_deg": 90.0, "mass": [1.0], "stiffness": [1.0]}
)


def exact_eigenvalues(gamma: float) -> np.ndarray:
    """Compute the five lowest |lambda| at a nondimensional speed from the power series."""
    return np.sqrt([float(v) for v in bending_eigenvalues(gamma, 0, np.pi / 2, count=5)])


def computed_eigenvalues(gamma: float, discretization: bd.Ritz, modes: int = 5) -> np.ndarray:
    """Compute the lowest |lambda| by beamdyn."""
    return np.abs(bd.natural_modes(UNIFORM_BLADE, gamma, modes, discretization).eigenvalue)
