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
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.beam_in_space.bent_beam import BeamInSpace, BentBeam
from beamdyn.equations.beam_in_space.finite_rotations import skew
from beamdyn.equations.beam_in_space.moving_beam import Carrier, MovingBeam
from beamdyn.equations.beam_in_space.rotating_beam import assemble_beam_in_space
from beamdyn.equations.beam_in_space.station_forces import StationForces
from beamdyn.equations.beam_in_space.tip_forces import TipForces
from beamdyn.equations.root_motion import root_motion
from beamdyn.modes.modal.equilibrium import DeflectedSolver
from beamdyn.modes.modal.model import ModalBasis, Model
from beamdyn.scene.motion.base import MotionSample
from beamdyn.scene.profile import to_profile
from beamdyn.transient.beam_in_space_system import BeamInSpaceSystem
from beamdyn.transient.elastica_steps import propagate_elastica
from benchmarks.cases.beams_in_space import bend, uniform
from benchmarks.cases.elastica import harvester_at, published, scene_of
from benchmarks.cases.two_planes import models, second_method_cases
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
    """All strains coupled; curved, with a kink, offsets, inertia, hinges and fibres that twist shortens."""
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
        hinges=rng.normal(size=(36, 3)),
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
    "centrifugal": (lambda bent: bent.masses.carried(AXIS / np.linalg.norm(AXIS), speed_squared=1.0), True),
    "angular acceleration": (lambda bent: bent.masses.carried(AXIS, acceleration=1.0), False),
    "root acceleration": (lambda bent: bent.masses.carried(0 * AXIS, root=AXIS), True),
    "dead force": (TipForces(FORCE).on, True),
    "dead couple": (TipForces(couple=COUPLE).on, False),
    "force that follows": (TipForces(FORCE, follows=True).on, False),
    "couple that follows": (TipForces(couple=COUPLE, follows=True).on, False),
}


@pytest.mark.parametrize("name", LOADS)
def test_tangent_is_the_derivative_of_the_work(name: str) -> None:
    load, has_potential = LOADS[name]
    beam, q = general(), somewhere()
    tangent = beam.at(q).under(load(beam.at(q))).change
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

    work = beam.at(q).work(beam.at(q).masses.carried(axis, speed_squared=1.0).force)
    np.testing.assert_allclose(-work, derivative(kinetic_energy, q), rtol=0, atol=DIFFERENCES)


def test_gyroscopic_matrix_is_that_of_coriolis_forces() -> None:
    """E - E^T of the angular momentum, against forces 2 m a x v and moments tr(I) a x w - 2 (I a) x w."""
    beam, q, axis = general(), somewhere(), AXIS / np.linalg.norm(AXIS)
    bent = beam.at(q)
    euler, masses = bent.under(bent.masses.carried(axis, acceleration=1.0)).change, bent.masses
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
    """Equilibria under a dead load and under one that follows, beam and load being turned at random."""
    law = np.diag([50.0, 20.0, 30.0, 1.0, 2.0, 3.0])
    for k in range(3):
        y, Q = random_rotation(np.random.default_rng(k))
        upright, turned = (uniform(1.0, law, functions=8, initial=(0, 0, 0, 0.5, 0.3, 0)) for _ in range(2))
        turned = replace(turned, kinks=y[None])
        for follows in (False, True):
            first = bend(upright, TipForces(2 * FORCE, COUPLE, follows))
            load = TipForces(2 * FORCE, COUPLE, True) if follows else TipForces(Q @ (2 * FORCE), Q @ COUPLE)
            np.testing.assert_allclose(bend(turned, load).tip, Q @ first.tip, rtol=0, atol=1e-11)


# Scenes -------------------------------------------------------------------------------------------


def bent_solver(scene: bd.Scene) -> DeflectedSolver:
    solver = Model(scene, bd.Ritz(16)).solver
    assert isinstance(solver, DeflectedSolver)
    return solver


