"""Floquet multipliers against published ones: parametric instability of rotating beams, Mathieu's equation.

The spectral radii were computed by independent 40-digit programs (the lowest modes of clamped-free beams as
basis); Mathieu's characteristic values are eigenvalues of tridiagonal matrices (McLachlan, 1947, chapter 3).
"""

from __future__ import annotations

import numpy as np
import pytest
import scipy.linalg
from scipy.optimize import brentq

import beamdyn as bd

UNIT = bd.Beam.from_stiffness(1.0, 1.0, 1.0)  # time in units of sqrt(rho A L^4 / EI)
OUTWARD, INWARD = bd.Mount(1.0, np.pi), bd.Mount(4.3)
RADII = {  # mean speed, rate of its fluctuation by a tenth, modes: spectral radius
    (2.0, 8.801033599927, 1): 1.05831837461,
    (2.0, 8.801033599927, 3): 1.05793953985,
    (1.0, 4.813763450244, 1): 1.19444284608,
    (1.0, 4.813763450244, 3): 1.19489406127,
}


def pulsating(speed, rate, **scene):
    mount = OUTWARD if speed == 2.0 else INWARD
    return bd.Scene(UNIT, mount, bd.PulsatingRotation(speed, 0.1, rate / (2 * np.pi)), **scene)


@pytest.mark.parametrize("case", RADII, ids=str)
def test_spectral_radii(case):
    speed, rate, modes = case
    found = bd.floquet_multipliers(pulsating(speed, rate), modes)
    assert abs(found.spectral_radius - RADII[case]) < 1e-8
    assert found.status == "unstable"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("speed", "rate", "radius"), [(2.0, 8.801033599927, 1.0579004), (1.0, 4.813763450244, 1.1949582)]
)
def test_spectral_radii_of_many_modes(speed, rate, radius):
    assert abs(bd.floquet_multipliers(pulsating(speed, rate), 12).spectral_radius - radius) < 1e-7


def characteristic_values(order, p, size=60):
    """Values a at which y'' + (a - 2 p cos 2t) y = 0 has periodic solutions: those about a tongue, sorted."""
    even = order % 2 == 0
    k = 2.0 * np.arange(size) + (0 if even else 1)
    diagonal, beside = k**2, np.full(size - 1, p)
    if even:  # cosines, whose first entry counts twice, and sines, which begin with sin 2t
        cosine = scipy.linalg.eigvalsh_tridiagonal(diagonal, np.concatenate([[np.sqrt(2) * p], beside[1:]]))
        sine = scipy.linalg.eigvalsh_tridiagonal(diagonal[1:], beside[1:])
        return sorted([cosine[order // 2], sine[order // 2 - 1]])
    signs = np.concatenate([[p], np.zeros(size - 1)])
    return sorted(
        scipy.linalg.eigvalsh_tridiagonal(diagonal + s * signs, beside)[order // 2] for s in (1, -1)
    )


@pytest.mark.parametrize("tongue", [1, 2, 3, 4])
@pytest.mark.parametrize("p", [0.3, 0.8])
def test_boundaries_of_mathieus_tongues(tongue, p):
    """One mode of a beam that stands still and is shaken along its axis: y'' + (a - 2 p cos 2t) y = 0."""
    first = 2 * np.pi * bd.natural_modes(bd.Scene(UNIT), 0.0, 1).frequency[0]
    per_acceleration = 1.57087819  # of the inward beam, whose tension falls: Southwell's slope per radius
    multiple = 1.0 if tongue % 2 == 0 else -1.0

    def excess(a):
        """Half the trace of the monodromy matrix beyond that on the boundary; 0 where a is characteristic."""
        rate = 2 * first / np.sqrt(a)
        shaken = bd.ShakenCarrier(rate / (2 * np.pi), along_n1=p * rate**2 / (2 * per_acceleration))
        found = bd.floquet_multipliers(bd.Scene(UNIT, motion=shaken), 1)
        return float(np.real(found.multipliers.sum())) / 2 * multiple - 1

    for value in (ends := characteristic_values(tongue, p)):
        near = min(1e-4, 0.25 * np.ptp(ends))  # further, the excess is above rounding in a narrow tongue
        a = brentq(excess, value - near, value + near, xtol=1e-13)
        assert a == pytest.approx(value, rel=1e-8)


def test_limits_that_are_followed_are_mathieus():
    first = bd.natural_modes(bd.Scene(UNIT), 0.0, 1).frequency[0]
    scene = bd.Scene(UNIT, motion=bd.ShakenCarrier(2 * first, along_n1=1.0))
    vary = {
        "motion.frequency": first * np.linspace(1.7, 2.3, 7),
        "motion.along_n1": np.linspace(2.0, 6.0, 3),
    }
    limits = bd.stability_limits(scene, vary, 1)
    assert limits.kinds == ("principal", "principal") and limits.error.max() <= 1e-9
    for frequency, acceleration in limits.place[::5]:
        a = (2 * first / frequency) ** 2
        p = 2 * 1.57087819 * acceleration / (2 * np.pi * frequency) ** 2
        nearest = min(characteristic_values(1, p), key=lambda value: abs(value - a))
        assert a == pytest.approx(nearest, rel=1e-8)  # of the slope, whose digits are as many
