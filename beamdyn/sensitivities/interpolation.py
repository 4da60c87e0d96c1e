"""Derivatives of matrices that depend on a number as a polynomial, a quotient of them or a sine.

The matrices are evaluated at eight places near the number, and the polynomial through these values is
differentiated.  For places within 1 % it is exact to rounding: the first term that it lacks is of order
0.01^8.  Eigenvalues, which have far fewer digits, are not differenced.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TypeVar

import numpy as np

from beamdyn.common.checks import InvalidValue
from beamdyn.sensitivities.scene_inputs import SceneInput

PLACES = 8

Evaluated = TypeVar("Evaluated")


def evaluate_nearby(
    number: SceneInput, evaluate: Callable[[float], Evaluated]
) -> tuple[list[Evaluated], np.ndarray]:
    """Evaluate something around a number, and give the weights of its derivative there.

    Where the values on one side are refused, those on the other alone are taken.

    Parameters
    ----------
    number : SceneInput
        The number.
    evaluate : callable
        Function of the number's value.

    Returns
    -------
    values : list
        What was evaluated, at `PLACES` places.
    weights : ndarray, shape (PLACES,)
        The derivative is their sum times the values [1 / unit of the number].

    Raises
    ------
    InvalidValue
        If the values on both sides are refused.
    """
    refused: InvalidValue | None = None
    for low, high in _intervals(number):
        nodes = (low + high) / 2 - (high - low) / 2 * np.cos(np.pi * (np.arange(PLACES) + 0.5) / PLACES)
        try:
            return [evaluate(float(node)) for node in nodes], _weights(nodes, number.value)
        except InvalidValue as error:
            refused = error
    assert refused is not None
    raise refused


def _intervals(number: SceneInput) -> Iterator[tuple[float, float]]:
    """Around the number, above it, and below it."""
    value, step = number.value, number.step
    if value - step >= number.least:
        yield value - step, value + step
    yield value, value + step
    if value - step >= number.least:
        yield value - step, value


def _weights(nodes: np.ndarray, at: float) -> np.ndarray:
    """Weights of the derivative of the interpolating polynomial at a place, which may be a node's."""
    scale = np.abs(nodes - at).max()
    t = (nodes - at) / scale
    powers = np.vander(t, increasing=True).T
    return np.linalg.solve(powers, np.eye(len(t))[1]) / scale
