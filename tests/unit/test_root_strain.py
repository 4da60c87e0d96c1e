"""Bending strain at the root against closed forms, a boundary-value problem and many functions."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_bvp

import beamdyn as bd

LENGTH, MASS, STIFFNESS, FIBRE = 2.0, 3.0, 500.0, 0.01
BODY = bd.TipMass(1.5, 0.1, 0.05, 0.06, 0.02)
BEAM = bd.Beam.from_stiffness(LENGTH, MASS, STIFFNESS, axial_stiffness=1e8, outer_fibre=FIBRE, tip=BODY)
SOFT = 5.0  # a hundredth of the stiffness of the beam's end [N m/rad]
HANGING = bd.Scene(BEAM, bd.Mount(), bd.SteadyRotation(0.0), damping_ratio=0.05, gravity=9.81)


@pytest.mark.parametrize("discretization", [bd.Ritz(14), bd.Fem(12)])
@pytest.mark.parametrize("stretch", [False, True])
@pytest.mark.parametrize("modes", [1, 3])
def test_weight_of_beam_and_body(modes: int, stretch: bool, discretization: bd.Ritz | bd.Fem) -> None:
    """The moment is that of the weights about the root, however few modes there are."""
    scene = replace(HANGING, physics=bd.Physics(stretch=stretch))
    run = bd.simulate(scene, 0.1, modes, initial="equilibrium", discretization=discretization)
    moment = -9.81 * (MASS * LENGTH**2 / 2 + BODY.mass * (LENGTH + BODY.offset))
    assert run.root_strain([0.05])[0] == pytest.approx(moment * FIBRE / STIFFNESS, rel=1e-10)


def test_tapered_beam() -> None:
    taper = np.polynomial.Polynomial([1.0, -0.5])
    beam = bd.Beam.from_stiffness(LENGTH, MASS * taper, STIFFNESS * taper**3, outer_fibre=FIBRE * taper)
    run = bd.simulate(replace(HANGING, beam=beam), 0.1, 1, initial="equilibrium")
    moment = -9.81 * MASS * LENGTH**2 * (1 / 2 - 0.5 / 3)
    assert run.root_strain([0.05])[0] == pytest.approx(moment * FIBRE / STIFFNESS, rel=1e-10)


def steady_moment(mount: bd.Mount, speed: float) -> float:
    """Moment at the root of the rotating beam, from its differential equation [N m]."""
    c, s = math.cos(mount.bending_angle), math.sin(mount.bending_angle)
    axial, across = (
        speed**2 * mount.radius * np.array([math.cos(mount.setting_angle), math.sin(mount.setting_angle)])
    )
    across, reach = c * across, LENGTH + BODY.offset
    end = BODY.mass * (speed**2 * reach - axial)  # tension at the tip
    tilting = (speed * s) ** 2 * (BODY.inertia_about_bending_direction - BODY.axial_inertia)

    def slopes(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        u, slope, moment, shear = y
        tension = MASS * (speed**2 * (LENGTH**2 - x**2) / 2 - axial * (LENGTH - x)) + end
        change = -MASS * (speed**2 * x - axial)
        load = MASS * ((speed * c) ** 2 * u - across)
        return np.array(
            [slope, moment / STIFFNESS, shear, tension * moment / STIFFNESS + change * slope + load]
        )

    def ends(root: np.ndarray, tip: np.ndarray) -> np.ndarray:
        u, slope, moment, shear = tip
        force = BODY.mass * ((speed * c) ** 2 * (u + BODY.offset * slope) - across)
        return np.array(
            [
                *root[:2],
                shear - end * slope + force,
                moment + BODY.offset * (end * slope - force) + tilting * slope,
            ]
        )

    x = np.linspace(0, LENGTH, 41)
    solution = solve_bvp(slopes, ends, x, np.zeros((4, 41)), tol=1e-10, max_nodes=100_000)
    assert solution.success
    return solution.y[2, 0]


@pytest.mark.parametrize("mount", [bd.Mount(0.5, 0.4, 0.7), bd.Mount(0.3, 2.5)])
@pytest.mark.parametrize("modes", [2, 5])
def test_steady_rotation(mount: bd.Mount, modes: int) -> None:
    """Right within the stated error, which is small."""
    scene = replace(HANGING, mount=mount, motion=bd.SteadyRotation(8.0), gravity=0.0)
    run = bd.simulate(scene, 0.1, modes, initial="equilibrium")
    expected = steady_moment(mount, 8.0) * FIBRE / STIFFNESS
    error = abs(run.root_strain([0.05])[0] - expected)
    assert 0 < error <= run.root_strain_error < {2: 0.01, 5: 1e-4}[modes] * abs(expected)


@pytest.fixture(scope="module", params=[False, True], ids=["rigid", "stretch"])
def reference(request: pytest.FixtureRequest) -> tuple[bd.Scene, np.ndarray, np.ndarray]:
    """Strain during a smooth spin-up on a road, by the curvature of polynomials at the root."""
    motion = bd.RollingWheel(0.5, bd.SpinUp(6.0, 0.8), bd.RoadWave(1.0, velocity_amplitude=0.05))
    scene = bd.Scene(
        BEAM, bd.Mount(0.5, 0.1, 0.3), motion, damping_ratio=0.03, physics=bd.Physics(stretch=request.param)
    )
    run, t = bd.simulate(scene, 1.0, None, 1e-7, discretization=bd.Ritz(9)), np.linspace(0, 1, 201)
    curvature = run.at(t)[0] @ run.system.equations.deflection(np.zeros(1), order=2)[:, 0] / LENGTH**2
    return scene, t, curvature * FIBRE


@pytest.mark.parametrize(
    ("modes", "discretization"), [(1, "ritz"), (3, "ritz"), (6, "ritz"), (3, bd.Fem(12))]
)
def test_transient(
    reference: tuple[bd.Scene, np.ndarray, np.ndarray], modes: int, discretization: str | bd.Fem
) -> None:
    """Within its error, which is far below that of the curvature of as many modes."""
    scene, t, expected = reference
    run = bd.simulate(scene, 1.0, modes, discretization=discretization)
    largest = np.abs(expected).max()
    error = np.abs(run.root_strain(t) - expected).max()
    assert error <= run.root_strain_error + 1e-6 * largest
    assert run.root_strain_error < {1: 0.05, 3: 0.004, 6: 0.001}[modes] * largest


def test_sudden_load() -> None:
    """The worst that the modes left out can do: each rings with its share of the static strain."""
    scene = replace(HANGING, damping_ratio=0.0)
    reference, t = bd.simulate(scene, 2.0, modes=16), np.linspace(0, 2, 1001)
    expected = reference.root_strain(t)
    for modes in (1, 2, 5):
        run = bd.simulate(scene, 2.0, modes)
        error = np.abs(run.root_strain(t) - expected).max()
        assert error <= run.root_strain_error + reference.root_strain_error
        assert run.root_strain_error < 6 * error


def test_needs_an_outer_fibre() -> None:
    beam = replace(BEAM, outer_fibre=None)
    run = bd.simulate(replace(HANGING, beam=beam), 0.1, modes=1)
    with pytest.raises(ValueError, match="outer_fibre"):
        run.root_strain([0.05])


def test_stock_methods_do_not_state_an_error() -> None:
    assert math.isnan(bd.simulate(HANGING, 0.1, modes=1, method="DOP853").root_strain_error)


def test_error_on_a_sampled_motion() -> None:
    """Steps over many samples: the stated error covers the distance from a run at a tight tolerance."""
    t = np.linspace(0, 1, 1001)
    record = bd.SampledRotation(tuple(t), tuple(5 * np.sin(7 * t) ** 2))
    scene = bd.Scene(BEAM, bd.Mount(0.3, 0.4), record, damping_ratio=0.02)
    rough, tight = (bd.simulate(scene, 1.0, 3, tolerance=tolerance) for tolerance in (1e-3, 1e-9))
    times = np.linspace(0, 1, 400)
    distance = np.abs(rough.root_strain(times) - tight.root_strain(times)).max()
    assert 0 < distance <= rough.root_strain_error < 0.1 * np.abs(tight.root_strain(times)).max()


@pytest.mark.parametrize("springs", [(math.inf, math.inf), (300.0, 200.0), (300.0, math.inf)])
@pytest.mark.parametrize("twist", [None, (0.4, 0.9)])
@pytest.mark.parametrize(
    "physics", [bd.Physics(planes=2), bd.Physics(shear=True), bd.Physics(2, True, True)], ids=str
)
def test_weight_in_two_planes(
    physics: bd.Physics, twist: tuple[float, float] | None, springs: tuple[float, float]
) -> None:
    """The moment of the weights about the axis of bending of the section at the root, with a few modes."""
    if physics.planes == 1 and twist:
        twist = None  # a beam of one plane does not use it
    beam = bd.Beam.from_stiffness(
        LENGTH,
        MASS,
        STIFFNESS,
        outer_fibre=FIBRE,
        tip=BODY,
        second_bending_stiffness=4 * STIFFNESS,
        twist=twist and bd.Table([0, 1], twist),
        shear_stiffness=1e4,
        second_shear_stiffness=2e4,
        rotary_inertia=0.02,
        second_rotary_inertia=0.05,
    )
    scene = replace(HANGING, beam=beam, mount=bd.Mount(0.0, 0.0, 0.5, *springs), physics=physics)
    run = bd.simulate(scene, 0.1, 3, initial="equilibrium")
    moment = -9.81 * (MASS * LENGTH**2 / 2 + BODY.mass * (LENGTH + BODY.offset))
    angle = 0.5 + (twist[0] if twist else 0.0)
    expected = moment * math.cos(angle) * FIBRE / STIFFNESS
    assert run.root_strain([0.05])[0] == pytest.approx(expected, rel=1e-9)


def test_a_hinge_has_no_moment() -> None:
    """Nor do its modes bend there, while the beam moves; a soft spring has the moment of its own turning."""
    scene = replace(HANGING, mount=bd.Mount(0.0, math.pi, 0.0, 0.0), motion=bd.SpinUp(4.0, 0.3), gravity=0.0)
    run, soft = (
        bd.simulate(replace(scene, mount=bd.Mount(0.5, math.pi, 0.0, spring)), 0.5, modes)
        for spring, modes in ((0.0, 3), (SOFT, 12))
    )
    xi = np.linspace(0, 1, 11)
    curvature = run.coordinates @ run.system.equations.deflection(xi, 2)
    assert np.abs(curvature[:, 0]).max() < 1e-9 * np.abs(curvature).max()
    assert run.largest > 0.01 * LENGTH and not run.root_strain(run.t).any()
    slope = soft.coordinates @ soft.system.equations.deflection(np.zeros(1), 1)[:, 0] / LENGTH
    error = np.abs(soft.root_strain(soft.t) - SOFT * slope * FIBRE / STIFFNESS).max()
    assert error <= soft.root_strain_error < 0.01 * SOFT * np.abs(slope).max() * FIBRE / STIFFNESS
