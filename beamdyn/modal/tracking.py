"""Mode tracking over speeds by the modal assurance criterion."""

from __future__ import annotations

import numpy as np

from beamdyn.common.assignment import assign

_NORMALIZED = 1e-6  # distance of a norm from 1 that is rounding


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
    vectors = _normalized(vectors, mass)
    mac = np.abs(np.swapaxes(vectors[:-1].conj(), 1, 2) @ (mass @ vectors[1:])) ** 2
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


def _normalized(vectors: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Normalise vectors that are not mass-normalised to rounding."""
    norm = np.sqrt(np.einsum("snk,snk->sk", vectors.conj(), mass @ vectors).real)
    return vectors / np.where(np.abs(norm - 1) < _NORMALIZED, 1.0, norm)[:, None, :]


def _assign(mac: np.ndarray) -> np.ndarray:
    """Assign to each mode (row) its successor (column) at the next speed, by the largest sum of MACs."""
    best = mac.argmax(axis=2)
    unique = (np.sort(best, axis=1) == np.arange(mac.shape[2])).all(axis=1)
    for s in np.flatnonzero(~unique):
        best[s] = assign(-mac[s])
    return best