@pytest.mark.parametrize("case", published()["case"], ids=lambda case: case["name"])
def test_in_one_plane_it_is_the_elastica(case: dict[str, Any]) -> None:
    """The beam bends in the plane of its loads, though it may bend in another, and some modes are in it."""
    scene, speed = scene_of(case), np.array([case["gamma"]])
    beam = replace(scene.beam, second_bending_stiffness=scene.beam.bending_stiffness.scaled(7.0))
    planar = bent_solver(scene)
    in_space = bent_solver(replace(scene, beam=beam, physics=replace(scene.physics, planes=2)))
    first, second = planar.equilibria(speed), in_space.equilibria(speed)
    side = np.sign(first[0, 0] * second[0, 0])  # of two equilibria by symmetry, either
    np.testing.assert_allclose(second[:, :16], side * first, rtol=0, atol=1e-9)
    np.testing.assert_allclose(second[:, 16:], 0.0, rtol=0, atol=1e-9)
    np.testing.assert_allclose(in_space.tips(speed)[:, 0], side * planar.tips(speed)[:, 0], rtol=1e-10)
    if case["bending_angle_deg"]:  # Coriolis forces couple modes out of the plane of rotation and in it
        return
    expected, all_modes = planar.eigenvalues(speed, 3)[0], in_space.eigenvalues(speed, 8)[0]
    found = [all_modes[np.abs(all_modes - value).argmin()] for value in expected]
    np.testing.assert_allclose(found, expected, rtol=1e-10)


STRAIGHT = [  # an equilibrium at any speed, as no shear deformation shifts its tension
    case
    for case in (*models()["case"], *second_method_cases())
    if case["setting_angle_deg"] in (0.0, 180.0)
    and (case["planes"] == 2 or "shear_stiffness" in case)
    and not ("shear_stiffness" in case and case["gamma"])
]


@pytest.mark.parametrize("case", STRAIGHT, ids=lambda case: case["name"])
def test_small_vibration_of_a_straight_beam_is_that_of_linear_theory(case: dict[str, Any]) -> None:
    """Two planes, twist, rotary inertia, bodies at the tip; shear at rest."""
    linear = two_planes_scene(case)
    bent = replace(linear, physics=replace(linear.physics, large_deflection=True))
    found, expected = (bd.natural_modes(scene, case["gamma"], modes=4) for scene in (bent, linear))
    np.testing.assert_allclose(found.frequency, expected.frequency, rtol=1e-9)


@pytest.mark.parametrize("precone", [0.0, 0.3])
def test_about_the_straight_beam_every_matrix_and_load_is_that_of_linear_theory(precone: float) -> None:
    """Two planes, twist, rotary inertia, bodies, springs at the root, any motion of the root."""
    beam = bd.Beam.from_stiffness(
        1.1,
        Polynomial([1.2, -0.3]),
        Polynomial([1.0, -0.2]),
        second_bending_stiffness=4.0,
        twist=Polynomial([0.2, 0.5]),
        rotary_inertia=0.02,
        second_rotary_inertia=0.04,
        tip=bd.TipMass(0.4, 0.1, 0.02, 0.03, 0.015),
        point_masses=[bd.PointMass(0.4, 0.3)],
    )
    physics = bd.Physics(2, rotary_inertia=True, large_deflection=True)
    mount = bd.Mount(0.7, np.pi, 0.4, 3.0, 5.0, precone=precone)
    scene = bd.Scene(beam, mount, damping_ratio=0.1, physics=physics)
    model = Model(scene, bd.Ritz(6))
    linear, exact = model.equations, assemble_beam_in_space(scene, model.discretization, model.equations)
    found, n = exact.about_straight, linear.size
    for own, expected in zip(
        (*found.matrices, found.vectors), (*linear.matrices, linear.vectors), strict=True
    ):
        for quantity in own.keys() | expected.keys():
            nothing = np.zeros((n, n) if own is not found.vectors else n)
            values = own.get(quantity, nothing), expected.get(quantity, nothing)
            np.testing.assert_allclose(*values, rtol=0, atol=1e-13)
    for direction in (0, 1):
        np.testing.assert_allclose(found.P(direction), linear.P(direction), rtol=0, atol=1e-13)
        np.testing.assert_allclose(found.Q(direction), linear.Q(direction), rtol=0, atol=1e-13)
    np.testing.assert_allclose(found.tips, linear.tips, rtol=0, atol=1e-13)


# Offsets of the centres of mass and of tension ----------------------------------------------------


