"""The printed tables of other papers: all digits, and a third computation of each erratum.

The third values come from the power-series determinant in 20 digits, which shares nothing with beamdyn.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from mpmath import mp

import beamdyn as bd
from beamdyn.published import load
from beamdyn.reproduce.blades import blade_scene, entries_of_blades
from beamdyn.reproduce.entries import half_unit
from beamdyn.reproduce.printed_tables import PAPERS, cases, entries_of_case, tip_stretch
from benchmarks.cases.reference.power_series import solve_case

CASES = [case for paper in PAPERS for case in cases(paper)]
# Named by whoever collected the tables; others are off by less than a unit of the last digit.
WRONG_BY_MORE = {
    ("Hamza cherif, Houmat 2004: flap", "gamma 50", 1),
    ("Hamza cherif, Houmat 2004: chord", "gamma 50", 1),
    ("Ozdemir, Kaya 2006: tapers", "b 0.4, h 0.4", 2),
    *(("Mabie, Rogers 1972: tapers", "b 0.75, h 0.75", mode) for mode in (1, 3)),
    *(("Mabie, Rogers 1972: tapers", "b 0.8, h 0.75", mode) for mode in (1, 2, 3)),
}

by_case = pytest.mark.parametrize("case", CASES, ids=lambda c: f"{c['name']}, {c['where']}")
by_erratum = pytest.mark.parametrize(
    "case", [c for c in CASES if c["exact"]], ids=lambda c: f"{c['name']}, {c['where']}"
)


def by_power_series(case: dict[str, Any]) -> list[Any]:
    """Values of the case as printed, in 20 digits."""
    model = {"model": "coupled" if "alpha" in case else "bending"}
    squares = solve_case(case | model, max(map(int, case["exact"])), 20)
    return [case["factor"] * mp.sqrt(square) for square in squares]


def test_the_number_of_printed_values() -> None:
    """B1 39, B2 26, B3 12, B4 75, B5 10."""
    counts = [sum(len(case["frequency"]) for case in cases(paper)) for paper in PAPERS]
    assert counts == [39, 26, 12, 75, 10]


@by_case
def test_all_digits_or_a_proven_erratum(case: dict[str, Any]) -> None:
    """Ours is within half a unit of the last printed digit, but where a third method says otherwise."""
    for entry in entries_of_case(case, "ritz"):
        assert entry.as_expected, entry
        assert entry.in_print or entry.is_erratum, entry


@by_erratum
def test_third_computation(case: dict[str, Any]) -> None:
    """Twelve digits of the power series, which do not round to the print."""
    found = by_power_series(case)
    for mode, exact in case["exact"].items():
        value, printed = found[int(mode) - 1], case["frequency"][int(mode) - 1]
        assert abs(float(exact) - value) <= 1.01 * half_unit(exact)
        assert abs(float(printed) - value) > half_unit(printed)


@by_erratum
def test_guaranteed_bounds_exclude_the_print(case: dict[str, Any]) -> None:
    """Of all errata but those with stretch, which no theorem covers."""
    for entry in entries_of_case(case, "ritz"):
        if entry.exact and "alpha" in case:
            assert entry.bounds is None
        elif entry.exact:
            assert entry.bounds is not None
            low, high = entry.bounds
            assert 0 < high - low < 1e-9 * high  # tighter by far than the digits in doubt
            printed = float(entry.printed)
            assert low > printed + entry.rounding or high < printed - entry.rounding


def test_errata_by_more_than_the_last_digit() -> None:
    wrong = {
        (case["name"], entry.where, entry.mode)
        for case in CASES
        if case["exact"]
        for entry in entries_of_case(case, "ritz")
        if entry.exact and abs(entry.off_by) >= 1
    }
    assert wrong == WRONG_BY_MORE


def test_all_of_mabie_and_rogers_is_low() -> None:
    """By 1e-4 to 3.4e-4, errata or not."""
    for case in cases("code_aster"):
        for entry in entries_of_case(case, "ritz"):
            assert 1e-4 < entry.ours / float(entry.printed) - 1 < 3.4e-4


# Limits and closed forms --------------------------------------------------------------------------

CABLE = np.sqrt([k * (2 * k - 1) for k in (1, 2, 3)])
BY_CURVATURE = np.array([0, 525, 12705]) / (2 * CABLE**2)  # relative change of lambda, times gamma^2


def flap_over_speed(speed: float, **root: float) -> np.ndarray:
    """First three flap frequencies of a beam of unit length, mass and stiffness, over the speed."""
    scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0, math.pi, math.pi / 2, **root))
    return np.abs(bd.natural_modes(scene, speed, 3).eigenvalue) / speed


def test_the_printed_ratios_of_a_cable_are_its_formula() -> None:
    printed = [float(text) for text in load("bir_2009")["cable"]["ratio"]]
    np.testing.assert_allclose(printed, CABLE, atol=5e-11, rtol=0)  # half a unit of the last digit


def test_a_hinged_beam_tends_to_a_cable() -> None:
    """From above: lambda^2 rises by int u''^2 / int u^2 of the cable's mode u, 0, 525 and 12705."""
    gamma = 1e5
    above = (flap_over_speed(gamma, root_stiffness=0.0) / CABLE - 1) * gamma**2
    # 1/gamma is left of the next order; rounding of the ratio, 1e-13, times gamma^2
    np.testing.assert_allclose(above, BY_CURVATURE, rtol=1e-4, atol=1e-3)


