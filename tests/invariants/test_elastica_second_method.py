"""The second method for large deflection: against its particles, and beamdyn against its answers."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from benchmarks.cases.elastica import CASES, reference_answer
from benchmarks.cases.reference import twisted_beam
from benchmarks.cases.reference.elastica import (
    Body,
    Elastica,
    constant,
    converged,
    critical_speed,
    exponents,
    fold_beside,
    frequencies,
    from_rest,
)
from benchmarks.cases.reference.elastica.equations import Collocation
from benchmarks.cases.reference.elastica.equilibrium import NotFound

RITZ, FEM = 1e-8, 1e-6  # of beamdyn against the second method, which is good to 1e-12

# The second method against particles ------------------------------------------------------------------

GAMMA = 1.7
BODY = Body(mass=0.3, offset=0.1, inertia=0.05, spin=0.02)
IN = Elastica(
    mass=Polynomial([1.0, -0.4]),
    stiffness=Polynomial([1.0, -0.5]),
    rotary=Polynomial([0.03, -0.01]),
    centre=(0.8, -1.1),
    spring=4.0,
    body=BODY,
    breakpoints=(0.3,),
)
OUT = replace(IN, in_plane=0)
by_plane = pytest.mark.parametrize("beam", [IN, OUT], ids=["in the plane", "out of the plane"])


class Particles:
    """Two particles for each node's section, on its normal, and four for the body."""

    def __init__(self, equations: Collocation) -> None:
        self.equations, beam = equations, equations.beam
        self.x, self.weights = equations.mesh.x.ravel(), equations.weights
        self.height = np.sqrt(beam.rotary(self.x) / beam.mass(self.x))
        section = self.weights * beam.mass(self.x) / 2
        self.masses = np.concatenate([section, section, np.full(4, beam.body.mass / 4)])

    def places(self, q: np.ndarray) -> np.ndarray:
        """From the axis of rotation; q as the unknowns, the turn of the root first: shape (2, particles)."""
        equations, body = self.equations, self.equations.beam.body
        ahead = equations.reach[:-1, :-1]
        angle = q[0] + ahead @ q[1:]
        tangent = np.stack([np.cos(angle), np.sin(angle)])
        normal = np.stack([-tangent[1], tangent[0]])
        centre = (ahead @ tangent.T).T
        end_angle = q[0] + self.weights @ q[1:]
        along = np.array([np.cos(end_angle), np.sin(end_angle)])
        aside = np.array([-along[1], along[0]])
        tip = tangent @ self.weights + body.offset * along
        length, breadth = (math.sqrt((body.inertia + s * body.spin) / body.mass) for s in (1, -1))
        arms = [length * along, -length * along, breadth * aside, -breadth * aside]
        sections = [centre + self.height * normal, centre - self.height * normal]
        whole = np.concatenate([*sections, np.stack([tip + arm for arm in arms], axis=1)], axis=1)
        return whole - np.array(self.equations.beam.centre)[:, None]

    def energy(self, q: np.ndarray) -> complex:
        """Of bending, the spring, and rotation."""
        beam = self.equations.beam
        place = self.places(q)
        spin = place[0] ** 2 + beam.in_plane * place[1] ** 2
        bending = self.weights @ (beam.stiffness(self.x) * q[1:] ** 2) + beam.spring * q[0] ** 2
        return (bending - GAMMA**2 * (self.masses @ spin)) / 2

    def slopes(self, q: np.ndarray) -> np.ndarray:
        """Derivatives of the places: shape (2, particles, unknowns)."""
        return np.stack([np.imag(self.places(bumped)) / TINY for bumped in bumps(q)], axis=-1)


TINY = 1e-100


def bumps(q: np.ndarray) -> list[np.ndarray]:
    """For derivatives without a difference: an imaginary part for each unknown."""
    return [q + 1j * TINY * row for row in np.eye(q.size)]


@pytest.fixture(params=[IN, OUT], ids=["in the plane", "out of the plane"])
def bent_far(request: pytest.FixtureRequest) -> tuple[Collocation, np.ndarray, np.ndarray]:
    """The equations, a shape that is no equilibrium, and the weights of the equations."""
    equations = Collocation(request.param, pieces=1, nodes=8)
    x = equations.mesh.x.ravel()
    return equations, np.append(0.3, 1.5 * np.cos(3 * x) + 0.8), np.append(1.0, equations.weights)


def assert_close(found: np.ndarray, expected: np.ndarray) -> None:
    """Rounding: both sum some hundred products."""
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-13 * np.abs(expected).max())


def test_balance_is_the_gradient_of_the_energy_of_particles(bent_far):
    equations, q, weights = bent_far
    particles = Particles(equations)
    gradient = np.array([particles.energy(bumped).imag / TINY for bumped in bumps(q)])
    assert_close(weights * equations.residual(q, GAMMA**2), gradient)


def test_stiffness_is_the_derivative_of_the_balance(bent_far):
    equations, q, _ = bent_far
    expected = np.stack([equations.residual(b, GAMMA**2).imag / TINY for b in bumps(q)], axis=-1)
    assert_close(equations.stiffness(q, GAMMA**2), expected)


