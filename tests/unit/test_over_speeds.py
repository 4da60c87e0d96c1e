"""Modes over many speeds by interpolation are those solved speed by speed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.modal import solvers
from beamdyn.modes.modal.eigenproblem import Eigen
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modal.solvers import solve_over_speeds

BEAM = bd.Beam.from_stiffness(1.0, 1.0, Polynomial([1.0, -0.5]), second_bending_stiffness=9.0, twist=1e-3)
OUTWARD = bd.Scene(BEAM, bd.Mount(0.1, math.pi, math.pi / 2))
SPEEDS = np.linspace(0.0, 20.0, 700)


def solve_both(scene: bd.Scene, speeds: np.ndarray, count: int = 4) -> tuple[Eigen, Eigen]:
    solver = Model(scene, bd.Ritz(16)).solver
    return solve_over_speeds(solver, speeds, count), solver.solve(speeds, count)


@pytest.mark.parametrize(
    "scene",
    [
        OUTWARD,
        replace(OUTWARD, mount=bd.Mount(0.1, math.pi, 0.0, root_stiffness=2.0)),
        replace(OUTWARD, mount=bd.Mount(2.0, 0.0, 0.4)),  # inward: it buckles at one of the speeds
        replace(OUTWARD, physics=bd.Physics(planes=2)),  # flap meets edge, with a sharp veering
        bd.Scene(
            BEAM, bd.Mount(0.1, math.pi, math.pi / 2, precone=0.1), physics=bd.Physics(planes=2)
        ),  # gyroscopic, as the next
        bd.Scene(
            replace(BEAM, axial_stiffness=BEAM.mass_per_length.scaled(1e4)),
            bd.Mount(0.1, math.pi, 0.0),
            physics=bd.Physics(stretch=True),
        ),
    ],
    ids=["flap", "edge on a spring", "inward", "veering", "precone", "stretch"],
)
def test_values_and_modes(scene: bd.Scene) -> None:
    found, each = solve_both(scene, SPEEDS)
    error = np.abs(found.eigenvalue**2 - each.eigenvalue**2) / np.abs(each.eigenvalue**2)
    assert (error <= found.rounding + each.rounding).all()
    products = np.abs(
        np.einsum(
            "snk,nm,smk->sk", found.vector.conj(), Model(scene, bd.Ritz(16)).solver.pencil.M, each.vector
        )
    )
    np.testing.assert_allclose(products, 1.0, rtol=1e-6)  # that of predicted modes, 1e-7


def test_either_sense_of_rotation() -> None:
    for precone in (0.0, 0.1):
        mount = bd.Mount(0.1, math.pi, math.pi / 2, precone=precone)
        scene = replace(OUTWARD, mount=mount, physics=bd.Physics(planes=2))
        found, each = solve_both(scene, np.linspace(-4.0, 2.0, 301))
        error = np.abs(found.eigenvalue**2 - each.eigenvalue**2) / np.abs(each.eigenvalue**2)
        assert (error <= found.rounding + each.rounding).all()
        M = Model(scene, bd.Ritz(16)).solver.pencil.M
        products = np.abs(np.einsum("snk,nm,smk->sk", found.vector.conj(), M, each.vector))
        np.testing.assert_allclose(products, 1.0, rtol=1e-6)  # that of predicted modes, 1e-7


def test_growing_modes_grow() -> None:
    inward = replace(OUTWARD, mount=bd.Mount(2.0, 0.0, 0.4))
    found, each = solve_both(inward, SPEEDS)
    assert (each.eigenvalue[-1, 0].imag == 0) and each.eigenvalue[-1, 0].real > 0
    np.testing.assert_array_equal(np.imag(found.eigenvalue) == 0, np.imag(each.eigenvalue) == 0)
    np.testing.assert_array_equal(np.real(found.eigenvalue) > 0, np.real(each.eigenvalue) > 0)


def test_few_solutions_where_loci_are_smooth(monkeypatch: pytest.MonkeyPatch) -> None:
    solver, solved = Model(OUTWARD, bd.Ritz(16)).solver, []
    solve = solver.solve
    monkeypatch.setattr(
        solver, "solve", lambda speeds, count: solved.append(len(speeds)) or solve(speeds, count)
    )
    solve_over_speeds(solver, SPEEDS / 4, 4)
    assert sum(solved) < 60


def test_damped_equations_are_solved_speed_by_speed() -> None:
    scene = replace(OUTWARD, damping_ratio=0.01)
    found, each = solve_both(scene, np.linspace(0, 2, solvers._FEW + 1))
    np.testing.assert_array_equal(found.eigenvalue, each.eigenvalue)


@pytest.mark.parametrize(
    ("scene", "speeds"),
    [
        (
            bd.Scene(
                bd.Beam.from_stiffness(1.0, 1.0, 1.0, axial_stiffness=1e3),
                bd.Mount(3.0, 0.0, 0.0),
                physics=bd.Physics(stretch=True),
            ),
            np.linspace(-10.0, 10.0, 401),
        ),
        (
            bd.Scene(
                bd.Beam.from_stiffness(
                    1.0, 1.0, 1.0, second_bending_stiffness=1.3, tip=bd.TipMass(1.0, 0.2, 0.01)
                ),
                bd.Mount(0.0, math.pi, 0.3, precone=1.3),
                physics=bd.Physics(planes=2),
            ),
            np.linspace(-30.0, 5.0, 401),
        ),
    ],
    ids=["divergence", "flutter"],
)
def test_growing_gyroscopic_modes_in_either_sense(scene: bd.Scene, speeds: np.ndarray) -> None:
    """What grows in one sense of rotation has the shape of what decays in the other, not its conjugate."""
    solver = Model(scene, bd.Ritz(12)).solver
    pencil, found = solver.pencil, solve_over_speeds(solver, speeds, 4)
    assert (np.real(found.eigenvalue)[speeds < 0] > 0).any() and pencil.G.any()
    for speed, s, V in zip(speeds, found.eigenvalue, found.vector, strict=True):
        inertia, stiffness = pencil.M @ V * s**2, (pencil.K0 + speed**2 * pencil.K2) @ V
        residual = np.linalg.norm(inertia + speed * pencil.G @ V * s + stiffness, axis=0)
        terms = np.linalg.norm(inertia, axis=0) + np.linalg.norm(stiffness, axis=0)
        assert (residual < 1e-9 * terms).all()  # rounding, with nearly equal modes; wrong shapes have 1


@pytest.mark.parametrize("bending_angle", [0.0, math.pi / 2], ids=["lag", "flap"])
def test_modes_with_frequency_zero(bending_angle: float) -> None:
    """About a hinge on the axis, lag has no stiffness at any speed, and flap none at rest: no warnings."""
    mount = bd.Mount(0.0, math.pi, bending_angle, root_stiffness=0.0)
    solver = Model(bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), mount), bd.Ritz(12)).solver
    speeds = np.linspace(0.0, 5.0, 401)
    found, each = solve_over_speeds(solver, speeds, 3), solver.solve(speeds, 3)
    assert each.eigenvalue[0, 0] == 0
    np.testing.assert_array_equal(found.eigenvalue == 0, each.eigenvalue == 0)
    moving = each.eigenvalue != 0
    error = np.abs(found.eigenvalue - each.eigenvalue)[moving] / np.abs(each.eigenvalue[moving])
    assert (error <= found.rounding[moving] + each.rounding[moving]).all()
