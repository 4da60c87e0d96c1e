"""Statistics of the results of random designs, with their standard errors.

The samples are divided into blocks of points that are scrambled independently, so that the scatter of the
block means gives the error of the mean.  This needs no assumption on the results, and accounts for evenly
distributed points, whose means scatter less than those of independent points.  A statistic is a mean or a
ratio of means over blocks; its error follows by linearization.

The designs are: random designs for statistics, the nominal design, and neighbouring designs for derivatives.

There are two random samples A and B of n designs each.  For each input, a further sample has that input from
B and all other inputs from A (Saltelli et al., Computer Physics Communications 181 (2010) 259).  A and B are
points of `BLOCKS` independently scrambled Sobol' sequences.

In shapes of arrays, d counts inputs, k results, and N all designs.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from inspect import signature
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count
from beamdyn.common.spreading.tolerances import SpreadInput

if TYPE_CHECKING:
    from scipy.stats.qmc import QMCEngine

BLOCKS = 16
LEAST, MOST = 128, 2**17  # allowed numbers of samples: with fewer, blocks are too small to estimate errors
MOST_SEED = 2**63
# The step is so large that rounding errors are negligible, and so small that results are nearly linear.
_STEP = 1 / 8  # largest step for derivatives, as a fraction of the distance to an end of the tolerance
_ONE_SIDED, _BOTH_SIDES = np.array([0.25, 0.5, 0.75, 1.0]), np.array([-1.0, -0.5, 0.5, 1.0])


def check_samples(samples: object) -> tuple[int, list[str]]:
    """Return the number of samples to use, a power of two, with a warning if another number was given."""
    given = count("samples", samples, LEAST, MOST)
    used = 1 << (given - 1).bit_length()
    said = [f"samples = {given}: {used}, the next power of two, are used"] if used != given else []
    return used, said


def count_designs(inputs: int, samples: int) -> int:
    """Compute the number of designs that a spread evaluates before it searches for worst cases.

    `inputs` is the number of inputs, `samples` the number of designs in each random sample.
    """
    return 1 + 4 * inputs + (2 + inputs) * samples


def check_seed(seed: object) -> int:
    """Return the seed of the samples; raise an error unless it is a whole number of 0 or more."""
    return count("seed", seed, 0, MOST_SEED)


@dataclass(frozen=True)
class SpreadDesigns:
    """All designs that are computed at first: nominal design, designs for derivatives, random designs.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The d inputs.
    samples : int
        Number n of designs of each random sample.
    seed : int
        Seed of the random samples.
    """

    inputs: Sequence[SpreadInput]
    samples: int
    seed: int

    @property
    def count(self) -> int:
        """Return the number d of inputs."""
        return len(self.inputs)

    @cached_property
    def table(self) -> np.ndarray:
        """Return all designs, one per row, shape (1 + 4 d + (d + 2) n, d), for d inputs and n samples.

        The rows are the nominal design, the designs for derivatives, the random samples A and B, and A with
        each input in turn from B.
        """
        first, second = self._random
        mixed = np.tile(first, (self.count, 1, 1))
        each = np.arange(self.count)
        mixed[each, :, each] = second.T
        return np.vstack([self.nominal, self._beside, first, second, mixed.reshape(-1, self.count)])

    @property
    def nominal(self) -> np.ndarray:
        """Return the nominal design."""
        return np.array([each.nominal for each in self.inputs])

    @cached_property
    def steps(self) -> np.ndarray:
        """Return the steps from the nominal values of the designs for derivatives, (inputs, 4).

        The largest steps are an eighth of the distance to either end of the tolerance; if the nominal value
        is at an end, all steps are towards the other end.
        """
        return np.array([_steps(each) for each in self.inputs])

    @property
    def _beside(self) -> np.ndarray:
        """Return the designs in which one input differs from its nominal value, (4 inputs, inputs)."""
        beside = np.tile(self.nominal, (self.count, 4, 1))
        each = np.arange(self.count)
        beside[each, :, each] += self.steps
        return beside.reshape(-1, self.count)

    @cached_property
    def _random(self) -> np.ndarray:
        """Return the random samples A and B, (2, samples, inputs)."""
        blocks = np.random.SeedSequence(self.seed).spawn(BLOCKS)
        shares = np.stack([_sobol_points(2 * self.count, self.samples // BLOCKS, each) for each in blocks])
        shares = shares.reshape(self.samples, 2, self.count).transpose(1, 0, 2)
        return np.stack([each.distribution.at(shares[..., i]) for i, each in enumerate(self.inputs)], axis=-1)

    def part(self, answers: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Split the results (N, k) of all designs into nominal, neighbouring and random designs.

        Returns
        -------
        nominal : ndarray, shape (k,)
        beside : ndarray, shape (d, 4, k)
        random : ndarray, shape (2 + d, samples, k)
            Results of the samples A, B, and A with each input in turn from B.
        """
        k, slopes = answers.shape[1], 1 + 4 * self.count
        beside = answers[1:slopes].reshape(self.count, 4, k)
        return answers[0], beside, answers[slopes:].reshape(2 + self.count, self.samples, k)


