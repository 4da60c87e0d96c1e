"""Point masses along the beam, by second methods: shooting, tip bodies, masses smeared over a short length."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.spectrum.bounds import _nondimensional
from beamdyn.spectrum.flexibility import bound_flexibility
from beamdyn.spectrum.split import Split

RITZ, FEM = 1e-9, 1e-6  # promised relative errors

# The beams are nondimensional, of no material.
pytestmark = pytest.mark.filterwarnings(
    "ignore:bending_stiffness:UserWarning", "ignore::beamdyn.common.announced.OutsideLinearTheory"
)


def uniform(*lumps: bd.PointMass, **more: Any) -> bd.Beam:
    """A uniform beam of unit length, mass and stiffness."""
    return bd.Beam.from_stiffness(1.0, 1.0, 1.0, point_masses=lumps, **more)


# A closed form --------------------------------------------------------------------------------------


def characteristic(b: float, place: float, mass: float) -> float:
    """Zero at a wave number b of the uniform cantilever at rest, by functions of A. N. Krylov."""

    def krylov(x: float) -> np.ndarray:
        ch, sh, c, s = math.cosh(b * x), math.sinh(b * x), math.cos(b * x), math.sin(b * x)
        K = np.array([ch + c, sh + s, ch - c, sh - s]) / 2
        return np.array([np.roll(K, k) for k in range(4)])  # derivatives over b^k

    inboard, beyond, outboard = krylov(1.0), krylov(1.0 - place), krylov(place)
    # w = A K_2 + B K_3, whose kinked continuation past the mass is b m w(place) K_3(x - place).
    columns = [
        inboard[2:, k] + b * mass * outboard[0, k] * beyond[2:, 3] for k in (2, 3)
    ]  # second and third derivative at the tip
    return float(np.linalg.det(np.array(columns)))


@pytest.mark.parametrize(("place", "mass"), [(0.5, 1.0), (0.5, 0.01), (0.3, 20.0), (1.0, 2.0)])
def test_uniform_beam_at_rest(place: float, mass: float) -> None:
    scene = bd.Scene(uniform(bd.PointMass(place, mass)))
    for discretization, rtol in (("ritz", RITZ), (bd.Fem(100), FEM)):
        for b in np.sqrt(2 * math.pi * bd.natural_modes(scene, 0.0, 4, discretization).frequency):
            root = brentq(characteristic, b * (1 - 1e-4), b * (1 + 1e-4), (place, mass), xtol=1e-14)
            assert b**2 == pytest.approx(root**2, rel=rtol)
