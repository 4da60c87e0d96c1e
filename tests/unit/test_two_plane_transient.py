"""Transients in two directions: against one plane, other axes, a second route, and stated errors."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Legendre
from numpy.polynomial import Polynomial as P
from scipy.integrate import solve_ivp

import beamdyn as bd
from beamdyn.scene.motion.base import MotionSample
from beamdyn.transient.trajectory import Trajectory

LENGTH, MASS, STIFFNESS, SECOND = 1.2, 2.0, 60.0, 900.0
TWIST = P([0.3, 0.8])
BOTH = bd.Physics(planes=2)
ALL = bd.Physics(planes=2, shear=True, rotary_inertia=True)
T = np.linspace(0, 1, 101)


def beam(stiffness: float = STIFFNESS, second: float | None = SECOND, **given: object) -> bd.Beam:
    """A beam whose sections have all properties; those of a single plane without the second."""
    sections = {"shear_stiffness": 50 * stiffness, "rotary_inertia": 1e-5 * stiffness, "outer_fibre": 0.01}
    if second is not None:
        sections |= {
            "second_bending_stiffness": second,
            "second_shear_stiffness": 50 * second,
            "second_rotary_inertia": 1e-5 * second,
        }
    return bd.Beam.from_stiffness(LENGTH, MASS, stiffness, **(sections | given))  # type: ignore[arg-type]


def tumbling(t: np.ndarray) -> MotionSample:
    """Rotation of changing speed about a centre that is shaken in all three directions."""
    shaken = np.stack([2 * np.sin(7 * t), 1.5 * np.cos(4 * t), 3 * np.sin(5 * t)], axis=-1)
    return MotionSample(5 * t + 1.5 * (1 - np.cos(2 * t)), 5 + 3 * np.sin(2 * t), 6 * np.cos(2 * t), shaken)


TUMBLING = bd.UserMotion(tumbling)
SCENE = bd.Scene(beam(twist=TWIST), bd.Mount(0.3, 2.6, 0.4), TUMBLING, gravity=9.81, physics=BOTH)


def turned(angle: float) -> float:
    return math.remainder(angle, 2 * math.pi)


@pytest.mark.parametrize("quarters", [0, 1, -1])
def test_straight_planes_move_as_one_plane_each(quarters: int) -> None:
    """Without twist, in the plane of rotation and out of it; with shear, rotary inertia and springs."""
    psi = quarters * math.pi / 2
    mount, across = (
        bd.Mount(0.3, 2.6, psi, 400.0, 700.0),
        bd.Mount(0.3, 2.6, turned(psi + math.pi / 2), 700.0),
    )
    scene = replace(SCENE, beam=beam(), mount=mount, physics=ALL)
    both, one = bd.simulate(scene, 1.0, 3, 1e-8), replace(ALL, planes=1)
    each = (
        replace(scene, physics=one),
        replace(scene, physics=one, mount=across, beam=beam(SECOND, None)),
    )
    for direction, run in enumerate(bd.simulate(s, 1.0, 3, 1e-8) for s in each):
        difference = np.abs(both.deflection(T, direction) - run.deflection(T)).max()
        assert difference <= both.time_error + run.time_error + 1e-9 * run.largest
        assert run.largest > 1e-3 * LENGTH


@pytest.mark.parametrize("physics", [BOTH, ALL])
def test_constant_twist_is_another_bending_angle(physics: bd.Physics) -> None:
    tip = bd.TipMass(0.4, 0.05, 0.002, 0.003, 0.001)
    twisted = replace(SCENE, beam=beam(twist=0.35, tip=tip), physics=physics)
    other = replace(twisted, beam=beam(tip=tip), mount=bd.Mount(0.3, 2.6, 0.75))
    one, two = bd.simulate(twisted, 1.0, 4, 1e-9), bd.simulate(other, 1.0, 4, 1e-9)
    c, s = math.cos(0.35), math.sin(0.35)
    along, across = two.deflection(T), two.deflection(T, 1)
    bound = one.time_error + two.time_error + 1e-9 * one.largest
    assert np.abs(one.deflection(T) - (c * along - s * across)).max() <= bound
    assert np.abs(one.deflection(T, 1) - (s * along + c * across)).max() <= bound
    assert one.largest == pytest.approx(two.largest, abs=bound)
    assert one.root_strain(T) == pytest.approx(
        two.root_strain(T), abs=1e-7 * np.abs(two.root_strain(T)).max()
    )


def test_mirror() -> None:
    """Reflection in the plane of rotation turns the twist, and deflections across, into their opposites."""

    def mirrored(t: np.ndarray) -> MotionSample:
        sample = tumbling(t)
        return replace(sample, carrier_acceleration=sample.carrier_acceleration * [1.0, 1.0, -1.0])

    scene = replace(SCENE, physics=ALL)
    image = replace(
        scene, beam=beam(twist=-1.0 * TWIST), mount=bd.Mount(0.3, 2.6, -0.4), motion=bd.UserMotion(mirrored)
    )
    one, two = bd.simulate(scene, 1.0, 4, 1e-8), bd.simulate(image, 1.0, 4, 1e-8)
    bound = one.time_error + two.time_error + 1e-9 * one.largest
    assert np.abs(one.deflection(T) - two.deflection(T)).max() <= bound
    assert np.abs(one.deflection(T, 1) + two.deflection(T, 1)).max() <= bound


@pytest.mark.slow
def test_second_route() -> None:
    """DOP853 on equations along b2, b3 of the facts, written here, over the same polynomials."""
    count, psi, phi, radius = 3, 0.4, 2.6, 0.3
    x, w = np.polynomial.legendre.leggauss(40)
    x, w = (x + 1) / 2, w / 2
    functions = [P([0, 0, 1]) * Legendre.basis(k, [0, 1]).convert(kind=P) for k in range(count)]
    u, du, ddu = (np.array([f.deriv(order)(x) if order else f(x) for f in functions]) for order in range(3))

    def gram(values: np.ndarray, weight: np.ndarray | float) -> np.ndarray:
        return (values * (w * weight)) @ values.T

    angle = psi + TWIST(x)
    c, s = np.cos(angle), np.sin(angle)
    K22, K33, K23 = (
        gram(ddu, weight) / LENGTH**3
        for weight in (
            STIFFNESS * c**2 + SECOND * s**2,
            STIFFNESS * s**2 + SECOND * c**2,
            (STIFFNESS - SECOND) * c * s,
        )
    )
    S, Z = MASS * LENGTH * gram(u, 1.0), np.zeros((count, count))
    KA, KB = gram(du, MASS * (1 - x)), gram(du, MASS * LENGTH * (1 - x**2) / 2)
    load, moment = MASS * LENGTH * (u @ w), MASS * LENGTH**2 * (u @ (w * x))
    elastic, inverse = np.block([[K22, K23], [K23, K33]]), np.linalg.inv(np.block([[S, Z], [Z, S]]))

    def rate(t: float, y: np.ndarray) -> np.ndarray:
        now = tumbling(np.asarray(t))
        (v1, v2, v3), speed, change = now.carrier_acceleration, float(now.speed), float(now.acceleration)
        v2, cos, sin = v2 + 9.81, math.cos(now.angle), math.sin(now.angle)
        outward = speed**2 * radius + v1 * cos - v2 * sin
        onward = change * radius + v1 * sin + v2 * cos
        axial = math.cos(phi) * outward - math.sin(phi) * onward
        inside = math.sin(phi) * outward + math.cos(phi) * onward
        tension = speed**2 * KB - axial * KA
        K = elastic + np.block([[tension - speed**2 * S, Z], [Z, tension]])
        f = np.concatenate([change * moment - inside * load, -v3 * load])
        q, v = np.split(y, 2)
        return np.concatenate([v, inverse @ (f - K @ q)])

    t = np.linspace(0, 0.3, 31)
    exact = solve_ivp(rate, (0, 0.3), np.zeros(4 * count), "DOP853", t, rtol=1e-11, atol=1e-13).y
    end = np.array([f(1.0) for f in functions])
    u2, u3 = end @ exact[:count], end @ exact[count : 2 * count]
    run = bd.simulate(SCENE, 0.3, None, 1e-9, discretization=bd.Ritz(count))
    assert run.system.size == 2 * count
    along, across = math.cos(psi) * u2 + math.sin(psi) * u3, math.cos(psi) * u3 - math.sin(psi) * u2
    bound = run.time_error + 1e-8 * run.largest  # of DOP853, whose rtol holds for a step
    np.testing.assert_allclose(run.deflection(t), along, rtol=0, atol=bound)
    np.testing.assert_allclose(run.deflection(t, 1), across, rtol=0, atol=bound)


@pytest.mark.parametrize("physics", [ALL, bd.Physics(planes=2, shear=True)])
def test_energy_is_constant_at_steady_speed(physics: bd.Physics) -> None:
    scene = replace(SCENE, physics=physics, motion=bd.SteadyRotation(7.0), gravity=0.0)
    run = bd.simulate(scene, 2.0, 5)
    assert isinstance(run.path, Trajectory)
    segment = run.path.segments[0]
    ends = segment.start + segment.h * np.arange(0, len(segment.acceleration), 3)
    kinetic = (run.velocities**2).sum(axis=1).max() / 2
    assert np.ptp(run.energy(ends)) < 1e-10 * kinetic
    assert run.tip_across.any()


def test_magnitudes() -> None:
    run = bd.simulate(SCENE, 1.0, 3, 1e-6)
    assert run.tip == pytest.approx(run.deflection(run.t), rel=1e-12, abs=1e-15)
    assert run.tip_across == pytest.approx(run.deflection(run.t, 1), rel=1e-12, abs=1e-15)
    t = np.linspace(0.2, 0.9, 20001)
    each = [run.deflection(t, direction) for direction in (0, 1)]
    assert run.peak(0.2, 0.9) == pytest.approx(np.hypot(*each).max(), rel=1e-7)
    for direction in (0, 1):
        assert run.peak(0.2, 0.9, direction) == pytest.approx(np.abs(each[direction]).max(), rel=1e-6)
    assert max(np.abs(run.tip).max(), np.abs(run.tip_across).max()) < run.largest
    with pytest.raises(ValueError, match=r"direction.*direction across"):
        run.deflection(t, 2)


def random_scene(seed: int) -> bd.Scene:
    """A blade with all effects, on a spin-up, a tumbling carrier or a road."""
    rng = np.random.default_rng(seed)
    motions = bd.SpinUp(rng.uniform(3, 15), rng.uniform(0.3, 1.0)), TUMBLING
    road = bd.RollingWheel(0.4, motions[0], bd.RoadWave(0.9, velocity_amplitude=0.04))
    springs = rng.choice([math.inf, 3000.0, 300.0], 2).tolist()
    return bd.Scene(
        beam(twist=P(rng.uniform(-1, 1, 2)), tip=[None, bd.TipMass(0.3, 0.02, 0.001)][seed % 2]),
        bd.Mount(rng.uniform(0, 0.5), rng.uniform(1.6, 4.6), rng.uniform(-3, 3), *springs),
        (*motions, road)[rng.integers(3)],
        gravity=9.81 * rng.integers(2),
        physics=bd.Physics(2, bool(rng.integers(2)), True),
    )


@pytest.mark.parametrize("seed", [s if s < 8 else pytest.param(s, marks=pytest.mark.slow) for s in range(20)])
def test_stated_errors_cover(seed: int) -> None:
    """Of the tip's deflection as a vector, and of the strain at the root, against many modes."""
    scene = random_scene(seed)
    tight, run = bd.simulate(scene, 0.6, 14, 1e-8), bd.simulate(scene, 0.6, 4, 1e-4)
    t = np.linspace(0, 0.6, 301)
    errors = [run.deflection(t, direction) - tight.deflection(t, direction) for direction in (0, 1)]
    assert np.hypot(*errors).max() <= run.time_error + run.mode_error * run.largest
    strain = np.abs(run.root_strain(t) - tight.root_strain(t)).max()
    assert strain <= run.root_strain_error
    fine = bd.simulate(scene, 0.6, 4, 1e-9)
    errors = [run.deflection(t, direction) - fine.deflection(t, direction) for direction in (0, 1)]
    assert np.hypot(*errors).max() <= run.time_error + fine.time_error


