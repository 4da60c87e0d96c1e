"""The published tyre harvester: Table 2, the setting-angle limits and the buckling speed."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.published import load
from benchmarks.cases.scenes import HARVESTER

PAPER = load("lee_yoo_2019")


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
@pytest.mark.parametrize("speed, ansys", [(0.0, 65.230), (50.0, 61.963), (100.0, 50.907)])
def test_table_2_within_a_thousandth_of_ansys(speed: float, ansys: float, discretization: str) -> None:
    assert abs(bd.natural_modes(HARVESTER, speed, 1, discretization).frequency[0] - ansys) < 0.001


def test_reference_digits() -> None:
    found = [bd.natural_modes(HARVESTER, speed, 1).frequency[0] for speed in (0.0, 50.0, 100.0)]
    np.testing.assert_allclose(found, [65.23045644, 61.96301891, 50.90709538], rtol=0, atol=5e-9)


def test_stretch_and_coriolis() -> None:
    coupled = bd.Scene(HARVESTER.beam, HARVESTER.mount, physics=bd.Physics(stretch=True))
    found = [bd.natural_modes(coupled, speed, 1).frequency[0] for speed in (0.0, 50.0, 100.0)]
    np.testing.assert_allclose(found, [65.23045644, 61.96300748, 50.90705785], rtol=0, atol=5e-9)


def test_buckling_speed() -> None:
    assert abs(bd.critical_speed(HARVESTER) - 159.818332659) < 5e-10


def test_first_setting_angle_limit() -> None:
    first, _ = bd.setting_angle_limits(HARVESTER, top_speed=400.0)
    assert abs(np.degrees(first) - 88.35985) < 5e-6


def test_southwell_slope_gives_the_first_limit() -> None:
    first, _ = bd.setting_angle_limits(HARVESTER, top_speed=400.0)
    by_slopes = np.arccos((1.1933363741 - 1) / (1.57087819 * 0.215 / 0.05))
    assert abs(first - by_slopes) < 1e-9  # the slopes have nine digits


@pytest.mark.parametrize(
    "top_speed, degrees", [(100, 88.372), (400, 88.5343), (1000, 89.026), (2000, 89.463), (3000, 89.637)]
)
def test_converged_second_limit_depends_on_the_top_speed(top_speed: float, degrees: float) -> None:
    limits = bd.setting_angle_limits(HARVESTER, top_speed)
    rounding = 0.5 * 10.0 ** -len(str(degrees).split(".")[1])
    assert abs(np.degrees(limits.second) - degrees) <= rounding
    assert limits.warnings  # all of these are outside linear theory


@pytest.mark.parametrize("functions, degrees", [(4, 89.537), (5, 89.6267), (6, 89.687), (12, 89.841)])
def test_published_second_limit_is_that_of_five_eigenfunctions(functions: int, degrees: float) -> None:
    limits = bd.setting_angle_limits(HARVESTER, np.inf, bd.Ritz(functions, "eigenfunctions"))
    rounding = 0.5 * 10.0 ** -len(str(degrees).split(".")[1])
    assert abs(np.degrees(limits.second) - degrees) <= rounding


def test_static_deflection_at_the_first_limit() -> None:
    """Static tip deflection at 88.36 degrees: 0.099 L at 50 rad/s, 0.40 L at 100, 6.4 L at 400."""
    mount = bd.Mount(0.215, np.radians(88.36))
    found = bd.frequency_locus(bd.Scene(HARVESTER.beam, mount), [50.0, 100.0, 400.0], 1)
    deviation = np.abs(np.abs(found.static_deflection) / 0.05 - [0.099, 0.40, 6.4])
    assert (deviation <= [0.0005, 0.005, 0.05]).all()
