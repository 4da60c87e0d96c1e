"""Large deflection: beamdyn and the second method against known equilibria and frequencies."""

from __future__ import annotations

import math
from decimal import Decimal
from functools import cache
from typing import Any

import numpy as np
import pytest

import beamdyn as bd
from benchmarks.cases.elastica import harvester_at, published, scene_of
from benchmarks.cases.reference.elastica import (
    Elastica,
    State,
    converged,
    critical_speed,
    equilibria_bent_to,
    fold_beside,
    growth,
    slowest,
)
from benchmarks.cases.reference.of_elastica import answer, bent_answer, elastica_of_scene
from benchmarks.cases.scenes import HARVESTER, time_unit

KNOWN = published()
CASES = KNOWN["case"]
UNIT = time_unit(HARVESTER.beam)

by_case = pytest.mark.parametrize("case", CASES, ids=lambda case: case["name"])
by_row = pytest.mark.parametrize(
    "row", KNOWN["harvester"], ids=lambda row: f"{row['setting_angle_deg']} deg, {row['speed']:g} rad/s"
)
FEM = 1e-6  # promised relative error
by_method = pytest.mark.parametrize(
    ("method", "rtol"), [("ritz", 0.0), (bd.Fem(60), FEM)], ids=["ritz", "fem"]
)


def assert_digits(found: Any, printed: list[str] | str, rtol: float = 0.0) -> None:
    """To half a unit of the last digit printed and the little that a float is off, or to `rtol` if wider."""
    texts = [printed] if isinstance(printed, str) else printed
    expected = np.array([float(text) for text in texts])
    digits = np.array([0.51 * 10.0 ** int(Decimal(text).as_tuple().exponent) for text in texts])
    off = np.abs(np.atleast_1d(found) - expected)
    assert (off <= np.maximum(digits, rtol * np.abs(expected))).all(), off / expected


# The second method --------------------------------------------------------------------------------


def reference(case: dict[str, Any]) -> tuple[np.ndarray, np.ndarray]:
    """The tip along the beam and along the direction of bending, and lambda."""
    solver = bent_answer if case["branch"] == "bent" else answer
    found = solver(scene_of(case), case["gamma"])
    across = found.tip[2] if case["bending_angle_deg"] else found.tip[1]
    return np.array([found.tip[0], across]), 2 * math.pi * found.frequency


@by_case
def test_second_method(case: dict[str, Any]) -> None:
    tip, frequency = reference(case)
    assert_digits(tip, case["tip"])
    assert_digits(frequency, case["frequency"])


@by_row
def test_second_method_on_the_harvester(row: dict[str, Any]) -> None:
    found = answer(harvester_at(row["setting_angle_deg"]), row["speed"]).frequency[0]
    assert_digits(found, row["frequency"])


@cache
def at_5_deg() -> Elastica:
    return elastica_of_scene(harvester_at(5.0))[0]


def test_second_method_finds_the_pitchfork() -> None:
    beam, _ = elastica_of_scene(harvester_at(0.0))
    assert_digits(critical_speed(beam), KNOWN["pitchfork"]["gamma"])


def test_second_method_finds_the_fold() -> None:
    found = fold_beside(at_5_deg(), side=1)
    assert_digits(found.gamma / UNIT, KNOWN["fold"]["speed"])


def test_second_method_finds_the_least_frequency() -> None:
    speed, frequency = slowest(at_5_deg(), 100 * UNIT, 190 * UNIT)
    assert_digits(speed / UNIT, KNOWN["least_frequency"]["speed"])
    assert_digits(frequency / (2 * math.pi * UNIT), KNOWN["least_frequency"]["frequency"])


@cache
def beside() -> list[State]:
    return equilibria_bent_to(at_5_deg(), KNOWN["beside"][0]["speed"] * UNIT, side=1)


def test_second_method_finds_the_equilibria_beside_that_from_rest() -> None:
    unstable, stable = beside()
    for row, state in zip(KNOWN["beside"], (stable, unstable), strict=True):
        assert_digits(state.tip, row["tip"])
        assert (growth(state) == 0) is row["stable"]
    assert_digits(converged(stable).frequency[0], KNOWN["beside"][0]["frequency"])


# beamdyn ------------------------------------------------------------------------------------------


def tip_of(scene: bd.Scene, speed: float) -> np.ndarray:
    """The tip over the length, along the beam at rest and along the direction of bending."""
    x, in_plane, out = bd.equilibrium(scene, speed).tip / scene.beam.length
    c, s = math.cos(scene.mount.bending_angle), math.sin(scene.mount.bending_angle)
    return np.array([x, c * in_plane + s * out])


@by_method
@by_case
def test_frequencies(case: dict[str, Any], method: Any, rtol: float) -> None:
    printed = case["frequency"]
    found = bd.natural_modes(scene_of(case), case["gamma"], len(printed), method)
    assert_digits(2 * math.pi * found.frequency, printed, rtol)


