"""Eigensolvers of whole models: with uncoupled blocks, with many coordinates, and for many speeds.

The eigensolver is chosen by the equations, separately for each uncoupled block, such as one of two planes.

Modes over many speeds are interpolated between those at a few.  Without damping, squared frequencies are
smooth functions of the speed (without gyroscopic terms: of the squared speed), and so are the modes, except
at sharp veerings.  They are interpolated in Chebyshev points of an interval.  The error of the interpolant is
estimated by its coefficients of highest degree: while these exceed rounding, points are added; then the
interval is halved, until few speeds are left, which are solved individually.

In shapes of arrays, S counts speeds, n coordinates, and k modes.
"""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property

import numpy as np
from numpy.polynomial import chebyshev

from beamdyn.common.numerics import assign
from beamdyn.equations.equations_of_motion import Equations, SteadyPencil
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, Solver

LARGE = 256  # number of coordinates of a block above which only the lowest modes are computed


def solver_of(equations: Equations, coordinates: np.ndarray | None = None) -> Eigensolver:
    """Choose an eigensolver for equations at steady speed, which solves uncoupled blocks separately.

    If coordinates (ascending) are given, the others are fixed at 0.
    """
    if len(equations.connected) == 1:
        pencil = equations.steady()
        return solver_of_pencil(pencil if coordinates is None else pencil.part(coordinates))
    return UncoupledSolver(equations, coordinates)


def solver_of_pencil(pencil: SteadyPencil) -> Eigensolver:
    """Choose an eigensolver for equations at steady speed that form one coupled block."""
    if len(pencil.M) <= LARGE:
        return Solver(pencil)
    # Imported here, because sparse matrices are slow to import, and few models are so large.
    from beamdyn.modes.modal.large_parts import LargeSolver

    return LargeSolver(pencil)


