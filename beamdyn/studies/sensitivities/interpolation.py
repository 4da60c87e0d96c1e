"""Derivatives of matrices that depend on a number, by interpolation between places near it.

The matrices are polynomials, quotients of them or sines of most numbers, and more of a place along the beam,
which moves over functions of high degree.  They are evaluated at eight places, and the polynomial through
these values is differentiated; the last term of that polynomial says how well it is resolved.  Eigenvalues,
which have far fewer digits, are not differenced.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Generic, TypeVar

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.studies.sensitivities.scene_numbers import SceneNumber

PLACES = 8
_STEPS = 9  # sizes of steps, over four decades: rounding counts by their inverse

Evaluated = TypeVar("Evaluated")


@dataclass(frozen=True)
class Nearby(Generic[Evaluated]):
    """What was evaluated around a number, and the weights that make derivatives of it.

    Parameters
    ----------
    values : list
        What was evaluated, at `PLACES` places.
    weights : ndarray, shape (PLACES,)
        The derivative is their sum times the values [1 / unit of the number].
    last : ndarray, shape (PLACES,)
        The same of the last term of the polynomial through the values, for what the polynomial misses.
    width : float
        Half of the interval [unit of the number].
    """

    values: list[Evaluated]
    weights: np.ndarray
    last: np.ndarray
    width: float


def evaluate_nearby(
    number: SceneNumber, evaluate: Callable[[float], Evaluated]
) -> Iterator[Nearby[Evaluated]]:
    """Evaluate something around a number, in the widest interval that is not refused, then in narrower ones.

    Where the values on one side are always refused, those on the other alone are taken.

    Parameters
    ----------
    number : SceneNumber
        The number.
    evaluate : callable
        Function of the number's value.

    Yields
    ------
    Nearby

    Raises
    ------
    InvalidValue
        If the values on both sides are refused.
    """
    refused: InvalidValue | None = None
    for intervals in _intervals(number):
        found = False
        for low, high in intervals:
            try:
                nearby = _evaluate_between(low, high, number.value, evaluate)
            except InvalidValue as error:
                refused = error
            else:
                found = True
                yield nearby
        if found:
            return
    assert refused is not None
    raise refused


def _evaluate_between(
    low: float, high: float, at: float, evaluate: Callable[[float], Evaluated]
) -> Nearby[Evaluated]:
    """Evaluate something at the Chebyshev points of an interval, for derivatives at a place within."""
    middle, half = (low + high) / 2, (high - low) / 2
    points = -np.cos(np.pi * (np.arange(PLACES) + 0.5) / PLACES)
    values = [evaluate(float(middle + half * t)) for t in points]
    terms = np.polynomial.chebyshev.chebvander(points, PLACES - 1) * 2 / PLACES
    terms[:, 0] /= 2
    slopes = np.array([_slope(k, (at - middle) / half) for k in range(PLACES)]) / half
    return Nearby(values, terms @ slopes, terms[:, -1] * slopes[-1], half)


def _slope(degree: int, t: float) -> float:
    """Derivative of a Chebyshev polynomial of some degree at t."""
    return float(np.polynomial.Chebyshev.basis(degree).deriv()(t)) if degree else 0.0


def _intervals(number: SceneNumber) -> Iterator[list[tuple[float, float]]]:
    """Intervals around the number, those above it, and those below it, each from wide to narrow."""
    steps = [number.step * 10 ** (-k / 2) for k in range(_STEPS)]
    lowest = [max(number.value - step, number.least) for step in steps]
    yield [(low, number.value + step) for low, step in zip(lowest, steps, strict=True)]
    yield [(number.value, number.value + step) for step in steps]
    yield [(low, number.value) for low in lowest if low < number.value]
