"""Spreads against closed forms: Sobol' indices, moments, percentiles, worst cases, first order.

Statistics are compared with what they estimate to within 3 of their own standard errors.  Seeds are fixed,
and a test has some 20 numbers at most, of each of which Student's t with 15 degrees has 0.9 % beyond 3.
"""

import math

import numpy as np
import pytest
from scipy.special import ndtri

import beamdyn as bd
from beamdyn.common.spreading.solve import SpreadAnswers, solve_spread
from beamdyn.common.spreading.statistics import PERCENTS
from beamdyn.common.spreading.tolerances import Normal, SpreadInput, Uniform

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
PLAIN = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2))
EXACT = 1e-9  # relative: errors of frequencies meet it by default


def within(found, error, exact):
    """Whether an estimate lies within three standard errors of what it estimates."""
    return (np.abs(np.asarray(found) - exact) <= 3 * np.asarray(error) + 1e-12).all()


def spread_of(function, distributions, samples=1024, seed=0):
    """The spread of a function of arrays."""
    nominal = (sum(each.ends) / 2 for each in distributions)
    inputs = [
        SpreadInput(f"x{i}", "", x, each)
        for i, (x, each) in enumerate(zip(nominal, distributions, strict=True))
    ]

    def evaluate(columns):
        value = function(*columns.values())[:, None]
        none, state = np.zeros(value.shape), np.full(value.shape, "done")
        return SpreadAnswers(("y",), ("",), value, none, state, (), "a formula", "nothing")

    return solve_spread("y", inputs, samples, seed, evaluate)


def ishigami(x, y, z):
    return np.sin(x) + 7 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x)


def test_ishigami():
    """Ishigami and Homma (1990): mean 7/2, and the closed forms of its variances."""
    found = spread_of(ishigami, [Uniform(-np.pi, np.pi)] * 3)
    of_x = (1 + 0.1 * np.pi**4 / 5) ** 2 / 2
    of_y, of_both = 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    variance = of_x + of_y + of_both
    first = np.array([of_x, of_y, 0.0]) / variance
    total = np.array([of_x + of_both, of_y, of_both]) / variance
    assert within(found.indices.first[:, 0], found.indices.first_error[:, 0], first)
    assert within(found.indices.total[:, 0], found.indices.total_error[:, 0], total)
    assert within(found.scatter.mean, found.scatter.mean_error, 3.5)
    assert within(found.scatter.deviation, found.scatter.deviation_error, variance**0.5)
    assert found.matters_most()[0] == "x0"
    assert found.indices.total_error.max() < 0.05  # so that the test can fail


def test_a_search_finds_worst_cases_inside():
    """Largest and smallest lie at x = +-pi/2, z = +-pi, y = pi/2 or 0: neither corner nor nominal."""
    found = spread_of(ishigami, [Uniform(-np.pi, np.pi)] * 3)
    tip = 1 + 0.1 * np.pi**4
    assert found.worst.searched.all()
    np.testing.assert_allclose(found.worst.largest, 7 + tip, rtol=1e-5)  # steps end at 2^-11, squared
    np.testing.assert_allclose(found.worst.smallest, -tip, rtol=1e-5)
    assert any("worse designs may exist" in said for said in found.warnings)


def test_standard_errors_are_those_of_many_seeds():
    """Deviations over their standard errors have the mean square of Student's t with 15 degrees, 15/13.

    The sum of two normal numbers is normal, so that its percentiles are known.  The mean of 20 such squares
    scatters by a third.
    """
    given = [Normal(1.0, 0.3), Normal(2.0, 0.4)]
    exact = 3.0 + 0.5 * ndtri(np.array(PERCENTS) / 100)
    scores = []
    for seed in range(20):
        found = spread_of(lambda x, y: x + y, given, 256, seed)
        scatter, indices = found.scatter, found.indices
        scores.append(
            [
                (scatter.mean[0] - 3.0) / scatter.mean_error[0],
                (scatter.deviation[0] - 0.5) / scatter.deviation_error[0],
                *((scatter.percentile - exact[:, None]) / scatter.percentile_error).ravel(),
                *((indices.total[:, 0] - [0.36, 0.64]) / indices.total_error[:, 0]),
                *((indices.first[:, 0] - [0.36, 0.64]) / indices.first_error[:, 0]),
            ]
        )
    square = np.mean(np.square(scores), axis=0)
    assert (square < 3.0).all()  # errors are not understated
    assert (square[[0, 1, *range(7, 11)]] > 0.2).all()  # nor overstated, but for percentiles of few samples


def moments(given, power):
    """Mean of x^power and of its square, over the square of the mean."""
    if isinstance(given, Uniform):
        a, b = given.low, given.high
        mean, square = ((b ** (p + 1) - a ** (p + 1)) / ((p + 1) * (b - a)) for p in (power, 2 * power))
    else:
        x, weights = np.polynomial.hermite_e.hermegauss(40)
        values = (given.mean + given.deviation * x) ** power
        mean, square = (weights @ values**p / weights.sum() for p in (1, 2))
    return mean, square / mean**2 - 1


