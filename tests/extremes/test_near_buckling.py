"""Near buckling, rounding moves the equilibrium far: its stated error says so."""

from __future__ import annotations

from dataclasses import replace
from functools import cache

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER

SCENE = replace(HARVESTER, physics=bd.Physics(large_deflection=True))


@pytest.mark.parametrize("functions", [14, 18, 22])
@pytest.mark.parametrize("beyond", [1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12])
def test_the_error_of_an_equilibrium_just_past_buckling_is_covered(functions: int, beyond: float) -> None:
    # The tip's deflection is as the root of the load beyond buckling: w = C d^(1/2) (1 - a d + ...).
    basis = bd.Ritz(functions)
    far = {d: abs(_equilibrium(d, basis).tip[1]) / d**0.5 for d in (1e-5, 1e-4)}
    slope = (far[1e-4] - far[1e-5]) / 9e-5
    expected = (far[1e-5] + slope * (beyond - 1e-5)) * beyond**0.5
    near = _equilibrium(beyond, basis)
    assert abs(abs(near.tip[1]) - expected) <= near.error
    assert near.error < 0.01 * abs(near.tip[1])


def test_the_error_of_an_equilibrium_next_to_buckling_under_a_tip_load_is_covered() -> None:
    # All these bases resolve the shape: their results differ by rounding alone.
    beam = HARVESTER.beam
    euler = np.pi**2 * float(beam.bending_stiffness(0.0)) / (2 * beam.length) ** 2
    load = bd.TipLoad(force=(-euler * (1 - 1e-7), 1e-9 * euler, 0.0))
    scene = replace(SCENE, mount=bd.Mount(radius=0.2, setting_angle=np.pi), tip_load=load)
    found = [bd.equilibrium(scene, 0.0, discretization=bd.Ritz(n)) for n in (12, 14, 16, 18, 20, 22, 24)]
    tips = np.array([each.tip[1] for each in found])
    assert np.ptp(tips) <= min(each.error for each in found) < 1e-8 * np.abs(tips).min()


@pytest.mark.parametrize(
    "narrowed, thinned, mount",
    [
        (0.5, 0.25, bd.Mount(0.215)),
        (0.8, 0.6, bd.Mount(0.215, 0.0, np.pi / 2)),
        (0.8, 0.5, bd.Mount(0.215, 0.3, np.pi / 2)),
    ],
)
def test_a_tapered_beam_bends_as_the_root_of_the_speed_beyond_buckling(
    narrowed: float, thinned: float, mount: bd.Mount
) -> None:
    # Between the two bent equilibria stands the straight one, at which a long step of the search can end.
    beam = _tapered(narrowed, thinned)
    scene, critical = bd.Scene(beam, mount, physics=SCENE.physics), bd.critical_speed(bd.Scene(beam, mount))
    beyond = np.array([1e-5, 2e-5, 5e-5, 7e-5, 1e-4, 1.5e-4, 2e-4])
    found = [bd.equilibrium(scene, critical * (1 + d), "bent", bd.Ritz(14)) for d in beyond]
    assert all(each.stable for each in found)
    slope = np.array([each.tip_angle for each in found]) / np.sqrt(beyond)
    # A law of symmetric buckling: slope = C d^(1/2) (1 - a d + ...), where a d is below 1e-3 here.
    assert np.ptp(slope) < 1e-3 * np.abs(slope).max()


@pytest.mark.parametrize("beyond", [1e-6, 1e-4, 1e-2])
def test_many_finite_elements_bend_as_a_basis_of_polynomials_does(beyond: float) -> None:
    """Rounding of the elastic forces of short elements kept Newton's method from converging."""
    speed = bd.equilibrium_branches(SCENE, 170.0).critical_speed * (1 + beyond)
    fine = bd.equilibrium(SCENE, speed, "bent", bd.Ritz(14))
    found = bd.equilibrium(SCENE, speed, "bent", bd.Fem(100))
    assert np.abs(found.tip - fine.tip).max() <= found.error < 1e-4


def _stepped() -> tuple[bd.Scene, float]:
    """Build a beam of three segments on its bent branch; also compute its critical speed [rad/s]."""
    stations = [0, 0.3, 0.7, 1]
    mass, stiffness = bd.Table(stations, [2, 1.5, 0.8, 0.3]), bd.Table(stations, [3, 1, 0.2, 0.03])
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, mass, stiffness), bd.Mount(1.5))
    bent = replace(scene, physics=bd.Physics(large_deflection=True, branch="bent"))
    return bent, float(bd.critical_speed(scene))


