"""Modes at one speed, by a factorization of the stiffness there, are those among many speeds."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.modal.diagonal_stiffness import LEAST_STIFFNESS
from beamdyn.modes.modal.eigenproblem import Solver
from beamdyn.modes.modal.error_estimate import error_of_assumed_modes, solve_with_error
from beamdyn.modes.modal.model import Model

BEAM = bd.Beam.from_stiffness(
    1.0, 1.0, Polynomial([1.0, -0.5]), second_bending_stiffness=9.0, twist=Polynomial([0.0, 0.6])
)
OUTWARD = bd.Scene(BEAM, bd.Mount(0.1, math.pi, math.pi / 2))
SCENES = {
    "outward": (OUTWARD, 6.0),
    "at rest": (OUTWARD, 0.0),
    "twisted": (replace(OUTWARD, physics=bd.Physics(planes=2)), 6.0),
    "softened": (replace(OUTWARD, mount=bd.Mount(2.0, 0.0, 0.4)), 0.8),
    "loaded": (replace(OUTWARD, mount=bd.Mount(2.0, 1.9, 0.0)), 1.5),
    "past the critical speed": (replace(OUTWARD, mount=bd.Mount(2.0, 0.0, 0.4)), 4.0),
}


def solver_of(scene: bd.Scene) -> Solver:
    solver = Model(scene, bd.Ritz(16)).solver
    assert isinstance(solver, Solver)
    return solver


@pytest.mark.parametrize(("scene", "speed"), SCENES.values(), ids=SCENES)
def test_modes_are_those_of_a_batch(scene: bd.Scene, speed: float) -> None:
    solver = solver_of(scene)
    one, batch = solver.solve(np.array([speed]), 4), solver.solve(np.full(2, speed), 4)
    distance = np.abs(one.eigenvalue[0] / batch.eigenvalue[0] - 1)
    assert (distance <= one.rounding[0] + batch.rounding[0]).all()
    np.testing.assert_allclose(solver.eigenvalues(np.array([speed]), 4), one.eigenvalue, rtol=1e-12)
    products = one.vector[0].T @ solver.pencil.M @ batch.vector[0]
    np.testing.assert_allclose(np.abs(np.diag(products)), 1.0, rtol=1e-9)  # vectors: rounding over their gaps
    tips = Model(scene, bd.Ritz(16)).equations.tips
    static = solver.solve_static(np.full(2, speed), tips)[:1]
    np.testing.assert_allclose(solver.solve_static(np.array([speed]), tips), static, rtol=1e-10, atol=1e-14)


def test_only_a_stiffness_that_is_safely_positive_is_factored() -> None:
    solver = solver_of(SCENES["softened"][0])
    critical = solver.critical_speed
    least_at = critical * math.sqrt(1 - LEAST_STIFFNESS)  # K0 + speed^2 K2 has a share 1 - (speed/critical)^2
    assert solver.factor(np.array([0.999 * least_at])) is not None
    assert solver.factor(np.array([1.001 * least_at])) is None
    assert solver.factor(np.array([1.1 * critical])) is None


@pytest.mark.parametrize("functions", [7, 11])  # far from convergence, and near it
@pytest.mark.parametrize("share", [0.0, 0.5, 0.9, 0.99999, 1.1])  # of the critical speed
def test_stated_error_has_the_scale_at_rest(share: float, functions: int) -> None:
    """Where a frequency nearly vanishes its error is no less regular: the scale is the lowest one at rest."""
    model = Model(SCENES["softened"][0], bd.Ritz(functions))
    speeds = np.array([share * model.solver.critical_speed])
    found = solve_with_error(model, speeds, 1)
    squared = found.eigen.eigenvalue**2
    distance = squared - model.coarse_solver.eigenvalues(speeds, 1) ** 2
    lowest = np.array([model.solver.lowest_at_rest])
    stated = error_of_assumed_modes(squared, distance, found.eigen.rounding, lowest)
    np.testing.assert_allclose(found.error, stated, rtol=1e-12)  # the same arithmetic