class UncoupledSolver(Eigensolver):
    """Eigensolver that solves uncoupled blocks separately, such as two planes of a straight beam.

    Parameters
    ----------
    equations : Equations
        Equations that consist of uncoupled blocks.
    coordinates : ndarray of int, optional
        Coordinates that are free, ascending; the others are fixed at 0.
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
        """Equations at steady speed of all blocks together."""
        pencil = self._equations.steady()
        return pencil if self._coordinates is None else pencil.part(self._coordinates)

    @property
    def conservative(self) -> bool:
        """Whether no block has damping or gyroscopic terms."""
        return all(solver.conservative for solver in self.solvers)

    def energies_at_rest(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute v K v and v M v of each row v, with the stiffness K at rest and the mass matrix M."""
        parts = zip(self.parts, self.solvers, strict=True)
        stiffness, mass = np.sum([solver.energies_at_rest(v[:, part]) for part, solver in parts], axis=0)
        return stiffness, mass

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest of all blocks plus the shift `pencil.shift` [rad2/s2]."""
        return min(solver.lowest_at_rest for solver in self.solvers)

    @property
    def softening(self) -> float:
        """Largest relative loss of stiffness per squared speed of all blocks [s2]."""
        return max(solver.softening for solver in self.solvers)

    @property
    def critical_rounding(self) -> float:
        """Relative rounding error of the critical speed, from the block with the lowest critical speed."""
        return max(self.solvers, key=lambda solver: solver.softening).critical_rounding

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes of all blocks at each speed [rad/s]."""
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
        """Compute the `count` lowest eigenvalues of all blocks at each speed [rad/s]."""
        each = [solver.eigenvalues(speeds, min(count, solver.size)) for solver in self.solvers]
        together = np.concatenate(each, axis=1)
        return np.take_along_axis(together, _order(together)[:, :count], axis=1)

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in static equilibrium under rotation.

        They are summed over all blocks; for the parameters see `Eigensolver.solve_static`.
        """
        each = zip(self.parts, self.solvers, strict=True)
        return np.sum([solver.solve_static(speeds, outputs[:, part]) for part, solver in each], axis=0)


def _order(eigenvalue: np.ndarray) -> np.ndarray:
    """Order eigenvalues of each speed by squared frequency, which is negative for a growing mode."""
    sign = np.where((np.imag(eigenvalue) == 0) & (np.real(eigenvalue) > 0), -1.0, 1.0)
    return np.argsort(sign * np.abs(eigenvalue) ** 2, axis=1, kind="stable")


# Many speeds -----------------------------------------------------------------------------------------

_FEW = 160  # largest number of speeds that are solved individually
_INTERVALS = 8, 16, 32  # numbers of intervals between Chebyshev points of the speed, tried in turn
# The last 1/3 of the coefficients of a Chebyshev series is checked: they are small if the series converges
# fast enough.
_HIGHEST = 3
# Allowed interpolation error of squared frequencies in addition to rounding; the stated error includes it.
_MISFIT = 1e-12
# Allowed interpolation error of modes, divided by their largest coordinate; interpolated modes are used only
# to follow the modes over speed.
_MISFIT_OF_MODES = 1e-7
_LEBESGUE = 3.0  # growth of rounding errors by interpolation: the Lebesgue constant of 17 to 33 points

Solve = Callable[[np.ndarray], Eigen]  # a function that computes modes at given speeds [rad/s]


def solve_over_speeds(solver: Eigensolver, speeds: np.ndarray, count: int) -> Eigen:
    """Compute the `count` lowest modes at speeds [rad/s], as `Eigensolver.solve` does."""
    if len(speeds) <= _FEW or solver.pencil.C.any():
        return solver.solve(speeds, count)
    return _solve_over(solver, speeds, lambda some: solver.solve(some, count))


def eigenvalues_over_speeds(solver: Eigensolver, speeds: np.ndarray, count: int) -> np.ndarray:
    """Compute the eigenvalues of the `count` lowest modes at each speed: (speeds, count).

    They are nan at speeds at which a beam with large deflection has no equilibrium.
    """

    def solve(some: np.ndarray) -> Eigen:
        found = solver.solve(some, count)
        return Eigen(found.eigenvalue, found.vector[:, :0], found.rounding)

    try:
        if len(speeds) <= _FEW:
            return solver.eigenvalues(speeds, count)
        return (solve(speeds) if solver.pencil.C.any() else _solve_over(solver, speeds, solve)).eigenvalue
    except ArithmeticError:  # `NoEquilibrium`, whose module few scenes need
        if len(speeds) == 1:
            return np.full((1, min(count, solver.size)), np.nan)
        return np.concatenate([eigenvalues_over_speeds(solver, each[None], count) for each in speeds])


def _solve_over(solver: Eigensolver, speeds: np.ndarray, solve: Solve) -> Eigen:
    """Compute modes at speeds of either sign; for reversed rotation, gyroscopic modes are conjugate.

    A growing mode corresponds to a decaying one in reversed rotation, which was not computed: such speeds are
    solved individually.
    """
    # Both directions of rotation have the same frequencies.
    sizes, place = np.unique(np.abs(speeds), return_inverse=True)
    found, backwards = _solve_ascending(solver, sizes, solve), speeds < 0
    if len(sizes) < len(speeds) or backwards.any():
        found = Eigen(found.eigenvalue[place], found.vector[place], found.rounding[place])
    if not np.iscomplexobj(found.vector):
        return found
    vector = np.where(backwards[:, None, None], found.vector.conj(), found.vector)
    turned = Eigen(found.eigenvalue.copy(), vector, found.rounding.copy())
    growing = backwards & (np.real(found.eigenvalue) != 0).any(axis=1)
    if growing.any():
        each = solve(speeds[growing])
        turned.eigenvalue[growing], turned.vector[growing] = each.eigenvalue, each.vector
        turned.rounding[growing] = each.rounding
    return turned


def _solve_ascending(solver: Eigensolver, speeds: np.ndarray, solve: Solve) -> Eigen:
    """Compute modes at ascending speeds from 0 by interpolation, with Chebyshev points doubled as needed.

    Modes are smooth functions of the speed; without gyroscopic terms, of the squared speed.
    """
    power = 2 if solver.conservative else 1
    known, (low, high) = None, speeds[[0, -1]] ** power
    if len(speeds) <= _FEW or low == high:  # squares of the slowest speeds are 0
        return solve(speeds)
    for intervals in _INTERVALS:
        nodes = np.clip(low + (high - low) * (1 + _nodes(intervals)) / 2, low, high) ** (1 / power)
        if known is None:
            known = solve(nodes)
        else:
            between, places = solve(nodes[1::2]), np.arange(1, len(known.eigenvalue))
            known = Eigen(
                np.insert(known.eigenvalue, places, between.eigenvalue, axis=0),
                np.insert(known.vector, places, between.vector, axis=0),
                np.insert(known.rounding, places, between.rounding, axis=0),
            )
        if (found := _interpolate(solver, known, speeds, power)) is not None:
            return found
    return Eigen.joined(_solve_ascending(solver, part, solve) for part in np.array_split(speeds, 2))


def _nodes(intervals: int) -> np.ndarray:
    """Compute the Chebyshev points of the interval [-1, 1], including both ends, ascending."""
    return -np.cos(np.pi * np.arange(intervals + 1) / intervals)


def _interpolate(solver: Eigensolver, eigen: Eigen, speeds: np.ndarray, power: int) -> Eigen | None:
    """Interpolate modes at ascending speeds from Chebyshev points of speed^`power`; None if inaccurate."""
    if (np.real(eigen.eigenvalue) * np.imag(eigen.eigenvalue)).any():  # flutter is not interpolated
        return None
    points, count = eigen.eigenvalue.shape
    (low, high), t = speeds[[0, -1]] ** power, _nodes(points - 1)
    squared, vector = np.real(-(eigen.eigenvalue**2)), _align(eigen.vector, solver.pencil.M)
    at_nodes = np.concatenate([squared, vector.reshape(points, -1)], axis=1)
    series = np.linalg.solve(chebyshev.chebvander(t, points - 1), at_nodes)
    misfit = np.abs(series[-(points // _HIGHEST) :]).sum(axis=0)
    # Relative errors: 0 for values that are 0 at all speeds; inf for a value that is 0 at only one of them.
    size, of_squares = np.abs(squared).min(axis=0), np.where(misfit[:count] > 0, np.inf, 0.0)
    np.divide(misfit[:count], size, out=of_squares, where=size > 0)
    of_modes = misfit[count:].max(initial=0.0) <= _MISFIT_OF_MODES * np.abs(vector).max(initial=0.0)
    if not (of_modes and (of_squares <= _MISFIT + eigen.rounding.min(axis=0)).all()):
        return None
    values = chebyshev.chebvander(2 * (speeds**power - low) / (high - low) - 1, points - 1) @ series
    squares = np.real(values[:, :count])
    root = np.sqrt(np.abs(squares))
    return Eigen(
        eigenvalue=np.where(squares > 0, 1j * root, root),
        vector=values[:, count:].reshape(len(speeds), -1, count),
        rounding=np.tile(_LEBESGUE * eigen.rounding.max(axis=0) + of_squares, (len(speeds), 1)),
    )


def _align(vector: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Give modes (speeds, coordinates, modes) consistent signs, or consistent phases if complex."""
    if not vector.size:
        return vector
    products = np.einsum("snk,snk->sk", vector[:-1], mass @ vector[1:].conj())
    size = np.abs(products)
    turns = np.where(size > 0, products / np.where(size > 0, size, 1.0), 1.0)
    return np.concatenate([vector[:1], vector[1:] * np.cumprod(turns, axis=0)[:, None, :]])