@pytest.mark.slow
@pytest.mark.parametrize("beyond", [1e-7, 1e-6, 6e-6, 5e-5])
def test_a_basis_is_chosen_that_buckles_below_the_speed(beyond: float) -> None:
    # With five functions on each segment, the beam buckles 5e-7 beyond the critical speed; with three, 6e-5.
    scene, critical = _stepped()
    slope, reference = (
        abs(bd.equilibrium(scene, critical * (1 + d)).tip_angle) / d**0.5 for d in (beyond, 1e-4)
    )
    assert slope == pytest.approx(reference, rel=1e-3)  # the law above, where a d is below 1e-3


def test_an_equilibrium_that_a_coarser_basis_lacks_has_no_known_error() -> None:
    scene, critical = _stepped()
    found = bd.equilibrium(scene, critical * (1 + 3e-5), discretization=bd.Ritz(5))
    assert np.isfinite(found.tip).all() and found.error == np.inf


@pytest.mark.parametrize("speeds", [3, 200])
def test_errors_are_known_at_the_speeds_at_which_a_coarser_basis_buckles(speeds: int) -> None:
    scene, critical = _stepped()
    locus = bd.frequency_locus(scene, critical * np.linspace(1 + 3e-5, 1.1, speeds), 1, bd.Ritz(5))
    assert locus.error[0, 0] == np.inf and locus.error[-1, 0] < 0.1


def test_a_coarsest_mesh_that_does_not_buckle_is_no_refusal() -> None:
    scene = replace(SCENE, mount=bd.Mount(0.05), physics=bd.Physics(large_deflection=True, branch="bent"))
    speed = 1.0002 * float(bd.critical_speed(bd.Scene(scene.beam, scene.mount)))
    mesh, exact = (bd.natural_modes(scene, speed, 1, each) for each in (bd.Fem(8), "ritz"))
    assert abs(mesh.frequency[0] - exact.frequency[0]) <= mesh.error[0] * mesh.frequency[0]


def test_a_backbone_that_a_coarser_basis_lacks_has_no_known_error() -> None:
    scene, critical = _stepped()
    found = bd.backbone(scene, critical * (1 + 3e-5), discretization=bd.Ritz(5))
    assert np.isfinite(found.coefficient) and found.error == np.inf


def test_a_speed_just_below_the_critical_one_has_no_bent_equilibrium() -> None:
    scene, critical = _stepped()
    with pytest.raises(bd.NoEquilibrium, match="no equilibrium beside"):
        bd.equilibrium(scene, critical * (1 - 1e-6))


@pytest.mark.parametrize("setting_angle", [1e-8, 1e-7, 1e-6, 1e-5])
@pytest.mark.parametrize("beyond", [1e-7, 1e-6, 1e-5, 4e-5, 8e-5])
def test_the_bent_equilibrium_just_past_its_fold_is_the_stable_one(
    setting_angle: float, beyond: float
) -> None:
    scene, fold = _turned_inwards(setting_angle), _fold_speed(setting_angle)
    bent, from_rest = (
        bd.equilibrium(scene, fold * (1 + beyond), b, bd.Ritz(12)) for b in ("bent", "straight")
    )
    assert bent.stable and from_rest.stable
    assert bent.tip_angle * from_rest.tip_angle < 0  # to the other side


def _tapered(narrowed: float, thinned: float) -> bd.Beam:
    """Build a strip of which width and thickness decrease linearly, by given parts over the length."""
    width, thickness = ([value, -part * value] for value, part in ((0.01, narrowed), (0.0002, thinned)))
    polynomial = np.polynomial.Polynomial
    return bd.Beam.rectangular(0.05, polynomial(width), polynomial(thickness), 200e9, 7850.0)


def _turned_inwards(setting_angle: float) -> bd.Scene:
    """Build the scene of a tapered strip that points past the rotation axis by a small angle."""
    return bd.Scene(_tapered(0.5, 0.25), bd.Mount(0.215, setting_angle), physics=SCENE.physics)


@cache
def _fold_speed(setting_angle: float) -> float:
    """Compute the lowest speed of the bent branch of this strip [rad/s]."""
    branches = bd.equilibrium_branches(_turned_inwards(setting_angle), 230.0).branches
    return float(branches[1].turning_speeds[0])


def _equilibrium(beyond: float, basis: bd.Ritz) -> bd.Equilibrium:
    """Compute the bent equilibrium at a squared speed that exceeds the critical one by a relative amount."""
    critical = bd.equilibrium_branches(SCENE, 170.0).critical_speed
    return bd.equilibrium(SCENE, critical * (1 + beyond) ** 0.5, "bent", basis)
