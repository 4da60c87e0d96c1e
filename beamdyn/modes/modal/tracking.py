"""Mode tracking over speeds by the modal assurance criterion."""

from __future__ import annotations

import numpy as np

from beamdyn.common.assignment import assign

_NORMALIZED = 2e-6  # distance of a squared norm from 1 that is rounding


def track(vectors: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Follow modes from each speed to the next by the modal assurance criterion (MAC).

    Parameters
    ----------
    vectors : ndarray, shape (S, n, k)
        Mode vectors at each speed, by ascending frequency; mass-normalised, or nearly so where the mass
        varies with the speed.
    mass : ndarray, shape (n, n)
        Mass matrix.

    Returns
    -------
    order : ndarray of int, shape (S, k)
        ``order[s, i]`` is the index at speed s of the mode that is the i-th at the first speed.
    confidence : ndarray, shape (S, k)
        MAC with the same mode at the speed before, minus the largest MAC of that mode with any other: 1
        is certain, 0 or less a guess.
    """
    weighted = mass @ vectors
    squares = _squared_norms(vectors, weighted)
    mac = np.abs(np.swapaxes(vectors[:-1].conj(), 1, 2) @ weighted[1:]) ** 2
    mac /= squares[:-1, :, None] * squares[1:, None, :]
    S, _, k = vectors.shape
    order, confidence = np.tile(np.arange(k), (S, 1)), np.ones((S, k))
    successor = _assign(mac)
    for s in np.flatnonzero((successor != np.arange(k)).any(axis=1)):
        order[s + 1 :] = successor[s][order[s]]  # holds until the next exchange
    matched = np.take_along_axis(mac, successor[:, :, None], axis=2)[:, :, 0]
    others = mac.copy()
    np.put_along_axis(others, successor[:, :, None], -1.0, axis=2)
    margin = matched - others.max(axis=2, initial=0.0)
    confidence[1:] = np.take_along_axis(margin, order[:-1], axis=1)
    return order, confidence


def _squared_norms(vectors: np.ndarray, weighted: np.ndarray) -> np.ndarray:
    """Squared norms (S, k) by the mass of vectors that are not mass-normalised to rounding; else 1."""
    squares = np.einsum("snk,snk->sk", vectors.conj(), weighted).real
    return np.where(np.abs(squares - 1) < _NORMALIZED, 1.0, squares)


def _assign(mac: np.ndarray) -> np.ndarray:
    """Assign to each mode (row) its successor (column) at the next speed, by the largest sum of MACs."""
    best = mac.argmax(axis=2)
    unique = (np.sort(best, axis=1) == np.arange(mac.shape[2])).all(axis=1)
    for s in np.flatnonzero(~unique):
        best[s] = assign(-mac[s])
    return best
