"""Designs of a spread: random ones for its statistics, the nominal one, and those about it for slopes.

Of random designs there are two samples A and B (n each), and for each input one with the values of A but for
that input, whose values are those of B (Saltelli et al., Computer Physics Communications 181 (2010) 259).
Both are points of scrambled Sobol' sequences, `BLOCKS` of them, each scrambled by itself: what they differ by
says how far a statistic may be from the truth.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from inspect import signature
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, count
from beamdyn.common.spreading.tolerances import SpreadInput

BLOCKS = 16
LEAST, MOST = 128, 2**17  # samples: below, blocks are too small to say how far off they are
MOST_SEED = 2**63
_STEP = 1 / 8  # of the way to an end, for slopes: far above rounding, and near enough to be straight
_ONE_SIDED, _BOTH_SIDES = np.array([0.25, 0.5, 0.75, 1.0]), np.array([-1.0, -0.5, 0.5, 1.0])


def check_samples(samples: object) -> tuple[int, list[str]]:
    """The number of samples that is used, a power of two, and a warning where it is not the one given."""
    given = count("samples", samples, LEAST, MOST)
    used = 1 << (given - 1).bit_length()
    said = [f"samples = {given}: {used}, the next power of two, are used"] if used != given else []
    return used, said


def count_designs(inputs: int, samples: int) -> int:
    """Number of designs that are answered at first, of d inputs."""
    return 1 + 4 * inputs + (2 + inputs) * samples


def check_seed(seed: object) -> int:
    """A whole number from which the samples follow."""
    return count("seed", seed, 0, MOST_SEED)


@dataclass(frozen=True)
class SpreadDesigns:
    """All designs whose answers are wanted at first: the nominal one, those for slopes, and random ones.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The d inputs.
    samples : int
        Number n of designs of each random sample.
    seed : int
        What the samples follow from.
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
        """The designs, shape (1 + 4 d + (d + 2) n, d): nominal, for slopes, A, B, and A with inputs of B."""
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
        """Distances from the nominal values at which answers are wanted for slopes, shape (d, 4).

        They go an eighth of the way to both ends of each tolerance; where the nominal value is one of these,
        to the other.
        """
        return np.array([_steps(each) for each in self.inputs])

    @property
    def _beside(self) -> np.ndarray:
        """Designs of which one input is off its nominal value, shape (4 d, d)."""
        beside = np.tile(self.nominal, (self.count, 4, 1))
        each = np.arange(self.count)
        beside[each, :, each] += self.steps
        return beside.reshape(-1, self.count)

    @cached_property
    def _random(self) -> np.ndarray:
        """The samples A and B, shape (2, n, d)."""
        blocks = np.random.SeedSequence(self.seed).spawn(BLOCKS)
        shares = np.stack([_sobol_points(2 * self.count, self.samples // BLOCKS, each) for each in blocks])
        shares = shares.reshape(self.samples, 2, self.count).transpose(1, 0, 2)
        return np.stack([each.distribution.at(shares[..., i]) for i, each in enumerate(self.inputs)], axis=-1)

    def part(self, answers: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Answers (N, k) of the designs by their part.

        Returns
        -------
        nominal : ndarray, shape (k,)
        beside : ndarray, shape (d, 4, k)
        random : ndarray, shape (2 + d, n, k)
            Of A, of B, and of A with each input of B.
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
    """Points of a scrambled Sobol' sequence, shape (rows, columns), none of which is 0 or 1."""
    from scipy.stats import qmc  # it takes long to load

    seed_name = "rng" if "rng" in signature(qmc.Sobol).parameters else "seed"  # before scipy 1.15
    if columns > qmc.Sobol.MAXDIM:
        raise InvalidValue("spread", columns // 2, f"at most {qmc.Sobol.MAXDIM // 2} inputs have a spread")
    random: dict[str, Any] = {seed_name: np.random.default_rng(seed)}
    points = qmc.Sobol(columns, **random).random(rows)
    return np.clip(points, 2.0**-40, 1 - 2.0**-40)
