"""Mode shapes of strips over their area."""

from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from numpy.polynomial.legendre import leggauss

import beamdyn as bd
from beamdyn.equations.assembly import assemble_equations

PLATE = bd.Physics(camber=True, torsion=True)
BASIS = bd.Ritz(8)
MOUNT = bd.Mount(0.215)
TAPER = Polynomial([0.012, -0.006])  # width [m] over x/L
X = np.linspace(0, 0.05, 7)
ETA = np.linspace(-1, 1, 5)


def strip(nu=0.3, width: float | Polynomial = 0.01):
    beam = bd.Beam.rectangular(0.05, width, 0.0002, 200e9, 7850.0, poissons_ratio=nu)
    return bd.Scene(beam, MOUNT, physics=PLATE)


@pytest.fixture(scope="module")
def modes():
    return bd.natural_modes(strip(), speed=50.0, modes=4, discretization=BASIS)


def test_the_mean_over_the_width_is_the_shape(modes):
    eta, weights = leggauss(12)
    mean = modes.surface(X, eta) @ weights / 2
    np.testing.assert_allclose(mean, modes.shape(X), rtol=0, atol=1e-12 * np.abs(modes.tip).max())  # rounding


def test_edges_and_axis_are_sums_of_the_functions(modes):
    """Legendre polynomials are 1 or -1 at the edges; those of odd order vanish on the axis."""
    equations, xi = modes.model.equations, X / 0.05
    along = equations.deflections["bending"].space.evaluate(xi)
    edge, axis = 0.0, 0.0
    for name, numbers in {"bending": [0], "torsion": range(1, 40, 2), "camber": range(2, 40, 2)}.items():
        of_each = modes.vectors[equations.blocks[name]].T.reshape(4, -1, len(along))
        for k, q in zip(numbers, of_each.transpose(1, 0, 2), strict=False):
            at_edges, on_axis = np.array([(-1) ** k, 1]), np.polynomial.Legendre.basis(k)(0.0)
            u = np.sqrt(2 * k + 1) * q @ along
            edge, axis = edge + u[:, :, None] * at_edges, axis + u * on_axis
    found = modes.surface(X, [-1.0, 0.0, 1.0])
    size = 1e-12 * np.abs(found).max()  # rounding
    np.testing.assert_allclose(found[:, :, [0, 2]], edge, rtol=0, atol=size)
    np.testing.assert_allclose(found[:, :, 1], axis, rtol=0, atol=size)


def test_without_poissons_ratio_bending_is_that_of_the_beam():
    scene = strip(nu=0.0)
    plain = bd.natural_modes(replace(scene, physics=bd.Physics()), 100.0, 3, discretization=bd.Ritz(14))
    found = bd.natural_modes(scene, 100.0, 4, discretization=bd.Ritz(14))
    beam = np.repeat(plain.shape(X)[:, :, None], len(ETA), axis=2)
    np.testing.assert_allclose(found.surface(X, ETA)[found.kind == "bending"], beam, rtol=0, atol=1e-7)
    np.testing.assert_allclose(plain.surface(X, ETA), beam, rtol=1e-12)  # rounding


@pytest.mark.parametrize("width", [0.01, TAPER])
def test_the_modal_mass_is_one(width):
    """By quadrature of rho t w^2 over the area; torsion has the rotary inertia of the thickness beside it."""
    modes = bd.natural_modes(strip(width=width), modes=4, discretization=BASIS)
    (s, of_x), (eta, of_eta) = leggauss(60), leggauss(20)
    x = 0.025 * (1 + s)
    b = TAPER(x / 0.05) if width is TAPER else np.full(60, width)
    area = np.outer(0.025 * of_x * b / 2, of_eta)
    mass = 7850.0 * 0.0002 * (area * modes.surface(x, eta) ** 2).sum(axis=(1, 2))
    np.testing.assert_allclose(mass, 1.0, rtol=1e-3)  # rho t^3/12 times the squared twist


def test_rotation_turns_an_oblique_strip_into_its_plane():
    """The point at eta = 1, -sin(psi) b2 + cos(psi) b3 from the axis, thus moves against the bending."""
    scene = replace(strip(), mount=bd.Mount(0.215, np.pi, bending_angle=0.5))
    equations = assemble_equations(scene, BASIS)
    pencil = equations.steady()
    q = np.linalg.solve(pencil.K0 + 50.0**2 * pencil.K2, 50.0**2 * pencil.f2)
    left, axis, right = np.tensordot(q, equations.surface(np.ones(1), np.array([-1.0, 0.0, 1.0])), 1)[0]
    assert right < axis < left


@pytest.mark.parametrize(
    ("x", "eta", "name"), [([0.051], [0.0], "x"), ([0.0], [1.1], "eta"), ([0.0], [np.nan], "eta")]
)
def test_places_beside_the_strip_are_refused(modes, x, eta, name):
    with pytest.raises(ValueError, match=f"^{name}"):
        modes.surface(x, eta)
