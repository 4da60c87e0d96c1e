"""Peaks of a frequency response, refined between the frequencies that are given."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

import beamdyn as bd

SCENE = replace(
    bd.load_scene(Path(__file__).parents[2] / "examples" / "rolling_harvester.toml"), damping_ratio=0.01
)
SPEED = 50.0  # rad/s
TURNS = SPEED / (2 * np.pi)


def response(count, scene=SCENE, band=(1.0, 1000.0), **options):
    return bd.frequency_response(scene, SPEED, np.geomspace(*band, count), **options)


def test_peaks_do_not_depend_on_the_frequencies_given():
    few, many = response(3).peaks, response(5).peaks
    assert len(few) == 2
    for name in ("frequency", "size", "bandwidth"):  # the same search, to rounding
        np.testing.assert_allclose(getattr(few, name), getattr(many, name), rtol=1e-12)


def test_no_frequency_near_a_peak_answers_more():
    peaks = response(3).peaks
    for at, size in zip(peaks.frequency, peaks.size, strict=True):
        near = bd.frequency_response(SCENE, SPEED, at * (1 + np.linspace(-1e-3, 1e-3, 101)))
        largest = np.abs(near.response).max()
        assert largest <= size * (1 + 1e-9)  # the peak's search ends within 1e-9 of its height
        assert largest >= size * (1 - 1e-5)  # the middle one of the 101 is the peak


def test_bandwidth_is_that_of_a_lightly_damped_oscillator():
    """Half-power bandwidth 2 zeta f: Craig and Kurdila (2006), section 4.2; zeta is that at rest."""
    rest = bd.natural_modes(SCENE, 0.0, 1).frequency[0]
    width = response(3).peaks.bandwidth[0]
    np.testing.assert_allclose(
        width, 2 * 0.01 * rest, rtol=3e-3
    )  # it holds to the order of zeta and of mode 2


def test_an_input_of_fixed_direction_has_a_peak_on_either_side():
    peaks, own = response(3, input="n1").peaks, response(3).peaks.frequency
    expected = np.sort(np.concatenate([own - TURNS, own + TURNS]))
    np.testing.assert_allclose(peaks.frequency, expected, rtol=1e-4)  # their tails shift each other
    assert peaks.harmonic.tolist() == [1, -1, 1, -1]


def test_without_damping_peaks_are_natural_frequencies():
    peaks = response(3, replace(SCENE, damping_ratio=0.0)).peaks
    modes = bd.natural_modes(replace(SCENE, damping_ratio=0.0), SPEED, 2).frequency
    np.testing.assert_allclose(peaks.frequency, modes, rtol=1e-9)  # errors of both are below
    assert np.isinf(peaks.size).all() and (peaks.bandwidth == 0).all()


def test_errors_cover_the_distance_of_finite_elements():
    ritz, fem = response(3).peaks, response(3, discretization="fem").peaks
    for name in ("frequency", "size", "bandwidth"):
        distance = np.abs(getattr(ritz, name) - getattr(fem, name))
        assert (distance <= getattr(ritz, f"{name}_error") + getattr(fem, f"{name}_error")).all(), name


def test_a_result_keeps_its_peaks(tmp_path):
    result = response(3)
    result.save(tmp_path / "r.json")
    assert bd.load(tmp_path / "r.json").peaks.frequency.tolist() == result.peaks.frequency.tolist()


@pytest.mark.parametrize("band", [(1.0, 10.0), (500.0, 1000.0)])
def test_where_nothing_resonates_there_is_no_peak(band):
    assert len(response(3, band=band).peaks) == 0


def test_the_command_lists_refined_peaks(run):
    path = Path(__file__).parents[2] / "examples" / "rolling_harvester.toml"
    _, out, _ = run("response", path, "--frequencies", "1:1000:7 Hz", "--speed", "50 rad/s")
    assert "peak at [Hz]" in out and "61.963" in out and "half-power" in out


def test_the_largest_response_and_the_picture_have_the_peak_between_the_frequencies():
    found = bd.frequency_response(SCENE, 0.0, np.geomspace(1.0, 2000.0, 20))
    at, size = found.peak
    assert size == found.peaks.size.max() > 2 * np.abs(found.response).max()
    assert at == found.peaks.frequency[found.peaks.size.argmax()]
    (curve,) = found.plot().get_lines()
    assert curve.get_ydata().max() == size and (np.diff(curve.get_xdata()) > 0).all()
