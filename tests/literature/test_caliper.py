"""The eeBrake's page, its reconstruction's table, and the cantilever brake by hand."""

from __future__ import annotations

import dataclasses
import math

import numpy as np
import pytest

from brakes import calipers
from brakes.reproduce import eebrake as reproduction

# tension, X, F_L of the table of the reconstruction at F_R = 1; ten printed digits and more
TABLE = {
    "equal work": (0.7788783071540528, 0.875, 1.0466507177033),
    "equal force": (0.7615204477374768, 0.836, 1.0),
}


@pytest.mark.parametrize("split", TABLE)
def test_table_of_the_reconstruction(split):
    tension, x, left = TABLE[split]
    run = calipers.EeBrake(split=split).build().stroke([0.0])
    right = run.pad_force[0, 0]
    assert run.tension / right == pytest.approx(tension, abs=1e-12)  # the printed digits
    assert run.pad_force[0, 1] / right == pytest.approx(left, abs=1e-12)
    assert reproduction.tangential_forces(split) == pytest.approx((0.836, x), abs=1e-12)
    assert run.magnitudes["strut end"][0] / right == pytest.approx(0.8497353800, abs=5e-11)


def test_every_verdict_on_the_page_is_as_expected():
    rows = [row for part in reproduction.sections().values() for row in part]
    assert len(rows) == 10
    assert all(row.as_expected for row in rows)
    assert sum(bool(row.reason) for row in rows) == 2  # X at equal pads, 4.457 cut to 4.4


def test_three_and_a_half_mm_of_cable_close_the_reconstruction():
    caliper = calipers.EeBrake().build()
    assert caliper.contact == pytest.approx(3.5e-3, abs=5e-9)  # 2.5000 mm in sum, printed digits
    run = caliper.stroke([caliper.contact])
    assert run.pad_travel[0] == pytest.approx((1.26234e-3, 1.23766e-3), abs=5e-9)  # printed digits


@pytest.mark.parametrize("yoke", [0.03, 0.07, 0.12])
def test_cantilever_by_hand(yoke):
    """N/T = PC/(2 PS sin(alpha)): PC the leg's arm about the boss, PS the pad's, alpha the leg's slope."""
    design = calipers.Cantilever(yoke=(0.0, yoke), lever_ratio=1.0)
    run = design.build().stroke([0.0], finger=1.0)
    leg = math.atan2(yoke - design.hook[1], design.hook[0])
    x, y = design.hook[0] - design.pivot[0], design.hook[1] - design.pivot[1]
    arm = abs(x * math.sin(leg) + y * math.cos(leg))
    by_hand = arm / (2 * (design.pad[1] - design.pivot[1]) * math.sin(leg))
    assert run.advantage[0] == pytest.approx([by_hand, by_hand], rel=1e-12)  # rounding


def test_stop_of_the_page():
    """M v^2 = 4 mu F L; 15.50 m by hand from it."""
    found = calipers.stop(mass=80.0, speed=30 / 3.6, pad_force=224.0, friction=0.4)
    assert found.distance == pytest.approx(15.50, abs=5e-3)  # printed digits
    assert pytest.approx(4 * 0.4 * 224.0 * found.distance, rel=1e-14) == 80.0 * (30 / 3.6) ** 2


def test_arms_by_hand_side_pull_and_linear_pull():
    """Moments about the pivots of the open arms: N/T is the ratio of the arms of cable and pad."""
    side = calipers.SinglePivot(lever_ratio=1.0)
    run = side.build().stroke([0.0], finger=1.0)
    assert run.advantage[0] == pytest.approx([42 / 48] * 2, rel=1e-12)  # rounding
    linear = calipers.VBrake(lever_ratio=1.0)
    run = linear.build().stroke([0.0], finger=1.0)
    assert run.advantage[0] == pytest.approx([105 / 25] * 2, rel=1e-12)


@pytest.mark.parametrize("mu", [0.02, 0.3])
def test_friction_by_hand(mu):
    """Open arm of a V-brake: T 105 = N 25 +- r (N - T), r = 4 mm mu/sqrt(1 + mu^2)."""
    found = calipers.VBrake().build().friction(mu, 0.0)
    r = 4 * mu / math.hypot(1, mu)
    assert found.squeeze == pytest.approx((25 / 105) / ((25 + r) / (105 + r)), rel=1e-12)  # rounding
    assert found.release == pytest.approx(((25 - r) / (105 - r)) / (25 / 105), rel=1e-12)


def test_dual_pivot_by_hand():
    """Both arms' moments, with the roller's force between them and equal pads."""
    d = calipers.DualPivot(lever_ratio=1.0)
    run = d.build().stroke([0.0], finger=1.0)
    roller_right, roller_left = d.side_pivot[0] - d.roller[0], d.roller[0] - d.bolt[0]
    cable_right, cable_left = d.side_pivot[0] - d.clamp[0], d.bolt[0] - d.housing[0]
    pad_right, pad_left = d.side_pivot[1] - d.pad[1], d.bolt[1] - d.pad[1]
    # N pad = T cable -+ P roller, right and left
    n, p = np.linalg.solve([[pad_right, roller_right], [pad_left, -roller_left]], [cable_right, cable_left])
    assert run.advantage[0] == pytest.approx([n, n], rel=1e-12)
    assert run.magnitudes["roller"][0] == pytest.approx(p, rel=1e-12)


def test_centre_pull_by_hand():
    d = calipers.CentrePull(lever_ratio=1.0)
    run = d.build().stroke([0.0], finger=1.0)
    along = np.subtract(d.yoke, d.hook) / math.dist(d.yoke, d.hook)
    arm = np.subtract(d.hook, d.pivot)
    moment = abs(arm[0] * along[1] - arm[1] * along[0])
    by_hand = moment / (2 * along[1] * (d.pivot[1] - d.pad[1]))
    assert run.advantage[0] == pytest.approx([by_hand] * 2, rel=1e-12)


def test_dimensions_of_the_reconstruction_are_those_of_its_source():
    given = dataclasses.asdict(calipers.EeBrake())
    printed = {
        "pivot": (17.5, -19),
        "pad": (12.75, -45),
        "strut_pin": (-12.6, 29),
        "link_anchor": (-3.6, 14.9),
    }
    assert all(given[key] == pytest.approx(np.multiply(mm, 1e-3), rel=1e-15) for key, mm in printed.items())