def with_offsets(mass: float, tension: float, tip: float, mount: bd.Mount, **given: Any) -> bd.Scene:
    """An untwisted beam of torsion, whose centres lie beside the shear centre, with a body at the tip."""
    body = bd.TipMass(0.2, 0.05, 0.01, 0.012, 0.005, offset_across=tip)
    values: dict[str, Any] = {"second_bending_stiffness": 1.3, "torsion_stiffness": 40.0}
    values |= {"rotary_inertia": 0.01, "second_rotary_inertia": 0.02}
    beam = bd.Beam.from_stiffness(
        1.0, 1.0, 200.0, tip=body, mass_offset=mass, tension_offset=tension, **(values | given)
    )
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    return bd.Scene(beam, mount, physics=physics)


def test_mass_and_stiffness_with_offsets_are_those_of_linear_theory() -> None:
    """Of beams without twist; the rest depends on second moments, which linear theory has in part."""
    scene = with_offsets(0.05, -0.03, 0.1, bd.Mount(0.5, np.pi))
    model = Model(scene, bd.Ritz(6))
    found, linear = model.bent.about_straight, model.equations
    for order in (0, 2):
        values = (each.matrices[order]["unity"] for each in (found, linear))
        np.testing.assert_allclose(
            *values, rtol=0, atol=1e-13 * np.abs(linear.matrices[order]["unity"]).max()
        )
    small = replace(scene, physics=replace(scene.physics, large_deflection=False))
    frequencies = (bd.natural_modes(each, 0.0, 5, bd.Ritz(8)).frequency for each in (scene, small))
    np.testing.assert_allclose(*frequencies, rtol=1e-9)


def test_a_beam_whose_centres_lie_beside_its_axis_is_one_that_stands_there() -> None:
    """In the plane of rotation, where nothing twists it: bent far, against the elastica."""
    radius, angle, beside, speed = 0.6, 2.0, 0.08, 3.0
    scene = with_offsets(beside, beside, beside, bd.Mount(radius, angle, np.pi / 2))
    along, across = -radius * np.cos(angle), radius * np.sin(angle) + beside
    moved = bd.Mount(np.hypot(along, across), np.arctan2(across, -along))
    body = bd.TipMass(0.2, 0.05, 0.012)  # the moment about what is now the axis of bending
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.3, rotary_inertia=0.02, tip=body)
    planar = bd.Scene(beam, moved, physics=bd.Physics(rotary_inertia=True, large_deflection=True))
    basis = bd.Ritz(10)
    found, expected = (bd.natural_modes(each, speed, 4, basis).frequency for each in (scene, planar))
    assert abs(bd.equilibrium(planar, speed, discretization=basis).tip[1]) > 0.4
    np.testing.assert_allclose(found[[0, 1, 3]], expected[:3], rtol=1e-10)


VALUES = {
    "mass_per_length": 2.0,
    "axial_stiffness": 1e5,
    "shear_stiffness": 1e4,
    "second_shear_stiffness": 2e4,
    "torsion_stiffness": 40.0,
    "second_bending_stiffness": 200.0,
    "bending_stiffness": 90.0,
    "rotary_inertia": 0.01,
    "second_rotary_inertia": 0.02,
}


def matrices_with_offsets(mass: float, tension: float) -> bd.SectionMatrices:
    """The 6 x 6 matrices of sections whose centres lie beside the axis, in the direction across."""
    strain, velocity = np.eye(6), np.eye(6)
    strain[0, 4] = tension  # stretch of the centre of tension by the second curvature
    velocity[0, 4], velocity[1, 3] = mass, -mass
    m, *diagonal, first, second = VALUES.values()
    stiffness = strain.T @ np.diag(diagonal) @ strain
    inertia = velocity.T @ np.diag([m, m, m, first + second, second, first]) @ velocity
    return bd.SectionMatrices.at_stations([0.0, 0.4, 1.0], [stiffness] * 3, [inertia] * 3)


