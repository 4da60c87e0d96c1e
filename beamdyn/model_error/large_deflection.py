"""What large deflection would change, which is solved and not estimated."""

from __future__ import annotations

import numpy as np

from beamdyn.modal.model import Model

NOT_SOLVED = "the bent beam has not been solved"
NO_CRITICAL_SPEED = "the rotation bends the beam at every speed: it does not buckle"


def large_deflection_change(
    model: Model, speeds: np.ndarray, eigenvalue: np.ndarray
) -> tuple[np.ndarray, str]:
    """Find what large deflection changes in the frequencies at some speeds.

    Parameters
    ----------
    model : Model
        The linear model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    eigenvalue : ndarray of complex, shape (S, m)
        Its eigenvalues [1/s].

    Returns
    -------
    change : ndarray, shape (S, m)
        Relative change of each frequency: 0 if the straight beam is in equilibrium, nan if it is not known.
    reason : str
        Why it is not known; empty if it is.
    """
    bent = np.array([bends(model, speed) for speed in speeds.tolist()])
    change = np.where(bent[:, None], np.nan, np.zeros(eigenvalue.shape))
    return change, NOT_SOLVED if bent.any() else ""


def bends(model: Model, speed: float) -> bool:
    """Whether a steady rotation loads the straight beam transversely."""
    return bool(speed) and bool(model.equations.steady().f2[_transverse(model)].any())


def _transverse(model: Model) -> np.ndarray:
    """Coordinates of the fields that deflect the beam transversely."""
    return model.equations.places(model.equations.deflections)
