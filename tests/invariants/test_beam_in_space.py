"""The beam in space: derivatives, symmetry, frames, conservation, and agreement with the models of less."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.equations.beam_in_space.bent_beam import BeamInSpace, BentBeam
from beamdyn.equations.beam_in_space.loaded_beam import TipLoad
from beamdyn.equations.beam_in_space.rotating_beam import assemble_beam_in_space
from beamdyn.equations.beam_in_space.rotations import skew
from beamdyn.equations.beam_in_space.stations import StationForces
from beamdyn.equations.elastica import Elastica
from beamdyn.modes.modal.equilibrium import DeflectedSolver
from beamdyn.modes.modal.model import Model
from benchmarks.cases.beams_in_space import BENDING, E1, bend, uniform
from benchmarks.cases.elastica import published, scene_of
from benchmarks.cases.two_planes import models
from benchmarks.cases.two_planes import scene_of as two_planes_scene

RNG = np.random.default_rng(33)
AXIS, FORCE, COUPLE = RNG.normal(size=(3, 3))
DIFFERENCES = 2e-9  # central differences of the fourth order, with a step of 1e-3
ROUNDING = 1e-12


def random_rotation(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray]:
    """A unit quaternion and its matrix."""
    w, *v = y = rng.normal(size=4) / 1.0
    w, *v = y = y / np.linalg.norm(y)
    return y, (2 * w**2 - 1) * np.eye(3) + 2 * (np.outer(v, v) + w * skew(np.array(v)))


@cache
def general() -> BeamInSpace:
    """All strains coupled; curved, with a kink, offsets, inertia and fibres that twist shortens."""
    rng = np.random.default_rng(1)
    root = rng.normal(size=(6, 6))
    kinks = np.array([random_rotation(rng)[0] for _ in range(2)])
    return uniform(
        1.3,
        root @ root.T + 6 * np.eye(6),
        functions=3,
        ends=(0.0, 0.6, 1.0),
        initial=(0.02, 0.01, -0.03, 0.7, 0.5, -1.1),
        mass=1.1,
        centre=np.array([0.01, 0.05, -0.07]),
        inertia=np.diag([0.03, 0.01, 0.02]),
        fibres=0.03,
        pretwist=0.3,
        kinks=kinks,
    )


@cache
def somewhere() -> np.ndarray:
    return 0.3 * np.random.default_rng(2).normal(size=general().size)


def derivative(function: Callable[[np.ndarray], np.ndarray], q: np.ndarray, step: float = 1e-3) -> np.ndarray:
    """Derivatives by the coordinates, in the last axis."""
    columns = [
        (8 * (function(q + d) - function(q - d)) - function(q + 2 * d) + function(q - 2 * d)) / (12 * step)
        for d in step * np.eye(len(q))
    ]
    return np.stack(columns, axis=-1)


LOADS: dict[str, tuple[Callable[[BentBeam], StationForces], bool]] = {  # and whether they have a potential
    "centrifugal": (lambda bent: bent.masses.centrifugal(AXIS / np.linalg.norm(AXIS)), True),
    "angular acceleration": (lambda bent: bent.masses.euler(AXIS), False),
    "root acceleration": (lambda bent: bent.masses.translated(AXIS), True),
    "dead force": (TipLoad(FORCE).on, True),
    "dead couple": (TipLoad(couple=COUPLE).on, False),
    "force that follows": (TipLoad(FORCE, follows=True).on, False),
    "couple that follows": (TipLoad(couple=COUPLE, follows=True).on, False),
}


@pytest.mark.parametrize("name", LOADS)
def test_tangent_is_the_derivative_of_the_work(name: str) -> None:
    load, has_potential = LOADS[name]
    beam, q = general(), somewhere()
    tangent = beam.at(q).work_change(load(beam.at(q)))
    exact = derivative(lambda q: beam.at(q).work(load(beam.at(q)).force), q)
    scale = np.abs(exact).max()
    np.testing.assert_allclose(tangent, exact, rtol=0, atol=DIFFERENCES * scale)
    is_symmetric = bool(np.abs(tangent - tangent.T).max() < ROUNDING * scale)
    assert is_symmetric is has_potential


def test_motions_are_derivatives_of_positions_and_rotations() -> None:
    beam, q = general(), somewhere()
    bent, count = beam.at(q), beam.stations.sections
    moved = derivative(lambda q: beam.at(q).positions, q)
    turned = np.einsum("abjn,cbj->acjn", derivative(lambda q: beam.at(q).rotations, q), bent.rotations)
    np.testing.assert_allclose(bent.motions[:, :3].transpose(1, 2, 0), moved, rtol=0, atol=DIFFERENCES)
    expected = skew(bent.motions[:, 3:, :count].transpose(1, 2, 0))
    np.testing.assert_allclose(turned, expected, rtol=0, atol=5 * DIFFERENCES)


def test_centrifugal_work_is_that_of_a_potential() -> None:
    beam, q, axis = general(), somewhere(), AXIS / np.linalg.norm(AXIS)

    def kinetic_energy(q: np.ndarray) -> np.ndarray:
        """At unit speed of the carrier, of which the centrifugal forces are the derivative."""
        masses = beam.at(q).masses
        velocity = np.cross(axis, masses.centre, axisb=0, axisc=0)
        turning = np.einsum("a,abj,b->j", axis, masses.inertia, axis)
        return ((velocity**2).sum(axis=0) @ masses.mass + turning.sum()) / 2

    work = beam.at(q).work(beam.at(q).masses.centrifugal(axis).force)
    np.testing.assert_allclose(-work, derivative(kinetic_energy, q), rtol=0, atol=DIFFERENCES)


def test_gyroscopic_matrix_is_that_of_coriolis_forces() -> None:
    """E - E^T of the angular momentum, against forces 2 m a x v and moments tr(I) a x w - 2 (I a) x w."""
    beam, q, axis = general(), somewhere(), AXIS / np.linalg.norm(AXIS)
    bent = beam.at(q)
    euler, masses = bent.work_change(bent.masses.euler(axis)), bent.masses
    X, W = bent.motions[:, :3], bent.motions[:, 3:]
    velocity = X + np.cross(W, masses.lever, axisa=1, axisb=0, axisc=1)
    coriolis = 2 * masses.mass * np.cross(axis, velocity, axisb=1, axisc=1)
    of_inertia = np.trace(masses.inertia) * np.cross(axis, W, axisb=1, axisc=1)
    of_inertia -= 2 * np.cross(np.einsum("abj,b->aj", masses.inertia, axis), W, axisa=0, axisb=1, axisc=1)
    expected = np.einsum("iaj,kaj->ik", velocity, coriolis) + np.einsum("iaj,kaj->ik", W, of_inertia)
    np.testing.assert_allclose(euler - euler.T, expected, rtol=0, atol=ROUNDING * np.abs(expected).max())


def test_rotations_stay_in_their_group() -> None:
    R = general().at(10 * somewhere()).rotations
    np.testing.assert_allclose(np.einsum("abj,acj->bcj", R, R), np.eye(3)[..., None] + 0 * R, atol=1e-14)


def test_turned_frame_turns_the_answer() -> None:
    """Equilibria under a dead load and under one that follows, of beams and loads that are turned at random."""
    law = np.diag([50.0, 20.0, 30.0, 1.0, 2.0, 3.0])
    for k in range(3):
        y, Q = random_rotation(np.random.default_rng(k))
        upright, turned = (uniform(1.0, law, functions=8, initial=(0, 0, 0, 0.5, 0.3, 0)) for _ in range(2))
        turned = replace(turned, kinks=y[None])
        for follows in (False, True):
            first = bend(upright, TipLoad(2 * FORCE, COUPLE, follows))
            load = TipLoad(2 * FORCE, COUPLE, True) if follows else TipLoad(Q @ (2 * FORCE), Q @ COUPLE)
            np.testing.assert_allclose(bend(turned, load).tip, Q @ first.tip, rtol=0, atol=1e-11)


# Scenes -------------------------------------------------------------------------------------------


def solver_in_space(scene: bd.Scene, functions: int = 16) -> DeflectedSolver:
    """Of a scene in one plane by the code for beams in space."""
    model = Model(scene, bd.Ritz(functions))
    in_space = assemble_beam_in_space(scene, model.discretization, model.equations)
    return DeflectedSolver(in_space, scene.physics.branch)


@pytest.mark.parametrize("case", published()["case"], ids=lambda case: case["name"])
def test_in_one_plane_it_is_the_elastica(case: dict[str, Any]) -> None:
    scene, speed = scene_of(case), np.array([case["gamma"]])
    planar = Model(scene, bd.Ritz(16)).solver
    assert isinstance(planar, DeflectedSolver) and isinstance(planar.elastica, Elastica)
    in_space = solver_in_space(scene)
    first, second = planar.equilibria(speed), in_space.equilibria(speed)
    side = np.sign(first[0, 0] * second[0, 0])  # of two equilibria by symmetry, either
    np.testing.assert_allclose(second, side * first, rtol=0, atol=1e-9)
    np.testing.assert_allclose(in_space.tips(speed)[:, 0], side * planar.tips(speed)[:, 0], rtol=1e-10)
    values = [solver.eigenvalues(speed, 3) for solver in (planar, in_space)]
    np.testing.assert_allclose(values[1], values[0], rtol=1e-10)


@pytest.mark.parametrize("case", models()["case"], ids=lambda case: case["name"])
def test_small_vibration_of_a_straight_beam_is_that_of_linear_theory(case: dict[str, Any]) -> None:
    """Two planes, twist and rotary inertia; shear only at rest, as the linear theory has Engesser's tension."""
    linear = two_planes_scene(case)
    if linear.physics.shear and case["gamma"]:
        return
    bent = replace(linear, physics=replace(linear.physics, large_deflection=True))
    if not bent.bends_in_space:
        bent = replace(bent, mount=replace(bent.mount, bending_angle=bent.mount.bending_angle))
    found, expected = (bd.natural_modes(scene, case["gamma"], modes=4) for scene in (bent, linear))
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=1e-9)
