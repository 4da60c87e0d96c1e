"""The series for weakly modulated systems against the same steps, each factorised."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.equations.fields.field import Term
from beamdyn.modes.modal.model import Model
from beamdyn.transient import weakly_modulated
from beamdyn.transient.gauss import propagate
from beamdyn.transient.integration import integrate
from beamdyn.transient.scipy_integrators import integrate_by_solve_ivp
from beamdyn.transient.system import ModalSystem
from beamdyn.transient.weakly_modulated import propagate_modulated
from benchmarks.cases.scenes import ROLLING

SCENES = {
    "published": ROLLING,
    "gravity": replace(ROLLING, gravity=9.81),
    "damped": replace(ROLLING, damping_ratio=0.01),
    "stretch, oblique": replace(
        ROLLING, physics=bd.Physics(stretch=True), mount=bd.Mount(0.215, 0.1, 0.3), damping_ratio=0.001
    ),
    "without road": replace(ROLLING, motion=replace(ROLLING.motion, road=None)),
}


@pytest.mark.parametrize("name", SCENES)
def test_series_agrees_with_steps_factorised_one_by_one(name: str) -> None:
    scene = SCENES[name]
    system = ModalSystem(Model(scene, bd.Ritz(16)).modal_equations(3), scene.motion)
    y = np.random.default_rng(1).standard_normal(2 * system.size) * 1e-6
    modulated, n, steps = system.modulated(10.0, 14.0), system.size, 430
    series = propagate_modulated(modulated, 10.0, 14.0, steps, y[:n], y[n:], 8, accuracy=1e-6)
    exact = propagate(system, 10.0, 14.0, steps, y[:n], y[n:], 8)
    for found, wanted in ((series.state, exact.state), (series.acceleration, exact.acceleration)):
        scale = np.abs(wanted).max(axis=tuple(range(wanted.ndim - 1)))
        assert (np.abs(found - wanted) <= 1e-6 * scale).all()


def test_error_is_of_third_order_in_the_modulation() -> None:
    system = ModalSystem(Model(ROLLING, bd.Ritz(16)).modal_equations(2), ROLLING.motion)
    y, errors = np.full(4, 1e-6), []
    for amplitude in (0.1, 0.2):
        road = bd.RoadWave(0.3, velocity_amplitude=amplitude)
        strong = replace(system, motion=replace(ROLLING.motion, road=road))
        modulated = strong.modulated(10.0, 10.1)
        series = propagate_modulated(modulated, 10.0, 10.1, 10, y[:2], y[2:], 8, accuracy=1.0)
        exact = propagate(strong, 10.0, 10.1, 10, y[:2], y[2:], 8)
        free = exact.state[-1, 1:3]
        errors.append(np.abs(series.state[-1, 1:3] - free).max() / np.abs(free).max())
    assert 6 < errors[1] / errors[0] < 11


@pytest.mark.parametrize("name", SCENES)
@pytest.mark.parametrize("start, end, steps", [(0.0, 2.5, 267), (2.5, 10.0, 801)])
def test_changing_speed_agrees_with_steps_factorised_one_by_one(name, start, end, steps) -> None:
    """Within the accuracy asked for, relative to the largest of each quantity, as the plain steps have it."""
    scene = SCENES[name]
    system = ModalSystem(Model(scene, bd.Ritz(16)).modal_equations(3), scene.motion)
    y = np.random.default_rng(1).standard_normal(2 * system.size) * 1e-6
    modulated, n = system.modulated(start, end), system.size
    found = propagate_modulated(modulated, start, end, steps, y[:n], y[n:], 8, accuracy=1e-6)
    exact = propagate(system, start, end, steps, y[:n], y[n:], 8)
    for ours, wanted in ((found.state, exact.state), (found.acceleration, exact.acceleration)):
        scale = np.abs(wanted).max(axis=tuple(range(wanted.ndim - 1)))
        assert (np.abs(ours - wanted) <= 1e-6 * scale).all()


def test_single_precision_of_the_second_order_is_far_below_the_accuracy(monkeypatch) -> None:
    """It is taken where 1e-6 of the second order is within the accuracy; rounding is 6e-8 of it."""
    system = ModalSystem(Model(ROLLING, bd.Ritz(16)).modal_equations(3), ROLLING.motion)
    zero, modulated, accuracy = np.zeros(system.size), system.modulated(2.5, 10.0), 1e-6
    states = []
    for rounding in (weakly_modulated._SINGLE_ROUNDING, np.inf):
        monkeypatch.setattr(weakly_modulated, "_SINGLE_ROUNDING", rounding)
        segment = propagate_modulated(modulated, 2.5, 10.0, 801, zero, zero, 8, accuracy)
        assert segment is not None
        states.append(segment.state[:, 1 : system.size + 1])
    difference = np.abs(states[0] - states[1]).max() / np.abs(states[1]).max()
    assert 0 < difference < 0.1 * accuracy


def test_strong_modulation_is_declined() -> None:
    system = ModalSystem(Model(ROLLING, bd.Ritz(16)).modal_equations(2), ROLLING.motion)
    modulated = system.modulated(10.0, 30.0)
    assert propagate_modulated(modulated, 10.0, 30.0, 2000, *np.zeros((2, 2)), 8, accuracy=1e-12) is None


def test_few_steps_and_a_speed_that_changes_too_fast_are_declined() -> None:
    """A speed that wavers a hundred times needs more Chebyshev polynomials than are tried."""
    equations = Model(ROLLING, bd.Ritz(16)).modal_equations(2)
    system = ModalSystem(equations, ROLLING.motion)
    modulated = system.modulated(5.0, 5.2)
    assert propagate_modulated(modulated, 5.0, 5.2, 20, *np.zeros((2, 2)), 8, accuracy=1e-6) is None

    def slow(t):
        return None, modulated.slow(t)[1] * (1 + 0.01 * np.sin(200 * np.pi * t / 7))[..., None, None]

    wavering = replace(modulated, slow=slow)
    assert propagate_modulated(modulated, 3.0, 10.0, 700, *np.zeros((2, 2)), 8, accuracy=1e-6) is not None
    assert propagate_modulated(wavering, 3.0, 10.0, 700, *np.zeros((2, 2)), 8, accuracy=1e-6) is None


def with_transverse_stiffness(system: ModalSystem, share: float) -> ModalSystem:
    """The system with a further stiffness term that the root's transverse acceleration multiplies."""
    (field,) = system.equations.blocks
    matrix = share * np.diag(system.equations.matrices[0]["unity"])[0] * np.eye(system.size)
    term = Term("test", field, field, 0, matrix, "root_transverse")
    return replace(system, equations=replace(system.equations, terms=(*system.equations.terms, term)))


