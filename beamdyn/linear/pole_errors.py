"""Errors of the poles of a linear model: by the modes left out, and by the discretization."""

from __future__ import annotations

import numpy as np
from scipy.optimize import linear_sum_assignment

from beamdyn.accuracy.margins import LINEAR_MESHES
from beamdyn.linear.model_at_speed import ModelAtSpeed

_UNRESOLVED = 0.01  # relative error beyond which the partner of a pole may be that of another mode
_ROUNDING = 4 * float(np.finfo(float).eps)  # of the matrices, relative


def pole_errors(model: ModelAtSpeed) -> np.ndarray:
    """Estimated relative errors (2 n,) of the poles of a model, in the order of `FreeMotion.poles`.

    What the modes left out change by damping and gyroscopic terms is the distance from its partner among
    the poles of all functions; these are compared with those of a coarser discretization.  An infinite pole,
    of a coordinate without mass, has no error: nan.  Beyond 1 % a pole is unresolved: inf.
    """
    kept, whole = model.free_motion, ModelAtSpeed(model.model, model.speed, None)
    coarse = ModelAtSpeed(model.model.coarser, model.speed, None)
    poles, of_all = kept.finite_poles, whole.free_motion.finite_poles
    truncation, nearest = _distance(poles, of_all)
    discretized, _ = _distance(nearest, coarse.free_motion.finite_poles)
    resolved = model.model.exceeds_coarser
    rounding = (kept.rounding + whole.free_motion.rounding) * np.abs(poles)
    with np.errstate(divide="ignore", invalid="ignore"):
        error = (truncation + LINEAR_MESHES.factor * discretized) / np.abs(poles)
    error += rounding + _ROUNDING + LINEAR_MESHES.factor * model.discretization.rounding
    found = np.full(len(kept.poles), np.nan)
    found[: len(poles)] = np.where((error < _UNRESOLVED) & resolved, error, np.inf)
    return found


def _distance(poles: np.ndarray, others: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Distance of each pole from a partner of its own among others, and that; inf where these are too few."""
    apart = np.abs(poles[:, None] - others)
    scale = np.maximum(np.abs(poles), _ROUNDING * np.abs(poles).max(initial=0.0))[:, None]
    rows, partners = linear_sum_assignment(apart / np.where(scale == 0, 1.0, scale))
    distance, found = np.full(len(poles), np.inf), poles.copy()
    distance[rows], found[rows] = apart[rows, partners], others[partners]
    return distance, found
