"""Natural frequencies at the ends of the ranges: right within the stated error, or refused with a reason.

The reference is the power series in mpmath, from the very binary numbers of the scene. Near the
critical speed the squared frequency is a small difference: there 4 eps times its condition is allowed.
"""

from __future__ import annotations

import math

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.reference.of_scene import exact, relative_errors
from benchmarks.cases.scenes import steel_strip, time_unit

EPS = float(np.finfo(float).eps)
INWARD, OUTWARD, TANGENTIAL = 0.0, math.pi, math.pi / 2


def at(gamma: float, made: bd.Scene) -> float:
    """The speed of a nondimensional one [rad/s]."""
    return gamma / time_unit(made.beam)


def assert_right(found: bd.Modes, allowed: float = 0.0) -> None:
    """Within the stated errors, which are small or warned of, or within what is allowed."""
    true = np.array(relative_errors(found, exact(found.scene, found.speed, len(found.error))))
    assert (true <= np.maximum(found.error, allowed)).all(), (true, found.error)
    assert found.error.max() < 1e-6 or any("relative error" in text for text in found.warnings)


@pytest.mark.parametrize(
    "changes, gamma",
    [
        ({"slenderness": 10.0}, 5.0),
        ({"slenderness": 1e6}, 5.0),
        ({"length": 1e-5}, 12.0),
        ({"length": 100.0}, 12.0),
        ({}, 1e-8),
        ({}, -10.0),
        ({"hub": 0.1, "bending": math.pi / 2}, 50.0),
        ({"hub": 1e6}, 0.01),
        ({"hub": 1.0, "setting": TANGENTIAL}, 10.0),
        ({"hub": 1e6, "setting": TANGENTIAL}, 10.0),
        ({"hub": 1e6, "setting": TANGENTIAL + 1e-12}, 10.0),
        ({"hub": 1e6, "setting": TANGENTIAL - 1e-12}, 10.0),
        ({"tip": 1e-6}, 3.0),
        ({"tip": 1e4}, 0.0),
        ({"tip": 1e4, "hub": 2.0, "setting": INWARD}, 0.01),
        ({"tip": 1e6}, 0.01),
        ({"tip": 1e6, "hub": 2.0, "setting": INWARD}, 0.001),
    ],
)
def test_frequencies_at_the_ends_of_the_ranges(changes: dict[str, float], gamma: float) -> None:
    made = steel_strip(**changes)
    assert_right(bd.natural_modes(made, at(gamma, made)))


@pytest.mark.parametrize("hub", [0.5, 4.0, 1e6])
@pytest.mark.parametrize("distance", [-1e-6, -1e-12, 1e-12, 1e-6, 3.0])
def test_near_and_past_the_critical_speed(hub: float, distance: float) -> None:
    made = steel_strip(hub=hub, setting=INWARD)
    found = bd.natural_modes(made, (1 + distance) * bd.critical_speed(made))
    assert_right(found, 4 * EPS / abs(distance))
    assert (found.status[0] == "divergence") == (distance > 0)


def test_at_the_critical_speed_nothing_is_claimed_of_the_first_mode() -> None:
    made = steel_strip(hub=1.0, setting=INWARD)
    found = bd.natural_modes(made, bd.critical_speed(made))
    assert found.error[0] > 1e-4 and any("relative error" in text for text in found.warnings)


@pytest.mark.parametrize("angle", [TANGENTIAL, math.nextafter(TANGENTIAL, 2), math.nextafter(TANGENTIAL, 1)])
def test_the_doubles_beside_a_quarter_turn(angle: float) -> None:
    """They differ from 90 deg by less than any user can mean; so do their frequencies."""
    f, g = (bd.natural_modes(steel_strip(hub=1e3, setting=a), 100.0).frequency for a in (angle, TANGENTIAL))
    np.testing.assert_allclose(f, g, rtol=1e-10)


@pytest.mark.parametrize("gamma", [1e3, 1e4])
def test_very_fast_outward_blade_is_a_string(gamma: float) -> None:
    """Flapwise, without hub: lambda -> gamma sqrt(n (2 n - 1)) from above, as the stiffness is a layer."""
    made = steel_strip(slenderness=1e6, bending=math.pi / 2)
    found = bd.natural_modes(made, at(gamma, made))
    n = np.arange(1, 4)
    string = at(gamma, made) * np.sqrt(n * (2 * n - 1))
    ratio = np.abs(found.eigenvalue) / string
    assert (ratio > 1 - found.error).all() and (ratio < 1 + 10 * n**2 / gamma + found.error).all()
    assert found.error.max() < 1e-6 or any("relative error" in text for text in found.warnings)


@pytest.mark.parametrize("modes", [1, 10, 50, 100, 150])
def test_many_modes_at_rest(modes: int) -> None:
    """Roots of cos b cosh b = -1, which are (n - 1/2) pi to rounding from the twelfth on."""
    made = steel_strip()
    found = bd.natural_modes(made, 0.0, modes)
    b = math.pi * (np.arange(1, modes + 1) - 0.5)
    for _ in range(20):
        b = b - (np.cos(b) + 1 / np.cosh(b)) / (-np.sin(b) - np.tanh(b) / np.cosh(b))
    b[0] = 1.8751040687119611664
    true = np.abs(np.abs(found.eigenvalue) / at(1.0, made) / b**2 - 1)
    assert (true <= np.maximum(found.error, 32 * EPS)).all()
    assert found.error.max() < 1e-6 or any("relative error" in text for text in found.warnings)


@pytest.mark.parametrize("modes", [180, 200])
def test_more_modes_than_can_be_checked_are_refused(modes: int) -> None:
    with pytest.raises(ValueError, match="fewer modes"):
        bd.natural_modes(steel_strip(), 0.0, modes)


@pytest.mark.parametrize("tolerance", [1e-2, 1e-5, 1e-8])
@pytest.mark.parametrize(
    "changes, gamma", [({}, 30.0), ({"tip": 10.0}, 5.0), ({"hub": 2.0, "setting": INWARD}, 1.4)]
)
def test_tolerances(changes: dict[str, float], gamma: float, tolerance: float) -> None:
    made = steel_strip(**changes)
    found = bd.natural_modes(made, at(gamma, made), tolerance=tolerance)
    fine = bd.natural_modes(made, at(gamma, made))
    true = np.abs(found.eigenvalue - fine.eigenvalue) / np.abs(fine.eigenvalue)
    assert found.error.max() <= tolerance and (true <= found.error + fine.error).all()
