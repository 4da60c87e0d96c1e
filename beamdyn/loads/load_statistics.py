"""Statistics of loads along the span under a random input: mean squares, rates and the largest expected.

A stationary Gaussian process with the mean squares s^2 of its values and r^2 of their rates passes its mean
upwards nu = r / (2 pi s) times a second (Rice).  Of N = 2 nu T passages in the duration T, of both signs and
taken as independent, the largest is

    s (sqrt(2 ln N) + 0.5772 / sqrt(2 ln N))

on the average (Davenport (1964), Proceedings of the Institution of Civil Engineers 28, 187-196), and with the
probability p none passes s sqrt(2 ln(N / -ln p)).
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.linear.convergence import Refined, evaluate_accurately, model_of_few_modes
from beamdyn.linear.inputs_outputs import Excitation
from beamdyn.linear.model_at_speed import ModelAtSpeed
from beamdyn.linear.spectra import PowerSpectrum, highest_frequency
from beamdyn.linear.transfer import check_stable
from beamdyn.loads.load_fractions import LinearLoads, LoadFractions, largest_in_turn
from beamdyn.loads.stations import SpanStations, StationOutputs
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.scene.scene import Scene

_FIRST_MODES = 4  # modes of a model that tells the sizes of the outputs
_OF_RATES = 1e3  # tolerance of rates over that of the others: peak factors follow their logarithm
_LEAST = math.e  # crossings that the formula is evaluated with, at least
_TURN = 2 * np.pi


@dataclass(frozen=True)
class RandomStatistics:
    """Statistics of K outputs at S stations; the components of all quantities stand one after the other.

    Parameters
    ----------
    mean : ndarray, shape (S, K)
        Constant part, by the steady rotation [unit of the output].
    gravity : ndarray, shape (S, K)
        Amplitude of what gravity makes of it within a turn [same unit].
    rms : ndarray, shape (S, K)
        Root mean square of the random part, over time and over a turn [same unit].
    rms_in_turn : ndarray, shape (S, K)
        That at the angle of rotation at which it is largest [same unit].
    rate_rms : ndarray, shape (S, K)
        Root mean square of its rate [same unit / s].

    References
    ----------
    Rice (1944), Mathematical analysis of random noise; Davenport (1964), Proceedings of the Institution of
    Civil Engineers 28, 187-196.

    Examples
    --------
    >>> scene = bd.load_scene("examples/harvester_on_road.toml")
    >>> found = bd.random_loads(scene, 83.3, bd.RoadRoughness("C", highest=10.0), at=[0.0])
    >>> type(found.statistics).__name__
    'RandomStatistics'
    """

    mean: np.ndarray
    gravity: np.ndarray
    rms: np.ndarray
    rms_in_turn: np.ndarray
    rate_rms: np.ndarray

    @property
    def crossings(self) -> np.ndarray:
        """How often a second the random part passes 0 upwards [1/s], shape (S, K); 0 where there is none."""
        moving = self.rms > 0
        return np.where(moving, self.rate_rms, 0.0) / (_TURN * np.where(moving, self.rms, 1.0))

    def largest(self, factor: Callable[[np.ndarray], np.ndarray], duration: float) -> np.ndarray:
        """Largest magnitude (S, K), with a peak factor by the number of crossings of both signs."""
        count = np.maximum(2 * self.crossings * duration, _LEAST)
        return np.abs(self.mean) + self.gravity + factor(count) * self.rms_in_turn


def expected_factor(count: np.ndarray) -> np.ndarray:
    """Mean of the largest of so many crossings, over the root mean square."""
    root = np.sqrt(2 * np.log(count))
    return root + np.euler_gamma / root


def safe_factor(count: np.ndarray, probability: float) -> np.ndarray:
    """Quantile of the largest of so many crossings, with a probability, over the root mean square."""
    return np.sqrt(2 * np.log(np.maximum(count / -math.log(probability), 1.0)))


@dataclass(frozen=True)
class InputAndOutputs:
    """A random input, and the outputs along the span whose statistics are asked for."""

    drive: Excitation
    spectrum: PowerSpectrum
    stations: SpanStations
    outputs: StationOutputs

    def fractions(self, model: ModelAtSpeed) -> tuple[LoadFractions, ...]:
        """Transfer functions from the input to the outputs, one for each harmonic of the rotation."""
        return LinearLoads(model, self.stations, self.outputs).fractions(self.drive)

    def statistics(self, model: ModelAtSpeed) -> np.ndarray:
        """The fields of `RandomStatistics`, in their order: shape (5, S, K)."""
        check_stable(model)
        fractions, spectrum = self.fractions(model), self.spectrum
        mean, gravity = LinearLoads(model, self.stations, self.outputs).steady()
        squares = [sum(each.mean_square(spectrum, order) for each in fractions) for order in (0, 2)]
        most = largest_in_turn(fractions, spectrum)
        rms, rate, in_turn = (np.sqrt(np.maximum(square, 0.0)) for square in (*squares, most))  # of rounding
        return np.stack([mean, gravity, rms, in_turn, rate])

    def refine(
        self,
        loaded: Scene,
        speed: float,
        modes: int | str,
        tolerance: float,
        discretization: DiscretizationChoice,
    ) -> Refined:
        """`statistics` and their errors, nan where there is none, with as many modes as they need."""
        few = self.statistics(model_of_few_modes(loaded, speed, _FIRST_MODES, discretization))
        size = np.nan_to_num(np.abs(few)).max(axis=1, keepdims=True)  # along the span: (5, 1, K)
        size = np.where(size > 0, size, 1.0) * np.array([1, 1, 1, 1, _OF_RATES])[:, None, None]

        def relative(model: ModelAtSpeed) -> np.ndarray:
            return np.nan_to_num(self.statistics(model)) / size

        top = _TURN * highest_frequency(self.spectrum) + abs(speed)
        refined = evaluate_accurately(loaded, speed, top, modes, tolerance, discretization, relative, 0)
        size = size * np.where(np.isnan(few), np.nan, 1.0)
        value = refined.value * size
        rounding = _rounding(self.fractions(refined.model), RandomStatistics(*value), self.spectrum)
        return replace(refined, value=value, error=refined.error * size + rounding)


def _rounding(
    fractions: Sequence[LoadFractions], found: RandomStatistics, spectrum: PowerSpectrum
) -> np.ndarray:
    """Rounding errors of the fields of `RandomStatistics`, in their order: shape (5, S, K)."""
    value, rate = (sum(each.rounding(spectrum, order) for each in fractions) for order in (0, 2))
    pairs = (found.rms, value), (found.rms_in_turn, 2 * value), (found.rate_rms, rate)
    none = np.zeros_like(found.mean)
    return np.stack([none, none, *(np.hypot(rms, np.sqrt(square)) - rms for rms, square in pairs)])


def error_of_largest(found: RandomStatistics, error: RandomStatistics, duration: float) -> np.ndarray:
    """Errors (S, K) of the largest expected: how far it rises with the errors of all statistics."""
    total = found.rms + error.rms
    with np.errstate(invalid="ignore"):
        less = np.where(np.isfinite(total) & (total > 0), found.rms**2 / np.where(total > 0, total, 1.0), 0.0)
    raised = RandomStatistics(
        np.abs(found.mean) + error.mean,
        found.gravity + error.gravity,
        less,
        found.rms_in_turn + error.rms_in_turn,
        found.rate_rms + error.rate_rms,
    )
    return raised.largest(expected_factor, duration) - found.largest(expected_factor, duration)
