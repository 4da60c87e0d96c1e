"""First-order ranges of results: tolerances of inputs times derivatives at the nominal design."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np

from beamdyn.common.spreading.tolerances import SpreadInput


@dataclass(frozen=True)
class KnownDerivatives:
    """Derivatives of k results that are computed from equations, not by finite differences.

    Parameters
    ----------
    rows : mapping of int to pair of ndarray, shape (k,)
        For each input, by index: derivatives of the results with respect to it (nan if unknown), and their
        absolute errors.
    warnings : tuple of str
        Reasons why derivatives with respect to the other inputs are unknown.
    """

    rows: Mapping[int, tuple[np.ndarray, np.ndarray]] = field(default_factory=dict)
    warnings: tuple[str, ...] = ()


@dataclass(frozen=True)
class Slopes:
    """Derivatives of k results with respect to d inputs at the nominal design, with their errors.

    Parameters
    ----------
    value, error : ndarray, shape (d, k)
        Derivatives (nan if unknown), and their absolute errors [unit of the result / unit of the input].
    exact : ndarray of bool, shape (d, k)
        Whether each derivative is computed from the equations; others are slopes of polynomials through
        results of neighbouring designs.
    """

    value: np.ndarray
    error: np.ndarray
    exact: np.ndarray

    def replaced(self, rows: Mapping[int, tuple[np.ndarray, np.ndarray]]) -> Slopes:
        """Return a copy with exact derivatives, where these are finite.

        `rows` has, by index of the input, the exact derivatives of all results and their errors.
        """
        value, error, exact = self.value.copy(), self.error.copy(), self.exact.copy()
        for row, (slope, wrong) in rows.items():
            known = np.isfinite(slope)
            value[row, known], error[row, known], exact[row, known] = slope[known], wrong[known], True
        return Slopes(value, error, exact)


def slopes_from(
    nominal: np.ndarray, beside: np.ndarray, steps: np.ndarray, error: np.ndarray | float = 0.0
) -> Slopes:
    """Compute derivatives as slopes of fourth-degree polynomials through five designs for each input.

    Parameters
    ----------
    nominal : ndarray, shape (k,)
        Results of the nominal design.
    beside : ndarray, shape (inputs, 4, k)
        Results of the designs in which one input differs from its nominal value by one of the steps.
    steps : ndarray, shape (inputs, 4)
        Steps of each input from its nominal value, in the input's unit.
    error : ndarray, shape (k,)
        Absolute error of each result.

    Returns
    -------
    Slopes
        The error is the difference from the slope of a parabola through three of the designs, plus the effect
        of errors of the results.  If a design lacks a result, the slope is nan and its error inf.
    """
    with np.errstate(invalid="ignore"):
        changes = beside - nominal
        fine = np.array([_slope_weights(each) for each in steps])
        coarse = np.array([_parabola_weights(each) for each in steps])
        value = np.einsum("ds,dsk->dk", fine, changes)
        distance = np.abs(value - np.einsum("ds,dsk->dk", coarse, changes))
        noise = 2 * np.abs(fine).sum(axis=1)[:, None] * error
    known = np.isfinite(value)
    errors = np.where(known, distance + noise, np.inf)
    return Slopes(np.where(known, value, np.nan), errors, np.zeros(value.shape, dtype=bool))


def _slope_weights(steps: np.ndarray) -> np.ndarray:
    """Compute the weights of values at given steps whose weighted sum is the slope of a polynomial at 0.

    The polynomial passes through these values, and is 0 at 0.
    """
    size = np.abs(steps).max()
    powers = (steps / size)[None, :] ** np.arange(1, len(steps) + 1)[:, None]
    return np.linalg.solve(powers, np.eye(len(steps))[0]) / size


def _parabola_weights(steps: np.ndarray) -> np.ndarray:
    """Compute weights of values at four steps whose weighted sum is the slope of a parabola at 0.

    The parabola is 0 at 0, and passes through two of the four values: the value at the last step, and the
    value at the first step or, if the first and the last step have the same sign, at the second.  The weights
    of the other values are 0.
    """
    used = [0, 3] if steps[0] * steps[3] < 0 else [1, 3]
    weights = np.zeros(len(steps))
    weights[used] = _slope_weights(steps[used])
    return weights


# First-order ranges -------------------------------------------------------------------------------


@dataclass(frozen=True)
class FirstOrderRange:
    """First-order ranges of k results over the tolerances of d inputs; nan if a derivative is missing.

    Parameters
    ----------
    smallest, largest : ndarray, shape (k,)
        Results with each input at the end of its tolerance that makes them smallest or largest [units of the
        results].
    mean, deviation : ndarray, shape (k,)
        Mean and standard deviation [units of the results].
    error : ndarray, shape (k,)
        Largest effect of errors of the derivatives on `smallest`, `largest`, `mean` and `deviation` [units of
        the results].
    share : ndarray, shape (d, k)
        Contribution of each input to the variance, as a fraction.
    slope, slope_error : ndarray, shape (d, k)
        Derivatives and their absolute errors [unit of the result / unit of the input].
    exact : ndarray of bool, shape (d, k)
        Whether each derivative is computed from the equations; others are slopes of polynomials through
        results of neighbouring designs.

    References
    ----------
    Standard: linear propagation of tolerances.

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
    """Compute first-order ranges of results from derivatives and tolerances.

    Parameters
    ----------
    inputs : sequence of SpreadInput
        The inputs.
    nominal : ndarray, shape (k,)
        Results of the nominal design.
    slopes : Slopes
        Derivatives of the results at the nominal design.
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
