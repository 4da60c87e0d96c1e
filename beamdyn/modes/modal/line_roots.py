"""Speeds at which an excitation line meets a natural frequency, as roots of the difference of both."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np
from scipy.optimize import brentq, minimize_scalar

ROUNDING = 4 * np.finfo(float).eps
# Largest relative difference of line and frequency over all speeds that counts as rounding.
_COINCIDENT = 1e-8


def find_roots(f: Callable[[float], float], x: np.ndarray, y: np.ndarray) -> Iterator[tuple[float, float]]:
    """Find the roots of a continuous function to rounding, also two roots between neighbouring nodes.

    Parameters
    ----------
    f : callable
        The function; it is not called at the nodes.
    x : ndarray, shape (S,)
        Nodes, ascending.
    y : ndarray, shape (S,)
        Values of the function at the nodes.

    Yields
    ------
    root, slope : float
        A root, and the mean slope over the interval that brackets it.
    """
    known = dict(zip(x.tolist(), y.tolist(), strict=True))

    def value(at: float) -> float:
        if at not in known:
            known[at] = f(at)
        return known[at]

    for a, b in bracket(value, x, y):
        root = brentq(value, a, b, xtol=ROUNDING * b, rtol=ROUNDING)  # pyright: ignore[reportArgumentType]
        yield float(root), (value(b) - value(a)) / (b - a)


def coincides(distance: np.ndarray, frequency: np.ndarray) -> bool:
    """Return whether a line equals a frequency at every speed, from their `distance` at each."""
    return bool(np.abs(distance).max() <= _COINCIDENT * frequency.max())


def bracket(f: Callable[[float], float], x: np.ndarray, y: np.ndarray) -> Iterator[tuple[float, float]]:
    """Bracket the roots of f, with values y at x, including pairs of roots between two nodes."""
    for k in range(len(x) - 1):
        if y[k] * y[k + 1] < 0 or (y[k + 1] == 0 and y[k] != 0):
            yield float(x[k]), float(x[k + 1])
    size = np.abs(y)
    dips = (
        (size[1:-1] < size[:-2]) & (size[1:-1] <= size[2:]) & (y[1:-1] * y[:-2] > 0) & (y[1:-1] * y[2:] > 0)
    )
    for k in np.flatnonzero(dips) + 1:
        a, b, sign = float(x[k - 1]), float(x[k + 1]), np.sign(y[k])
        minimum = minimize_scalar(lambda v, s=sign: s * f(v), bounds=(a, b), method="bounded")
        if minimum.fun < 0:
            yield from ((a, float(minimum.x)), (float(minimum.x), b))