def test_matrices_of_offsets_are_offsets() -> None:
    """Of a swept and twisted beam: by the 6 x 6 law, or by stretch that bending causes at the axis."""
    shape: dict[str, Any] = {"twist": Polynomial([0.3, 0.5]), "sweep": Polynomial([0.0, 0.3])}
    shape |= {"tip": bd.TipMass(0.2, 0.05, 0.01, 0.012, 0.005, offset_across=0.1)}
    by_offsets = bd.Beam.from_stiffness(1.3, mass_offset=0.05, tension_offset=-0.03, **VALUES, **shape)
    by_matrices = bd.Beam.from_matrices(1.3, matrices_with_offsets(0.05, -0.03), **shape)
    scenes = [bd.Scene(beam, bd.Mount(0.5, 2.0, 0.4), physics=ALL) for beam in (by_offsets, by_matrices)]
    first, second = (bd.natural_modes(scene, 2.0, 4, bd.Ritz(8)) for scene in scenes)
    np.testing.assert_allclose(second.frequency, first.frequency, rtol=1e-8)  # of unlike segments
    tips = (bd.equilibrium(scene, 2.0, discretization=bd.Ritz(8)).tip for scene in scenes)
    np.testing.assert_allclose(*tips, rtol=0, atol=1e-9)
    by_forces = bd.natural_modes(scenes[1], 2.0, 4, bd.Ritz(12, "moments"))
    np.testing.assert_allclose(by_forces.frequency, first.frequency, rtol=1e-6)


def test_damping_ratio_is_that_of_the_modes_at_rest_of_sections_with_matrices() -> None:
    beam = bd.Beam.from_matrices(1.3, matrices_with_offsets(0.05, -0.03), sweep=Polynomial([0.0, 0.3]))
    found = bd.natural_modes(bd.Scene(beam, damping_ratio=0.02, physics=ALL), 0.0, 3, bd.Ritz(6))
    undamped = bd.natural_modes(bd.Scene(beam, physics=ALL), 0.0, 3, bd.Ritz(6))
    np.testing.assert_allclose(-found.growth_rate, 0.02 * 2 * np.pi * undamped.frequency, rtol=1e-8)


def test_offsets_turn_with_the_sections() -> None:
    """By the bending angle, or by the twist of the whole beam."""
    by_twist = with_offsets(0.05, -0.03, 0.1, bd.Mount(0.5, 2.0, 0.4), twist=Polynomial([0.3, 0.5]))
    mount = bd.Mount(0.5, 2.0, 0.7)
    by_mount = with_offsets(0.05, -0.03, 0.1, mount, twist=Polynomial([0.0, 0.5]))
    basis = bd.Ritz(6)
    first, second = (bd.natural_modes(each, 2.0, 4, basis).frequency for each in (by_twist, by_mount))
    np.testing.assert_allclose(second, first, rtol=1e-11)


@pytest.mark.parametrize(
    ("gamma", "haringx"),
    [(12.0, [12.9630, 35.8047]), (4.0, [10.0870, 29.4247])],  # digits printed, by another program
    ids=["gamma 12", "gamma 4"],
)
def test_tension_acts_on_the_sections_where_shear_deforms_them(gamma: float, haringx: list[float]) -> None:
    """Haringx, not Engesser as in the linear theory, which has 12.9954 and 10.1105."""
    (case,) = (c for c in models()["case"] if c["gamma"] == gamma and "shear_stiffness" in c)
    linear = two_planes_scene(case)
    bent = replace(linear, physics=replace(linear.physics, large_deflection=True))
    found = bd.natural_modes(bent, gamma, modes=2).frequency
    np.testing.assert_allclose(2 * np.pi * found, haringx, rtol=0, atol=0.51e-4)


SWEPT = bd.Beam.from_stiffness(
    1.0,
    1.0,
    1.0,
    second_bending_stiffness=4.0,
    twist=Polynomial([0.0, 0.5]),
    rotary_inertia=0.002,
    second_rotary_inertia=0.004,
    torsion_stiffness=0.7,
    shear_stiffness=300.0,
    axial_stiffness=3e4,
    sweep=bd.Table([0.0, 0.6, 0.6, 1.0], [0.0, 0.1, 0.3, 0.5]),
    prebend=Polynomial([0.0, 0.2]),
)
ALL = bd.Physics(2, shear=True, rotary_inertia=True, stretch=True, torsion=True, large_deflection=True)


def test_elements_agree_with_ritz() -> None:
    scene = bd.Scene(SWEPT, bd.Mount(0.5, 2.0, 0.4), physics=ALL)
    ritz, fem = (bd.natural_modes(scene, 2.0, 3, d) for d in (bd.Ritz(8), bd.Fem(8)))
    np.testing.assert_allclose(fem.frequency, ritz.frequency, rtol=1e-4)
    assert (np.abs(fem.frequency / ritz.frequency - 1) < fem.error + ritz.error).all()