def test_indices_of_a_product_of_powers():
    """The frequency is c h / L^2 (E / rho)^(1/2): each factor has its own relative variance v.

    The variance is prod(1 + v) - 1 over the square of the mean; an input alone makes v of it, and with what
    it does together with others v prod(1 + v of others).
    """
    given = {
        "beam.thickness": (Uniform(1.6e-4, 2.4e-4), 1.0),
        "beam.length": (Uniform(0.045, 0.055), -2.0),
        "beam.youngs_modulus": (Normal(2e11, 1e10), 0.5),
        "beam.width": (Uniform(0.009, 0.011), 0.0),
    }
    found = bd.spread(PLAIN, {name: each for name, (each, _) in given.items()}, modes=2)
    factors = np.array([moments(*each) for each in given.values()])
    powers = np.array([PLAIN.beam.length**-2 * 2e-4 * 2e11**0.5])
    c = found.nominal / powers
    mean, v = c * factors[:, 0].prod(), factors[:, 1]
    total = np.prod(1 + v) - 1
    assert within(found.scatter.mean, found.scatter.mean_error, mean)
    assert within(found.scatter.deviation, found.scatter.deviation_error, mean * total**0.5)
    alone, together = (v / total)[:, None], (v / (1 + v) * (1 + total) / total)[:, None]
    assert within(found.indices.first, found.indices.first_error, alone)
    assert within(found.indices.total, found.indices.total_error, together)
    assert found.trends.tolist() == [["rises"] * 2, ["falls"] * 2, ["rises"] * 2, ["does not change"] * 2]
    np.testing.assert_allclose(found.worst.largest, found.nominal * 1.2 / 0.9**2 * 1.15**0.5, rtol=EXACT)
    np.testing.assert_allclose(found.worst.smallest, found.nominal * 0.8 / 1.1**2 * 0.85**0.5, rtol=EXACT)


def test_monte_carlo_is_first_order_where_the_answer_is_linear():
    """At tolerances of 0.01 % what is left out is 1e-8, far below the standard errors, some 1e-7."""
    scene = bd.Scene(bd.Beam.rectangular(**BEAM, tip=bd.TipMass(1e-4, 1e-3, 1e-10)), bd.Mount(0.2))
    tight = dict.fromkeys(("beam.thickness", "beam.length", "beam.tip.mass", "speed"), "+-0.01%")
    found = bd.spread(scene, tight | {"mount.radius": "sd 0.01%"}, speed=60.0)
    first = found.first_order
    assert within(found.scatter.mean, found.scatter.mean_error, first.mean)
    assert within(found.scatter.deviation, found.scatter.deviation_error, first.deviation)
    assert within(found.indices.total, found.indices.total_error, first.share)
    assert first.exact.all()
    np.testing.assert_allclose(found.worst.smallest, first.smallest, rtol=1e-7)
    np.testing.assert_allclose(found.worst.largest, first.largest, rtol=1e-7)


@pytest.mark.parametrize(
    ("what", "options"),
    [("frequencies", {"speed": 60.0}), ("critical_speed", {}), ("crossings", {"speed": 150.0})],
)
def test_slopes_from_designs_are_the_derivatives(what, options):
    """A factor of all thicknesses has no derivative of its own: designs give it, within the error stated."""
    wheel = bd.RollingWheel(0.3, bd.SpinUp(55.0, 10.0), bd.RoadWave(0.3, 0.01))
    scene = bd.Scene(PLAIN.beam, PLAIN.mount, wheel)
    by_number, by_factor = (
        bd.spread(scene, {name: "+1% -2%"}, what, samples=128, **options).first_order
        for name in ("beam.thickness", "beam.scale.thickness")
    )
    known = np.isfinite(by_number.slope)
    assert by_number.exact[known].all() and not by_factor.exact.any() and known.any()
    exact, found = by_number.slope[known] * 2e-4, by_factor.slope[known]
    assert (np.abs(found - exact) <= by_factor.slope_error[known] + 1e-9 * np.abs(exact)).all()
    assert (by_factor.slope_error[known] < 1e-3 * np.abs(exact)).all()


def test_slopes_at_the_end_of_a_tolerance():
    """One-sided designs: of a polynomial of fourth degree exact, but for rounding."""
    inputs = [SpreadInput("x", "", 1.0, Uniform(1.0, 1.5)), SpreadInput("y", "", 0.5, Uniform(0.0, 1.0))]

    def evaluate(columns):
        value = (columns["x"] ** 4 - columns["x"] + 3 * columns["y"])[:, None]
        state = np.full(value.shape, "done")
        return SpreadAnswers(("y",), ("",), value, np.zeros(value.shape), state, (), "a formula", "nothing")

    slope = solve_spread("y", inputs, 128, 0, evaluate).first_order.slope
    np.testing.assert_allclose(slope[:, 0], [3.0, 3.0], rtol=1e-12)


def test_designs_that_buckle_are_counted():
    """The critical speed is proportional to the thickness: at that of 0.2 mm thinner beams buckle.

    Of 0.19 mm to 0.22 mm these are a third.
    """
    at = bd.critical_speed(PLAIN)
    given = {"beam.thickness": "1.9e-4 to 2.2e-4", "beam.width": "+-1%"}
    found = bd.spread(PLAIN, given, speed=at, modes=2)
    scatter = found.scatter
    assert abs(scatter.no_answer[0] - 1 / 3) <= 3 * scatter.no_answer_error[0] + 0.5 / 2048
    assert scatter.no_answer[1] == 0
    assert math.isclose(found.states[0]["divergence"], scatter.no_answer[0])
    assert np.isnan(found.indices.total[:, 0]).all() and np.isfinite(found.indices.total[:, 1]).all()
    assert found.matters_most(0) == () and found.matters_most(1) == ("beam.thickness",)
    assert any("mode 1: 33 % of the random designs have no answer" in said for said in found.warnings)
    assert found.scatter.percentile[0, 0] >= 0