def _steps(given: SpreadInput) -> np.ndarray:
    low, high = (_STEP * (end - given.nominal) for end in given.distribution.ends)
    if min(-low, high) <= 1e-6 * (high - low):
        return _ONE_SIDED * (high if high > -low else low)
    return np.where(_BOTH_SIDES < 0, -low, high) * _BOTH_SIDES


def _sobol_points(columns: int, rows: int, seed: np.random.SeedSequence) -> np.ndarray:
    """Return points of a scrambled Sobol' sequence, shape (rows, columns), all between 0 and 1."""
    from scipy.stats import qmc  # imported here, because the import takes long

    if columns > qmc.Sobol.MAXDIM:
        raise InvalidValue("spread", columns // 2, f"give at most {qmc.Sobol.MAXDIM // 2} inputs to a spread")
    return np.clip(seeded(qmc.Sobol, columns, seed).random(rows), 2.0**-40, 1 - 2.0**-40)


def seeded(sequence: Callable[..., QMCEngine], columns: int, seed: np.random.SeedSequence | int) -> QMCEngine:
    """Make a sequence of points of `scipy.stats.qmc`; scipy before 1.15 has another name for the seed."""
    name = "rng" if "rng" in signature(sequence).parameters else "seed"
    return sequence(columns, **{name: np.random.default_rng(seed)})


# Statistics of the results ------------------------------------------------------------------------


PERCENTS = (1.0, 5.0, 50.0, 95.0, 99.0)
_LEAST_BLOCKS = 8  # least number of blocks with results from which an error is estimated
_ROUNDING = 1e-12  # relative scatter of results below which they count as equal


@dataclass(frozen=True)
class Scatter:
    """Statistics of each of k results over those random designs that have this result.

    Parameters
    ----------
    mean, mean_error : ndarray, shape (k,)
        Mean [units of the results], nan if no design has a result; and its standard error, inf if fewer than
        8 of the 16 blocks of samples contain results.
    deviation, deviation_error : ndarray, shape (k,)
        Standard deviation and its standard error, nan and inf as for the mean [same units].
    percentile : ndarray, shape (5, k)
        Percentiles: results below which the percentages `PERCENTS` of all results lie [same units].
    percentile_error : ndarray, shape (5, k)
        Standard errors of the percentiles [same units]; inf as for the mean.
    no_answer : ndarray, shape (k,)
        Fraction of designs without a result.
    no_answer_error : ndarray, shape (k,)
        Standard error of this fraction.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.spread(bd.Scene(strip), {"beam.thickness": "+-2%"}, modes=1, samples=128)
    >>> found.scatter.mean.shape, found.scatter.percentile.shape
    ((1,), (5, 1))
    """

    mean: np.ndarray
    mean_error: np.ndarray
    deviation: np.ndarray
    deviation_error: np.ndarray
    percentile: np.ndarray
    percentile_error: np.ndarray
    no_answer: np.ndarray
    no_answer_error: np.ndarray


def scatter_of(random: np.ndarray) -> Scatter:
    """Compute the scatter of results over random designs.

    Parameters
    ----------
    random : ndarray, shape (2, samples, results)
        Results of the samples A and B; not finite where there is none.
    """
    two, n, k = random.shape
    blocks = random.reshape(two, BLOCKS, n // BLOCKS, k)
    blocks = np.moveaxis(blocks, -1, 0).transpose(0, 2, 1, 3).reshape(k, BLOCKS, -1)
    return Scatter(*(np.stack(each, axis=-1) for each in zip(*map(_scatter_of_one, blocks), strict=True)))


def _scatter_of_one(values: np.ndarray) -> tuple[np.ndarray | float, ...]:
    """Compute the fields of `Scatter` for one result, from its values: one row for each block of samples."""
    known = np.isfinite(values)
    none, none_error = mean_of_blocks(~known, np.ones(values.shape))
    if not known.any():
        nothing, nowhere = np.full(len(PERCENTS), np.nan), np.full(len(PERCENTS), np.inf)
        return np.nan, np.inf, np.nan, np.inf, nothing, nowhere, none, none_error
    filled = np.where(known, values, 0.0)
    mean, mean_error = mean_of_blocks(filled, known)
    variance, variance_error = mean_of_blocks((filled - mean) ** 2, known)
    deviation = float(np.sqrt(variance))
    deviation_error = variance_error / (2 * deviation) if deviation else 0.0
    found = np.array([_percentile(filled, known, percent / 100) for percent in PERCENTS])
    if known.any(axis=1).sum() < _LEAST_BLOCKS:
        mean_error = deviation_error = found[:, 1] = np.inf
    return mean, mean_error, deviation, deviation_error, *found.T, none, none_error


def mean_of_blocks(values: np.ndarray, weights: np.ndarray) -> tuple[float, float]:
    """Compute the weighted mean of values, and its standard error.

    The values have a row for each block of samples; the error follows from the scatter of the blocks' means.
    """
    total = weights.sum()
    mean = float((weights * values).sum() / total)
    parts = (weights * (values - mean)).sum(axis=1) * (len(values) / total)
    return mean, float(parts.std(ddof=1) / np.sqrt(len(values)))


def _percentile(values: np.ndarray, known: np.ndarray, share: float) -> tuple[float, float]:
    """Compute a percentile (the result below which a given fraction lies), and its standard error.

    The error is the change of the percentile if the fraction is changed by its own error.  That error has two
    parts, added as squares: the standard error from the scatter between blocks, and half the fraction of
    one sample.
    """
    ordered = values[known]
    found = float(np.quantile(ordered, share))
    _, below = mean_of_blocks(values <= found, known)
    below = np.hypot(below, 0.5 / len(ordered))
    near = np.quantile(ordered, np.clip([share - below, share + below], 0.0, 1.0))
    return found, float(np.abs(near - found).max())


# Sobol' indices -----------------------------------------------------------------------------------


@dataclass(frozen=True)
class SobolIndices:
    """Fractions of the variance of k results that are due to each of d inputs.

    Parameters
    ----------
    first, total : ndarray, shape (d, k)
        First-order indices (effect of the input alone) and total indices (including interactions with other
        inputs); nan if a design lacks the result, or the result varies by no more than its numerical error.
    first_error, total_error : ndarray, shape (d, k)
        Standard errors of the indices.

    References
    ----------
    Saltelli et al. (2010), Computer Physics Communications 181, 259.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> tolerances = {"beam.thickness": "+-2%", "beam.density": "+-1%"}
    >>> found = bd.spread(bd.Scene(strip), tolerances, modes=1, samples=128)
    >>> bool(found.indices.total[0, 0] > found.indices.total[1, 0])
    True
    """

    first: np.ndarray
    total: np.ndarray
    first_error: np.ndarray
    total_error: np.ndarray


def indices_of(random: np.ndarray, error: np.ndarray | float = 0.0) -> SobolIndices:
    """Compute Sobol' indices by the estimators of `scipy.stats.sobol_indices`, with errors from blocks.

    Parameters
    ----------
    random : ndarray, shape (2 + d, samples, k)
        Results of the samples A, B, and A with each input in turn from B.
    error : ndarray, shape (k,)
        Largest absolute error of each result.
    """
    d, k = len(random) - 2, random.shape[2]
    found = np.full((2, d, k), np.nan)
    wrong = np.full((2, d, k), np.inf)
    with np.errstate(invalid="ignore"):
        scale = np.abs(random).max(axis=(0, 1))
        varied = random[:2].std(axis=(0, 1)) > np.maximum(_ROUNDING * scale, error)
    sure = np.isfinite(random).all(axis=(0, 1)) & varied
    if not sure.any():
        return SobolIndices(*found, *wrong)
    known = random[..., sure] / scale[sure]
    known = known - known[:2].mean(axis=(0, 1))
    found[..., sure] = _indices(known)
    wrong[..., sure] = _errors_of_indices(known, found[..., sure])
    return SobolIndices(*found, *wrong)


def _indices(random: np.ndarray) -> np.ndarray:
    """Compute first-order and total Sobol' indices of d inputs for k results, shape (2, d, k)."""
    from scipy.stats import sobol_indices  # imported here, because the import takes long

    d, n, k = len(random) - 2, random.shape[1], random.shape[2]
    if d == 1:
        return np.ones((2, 1, k))  # a single input causes the whole variance
    a, b, *mixed = np.moveaxis(random, -1, 1)
    found = sobol_indices(func={"f_A": a, "f_B": b, "f_AB": np.array(mixed)}, n=n)
    shapes = (np.reshape(order, (k, d)).T for order in (found.first_order, found.total_order))
    return np.stack([*shapes])


def _errors_of_indices(random: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """Compute standard errors of Sobol' indices, which are ratios of two means, by linearization.

    As in `scipy.stats.sobol_indices`, the numerators are the means of f_B (f_AB - f_A) and (f_A - f_AB)^2 /
    2, where f is a result minus its mean; the denominator is the variance.
    """
    if len(random) == 3:
        return np.zeros(indices.shape)
    blocks = random.reshape(len(random), BLOCKS, -1, random.shape[2])
    a, b, mixed = blocks[0], blocks[1], blocks[2:]
    variance = (a**2 + b**2).mean(axis=1) / 2
    parts = np.stack([b * (mixed - a), (a - mixed) ** 2 / 2]).mean(axis=3)
    linear = parts - indices[:, :, None] * variance
    return linear.std(axis=2, ddof=1) / variance.mean(axis=0) / np.sqrt(BLOCKS)
