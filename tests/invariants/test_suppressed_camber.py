"""What a strip that is bent far is stiffer by: Searle's parameter, and the energy of a cross-section."""

import math

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.results.statements import MODEL_ERROR
from beamdyn.modes.model_error.sharp_bending import tangent_stiffening


def by_cross_section(searle, nu):
    """U/(E I kappa^2/2) of a unit strip by the equation of its cross-section, with free edges.

    D d4w/dy4 + E t kappa^2 w = 0, at the edges d2w/dy2 = -nu kappa and d3w/dy3 = 0; by collocation with
    Chebyshev polynomials.
    """
    kappa, n, D = searle, 60, 1 / (12 * (1 - nu**2))
    basis = [np.polynomial.Chebyshev.basis(k, domain=[-0.5, 0.5]) for k in range(n)]
    inner = -0.5 * np.cos(np.pi * np.arange(1, n - 3) / (n - 3))
    rows = [[D * f.deriv(4)(y) + kappa**2 * f(y) for f in basis] for y in inner]
    edges = [[f.deriv(order)(y) for f in basis] for order in (2, 3) for y in (-0.5, 0.5)]
    right = [0.0] * len(rows) + [-nu * kappa] * 2 + [0.0] * 2
    w = np.polynomial.Chebyshev(np.linalg.solve([*rows, *edges], right), [-0.5, 0.5])
    y, weights = np.polynomial.legendre.leggauss(80)
    across = w.deriv(2)(y / 2)
    bending = D * (kappa**2 + 2 * nu * kappa * across + across**2)
    stretching = kappa**2 * w(y / 2) ** 2
    return weights @ (bending + stretching) / 2 / (kappa**2 / 12)


@pytest.mark.slow
@pytest.mark.parametrize("nu", [0.3, 0.45])
@pytest.mark.parametrize("searle", [1.0, 3.0, 10.0])
def test_stiffness_is_that_of_the_cross_section(searle, nu):
    """The second derivative of the energy over the curvature, by differences."""
    step = 1e-2 * searle
    energy = [(searle + s) ** 2 / 2 * by_cross_section(searle + s, nu) for s in (-step, 0.0, step)]
    stiffness = (energy[0] - 2 * energy[1] + energy[2]) / step**2
    theta = np.array((3 * (1 - nu**2)) ** 0.25 * math.sqrt(searle))
    assert float(tangent_stiffening(theta, nu)) == pytest.approx(stiffness, rel=1e-5)  # differences


def test_limits_are_the_beam_and_the_plate():
    ends = tangent_stiffening(np.array([1e-3, 1e3]), 0.3)
    assert ends[0] == pytest.approx(1.0, abs=1e-9)  # as theta^4
    assert ends[1] == pytest.approx((1 - 0.09 * 0.75 / 1e3) / (1 - 0.09), rel=1e-9)  # h is 1


def scene(width, nu=0.3, **more):
    beam = bd.Beam.rectangular(0.05, width, 0.0002, 200e9, 7850.0, poissons_ratio=nu)
    mount = bd.Mount(0.215, math.radians(45))
    return bd.Scene(beam, mount, physics=bd.Physics(large_deflection=True), **more)


def bent(width, nu=0.3):
    return bd.natural_modes(scene(width, nu), 100.0)


def said(modes):
    return [w for w in modes.warnings if "Searle" in w]


def test_the_published_strip_says_what_it_is_worth():
    """The facts have 13.7 at the root, of a strip 2 % stiffer."""
    (warning,) = said(bent(0.01))
    assert warning.kind == MODEL_ERROR and warning.value == pytest.approx(13.7, rel=0.05)
    assert "8.3 % stiffer, its frequencies up to 4.1 % higher" in warning and "assumed" not in warning


def test_the_equilibrium_says_the_same():
    assert said(bd.equilibrium(scene(0.01), 100.0)) == said(bent(0.01))


def test_a_transient_says_it_of_the_time_at_which_it_is_bent_most():
    """Released straight, the beam swings past the equilibrium, about twice as far."""
    wheel = bd.RollingWheel(0.3, 100.0)
    (warning,) = said(bd.simulate(scene(0.01, motion=wheel), 0.02, tolerance=1e-3))
    assert warning.startswith("at 0.0") and " s the strip is bent to" in warning
    assert 1.2 * 13.7 < warning.value < 3 * 13.7


def test_a_narrow_strip_says_nothing():
    assert not said(bent(0.001))
    assert not said(bd.equilibrium(scene(0.001), 100.0))


def test_a_strip_that_does_not_camber_says_nothing():
    assert not said(bent(0.01, 0.0))


def test_an_assumed_ratio_is_said():
    (warning,) = said(bent(0.01, None))
    assert "with Poisson's ratio 0.3 assumed" in warning


def test_bending_past_linear_elasticity_is_told_by_modes_equilibrium_and_transient():
    """The strain of the outer fibre is kappa t/2, as far as Searle's parameter b^2 kappa/t tells kappa."""
    answers = [
        bd.natural_modes(scene(0.01), 300.0, 1),
        bd.equilibrium(scene(0.01), 300.0),
        bd.simulate(scene(0.01, motion=bd.RollingWheel(0.3, 300.0)), 0.005, tolerance=1e-2),
    ]
    for answer in answers:
        (strain,) = (w for w in answer.warnings if "linearly elastic" in w)
        (searle,) = said(answer)
        assert strain.value == pytest.approx(searle.value * 0.0002**2 / 2 / 0.01**2, rel=1e-9)
        assert strain.startswith(searle.split(" the strip")[0] + " the strain reaches 0.0")
    assert not any("linearly elastic" in w for w in bd.equilibrium(scene(0.01), 50.0).warnings)
