"""Modes over many speeds by interpolation are those solved speed by speed."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modal import over_speeds
from beamdyn.modal.eigensolver import Eigen
from beamdyn.modal.model import Model
from beamdyn.modal.over_speeds import solve_over_speeds

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
    found, each = solve_both(scene, np.linspace(0, 2, over_speeds._FEW + 1))
    np.testing.assert_array_equal(found.eigenvalue, each.eigenvalue)
