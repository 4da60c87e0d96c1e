"""The beam in space: closed forms, and published static cases, converged."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scipy.optimize import brentq, minimize_scalar
from scipy.special import jv

import beamdyn as bd
from beamdyn.equations.beam_in_space.bent_beam import STRAINS
from beamdyn.equations.beam_in_space.tip_forces import TipForces
from benchmarks.cases.beams_in_space import (
    BENDING,
    E1,
    E3,
    bend,
    bend_of_45_deg,
    flutter_load,
    helix,
    lateral_buckling_load,
    uniform,
)

CLOSED = 1e-9
WEAK = 1e-6  # stiffness of a deep section across, and in torsion [N m2]


def test_pure_bending_closes_a_circle() -> None:
    stiffness = 2.0
    beam = uniform(1.5, np.diag([1, 1, 1, 1, 1, stiffness]), ("curvature",))
    bent = bend(beam, TipForces(couple=2 * np.pi * stiffness / 1.5 * E3))
    np.testing.assert_allclose(bent.tip, 0.0, atol=CLOSED)
    np.testing.assert_allclose(bent.rotations[..., -1], np.eye(3), atol=CLOSED)


@pytest.mark.parametrize("torsion", [2.0, 1.2], ids=["one stiffness", "torsion softer"])
def test_oblique_couple_bends_to_a_helix(torsion: float) -> None:
    stiffness, couple = 2.0, 12.0 * (np.cos(0.5) * E1 + np.sin(0.5) * E3)
    beam = uniform(1.0, np.diag([1, 1, 1, torsion, stiffness, stiffness]), BENDING, functions=16)
    bent = bend(beam, TipForces(couple=couple), steps=12)
    np.testing.assert_allclose(bent.tip, helix(1.0, stiffness, couple), atol=CLOSED)
    twist, *curvature = bent.strains[3:]
    np.testing.assert_allclose(twist, 12 * np.cos(0.5) / torsion, rtol=1e-8)  # at single points
    np.testing.assert_allclose(np.hypot(*curvature), 12 * np.sin(0.5) / stiffness, rtol=1e-8)


@pytest.mark.parametrize(
    ("torsion", "strains", "converged"),
    [  # digits printed: by a boundary-value problem of its own
        (1 / 6, STRAINS, [-23.5602, -13.6045, 53.4749]),
        (1 / 6, BENDING, [-23.559, -13.604, 53.469]),
        (0.14058, STRAINS, [-23.819, -13.732, 53.607]),
    ],
    ids=["extensible, J = 1/6", "inextensible, J = 1/6", "extensible, J of the square"],
)
def test_bend_of_45_deg(torsion: float, strains: tuple[str, ...], converged: list[float]) -> None:
    digits = 0.51e-4 if strains is STRAINS and torsion == 1 / 6 else 0.51e-3
    np.testing.assert_allclose(bend_of_45_deg(torsion, strains), converged, rtol=0, atol=digits)


def test_lateral_buckling() -> None:
    exact = 2 * float(brentq(lambda x: jv(-0.25, x), 1.8, 2.2, xtol=1e-14))
    assert exact == pytest.approx(4.0126, abs=5e-5)
    assert lateral_buckling_load() == pytest.approx(exact, rel=CLOSED)


def deep_blade(bending: float, radius: float) -> bd.Scene:
    """A blade whose far carrier pushes it, evenly, in its stiff direction."""
    beam = bd.Beam.from_stiffness(
        1.0,
        1.0,
        bending,
        second_bending_stiffness=WEAK,
        torsion_stiffness=0.7 * WEAK,
        rotary_inertia=1e-9,
        second_rotary_inertia=1e-9,
    )
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    return bd.Scene(beam, bd.Mount(radius, np.pi / 2), physics=physics)


def test_lateral_buckling_of_a_blade_that_its_carrier_pushes() -> None:
    """Under an even load, w L^3 = 12.854 sqrt(EI GJ): Timoshenko and Gere, Theory of Elastic Stability."""
    exact = 6 * float(brentq(lambda x: jv(-1 / 6, x), 2.0, 2.3, xtol=1e-14))
    assert exact == pytest.approx(12.85, abs=0.005)
    radius = 1e8  # what the pull along the beam changes is of the order of L over it
    found = bd.critical_point(deep_blade(100.0, radius))
    assert found.speed**2 * radius / (np.sqrt(0.7) * WEAK) == pytest.approx(exact, rel=1e-7)
    assert found.error < 1e-7
    below, above = (bd.natural_modes(found.scene, k * found.speed, 1) for k in (1 - 1e-5, 1 + 1e-5))
    assert not np.real(below.eigenvalue).any() and np.real(above.eigenvalue).any()
    shallow = bd.critical_point(deep_blade(WEAK, 1.0), bd.Ritz(6))
    assert shallow.speed == np.inf and shallow.none_below > 100 * np.sqrt(WEAK)


def test_a_mesh_finds_the_speed_at_which_a_deep_strip_buckles_sideways() -> None:
    """Beside shooting on the equations of a thin rod: 55.0792778863 rad/s.

    The base is the elastica in the plane of rotation, on it small deflection across, tilt and twist with the
    pull of twisted fibres and the centrifugal moments of twisted and tilted sections.
    """
    strip = bd.Beam.rectangular(0.3, 0.02, 0.0005, 200e9, 7850.0, poissons_ratio=0.3)
    physics = bd.Physics(2, torsion=True, large_deflection=True)
    scene = bd.Scene(strip, bd.Mount(0.2, np.pi / 2, np.pi / 2), physics=physics)
    exact = 525.9683602936 * np.pi / 30
    basis, mesh = bd.critical_point(scene), bd.critical_point(scene, bd.Fem(20))
    assert basis.speed == pytest.approx(exact, rel=1e-9)
    assert mesh.speed == pytest.approx(exact, rel=1e-5)  # coordinates of short elements once hid the sign
    assert abs(mesh.speed / exact - 1) < mesh.error < 3e-4
    unknown = basis.left_out_effects.not_known
    assert {"shear deformation", "stretch"} <= set(unknown)


def frequency_equation(load: float, frequency: float) -> float:
    """Zero where a beam of unit length, stiffness and mass under a load that follows it vibrates (Beck)."""
    root = np.hypot(load / 2, frequency)
    a, b = np.sqrt(root + load / 2), np.sqrt(root - load / 2)
    waves = load * frequency * np.sin(a) * np.sinh(b) + 2 * frequency**2 * np.cos(a) * np.cosh(b)
    return float(load**2 + 2 * frequency**2 + waves)


def test_flutter_under_a_load_that_follows() -> None:
    def least(load: float) -> float:  # between the first two frequencies, which meet where it is 0
        between = minimize_scalar(
            lambda w: frequency_equation(load, w), bounds=(8, 14), method="bounded", options={"xatol": 1e-9}
        )
        return float(between.fun)

    exact = float(brentq(least, 19.5, 20.5, xtol=1e-12))
    assert exact == pytest.approx(20.0509, rel=1e-5)  # as printed, cut off
    assert flutter_load() == pytest.approx(exact, rel=CLOSED)


# Loads at the tip of scenes -------------------------------------------------------------------------

UNIT = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
OUTWARD, PLANAR = bd.Mount(setting_angle=np.pi), bd.Physics(large_deflection=True)


def loaded(*force: float, **others: Any) -> bd.Scene:
    """A beam of unit length, stiffness and mass under a force at its tip."""
    return bd.Scene(UNIT, OUTWARD, physics=PLANAR, tip_load=bd.TipLoad(force, **others))


def test_modes_under_a_load_that_follows_flutter() -> None:
    """At 20.0509 (Beck) the first two frequencies meet, and beyond one of the two modes grows."""

    def squared_distance(load: float) -> float:
        found = bd.natural_modes(loaded(-load, 0.0, 0.0, follows=True), 0.0, 2, bd.Ritz(12))
        first, second = found.eigenvalue**2
        return float(((first - second) ** 2).real)

    found = float(brentq(squared_distance, 15.0, 25.0, xtol=1e-10))
    assert found == pytest.approx(20.0509, rel=1e-5)
    assert found == pytest.approx(flutter_load(), rel=1e-9)
    below, beyond = (bd.natural_modes(loaded(-P, 0.0, 0.0, follows=True), modes=2) for P in (20.05, 20.06))
    assert not below.growth_rate.any() and beyond.growth_rate[0] == pytest.approx(-beyond.growth_rate[1])
    assert "growing mode" in beyond.warnings[0]


def test_a_dead_load_along_the_beam_buckles_it() -> None:
    """Euler's column, pi^2/4, at rest; the rotation of an outward beam then holds it."""
    exact = np.pi**2 / 4
    below, beyond = (bd.natural_modes(loaded(-P, 0.0, 0.0), modes=1) for P in (exact - 1e-6, exact + 1e-6))
    assert not below.growth_rate.any() and beyond.growth_rate[0] > 0
    assert bd.critical_point(loaded(-exact - 1e-6, 0.0, 0.0), bd.Ritz(10)).speed == 0.0
    assert bd.critical_point(loaded(-exact + 1e-6, 0.0, 0.0), bd.Ritz(10)).speed == np.inf


