"""Verdicts on mechanisms are the same in other units and places, and after changes in the last digits."""

from __future__ import annotations

import math

import numpy as np
import pytest

from benchmarks.invariant_verdicts import count_changes, draw_mechanism, transform, verdicts
from benchmarks.stated_mechanism_errors import measure
from brakes.planar import (
    GROUND,
    Bar,
    Force,
    Mechanism,
    Moment,
    Pin,
    RotationLock,
    Slot,
    solve_with_friction,
    stroke,
)


def test_random_mechanisms_have_the_verdicts_that_they_have_elsewhere():
    """Ten of the 500 of the benchmark."""
    assert not [*count_changes(10)]


@pytest.mark.slow
def test_what_no_disturbance_presses_jams_nothing():
    """The 95th mechanism of this seed: whether a disturbance of another part jammed it hung on rounding."""
    rng = np.random.default_rng(5)
    *_, (mechanism, driver) = (draw_mechanism(rng) for _ in range(95))
    before = verdicts(mechanism, driver)
    for angle in (0.5, 1.0, math.pi / 2, 2.0, 3.0):
        assert verdicts(transform(mechanism, angle=angle), driver) == before
    assert verdicts(transform(mechanism, scale=1e-6), driver, 1e-6) == before


def crank_with_a_side_load() -> Mechanism:
    """A slider-crank whose slider bears a load across its guide, which never moves."""
    joints = (
        Pin("axle", "crank", GROUND, (0, 0)),
        Bar("rod", "crank", "slider", (0.03, 0.04), (0.15, 0)),
        Slot("guide", "slider", GROUND, (0.15, 0), along=(1, 0)),
        RotationLock("upright", "slider", GROUND),
    )
    loads = (
        Moment("turn", "crank"),
        Force("push", "slider", (0.15, 0), (1, 0), 1.0),
        Force("side", "slider", (0.15, 0), (0, 1), 3.0),
    )
    return Mechanism(("crank", "slider"), joints, loads)


@pytest.mark.parametrize("shift", [0j, 1 + 1j, 1e4j])
def test_a_load_that_never_moves_has_no_toggle_position(shift: complex):
    for angle in np.linspace(0.0, math.pi, 61):
        mechanism = transform(crank_with_a_side_load(), angle=angle, shift=shift)
        assert not stroke(mechanism, "turn", np.linspace(0.0, 0.5, 11)).toggles


def drawer(guide: float, offset: float = 0.0) -> Mechanism:
    """A drawer on guides 50 mm apart, `guide` [m] beside the line of its load, pulled `offset` beside it."""
    joints = tuple(
        Slot(name, "drawer", GROUND, (x, guide), (1, 0), friction=0.5)
        for name, x in (("front", 0.0), ("back", 0.05))
    )
    loads = (
        Force("pull", "drawer", (0.3, offset), (1, 0)),
        Force("load", "drawer", (-0.3, 0.0), (-1, 0), 100.0),
    )
    return Mechanism(("drawer",), joints, loads)


@pytest.mark.parametrize(("guide", "warns"), [(0.1, True), (0.02, False)])
def test_a_drawer_pulled_along_its_line_moves_and_says_whether_an_offset_jams_it(guide: float, warns: bool):
    """Friction turns it about the guides: with 0.5 it jams if they are 50 mm or more beside the line."""
    rng = np.random.default_rng(2)
    for _ in range(50):
        place = {"angle": rng.uniform(0.0, 6.3), "shift": complex(*rng.uniform(-1, 1, 2))}
        found = solve_with_friction(transform(drawer(guide), **place), "pull")
        for way in (found.squeeze, found.release):
            assert way.status == "determined"
            assert way.amplitudes["pull"] == pytest.approx(100.0, rel=1e-13)
            assert [
                warning.startswith("'front' and 'back' press with no force") for warning in way.warnings
            ] == ([True] if warns else [])


def test_a_drawer_pulled_beside_its_line_jams():
    """Toward the guides; away from them the pull grows: 100 N (1 + 2 mu e/(b - 2 mu h + 2 mu e))."""
    assert solve_with_friction(drawer(0.1, -1e-3), "pull").squeeze.status == "self-locking"


@pytest.mark.slow
def test_stated_errors_cover_those_against_forty_digits():
    """Sixty of the thousand mechanisms of the benchmark, drawn far away and nearly jammed among them."""
    found = measure(60)
    assert len(found) > 80
    assert all(each.true <= each.stated for each in found)


def test_stated_errors_cover_those_on_round_faces_that_have_turned():
    """Ten of the hundred drums: their forces are those of the drawing, which forty digits solve."""
    found = measure(10, "blocks on drums that have turned")
    assert len(found) > 20
    assert all(each.true <= each.stated for each in found)
