"""Harmonic balance by its series against one matrix over all harmonics; the largest of a sum of lines."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modes.modal.discretization_choice import choose_model
from beamdyn.steady.harmonic_balance import _Series, solve_at_once, solve_harmonic_balance, sum_interactions
from beamdyn.steady.largest_over_phases import largest_over_phases
from beamdyn.steady.periodic_system import Pair, PeriodicSystem, generate_harmonics, periodic_system
from beamdyn.steady.stability import _MeanMotion, growth_rate
from benchmarks.cases.scenes import HARVESTER, STEADY_ROLLING, STEADY_ROLLING_IN_GRAVITY

FLAT = bd.Beam.from_stiffness(10.0, 100.0, 1e6, axial_stiffness=1e8, second_bending_stiffness=4e6)
GYROSCOPIC = bd.Scene(  # stretch couples with bending through the speed
    FLAT,
    bd.Mount(1.0, 2.0, 0.3),
    bd.SteadyRotation(5.0),
    damping_ratio=0.02,
    gravity=9.81,
    physics=bd.Physics(planes=2, stretch=True),
)
WEAKLY_COUPLED = {
    "undamped": STEADY_ROLLING,
    "damped, in gravity": replace(STEADY_ROLLING_IN_GRAVITY, damping_ratio=0.01),
}
STRONGLY_COUPLED = {  # and the top speed
    "heavy": (replace(STEADY_ROLLING, gravity=1000.0), 150.0),
    "gyroscopic": (GYROSCOPIC, 8.0),
}


def system_of(scene: bd.Scene, speeds: np.ndarray) -> PeriodicSystem:
    equations = choose_model(scene, "ritz", speeds, 3).modal_equations(3)
    return periodic_system(equations, scene.motion, speeds)


def harmonics_of(system: PeriodicSystem) -> list[Pair]:
    levels = generate_harmonics(system.load_harmonics, system.coupling, 3)
    return [h for level in levels for h in level]


# Series -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", WEAKLY_COUPLED)
def test_series_is_the_solution_of_all_harmonics_at_once(name: str) -> None:
    system = system_of(WEAKLY_COUPLED[name], np.linspace(1.5, 150.0, 23))
    harmonics = harmonics_of(system)
    response, settled = sum_interactions(system, harmonics, _Series.by_modes)
    assert settled.all()
    # Rounding, which resonance of some harmonic at these speeds raises by up to 1e3.
    assert_close(response, solve_at_once(system, harmonics), 1e-12)


@pytest.mark.parametrize("name", STRONGLY_COUPLED)
def test_equations_that_the_series_does_not_settle_are_solved_at_once(name: str) -> None:
    scene, top = STRONGLY_COUPLED[name]
    system = system_of(scene, np.linspace(0.01 * top, top, 23))
    harmonics = harmonics_of(system)
    response, settled = sum_interactions(system, harmonics, _Series.by_modes)
    assert not settled.all() and np.isnan(response[~settled]).all()
    assert_close(solve_harmonic_balance(system, harmonics), solve_at_once(system, harmonics), 1e-11)


def test_series_by_matrices_settles_where_a_circuit_couples_the_modes() -> None:
    """The circuit's flux has no stiffness, so that there is no series in undamped modes."""
    scene = bd.load_scene("examples/bimorph.toml")
    system = system_of(scene, np.linspace(1.5, 130.0, 23))
    harmonics = harmonics_of(system)
    assert not sum_interactions(system, harmonics, _Series.by_modes)[1].any()
    response, settled = sum_interactions(system, harmonics, _Series.by_matrices)
    assert settled.all()
    assert_close(response, solve_at_once(system, harmonics), 1e-12)


def assert_close(found: np.ndarray, expected: np.ndarray, rtol: float) -> None:
    """Assert that responses (S, H, n) agree, relative to the sum of all harmonics at each speed."""
    size = np.abs(expected).sum(axis=(1, 2), keepdims=True)
    assert (np.abs(found - expected) <= rtol * size).all()


# Stability ----------------------------------------------------------------------------------------


