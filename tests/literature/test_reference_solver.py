"""The power-series reference of `benchmarks/cases` reproduces the published values to their last digit."""

import math
from decimal import Decimal

import pytest
from mpmath import mp, mpf

from beamdyn.published import load
from benchmarks.cases.reference.power_series import (
    Tip,
    bending_eigenvalues,
    coupled_frequencies,
    critical_speed,
    solve_case,
)

BEAMS = load("rotating_beams")
PAPER = load("lee_yoo_2019")
FLAP = math.pi / 2


def last_digit(printed: float) -> float:
    """One unit in the last digit that the data file gives."""
    return 10.0 ** Decimal(repr(printed)).as_tuple().exponent


def agree(found: mpf, printed: float) -> bool:
    # 0.51: half a unit from rounding, and the little that the printed float itself is off
    return abs(found - printed) <= 0.51 * last_digit(printed)


def named(table: str) -> list:
    return [pytest.param(case, id=case["name"]) for case in BEAMS[table]]


@pytest.mark.parametrize("case", named("case"))
def test_frequencies(case):
    squares = solve_case(case, count=len(case["frequency"]), digits=20)
    assert all(map(agree, map(mp.sqrt, squares), case["frequency"]))


@pytest.mark.parametrize("case", named("critical"))
def test_critical_speeds(case):
    tip = Tip(**case["tip"]) if "tip" in case else None
    angle = math.radians(case["bending_angle_deg"])
    found = critical_speed(case["delta"], angle, case["mass"], case["stiffness"], tip, digits=20)
    assert found == case["gamma"] == mp.inf or agree(found, case["gamma"])


def test_critical_speed_of_the_beam_whose_tip_is_on_the_axis():
    zero = mp.findroot(lambda z: mp.besselj(-0.25, z), 2)
    assert abs(critical_speed(-1, FLAP) - 2 * mp.sqrt(2) * zero) < 1e-14


def test_limit_of_the_critical_speed_at_large_radius():
    limit = BEAMS["critical_limit"]["gamma_squared_times_radius"]
    assert agree(critical_speed(-1e7, digits=15) ** 2 * 1e7, limit)


@pytest.mark.parametrize("delta", [0, 1])
def test_slopes_at_rest(delta):
    """Squares are linear in gamma^2 to within gamma^4: 1e-8 leaves the ten printed digits."""
    slopes = BEAMS["southwell"]
    rest, turning = (bending_eigenvalues(gamma, delta, FLAP, digits=40) for gamma in (0, "1e-8"))
    for a, b, flap, hub in zip(rest, turning, slopes["flap"], slopes["hub"], strict=True):
        tolerance = 0.51 * last_digit(flap) + delta * 0.51 * last_digit(hub)
        assert abs((b - a) * 10**16 - (flap + delta * hub)) < tolerance


def paper_scale() -> tuple[float, float, float]:
    """Tau [s], r/L and alpha of the paper's beam."""
    value = {name: entry["value"] for name, entry in PAPER["input"].items()}
    slenderness = math.sqrt(12) * value["length"] / value["thickness"]
    tau = slenderness * value["length"] * math.sqrt(value["density"] / value["youngs_modulus"])
    return tau, value["radius"] / value["length"], slenderness


@pytest.mark.parametrize("row", PAPER["reference"]["first_frequency"], ids=lambda row: str(row["speed"]))
def test_frequencies_of_lee_and_yoo(row):
    tau, radius, slenderness = paper_scale()
    gamma = row["speed"]["value"] * tau
    bending = mp.sqrt(bending_eigenvalues(gamma, -radius, count=1, digits=15)[0])
    coupled = coupled_frequencies(gamma, -radius, slenderness, digits=15)[0]
    for found, printed in ((bending, row["bending"]), (coupled, row["stretch"])):
        assert agree(found / (2 * math.pi * tau), printed["value"])


def test_critical_speed_of_lee_and_yoo():
    tau, radius, _ = paper_scale()
    assert agree(critical_speed(-radius) / tau, PAPER["reference"]["critical_speed"]["value"])


@pytest.mark.parametrize("row", PAPER["reference"]["second_setting_angle_limit"])
def test_second_setting_angle_limits(row):
    """There the first frequency has its maximum over the speed at the top speed."""
    tau, radius, _ = paper_scale()
    top, step = row["top_speed"]["value"] * tau, mpf("1e-4")

    def slope(angle: float) -> mpf:
        delta = -radius * math.cos(math.radians(angle))
        low, high = (bending_eigenvalues(top + sign * step, delta, count=1)[0] for sign in (-1, 1))
        return high - low

    half = 0.51 * last_digit(row["value"])
    assert slope(row["value"] - half) < 0 < slope(row["value"] + half)


def test_a_skipped_root_is_an_error(monkeypatch):
    from benchmarks.cases.reference import power_series

    lowest = power_series._lowest

    def without_the_second(*args):
        values, vectors = lowest(*args)
        return values[[0, *range(2, len(values))]], vectors

    monkeypatch.setattr(power_series, "_lowest", without_the_second)
    with pytest.raises(ArithmeticError, match="does not change sign"):
        bending_eigenvalues(1, count=3)
