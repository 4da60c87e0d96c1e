"""Sections below five thicknesses are no plates: what modelling their width is worth is said."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.results.statements import MODEL_ERROR
from beamdyn.common.words import told_from
from benchmarks import solids

CAMBER = bd.Physics(camber=True)


def scene(slimness: float, physics: bd.Physics) -> bd.Scene:
    beam = bd.Beam.rectangular(0.05, slimness * 1e-3, 1e-3, 200e9, 7850.0, poissons_ratio=0.3)
    return bd.Scene(beam, bd.Mount(0.2, math.pi), physics=physics)


def said(warnings: tuple[str, ...]) -> list[str]:
    return [each for each in warnings if "a section is no plate" in each]


@pytest.mark.parametrize("physics", [CAMBER, bd.Physics(torsion=True)])
def test_a_narrow_section_is_solved_and_says_what_that_is_worth(physics: bd.Physics) -> None:
    (warning,) = said(bd.natural_modes(scene(2.5, physics), 50.0).warnings)
    assert warning.startswith("width/thickness is 2.5: ") and "up to 1 %" in warning
    assert warning.kind == MODEL_ERROR and (warning.value, warning.limit) == (pytest.approx(2.5), 5.0)


@pytest.mark.parametrize("physics", [bd.Physics(), bd.Physics(planes=2)])
def test_nothing_is_said_where_the_width_is_not_modelled(physics: bd.Physics) -> None:
    assert not said(bd.natural_modes(scene(2.5, physics), 50.0).warnings)


@pytest.mark.parametrize("near", [1 - 1e-13, 1.0, 1 + 1e-13])
def test_no_last_digit_decides_it(near: float) -> None:
    assert not said(bd.natural_modes(scene(5 * near, CAMBER), 50.0).warnings)
    assert said(bd.natural_modes(scene(4.99 * near, CAMBER), 50.0).warnings)


def test_responses_and_transients_say_it_too() -> None:
    narrow = scene(3.0, CAMBER)
    assert said(bd.frequency_response(narrow, 50.0, [10.0, 20.0], modes=2).warnings)
    assert said(bd.critical_point(narrow).warnings)  # an argument says that there is none
    assert said(bd.critical_point(replace(narrow, mount=bd.Mount(0.2))).warnings)
    rolling = replace(narrow, motion=bd.RollingWheel(0.3, 50.0))
    assert said(bd.simulate(rolling, 0.01, tolerance=1e-2).warnings)


def test_the_worst_of_the_solids_lie_within_it() -> None:
    """The cases that `benchmarks.solids` finds worst, to the digit that is stated; each exceeds 0.3 %."""
    worst = [each for each in solids.known() if each.number in (160, 134, 189, 21)]
    differences = [max(abs(size) for _, size in solids.compare_plate(each)) for each in worst]
    assert len(worst) == 4 and min(differences) > 0.003 and max(differences) < 0.0105
    assert all(each.body().width < 5 * each.body().thickness for each in worst)
    assert np.isfinite(differences).all()


def test_a_chosen_physics_says_it_too() -> None:
    modes = bd.natural_modes(replace(scene(2.0, CAMBER), physics="auto"), 50.0, tolerance=2e-4)
    assert modes.scene.physics.camber and said(modes.warnings)


@pytest.mark.slow
def test_a_short_narrow_part_is_seen() -> None:
    width = bd.Table([0.0, 0.5, 0.5001, 0.5002, 1.0], [0.01, 0.01, 0.003, 0.01, 0.01])
    beam = bd.Beam.rectangular(0.05, width, 1e-3, 200e9, 7850.0, poissons_ratio=0.3)
    assert any(
        "is 3: " in each
        for each in bd.natural_modes(bd.Scene(beam, physics=bd.Physics(torsion=True))).warnings
    )


def test_a_number_beside_a_limit_has_the_digits_that_tell_it_from_that() -> None:
    assert told_from(4.9999, 5.0) == "4.9999"
    assert told_from(2.5, 5.0) == "2.5"
    assert told_from(1.0000001, 1.0) == "1.0000001"
