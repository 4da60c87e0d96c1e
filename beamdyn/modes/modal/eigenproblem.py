"""Eigenvalues and modes of the equations of motion at steady speed, for a batch of speeds.

The inverse problem M v = mu K v is solved: its largest eigenvalues mu belong to the lowest modes, and keep
all digits whatever the size of the basis.  For one speed, the stiffness is factorized.  For many speeds,
coordinates are used in which the stiffness is diagonal at every speed; these require an additional
eigenproblem, which for one speed would be most of the work (`diagonal_stiffness`).

In shapes of arrays, S counts speeds, n coordinates, and k modes.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from functools import cached_property
from typing import TypeAlias

import numpy as np
from scipy.linalg.lapack import dpotrf, dsyevd, dsyevr

from beamdyn.common.numerics import solve_lower, solve_lower_transposed
from beamdyn.equations.equations_of_motion import BACKWARD, ROUNDING_SIZE, SteadyPencil
from beamdyn.modes.modal import springs
from beamdyn.modes.modal.diagonal_stiffness import (
    LEAST_STIFFNESS,
    above_rounding,
    forward_error,
    inverse_squares,
    rounding_of_matrices,
    rounding_of_scene,
    solve_diagonal,
)
from beamdyn.modes.modal.quadratic_eigenproblem import (
    condense,
    has_massless,
    select_lowest,
    solve_first_order,
    solve_general,
    solve_gyroscopic,
)

_EPS = np.finfo(float).eps

# Cholesky factor L (n, n) of a stiffness, and the mass in its coordinates, L^-1 M L^-T.
Factored: TypeAlias = tuple[np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class Eigen:
    """Lowest k modes at each of S speeds.

    Parameters
    ----------
    eigenvalue : ndarray, shape (S, k)
        Eigenvalues s of q = v exp(s t) [1/s]: from each conjugate pair the one with Im s > 0, from each real
        pair the larger.
    vector : ndarray, shape (S, coordinates, k)
        Mass-normalised eigenvectors v; real if the equations are conservative.
    rounding : ndarray, shape (S, k)
        Estimated relative rounding error of |s|.
    """

    eigenvalue: np.ndarray
    vector: np.ndarray
    rounding: np.ndarray

    @classmethod
    def joined(cls, parts: Iterable[Eigen]) -> Eigen:
        """Join the modes at several batches of speeds."""
        values = zip(*((p.eigenvalue, p.vector, p.rounding) for p in parts), strict=True)
        return cls(*map(np.concatenate, values))


class Eigensolver(ABC):
    """Base class of solvers that compute eigenvalues and modes of one beam at any steady speed.

    Parameters
    ----------
    pencil : SteadyPencil
        Equations of motion in n coordinates, whose matrices depend on the speed.
    """

    def __init__(self, pencil: SteadyPencil) -> None:
        self.pencil, self.size = pencil, len(pencil.M)

    @property
    def conservative(self) -> bool:
        """Whether the equations have neither damping nor gyroscopic terms, so that the modes are real."""
        return self.pencil.conservative

    def energies_at_rest(self, v: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Compute v K v and v M v of each row v, with the stiffness K at rest and the mass matrix M."""
        return np.real(np.vecdot(v, v @ self.pencil.K0)), np.real(np.vecdot(v, v @ self.pencil.M))

    @cached_property
    @abstractmethod
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest plus the stiffness shift `pencil.shift` [rad2/s2]."""

    @property
    @abstractmethod
    def softening(self) -> float:
        """Largest relative loss of stiffness per squared speed [s2]; 0 if it is within rounding errors."""

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the stiffness is singular [rad/s]; inf if there is none."""
        return self.softening**-0.5 if self.softening else np.inf

    @property
    @abstractmethod
    def critical_rounding(self) -> float:
        """Estimated relative rounding error of the critical speed."""

    @abstractmethod
    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s].

        Raises
        ------
        LinAlgError
            If stiffness and mass span more digits than double precision has (a ValueError).
        """

    def eigenvalues(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Compute the eigenvalues of the `count` lowest modes at each speed [rad/s], shape (S, count)."""
        return self.solve(speeds, count).eigenvalue

    @abstractmethod
    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in static equilibrium under rotation.

        Parameters
        ----------
        speeds : ndarray, shape (S,)
            Speeds [rad/s].
        outputs : ndarray, shape (outputs, coordinates)
            Coefficients of the functions, such as the tip deflections per unit coordinate.

        Returns
        -------
        ndarray, shape (S, outputs)
            Values of the functions; nan at and above the critical speed.
        """


class Solver(Eigensolver):
    """Eigensolver by full matrices, which computes all modes.

    For many speeds it uses coordinates in which the stiffness is diag(1 + speed^2 growth), minus
    `pencil.shift` times the mass matrix.
    """

    _factored: tuple[float, Factored | None] = np.nan, None  # the last speed [rad/s] with its factorization

    @cached_property
    def _at_rest(self) -> np.ndarray:
        """Cholesky factor of the stiffness at rest plus `pencil.shift` times the mass matrix."""
        K0, M, shift = self.pencil.K0, self.pencil.M, self.pencil.shift
        with explained():
            return np.linalg.cholesky(K0 + shift * M if shift else K0)

    @cached_property
    def _diagonal(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Growth of a diagonal stiffness per squared speed; basis and mass matrix of its coordinates."""
        L = self._at_rest
        K2, M = (_symmetric(transformed(L, A)) for A in (self.pencil.K2, self.pencil.M))
        growth, Q = np.linalg.eigh(K2)
        return growth, solve_lower_transposed(L, Q), _symmetric(Q.T @ M @ Q)

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest plus the stiffness shift `pencil.shift` [rad2/s2]."""
        return float(1 / np.linalg.eigvalsh(transformed(self._at_rest, self.pencil.M), UPLO="U")[-1])

    @property
    def softening(self) -> float:
        """Largest relative loss of stiffness per squared speed [s2]; 0 if it is within rounding errors."""
        return self._softening[0]

    @property
    def critical_rounding(self) -> float:
        """Relative rounding error of the critical speed, from that of the growth of the stiffness."""
        return self._softening[1]

    @cached_property
    def _softening(self) -> tuple[float, float]:
        if self.pencil.shift:
            if (found := springs.softening_of_graded(self.pencil)) is not None:
                return found
            growth, _, mass = self._diagonal
            return springs.softening_on_springs(mass, growth, self.pencil.shift)
        growth = self._diagonal[0]
        lowest, lost = -float(growth[0]), 2 * BACKWARD * np.abs(growth).max()
        return (lowest, float(lost / lowest)) if lowest > lost else (0.0, np.inf)

    def factor(self, speeds: np.ndarray) -> Factored | None:
        """Factor the stiffness of conservative equations at one speed [rad/s] as L L^T.

        The result is L, and L^-1 M L^-T of the mass matrix M; None for more speeds, or if the stiffness is
        below `LEAST_STIFFNESS` times that at rest.
        """
        if len(speeds) > 1 or self.pencil.shift or not self.pencil.conservative:
            return None
        last, found = self._factored
        if last != speeds[0]:
            K0, spin = self.pencil.K0, speeds[0] ** 2 * self.pencil.K2
            upper, failed = dpotrf((K0 + spin).T)
            unsafe = failed or dpotrf(((1 - LEAST_STIFFNESS) * K0 + spin).T)[1]
            found = None if unsafe else (upper.T, transformed(upper.T, self.pencil.M))
            self._factored = speeds[0], found
        return found

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed; if conservative, for all speeds at once."""
        with explained():
            if not self.pencil.conservative:
                modes = [self._solve_coupled(speed, count) for speed in speeds]
                return Eigen(*(np.array(values) for values in zip(*modes, strict=True)))
            if (factored := self.factor(speeds)) is None:
                return self._solve_diagonal(speeds, count)
            mu, y, _, _, failed = dsyevr(factored[1], range="I", il=self.size - count + 1, iu=self.size)
            if failed:
                raise np.linalg.LinAlgError
            mu = above_rounding(mu[:count][::-1])
            return modes_of_factored(self.pencil, speeds, factored[0], mu, y[:, ::-1])

    def eigenvalues(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Compute the eigenvalues at each speed, without vectors where conservative equations allow it."""
        if (factored := self.factor(speeds)) is not None:
            mu, _, failed = dsyevd(factored[1], compute_v=0)
            if failed:
                raise np.linalg.LinAlgError
            return 1j / np.sqrt(above_rounding(mu[: -count - 1 : -1]))[None]
        growth, _, mass = self._diagonal
        stiffness = 1 + speeds[:, None] ** 2 * growth
        if not self.pencil.conservative or stiffness.min() < LEAST_STIFFNESS or self.pencil.shift:
            return self.solve(speeds, count).eigenvalue
        return 1j / np.sqrt(inverse_squares(mass, stiffness, count))

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in static equilibrium under rotation.

        One speed uses a factorization, several use coordinates in which the stiffness is diagonal; for the
        parameters see `Eigensolver.solve_static`.
        """
        if self.pencil.shift:
            return np.array([springs.solve_definite(self.pencil, speed) for speed in speeds]) @ outputs.T
        if (factored := self.factor(speeds)) is not None:
            L, load = factored[0], speeds[0] ** 2 * self.pencil.f2
            return (outputs @ solve_lower_transposed(L, solve_lower(L, load[:, None]))[:, 0])[None]
        growth, basis, _ = self._diagonal
        stiffness = 1 + speeds[:, None] ** 2 * growth
        with np.errstate(divide="ignore", invalid="ignore"):
            q = (basis.T @ self.pencil.f2) * speeds[:, None] ** 2 / stiffness
            values = np.stack([q @ (basis.T @ output) for output in outputs], axis=1)
        return np.where(stiffness.min(axis=1, keepdims=True) > 0, values, np.nan)

    def _solve_diagonal(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute modes of conservative equations in coordinates in which the stiffness is diagonal."""
        growth, basis, mass = self._diagonal
        spin = speeds[:, None] ** 2
        squared, z, rounding = solve_diagonal(mass, 1 + spin * growth, count, self.lowest_at_rest)
        vector = basis @ z
        terms, size = 1 + spin * np.abs(growth), np.abs(vector)
        by_matrices = rounding_of_matrices(terms, squared, z, size, np.abs(self.pencil.M))
        rounding += rounding_of_scene(self.pencil, speeds, squared, size, by_matrices)
        if self.pencil.shift:
            squared, rounding = springs.remove_shift(self.pencil, speeds, squared, vector, rounding)
            vector = springs.part_free_turns(self.pencil, squared, vector)
        root = np.sqrt(np.abs(squared))
        eigenvalue = np.where(squared > 0, 1j * root, root)
        return Eigen(eigenvalue, vector, np.where(squared == 0, np.inf, rounding))

    # Gyroscopic and damped equations ----------------------------------------------------------------

    @cached_property
    def _has_massless(self) -> bool:
        return has_massless(self._diagonal[2])

    def _solve_coupled(self, speed: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute eigenvalues, vectors (in columns) and rounding errors of damped or gyroscopic beams."""
        pencil, n = self.pencil, self.size
        on_springs = pencil.shift and not pencil.C.any() and not self._has_massless
        if on_springs and (graded := springs.factor_graded(pencil, speed)):
            return self._solve_graded(speed, count, *graded)
        growth, T, mass = self._diagonal
        stiffness = 1 + speed**2 * growth
        damping = T.T @ (pencil.C + speed * pencil.G) @ T
        time = np.sqrt(1 / self.lowest_at_rest)  # unit of time in which the frequencies are of order 1
        if pencil.shift or self._has_massless or not stiffness.all():
            K = np.diag(stiffness) - pencil.shift * mass
            R = condense(mass, K) if self._has_massless else np.eye(n)
            inverse, y = solve_first_order(*(R.T @ A @ R for A in (mass / time**2, damping / time, K)))
            y = R @ y[: R.shape[1]]
        elif pencil.C.any() or stiffness.min() <= 0:
            inverse, y = solve_general(mass / time**2, damping / time, stiffness)
        else:
            inverse, y = solve_gyroscopic(mass / time**2, damping / time, stiffness, count)
        turns = np.empty((n, 0))  # rotations about hinges on which no stiffness acts
        if pencil.shift:
            undamped = self._solve_diagonal(np.array([speed]), min(pencil.planes, n))
            turns, rates = springs.find_free_turns(pencil, undamped.eigenvalue[0], undamped.vector[0])
            others = springs.other_eigenvalues(inverse, rates * time)
            inverse, y = inverse[others], y[:, others]
        s, z = select_lowest(inverse * time, y[:n], count)
        norm = np.sqrt(np.maximum(np.einsum("nk,nm,mk->k", z.conj(), mass, z).real, 0.0))
        condition = (1 + speed**2 * np.abs(growth)).max() / max(np.abs(stiffness).min(), _EPS)
        rounding = 8 * _EPS * (np.abs(s) * np.abs(inverse).max() * time + condition)
        lost = norm == 0  # the modal mass is below rounding, so the mode is unknown
        modes = s, T @ (z / np.where(lost, np.inf, norm)), np.where(lost, np.inf, rounding)
        return springs.insert_free_turns(turns, *modes, count) if turns.size else modes

    def _solve_graded(
        self, speed: float, count: int, basis: np.ndarray, condition: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute gyroscopic modes of a beam on root springs, in a `basis` with unit stiffness matrix.

        `condition` is the condition number of the scaled stiffness, on which rounding errors depend.  Returns
        eigenvalues, vectors (in columns) and rounding errors.
        """
        M, C = (basis.T @ A @ basis for A in (self.pencil.M, speed * self.pencil.G))
        time = np.sqrt(np.trace(M) / len(M))
        inverse, y = solve_gyroscopic(M / time**2, C / time, np.ones(len(M)), count)
        s, z = select_lowest(inverse * time, y[: len(M)], count)
        norm = np.sqrt(np.einsum("nk,nm,mk->k", z.conj(), M, z).real)
        rounding = 8 * _EPS * (np.abs(s) * np.abs(inverse).max() * time + condition)
        return s, basis @ (z / norm), rounding


class LeadingSolver(Solver):
    """Eigensolver for the first coordinates of another solver, with the other coordinates fixed at 0.

    It reuses the leading blocks of the other solver's factors.

    Parameters
    ----------
    whole : Solver
        Eigensolver of all coordinates.
    size : int
        Number of coordinates that are kept.
    """

    def __init__(self, whole: Solver, size: int) -> None:
        self._whole, self.size = whole, size

    @cached_property
    def pencil(self) -> SteadyPencil:
        """Equations at steady speed of the coordinates that are kept."""
        return self._whole.pencil.part(np.arange(self.size))

    def factor(self, speeds: np.ndarray) -> Factored | None:
        """Take the leading blocks of the factors of all coordinates: see `Solver.factor`."""
        factored, n = self._whole.factor(speeds), self.size
        return factored and (factored[0][:n, :n], factored[1][:n, :n])


class LoadedSolver(Solver):
    """Eigensolver for a stiffness that a tip load may make indefinite and not symmetric."""

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the stiffness is singular [rad/s]; 0 if it is so at rest, within rounding."""
        try:
            return super().critical_speed
        except np.linalg.LinAlgError:
            return 0.0

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Solve the eigenproblem for one speed after the other, by the inverse of the stiffness."""
        modes = [self._solve_loaded(speed, count) for speed in speeds]
        return Eigen(*(np.array(values) for values in zip(*modes, strict=True)))

    def _solve_loaded(self, speed: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute eigenvalues, vectors (in columns) and rounding errors at one speed."""
        pencil, M = self.pencil, self.pencil.M
        K, C = pencil.K0 + speed**2 * pencil.K2, pencil.C + speed * pencil.G
        by_mass = np.linalg.solve(K, M)
        mu, y = np.linalg.eig(by_mass)
        time = np.sqrt(np.abs(mu).max())  # unit of time in which the frequencies are of order 1
        inverse, y = np.concatenate([r := np.sqrt(-mu + 0j) / time, -r]), np.concatenate([y, y], axis=1)
        if C.any():
            inverse, y = solve_general(by_mass / time**2, np.linalg.solve(K, C) / time, np.ones(self.size))
        # Omit eigenvalues of very high modes, which are rounding errors.
        lost = np.abs(inverse) < np.sqrt(self.size * _EPS)
        s, z = select_lowest(inverse[~lost] * time, y[: self.size, ~lost], count)
        norm = np.sqrt(np.einsum("nk,nm,mk->k", z.conj(), M, z).real)
        return s + 0.0, z / norm, 8 * _EPS * self.size * np.abs(s) * np.abs(inverse).max() * time


@contextmanager
def explained() -> Iterator[None]:
    """Add an explanation to the error message of a factorization that fails within this context."""
    try:
        yield
    except np.linalg.LinAlgError as error:
        raise np.linalg.LinAlgError(
            "stiffness, mass and speed span more digits than double precision has: give a lower speed, "
            "a smaller tip inertia, or properties and breakpoints that vary less"
        ) from error


def transformed(L: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Compute L^-1 A L^-T for triangular L and symmetric A; the result is symmetric except for rounding."""
    return solve_lower(L, solve_lower(L, A).T)


def _symmetric(A: np.ndarray) -> np.ndarray:
    return (A + A.T) / 2


def modes_of_factored(
    pencil: SteadyPencil, speeds: np.ndarray, L: np.ndarray, mu: np.ndarray, y: np.ndarray
) -> Eigen:
    """Build the modes of a clamped beam at one speed, and estimate the rounding errors of its frequencies.

    Parameters
    ----------
    pencil : SteadyPencil
        Equations whose stiffness was factored at the speed.
    speeds : ndarray, shape (1,)
        The speed [rad/s].
    L : ndarray, shape (coordinates, coordinates)
        Cholesky factor of the stiffness.
    mu, y : ndarray, shapes (k,) and (coordinates, k)
        Largest eigenvalues, descending, and eigenvectors of L^-1 M L^-T.
    """
    v, squared = solve_lower_transposed(L, y) / np.sqrt(mu), 1 / mu
    size = np.abs(v.T)
    spin = speeds[0] ** 2 * np.vecdot(size, size @ np.abs(pencil.K2))
    by_terms = (np.vecdot(v.T, v.T @ pencil.K0) + spin) / squared
    mass = np.vecdot(size, size @ np.abs(pencil.M))  # modal mass, if no terms cancelled
    growth = max(1.0, len(v) / ROUNDING_SIZE)  # rounding errors accumulate over the functions
    by_matrices = growth * (BACKWARD * (by_terms + np.sqrt(by_terms)) + _EPS * mass)
    rounding = rounding_of_scene(pencil, speeds, squared[None], size.T[None], by_matrices[None])
    return Eigen(1j * np.sqrt(squared)[None], v[None], forward_error(mu) + rounding)
