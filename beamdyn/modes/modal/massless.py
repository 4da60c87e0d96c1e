"""Coordinates without mass, such as shear against bending where sections have no rotary inertia."""

from __future__ import annotations

import numpy as np

_EPS = np.finfo(float).eps
_MASSLESS = 16 * _EPS  # eigenvalue of a mass matrix, over the largest, that is 0 within rounding


def has_massless(mass: np.ndarray) -> bool:
    """Whether some combination of coordinates has no mass within rounding, for a mass (n, n)."""
    values = np.linalg.eigvalsh(mass)
    return bool(values[0] < _MASSLESS * values[-1])


def condense(mass: np.ndarray, stiffness: np.ndarray) -> np.ndarray:
    """Coordinates (n, r) in which the mass is regular: those without mass follow in equilibrium.

    Neither damping nor gyroscopic terms may act on what has no mass.
    """
    values, V = np.linalg.eigh(mass)
    massless = values < _MASSLESS * values[-1]
    V0, V1 = V[:, massless], V[:, ~massless]
    return V1 - V0 @ np.linalg.solve(V0.T @ stiffness @ V0, V0.T @ stiffness @ V1)