_NORMALIZED = 2e-6  # difference of a squared norm from 1 that counts as rounding


def track(vectors: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Follow modes from each speed to the next by the modal assurance criterion (MAC).

    Parameters
    ----------
    vectors : ndarray, shape (speeds, coordinates, modes)
        Mode vectors at each speed, by ascending frequency; mass-normalised, or nearly so if the mass matrix
        varies with the speed.
    mass : ndarray, shape (coordinates, coordinates)
        Mass matrix.

    Returns
    -------
    order : ndarray of int, shape (speeds, modes)
        ``order[s, i]`` is the index at speed s of the mode that is the i-th at the first speed.
    confidence : ndarray, shape (speeds, modes)
        MAC with the same mode at the speed before, minus the largest MAC of that mode with any other: 1
        is certain, 0 or less a guess.
    """
    weighted = mass @ vectors
    squares = np.einsum("snk,snk->sk", vectors.conj(), weighted).real
    squares = np.where(np.abs(squares - 1) < _NORMALIZED, 1.0, squares)
    mac = np.abs(np.swapaxes(vectors[:-1].conj(), 1, 2) @ weighted[1:]) ** 2
    mac /= squares[:-1, :, None] * squares[1:, None, :]
    S, _, k = vectors.shape
    order, confidence = np.tile(np.arange(k), (S, 1)), np.ones((S, k))
    # Index of each mode at the next speed.  If this is no permutation, the one with the largest sum of MACs.
    successor = mac.argmax(axis=2)
    unique = (np.sort(successor, axis=1) == np.arange(k)).all(axis=1)
    for s in np.flatnonzero(~unique):
        successor[s] = assign(-mac[s])
    for s in np.flatnonzero((successor != np.arange(k)).any(axis=1)):
        order[s + 1 :] = successor[s][order[s]]  # valid until the next exchange of modes
    matched = np.take_along_axis(mac, successor[:, :, None], axis=2)[:, :, 0]
    others = mac.copy()
    np.put_along_axis(others, successor[:, :, None], -1.0, axis=2)
    margin = matched - others.max(axis=2, initial=0.0)
    confidence[1:] = np.take_along_axis(margin, order[:-1], axis=1)
    return order, confidence
