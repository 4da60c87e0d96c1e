"""Transients of large deflection: energy, reversal in time, the linear limit, and the stated error."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.modes.modal.model import ModalBasis, Model
from beamdyn.transient.elastica_steps import propagate_elastica
from beamdyn.transient.elastica_system import ElasticaSystem
from benchmarks.cases.scenes import HARVESTER

ELASTICA = bd.Physics(large_deflection=True)
STILL = replace(HARVESTER, physics=ELASTICA, motion=bd.SteadyRotation(0.0))
FIRST_PERIOD = 1 / 65.23  # of the harvester at rest [s]
TIPPED = bd.TipMass(1e-4, offset=2e-3, inertia=1e-9)


def system_of(scene: bd.Scene, modes: int) -> ElasticaSystem:
    assert scene.motion is not None
    return ElasticaSystem.of_model(Model(scene, bd.Ritz(12)), ModalBasis(modes), scene.motion)


def bent_to(system: ElasticaSystem, deflection: float) -> np.ndarray:
    """Coordinates of the first mode that deflect the tip by so many metres."""
    first = np.eye(system.size)[0]
    scale = 2 * deflection / system.equations.tip[0]
    return first * brentq(lambda x: system.deflections(x * first)[0] - deflection, 0.0, scale)


def test_energy_of_a_free_motion_does_not_drift() -> None:
    """At 0.3 L for 300 periods: the energy swings by the error of a step, below 1e-6, and its mean stays.

    Each step takes two periods of the second mode: longer ones can excite it, which `simulate` notices.
    """
    system, steps = system_of(STILL, 2), 900
    q = bent_to(system, 0.3 * 0.05)
    run = propagate_elastica(system, 0.0, 300 * FIRST_PERIOD, steps, q, np.zeros(2), 8)
    energy = system.energy(np.zeros(steps + 1), run.state[:, 1:3], run.state[:, 3:])
    change = energy / energy[0] - 1
    assert np.abs(change).max() < 1e-6
    thirds = [part.mean() for part in np.array_split(change, 3)]
    assert np.ptp(thirds) < 0.1 * np.abs(change).max()  # each third averages over 300 steps
    assert np.abs(system.deflections(run.state[:, 1:3])).max() > 0.29 * 0.05


@pytest.mark.parametrize("bending", [0.0, math.pi / 2])
def test_energy_stays_constant_at_a_steady_speed(bending: float) -> None:
    """Without gravity, with a tip body and rotary inertia, in the plane of rotation and out of it."""
    physics = bd.Physics(large_deflection=True, rotary_inertia=True)
    beam = replace(HARVESTER.beam, tip=TIPPED)
    scene = bd.Scene(beam, bd.Mount(0.1, 0.8, bending), bd.SteadyRotation(40.0), physics=physics)
    system = system_of(scene, 2)
    start = np.concatenate([bent_to(system, 0.01), np.zeros(2)])
    run = bd.simulate(scene, 0.3, 2, tolerance=1e-9, initial=start, discretization=bd.Ritz(12))
    energy = run.energy(run.t[::8])
    kinetic = np.abs(run.velocities[::8]).max() ** 2 / 2
    assert np.ptp(energy) < 1e-8 * kinetic  # of the tolerance, with a margin of ten


def test_a_motion_turned_back_in_time_returns() -> None:
    """The method is symmetric: back over the same steps, only rounding errors remain."""
    system, steps = system_of(STILL, 3), 60
    q = bent_to(system, 0.3 * 0.05)
    there = propagate_elastica(system, 0.0, 20 * FIRST_PERIOD, steps, q, np.zeros(3), 8).state[-1]
    back = propagate_elastica(system, 0.0, 20 * FIRST_PERIOD, steps, there[1:4], -there[4:], 8).state[-1]
    assert np.abs(back[1:4] - q).max() < 1e-9 * np.abs(q).max()
    assert np.abs(there[1:4] - q).max() > 1e-3 * np.abs(q).max()


def scene_of_small_motion(physics: bd.Physics, size: float) -> bd.Scene:
    """A spin-up whose loads are proportional to the size, to the first order."""
    motion = bd.SpinUp(20.0 * size, duration=0.1)
    return replace(HARVESTER, mount=bd.Mount(0.02, 1.2), motion=motion, damping_ratio=0.01, physics=physics)


def test_small_motions_are_those_of_linear_theory() -> None:
    """The difference falls as the square of the motion, besides the squared speed that both have alike."""
    distance = []
    for size in (1.0, 0.5):
        runs = [
            bd.simulate(scene_of_small_motion(p, size), 0.2, 2, tolerance=1e-10)
            for p in (bd.Physics(), ELASTICA)
        ]
        distance.append(runs[1].distance_from(runs[0]) / runs[0].largest)
        linear, bent = (run.energy(np.linspace(0.1, 0.2, 21)) for run in runs)  # after the spin-up
        assert bent == pytest.approx(linear, abs=1e-3 * float(np.abs(linear).max()))
    assert distance[0] < 1e-4
    assert distance[1] < 0.5 * distance[0]


SWUNG = replace(
    HARVESTER,
    physics=ELASTICA,
    gravity=9.81,
    damping_ratio=0.002,
    mount=bd.Mount(0.215, math.radians(60)),
    motion=bd.SpinUp(80.0, duration=0.03),
)
TIMES = np.linspace(0, 0.06, 61)


@pytest.fixture(scope="module")
def exact_tip() -> np.ndarray:
    """Tip deflection of `SWUNG` in two modes, by solve_ivp piece by piece: the motion is smooth in each."""
    system = system_of(SWUNG, 2)
    parts, y = [], np.zeros(4)
    for a, b, inside in ((0.0, 0.03, TIMES[:31]), (0.03, 0.06, TIMES[31:])):
        exact = solve_ivp(system.rhs, (a, b), y, "DOP853", rtol=1e-11, atol=1e-15, dense_output=True)
        parts.append(system.deflections(exact.sol(inside)[:2].T)[:, 0])
        y = exact.y[:, -1]
    return np.concatenate(parts)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-4, 1e-6])
def test_the_stated_error_covers_the_true_one(tolerance: float, exact_tip: np.ndarray) -> None:
    """Against solve_ivp on the same equations, with gravity, damping and a deflection of 0.1 L."""
    run = bd.simulate(SWUNG, 0.06, 2, tolerance=tolerance, discretization=bd.Ritz(12))
    true = np.abs(run.deflection(TIMES) - exact_tip).max()
    assert run.largest > 0.1 * 0.05
    assert true <= run.time_error <= tolerance * run.largest


BENDING_ANGLES = (0.0, math.pi / 2, math.pi)


def loaded_system(bending_angle: float) -> ElasticaSystem:
    """With every load: three modes of a beam with a tip body and rotary inertia that spins up."""
    physics = bd.Physics(large_deflection=True, rotary_inertia=True)
    mount, motion = bd.Mount(0.2, 0.7, bending_angle), bd.SpinUp(80.0, duration=1.0)
    beam = replace(HARVESTER.beam, tip=TIPPED)
    scene = bd.Scene(beam, mount, motion, gravity=9.81, damping_ratio=0.01, physics=physics)
    return system_of(scene, 3)


SIZES = 1e-3, 0.1, 50.0  # of coordinates, rates and accelerations at which all terms count


def test_the_cheap_form_of_the_equations_is_the_plain_one() -> None:
    """By the matrix of the mass as by the positions of the masses, in every plane and with every load."""
    random = np.random.default_rng(4)
    for bending in BENDING_ANGLES:
        system = loaded_system(bending)
        q, v, a = (random.normal(size=(5, 3)) * size for size in SIZES)
        root = system.root(np.linspace(0.1, 0.9, 5))
        cheap = system.residual(system.carrier(root), q, v, a)
        plain = system.elastica.at(q).work(v, a, root)
        assert cheap == pytest.approx(plain, rel=1e-9, abs=1e-12 * np.abs(plain).max())


def test_derivatives_are_those_of_the_residual() -> None:
    """Central differences over 2e-4 of the size: their error is about its square, 1e-8."""
    random = np.random.default_rng(5)
    for bending in BENDING_ANGLES:
        system = loaded_system(bending)
        motion = [random.normal(size=(1, 3)) * size for size in SIZES]
        carrier = system.carrier(system.root(np.array([0.4])))
        tangents = system.tangents(carrier, *motion, system.residual(carrier, *motion))
        for i, (name, size) in enumerate(zip(("stiffness", "damping", "mass"), SIZES, strict=True)):
            stated, columns = tangents[i, 0], []
            for step in 1e-4 * size * np.eye(3):
                ahead, behind = (
                    system.residual(carrier, *(x + sign * step * (j == i) for j, x in enumerate(motion)))[0]
                    for sign in (1, -1)
                )
                columns.append((ahead - behind) / (2e-4 * size))
            difference = np.abs(np.array(columns).T - stated).max()
            assert difference < 1e-6 * np.abs(stated).max(), name