def test_inertia_and_coriolis_forces_are_those_of_particles(bent_far):
    """Virtual work of -m (p.. + 2 gamma (Y., -X.)); out of the plane Coriolis forces do none."""
    equations, q, weights = bent_far
    particles = Particles(equations)
    along, across = particles.slopes(q)
    masses, pencil = particles.masses[:, None], equations.pencil(q, GAMMA**2)
    inertia = along.T @ (masses * along) + across.T @ (masses * across)
    assert_close(weights[:, None] * pencil.inertia, inertia)
    half = along.T @ (masses * across)
    gyroscopic = 2 * GAMMA * equations.beam.in_plane * (half - half.T)
    np.testing.assert_allclose(weights[:, None] * pencil.gyroscopic, gyroscopic, rtol=0, atol=1e-13)


# The second method by itself ------------------------------------------------------------------------


@pytest.mark.parametrize("bending", [0.0, math.pi / 2], ids=["in the plane", "out of the plane"])
def test_straight_beam_is_that_of_the_linear_second_method(bending):
    """Another solver of the linear equations, with another state and mesh."""
    mass, stiffness, rotary = Polynomial([1.0, -0.4]), Polynomial([1.0, -0.5]), Polynomial([0.003, -0.001])
    body = twisted_beam.Body(0.3, 0.1, inertia=0.05, transverse=0.06, axial=0.04)
    linear = twisted_beam.Blade(
        mass, (stiffness, constant(1)), rotary=(rotary, constant(0)), hub=0.7, planes=1, body=body,
        bending_angle=bending, springs=(6.0, math.inf), breakpoints=(0.3,),
    )  # fmt: skip
    beam = Elastica(
        mass, stiffness, rotary, (-0.7, 0.0), int(bending == 0), 6.0,
        Body(0.3, 0.1, 0.05, 0.06 - 0.04), (0.3,),
    )  # fmt: skip
    expected = np.sqrt(twisted_beam.converged(linear, 4.0, 3)[0])
    np.testing.assert_allclose(converged(from_rest(beam, 4.0)).frequency, expected, rtol=1e-11)


def test_exponents_about_a_stable_equilibrium_are_imaginary():
    """No damping, no growth: nothing in the collocated equations makes them so."""
    found = exponents(from_rest(IN, GAMMA), 6)
    assert np.abs(found.real).max() < 1e-11 * np.abs(found).min()


def test_frequency_vanishes_at_the_fold():
    """To the root of a square that is rounding."""
    beam = Elastica(centre=(4.3 * math.cos(0.1), 4.3 * math.sin(0.1)))
    lowest = fold_beside(beam, side=1)
    assert np.abs(exponents(lowest, 1))[0] < 1e-5
    with pytest.raises(NotFound, match="straight"):
        critical_speed(beam)


@by_plane
def test_frequencies_of_mirror_images_are_the_same(beam):
    mirrored = replace(beam, centre=(beam.centre[0], -beam.centre[1]))
    one, other = (from_rest(b, GAMMA) for b in (beam, mirrored))
    np.testing.assert_allclose(one.tip * [1, -1], other.tip, atol=1e-13)
    np.testing.assert_allclose(frequencies(one), frequencies(other), rtol=1e-11)


def test_there_are_strong_and_moderate_deflections_among_the_cases():
    across = [abs(reference_answer(k).tip[1:]).max() / case.scene.beam.length for k, case in enumerate(CASES)]
    assert len(CASES) >= 20
    assert sum(value > 0.7 for value in across) >= 5
    assert sum(0.05 < value < 0.4 for value in across) >= 5


# beamdyn ------------------------------------------------------------------------------------------


def some(every: int) -> list:
    """The places of the cases, each but the `every`-th marked as slow."""
    return [
        pytest.param(k, marks=[pytest.mark.slow] if k % every else [], id=case.name)
        for k, case in enumerate(CASES)
    ]


def assert_frequencies(number: int, method: Any, rtol: float) -> None:
    case, expected = CASES[number], reference_answer(number).frequency
    found = bd.natural_modes(case.scene, case.speed, expected.size, method)
    np.testing.assert_allclose(found.frequency, expected, rtol=rtol)


by_case = pytest.mark.parametrize("number", some(1))


@by_case
def test_frequencies_of_beamdyn(number):
    assert_frequencies(number, "ritz", RITZ)


@pytest.mark.parametrize("number", some(4))
def test_frequencies_of_beamdyn_by_elements(number):
    # A wedge's third mode has 3.6e-6 with 40 elements; the promise is of at most 100.
    elements = 80 if CASES[number].name == "wedge at 45 deg" else 40
    assert_frequencies(number, bd.Fem(elements), FEM)


@by_case
def test_equilibria_of_beamdyn(number):
    """Of a symmetric scene, bent to either side."""
    case, expected = CASES[number], reference_answer(number)
    found = bd.equilibrium(case.scene, case.speed)
    assert found.stable == expected.stable
    mirrored = (case.bent_to and case.setting in (0, 180)) or case.bending in (90, -90)
    compare = np.abs if mirrored else np.asarray
    np.testing.assert_allclose(
        compare(found.tip), compare(expected.tip), rtol=0, atol=RITZ * case.scene.beam.length
    )
