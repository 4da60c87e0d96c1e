"""Growth rates of free motion against the monodromy matrix of one turn, on roads that repeat each turn."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np
import pytest
import scipy.linalg

import beamdyn as bd
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.modes.modal.model import Model
from beamdyn.scene.motion.base import MotionSample
from beamdyn.steady.periodic_system import periodic_system
from beamdyn.steady.stability import growth_rate
from benchmarks.cases.scenes import HARVESTER


def rolling(waves: float, amplitude: float, **changes: object) -> bd.Scene:
    """The harvester on a road with so many waves a turn."""
    road = bd.RoadWave(wavelength=2 * math.pi * 0.3 / waves, velocity_amplitude=amplitude)
    return replace(HARVESTER, motion=bd.RollingWheel(0.3, speed=55.0, road=road), **changes)


@dataclass(frozen=True)
class ShiftedRoad:
    """A rolling wheel at steady speed [rad/s] whose road is shifted by a phase [rad]."""

    wheel: bd.RollingWheel
    speed: float
    phase: float

    def at(self, t: np.ndarray) -> MotionSample:
        angle, speed = self.speed * t, np.full(t.shape, self.speed)
        road = (self.wheel.road_multiple or 0.0) * angle + self.phase
        return MotionSample(angle, speed, 0 * angle, self.wheel.steady_acceleration(speed, angle, road))


def monodromy_growth(equations: Equations, motion: ShiftedRoad) -> float:
    """Growth rate from one turn, cut into steps of a fourth-order Magnus integrator."""
    steps, n = 600, equations.size
    h = 2 * math.pi / motion.speed / steps
    t = (np.arange(steps)[:, None] + 0.5 + np.array([-1, 1]) * math.sqrt(3) / 6).ravel() * h
    root = equations.root(motion.at(t))
    A = np.zeros((len(t), 2 * n, 2 * n))
    A[:, :n, n:] = np.eye(n)
    A[:, n:, :n], A[:, n:, n:] = -equations.matrix(0, root), -equations.matrix(1, root)
    first, second = A[::2], A[1::2]
    omega = h / 2 * (first + second) + math.sqrt(3) / 12 * h**2 * (second @ first - first @ second)
    turn = np.eye(2 * n)
    for step in scipy.linalg.expm(omega):
        turn = step @ turn
    return math.log(np.abs(np.linalg.eigvals(turn)).max()) / (h * steps)


def compare(scene: bd.Scene, speeds: np.ndarray, phases: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Growth rates, their errors, and those of the monodromy matrix, the largest over phases of the road."""
    assert isinstance(scene.motion, bd.RollingWheel)
    equations = Model(scene, bd.Ritz(14)).modal_equations(2)
    rate, error = growth_rate(periodic_system(equations, scene.motion, speeds))
    shifts = 2 * math.pi * np.arange(phases) / phases
    runs = [[monodromy_growth(equations, ShiftedRoad(scene.motion, v, s)) for s in shifts] for v in speeds]
    return rate, error, np.max(runs, axis=1)


def tongues(scene: bd.Scene) -> dict[str, float]:
    """Speeds at the middle of the tongues of the first mode up to second order, by their lines."""
    crossings = bd.resonance_speeds(scene, 150.0, modes=1, order=2)
    return {c.line.name: c.speed for c in crossings if c.kind == "parametric"}


@pytest.mark.parametrize("line", ["2 road + 2 rotation", "2 road", "road +"])
def test_tongues_of_a_strong_road(line: str) -> None:
    """Second-order tongues are as accurate as those of first order."""
    scene = rolling(4, 1.0)
    speeds = tongues(scene)[line] * (1 + np.array([-0.01, 0.0, 0.01]))
    rate, error, expected = compare(scene, speeds, 1)
    assert rate[1] > 0.01 and error[1] < 2e-3 * rate[1]
    np.testing.assert_array_less(np.abs(rate - expected), error + 1e-6 * np.abs(rate) + 1e-8)


