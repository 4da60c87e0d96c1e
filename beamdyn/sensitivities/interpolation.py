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
from beamdyn.sensitivities.scene_numbers import SceneNumber

PLACES = 8
_STEPS = 9  # sizes of steps, over four decades: rounding counts by their inverse

Evaluated = TypeVar("Evaluated")


def evaluate_nearby(
    number: SceneNumber, evaluate: Callable[[float], Evaluated]
) -> tuple[list[Evaluated], np.ndarray]:
    """Evaluate something around a number, and give the weights of its derivative there.

    Where the values on one side are refused, those on the other alone are taken.

    Parameters
    ----------
    number : SceneNumber
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


def _intervals(number: SceneNumber) -> Iterator[tuple[float, float]]:
    """Around the number, the widest first, nearer where others of the scene limit it; then beside it."""
    steps = [number.step * 10 ** (-k / 2) for k in range(_STEPS)]
    lowest = [max(number.value - step, number.least) for step in steps]
    for low, step in zip(lowest, steps, strict=True):
        yield low, number.value + step
    for low, step in zip(lowest, steps, strict=True):
        yield number.value, number.value + step
        if low < number.value:
            yield low, number.value


def _weights(nodes: np.ndarray, at: float) -> np.ndarray:
    """Weights of the derivative of the interpolating polynomial at a place, which may be a node's."""
    scale = np.abs(nodes - at).max()
    t = (nodes - at) / scale
    powers = np.vander(t, increasing=True).T
    return np.linalg.solve(powers, np.eye(len(t))[1]) / scale
