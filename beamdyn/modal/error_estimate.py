"""Modes with the error of their eigenvalues, from the distance of a coarser model."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.modal.eigen import Eigen
from beamdyn.modal.model import Model

_UNRESOLVED = 0.3  # error from which the distance of two models tells nothing
_SLOW = 1e-10  # distance of two bases from which the error may exceed it


@dataclass(frozen=True)
class EstimatedModes:
    """Modes over a batch of speeds, with the error of their eigenvalues.

    Parameters
    ----------
    model, coarse : Model
        The model that was solved, and the one that it was compared with.
    eigen : Eigen
        Modes of `model`.
    error : ndarray, shape (S, k)
        Estimated relative error of the eigenvalues: distance of the two models, and rounding.
    """

    model: Model
    coarse: Model
    eigen: Eigen
    error: np.ndarray

    def meet(self, tolerance: float) -> bool:
        """Whether all errors are below a tolerance, or within rounding."""
        rounding = self.eigen.rounding[:, : self.error.shape[1]]
        return bool((self.error <= np.maximum(tolerance, 3 * rounding)).all())


def solve_with_error(model: Model, speeds: np.ndarray, modes: int, extra: int = 0) -> EstimatedModes:
    """Solve a model and its coarser companion.

    Parameters
    ----------
    model : Model
        The model.
    speeds : ndarray, shape (S,)
        Speeds [rad/s].
    modes : int
        Number of modes with an error.
    extra : int
        Further modes, without one.

    Returns
    -------
    EstimatedModes
    """
    coarse = model.coarser
    fine = model.solver.solve(speeds, min(modes + extra, model.solver.size))
    s = fine.eigenvalue[:, :modes]
    distance = s - coarse.solver.eigenvalues(speeds, modes)
    order = model.discretization.order
    if order is not None:  # Richardson: the two meshes know the leading term of the error
        s = s + distance / (2**order - 1)
        fine = Eigen(np.concatenate([s, fine.eigenvalue[:, modes:]], axis=1), fine.vector, fine.rounding)
    with np.errstate(divide="ignore", invalid="ignore"):
        relative = np.abs(distance) / np.abs(s)
        truncation = relative / 3 if order is not None else _ritz_error(distance, s, model.solver.rest)
        error = truncation + fine.rounding[:, :modes] + model.discretization.rounding
    return EstimatedModes(model, coarse, fine, np.where(error < _UNRESOLVED, error, np.inf))  # nan, too


def _ritz_error(distance: np.ndarray, s: np.ndarray, rest: float) -> np.ndarray:
    """Relative error of Ritz eigenvalues s (S, k) by their distance from those of a smaller basis.

    The next functions mostly bring less than the last did, but for staircases of even and odd ones, and
    modes whose distance is small by accident; where they converge slowly, a margin measured on random
    scenes is added.  `rest` is the lowest squared frequency at rest, the scale where s vanishes.
    """
    own = np.abs(distance) / np.abs(s)
    of_squares = np.abs(distance * (s - distance / 2)) / np.maximum(np.abs(s) ** 2, rest)
    largest = of_squares.max(axis=1, keepdims=True)
    return np.where(largest > _SLOW, np.maximum(3 * own, 0.3 * largest), own)
