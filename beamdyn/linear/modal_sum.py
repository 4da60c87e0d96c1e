"""A transfer function as a sum over the free motions of a model, fast at many frequencies.

Each free motion adds one term over 1 - s t_k, with its inverse pole t_k = 1/p_k: see
`beamdyn.linear.free_motion`.  The lowest poles belong to the largest t_k, which are the accurate ones;
coordinates without mass have t_k = 0.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from beamdyn.linear.model_at_speed import HarmonicDrive, ModelAtSpeed
from beamdyn.linear.observations import Observation, StrainAtRoot

_AT_ONCE = 1_000_000  # terms that are held at once


@dataclass(frozen=True)
class ModalSum:
    """H(s) = (sum_k (w_k0 + w_k1 s + w_k2 s^2) / (1 - s t_k) + d_0 + d_1 s + d_2 s^2) / (1 + s delay).

    Parameters
    ----------
    inverse_poles : ndarray of complex, shape (m,)
        t_k [s].
    weights : ndarray of complex, shape (m, 3)
        w_kj.
    direct : ndarray of complex, shape (3,)
        d_j.
    delay : float
        Delay of the strain in a material that damps [s].
    """

    inverse_poles: np.ndarray
    weights: np.ndarray
    direct: np.ndarray
    delay: float

    @property
    def poles(self) -> np.ndarray:
        """The finite p_k [1/s]."""
        return 1 / self.inverse_poles[self.inverse_poles != 0]

    def __call__(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative by s at complex frequencies s [1/s] (F,): each of shape (F,)."""
        step = max(1, _AT_ONCE // len(self.inverse_poles))
        each = [self._at(s[k : k + step]) for k in range(0, max(len(s), 1), step)]
        value, slope = (np.concatenate(parts) for parts in zip(*each, strict=True))
        filtered = 1 + s * self.delay
        return value / filtered, (slope - value * self.delay / filtered) / filtered

    def _at(self, s: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Value and derivative before the delay."""
        terms = 1 / (1 - s[:, None] * self.inverse_poles)
        sums, slopes = terms @ self.weights + self.direct, (terms**2 * self.inverse_poles) @ self.weights
        value = sums[:, 0] + s * (sums[:, 1] + s * sums[:, 2])
        return value, slopes[:, 0] + s * (slopes[:, 1] + s * slopes[:, 2]) + sums[:, 1] + 2 * s * sums[:, 2]


def modal_sums(
    model: ModelAtSpeed, drives: Mapping[int, HarmonicDrive], observation: Observation
) -> dict[int, ModalSum]:
    """Expand the transfer function of each drive, by harmonic of the rotation."""
    free = model.free_motion
    shares = free.shares(np.column_stack([drive.load for drive in drives.values()]))
    row = model.row(observation)
    seen = np.column_stack([r @ free.shapes for r in (row.position, row.velocity, row.acceleration)])
    delay = model.scene.damping.stiffness_factor if isinstance(observation, StrainAtRoot) else 0.0
    return {
        h: ModalSum(free.inverse_poles, seen * share[:, None], model.residual(observation, drive), delay)
        for (h, drive), share in zip(drives.items(), shares.T, strict=True)
    }
