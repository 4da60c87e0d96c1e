"""Convergence of the finite elements, without extrapolation."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modes.modal.model import Model
from benchmarks.cases.reference.power_series import bending_eigenvalues
from benchmarks.cases.scenes import of_case

CASE = {
    "model": "bending",
    "delta": 1.0,
    "bending_angle_deg": 90.0,
    "mass": [1.0, -0.5],
    "stiffness": [1.0, -0.8, 0.2],
}


@pytest.mark.parametrize("mesh", ["uniform", "graded"])
def test_elements_converge_with_fourth_order(mesh: str) -> None:
    expected = np.sqrt(float(bending_eigenvalues(6, 1, np.pi / 2, (1, -0.5), (1, -0.8, 0.2), count=1)[0]))
    sizes = np.array([5, 10, 20, 40])
    errors = []
    for n in sizes:
        model = Model(of_case(CASE), bd.Fem(int(n), mesh))  # pyright: ignore[reportArgumentType]
        errors.append(abs(model.solver.solve(np.array([6.0]), 1).eigenvalue[0, 0]) / expected - 1)
    slope = np.polyfit(np.log(sizes), np.log(errors), 1)[0]
    assert -4.3 < slope < -3.7


def test_extrapolation_reduces_the_error_twentyfold() -> None:
    expected = np.sqrt(float(bending_eigenvalues(6, 1, np.pi / 2, (1, -0.5), (1, -0.8, 0.2), count=1)[0]))
    plain = Model(of_case(CASE), bd.Fem(40)).solver.solve(np.array([6.0]), 1).eigenvalue[0, 0]
    better = bd.natural_modes(of_case(CASE), 6.0, 1, bd.Fem(40)).eigenvalue[0]
    assert abs(abs(better) - expected) < 0.05 * abs(abs(plain) - expected)


@pytest.mark.parametrize("elements", [10, 30, 50])
def test_a_beam_of_many_stations_has_two_meshes_to_compare(elements: int) -> None:
    """With one element on each segment, half as many would be the same mesh, and the error 0."""
    stations = np.linspace(0, 1, 31)
    beam = bd.Beam.from_stiffness(
        1.0, bd.Table(stations, 1 - 0.6 * stations), bd.Table(stations, np.exp(-3 * stations))
    )
    scene = bd.Scene(beam, bd.Mount(0.1, np.pi))
    found, exact = (bd.natural_modes(scene, 3.0, 5, basis) for basis in (bd.Fem(elements), bd.Ritz(6)))
    true = np.abs(found.frequency / exact.frequency - 1)
    assert (true <= found.error).all() and (found.error < 1e-4).all()


def _answers(scene: bd.Scene, discretization: bd.Discretization) -> np.ndarray:
    """Compute a critical speed (as its logarithm), a moment and a setting angle, and their errors (2, 3)."""
    critical = bd.critical_point(scene, discretization)
    loads = bd.static_loads(scene, 50.0, at=[0.1], angle=0.7, discretization=discretization)
    limits = bd.setting_angle_limits(scene, 50.0, discretization)
    values = np.log(critical.speed), loads.moment[0, 0, 0], limits.first
    return np.array([values, (critical.error, loads.moment_error[0, 0, 0], limits.error)])


def test_meshes_of_a_strip_state_what_more_functions_across_it_would_change() -> None:
    """A finer mesh has as many across; assumed modes have nearly twice as many."""
    strip = bd.Beam.rectangular(0.3, 0.12, 0.004, 70e9, 2700.0, poissons_ratio=0.33)
    scene = bd.Scene(strip, bd.Mount(0.2), gravity=9.81, physics=bd.Physics(camber=True))
    (of_mesh, stated), (of_modes, _) = (_answers(scene, each) for each in (bd.Fem(16), bd.Ritz(16)))
    assert (np.abs(of_mesh - of_modes) <= stated).all()