def test_a_beam_and_its_mount_may_be_turned_against_each_other() -> None:
    """The sections by the bending angle, or by the twist; the axis swept in the plane, or bent out of it."""
    mount, quarter = bd.Mount(0.5, 2.0, 0.4), np.pi / 2
    upright = replace(SWEPT, twist=None, prebend=None)
    swapped = replace(
        upright, sweep=None, prebend=upright.sweep, bending_stiffness=SWEPT.second_bending_stiffness,
        second_bending_stiffness=SWEPT.bending_stiffness, rotary_inertia=SWEPT.second_rotary_inertia,
        second_rotary_inertia=SWEPT.rotary_inertia,
    )  # fmt: skip
    basis, turned = bd.Ritz(6), replace(mount, bending_angle=0.4 + quarter)
    first = bd.natural_modes(bd.Scene(upright, mount, physics=ALL), 2.0, 4, basis)
    second = bd.natural_modes(bd.Scene(swapped, turned, physics=ALL), 2.0, 4, basis)
    np.testing.assert_allclose(second.frequency, first.frequency, rtol=1e-11)
    tips = (bd.equilibrium(each.scene, 2.0, discretization=basis).tip for each in (first, second))
    np.testing.assert_allclose(*tips, rtol=0, atol=1e-11)
    by_mount, more = replace(SWEPT, sweep=None, prebend=None), to_profile("twist", Polynomial([0.3, 0.5]))
    by_twist = replace(by_mount, twist=more)
    first = bd.natural_modes(bd.Scene(by_twist, mount, physics=ALL), 2.0, 4, basis)
    second = bd.natural_modes(
        bd.Scene(by_mount, replace(mount, bending_angle=0.7), physics=ALL), 2.0, 4, basis
    )
    np.testing.assert_allclose(second.frequency, first.frequency, rtol=1e-11)


def test_a_curved_axis_is_that_of_its_angles() -> None:
    """Unloaded: the position is the integral of the direction that the angles give."""
    found = bd.equilibrium(bd.Scene(SWEPT, bd.Mount(), physics=ALL), 0.0, discretization=bd.Ritz(4))
    xi, weights = np.polynomial.legendre.leggauss(20)
    expected = np.zeros(3)
    for a, b in ((0.0, 0.6), (0.6, 1.0)):
        at = (a + b) / 2 + (b - a) / 2 * xi
        assert SWEPT.sweep is not None and SWEPT.prebend is not None
        sweep, bend = SWEPT.sweep(at), SWEPT.prebend(at)
        along = [np.cos(sweep) * np.cos(bend), np.cos(sweep) * np.sin(bend), np.sin(sweep)]
        expected += (b - a) / 2 * np.array(along) @ weights
    np.testing.assert_allclose(found.tip, expected, rtol=0, atol=1e-13)


# Motion -------------------------------------------------------------------------------------------


def test_inertial_forces_are_those_of_lagrange() -> None:
    """d/dt of the momentum, and the derivative of the kinetic energy in fixed axes, by the coordinates."""
    beam, q, turning = general(), somewhere(), AXIS / np.linalg.norm(AXIS)
    rates, accelerations = RNG.normal(size=(2, beam.size))

    def momentum(q: np.ndarray) -> np.ndarray:
        bent = beam.at(q)
        return bent.mass @ rates + bent.work(bent.masses.carried(turning, acceleration=1.0).force)

    def kinetic_energy(q: np.ndarray) -> np.ndarray:
        bent = beam.at(q)
        velocity = np.cross(turning, bent.masses.centre, axisb=0, axisc=0)
        sections = np.einsum("a,abj,b->", turning, bent.masses.inertia, turning)
        carried = (velocity**2).sum(axis=0) @ bent.masses.mass + sections
        return (
            rates @ bent.mass @ rates / 2
            + rates @ bent.work(bent.masses.carried(turning, acceleration=1.0).force)
            + carried / 2
        )

    exact = derivative(momentum, q) @ rates + beam.at(q).mass @ accelerations - derivative(kinetic_energy, q)
    moving = MovingBeam(beam.at(q), rates, Carrier(turning))
    found = moving.bent.work(moving.forces(accelerations))
    np.testing.assert_allclose(found, exact, rtol=0, atol=DIFFERENCES * np.abs(exact).max())