@pytest.mark.parametrize(
    ("load", "along", "across"),
    [(1.0, 0.05643, 0.30172), (5.0, 0.38763, 0.71379), (10.0, 0.55500, 0.81061)],
)
def test_a_cantilever_under_a_load_across_it(load: float, along: float, across: float) -> None:
    """By elliptic integrals, as printed: Mattiasson (1981), Int. J. Numer. Meth. Engng 17, 145-153."""
    tip = bd.equilibrium(loaded(0.0, load, 0.0), 0.0).tip
    np.testing.assert_allclose(tip, [1 - along, across, 0.0], rtol=0, atol=0.51e-5)


def test_a_moment_at_the_tip_of_a_scene_closes_a_circle() -> None:
    for follows in (False, True):
        scene = loaded(0.0, 0.0, 0.0, moment=(0.0, 0.0, 2 * np.pi), follows=follows)
        found = bd.equilibrium(scene, 0.0)
        np.testing.assert_allclose(found.tip, 0.0, atol=CLOSED)
        assert found.tip_angle == pytest.approx(2 * np.pi, rel=CLOSED)


def test_the_bend_of_45_deg_as_a_scene() -> None:
    """The arc is a prebend; its tip leaves as that of the equations in the hand does."""
    second = 1e7 / 12
    arc = bd.Beam.from_stiffness(
        25 * np.pi,
        1.0,
        second,
        second_bending_stiffness=second,
        torsion_stiffness=1e7 / 12,
        rotary_inertia=1e-9,
        second_rotary_inertia=1e-9,
        prebend=np.polynomial.Polynomial([0.0, np.pi / 4]),
    )
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    scene = bd.Scene(arc, OUTWARD, physics=physics, tip_load=bd.TipLoad((0.0, 0.0, 600.0)))
    moved = bd.equilibrium(scene, 0.0).tip - bd.equilibrium(replace(scene, tip_load=bd.TipLoad()), 0.0).tip
    np.testing.assert_allclose(moved, [-23.559, -13.604, 53.469], rtol=0, atol=0.51e-3)
