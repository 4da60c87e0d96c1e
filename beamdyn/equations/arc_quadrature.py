"""Integration along the beam of functions that no discretization integrates in closed form."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache, cached_property

import numpy as np
from numpy.polynomial import legendre

from beamdyn.common.legendre import gauss_points_on, gauss_rule, legendre_series


@dataclass(frozen=True)
class Cells:
    """Parts of the beam on which the trial functions of a discretization are smooth.

    Parameters
    ----------
    ends : ndarray, shape (c + 1,)
        Ends of the c cells, as x/L from 0 to 1.
    points : int
        Number p of Gauss points on each that resolve nonlinear functions of the trial functions.
    """

    ends: np.ndarray
    points: int


@dataclass(frozen=True)
class ArcQuadrature:
    """Gauss rule on cells, and integrals from the root to each of its points.

    Parameters
    ----------
    cells : Cells
        Cells and number of points.
    """

    cells: Cells

    @cached_property
    def xi(self) -> np.ndarray:
        """Points on [0, 1], shape (N,)."""
        return gauss_points_on(self.cells.ends, self.cells.points).ravel()

    @cached_property
    def weights(self) -> np.ndarray:
        """Weights of the integral from 0 to 1, shape (N,)."""
        _, w = gauss_rule(self.cells.points)
        return (np.diff(self.cells.ends)[:, None] / 2 * w).ravel()

    @cached_property
    def _half_lengths(self) -> np.ndarray:
        return np.diff(self.cells.ends)[:, None] / 2

    @property
    def _count(self) -> int:
        """Number of cells."""
        return len(self.cells.ends) - 1

    def integrate(self, values: np.ndarray) -> np.ndarray:
        """Integrate from 0 to each point, and to 1: values (..., N) at the points, result (..., N + 1)."""
        p, N = self.cells.points, len(self.xi)
        of_cells = values.reshape(-1, p)
        shape = *values.shape[:-1], self._count, p
        ends = np.cumsum(
            (of_cells @ gauss_rule(p)[1]).reshape(shape[:-1]) * self._half_lengths[:, 0], axis=-1
        )
        integrals = np.empty((*values.shape[:-1], N + 1))  # new memory costs more than the arithmetic
        inside = integrals[..., :N].reshape(shape)
        np.multiply((of_cells @ _cumulative(p).T).reshape(shape), self._half_lengths, out=inside)
        inside[..., 1:, :] += ends[..., :-1, None]
        integrals[..., N] = ends[..., -1]
        return integrals

    def transposed(self, forces: np.ndarray) -> np.ndarray:
        """Apply the transpose of `integrate`: forces (..., N + 1), result (..., N)."""
        p = self.cells.points
        _, w = gauss_rule(p)
        inside = forces[..., :-1].reshape(*forces.shape[:-1], self._count, p)
        of_cells = inside.sum(axis=-1)
        beyond = np.cumsum(of_cells[..., ::-1], axis=-1)[..., ::-1] - of_cells + forces[..., -1:]
        scaled = (inside @ _cumulative(p) + beyond[..., None] * w) * self._half_lengths
        return scaled.reshape(*forces.shape[:-1], self._count * p)

    def integrate_to(self, xi: np.ndarray) -> np.ndarray:
        """Weights (k, N) of the integrals from 0 to xi (k,) of the interpolant through the points."""
        cell, t, own = self._find(xi)
        length, p = np.diff(self.cells.ends)[cell], self.cells.points
        matrix = np.where(np.arange(len(self.xi)) < (cell * p)[:, None], self.weights, 0.0)
        np.put_along_axis(matrix, own, length[:, None] / 2 * _integrate_interpolant(t, p), axis=1)
        return matrix

    def interpolate_to(self, xi: np.ndarray) -> np.ndarray:
        """Weights (k, N) of the interpolants through the points of each cell at xi (k,)."""
        _, t, own = self._find(xi)
        matrix = np.zeros((len(xi), len(self.xi)))
        np.put_along_axis(matrix, own, _interpolate(t, self.cells.points), axis=1)
        return matrix

    def _find(self, xi: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Cell (k,) of each xi, place in it from -1 to 1 (k,), and indices (k, p) of the cell's points."""
        ends, p = self.cells.ends, self.cells.points
        cell = np.clip(np.searchsorted(ends, xi, side="right") - 1, 0, len(ends) - 2)
        t = np.clip(2 * (xi - ends[cell]) / np.diff(ends)[cell] - 1, -1, 1)
        return cell, t, cell[:, None] * p + np.arange(p)


@cache
def _cumulative(points: int) -> np.ndarray:
    """Weights (p, p) of the integrals from -1 to each of p Gauss points of the interpolant through them."""
    return _integrate_interpolant(gauss_rule(points)[0], points)


def _integrate_interpolant(t: np.ndarray, points: int) -> np.ndarray:
    """Weights (k, p) of the integrals from -1 to t (k,) of the interpolant through p Gauss points."""
    integrals = legendre.legint(np.eye(points), lbnd=-1)
    return legendre.legvander(t, points) @ integrals @ legendre_series(points)


def _interpolate(t: np.ndarray, points: int) -> np.ndarray:
    """Weights (k, p) of the interpolant through p Gauss points at t (k,)."""
    return legendre.legvander(t, points - 1) @ legendre_series(points)
