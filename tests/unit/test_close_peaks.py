"""Peaks of close pairs, between antiresonances and without a half-power bandwidth, against dense grids."""

from __future__ import annotations

from dataclasses import replace
from io import StringIO

import numpy as np
import pytest
from rich.console import Console

import beamdyn as bd
from beamdyn.analyses.results.of_linear_models import response_table
from beamdyn.linear.convergence import model_at_speed
from beamdyn.linear.inputs_outputs import as_excitation, as_observation
from beamdyn.linear.transfer import modal_sums, respond

STRIP = bd.Beam.rectangular(
    0.3, 0.00505, 0.005, youngs_modulus=200e9, density=7850.0, poissons_ratio=0.3
)  # nearly square
MOUNT = bd.Mount(radius=0.1, setting_angle=np.pi, bending_angle=0.5)
PAIR = bd.Scene(STRIP, MOUNT, damping_ratio=0.003, physics=bd.Physics(planes=2))
BAND = (42.0, 50.0)


def dense(scene, speed, grid, **options):
    """Magnitudes (F, k) by the equations themselves, which the search for peaks does not solve."""
    return np.abs(bd.frequency_response(scene, speed, grid, **options).response)


def maxima(grid, size):
    """Frequencies of the grid above both neighbours, of all harmonics."""
    higher = (size[1:-1] > size[:-2]) & (size[1:-1] > size[2:])
    return np.sort(np.concatenate([grid[1:-1][column] for column in higher.T]))


@pytest.mark.parametrize("damping", [1e-3, 0.003, 0.01, 0.03])
@pytest.mark.parametrize(
    ("speed", "input"), [(20.0, "n3"), (20.0, "across"), (40.0, "bending"), (40.0, "across")]
)
def test_a_close_pair_has_the_peaks_of_a_dense_grid(damping, speed, input):
    scene = replace(PAIR, damping_ratio=damping)
    grid = np.linspace(*BAND, 1001)
    found = bd.frequency_response(scene, speed, BAND, input=input).peaks
    expected = maxima(grid, dense(scene, speed, grid, input=input))
    assert len(found) == len(expected)
    np.testing.assert_allclose(found.frequency, expected, rtol=0, atol=grid[1] - grid[0])


@pytest.mark.parametrize("input", ["across", "n3"])
def test_an_input_of_either_direction_shows_both_modes_of_the_pair(input):
    assert len(bd.frequency_response(PAIR, 20.0, BAND, input=input).peaks) == 2


@pytest.mark.parametrize(("speed", "input"), [(20.0, "across"), (40.0, "across"), (40.0, "bending")])
def test_bandwidth_is_nan_where_the_flank_rises_again_above_half_the_power(speed, input):
    found = bd.frequency_response(PAIR, speed, BAND, input=input).peaks
    grid = np.linspace(*BAND, 4001)
    size = dense(PAIR, speed, grid, input=input)[:, 0]
    between = size[(grid > found.frequency[0]) & (grid < found.frequency[1])].min()
    none = between >= found.size / np.sqrt(2)
    assert np.isnan(found.bandwidth).tolist() == none.tolist() == np.isnan(found.bandwidth_error).tolist()
    for k in np.flatnonzero(~none):
        middle = found.frequency.mean()
        own = (grid < middle) if k == 0 else (grid > middle)
        above = grid[own & (size > found.size[k] / np.sqrt(2))]
        step = grid[1] - grid[0]
        np.testing.assert_allclose(found.bandwidth[k], above[-1] - above[0], rtol=0, atol=2 * step)


@pytest.mark.parametrize("damping", [1e-3, 0.003])
def test_errors_of_a_pair_cover_finite_elements_and_a_larger_model(damping):
    scene = replace(PAIR, damping_ratio=damping)
    ritz, fem, large = (
        bd.frequency_response(scene, 40.0, BAND, input="n3", modes=None, discretization=each).peaks
        for each in (bd.Ritz(7), bd.Fem(6), bd.Ritz(24))
    )
    for coarse in (ritz, fem):
        for name in ("frequency", "size", "bandwidth"):
            distance = np.abs(getattr(coarse, name) - getattr(large, name))
            stated = getattr(coarse, f"{name}_error") + getattr(large, f"{name}_error")
            assert (distance <= stated).all(), name
    assert ritz.frequency_error.max() > 1e-8 * ritz.frequency.max()  # of a model that is not exact


