"""The second method for two planes: its kinematics and energies; beamdyn against its twenty cases."""

from __future__ import annotations

import math
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.integrate import solve_ivp

import beamdyn as bd
from benchmarks.cases.reference.of_two_planes import blade_of_scene
from benchmarks.cases.reference.resolved import known_frequencies
from benchmarks.cases.reference.twisted_beam import Blade, Body, constant, converged, solve
from benchmarks.cases.reference.twisted_beam.cases import blade_of, cases
from benchmarks.cases.reference.twisted_beam.energy import Deflection, spin_energy
from benchmarks.cases.reference.twisted_beam.equations import sections_at
from benchmarks.cases.reference.twisted_beam.mesh import Mesh
from benchmarks.cases.two_planes import scene_of, second_method_cases

RITZ, FEM = 1e-9, 1e-6  # promised relative errors
DIGITS = 5.1e-12  # half a unit of the twelfth digit

CASES = second_method_cases()
by_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
some_cases = pytest.mark.parametrize(  # each fourth; the others are slow
    "case",
    [
        pytest.param(case, marks=[pytest.mark.slow] if k % 4 else [], id=case["name"])
        for k, case in enumerate(CASES)
    ],
)


def frequencies(case: dict[str, Any]) -> np.ndarray:
    return np.array([float(text) for text in case["frequency"]])


# The file and the method --------------------------------------------------------------------------


def test_the_file_has_the_cases_of_the_program():
    written = [{key: value for key, value in case.items() if key != "frequency"} for case in CASES]
    assert written == cases()
    assert len(CASES) == 20


@some_cases
def test_the_file_has_the_frequencies_of_the_program(case):
    squares, _ = converged(blade_of(case), case["gamma"])
    np.testing.assert_allclose(np.sqrt(squares), frequencies(case), rtol=DIGITS)


@some_cases
def test_eigenvalues_are_the_quotients_of_the_energies(case):
    """Exact modes make the quotient stationary: that of a mode in error by 1e-6 is in error by 1e-12."""
    found = solve(blade_of(case), case["gamma"], pieces=4)
    np.testing.assert_allclose(found.squares, found.quotients, rtol=1e-11)


# Kinematics at finite amplitude -------------------------------------------------------------------

# Curvatures about the section's axes and shear angles, as polynomials in x, for two shapes and both together.
CURVATURES = (([0.9, -0.7, 0.5], [0.0]), ([0.2], [-0.4, 1.1]))  # (kappa_2, kappa_3) of each shape
SHEARS = (([0.0, 0.3], [0.1]), ([0.2, -0.1], [-0.15, 0.4]))  # (gamma_2, gamma_3)
TWISTED = Blade(
    mass=Polynomial([1.0, -0.4]),
    twist=Polynomial([0.3, 0.9]),
    rotary=(constant(0.02), Polynomial([0.07, -0.03])),
    hub=0.3,
    bending_angle=0.5,
    body=Body(mass=0.3, offset=0.1, inertia=0.05, transverse=0.09, axial=0.06),
)
MESH = Mesh.make((), 2, 12)
SIDEWAYS = 0.7  # distance of the axis of rotation from the beam's axis, which shall not matter


def shape(coefficients: tuple, weights: np.ndarray) -> list[Polynomial]:
    return [
        sum((w * Polynomial(pair[i]) for w, pair in zip(weights, coefficients, strict=True)), Polynomial(0))
        for i in (0, 1)
    ]


@cache
def frames(*amplitudes: float) -> tuple[np.ndarray, np.ndarray]:
    """Positions and triads (columns) at the nodes and the tip; of curvatures and shears, without torsion."""
    weights = np.array(amplitudes)
    curvatures, shears = shape(CURVATURES, weights), shape(SHEARS, weights)

    def rate(x: float, state: np.ndarray) -> np.ndarray:
        triad = state[3:].reshape(3, 3)
        k2, k3 = (k(x) for k in curvatures)
        g2, g3 = (g(x) for g in shears)
        spin = np.array([[0, -k3, k2], [k3, 0, 0], [-k2, 0, 0]])
        tangent = triad @ [math.sqrt(1 - g2**2 - g3**2), g2, g3]  # the centre line does not stretch
        return np.concatenate([tangent, (triad @ spin).ravel()])

    start = np.concatenate([np.zeros(3), np.eye(3).ravel()])
    x = np.append(MESH.x.ravel(), 1.0)
    run = solve_ivp(rate, (0, 1), start, "DOP853", x, rtol=1e-13, atol=1e-15)
    return run.y[:3].T, run.y[3:].T.reshape(-1, 3, 3)


