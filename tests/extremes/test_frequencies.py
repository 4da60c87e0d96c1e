"""Natural frequencies at the ends of the ranges: right within the stated error, or refused with a reason.

The reference is the power series in mpmath, from the very binary numbers of the scene. Near the
critical speed the squared frequency is a small difference: there 4 eps times its condition is allowed.
"""

from __future__ import annotations

import dataclasses
import math
import time
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.reference.of_scene import exact, relative_errors
from benchmarks.cases.scenes import HARVESTER, steel_strip, time_unit

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
    assert (found.error[1:] < 1e-9).all()


@pytest.mark.parametrize("stretch", [False, True])
def test_at_the_critical_speed_no_functions_are_added_in_vain(stretch: bool) -> None:
    made = replace(steel_strip(hub=1.0, setting=INWARD), physics=bd.Physics(stretch=stretch))
    found = bd.natural_modes(made, bd.critical_speed(made))
    assert found.error[0] > 1e-4
    assert found.model.equations.size < 50  # it was 200, or 344 with stretch: 11 s


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
    with pytest.raises(ValueError, match="at most 176 modes"):
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


@pytest.mark.parametrize("elements", [5, 10, 20, 80])
def test_a_conservative_beam_never_flutters(elements: int) -> None:
    """Its squared eigenvalues are real; the two meshes pass zero at different speeds."""
    tip = bd.TipMass(1e-3, inertia=1e-5)
    made = bd.Scene(dataclasses.replace(HARVESTER.beam, tip=tip), HARVESTER.mount)
    speeds = bd.critical_speed(made) * (1 + np.concatenate([[0], np.geomspace(1e-9, 1e-2, 40)]))
    locus = bd.frequency_locus(made, speeds, 2, bd.Fem(elements))
    assert (np.real(locus.eigenvalue) * np.imag(locus.eigenvalue) == 0).all()
    assert set(locus.status[:, 0]) <= {"stable", "divergence"}


def test_higher_modes_keep_their_errors_where_the_first_vanishes() -> None:
    made = steel_strip(hub=1.0, setting=1.55)
    speed = bd.critical_speed(made)
    found, fine = (bd.natural_modes(made, speed, 3, bd.Ritz(n)) for n in (8, 60))
    true = np.abs(found.eigenvalue / fine.eigenvalue - 1)
    assert np.isinf(found.error[0])
    assert (true[1:] <= found.error[1:]).all() and (found.error[1:] < 0.05).all()


def test_a_mode_that_a_coarse_mesh_puts_below_an_unresolved_one_is_unresolved() -> None:
    """The toppling mode of a small tip body is the lowest, at zero; a mesh puts it above another mode."""
    tip = bd.TipMass(0.00713906, -0.00949844, 0.000923927, 0.00080495, 0.000375134)
    made = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0, tip=tip))
    found = bd.natural_modes(made, 1489.55707427074, 3, "fem")
    fine = bd.natural_modes(made, 1489.55707427074, 3, bd.Ritz(120))
    true = np.abs(found.eigenvalue - fine.eigenvalue) / np.abs(fine.eigenvalue)
    assert (true <= found.error).all()


# Inputs past double precision -------------------------------------------------------------------------


SPLIT = bd.Table([0, 5e-9, 0.5, 1], [2e-4, 2.1e-4, 1.9e-4, 1.5e-4])  # a first station at 0.25 nm


def test_a_speed_past_double_precision_ends_with_a_reason() -> None:
    beam = bd.Beam.rectangular(0.05, 0.01, SPLIT, 200e9, 7850.0)
    started = time.perf_counter()
    with pytest.raises(ValueError, match="more digits than double precision has: give a lower speed"):
        bd.natural_modes(bd.Scene(beam, bd.Mount(0.2)), 1e9)
    assert time.perf_counter() - started < 5


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
@pytest.mark.parametrize("speed", [0.0, 50.0, 1e9])
def test_an_immense_tip_inertia_ends_with_an_answer_or_a_reason(speed: float, discretization: str) -> None:
    beam = dataclasses.replace(HARVESTER.beam, tip=bd.TipMass(1e-3, 0.0, 1e20))
    started = time.perf_counter()
    try:
        found = bd.natural_modes(bd.Scene(beam, bd.Mount(0.2)), speed, 3, discretization)
        assert np.isinf(found.error[1:]).all() and any("relative error" in text for text in found.warnings)
    except ValueError as error:
        assert "more digits than double precision has" in str(error)
    assert time.perf_counter() - started < 20


@pytest.mark.parametrize("ratio", [1e9, 1e12, 1e24])
@pytest.mark.parametrize("speed", [0.0, 3.162277660168379e-08, 1.0])
def test_an_immense_tip_mass_ends_with_an_answer_or_a_reason(speed: float, ratio: float) -> None:
    """With precone the planes are coupled by velocities; the tip body alone has mass within rounding."""
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0, second_bending_stiffness=3.0, tip=bd.TipMass(ratio))
    mount = bd.Mount(0.1, math.pi, math.pi / 2, precone=0.05)
    try:
        found = bd.natural_modes(bd.Scene(beam, mount, physics=bd.Physics(planes=2)), speed, 3)
        assert found.frequency.size == found.error.size == 3
    except ValueError as error:
        assert "more digits than double precision has" in str(error)


def test_more_segments_than_can_be_solved_are_refused_at_once() -> None:
    stations = np.linspace(0, 1, 302)
    beam = bd.Beam.rectangular(
        0.05, 0.01, bd.Table(stations.tolist(), (2e-4 * (1 - 0.1 * stations)).tolist()), 200e9, 7850.0
    )
    for analysis in (bd.natural_modes, bd.critical_point):
        for discretization in ("ritz", "fem", bd.Ritz(14)):
            with pytest.raises(ValueError, match=r"301 segments.*at most 200; give fewer stations"):
                analysis(bd.Scene(beam), discretization=discretization)


def test_a_tolerance_past_double_precision_gives_the_last_result_with_a_warning() -> None:
    found = bd.natural_modes(HARVESTER, 1e9, tolerance=1e-3)
    assert np.isinf(found.error).all() and any("is not reached" in text for text in found.warnings)
