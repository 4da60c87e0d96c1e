"""Spreads (ranges of answers over tolerances of inputs): statistics against closed forms, and times.

Run: python -m benchmarks.spread [--seeds N]

Mean, standard deviation and Sobol' indices are known in closed form for Ishigami's function, and for a
frequency that is a product of powers of its inputs.  Printed are the root mean square, over seeds, of
deviations over their standard errors, for all statistics and the largest of one statistic (which scatters by
0.1 with 50 seeds), and the fraction above 3 standard errors.  Student's t distribution with 15 degrees of
freedom (16 blocks of samples) gives 1.07 and 0.9 %.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from functools import partial
from time import process_time

import numpy as np

import beamdyn as bd
from beamdyn.common.spreading.solve import SpreadAnswers, solve_spread
from beamdyn.common.spreading.tolerances import SpreadInput, Uniform
from benchmarks.rows import Row, best_time, show, time_text

BEAM = {"length": 0.05, "width": 0.01, "thickness": 2e-4, "youngs_modulus": 2e11, "density": 7850.0}
PLAIN = bd.Scene(bd.Beam.rectangular(**BEAM), bd.Mount(0.2))
TOLERANCES = {"beam.thickness": "+-20%", "beam.length": "+-10%", "beam.density": "+-5%"}
POWERS = (1.0, -2.0, -0.5)
SAMPLES = 1024


def evaluate(columns: dict[str, np.ndarray]) -> SpreadAnswers:
    """Evaluate Ishigami's function of three inputs."""
    x, y, z = columns.values()
    value = (np.sin(x) + 7 * np.sin(y) ** 2 + 0.1 * z**4 * np.sin(x))[:, None]
    states = np.full(value.shape, "done")
    return SpreadAnswers(("y",), ("",), value, np.zeros(value.shape), states, (), "a formula", "nothing")


def ishigami(seed: int) -> np.ndarray:
    """Compute deviations over their standard errors: mean, standard deviation, indices."""
    inputs = [SpreadInput(name, "", 0.0, Uniform(-np.pi, np.pi)) for name in "xyz"]
    found = solve_spread("y", inputs, SAMPLES, seed, evaluate)
    of_x = (1 + 0.1 * np.pi**4 / 5) ** 2 / 2
    of_y, of_both = 49 / 8, 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    variance = of_x + of_y + of_both
    first = np.array([of_x, of_y, 0.0]) / variance
    total = np.array([of_x + of_both, of_y, of_both]) / variance
    return scores(found, 3.5, variance**0.5, first, total)


def product_of_powers(seed: int) -> np.ndarray:
    """Compute deviations for the first frequency of a uniform beam, as h / (L^2 rho^(1/2))."""
    found = bd.spread(PLAIN, TOLERANCES, modes=1, samples=SAMPLES, seed=seed)
    means, squares = np.array(
        [_moments(*each.distribution.ends, p) for each, p in zip(found.inputs, POWERS, strict=True)]
    ).T
    own = squares / means**2 - 1
    nominal = np.prod([each.nominal**p for each, p in zip(found.inputs, POWERS, strict=True)])
    mean, variance = found.nominal[0] / nominal * means.prod(), np.prod(1 + own) - 1
    return scores(found, mean, mean * variance**0.5, own / variance, own / (1 + own) * (1 + 1 / variance))


def _moments(low: float, high: float, power: float) -> list[float]:
    """Compute the means of x^power and of its square, for x uniform between two ends."""
    ends = (
        (high ** (p + 1) - low ** (p + 1)) / ((p + 1) * (high - low)) for p in (power, 2 * power) if p != -1
    )
    found = [*ends]
    return found if len(found) == 2 else [*found, np.log(high / low) / (high - low)]


def scores(
    found: bd.Spread, mean: float, deviation: float, first: np.ndarray, total: np.ndarray
) -> np.ndarray:
    """Compute deviations over their standard errors."""
    scatter, indices = found.scatter, found.indices
    return np.concatenate(
        [
            (scatter.mean - mean) / scatter.mean_error,
            (scatter.deviation - deviation) / scatter.deviation_error,
            (indices.first[:, 0] - first) / indices.first_error[:, 0],
            (indices.total[:, 0] - total) / indices.total_error[:, 0],
        ]
    )


def statistics(seeds: int) -> Iterator[Row]:
    """Yield deviations of statistics from closed forms."""
    for name, case in (("Ishigami's function", ishigami), ("a product of powers", product_of_powers)):
        found = np.array([case(seed) for seed in range(seeds)])
        each, size = np.sqrt((found**2).mean(axis=0)), np.sqrt((found**2).mean())
        of_all, largest = f"{size:.2f} ({each.max():.2f})", "1.07 of Student's t"
        yield f"{name}, {seeds} seeds: deviations over standard errors, rms (largest)", of_all, largest
        beyond = (np.abs(found) > 3).mean()
        yield "... beyond 3 standard errors", f"{100 * beyond:.1f} %", "0.9 %"


def times() -> Iterator[Row]:
    """Yield the computing time of a spread of three inputs with 5120 random designs."""
    run = partial(bd.spread, PLAIN, TOLERANCES, speed=50.0)
    yield "5120 designs of three inputs, three modes", time_text(best_time(run, 3, process_time)), ""


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--seeds", type=int, default=50)
    show("Spreads", partial(statistics, parser.parse_args().seeds), times)
