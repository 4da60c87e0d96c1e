"""Statistics of the answers of random designs, with their standard errors.

Samples come in blocks whose points were scrambled independently, so that the scatter over blocks says how far
a mean is from the truth: it needs no assumption on the answers, and includes what the even distribution of
the points gains.  A statistic is a mean or a ratio of means over blocks, its error that of its linear part.

Designs of a spread: random ones for its statistics, the nominal one, and those about it for slopes.

Of random designs there are two samples A and B (n each), and for each input one with the values of A but for
that input, whose values are those of B (Saltelli et al., Computer Physics Communications 181 (2010) 259).
A and B are points of `BLOCKS` Sobol' sequences, each scrambled by itself: the scatter over these blocks says
how far a statistic may be from the truth.
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
LEAST, MOST = 128, 2**17  # least and most samples: with fewer, blocks are too small to estimate errors
MOST_SEED = 2**63
# Largest step for slopes, over the way to an end of the tolerance: so large that rounding does not matter, so
# small that answers are nearly linear.
_STEP = 1 / 8
_ONE_SIDED, _BOTH_SIDES = np.array([0.25, 0.5, 0.75, 1.0]), np.array([-1.0, -0.5, 0.5, 1.0])


def check_samples(samples: object) -> tuple[int, list[str]]:
    """Return the number of samples to use, a power of two, with a warning if another was given."""
    given = count("samples", samples, LEAST, MOST)
    used = 1 << (given - 1).bit_length()
    said = [f"samples = {given}: {used}, the next power of two, are used"] if used != given else []
    return used, said


def count_designs(inputs: int, samples: int) -> int:
    """Compute the number of designs that are answered at first, for d inputs."""
    return 1 + 4 * inputs + (2 + inputs) * samples


def check_seed(seed: object) -> int:
    """Return the seed of the samples; refuse anything but a whole number from 0."""
    return count("seed", seed, 0, MOST_SEED)


@dataclass(frozen=True)
class SpreadDesigns:
    """All designs that are answered at first: the nominal one, those for slopes, and random ones.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The d inputs.
    samples : int
        Number n of designs of each random sample.
    seed : int
        Seed from which the samples follow.
    """

    inputs: Sequence[SpreadInput]
    samples: int
    seed: int

    @property
    def count(self) -> int:
        """Number of inputs d."""
        return len(self.inputs)

    @cached_property
    def table(self) -> np.ndarray:
        """All designs, one in each row, (1 + 4 d + (d + 2) n, d), with d inputs and n samples.

        They are the nominal one, those for slopes, two random samples A and B, and A with each input in turn
        from B.
        """
        first, second = self._random
        mixed = np.tile(first, (self.count, 1, 1))
        each = np.arange(self.count)
        mixed[each, :, each] = second.T
        return np.vstack([self.nominal, self._beside, first, second, mixed.reshape(-1, self.count)])

    @property
    def nominal(self) -> np.ndarray:
        """The nominal design, shape (d,)."""
        return np.array([each.nominal for each in self.inputs])

    @cached_property
    def steps(self) -> np.ndarray:
        """Distances from the nominal values of the designs for slopes, shape (d, 4).

        The largest go an eighth of the way to either end of the tolerance; where the nominal value is an end,
        all go towards the other.
        """
        return np.array([_steps(each) for each in self.inputs])

    @property
    def _beside(self) -> np.ndarray:
        """Designs with one input off its nominal value, shape (4 d, d)."""
        beside = np.tile(self.nominal, (self.count, 4, 1))
        each = np.arange(self.count)
        beside[each, :, each] += self.steps
        return beside.reshape(-1, self.count)

    @cached_property
    def _random(self) -> np.ndarray:
        """Random samples A and B, shape (2, n, d)."""
        blocks = np.random.SeedSequence(self.seed).spawn(BLOCKS)
        shares = np.stack([_sobol_points(2 * self.count, self.samples // BLOCKS, each) for each in blocks])
        shares = shares.reshape(self.samples, 2, self.count).transpose(1, 0, 2)
        return np.stack([each.distribution.at(shares[..., i]) for i, each in enumerate(self.inputs)], axis=-1)

    def part(self, answers: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Split the answers (N, k) of the designs into those of nominal, neighbouring and random designs.

        Returns
        -------
        nominal : ndarray, shape (k,)
        beside : ndarray, shape (d, 4, k)
        random : ndarray, shape (2 + d, n, k)
            Answers of the samples A, of B, and of A with each input of B.
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
    """Draw points of a scrambled Sobol' sequence, shape (rows, columns), none of which is 0 or 1."""
    from scipy.stats import qmc  # imported here, because it takes long to load

    if columns > qmc.Sobol.MAXDIM:
        raise InvalidValue("spread", columns // 2, f"at most {qmc.Sobol.MAXDIM // 2} inputs have a spread")
    return np.clip(seeded(qmc.Sobol, columns, seed).random(rows), 2.0**-40, 1 - 2.0**-40)


def seeded(sequence: Callable[..., QMCEngine], columns: int, seed: np.random.SeedSequence | int) -> QMCEngine:
    """Make a sequence of points of `scipy.stats.qmc`, whose seed had another name before scipy 1.15."""
    name = "rng" if "rng" in signature(sequence).parameters else "seed"
    return sequence(columns, **{name: np.random.default_rng(seed)})


# Statistics of the answers ------------------------------------------------------------------------


PERCENTS = (1.0, 5.0, 50.0, 95.0, 99.0)
_LEAST_BLOCKS = 8  # least number of blocks with answers, whose scatter gives an error
_ROUNDING = 1e-12  # relative scatter of answers below which they count as equal


@dataclass(frozen=True)
class Scatter:
    """Scatter of k answers over the random designs that have them.

    Parameters
    ----------
    mean, mean_error : ndarray, shape (k,)
        Mean [units of the answers], nan where no design has an answer; and its standard error, inf where
        fewer than 8 of the 16 blocks of samples hold answers.
    deviation, deviation_error : ndarray, shape (k,)
        Standard deviation and its standard error, nan and inf as for the mean [same units].
    percentile : ndarray, shape (5, k)
        Answers below which `PERCENTS` of all lie [same units].
    percentile_error : ndarray, shape (5, k)
        Their standard errors [same units]; inf as those of the mean.
    no_answer : ndarray, shape (k,)
        Share of designs without an answer.
    no_answer_error : ndarray, shape (k,)
        Standard error of that share.

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
    """Compute the scatter of answers over random designs.

    Parameters
    ----------
    random : ndarray, shape (2, n, k)
        Answers of the samples A and B; not finite where there is none.
    """
    blocks = _in_blocks(random)
    return Scatter(*(np.stack(each, axis=-1) for each in zip(*map(_scatter_of_one, blocks), strict=True)))


def _in_blocks(random: np.ndarray) -> np.ndarray:
    """Arrange answers by block, shape (k, BLOCKS, 2 n / BLOCKS)."""
    two, n, k = random.shape
    blocks = random.reshape(two, BLOCKS, n // BLOCKS, k)
    return np.moveaxis(blocks, -1, 0).transpose(0, 2, 1, 3).reshape(k, BLOCKS, -1)


def _scatter_of_one(values: np.ndarray) -> tuple[np.ndarray | float, ...]:
    """Compute the fields of `Scatter` for one answer, from values (BLOCKS, m)."""
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
    """Compute the weighted mean of values (BLOCKS, m), and its standard error from the scatter of blocks."""
    total = weights.sum()
    mean = float((weights * values).sum() / total)
    parts = (weights * (values - mean)).sum(axis=1) * (len(values) / total)
    return mean, float(parts.std(ddof=1) / np.sqrt(len(values)))


def _percentile(values: np.ndarray, known: np.ndarray, share: float) -> tuple[float, float]:
    """Compute the answer below which a share of all answers lies, and its standard error.

    From block to block the share below this answer scatters: the error spans the answers at shares that
    differ by this scatter, and by half a sample.
    """
    ordered = values[known]
    found = float(np.quantile(ordered, share))
    _, below = mean_of_blocks(values <= found, known)
    below = np.hypot(below, 0.5 / len(ordered))
    near = np.quantile(ordered, np.clip([share - below, share + below], 0.0, 1.0))
    return found, float(np.abs(near - found).max())


# Indices of Sobol' --------------------------------------------------------------------------------


@dataclass(frozen=True)
class SobolIndices:
    """Shares of the variance of k answers that come from d inputs.

    Parameters
    ----------
    first, total : ndarray, shape (d, k)
        Indices of the first order, by the input alone, and total ones, also by what it does together with
        others; nan where a design has no answer, or the answer scatters by no more than its numerical error.
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
    random : ndarray, shape (2 + d, n, k)
        Answers of A, of B, and of A with each input of B.
    error : ndarray, shape (k,)
        Largest absolute error of each answer.
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
    """Compute indices of first order and total indices, shape (2, d, k)."""
    from scipy.stats import sobol_indices  # imported here, because it takes long to load

    d, n, k = len(random) - 2, random.shape[1], random.shape[2]
    if d == 1:
        return np.ones((2, 1, k))  # a single input has all of the variance
    a, b, *mixed = np.moveaxis(random, -1, 1)
    found = sobol_indices(func={"f_A": a, "f_B": b, "f_AB": np.array(mixed)}, n=n)
    shapes = (np.reshape(order, (k, d)).T for order in (found.first_order, found.total_order))
    return np.stack([*shapes])


def _errors_of_indices(random: np.ndarray, indices: np.ndarray) -> np.ndarray:
    """Compute standard errors (2, d, k) of indices, as quotients of two means whose linear part scatters.

    The means are those of `scipy.stats.sobol_indices`, of answers about their mean: f_B (f_AB - f_A) and
    (f_A - f_AB)^2 / 2, over the variance.
    """
    if len(random) == 3:
        return np.zeros(indices.shape)
    blocks = random.reshape(len(random), BLOCKS, -1, random.shape[2])
    a, b, mixed = blocks[0], blocks[1], blocks[2:]
    variance = (a**2 + b**2).mean(axis=1) / 2
    parts = np.stack([b * (mixed - a), (a - mixed) ** 2 / 2]).mean(axis=3)
    linear = parts - indices[:, :, None] * variance
    return linear.std(axis=2, ddof=1) / variance.mean(axis=0) / np.sqrt(BLOCKS)