def test_carrier_that_speeds_up_and_moves_loads_the_beam_at_rest() -> None:
    beam, q, rest = general(), somewhere(), np.zeros(general().size)
    moving = MovingBeam(beam.at(q), rest, Carrier(0 * AXIS, AXIS, FORCE))
    expected = beam.at(q).work(moving.bent.masses.carried(AXIS, acceleration=1.0).force)
    expected += beam.at(q).work(moving.bent.masses.carried(0 * AXIS, root=FORCE).force)
    np.testing.assert_allclose(moving.bent.work(moving.forces(rest)), expected, rtol=0, atol=ROUNDING)


def test_energy_of_large_motion_at_constant_speed() -> None:
    """Of a twisted beam with torsion at an oblique angle, whose tip moves by a third of its length."""
    beam = replace(SWEPT, sweep=None, shear_stiffness=None, axial_stiffness=None)
    physics = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)
    motion = bd.SteadyRotation(2.0)
    scene = bd.Scene(beam, bd.Mount(0.5, 2.0, 0.4), motion, physics=physics)
    system = BeamInSpaceSystem.of_model(Model(scene, bd.Ritz(5)), ModalBasis(3), motion)
    run = propagate_elastica(system, 0.0, 0.4, 8, np.zeros(3), np.array([1.0, 1.0, 0.5]), stages=8)
    q, v = np.split(run.state[:, 1:], 2, axis=1)
    energy = system.energy(np.linspace(0.0, 0.4, 9), q, v)
    assert np.abs(system.deflections(q)).max() > 0.3
    np.testing.assert_allclose(energy, energy[0], rtol=1e-9)


def test_steps_follow_a_tip_that_moves_across_alone() -> None:
    """A blade that is swept in the plane of rotation, whose direction of bending is out of it."""
    swept = replace(SWEPT, twist=None, prebend=None)
    motion, physics = bd.SpinUp(2.0, 2.0), bd.Physics(2, rotary_inertia=True, large_deflection=True)
    scene = bd.Scene(swept, bd.Mount(0.1, np.pi, np.pi / 2), motion, physics=physics)
    run = bd.simulate(scene, 0.4, modes=2, tolerance=1e-4, discretization=bd.Ritz(6))
    largest = np.abs(run.tip_across).max()
    assert np.abs(run.tip).max() < 1e-12 * largest and run.time_error < 1e-4 * largest
    assert int(run.provenance.method.split(" steps")[0].split()[-1]) < 20


def test_motion_in_a_plane_is_that_of_the_elastica() -> None:
    scene = replace(harvester_at(45.0), motion=bd.SpinUp(100.0, 0.01))
    both = replace(scene, physics=replace(scene.physics, planes=2))
    planar, in_space = (bd.simulate(each, 0.01, modes=2, tolerance=1e-5) for each in (scene, both))
    t = np.linspace(0, 0.01, 41)
    first, second = planar.at(t)[0], in_space.at(t)[0]
    length = scene.beam.length
    tips = planar.system.deflections(first)[:, 0], in_space.system.deflections(second)[:, 0]
    np.testing.assert_allclose(tips[1], tips[0], rtol=0, atol=1e-9 * length)


def test_a_section_that_deforms_without_a_force_is_refused_with_its_place() -> None:
    law = np.diag([1.0, 1.0, 1.0, 1.0, 2.0, 3.0])
    law[3, 4] = law[4, 3] = 1.5
    with pytest.raises(InvalidValue, match=r"section = -0\.08.* at x/L = .*6 x 6"):
        uniform(1.0, law)


# Loads at the tip of scenes -------------------------------------------------------------------------

FORCE_AT_TIP, MOMENT_AT_TIP = np.array([-0.3, 0.8, 0.5]), np.array([0.2, -0.4, 0.3])
CURVED = bd.Beam.from_stiffness(
    1.0,
    1.0,
    1.0,
    second_bending_stiffness=3.0,
    torsion_stiffness=0.8,
    rotary_inertia=1e-3,
    second_rotary_inertia=2e-3,
    sweep=Polynomial([0.0, 0.5]),
)
IN_SPACE = bd.Physics(2, rotary_inertia=True, torsion=True, large_deflection=True)


def pushed(load: bd.TipLoad, bending_angle: float = 0.3, **others: Any) -> bd.Scene:
    return bd.Scene(CURVED, bd.Mount(0.5, 2.0, bending_angle), physics=IN_SPACE, tip_load=load, **others)


