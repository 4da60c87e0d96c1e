"""Equilibrium and frequencies on increasingly fine meshes, and the difference of the last two meshes."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from benchmarks.cases.reference.elastica.equations import Collocation
from benchmarks.cases.reference.elastica.equilibrium import State, on
from benchmarks.cases.reference.elastica.vibration import Complexes, exponents, frequencies, growth

_NODES = 16
_FINEST = 24  # largest number of pieces of each interval between breakpoints


@dataclass(frozen=True)
class Answer:
    """Equilibrium and frequencies of a scene at one speed.

    Parameters
    ----------
    tip
        Position of the tip relative to the root, along the beam at rest and along the direction of bending.
    frequency
        The lowest frequencies lambda; nan for a mode that diverges.
    exponent
        Exponents s of the lowest modes.
    growth
        Largest real part of s: 0 is stable.
    change
        Change of tip and exponents between the last two meshes, relative to 1 and to the exponents.
    """

    tip: np.ndarray
    frequency: np.ndarray
    exponent: Complexes
    growth: float
    change: float


def converged(state: State, count: int = 3, rtol: float = 1e-12) -> Answer:
    """Return the answer on the first mesh whose refinement changes no result by more than `rtol`."""
    beam, pieces, change = state.equations.beam, 2, np.inf
    before = _answer(on(Collocation(beam, 1, _NODES), state), count, change)
    while pieces <= _FINEST:
        found = _answer(on(Collocation(beam, pieces, _NODES), state), count, change)
        change = _difference(before, found)
        if change <= rtol:
            return Answer(found.tip, found.frequency, found.exponent, found.growth, change)
        before, pieces = found, pieces + (pieces + 1) // 2
    raise ArithmeticError(f"not converged: the finest mesh changes the answer by {change:.1e}")


def _answer(state: State, count: int, change: float) -> Answer:
    return Answer(state.tip, frequencies(state, count), exponents(state, count), growth(state), change)


def _difference(a: Answer, b: Answer) -> float:
    by_exponent = np.abs(a.exponent - b.exponent) / np.abs(b.exponent)
    return float(max(np.abs(a.tip - b.tip).max(), by_exponent.max()))