@cache
def second_moments() -> tuple[np.ndarray, np.ndarray]:
    """In b1, b2, b3: of the sections per length, shape (nodes, 3, 3), and of the body about its centre."""

    def turned(diagonal: np.ndarray, psi: np.ndarray) -> np.ndarray:
        zero, one, c, s = np.zeros_like(psi), np.ones_like(psi), np.cos(psi), np.sin(psi)
        axes = np.stack([one, zero, zero, zero, c, -s, zero, s, c], -1).reshape(*psi.shape, 3, 3)
        return np.einsum("...ik,...k,...jk->...ij", axes, diagonal, axes)

    x, body = MESH.x.ravel(), TWISTED.body
    psi = TWISTED.bending_angle + TWISTED.twist(x)
    sections = turned(np.stack([0 * x, *(f(x) for f in TWISTED.rotary)], -1), psi)
    # moments of inertia about the beam axis, the direction of bending and the axis of bending
    moments = np.array([body.axial, body.transverse, body.inertia])
    return sections, turned(moments.sum() / 2 - moments, np.array(TWISTED.tip_angle))


def energy_of_rotation(amplitude: float) -> float:
    """-1/2 sum over all particles of (X1^2 + X2^2), from the axis of rotation."""
    x, body = MESH.x.ravel(), TWISTED.body
    place, triad = frames(amplitude, amplitude)
    weights = (MESH.steps[:, None] * MESH.weights).ravel()
    sections, tip = second_moments()
    spread = np.concatenate([weights[:, None, None] * sections, tip[None]])
    centres = place + np.array([TWISTED.hub, SIDEWAYS, 0.0])
    centres[-1] += triad[-1] @ [body.offset, 0, 0]
    masses = np.append(weights * TWISTED.mass(x), body.mass)
    about_centres = np.einsum("nik,nkl,nil->", triad[:, :2], spread, triad[:, :2])
    return -float(masses @ (centres[:, :2] ** 2).sum(axis=1) + about_centres) / 2


def second_derivative(h: float) -> float:
    return (energy_of_rotation(h) - 2 * energy_of_rotation(0.0) + energy_of_rotation(-h)) / h**2


def test_energy_of_steady_rotation():
    """Against frames integrated at finite amplitude, extrapolated from two: E23 turns with the sections.

    The remainder is of order h^4 = 1e-7 and of rounding / h^2.
    """
    h = 0.02
    exact = (4 * second_derivative(h / 2) - second_derivative(h)) / 3
    p2, p3 = (sign * k.integ() for sign, k in zip((1, -1), shape(CURVATURES, np.ones(2))[::-1], strict=True))
    slopes = [p + g for p, g in zip((p2, p3), shape(SHEARS, np.ones(2)), strict=True)]
    u = [s.integ() for s in slopes]

    def at_nodes(pair: list[Polynomial]) -> np.ndarray:
        return np.stack([f(MESH.x) for f in pair], -1)

    tip = np.array([f(1.0) for f in (*u, p2, p3)])
    mode = Deflection(
        at_nodes(u), at_nodes(slopes), at_nodes([p2, p3]), at_nodes([p2.deriv(), p3.deriv()]), tip
    )
    section = sections_at(TWISTED, MESH)
    np.testing.assert_allclose(spin_energy(TWISTED, 1.0, MESH, section, mode), exact, rtol=1e-7)


# beamdyn ------------------------------------------------------------------------------------------


@by_case
@pytest.mark.parametrize("discretization", [("ritz", RITZ), (bd.Fem(40), FEM)], ids=["ritz", "fem"])
def test_beamdyn(case, discretization):
    method, rtol = discretization
    expected = frequencies(case)
    found = bd.natural_modes(scene_of(case), case["gamma"], len(expected), method)
    np.testing.assert_allclose(2 * np.pi * found.frequency, expected, rtol=rtol)


def test_a_stiffness_that_falls_fast_is_resolved():
    """EI falls linearly to 1e-6 of its value at mid-span: its reciprocal has a pole 1e-6 beyond that.

    Compared with pieces that become shorter by factors of 1.5, other than those of the reference.  rtol: both
    are known to rounding, 1e-13 of the squared frequency.
    """
    stiffness = bd.Table((0.0, 0.5, 0.5, 1.0), (1.0, 1e-6, 1.0, 1.0))
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, stiffness), bd.Mount(0.1, math.pi, math.pi / 2))
    known = known_frequencies(scene, 1.0, 3)
    assert known.uncertainty.max() <= 1e-12
    blade, unit = blade_of_scene(scene)
    towards_middle = (0.5 - 0.5 * 1.5 ** -np.arange(1, 40)).tolist()
    other = solve(replace(blade, breakpoints=[*towards_middle, 0.5]), unit, 3, 2).squares / unit**2
    np.testing.assert_allclose(-(known.eigenvalue**2).real, other, rtol=1e-12)
