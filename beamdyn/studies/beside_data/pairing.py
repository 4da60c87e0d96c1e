"""Assignment of computed modes to measured frequencies.

The distance of two frequencies is the difference of their logarithms, divided by half the gap between the
computed mode and its neighbour on that side: a mode far from all others may deviate more.  If shapes are
given, the distance increases with 1 minus their modal assurance criterion.  All pairs at a speed are chosen
together, for the smallest total distance; a frequency stays without a mode if all modes are too far.

In shapes of arrays, m counts measured modes, n computed ones, and P points of each shape.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.common.numerics import assign
from beamdyn.modes.modal.model import BENDING, TORSION

# Distance, in half gaps between modes, above which a measured value stays without a mode; a deviation may
# exceed half a gap.
_TOO_FAR = 1.5
# Assumed gap below the lowest and above the highest mode, as a logarithm: a factor of about seven.
_BELOW = 2.0
_CROSSING = 1e-2  # smallest half gap: crossing modes are distinguished by their shapes alone
_OF_SHAPE = 3.0  # distance added by a shape that is orthogonal to the measured one
NO_MODE = -1


def pair(measured: np.ndarray, computed: np.ndarray, likeness: np.ndarray | None = None) -> np.ndarray:
    """Return the index (m,) of the computed mode of each measured frequency; `NO_MODE` if there is none.

    Parameters
    ----------
    measured : ndarray, shape (m,)
        Measured frequencies [Hz]; nan if not measured.
    computed : ndarray, shape (n,)
        Frequencies of the model [Hz], in any order; nan or 0 if a mode does not vibrate.
    likeness : ndarray, shape (m, n), optional
        Modal assurance criterion of the shapes.
    """
    found = np.full(len(measured), NO_MODE)
    known, there = np.flatnonzero(np.isfinite(measured)), np.flatnonzero(np.nan_to_num(computed) > 0)
    if not known.size:
        return found
    cost = _distances(measured[known], computed[there])
    if likeness is not None:
        cost = cost + _OF_SHAPE * (1 - likeness[np.ix_(known, there)])
    alone = np.where(np.eye(len(known), dtype=bool), _TOO_FAR, 1e6)  # cost of leaving a value without a mode
    column = assign(np.hstack([cost, alone]))
    paired = column < len(there)
    found[known[paired]] = there[column[paired]]
    return found


def _distances(measured: np.ndarray, computed: np.ndarray) -> np.ndarray:
    """Compute the distance of each measured from each computed frequency, shape (measured, computed).

    It is the difference of their logarithms, divided by half the gap between the computed frequency and its
    computed neighbour on the side of the measured one.
    """
    log, order = np.log(computed), np.argsort(computed)
    apart = np.log(measured)[:, None] - log
    gaps = np.diff(log[order], prepend=log[order[0]] - _BELOW, append=log[order[-1]] + _BELOW)
    half = np.maximum(gaps / 2, _CROSSING)
    below, above = np.empty_like(log), np.empty_like(log)
    below[order], above[order] = half[:-1], half[1:]
    return np.abs(apart) / np.where(apart < 0, below, above)


def likeness_of(measured: np.ndarray, computed: np.ndarray) -> np.ndarray:
    """Compute the modal assurance criterion (measured, computed) of shapes in rows (Allemang 2003, eq. 1)."""
    products = np.abs(measured @ computed.conj().T) ** 2
    sizes = (np.abs(measured) ** 2).sum(axis=1)[:, None] * (np.abs(computed) ** 2).sum(axis=1)
    return products / np.where(sizes == 0, 1.0, sizes)


def likeness_of_kinds(labels: Sequence[str], kinds: np.ndarray | None, modes: int) -> np.ndarray | None:
    """Compare kinds of modes (measured, computed): 1 if both modes are torsional or neither is, otherwise 0.

    Measured modes are torsional if their labels mention torsion; None if no label mentions it.
    """
    said = np.array([TORSION in label.lower() for label in labels])
    if not said.any():
        return None
    twists = np.full(modes, BENDING) == TORSION if kinds is None else kinds == TORSION
    return (said[:, None] == twists).astype(float)