def test_a_plane_that_nothing_excites_costs_nothing() -> None:
    """Out of the plane a straight blade that spins up stays straight, however stiff it is there."""
    blade = replace(SCENE, beam=beam(second=1e9), gravity=0.0, motion=bd.SpinUp(9.0, 0.4))
    for psi, still in ((0.0, 1), (math.pi / 2, 0)):
        mount = bd.Mount(0.3, 2.6, psi)
        run = bd.simulate(replace(blade, mount=mount, beam=beam()), 0.5, 3)
        assert run.system.size == 3
        assert not (run.tip, run.tip_across)[still].any()
        assert (run.tip, run.tip_across)[1 - still].any()
    shaken = bd.simulate(replace(blade, mount=mount, motion=TUMBLING), 0.5, 3)
    assert shaken.system.size == 6


def test_a_hinge_at_rest_has_no_equilibrium_but_moves() -> None:
    """Its error is covered although its frequency is 0 where it starts."""
    hinged = replace(SCENE, mount=bd.Mount(0.3, math.pi, 0.0, 0.0), gravity=0.0, damping_ratio=0.01)
    scene = replace(hinged, beam=beam(), motion=bd.SpinUp(9.0, 0.3))
    with pytest.raises(ValueError, match=r"initial.*turns freely on its hinge.*root_stiffness"):
        bd.simulate(scene, 0.5, 3, initial="equilibrium")
    run, fine = bd.simulate(scene, 0.5, 3, 1e-4), bd.simulate(scene, 0.5, 3, 1e-9)
    t = np.linspace(0, 0.5, 201)
    assert run.time_error <= 1e-4 * run.largest
    assert np.abs(run.deflection(t) - fine.deflection(t)).max() <= run.time_error + fine.time_error
    assert np.isfinite(run.energy(t)).all()


def test_damped_shear_without_its_own_mass() -> None:
    """Modes at rest and at speed, from equations whose mass is singular."""
    scene = replace(SCENE, physics=bd.Physics(planes=2, shear=True), damping_ratio=0.02)
    spun = replace(scene, motion=bd.SpinUp(9.0, 0.3))
    run, tight = bd.simulate(spun, 0.5, tolerance=1e-3), bd.simulate(spun, 0.5, 12, 1e-8)
    assert run.mode_error <= 1e-3
    t = np.linspace(0, 0.5, 201)
    errors = [run.deflection(t, direction) - tight.deflection(t, direction) for direction in (0, 1)]
    assert np.hypot(*errors).max() <= run.time_error + run.mode_error * run.largest
