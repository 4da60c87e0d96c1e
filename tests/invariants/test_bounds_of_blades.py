"""Guaranteed bounds of blades by tables of many stations: present, narrow and never violated."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.modes.bounds import _lowest, _nondimensional, frequency_bounds
from beamdyn.modes.flexibility import bound_flexibility, bound_traces
from beamdyn.modes.residual_bound import PlaneEnclosure
from beamdyn.modes.ritz_part import PlaneRitzPart
from benchmarks.cases.blades import blade_scene
from benchmarks.cases.random_stations import random_station_scene
from benchmarks.cases.reference.resolved import known_frequencies

_RATED = {"iea_15": 7.56, "nrel_5": 12.1, "bmodes_test01": 60.0}  # rpm, of the turbines
_ROUNDING = 1e-11  # of squared frequencies in `natural_modes`, by stiffnesses of many decades


def _without_twist(seed: int) -> tuple[bd.Scene, float]:
    """A random blade in one plane, and a speed."""
    scene, speed = random_station_scene(np.random.default_rng(seed))
    return replace(scene, beam=replace(scene.beam, twist=None), physics=bd.Physics()), speed


def _check_enclosed(bounds: bd.FrequencyBounds, squared: np.ndarray, error: np.ndarray) -> None:
    slack = error * np.abs(squared)
    assert (bounds.lower_squared - slack <= squared).all()
    assert (squared <= bounds.upper_squared + slack).all()


@pytest.mark.parametrize("share", [0.0, 1.0])
@pytest.mark.parametrize("name", _RATED)
def test_bounds_of_the_public_blades_are_narrow_in_both_planes(name: str, share: float) -> None:
    scene, speed = blade_scene(name, twisted=False), share * _RATED[name] * math.pi / 30
    found, modes = frequency_bounds(scene, speed, 6), bd.natural_modes(scene, speed, 6)
    assert (found.width < 1e-9).all()  # the rounding allowance is 1e-10
    assert not found.warnings
    _check_enclosed(found, (2 * np.pi * modes.frequency) ** 2, 2 * modes.error)


@pytest.mark.parametrize("seed", range(10))
def test_bounds_of_random_blades_are_present_and_hold(seed: int) -> None:
    scene, speed = _without_twist(seed)
    found, modes = frequency_bounds(scene, speed), bd.natural_modes(scene, speed, 3)
    assert (found.width < 1e-7).all()
    _check_enclosed(found, (2 * np.pi * modes.frequency) ** 2, 2 * modes.error)


@pytest.mark.parametrize("seed", [1, 23, 47])  # whose stiffness falls by seven decades
def test_bounds_of_random_blades_enclose_the_second_method(seed: int) -> None:
    scene, speed = _without_twist(seed)
    known = known_frequencies(scene, speed, 3)
    squared = -np.real(known.eigenvalue**2)
    _check_enclosed(frequency_bounds(scene, speed), squared, 2 * known.uncertainty)


@pytest.mark.parametrize("left", [1e-2, 1e-3, 1e-4])  # thickness at the tip over that at the root
def test_bounds_of_smooth_tapers_to_almost_nothing_are_narrow(left: float) -> None:
    taper = Polynomial([1.0, left - 1])
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, taper, taper**3), bd.Mount(0.1, np.pi, 0.0))
    found, known = frequency_bounds(scene, 2.0), known_frequencies(scene, 2.0, 3)
    assert (found.width < 1e-9).all()
    _check_enclosed(found, -np.real(known.eigenvalue**2), 2 * known.uncertainty)


@pytest.mark.parametrize("functions", [7, 10, 16])
@pytest.mark.parametrize("seed", range(4))
def test_bounds_of_few_moments_are_wide_but_hold(seed: int, functions: int) -> None:
    """Most are missing or wide: what the head leaves out is bounded, not neglected."""
    scene, speed = _without_twist(seed)
    scaled, time = _nondimensional(scene)
    flexibility = bound_flexibility(scaled.beam.bending_stiffness)
    lower, upper = PlaneEnclosure(scaled, functions, speed * time, flexibility).bounds(3)
    exact = (2 * np.pi * time * bd.natural_modes(scene, speed, 3).frequency) ** 2
    assert (upper > exact * (1 - _ROUNDING)).all()
    assert (np.isnan(lower) | (lower < exact * (1 + _ROUNDING))).all()


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_traces_of_growing_heads_approach_those_in_closed_form_from_below(seed: int) -> None:
    beam = _nondimensional(_without_twist(seed)[0])[0].beam
    flexibility = bound_flexibility(beam.bending_stiffness)
    assert flexibility is not None
    total = bound_traces(beam, flexibility)
    few, many = (total - np.trace(PlaneRitzPart(beam, n).forms, axis1=1, axis2=2) for n in (20, 80))
    assert (many > -1e-12 * total).all()
    assert (many[:2] < few[:2] / 2).all()  # slopes: as 1/n
    assert many[2] < few[2] / 16  # deflections: as n^-3
    assert (np.abs([few[3], many[3]]) < 1e-9 * total[3]).all()  # a constant moment is in every head


@pytest.mark.parametrize("stations", [2, 30])  # polynomials of the curvature, and of the moment
def test_functions_are_orthonormal_whatever_the_stiffness(stations: int) -> None:
    x = np.linspace(0, 1, stations)
    beam = bd.Beam.from_stiffness(1.0, 1.0, bd.Table(x.tolist(), (1 - (1 - 1e-6) * x).tolist()))
    stiffness = PlaneRitzPart(beam, 60).stiffness
    np.testing.assert_allclose(stiffness, np.eye(len(stiffness)), rtol=0, atol=1e-10)


def test_no_speed_is_critical_below_the_bound_of_an_inward_blade() -> None:
    scene = blade_scene("nrel_5", bd.Physics(), twisted=False)
    inward = replace(scene, mount=bd.Mount(40.0, 0.0, 0.0))
    critical = bd.critical_speed(inward)
    assert np.isfinite(critical)
    scaled, time = _nondimensional(inward)
    split = PlaneEnclosure(scaled, 30, 0.0, bound_flexibility(scaled.beam.bending_stiffness))
    below, above = (split.stiffness_form((c * critical * time) ** 2) for c in (1 - 1e-6, 1 + 1e-6))
    assert below is not None and np.linalg.eigvalsh(below)[0] > 0
    assert above is not None and np.linalg.eigvalsh(above)[0] < 0


def test_a_bound_that_is_missing_in_one_plane_moves_no_other() -> None:
    """Sorted as the largest of all it gave the bounds of higher modes to lower ones."""
    flap, edge = np.array([1.0, np.nan, 40.0]), np.array([np.nan, 9.0, 50.0])
    np.testing.assert_array_equal(_lowest([flap, edge], 4, -np.inf), [np.nan, 1.0, 1.0, 9.0])
    np.testing.assert_array_equal(_lowest([flap, edge], 4, np.inf), [1.0, np.nan, np.nan, np.nan])
