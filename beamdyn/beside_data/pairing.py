"""Which computed mode a measured frequency belongs to.

The distance of two frequencies is that of their logarithms, over half of the way from the computed mode to
its nearest neighbour: a mode far from all others may be far off, and is still the one.  Where shapes are
given, the distance grows with what their modal assurance criterion lacks of 1.  All pairs at a speed are
chosen together, by least total distance; a frequency stays without a mode where all are too far.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.common.assignment import assign
from beamdyn.modes.kinds import BENDING, TORSION

_TOO_FAR = 1.5  # half ways from a mode to its neighbour; one mode may be off by more than its half way
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
    log = np.log(computed[there])
    cost = np.abs(np.log(measured[known])[:, None] - log) / _half_ways(log)
    if likeness is not None:
        cost = cost + _OF_SHAPE * (1 - likeness[np.ix_(known, there)])
    alone = np.where(np.eye(len(known), dtype=bool), _TOO_FAR, 1e6)  # each may stay alone
    column = assign(np.hstack([cost, alone]))
    paired = column < len(there)
    found[known[paired]] = there[column[paired]]
    return found


def _half_ways(log: np.ndarray) -> np.ndarray:
    """Half of the distance of each mode to its nearest neighbour; that of the lowest to the one above."""
    order = np.argsort(log)
    gaps = np.diff(log[order], prepend=-np.inf, append=np.inf)
    near = np.minimum(gaps[:-1], gaps[1:])
    half = np.empty(len(log))
    half[order] = np.where(np.isfinite(near), near, np.inf) / 2
    return np.maximum(half, 1e-3)  # modes that cross are told by their shapes alone


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
