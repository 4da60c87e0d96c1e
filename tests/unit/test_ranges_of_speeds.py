"""Warnings name the speeds that they are about: neighbours as a range, others one by one."""

from __future__ import annotations

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.scene.validity import list_speeds

SPEEDS = np.arange(10.0)


@pytest.mark.parametrize(
    ("selected", "said"),
    [
        ([3], "3 rad/s"),
        ([0, 1, 2], "0 to 2 rad/s"),
        ([0, 9], "0 rad/s and 9 rad/s"),
        ([1, 2, 5, 7, 8, 9], "1 to 2 rad/s, 5 rad/s and 7 to 9 rad/s"),
        ([0, 2, 4, 6, 8], "0 rad/s, 2 rad/s, 4 rad/s and 2 more ranges up to 8 rad/s"),
    ],
)
def test_only_neighbours_make_a_range(selected: list[int], said: str):
    assert list_speeds(SPEEDS, np.isin(SPEEDS, selected)) == said


def test_ranges_do_not_depend_on_the_order_of_speeds():
    shuffled = np.random.default_rng(1).permutation(SPEEDS)
    for speeds in (SPEEDS[::-1], shuffled):
        assert list_speeds(speeds, np.isin(speeds, [1, 2, 5])) == "1 to 2 rad/s and 5 rad/s"


def test_two_resonances_are_not_a_range_of_speeds():
    """The tip moves far at 53.09 and at 69.80 rad/s, and by 0.1 mm between: undamped, its resonances."""
    scene = bd.load_scene("examples/rolling_harvester.toml")
    response = bd.steady_response(scene, [53.0328, 63.0, 69.8722], modes=3)
    (said,) = (warning for warning in response.warnings if "the tip moves by" in warning)
    assert response.amplitude[1] < 2e-4
    assert "at 53.0328 rad/s and 69.8722 rad/s" in said
