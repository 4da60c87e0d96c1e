"""Comparison of a plate's results with those by fewer functions across its width, for their errors."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from beamdyn.equations.fewer_across import FewerAcross
from beamdyn.modes.modal.model import Model


def distance_across(
    model: Model, evaluate: Callable[[Model], np.ndarray], value: np.ndarray
) -> np.ndarray | float:
    """Compute the distance of `value` from that with fewer functions across a strip; 0 for other beams.

    `evaluate` computes the value from a model.  The comparison with a coarser mesh, or between the largest
    bases, does not show this distance, as these have equally many functions across.  The distance is inf if
    there are too few functions across to leave out two.
    """
    if not model.scene.models_width:
        return 0.0
    fewer = FewerAcross(model.discretization)
    if not fewer.has_fewer_of_both(model.scene.modelled_beam):
        return np.inf
    return np.abs(evaluate(Model(model.scene, fewer)) - value)