def test_narrow_tongue_beside_its_crossing() -> None:
    """Periodic coefficients shift the frequencies, and so the tongue, by more than its width."""
    scene = rolling(4, 1.0)
    rate, _, expected = compare(scene, tongues(scene)["2 rotation"] * np.array([1.0, 1.002]), 8)
    assert rate[0] == 0 and expected[0] == pytest.approx(0, abs=1e-10)
    assert rate[1] == pytest.approx(expected[1], rel=1e-4) and rate[1] > 0.4


def test_growth_depends_on_the_phase_of_a_road_that_repeats() -> None:
    """Three waves a turn: twice the line of the road's difference is that of its sum."""
    scene = rolling(3, 0.3, damping_ratio=2e-4)
    speeds = tongues(scene)["road +"] + np.array([-0.1, 0.1])
    rate, error, expected = compare(scene, speeds, 16)
    lowest = compare(scene, speeds, 1)[2]
    assert (np.ptp([expected, lowest], axis=0) >= 0).all() and (error < 0.01 * rate).all()
    np.testing.assert_array_less(np.abs(rate - expected), error)


def test_decay_under_damping() -> None:
    """Between tongues the modulated beam decays almost as the mean one."""
    scene = rolling(4, 1.0, damping_ratio=0.01)
    rate, error, expected = compare(scene, np.array([40.0, 80.0, 128.0]), 1)
    assert (rate < 0).all() and (error > 0).all()
    np.testing.assert_array_less(np.abs(rate - expected), error)


def test_decay_in_a_tongue_that_damping_closes() -> None:
    """From its edge on, free motion decays more slowly than beside it."""
    scene = rolling(8, 1.058, damping_ratio=0.01, mount=bd.Mount(0.2738049869))
    rate, error, expected = compare(scene, np.array([48.12, 48.13, 48.135, 48.15]), 1)
    assert (np.diff(rate) > 0.05).all() and rate[-1] < 0
    np.testing.assert_array_less(np.abs(rate - expected), error + 1e-6)


def test_response_states_the_error_of_its_growth_rate() -> None:
    scene = rolling(4, 1.0)
    found = bd.steady_response(scene, [tongues(scene)["2 road"]], modes=2)
    assert found.status[0] == "parametric instability"
    assert found.growth_rate[0] == pytest.approx(0.1648, rel=1e-3)  # by the monodromy matrix
    assert 0 < found.growth_rate_error[0] < 1e-4 * found.growth_rate[0]


def test_a_stiffness_that_varies_slowly_shifts_no_growth_rate() -> None:
    """At rest gravity is constant: the error of the growth rate must not grow as the speed falls."""
    heavy = replace(HARVESTER, motion=bd.SteadyRotation(5.0), damping_ratio=1e-3, gravity=9.81)
    slow = bd.steady_response(heavy, [0.0, 0.5, 50.0])
    assert (slow.growth_rate_error < 1e-3 * np.abs(slow.growth_rate)).all() and slow.warnings == ()


@pytest.mark.parametrize(("mode", "others"), [(5, []), (6, []), (7, [5.0])])
def test_automatic_modes_include_those_that_the_road_makes_unstable(mode: int, others: list[float]) -> None:
    """Two modes with static responses suffice for the amplitude, which a weak road hardly changes."""
    mount, speed = bd.Mount(0.215, setting_angle=math.pi / 2), 50.0
    frequencies = bd.natural_modes(replace(HARVESTER, mount=mount), speed, mode).frequency
    waves = 4 * math.pi * frequencies[-1] / speed - 1  # twice the frequency is that of road and rotation
    scene = rolling(waves, 1e-3, mount=mount, gravity=9.81)
    found, many = (bd.steady_response(scene, [*others, speed], modes) for modes in ("auto", 9))
    assert (found.status[-1], many.status[-1]) == ("parametric instability",) * 2
    assert found.growth_rate[-1] == pytest.approx(many.growth_rate[-1], rel=1e-3)
