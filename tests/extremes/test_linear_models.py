"""Linear models of beams of a micrometre to a kilometre, and with few functions or none to spare."""

from __future__ import annotations

from typing import Literal

import numpy as np
import pytest
from numpy.polynomial import Polynomial
from scipy.optimize import brentq

import beamdyn as bd
from benchmarks.cases.similar_beams import deviation, first_frequency, similar_beam


@pytest.mark.parametrize("planes", [1, 2])
@pytest.mark.parametrize("length", [1e-6, 1e-4, 3e-4, 1e-3, 1e3])
def test_linear_models_are_the_same_at_any_length(length: float, planes: Literal[1, 2]) -> None:
    """Up to 1e-9; before, beams of 0.3 mm and below were refused as past their critical speed."""
    assert deviation(length, planes) < 1e-9


@pytest.mark.parametrize("length", [1e-6, 1.0, 1e3])
def test_all_poles_of_a_damped_beam_at_rest_are_finite_and_decay(length: float) -> None:
    poles = bd.matrices(similar_beam(length), 0.0).poles
    assert np.isfinite(poles).all()
    np.testing.assert_allclose(np.real(poles), -0.01 * np.abs(poles), rtol=1e-4)  # rounding


@pytest.mark.parametrize("length", [1e-6, 1.0, 1e3])
def test_past_the_critical_speed_one_pole_grows_and_answers_are_refused(length: float) -> None:
    inward = bd.Scene(similar_beam(length).beam, bd.Mount(length, 0.0), damping_ratio=0.01)
    critical = bd.critical_speed(inward)
    poles = bd.matrices(inward, 1.01 * critical).poles
    assert (np.real(poles) > 1e-6 * np.abs(poles)).sum() == 1
    frequency = [first_frequency(length) / (2 * np.pi)]
    assert np.isfinite(bd.frequency_response(inward, 0.99 * critical, frequency).response).all()
    with pytest.raises(ValueError, match="past the critical speed"):
        bd.frequency_response(inward, 1.01 * critical, frequency)


@pytest.mark.parametrize("stiffness", [0.0, 1e-12])
def test_a_hinge_is_free_at_rest_and_its_other_poles_are_kept(stiffness: float) -> None:
    beam = bd.Beam.from_stiffness(1.0, 1.0, 1.0)
    hinged = bd.Scene(beam, bd.Mount(1.0, np.pi, root_stiffness=stiffness))
    poles = bd.matrices(hinged, 0.0).poles
    assert np.abs(poles[:2]).max() < 1e-4
    np.testing.assert_allclose(np.abs(poles[2:6:2]), [15.4182057, 49.9648621], rtol=1e-8)  # clamped is none


TWO_PLANES = bd.Scene(
    bd.Beam.from_stiffness(1, 1, 100, second_bending_stiffness=400),
    bd.Mount(1, np.pi, 0.5),
    damping_ratio=0.02,
    physics=bd.Physics(planes=2),
)


@pytest.mark.parametrize("speed", [0.0, 1.0])
def test_white_noise_asks_for_no_more_modes_than_there_are(speed: float) -> None:
    found = bd.random_response(TWO_PLANES, speed, 1.0, output="tip")
    few = bd.random_response(TWO_PLANES, speed, 1.0, output="tip", modes=12)
    assert abs(found.rms - few.rms) <= found.rms_error + few.rms_error
    assert found.psd_error.max() < 1e-6 * found.psd.max()


@pytest.mark.parametrize("functions", [3, 6, 9])
def test_few_functions_are_no_mistake_of_modes_that_nobody_asked_for(functions: int) -> None:
    band, basis = bd.PowerSpectrum([0.1, 3.0], [1.0, 1.0]), bd.Ritz(functions)
    response = bd.frequency_response(TWO_PLANES, 1.0, [1.0], discretization=basis)
    random = bd.random_response(TWO_PLANES, 1.0, band, discretization=basis)
    loads = bd.random_loads(TWO_PLANES, 1.0, band, at=[0.0], discretization=basis)
    assert response.error[0, 0] > 0 and random.rms_error > 0 and loads.rms("moment").shape == (1, 2)


@pytest.mark.parametrize("taper", [0.0, 0.5])
@pytest.mark.parametrize("elements", [6, 8, 9, 10, 12])
def test_stated_errors_of_poles_by_few_elements_cover_the_true_ones(elements: int, taper: float) -> None:
    """Distances of meshes of few elements fall faster than the order of convergence at first."""
    width, thickness = (Polynomial([side, -taper * side]) for side in (0.01, 0.0002))
    scene = bd.Scene(bd.Beam.rectangular(0.05, width, thickness, 200e9, 7850.0), damping_ratio=0.01)
    found = bd.matrices(scene, 0.0, discretization=bd.Fem(elements))
    poles, stated = found.poles[np.isfinite(found.error)], found.error[np.isfinite(found.error)]
    true = bd.matrices(scene, 0.0, discretization=bd.Ritz(24)).poles
    error = np.abs(poles[:, None] - true).min(axis=1) / np.abs(poles)
    assert len(poles) >= 2 and (error <= stated).all()


@pytest.mark.parametrize("functions", range(8, 17))
def test_stated_errors_of_poles_cover_the_true_ones_of_a_uniform_beam_mode_by_mode(functions: int) -> None:
    """A high pole of few functions may be near that of another mode by fewer: then it is unresolved."""
    strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    found = bd.matrices(bd.Scene(strip), 0.0, discretization=bd.Ritz(functions))
    scale = np.sqrt(200e9 * 0.0002**2 / 12 / 7850.0) / 0.05**2
    between = [(np.pi * (n - 1), np.pi * n) for n in range(1, functions + 1)]
    true = scale * np.square([brentq(lambda x: np.cos(x) + 1 / np.cosh(x), *ends) for ends in between])
    error, stated = np.abs(np.abs(found.poles[::2]) / true - 1), found.error[::2]
    assert np.isfinite(stated[:2]).all() and (error <= stated + 1e-14).all()  # rounding of the closed form
