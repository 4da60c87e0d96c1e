"""Resonance peaks of a frequency response, found between grid points: frequency, height and width.

A transfer function's magnitude, from a sum over poles, is extreme where the derivative of its square is 0.
The derivative is sampled in steps of a fraction of the distance to the nearest pole, and each sign change is
bisected: every maximum and every minimum, whether or not it lies at a natural frequency.  From a peak to the
minima on its sides the magnitude falls steadily, so that there is one half-power frequency on either side, or
none.

In shapes of arrays, F counts frequencies, and p peaks.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from beamdyn.accuracy.refinement import LINEAR_MESHES, LINEAR_MODES
from beamdyn.linear.inputs_outputs import Excitation, Observation
from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.transfer import ModalSum, modal_sums, respond

_TURN = 2 * np.pi
_DENSE = 0.1  # distance between samples, divided by the distance to the nearest pole
_HALVINGS = 60  # number of halvings after which an interval is as short as rounding errors
_UNDAMPED = 1e-10  # largest damping ratio that is 0 within rounding
_ROUNDING = 1e-9  # relative accuracy of frequency, magnitude and bandwidth of a peak
_SHARE = 0.1  # accuracy of a peak's values, as a fraction of the tolerance
# Height of a peak above the neighbouring minima, divided by its magnitude, below which it is a rounding
# error.
_LEVEL = 1e-10
# Relative difference between the sum over modes and the solution of the equations, above which the response
# is only rounding error.
_NOISE = 0.5
_STEP = 1e-6  # relative distance from an undamped natural frequency at which its pole is sought


class Peak(NamedTuple):
    """Resonance peak: frequency and bandwidth [Hz], magnitude, harmonic of the rotation, rounding error."""

    frequency: float
    size: float
    bandwidth: float
    harmonic: int
    rounding: float


@dataclass(frozen=True)
class ResonancePeaks:
    """Peaks of a response between its lowest and its highest frequency, by ascending frequency.

    The peaks are all local maxima of each harmonic's magnitude: a mode in the flank of a higher neighbour
    without a maximum of its own has none.  Two minima closer to each other than a tenth of their distance to
    the nearest pole may be taken for one, and a peak between them may be missed.

    Parameters
    ----------
    frequency : ndarray, shape (p,)
        Frequencies of the excitation at which the response is largest [Hz].
    size : ndarray, shape (p,)
        Magnitudes of the response at these frequencies; inf without damping.
    bandwidth : ndarray, shape (p,)
        Half-power bandwidths [Hz]: distance between the frequencies on both sides at which the magnitude has
        fallen to 1/sqrt(2) of the peak's.  They are nan if, on a side, the magnitude rises again before it
        has fallen so far, towards a close peak, or if it does not fall so far from 0 to twice the highest
        frequency.
    harmonic : ndarray of int, shape (p,)
        Harmonics of the rotation in the response.
    frequency_error, size_error, bandwidth_error : ndarray, shape (p,)
        Estimated errors: the distance from the nearest peak of a model with a coarser discretization and,
        where modes are left out, of a model with more modes.  They are inf if such a model has no peak, or
        its peak no bandwidth.  The error of an infinite magnitude, or of a bandwidth that is nan, is nan.
    """

    frequency: np.ndarray
    size: np.ndarray
    bandwidth: np.ndarray
    harmonic: np.ndarray
    frequency_error: np.ndarray
    size_error: np.ndarray
    bandwidth_error: np.ndarray

    def __len__(self) -> int:
        return len(self.frequency)


def find_peaks(
    model: ModelAtSpeed,
    larger: ModelAtSpeed | None,
    drive: Excitation,
    seen: Observation,
    band: tuple[float, float],
    tolerance: float = 0.0,
) -> ResonancePeaks:
    """Find the peaks of a response within a band of frequencies of the excitation [Hz].

    Parameters
    ----------
    model : ModelAtSpeed
        The model.
    larger : ModelAtSpeed or None
        Model with more modes; None if there is none, or `model` keeps all functions.
    drive, seen : Excitation, Observation
        Input and output.
    band : tuple of float
        Lowest and highest frequency [Hz].
    tolerance : float
        Target of the errors of a peak: of its magnitude relative to the magnitude, of its frequency and
        bandwidth relative to the bandwidth.  With 0, they are computed to within rounding.
    """
    share = max(_SHARE * tolerance, _ROUNDING)
    # Highest frequency at which the response is sampled, as flanks of peaks reach beyond the band.
    top = 2 * band[1] + abs(model.speed) / _TURN
    found = sorted(
        peak for peak in _peaks(model, drive, seen, top, share) if band[0] < peak.frequency < band[1]
    )
    compared = list[tuple[float, list[Peak]]]()
    if found:
        coarse = ModelAtSpeed(model.model.coarser, model.speed, model.modes)
        compared.append((LINEAR_MESHES.factor, [*_peaks(coarse, drive, seen, top, share)]))
    if found and model.modes is not None:
        compared.append((LINEAR_MODES.factor, [*_peaks(larger, drive, seen, top, share)] if larger else []))
    errors = np.reshape([_error(each, compared, share) for each in found], (-1, 3))
    columns = [np.array(column) for column in zip(*found, strict=True)] or [np.zeros(0)] * 5
    frequency, size, bandwidth, harmonic, _ = columns
    return ResonancePeaks(frequency, size, bandwidth, harmonic.astype(int), *errors.T)


def _error(peak: Peak, compared: list[tuple[float, list[Peak]]], share: float) -> np.ndarray:
    """Estimate errors (3,) of frequency, magnitude and bandwidth from the nearest peaks of other models.

    `compared` contains a margin and the peaks of each model, `share` the relative accuracy of all peaks.
    """
    own = np.array(peak[:3])
    with np.errstate(invalid="ignore"):  # the difference of infinite magnitudes is nan
        # The frequency's rounding error is relative to the bandwidth, or to the frequency if that is unknown.
        width = np.nan_to_num(peak.bandwidth, nan=peak.frequency)
        sizes = np.array([width, peak.size, peak.bandwidth])
        error = _ROUNDING * own + (peak.rounding + np.array([share, share**2, share])) * sizes
        for margin, others in compared:
            same = (each for each in others if each.harmonic == peak.harmonic)
            near = min(same, key=lambda each: abs(each.frequency - peak.frequency), default=[np.inf] * 3)
            error += margin * np.nan_to_num(np.abs(np.array(near[:3]) - own), nan=np.inf, posinf=np.inf)
    return np.where(np.isfinite(own), error, np.nan)


def _peaks(
    model: ModelAtSpeed, drive: Excitation, seen: Observation, top: float, share: float
) -> Iterator[Peak]:
    """Yield all peaks from 0 to the excitation frequency `top` [Hz], accurate to `share` of their width."""
    drives = model.drives(drive)
    for h, total in modal_sums(model, drives, seen).items():
        magnitude = HarmonicMagnitude(model, drives[h], seen, total, h)
        # Natural frequencies without damping, where the response is infinite.
        at = magnitude.undamped & (magnitude.places > 0) & (magnitude.places < top)
        for pole, place in zip(magnitude.poles[at], magnitude.places[at].tolist(), strict=True):
            step = _STEP * abs(pole) / _TURN
            near, far = np.abs(magnitude.solved(np.array([place + step, place + 2 * step])))
            if near > 1.5 * far > 0:
                yield Peak(place, np.inf, 0.0, magnitude.harmonic, 0.0)
        yield from _damped_peaks(magnitude, top, share)


@dataclass(frozen=True)
class HarmonicMagnitude:
    """Magnitude of the response at one harmonic of the rotation, over excitation frequency [Hz].

    Parameters
    ----------
    model, drive, seen : ModelAtSpeed, HarmonicDrive, Observation
        Model, input and output.
    total : ModalSum
        Transfer function of model, input and output.
    harmonic : int
        Harmonic of the rotation.
    """

    model: ModelAtSpeed
    drive: HarmonicDrive
    seen: Observation
    total: ModalSum
    harmonic: int

    @property
    def shift(self) -> float:
        """Response frequency minus excitation frequency [Hz]."""
        return self.harmonic * self.model.speed / _TURN

    @cached_property
    def poles(self) -> np.ndarray:
        """Poles [1/s] that may cause peaks; for other harmonics than 0 also those of negative frequency."""
        poles = self.total.poles
        return poles if self.harmonic else poles[np.imag(poles) >= 0]

    @cached_property
    def places(self) -> np.ndarray:
        """Excitation frequencies [Hz] at which the response frequency is that of a pole."""
        return np.imag(self.poles) / _TURN - self.shift

    @cached_property
    def undamped(self) -> np.ndarray:
        """Whether each of the poles is undamped within rounding."""
        return -np.real(self.poles) <= _UNDAMPED * np.abs(self.poles)

    def size(self, f: np.ndarray) -> np.ndarray:
        """Compute the magnitudes at excitation frequencies f [Hz]."""
        return np.abs(self.total(self._s(f))[0])

    def rises(self, f: np.ndarray) -> np.ndarray:
        """Return whether the magnitude increases with frequency at excitation frequencies f [Hz]."""
        value, slope = self.total(self._s(f))
        return np.real(np.conj(value) * 1j * slope) > 0

    def solved(self, f: np.ndarray) -> np.ndarray:
        """Compute the complex response at excitation frequencies f [Hz] from the equations of motion."""
        return respond(self.model, self.drive, self.seen, self._s(f))

    def rounding(self, f: np.ndarray) -> np.ndarray:
        """Compute the relative difference between sum over poles and solution of the equations at f [Hz]."""
        value = self.solved(f)
        distance = np.abs(self.total(self._s(f))[0] - value)
        return np.divide(distance, np.abs(value), out=np.full(len(f), np.inf), where=value != 0)

    def samples(self, top: float) -> np.ndarray:
        """Return frequencies from 0 to `top` [Hz], in steps proportional to the nearest pole's distance."""
        order = np.argsort(self.places)
        places = self.places[order]
        halves = np.maximum(-np.real(self.poles), _UNDAMPED * np.abs(self.poles))[order] / _TURN
        ends = [min(0.0, places[0]), *(places[1:] + places[:-1]) / 2, max(top, places[-1])]
        each = [np.array([0.0, top])]
        for place, half, low, high in zip(places, halves, ends[:-1], ends[1:], strict=True):
            first, last = np.ceil(np.arcsinh((np.array([low, high]) - place) / half) / _DENSE - 0.5)
            each.append(place + half * np.sinh((np.arange(first, last) + 0.5) * _DENSE))
        f = np.unique(np.concatenate(each))
        return f[(f >= 0) & (f <= top)]

    def _s(self, f: np.ndarray) -> np.ndarray:
        return 1j * _TURN * (f + self.shift)