@pytest.mark.parametrize("output", ["tip", "root moment", "tip acceleration"])
def test_errors_of_few_modes_cover_all_functions(output):
    scene = replace(PAIR, damping_ratio=0.01)
    few = bd.frequency_response(scene, 40.0, (10.0, 1000.0), modes=5, output=output).peaks
    whole = bd.frequency_response(scene, 40.0, (10.0, 1000.0), modes=None, output=output).peaks
    assert len(few) == len(whole)
    for name in ("frequency", "size", "bandwidth"):
        distance, stated = np.abs(getattr(few, name) - getattr(whole, name)), getattr(few, f"{name}_error")
        known = np.isfinite(distance)
        assert known.any()
        assert (distance[known] <= stated[known] + getattr(whole, f"{name}_error")[known]).all(), name


@pytest.mark.parametrize("output", ["tip", "tip acceleration", "root strain"])
@pytest.mark.parametrize("input", ["bending", "tip force", "n1"])
def test_antiresonances_between_peaks_are_none(input, output):
    scene = replace(PAIR, physics=bd.Physics(), damping_ratio=0.005)
    band = (20.0, 1000.0)
    found = bd.frequency_response(scene, 30.0, band, input=input, output=output).peaks
    grid = np.geomspace(*band, 3001)
    expected = maxima(grid, dense(scene, 30.0, grid, input=input, output=output))
    assert len(found) == len(expected)
    np.testing.assert_allclose(found.frequency, expected, rtol=grid[1] / grid[0] - 1)


def test_an_undamped_pair_is_refused_at_its_natural_frequency():
    scene = replace(PAIR, damping_ratio=0.0)
    peaks = bd.frequency_response(scene, 40.0, BAND, input="n3").peaks
    assert np.isinf(peaks.size).all() and (peaks.bandwidth == 0).all()
    modes = bd.natural_modes(scene, 40.0, 2).frequency
    np.testing.assert_allclose(peaks.frequency, modes, rtol=1e-9)  # errors of both are below


@pytest.mark.parametrize(
    "physics", [bd.Physics(), bd.Physics(planes=2), bd.Physics(shear=True), bd.Physics(planes=2, shear=True)]
)
@pytest.mark.parametrize("output", ["tip", "tip acceleration", "root strain"])
@pytest.mark.parametrize("modes", [4, None])
def test_the_sum_over_free_motions_solves_the_equations(physics, output, modes):
    model = model_at_speed(replace(PAIR, physics=physics), 40.0, modes, "ritz")
    seen = as_observation("output", output)
    drives = model.drives(as_excitation("input", "n1"))
    s = 2j * np.pi * np.array([1.0, 30.0, 46.0, 200.0, 1000.0])
    for h, total in modal_sums(model, drives, seen).items():
        value, slope = total(s)
        np.testing.assert_allclose(value, respond(model, drives[h], seen, s), rtol=1e-8)  # rounding of both
        step = 1e-6 * s  # far below the distance to a pole
        np.testing.assert_allclose(slope, (total(s + step)[0] - total(s - step)[0]) / (2 * step), rtol=1e-5)


def test_a_direction_that_nothing_excites_has_no_peaks():
    """Rounding is no response: uncoupled planes, one of them excited."""
    scene = replace(PAIR, mount=replace(MOUNT, bending_angle=0.0))
    for modes in (4, None):
        found = bd.frequency_response(scene, 40.0, (10.0, 1000.0), output="tip across", modes=modes)
        assert len(found.peaks) == 0


@pytest.mark.parametrize("speed", [0.0, 40.0])
def test_equal_planes_have_one_peak_a_mode_at_rest(speed):
    """Poles that coincide at rest, where any combination of their motions is free."""
    strip = bd.Beam.rectangular(0.3, 0.005, 0.005, youngs_modulus=200e9, density=7850.0)
    scene = replace(PAIR, beam=strip)
    grid = np.linspace(*BAND, 1001)
    found = bd.frequency_response(scene, speed, BAND, input="n3").peaks
    expected = maxima(grid, dense(scene, speed, grid, input="n3"))
    assert len(found) == len(expected) == (1 if speed == 0 else len(expected)) > 0
    np.testing.assert_allclose(found.frequency, expected, rtol=0, atol=grid[1] - grid[0])


def test_the_command_shows_a_dash_where_a_peak_has_no_bandwidth():
    found = bd.frequency_response(PAIR, 20.0, BAND, input="across")
    assert np.isnan(found.peaks.bandwidth).all()
    with Console(width=120, record=True, file=StringIO()) as console:
        console.print(response_table(found))
    text = console.export_text()
    rows = [line for line in text.splitlines() if line.strip().startswith("45.")]
    assert len(rows) == 2 and all(row.split()[-1] == "-" for row in rows)
    assert "rises again before it falls to half the power" in " ".join(text.split())
