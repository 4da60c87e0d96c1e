"""Beams on root springs so soft that rounding of the bending stiffness could hide them.

The reference is the rigid body: frequency sqrt(k / I) of a turn against a spring, and the critical speed of a
rigid bar that points at the axis, where the spring balances the centrifugal moment.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import beamdyn as bd

LENGTH, MASS = 0.05, 0.01 * 0.0002 * 7850.0  # m, kg/m
INERTIA = MASS * LENGTH**3 / 3


def on_spring(stiffness: float, radius: float = 0.215) -> bd.Scene:
    beam = bd.Beam.rectangular(LENGTH, 0.01, 0.0002, 200e9, 7850.0)
    return bd.Scene(beam, bd.Mount(radius, root_stiffness=stiffness))


@pytest.mark.parametrize("stiffness", [1e-13, 1e-10, 1e-8])
def test_elements_turn_against_a_soft_spring(stiffness: float) -> None:
    modes = bd.natural_modes(on_spring(stiffness), discretization="fem")
    exact = math.sqrt(stiffness / INERTIA) / (2 * math.pi)  # the beam's own bending changes 1e-9 of it
    assert modes.status.tolist() == ["stable"] * 3
    assert modes.error[0] < 0.01 and modes.frequency[0] == pytest.approx(exact, rel=1e-6)


@pytest.mark.parametrize("stiffness", [1e-14, 1e-10])
def test_elements_find_the_critical_speed_on_a_soft_spring(stiffness: float) -> None:
    found = bd.critical_point(on_spring(stiffness), bd.Fem(40))
    # Moment per angle and squared speed of a bar that points at the axis: radius * first moment.
    exact = math.sqrt(stiffness / (0.215 * MASS * LENGTH**2 / 2))
    assert found.speed == pytest.approx(exact, rel=max(found.error, 1e-6)) and found.error < 1e-3


@pytest.mark.parametrize("elements", [40, 80, 400])
@pytest.mark.parametrize("stiffness", [0.0, 1e-20, 1e-16, 1e-12])
def test_no_soft_spring_lets_a_beam_diverge_at_rest(stiffness: float, elements: int) -> None:
    modes = bd.natural_modes(on_spring(stiffness), modes=1, discretization=bd.Fem(elements))
    assert modes.status[0] in ("neutral", "stable") and np.real(modes.eigenvalue[0]) == 0
