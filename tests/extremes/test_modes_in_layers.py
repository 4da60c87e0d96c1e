"""Modes and critical speeds that live in a short layer at the tip, and stiffness that changes steeply.

Two bases, or two meshes, that resolve neither agree with each other.  The values were found by shooting or by
assumed modes on segments that shrink towards both ends.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.polynomial import Polynomial

import beamdyn as bd
from benchmarks.stated_tolerance_errors import SEED, measure
from benchmarks.two_discretizations import SEED as SEED_OF_TABLES
from benchmarks.two_discretizations import measure as measure_tables


def scene_of(beam: Polynomial, stiffness: Polynomial, tip: tuple[float, ...], mount: bd.Mount) -> bd.Scene:
    return bd.Scene(bd.Beam.from_stiffness(1.0, beam, stiffness, tip=bd.TipMass(*tip)), mount)


A, B = Polynomial([1, -0.2806177891683129]), Polynomial([1, -0.4201771879527136])
FIFTH = scene_of(
    A,
    A**3,
    (0.2606032351584146, -0.009714257049657837),
    bd.Mount(0.0, -2.89555906458807, 0.885384137233222),
)
THIRD = scene_of(
    B,
    B**3,
    (12.74875134048287, -0.033993014763889176),
    bd.Mount(0.8649435306389569, 3.0367425676691333, -1.3730371964135313),
)


@pytest.mark.parametrize("tolerance", [1e-1, 1e-2, 1e-3, 1e-4, 1e-6, None])
def test_a_mode_at_the_tip_body_is_found_at_any_tolerance(tolerance: float | None) -> None:
    modes = bd.natural_modes(FIFTH, 123.6449028464993, 5, tolerance=tolerance)
    assert abs(abs(modes.eigenvalue[4]) / 1063.43879184 - 1) <= modes.error[4] + 1e-11


def test_elements_find_a_mode_at_the_tip_body() -> None:
    modes = bd.natural_modes(THIRD, 2.7206016133661723, 3, "fem", 4e-4)
    assert abs(abs(modes.eigenvalue[2]) / 64.02642621 - 1) <= modes.error[2] < 1e-2


@pytest.mark.parametrize("tolerance", [1e-1, 1e-3, None])
def test_elements_find_where_a_tip_body_topples(tolerance: float | None) -> None:
    a, b = Polynomial([1, -0.6855084041190785]), Polynomial([1, -0.10367014388273023])
    body = (
        0.638690641494518,
        -0.01935927338677601,
        0.0748631420403632,
        0.07832073491758795,
        0.11201293069065191,
    )
    mount = bd.Mount(0.13143132125227053, -1.3370494928856882, 0.008994087169273808)
    point = bd.critical_point(scene_of(a * b, a * b**3, body, mount), "fem", tolerance)
    assert abs(point.speed / 31.99417586 - 1) <= point.error < 1e-3


@pytest.mark.parametrize("elements", [25, 50, 100, 200, 400])
def test_elements_state_the_error_of_a_steep_stiffness(elements: int) -> None:
    """By shooting: 3.35730232 Hz."""
    stiffness = bd.Table([0, 0.27, 0.28, 1], [100, 1, 160, 100])
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, stiffness), bd.Mount(1.0, np.pi))
    modes = bd.natural_modes(scene, 0.0, 1, bd.Fem(elements))
    error = abs(modes.frequency[0] / 3.35730232 - 1)
    assert error <= modes.error[0] < 10 * error


@pytest.mark.parametrize("elements", [50, 100, 200, 400])
def test_elements_state_the_error_of_a_jump(elements: int) -> None:
    stiffness = bd.Table([0, 0.2, 0.2, 1], [1000, 1000, 1, 1])
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, stiffness))
    modes, exact = (bd.natural_modes(scene, 0.0, 1, d) for d in (bd.Fem(elements), "ritz"))
    assert abs(modes.frequency[0] / exact.frequency[0] - 1) <= modes.error[0]


@pytest.mark.slow
def test_stated_errors_of_random_tip_bodies_at_any_tolerance() -> None:
    """Scenes 1100 to 1119, of which the version before lost modes, and of which some turn at gamma 2000."""
    for number in range(1100, 1120):
        (case,) = measure(number, SEED, critical=False)
        assert not case.refusal
        true, known, stated = map(np.array, (case.true, case.known, case.stated))
        assert (true - known <= 1.5 * stated).all(), number


@pytest.mark.slow
def test_random_tables_have_one_answer_by_both_discretizations() -> None:
    """Scenes 380 to 389: short segments, point springs, bodies at the tip."""
    for number in range(380, 390):
        (case,) = measure_tables(number, SEED_OF_TABLES)
        assert (np.array(case.distance) <= case.stated).all(), number


def test_matrices_and_studies_know_modes_in_layers() -> None:
    """Both choose functions for modes, and take these for the beam: with the breakpoints of its layers."""
    speed, true = 123.6449028464993, 1063.43879184
    poles = bd.matrices(FIFTH, speed, 5)
    rank = np.argsort(np.abs(poles.poles.imag))[8:]
    np.testing.assert_allclose(np.abs(poles.poles[rank]), true, rtol=1e-6)
    study = bd.study(
        FIFTH,
        {"beam.tip.mass": FIFTH.beam.tip.mass * np.linspace(1, 1.01, 12)},
        speed=speed,
        modes=5,
        tolerance=0.1,
    )
    assert abs(2 * np.pi * study.value[0, 4] / true - 1) <= study.error[0, 4] < 0.1
