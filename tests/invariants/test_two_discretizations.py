"""Assumed modes and finite elements give one answer to every question."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER

STEPPED = bd.Beam.rectangular(
    length=0.1,
    width=0.01,
    thickness=bd.Table((0, 0.4, 0.4, 0.7, 1), (4e-4, 4e-4, 3e-4, 3e-4, 2e-4)),
    youngs_modulus=70e9,
    density=2700.0,
    tip=bd.TipMass(2e-4, offset=1e-3, inertia=3e-10),
)
TAPERED = bd.Beam.rectangular(1.0, Polynomial([0.1, -0.05]), lambda x: 0.01 * np.exp(-x), 70e9, 2700.0)
SCENES = {
    "published": (HARVESTER, 50.0),
    "stepped, oblique": (bd.Scene(STEPPED, bd.Mount(0.1, 2.0, 0.7)), 60.0),
    "tapered blade": (bd.Scene(TAPERED, bd.Mount(0.2, np.pi, np.pi / 2)), 80.0),
    "past the critical speed": (HARVESTER, 170.0),
    "with stretch": (bd.Scene(TAPERED, bd.Mount(0.2, np.pi, 0.3), physics=bd.Physics(stretch=True)), 80.0),
    "damped": (bd.Scene(STEPPED, bd.Mount(0.1, np.pi), damping_ratio=0.02), 60.0),
}


@pytest.mark.parametrize("name", SCENES)
def test_same_answer(name: str) -> None:
    scene, speed = SCENES[name]
    ritz, fem = (bd.natural_modes(scene, speed, 3, discretization) for discretization in ("ritz", "fem"))
    np.testing.assert_array_equal(ritz.status, fem.status)
    np.testing.assert_allclose(ritz.eigenvalue, fem.eigenvalue, rtol=1e-6)
    for quantity in ("tip", "load", "angular_load"):  # errors of vectors go like the second power of h
        a, b = getattr(ritz, quantity), getattr(fem, quantity)
        np.testing.assert_allclose(a, b, rtol=1e-4, atol=1e-6 * np.abs(a).max())
    x = np.linspace(0, scene.beam.length, 11)
    np.testing.assert_allclose(ritz.shape(x), fem.shape(x), atol=1e-4 * np.abs(ritz.tip).max())
    if np.isfinite(ritz.static_deflection):
        np.testing.assert_allclose(ritz.static_deflection, fem.static_deflection, rtol=1e-5, atol=1e-15)
    assert (ritz.tip > 0).all()


@pytest.mark.parametrize("name", ["published", "stepped, oblique", "tapered blade"])
def test_same_locus_and_critical_speed(name: str) -> None:
    scene, top = SCENES[name]
    loci = [
        bd.frequency_locus(scene, np.linspace(0, top, 5), 2, discretization)
        for discretization in ("ritz", "fem")
    ]
    np.testing.assert_allclose(loci[0].frequency, loci[1].frequency, rtol=1e-6)
    np.testing.assert_allclose(bd.critical_speed(scene), bd.critical_speed(scene, "fem"), rtol=1e-6)


def test_the_error_of_a_blade_of_many_stations_is_known_of_both() -> None:
    stations = np.linspace(0, 1, 30)
    rough = np.exp(0.1 * np.random.default_rng(1).standard_normal((2, 30)))
    mass, stiffness = (
        bd.Table(stations, 10 ** (-fall * stations) * each) for fall, each in zip((1, 3), rough, strict=True)
    )
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, mass, stiffness), bd.Mount(0.1, np.pi))
    ritz, fem = (bd.natural_modes(scene, 1.0, 4, discretization) for discretization in ("ritz", "fem"))
    assert (np.abs(ritz.frequency / fem.frequency - 1) <= ritz.error + fem.error).all()
    assert fem.error.max() < 1e-5


def test_a_breakpoint_that_changes_nothing_changes_nothing() -> None:
    split = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0, breakpoints=(0.3, 0.55))
    whole = bd.natural_modes(HARVESTER, 50.0)
    parts = bd.natural_modes(bd.Scene(split, HARVESTER.mount), 50.0)
    np.testing.assert_allclose(whole.frequency, parts.frequency, rtol=1e-11)
