"""What more functions across the width of a strip would change, for the errors of its answers."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from beamdyn.equations.fewer_across import FewerAcross
from beamdyn.modes.modal.model import Model


def distance_across(
    model: Model, evaluate: Callable[[Model], np.ndarray], value: np.ndarray
) -> np.ndarray | float:
    """Compute how far a value is from that with fewer functions across a strip; 0 for other beams.

    Meshes, and the largest bases, differ from coarser ones along the beam alone.  With too few functions to
    leave out some, the distance is inf.
    """
    if not model.scene.models_width:
        return 0.0
    narrow = FewerAcross(model.discretization)
    if not narrow.has_fewer_of_both(model.scene.modelled_beam):
        return np.inf
    return np.abs(evaluate(Model(model.scene, narrow)) - value)
