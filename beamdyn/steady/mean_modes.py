"""Modes of equations with periodic coefficients, without what varies and without damping."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.steady.periodic_system import PeriodicSystem


@dataclass(frozen=True)
class MeanModes:
    """Modes of the mean equations without damping, of unit mass.

    Parameters
    ----------
    squared : ndarray, shape (S, n)
        Squared frequencies [rad2/s2].
    shapes : ndarray, shape (S, n, n)
        Modes, in columns.
    """

    squared: np.ndarray
    shapes: np.ndarray

    @classmethod
    def of_system(cls, system: PeriodicSystem) -> MeanModes:
        """Modes at S pairs of rates; raises a LinAlgError if the mass is singular."""
        K, _, M = system.mean
        inverse = np.linalg.inv(np.linalg.cholesky(M))
        squared, vectors = np.linalg.eigh(inverse @ K @ np.swapaxes(inverse, 1, 2))
        return cls(squared, np.swapaxes(inverse, 1, 2) @ vectors)

    def transform(self, matrix: np.ndarray) -> np.ndarray:
        """Matrices (S, n, n) in these modes, with the rates last: shape (n, n, S)."""
        return np.ascontiguousarray(np.moveaxis(np.swapaxes(self.shapes, 1, 2) @ matrix @ self.shapes, 0, 2))
