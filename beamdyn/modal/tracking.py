"""Follow modes over a batch of speeds by the overlap of their vectors."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment


def track(vectors: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Which mode at each speed continues which mode at the first.

    Parameters
    ----------
    vectors : ndarray, shape (S, n, k)
        Mass-normalised vectors at each speed.
    mass : ndarray, shape (n, n)
        Mass matrix.

    Returns
    -------
    order : ndarray of int, shape (S, k)
        ``order[s, i]`` is the place at speed s of the mode that is the i-th at the first speed.
    confidence : ndarray, shape (S, k)
        Overlap (modal assurance criterion) with the mode at the speed before, less the overlap of the
        best rival: 1 is sure, 0 or less a guess.
    """
    steps = np.abs(np.swapaxes(vectors[:-1].conj(), 1, 2) @ (mass @ vectors[1:])) ** 2
    S, _, k = vectors.shape
    order, confidence = np.tile(np.arange(k), (S, 1)), np.ones((S, k))
    step = _assignments(steps)
    for s in np.flatnonzero((step != np.arange(k)).any(axis=1)):
        order[s + 1 :] = step[s][order[s]]  # holds until the next exchange
    own = np.take_along_axis(steps, step[:, :, None], axis=2)[:, :, 0]
    rivals = steps.copy()
    np.put_along_axis(rivals, step[:, :, None], -1.0, axis=2)
    sure = own - rivals.max(axis=2, initial=0.0)
    confidence[1:] = np.take_along_axis(sure, order[:-1], axis=1)
    return order, confidence


def _assignments(steps: np.ndarray) -> np.ndarray:
    """For each step, the column that continues each row; solved only where the order is in doubt."""
    best = steps.argmax(axis=2)
    settled = np.sort(best, axis=1) == np.arange(steps.shape[2])
    for s in np.flatnonzero(~settled.all(axis=1)):
        best[s] = linear_sum_assignment(-steps[s])[1]
    return best