def test_smaller_discs_leave_out_no_tongue(monkeypatch: pytest.MonkeyPatch) -> None:
    """Speeds across tongues of first and second order, with discs as large as the row sums, and smaller."""
    road = bd.RoadWave(wavelength=2 * math.pi * 0.3 / 4, velocity_amplitude=0.2)
    scene = replace(HARVESTER, motion=bd.RollingWheel(0.3, 55.0, road))
    lines = [c.speed for c in bd.resonance_speeds(scene, 150.0, modes=1, order=2) if c.kind == "parametric"]
    speeds = np.ravel(np.array(lines)[:, None] * (1 + np.linspace(-0.006, 0.006, 7)))
    system = system_of(scene, np.sort(speeds))
    computed = count_resonances(monkeypatch)
    rate, error = growth_rate(system)
    few = len(computed)
    monkeypatch.setattr(_MeanMotion, "shrunk_radius", lambda self, harmonics: self.radius)
    expected, of_expected = growth_rate(system)
    assert few < 0.8 * (len(computed) - few) and (rate > 0).sum() >= 3
    np.testing.assert_array_equal(rate > 0, expected > 0)
    assert (np.abs(rate - expected) <= error + of_expected + 1e-9 * rate).all()


def count_resonances(monkeypatch: pytest.MonkeyPatch) -> list[float]:
    """List to which each resonance whose eigenvalues are computed adds the rate of rotation."""
    from beamdyn.steady import stability

    computed, compute = [], stability._Resonance.growth_rate

    def counting(self: stability._Resonance, scale: float) -> tuple[float, float]:
        computed.append(self.rates[0])
        return compute(self, scale)

    monkeypatch.setattr(stability._Resonance, "growth_rate", counting)
    return computed


# Largest over the phases --------------------------------------------------------------------------


def on_a_grid(a: np.ndarray, h: np.ndarray, count: int = 360) -> np.ndarray:
    phase = 2 * math.pi / count * np.arange(count)
    angle = h[:, 0, None, None] * phase[:, None] + h[:, 1, None, None] * phase
    u = np.tensordot(np.real(a), np.cos(angle), 1) - np.tensordot(np.imag(a), np.sin(angle), 1)
    return np.hypot.reduce(u, axis=1).max(axis=(1, 2))


@pytest.mark.slow
@pytest.mark.parametrize("real", [True, False], ids=["symmetric", "any"])
@pytest.mark.parametrize("directions", [1, 2])
def test_largest_of_a_sum_of_lines(directions: int, real: bool) -> None:
    """Symmetric sums have saddles at round phases, where the slope is 0."""
    rng = np.random.default_rng(3)
    h = np.array([(0, 0), (1, 0), (0, 1), (1, 1), (-1, 1)])
    a = 10.0 ** rng.uniform(-1, 0, (100, 1, 5)) * rng.standard_normal((100, directions, 5)) + 0j
    if not real:
        a *= np.exp(2j * math.pi * rng.random(a.shape))
    sampled, largest = on_a_grid(a, h), largest_over_phases(a, h)
    assert (largest >= sampled * (1 - 1e-12)).all()
    assert (largest <= sampled * (1 + 2e-3)).all()  # of the grid: (degree pi / 360)^2 times the sum over that


def test_a_weak_line_decides_along_the_crests_of_a_strong_one() -> None:
    strong, weak = 1.0, 1e-4
    h = np.array([(1, 0), (2, 3), (1, -2)])
    a = np.array([[[strong, weak, 1j * weak]]])
    assert largest_over_phases(a, h)[0] == pytest.approx(on_a_grid(a, h, 720)[0], rel=1e-7)
    assert largest_over_phases(a[..., :2], h[:2])[0] == pytest.approx(strong + weak, rel=1e-12)


def test_nothing_to_sum() -> None:
    assert largest_over_phases(np.zeros((2, 1, 0), dtype=complex), np.zeros((0, 2), dtype=int)).tolist() == [
        0,
        0,
    ]
    assert largest_over_phases(np.zeros((2, 1, 1), dtype=complex), np.ones((1, 2), dtype=int)).tolist() == [
        0,
        0,
    ]