def _damped_peaks(magnitude: HarmonicMagnitude, top: float, share: float) -> Iterator[Peak]:
    """Yield the maxima of a finite magnitude as peaks, with their half-power bandwidths."""
    f = magnitude.samples(top)
    rises = magnitude.rises(f)
    turns = np.flatnonzero(rises[1:] != rises[:-1])
    singular = magnitude.places[magnitude.undamped]
    turns = turns[~((f[turns, None] < singular) & (singular < f[turns + 1, None])).any(axis=1)]
    rises_before = rises[turns]
    low, high = f[turns], f[turns + 1]
    at = _bisect(lambda x: magnitude.rises(x) == rises_before, low, high, 2 * low - high, share)
    limits = np.concatenate([[0.0], at, [top]])
    k = np.flatnonzero(rises_before)
    if not k.size:
        return
    tops, sides = at[k], np.array([limits[k], limits[k + 2]])
    size, beside = magnitude.size(tops), magnitude.size(sides.ravel()).reshape(2, -1)
    rounding = magnitude.rounding(tops)
    # Half-power widths [Hz] of p peaks; nan where a neighbouring minimum is above half power.
    level = np.tile(size / np.sqrt(2), 2)
    twice = np.tile(tops, 2)
    ends = _bisect(lambda f: magnitude.size(f) > level, twice, sides.ravel(), twice, share).reshape(2, -1)
    width = np.where((beside < size / np.sqrt(2)).all(axis=0), ends[1] - ends[0], np.nan)
    real = (size > (1 + _LEVEL) * beside.max(axis=0)) & (rounding < _NOISE)
    for j in np.flatnonzero(real).tolist():
        yield Peak(float(tops[j]), float(size[j]), float(width[j]), magnitude.harmonic, float(rounding[j]))


def _bisect(
    as_at_start: Callable[[np.ndarray], np.ndarray],
    start: np.ndarray,
    end: np.ndarray,
    origin: np.ndarray,
    share: float,
) -> np.ndarray:
    """Find, in each of p intervals, where a condition that holds at the start ceases to hold: shape (p,).

    `as_at_start(x)` returns whether it holds at the positions x (p,).  The intervals are bisected until they
    are shorter than the fraction `share` of their distance from `origin`.
    """
    for _ in range(_HALVINGS):
        if (np.abs(end - start) <= share * np.abs(end - origin)).all():
            break
        middle = (start + end) / 2
        same = as_at_start(middle)
        start, end = np.where(same, middle, start), np.where(same, end, middle)
    return (start + end) / 2
