"""Steady stretches in closed form, against steps that are solved one by one."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.modes.modal.model import Model
from beamdyn.transient.closed_form import propagate_in_closed_form
from beamdyn.transient.gauss import propagate
from beamdyn.transient.system import ModalSystem
from benchmarks.cases.scenes import STEADY_ROLLING, STEADY_ROLLING_IN_GRAVITY

SCENES = {
    "rolling": STEADY_ROLLING,
    "in gravity": STEADY_ROLLING_IN_GRAVITY,
    "damped": replace(STEADY_ROLLING_IN_GRAVITY, damping_ratio=0.02),
    "fixed centre": replace(STEADY_ROLLING, motion=bd.SteadyRotation(55.0)),
}


def _system(scene: bd.Scene) -> ModalSystem:
    return ModalSystem(Model(scene, bd.Ritz(16)).modal_equations(2), scene.motion)


@pytest.mark.parametrize("name", SCENES)
def test_it_is_the_limit_of_fine_steps_within_its_stated_error(name: str) -> None:
    system = _system(SCENES[name])
    y = np.array([2e-6, 1e-8, 5e-4, 1e-5])  # 2 s, of some 130 periods; steps of 0.65 rad resolve the second
    closed = propagate_in_closed_form(system.modulated(0.0, 2.0), 0.0, 2.0, 8000, y[:2], y[2:], 8, 1e-7)
    fine = propagate(system, 0.0, 2.0, 8000, y[:2], y[2:], 8)
    assert closed is not None
    difference = np.abs(closed.state - fine.state)[:, 1:3].max(axis=0)
    rounding = 1e-10 * np.abs(fine.state[:, 1:3]).max()  # of 8000 steps, each of some 1e-14
    assert (difference <= closed.error.coordinates + rounding).all()
    t = np.linspace(0.0, 2.0, 1001)
    assert np.abs(closed.at(t)[0] - fine.at(t)[0]).max() <= closed.error.coordinates.max() + rounding


def test_a_motion_without_known_lines_is_left_to_steps() -> None:
    """A road that the system does not know of is not fitted by its lines."""
    system = _system(STEADY_ROLLING)
    modulated = replace(system.modulated(0.0, 2.0), lines=np.array([55.0]))
    assert propagate_in_closed_form(modulated, 0.0, 2.0, 1000, np.zeros(2), np.zeros(2), 8, 1e-6) is None


def test_nothing_moves_without_loads() -> None:
    run = bd.simulate(replace(STEADY_ROLLING, motion=bd.SpinUp(0.0, duration=1.0)), 20.0, 3)
    assert run.largest == 0


def test_terms_too_fast_for_the_steps_are_in_the_error() -> None:
    system = _system(STEADY_ROLLING)
    y = np.array([0.0, 1e-7, 0.0, 0.0])  # the second mode vibrates, 25 rad in each of 500 steps
    closed = propagate_in_closed_form(system.modulated(0.0, 5.0), 0.0, 5.0, 500, y[:2], y[2:], 8, 1e-3)
    assert closed is not None and closed.error.unresolved[1]
    assert closed.error.coordinates[1] > 0.9e-7
