"""Systems q'' + C q' + K q = f with known solutions, in the form that `beamdyn.transient.gauss` solves."""

from __future__ import annotations

import numpy as np


class Oscillator:
    """The oscillator q'' + q = 0, whose energy (q^2 + q'^2) / 2 is constant."""

    size = 1

    def coefficients(self, t: np.ndarray) -> tuple[None, np.ndarray, np.ndarray]:
        """Return C (None), K = 1 and f = 0 at times."""
        t = np.asarray(t)[..., None]
        return None, 1 + 0 * t[..., None], 0 * t