@pytest.mark.parametrize("gamma", [1e3, 4e3])
def test_a_cantilever_tends_to_a_cable(gamma: float) -> None:
    """From above: its root straightens within a length of sqrt(EI / T) = sqrt(2) / gamma (T = gamma^2 / 2).

    A cable shorter by that has lambda^2 higher by T u'(0)^2 sqrt(EI / T), over int u^2 = 1 / (4 k - 1) of its
    mode, the Legendre polynomial of 2 k - 1: slopes are 1, -3/2, 15/8. The next order is that of curvature.
    """
    slope, k = np.array([1, 1.5, 1.875]), np.array([1, 2, 3])
    straightened = slope**2 * (4 * k - 1) / (2 * math.sqrt(2) * CABLE**2)
    above = (flap_over_speed(gamma) / CABLE - 1) * gamma
    assert (np.abs(above - straightened) < (1 + BY_CURVATURE) / gamma).all()


def stretched_beam() -> tuple[bd.Beam, dict[str, Any]]:
    given = load("code_aster")["stretch"]
    mass, stiffness = given["density"]["value"], given["youngs_modulus"]["value"]
    return bd.Beam.from_stiffness(given["length"]["value"], mass, 1.0, axial_stiffness=stiffness), given


@pytest.mark.parametrize(("method", "rtol"), [(bd.Ritz(16), 1e-13), (bd.Fem(80), 1e-9)], ids=["ritz", "fem"])
def test_centrifugal_stretch(method: bd.Ritz | bd.Fem, rtol: float) -> None:
    """tan(a L) / a - L, a = speed sqrt(rho / E), which rounds to what Code_Aster prints."""
    beam, given = stretched_beam()
    a = given["speed"]["value"] * math.sqrt(given["density"]["value"] / given["youngs_modulus"]["value"])
    closed = math.tan(a * beam.length) / a - beam.length
    assert closed == pytest.approx(float(given["stretch"]), rel=1e-14)  # rounding of the difference
    assert tip_stretch(beam, given["speed"]["value"], method) == pytest.approx(closed, rel=rtol)


@pytest.mark.parametrize("method", [bd.Ritz(16), bd.Fem(80)], ids=["ritz", "fem"])
def test_stretch_of_the_blade_that_spins_up(method: bd.Ritz | bd.Fem) -> None:
    given = {
        key: entry["value"] for key, entry in load("rotating_beams")["spin_up"].items() if key != "source"
    }
    beam = bd.Beam.from_stiffness(
        given["length"],
        given["line_density"],
        given["bending_stiffness"],
        axial_stiffness=given["axial_stiffness"],
    )
    found = tip_stretch(beam, given["speed"], method)
    assert found == pytest.approx(given["steady_stretch"], abs=0.51e-10)  # half a unit of the last digit


# Blades -------------------------------------------------------------------------------------------


@pytest.mark.parametrize("discretization", ["ritz", "fem"])
def test_blades_of_wind_turbines(discretization: str) -> None:
    """25 values of two planes with twist, and five without, to 1e-5."""
    entries = [entry for _, entry in entries_of_blades(discretization)]
    assert len(entries) == 30
    for entry in entries:
        assert entry.as_expected, entry
        assert entry.relative_deviation < 1e-5


def test_the_values_of_blades_tell_twist_from_none() -> None:
    """Their twist is worth 0.1 to 0.4 %, a hundred times the tolerance."""
    for row in load("blades")["blade"]:
        speed = row["speed_rpm"] * math.pi / 30
        plain = bd.natural_modes(blade_scene(row["name"], twisted=False), speed, 5).frequency
        assert np.abs(plain / np.array(row["frequency"], dtype=float) - 1).max() > 1e-3