@pytest.mark.slow
def test_a_term_on_any_varying_quantity_is_treated() -> None:
    """Two varying stiffnesses: the series agrees with DOP853, in as few steps as one of them takes."""
    system = ModalSystem(Model(ROLLING, bd.Ritz(16)).modal_equations(3), replace(ROLLING.motion, speed=55.0))
    both, y0 = with_transverse_stiffness(system, 0.003), np.array([1e-6, 0, 0, 0, 0, 0])
    assert len(both.modulated(0.0, 0.2).G) == 2
    path, error, method = integrate(both, y0, 0.2, 1e-5)
    exact = integrate_by_solve_ivp(both, y0, 0.2, "DOP853", 1e-11, {})
    t = np.linspace(0, 0.2, 1001)
    tip = exact.at(t)[0] @ both.tip
    assert np.abs(path.at(t)[0] @ both.tip - tip).max() <= error <= 1e-5 * np.abs(tip).max()
    _, _, method_of_one = integrate(system, y0, 0.2, 1e-5)
    steps, steps_of_one = (int(words.split()[-2]) for words in (method, method_of_one))
    assert steps <= 1.1 * steps_of_one
    unchanged = integrate(system, y0, 0.2, 1e-5)[0].at(t)[0] @ system.tip
    assert np.abs(unchanged - tip).max() > 500 * error  # the term matters


def test_varying_damping_is_declined() -> None:
    system = ModalSystem(Model(ROLLING, bd.Ritz(16)).modal_equations(2), replace(ROLLING.motion, speed=55.0))
    (field,) = system.equations.blocks
    term = Term("test", field, field, 1, np.eye(2), "root_axial")
    damped = replace(system, equations=replace(system.equations, terms=(*system.equations.terms, term)))
    assert system.modulated(0.0, 1.0) is not None and damped.modulated(0.0, 1.0) is None
