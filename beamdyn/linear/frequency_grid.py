"""Frequencies of the density of a random response: straight lines between its values have its area.

They are dense where the density of the input is steep, and about each resonance, down to its bandwidth.  An
input that does not turn with the beam appears shifted by the speed.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from beamdyn.linear.spectra import PowerSpectrum, SpectrumPiece

_TURN = 2 * np.pi
_STEP = 0.02  # relative distance of frequencies of the input
_STEEPEST = 0.1  # logarithm of the ratio of densities of the input at two of them
_DECADES = 3  # that a piece which begins at 0 is listed downwards
_CLOSE = 0.2  # distance of two frequencies near a resonance, over that from it or its bandwidth
_REACH = 30.0  # half bandwidths about a resonance that are dense, beside its frequency
_BESIDE = 1e-6  # relative distance of a frequency outside of an input to its end, where the density falls
_SAME = 1e-13  # relative distance of two frequencies that are one


def frequencies_of_response(
    spectrum: PowerSpectrum, poles: np.ndarray, shifts: Sequence[float]
) -> np.ndarray:
    """Frequencies at which an input has a response [Hz], ascending.

    Parameters
    ----------
    spectrum : PowerSpectrum
        The density of the input.
    poles : ndarray of complex
        Poles of the response [1/s], all of them damped.
    shifts : sequence of float
        How far the response is from the input [Hz].

    Returns
    -------
    ndarray
    """
    of_input = np.concatenate([_frequencies_of(piece) for piece in spectrum.pieces()])
    ends = np.array([of_input[0] * (1 - _BESIDE), of_input[-1] * (1 + _BESIDE)])
    excited, beside = (_shifted(f, shifts) for f in (of_input, ends))
    about = np.concatenate([beside, about_resonances(poles)])
    inside = (about > excited.min()) & (about < excited.max())
    return one_of_each(np.concatenate([excited, about[inside]]))


def _frequencies_of(piece: SpectrumPiece) -> np.ndarray:
    """Frequencies of a part of the input [Hz], at equal ratios."""
    start = piece.start or piece.end / 10**_DECADES
    steps = math.log(piece.end / start) * max(1 / _STEP, abs(piece.power) / _STEEPEST)
    between = np.geomspace(start, piece.end, math.ceil(steps) + 1)[1:-1]
    return np.concatenate([[piece.start], between, [piece.end]])


def _shifted(f: np.ndarray, shifts: Sequence[float]) -> np.ndarray:
    """Frequencies of the response to those of the input, of either sign [Hz]."""
    return np.concatenate([np.abs(shift + each) for shift in shifts for each in (f, -f)])


def about_resonances(poles: np.ndarray) -> np.ndarray:
    """Frequencies dense about those of poles, from 0 on [Hz], in no order."""
    each = [_about(float(pole.imag), -float(pole.real)) for pole in poles / _TURN if pole.imag >= 0]
    f = np.concatenate([*each, np.empty(0)])
    return f[f >= 0]


def _about(centre: float, half_width: float) -> np.ndarray:
    """Frequencies about one: at a distance the steps are in proportion to it."""
    reach = np.arcsinh(_REACH + centre / half_width)
    side = half_width * np.sinh(np.linspace(0.0, reach, math.ceil(reach / _CLOSE) + 1))
    return np.concatenate([centre - side[:0:-1], centre + side])


def one_of_each(f: np.ndarray) -> np.ndarray:
    """The frequencies, ascending, without those that differ by rounding."""
    f = np.unique(f)
    return f[np.diff(f, prepend=-1.0) > _SAME * f]