@by_case
def test_tips(case: dict[str, Any]) -> None:
    """Bent ones are on one of two sides, which a symmetric scene does not tell apart."""
    x, across = tip_of(scene_of(case), case["gamma"])
    side = np.sign(across) * np.sign(float(case["tip"][1])) if case["branch"] == "bent" else 1.0
    assert_digits([x, side * across], case["tip"])


@by_method
@by_row
def test_harvester(row: dict[str, Any], method: Any, rtol: float) -> None:
    found = bd.natural_modes(harvester_at(row["setting_angle_deg"]), row["speed"], 1, method)
    assert_digits(found.frequency[0], row["frequency"], rtol)


def test_pitchfork_of_the_inward_harvester() -> None:
    """Straight it is unstable beyond, bent it is not there before: 1e-6 of the speed on either side."""
    scene, critical = harvester_at(0.0), float(KNOWN["pitchfork"]["gamma"]) / UNIT
    below, above = critical * (1 - 1e-6), critical * (1 + 1e-6)
    assert bd.equilibrium(scene, below).stable
    assert not bd.equilibrium(scene, above).stable
    assert bd.equilibrium(harvester_at(0.0, "bent"), above).stable
    assert_digits(bd.critical_speed(scene) * UNIT, KNOWN["pitchfork"]["gamma"])


def test_branch_from_rest_at_5_deg_has_no_critical_speed_but_a_least_frequency() -> None:
    least, scene = KNOWN["least_frequency"], harvester_at(5.0)
    speed = float(least["speed"])
    before, there, after = (bd.natural_modes(scene, v, 1).frequency[0] for v in (speed - 1, speed, speed + 1))
    assert_digits(there, least["frequency"])
    assert min(before, after) > there
    assert bd.equilibrium(scene, 400.0).stable


def test_fold_at_5_deg() -> None:
    speed = float(KNOWN["fold"]["speed"])
    scene = harvester_at(5.0, "bent")
    assert bd.equilibrium(scene, speed + 1e-3).stable
    with pytest.raises(ArithmeticError, match="no equilibrium beside"):
        bd.equilibrium(scene, speed - 1e-3)


@by_method
def test_frequency_about_the_second_stable_equilibrium_at_5_deg(method: Any, rtol: float) -> None:
    scene, row = harvester_at(5.0, "bent"), KNOWN["beside"][0]
    found = bd.natural_modes(scene, row["speed"], 1, method).frequency[0]
    assert_digits(2 * math.pi * found * UNIT, row["frequency"], rtol)


def test_second_stable_equilibrium_at_5_deg() -> None:
    row = KNOWN["beside"][0]
    assert_digits(tip_of(harvester_at(5.0, "bent"), row["speed"]), row["tip"])


@pytest.mark.parametrize("speed", [100.0, 178.0])
def test_no_second_equilibrium_before_the_fold(speed: float) -> None:
    """The branch from rest is not given out as the bent one."""
    with pytest.raises(ArithmeticError, match="no equilibrium beside"):
        bd.natural_modes(harvester_at(5.0, "bent"), speed, 1)


@pytest.mark.parametrize("excess", [1e-4, 1e-3, 1e-2, 0.1, 0.5])
def test_bent_modes_past_the_pitchfork(excess: float) -> None:
    """From beside it on, where the branches are close together."""
    speed = critical_speed(elastica_of_scene(harvester_at(0.0))[0]) / UNIT * (1 + excess)
    expected = bent_answer(harvester_at(0.0), speed, count=2).frequency
    found = bd.natural_modes(harvester_at(0.0, "bent"), speed, 2)
    np.testing.assert_allclose(found.frequency, expected, rtol=1e-9 + 1e-14 / excess)  # f1^2 is as excess


@pytest.mark.parametrize("excess", [1e-4, 1e-3, 1e-2, 0.1])
def test_bent_modes_past_the_fold(excess: float) -> None:
    speed = float(KNOWN["fold"]["speed"]) * (1 + excess)
    expected = bent_answer(harvester_at(5.0), speed, count=2).frequency
    found = bd.natural_modes(harvester_at(5.0, "bent"), speed, 2)
    np.testing.assert_allclose(found.frequency, expected, rtol=1e-9 + 1e-14 / excess)


@pytest.mark.parametrize("speed", [200.0, 400.0])
def test_branch_from_rest_is_not_left_at_speed(speed: float) -> None:
    """Newton's method from the straight beam lands on the unstable equilibrium, on the other side."""
    found = bd.equilibrium(harvester_at(5.0), speed)
    expected = answer(harvester_at(5.0), speed).tip
    assert found.stable
    np.testing.assert_allclose(found.tip, expected, rtol=0, atol=1e-9 * HARVESTER.beam.length)
