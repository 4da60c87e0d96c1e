"""What a strip that is bent far is stiffer by: Searle's parameter, and Ashwell's moment."""

import math

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.results.statements import MODEL_ERROR
from beamdyn.modes.model_error.suppressed_camber import tangent_stiffening


def moment(theta, nu):
    """M/(E I kappa), as of the module's docstring, in other words."""
    f = 2 / theta * (math.cosh(theta) - math.cos(theta)) / (math.sinh(theta) + math.sin(theta))
    return (1 - nu**2 * f) / (1 - nu**2)


def test_stiffness_is_the_slope_of_the_moment():
    """Over the curvature, which is as the square of theta."""
    step = 1e-5
    for theta in (0.3, 1.0, 2.5, 6.0):
        slope = sum(s * (theta + s * step) ** 2 * moment(theta + s * step, 0.3) for s in (1, -1))
        slope /= (theta + step) ** 2 - (theta - step) ** 2
        assert float(tangent_stiffening(np.array(theta), 0.3)) == pytest.approx(
            slope, rel=1e-8
        )  # differences


def test_limits_are_the_beam_and_the_plate():
    ends = tangent_stiffening(np.array([1e-3, 1e3]), 0.3)
    assert ends[0] == pytest.approx(1.0, abs=1e-9)  # as theta^4
    assert ends[1] == pytest.approx((1 - 0.09 / 1e3) / (1 - 0.09), rel=1e-12)  # f is 2/theta


def bent(width, nu=0.3):
    beam = bd.Beam.rectangular(0.05, width, 0.0002, 200e9, 7850.0, poissons_ratio=nu)
    mount = bd.Mount(0.215, math.radians(45))
    return bd.natural_modes(bd.Scene(beam, mount, physics=bd.Physics(large_deflection=True)), 100.0)


def said(modes):
    return [w for w in modes.warnings if "Searle" in w]


def test_the_published_strip_says_what_it_is_worth():
    """The facts have 13.7 at the root, of a strip 2 % stiffer."""
    (warning,) = said(bent(0.01))
    assert warning.kind == MODEL_ERROR and warning.value == pytest.approx(13.7, rel=0.05)
    assert "8.1 % stiffer, its frequencies up to 4 % higher" in warning and "assumed" not in warning


def test_a_narrow_strip_says_nothing():
    assert not said(bent(0.001))


def test_a_strip_that_does_not_camber_says_nothing():
    assert not said(bent(0.01, 0.0))


def test_an_assumed_ratio_is_said():
    (warning,) = said(bent(0.01, None))
    assert "with Poisson's ratio 0.3 assumed" in warning
