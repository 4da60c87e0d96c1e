"""Eigensolver for the few lowest modes of many coupled coordinates, a large block of a model's equations.

The modes are found by Lanczos iteration on the inverse problem (by Arnoldi iteration with damping or Coriolis
forces), with factorizations of the stiffness at each speed, in place of all eigenvalues of full matrices.

In shapes of arrays, n counts coordinates, and k modes.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from functools import cached_property

import numpy as np
from scipy.linalg import cho_factor, cho_solve
from scipy.sparse.linalg import ArpackError, LinearOperator, eigs, eigsh

from beamdyn.common.numerics import solve_lower, solve_lower_transposed
from beamdyn.modes.modal.diagonal_stiffness import LEAST_STIFFNESS
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver, Solver, explained, modes_of_factored
from beamdyn.modes.modal.quadratic_eigenproblem import select_lowest
from beamdyn.modes.modal.springs import solve_definite

_EPS = np.finfo(float).eps
_MORE = 2  # number of further modes sought, as not every real eigenvalue found belongs to a mode
_RESTARTS = 50  # largest number of restarts of the iteration, which converges after a few, if at all


class LargeSolver(Eigensolver):
    """Eigensolver for the lowest few modes of many coordinates, by Lanczos iteration.

    Where the stiffness is not safely positive definite, or the iteration does not converge, it uses
    `Solver`.
    """

    @cached_property
    def _at_rest(self) -> np.ndarray:
        """Cholesky factor of the stiffness at rest plus `pencil.shift` times the mass matrix."""
        with explained():
            return np.linalg.cholesky(self.pencil.K0 + self.pencil.shift * self.pencil.M)

    @cached_property
    def dense(self) -> Solver:
        """Eigensolver by full matrices, used where the iteration fails."""
        return Solver(self.pencil)

    @cached_property
    def lowest_at_rest(self) -> float:
        """Lowest squared angular frequency at rest plus the stiffness shift `pencil.shift` [rad2/s2]."""
        with suppress(ArpackError):
            return float(1 / self._largest(self._at_rest, 1)[0][0])
        return self.dense.lowest_at_rest

    @property
    def softening(self) -> float:
        """Largest relative loss of stiffness per squared speed [s2], from full matrices."""
        return self.dense.softening

    @property
    def critical_rounding(self) -> float:
        """Relative rounding error of the critical speed, from full matrices."""
        return self.dense.critical_rounding

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Compute the `count` lowest modes at each speed [rad/s], one speed after another."""
        each = [self._solve_at(speed, count) for speed in speeds]
        return Eigen(*(np.array(values) for values in zip(*each, strict=True)))

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """Compute linear functions of the coordinates in static equilibrium under the rotation.

        The stiffness is factorized at each speed: see `Eigensolver.solve_static`.
        """
        return np.array([solve_definite(self.pencil, speed) for speed in speeds]) @ outputs.T

    def _solve_at(self, speed: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute eigenvalues, vectors (in columns) and rounding errors at one speed."""
        with suppress(ArpackError):
            found = None if self.pencil.shift else self._lowest(speed, count)
            if found is not None:
                return found if self.pencil.conservative else self._lowest_coupled(speed, count)
        eigen = self.dense.solve(np.array([speed]), count)
        return eigen.eigenvalue[0], eigen.vector[0], eigen.rounding[0]

    # Conservative equations --------------------------------------------------------------------------

    def _lowest(self, speed: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray] | None:
        """Compute the lowest conservative modes; None unless the stiffness is safely positive definite."""
        try:
            L = np.linalg.cholesky(self.pencil.K0 + speed**2 * self.pencil.K2) if speed else self._at_rest
        except np.linalg.LinAlgError:
            return None
        mu, x = self._largest(L, count)
        if 1 / mu[0] < LEAST_STIFFNESS * self.lowest_at_rest:
            return None
        eigen = modes_of_factored(self.pencil, np.array([speed]), L, mu, x)
        return eigen.eigenvalue[0], eigen.vector[0], eigen.rounding[0]

    def _largest(self, L: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
        """Compute the largest eigenvalues of the mass matrix in the stiffness' Cholesky coordinates.

        The matrix is L^-1 M L^-T; eigenvalues descend, and the vectors are columns.
        """

        def product(x: np.ndarray) -> np.ndarray:
            half = solve_lower_transposed(L, x.reshape(len(L), -1))
            return solve_lower(L, self.pencil.M @ half).reshape(x.shape)

        start = np.random.default_rng(0).standard_normal(self.size)
        operator = _operator(product, self.size)
        mu, x = eigsh(operator, count, which="LA", v0=start, tol=0, maxiter=_RESTARTS)
        order = np.argsort(-mu)
        return mu[order], x[:, order]

    # Gyroscopic and damped equations -----------------------------------------------------------------

    def _lowest_coupled(self, speed: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Compute the lowest modes of damped or gyroscopic equations from the largest inverse eigenvalues."""
        n, M, C = self.size, self.pencil.M, self.pencil.C + speed * self.pencil.G
        factor = cho_factor(self.pencil.K0 + speed**2 * self.pencil.K2)
        time = np.sqrt(1 / self.lowest_at_rest)  # unit of time in which the frequencies are of order 1

        def product(y: np.ndarray) -> np.ndarray:
            q, v = y[:n], y[n:]
            force = C @ q / time + M @ v / time**2
            return np.concatenate([-cho_solve(factor, force, check_finite=False), q])

        start = np.random.default_rng(0).standard_normal(2 * n)
        sought = 2 * (count + _MORE)
        operator = _operator(product, 2 * n)
        inverse, y = eigs(operator, sought, which="LM", v0=start, tol=0, maxiter=_RESTARTS)
        s, q = select_lowest(inverse * time, y[:n], count)
        mass = np.sqrt(np.einsum("nk,nk->k", q.conj(), M @ q).real)
        rounding = 8 * _EPS * (np.abs(s) * np.abs(inverse).max() * time + self.size)
        return s, q / mass, rounding


def _operator(product: Callable[[np.ndarray], np.ndarray], size: int) -> LinearOperator:
    return LinearOperator((size, size), matvec=product, dtype=float)  # pyright: ignore[reportCallIssue]
