"""Eigensolver of equations that fall into parts without coupling, such as two planes of a straight beam."""

from __future__ import annotations

from functools import cached_property

import numpy as np

from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, Solver

LARGE = 256  # number of coordinates of a part above which its lowest modes alone are computed


def solver_of(equations: Equations, coordinates: np.ndarray | None = None) -> Eigensolver:
    """Eigensolver of equations at steady speed; each uncoupled part of them is solved apart.

    Where some coordinates, ascending, are given, the others are 0.
    """
    if len(equations.connected) == 1:
        pencil = equations.steady()
        return solver_of_pencil(pencil if coordinates is None else pencil.part(coordinates))
    return UncoupledSolver(equations, coordinates)


def solver_of_pencil(pencil: SteadyPencil) -> Eigensolver:
    """Eigensolver of equations at steady speed that are solved together."""
    if len(pencil.M) <= LARGE:
        return Solver(pencil)
    # It is imported here for the time that sparse algebra takes to import.
    from beamdyn.modes.modal.large import LargeSolver

    return LargeSolver(pencil)


class UncoupledSolver(Eigensolver):
    """Eigensolver that solves parts of a pencil apart, such as two planes of a straight beam.

    Parameters
    ----------
    equations : Equations
        Equations that fall into parts.
    coordinates : ndarray of int, optional
        Coordinates that are kept, ascending; the others are 0.
    """

    def __init__(self, equations: Equations, coordinates: np.ndarray | None = None) -> None:
        self._equations, self._coordinates = equations, coordinates
        places, pencils = [equations.places(names) for names in equations.connected], equations.separate
        self.size = equations.size
        if coordinates is not None:
            number = np.full(equations.size, -1)
            number[coordinates] = np.arange(len(coordinates))
            kept = [number[part] >= 0 for part in places]
            places = [number[part][own] for part, own in zip(places, kept, strict=True)]
            own_pencils = zip(pencils, kept, strict=True)
            pencils = tuple(pencil.part(np.flatnonzero(own)) for pencil, own in own_pencils)
            self.size = len(coordinates)
        self.parts = tuple(places)
        self.solvers = tuple(map(solver_of_pencil, pencils))

    @cached_property
    def pencil(self) -> SteadyPencil:
        """All equations at steady speed."""
        pencil = self._equations.steady()
        return pencil if self._coordinates is None else pencil.part(self._coordinates)

    @property
    def conservative(self) -> bool:
        """Whether all parts are."""
        return all(solver.conservative for solver in self.solvers)

    def quotient_at_rest(self, v: np.ndarray) -> np.ndarray:
        """As of any solver, without a matrix of all parts."""
        each = [
            solver.energies_at_rest(v[:, part]) for part, solver in zip(self.parts, self.solvers, strict=True)
        ]
        stiffness, mass = np.sum(each, axis=0)
        return stiffness / mass

    @cached_property
    def lowest_at_rest(self) -> float:
        """The lowest of all parts."""
        return min(solver.lowest_at_rest for solver in self.solvers)

    @property
    def softening(self) -> float:
        """The largest of all parts."""
        return max(solver.softening for solver in self.solvers)

    @property
    def critical_rounding(self) -> float:
        """Rounding error of the softest part."""
        return max(self.solvers, key=lambda solver: solver.softening).critical_rounding

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """The lowest of the modes of all parts."""
        found = [solver.solve(speeds, min(count, solver.size)) for solver in self.solvers]
        vectors = []
        for part, eigen in zip(self.parts, found, strict=True):
            embedded = np.zeros((len(speeds), self.size, eigen.vector.shape[2]), dtype=eigen.vector.dtype)
            embedded[:, part] = eigen.vector
            vectors.append(embedded)
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
        """The lowest of those of all parts."""
        each = [solver.eigenvalues(speeds, min(count, solver.size)) for solver in self.solvers]
        together = np.concatenate(each, axis=1)
        return np.take_along_axis(together, _order(together)[:, :count], axis=1)

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """The sums of what the parts contribute."""
        each = zip(self.parts, self.solvers, strict=True)
        return np.sum([solver.solve_static(speeds, outputs[:, part]) for part, solver in each], axis=0)


def _order(eigenvalue: np.ndarray) -> np.ndarray:
    """Order (S, k) of eigenvalues by squared frequency, that of a growing mode being negative."""
    sign = np.where((np.imag(eigenvalue) == 0) & (np.real(eigenvalue) > 0), -1.0, 1.0)
    return np.argsort(sign * np.abs(eigenvalue) ** 2, axis=1, kind="stable")
