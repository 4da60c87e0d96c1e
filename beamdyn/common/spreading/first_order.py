"""Ranges to first order: what the slopes at the nominal design make of the tolerances."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamdyn.common.spreading.slopes import Slopes
from beamdyn.common.spreading.tolerances import SpreadInput


@dataclass(frozen=True)
class FirstOrderRange:
    """Ranges of k answers to first order in d inputs; nan where a slope is missing.

    Parameters
    ----------
    smallest, largest : ndarray, shape (k,)
        With each input at that end of its tolerance which makes them so [units of the answers].
    mean, deviation : ndarray, shape (k,)
        Mean and standard deviation [units of the answers].
    error : ndarray, shape (k,)
        What the errors of the slopes make at most of these four [units of the answers].
    share : ndarray, shape (d, k)
        Share of each input in the variance.
    slope, slope_error : ndarray, shape (d, k)
        Derivatives and their absolute errors [unit / unit of the input].
    exact : ndarray of bool, shape (d, k)
        Which slopes are derivatives of the equations; others are those of polynomials through designs.

    References
    ----------
    Standard: propagation of tolerances by slopes.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.spread(bd.Scene(strip), {"beam.thickness": "+-2%"}, modes=1, samples=128)
    >>> round(float(found.first_order.largest[0] / found.nominal[0]), 6)
    1.02
    """

    smallest: np.ndarray
    largest: np.ndarray
    mean: np.ndarray
    deviation: np.ndarray
    error: np.ndarray
    share: np.ndarray
    slope: np.ndarray
    slope_error: np.ndarray
    exact: np.ndarray


def first_order_of(inputs: Sequence[SpreadInput], nominal: np.ndarray, slopes: Slopes) -> FirstOrderRange:
    """Ranges to first order.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The inputs.
    nominal : ndarray, shape (k,)
        Answers of the nominal design.
    slopes : Slopes
        Derivatives there.
    """
    at = np.array([each.nominal for each in inputs])
    low, high = (np.array([each.distribution.ends for each in inputs]) - at[:, None]).T[..., None]
    mean = np.array([each.distribution.mean for each in inputs]) - at
    parts = slopes.value * np.array([each.distribution.deviation for each in inputs])[:, None]
    with np.errstate(invalid="ignore"):
        changes = slopes.value * low, slopes.value * high
        error = (slopes.error * np.maximum(-low, high)).sum(axis=0)
        variance = (parts**2).sum(axis=0)
        share = np.divide(parts**2, variance, out=np.full(parts.shape, np.nan), where=variance > 0)
    return FirstOrderRange(
        smallest=nominal + np.minimum(*changes).sum(axis=0),
        largest=nominal + np.maximum(*changes).sum(axis=0),
        mean=nominal + mean @ slopes.value,
        deviation=np.sqrt(variance),
        error=error,
        share=share,
        slope=slopes.value,
        slope_error=slopes.error,
        exact=slopes.exact,
    )
