"""Which computed mode a measured frequency belongs to.

The distance of two frequencies is that of their logarithms, over half of the way from the computed mode to
its neighbour on that side: a mode far from all others may be far off, and is still the one.  Where shapes are
given, the distance grows with what their modal assurance criterion lacks of 1.  All pairs at a speed are
chosen together, by least total distance; a frequency stays without a mode where all are too far.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.common.numerics import assign
from beamdyn.modes.kinds import BENDING, TORSION

_TOO_FAR = 1.5  # half ways from a mode to its neighbour; one mode may be off by more than its half way
_BELOW = 2.0  # way from the lowest mode down, and from the highest up, where none is: a factor of seven
_CROSSING = 1e-2  # least half way: modes that cross are told by their shapes alone
_OF_SHAPE = 3.0  # what a shape that is orthogonal adds to a distance
NO_MODE = -1


def pair(measured: np.ndarray, computed: np.ndarray, likeness: np.ndarray | None = None) -> np.ndarray:
    """Index (m,) of the computed mode of each measured frequency; `NO_MODE` where there is none.

    Parameters
    ----------
    measured : ndarray, shape (m,)
        Frequencies [Hz]; nan where none was measured.
    computed : ndarray, shape (n,)
        Frequencies of the model [Hz], in any order; nan or 0 where a mode does not vibrate.
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
    alone = np.where(np.eye(len(known), dtype=bool), _TOO_FAR, 1e6)  # each may stay alone
    column = assign(np.hstack([cost, alone]))
    paired = column < len(there)
    found[known[paired]] = there[column[paired]]
    return found


def _distances(measured: np.ndarray, computed: np.ndarray) -> np.ndarray:
    """Distances (m, n) of frequencies in half ways from a mode to its neighbour on that side."""
    log, order = np.log(computed), np.argsort(computed)
    apart = np.log(measured)[:, None] - log
    gaps = np.diff(log[order], prepend=log[order[0]] - _BELOW, append=log[order[-1]] + _BELOW)
    half = np.maximum(gaps / 2, _CROSSING)
    below, above = np.empty_like(log), np.empty_like(log)
    below[order], above[order] = half[:-1], half[1:]
    return np.abs(apart) / np.where(apart < 0, below, above)


def likeness_of(measured: np.ndarray, computed: np.ndarray) -> np.ndarray:
    """Modal assurance criterion (m, n) of shapes (m, P), (n, P) at the same points (Allemang 2003, eq. 1)."""
    products = np.abs(measured @ computed.conj().T) ** 2
    sizes = (np.abs(measured) ** 2).sum(axis=1)[:, None] * (np.abs(computed) ** 2).sum(axis=1)
    return products / np.where(sizes == 0, 1.0, sizes)


def likeness_of_kinds(labels: Sequence[str], kinds: np.ndarray | None, modes: int) -> np.ndarray | None:
    """Likeness (m, n) by what labels say of torsion: 1 where a mode may be meant; None where none says it."""
    said = np.array([TORSION in label.lower() for label in labels])
    if not said.any():
        return None
    twists = np.full(modes, BENDING) == TORSION if kinds is None else kinds == TORSION
    return (said[:, None] == twists).astype(float)
