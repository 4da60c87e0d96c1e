"""A measured straight beam, and published answers that are no row of a table."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.published import load
from benchmarks.cases import measured, single_answers
from benchmarks.cases.scenes import BLADE_SPIN_UP


@pytest.mark.parametrize(
    "row", load("epps_chandra_1996")["measured"], ids=lambda row: f"{row['speed_rpm']:g}"
)
def test_a_measured_straight_beam(row: dict) -> None:
    """Within 10 % or 1 Hz, as the tests of the program that has the transcription allow."""
    printed = np.array(row["frequency"], dtype=float)
    found = bd.natural_modes(measured.straight_beam(), row["speed_rpm"] * measured.RPM, 3).frequency
    assert (np.abs(found - printed) <= np.maximum(0.1 * printed, 1.0)).all()


@pytest.mark.parametrize(
    "row",
    load("epps_chandra_1996")["swept"],
    ids=lambda row: f"{row['sweep_deg']:g} deg, {row['speed_rpm']:g} rpm",
)
def test_a_measured_beam_with_a_swept_tip(row: dict) -> None:
    """By the same bound; torsion is among the modes of flap, without those in the plane of rotation."""
    scene, speed = measured.swept_beam(row["sweep_deg"]), row["speed_rpm"] * measured.RPM
    modes = bd.natural_modes(scene, speed, 8, bd.Ritz(9))  # good to 2e-5
    found = modes.frequency[modes.plane_share[:, 0] > 0.5]
    printed = np.sort(np.array([*row["flap"], *row.get("torsion", [])], dtype=float))
    found = found[: len(printed)]
    assert (np.abs(found - printed) <= np.maximum(0.1 * printed, 1.0)).all(), found / printed


def test_the_rotating_beam_was_faster_than_a_clamped_one() -> None:
    """By 5 to 10 %, in each mode: what the manual says of it."""
    rotating = [c for c in measured.compare() if not c.what.startswith("0 rpm")]
    ratios = [float(np.mean(c.published)) / c.ours for c in rotating]
    assert len(ratios) == 6
    assert min(ratios) > 1.05 and max(ratios) < 1.11


def test_slopes_at_rest() -> None:
    assert [c for c in single_answers.slopes() if not c.agrees or c.error > 1e-6] == []


def test_critical_speed_far_from_the_axis() -> None:
    assert single_answers.limit_of_the_critical_speed().agrees


def test_growth_where_the_speed_varies() -> None:
    found = [*single_answers.growth_factors()]
    assert len(found) == 4
    assert [c for c in found if not c.agrees] == []


def test_the_stated_error_of_a_spin_up_has_what_its_modes_leave_out() -> None:
    found, more = single_answers.spin_up(), bd.simulate(BLADE_SPIN_UP, 20.0, modes=14)
    assert abs(found.ours - more.largest) + more.time_error <= found.error


def test_branches_of_the_harvester() -> None:
    """Also held one by one in `test_elastica`."""
    found = [*single_answers.branches()]
    assert len(found) == 9
    assert [c for c in found if not c.agrees] == []