@pytest.mark.parametrize("follows", [False, True])
def test_a_load_turned_with_the_beam_turns_its_tip(follows: bool) -> None:
    c, s = np.cos(0.9), np.sin(0.9)
    turn = np.array([[1, 0, 0], [0, c, -s], [0, s, c]])
    loads = (
        bd.TipLoad(tuple(Q @ FORCE_AT_TIP), tuple(Q @ MOMENT_AT_TIP), follows) for Q in (np.eye(3), turn)
    )
    one, other = (
        bd.equilibrium(pushed(load, angle), 0.0) for load, angle in zip(loads, (0.3, 1.2), strict=True)
    )
    np.testing.assert_allclose(other.tip, turn @ one.tip, rtol=0, atol=1e-11)
    assert np.linalg.norm(one.tip - bd.equilibrium(pushed(bd.TipLoad()), 0.0).tip) > 0.1


def test_small_loads_do_not_know_whether_they_follow_the_tip() -> None:
    """Also of a swept beam: the components are those on the unloaded beam."""
    unloaded = bd.equilibrium(pushed(bd.TipLoad()), 0.0).tip
    loads = [
        bd.TipLoad(tuple(1e-5 * FORCE_AT_TIP), tuple(1e-5 * MOMENT_AT_TIP), each) for each in (False, True)
    ]
    dead, following = (bd.equilibrium(pushed(load), 0.0).tip - unloaded for load in loads)
    np.testing.assert_allclose(following, dead, rtol=0, atol=1e-4 * np.linalg.norm(dead))


def test_frequencies_under_a_load_are_those_of_motion_about_the_equilibrium() -> None:
    """The derivative, by differences, of the residual of the equations in time."""
    for load in (bd.TipLoad((0.0, 0.5, 0.4)), bd.TipLoad((0.0, 0.5, 0.4), (0.1, 0.0, 0.2), follows=True)):
        model = Model(pushed(load), bd.Ritz(6))
        q = model.solver.equilibria(np.array([1.5]))[0]
        root = root_motion(model.scene.mount, MotionSample.steady(1.5))
        rest, pencil = np.zeros_like(q), model.equations_at(1.5).steady()

        def residual(q: np.ndarray, model=model, root=root, rest=rest) -> np.ndarray:
            return model.bent.at(q).work(rest, rest, root)

        steps = 1e-6 * np.eye(len(q))
        change = np.array([(residual(q + step) - residual(q - step)) / 2e-6 for step in steps]).T
        K = pencil.K0 + 1.5**2 * pencil.K2
        np.testing.assert_allclose(residual(q), 0.0, atol=1e-10)
        np.testing.assert_allclose(change, K, rtol=0, atol=1e-8 * np.abs(K).max())


def test_critical_speed_under_a_dead_load_is_where_the_first_frequency_vanishes() -> None:
    inward = bd.Scene(
        bd.Beam.from_stiffness(1.0, 1.0, 1.0),
        bd.Mount(4.0),
        physics=bd.Physics(large_deflection=True),
        tip_load=bd.TipLoad((-1.0, 0.0, 0.0)),
    )
    basis = bd.Ritz(12)
    found = bd.critical_point(inward, basis)
    below, above = (bd.natural_modes(inward, k * found.speed, 1, basis) for k in (1 - 1e-8, 1 + 1e-8))
    assert found.of_bent_beam and not below.growth_rate.any() and above.growth_rate.any()
    assert "its load" in found.reason
    assert found.speed < bd.critical_speed(replace(inward, tip_load=bd.TipLoad()))


def test_energy_under_a_dead_force_that_begins_at_once() -> None:
    scene = bd.Scene(
        bd.Beam.from_stiffness(1.0, 1.0, 1.0),
        motion=bd.SteadyRotation(1.0),
        physics=bd.Physics(large_deflection=True),
        tip_load=bd.TipLoad((0.0, 1.0, 0.0)),
    )
    run = bd.simulate(scene, 2.0, modes=2, tolerance=1e-6, initial="rest")
    energy = run.energy(run.t)
    np.testing.assert_allclose(energy, 0.0, rtol=0, atol=1e-6 * 0.3)  # the work of the force is of order 0.3
    assert np.abs(run.tip).max() > 0.4
    still = bd.simulate(scene, 0.5, modes=2, tolerance=1e-6, initial="equilibrium")
    assert np.ptp(still.tip) < 1e-6 < abs(still.tip[0])
