"""Eigensolver of equations that fall into parts without coupling, such as two planes of a straight beam."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.modal.eigen import Eigen, Solver
from beamdyn.modal.large import LargeSolver

LARGE = 256  # number of coordinates of a part above which its lowest modes alone are computed


def solver_of(equations: Equations) -> Solver | LargeSolver | UncoupledSolver:
    """Eigensolver of equations at steady speed; each uncoupled part of them is solved apart."""
    pencil, parts = equations.steady(), [equations.places(names) for names in equations.connected]
    return _solver_of_part(pencil) if len(parts) == 1 else UncoupledSolver(pencil, parts)


def _solver_of_part(pencil: SteadyPencil) -> Solver | LargeSolver:
    return LargeSolver(pencil) if len(pencil.M) > LARGE else Solver(pencil)


class UncoupledSolver:
    """Eigensolver that solves the parts of a pencil apart, with the interface of `Solver`.

    Parameters
    ----------
    pencil : SteadyPencil
        Equations at steady speed.
    parts : sequence of ndarray of int
        Coordinates of each part.
    """

    def __init__(self, pencil: SteadyPencil, parts: Sequence[np.ndarray]) -> None:
        self.pencil = pencil
        self.parts = tuple(parts)
        self.solvers = tuple(_solver_of_part(pencil.part(part)) for part in parts)

    @property
    def size(self) -> int:
        """Number n of coordinates and modes."""
        return len(self.pencil.M)

    @property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest [rad2/s2], plus `pencil.shift`."""
        return min(solver.lowest_at_rest for solver in self.solvers)

    @property
    def softening(self) -> float:
        """Largest loss of stiffness per squared speed, relative to that at rest [s2]; 0 within rounding."""
        return self._softest.softening

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the stiffness is singular [rad/s]; inf if there is none."""
        return self._softest.critical_speed

    @property
    def critical_rounding(self) -> float:
        """Estimated relative rounding error of the critical speed."""
        return self._softest.critical_rounding

    @property
    def _softest(self) -> Solver | LargeSolver:
        return max(self.solvers, key=lambda solver: solver.softening)

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s]."""
        found = [solver.solve(speeds, min(count, solver.size)) for solver in self.solvers]
        vectors = [self._embed(part, eigen.vector) for part, eigen in zip(self.parts, found, strict=True)]
        eigenvalue, rounding, vector = (
            np.concatenate(values, axis=-1)
            for values in ([e.eigenvalue for e in found], [e.rounding for e in found], vectors)
        )
        order = _order(eigenvalue)[:, :count]
        return Eigen(
            np.take_along_axis(eigenvalue, order, axis=1),
            np.take_along_axis(vector, order[:, None, :], axis=2),
            np.take_along_axis(rounding, order, axis=1),
        )

    def eigenvalues(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Compute the eigenvalues of the `count` lowest modes at each speed [rad/s], shape (S, count)."""
        each = [solver.eigenvalues(speeds, min(count, solver.size)) for solver in self.solvers]
        together = np.concatenate(each, axis=1)
        return np.take_along_axis(together, _order(together)[:, :count], axis=1)

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in static equilibrium: as `Solver.solve_static`."""
        each = zip(self.parts, self.solvers, strict=True)
        return np.sum([solver.solve_static(speeds, outputs[:, part]) for part, solver in each], axis=0)

    def _embed(self, part: np.ndarray, vector: np.ndarray) -> np.ndarray:
        """Vectors (S, n, k) over all coordinates, from those over a part."""
        embedded = np.zeros((len(vector), self.size, vector.shape[2]), dtype=vector.dtype)
        embedded[:, part] = vector
        return embedded


def _order(eigenvalue: np.ndarray) -> np.ndarray:
    """Order (S, k) of eigenvalues by squared frequency, that of a growing mode being negative."""
    sign = np.where((np.imag(eigenvalue) == 0) & (np.real(eigenvalue) > 0), -1.0, 1.0)
    return np.argsort(sign * np.abs(eigenvalue) ** 2, axis=1, kind="stable")
