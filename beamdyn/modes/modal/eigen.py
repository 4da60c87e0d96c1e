"""Eigenvalues and modes of the equations at steady speed, for a batch of speeds.

In coordinates in which the stiffness is diagonal at every speed, the inverse problem M v = mu K v is solved:
the lowest modes are then those of the largest eigenvalues mu, which keep all digits whatever the size of the
basis.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from functools import cached_property

import numpy as np
import scipy.linalg

from beamdyn.common.triangular import solve_lower, solve_lower_transposed
from beamdyn.equations.equations_of_motion import BACKWARD, ROUNDING_SIZE, SteadyPencil
from beamdyn.modes.modal.eigensolver import Eigen, Eigensolver
from beamdyn.modes.modal.massless import condense, has_massless
from beamdyn.modes.modal.one_speed import (
    factor_stiffness,
    largest_modes,
    largest_values,
    rounding_of_factored,
    static_coordinates,
    transformed,
)
from beamdyn.modes.modal.springs import (
    factor_graded,
    find_free_turns,
    insert_free_turns,
    leave_out_slowest,
    part_free_turns,
    remove_shift,
    softening_of_graded,
    softening_on_springs,
    solve_definite,
    solve_first_order,
)

_EPS = np.finfo(float).eps
# Rounding errors beyond those of `beamdyn.equations.rounding`.
_TWO_PLANES, _ON_SPRINGS = 3.0, 2.0  # their rounding over that of one clamped plane, on random scenes
_CANCELLED = 0.5 * _EPS  # error by entries of the stiffness that cancel where twist couples two planes
_FORWARD = 0.5 * _EPS  # error of mu relative to the largest mu; five times the error measured at mode 100
LEAST_STIFFNESS = 0.1  # relative to the stiffness at rest: below it the eigenproblem is shifted
_LARGEST_SHIFT = 256  # largest exponent of 4 of a shift: beyond it numbers overflow
_LARGEST_BATCHED = 64  # size of matrices up to which one batched call computes all eigenvectors
_REAL = 1e-8  # relative growth rate of a mode below which it counts as stable: rounding of a double root


class Solver(Eigensolver):
    """Eigensolver by full matrices, for all modes.

    For many speeds it has coordinates of its own, in which K = diag(1 + speed^2 growth), minus `pencil.shift`
    times the mass; conservative equations at one speed are solved by a factorization of the stiffness there.

    Parameters
    ----------
    pencil : SteadyPencil
        Equations at steady speed.
    """

    def __init__(self, pencil: SteadyPencil) -> None:
        self.pencil = pencil

    @cached_property
    def _at_rest(self) -> np.ndarray:
        """Cholesky factor (n, n) of the stiffness at rest, with the shift."""
        with explained():
            return np.linalg.cholesky(_shifted_stiffness(self.pencil))

    @cached_property
    def _diagonal(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        L = self._at_rest
        growth, Q = np.linalg.eigh(_transform_by_inverse(L, self.pencil.K2))
        mass = _symmetrize(Q.T @ _transform_by_inverse(L, self.pencil.M) @ Q)
        return growth, solve_lower_transposed(L, Q), mass

    @property
    def growth(self) -> np.ndarray:
        """Stiffness per squared speed (n,), in coordinates in which it is diagonal at every speed."""
        return self._diagonal[0]

    @property
    def basis(self) -> np.ndarray:
        """Coordinates of the pencil per coordinate of these (n, n)."""
        return self._diagonal[1]

    @property
    def mass(self) -> np.ndarray:
        """Mass matrix (n, n) in these."""
        return self._diagonal[2]

    @cached_property
    def lowest_at_rest(self) -> float:
        """By the largest eigenvalue of the inverse problem."""
        return float(1 / largest_values(transformed(self._at_rest, self.pencil.M), 1)[0])

    @property
    def softening(self) -> float:
        """By the lowest growth of the stiffness; on springs, without that of the shift."""
        if self.pencil.shift:
            return self._softening_on_springs[0]
        lowest = -float(self.growth[0])
        return lowest if lowest > 2 * BACKWARD * np.abs(self.growth).max() else 0.0

    @property
    def critical_rounding(self) -> float:
        """That of the softening, which is relative to the largest growth."""
        if self.pencil.shift:
            return self._softening_on_springs[1]
        softening = self.softening
        return float(2 * BACKWARD * np.abs(self.growth).max() / softening) if softening else np.inf

    @cached_property
    def _softening_on_springs(self) -> tuple[float, float]:
        if (found := softening_of_graded(self.pencil)) is not None:
            return found
        return softening_on_springs(self.mass, self.growth, self.pencil.shift)

    @cached_property
    def _has_massless(self) -> bool:
        return has_massless(self.mass)

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """Conservative equations for all speeds at once, others speed by speed."""
        with explained():
            if self.pencil.conservative:
                return self._solve_conservative(speeds, count)
            modes = [self._solve_coupled(speed, count) for speed in speeds]
        return Eigen(*(np.array(values) for values in zip(*modes, strict=True)))

    def eigenvalues(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Without vectors where the equations are conservative, and stiff at each speed."""
        if (L := self._factor(speeds)) is not None:
            mu = _above_rounding(largest_values(transformed(L, self.pencil.M), count))
            return 1j / np.sqrt(mu)[None]
        stiffness = 1 + speeds[:, None] ** 2 * self.growth
        if not self.pencil.conservative or stiffness.min() < LEAST_STIFFNESS or self.pencil.shift:
            return self.solve(speeds, count).eigenvalue
        return 1j / np.sqrt(inverse_squares(self.mass, stiffness, count))

    def solve_static(self, speeds: np.ndarray, outputs: np.ndarray) -> np.ndarray:
        """By a factorization at one speed, else in the coordinates of the solver: each is by itself."""
        if self.pencil.shift:
            return np.array([solve_definite(self.pencil, speed) for speed in speeds]) @ outputs.T
        if (L := self._factor(speeds)) is not None:
            return (outputs @ static_coordinates(L, speeds[0] ** 2 * self.pencil.f2))[None]
        stiffness = 1 + speeds[:, None] ** 2 * self.growth
        with np.errstate(divide="ignore", invalid="ignore"):
            q = (self.basis.T @ self.pencil.f2) * speeds[:, None] ** 2 / stiffness
        values = np.stack([q @ (self.basis.T @ output) for output in outputs], axis=1)
        return np.where(stiffness.min(axis=1, keepdims=True) > 0, values, np.nan)

    # Conservative equations: a real symmetric problem -----------------------------------------------

    def _factor(self, speeds: np.ndarray) -> np.ndarray | None:
        """Factor of the stiffness at one speed, which is safely positive there; else None."""
        if len(speeds) > 1 or self.pencil.shift or not self.pencil.conservative:
            return None
        return factor_stiffness(self.pencil, speeds[0], LEAST_STIFFNESS)

    def _solve_factored(self, L: np.ndarray, speed: float, count: int) -> Eigen:
        """Modes at one speed by the factor of the stiffness there."""
        mu, y = largest_modes(transformed(L, self.pencil.M), count)
        mu = _above_rounding(mu)
        v = solve_lower_transposed(L, y) / np.sqrt(mu)
        size, squared = np.abs(v), 1 / mu
        found = squared[None], size[None], rounding_of_factored(self.pencil, speed, squared, v, size)[None]
        rounding = forward_error(mu) + rounding_of_scene(self.pencil, np.array([speed]), *found)
        return Eigen(1j * np.sqrt(squared)[None], v[None], rounding)

    def _solve_conservative(self, speeds: np.ndarray, count: int) -> Eigen:
        if (L := self._factor(speeds)) is not None:
            return self._solve_factored(L, speeds[0], count)
        stiffness = 1 + speeds[:, None] ** 2 * self.growth
        squared, z, rounding = solve_diagonal(self.mass, stiffness, count, self.lowest_at_rest)
        rounding += self._estimate_rounding(speeds, squared, z)
        vector = self.basis @ z
        if self.pencil.shift:
            squared, rounding = remove_shift(self.pencil, speeds, squared, vector, rounding)
            vector = part_free_turns(self.pencil, squared, vector)
        root = np.sqrt(np.abs(squared))
        eigenvalue = np.where(squared > 0, 1j * root, root)
        return Eigen(eigenvalue, vector, np.where(squared == 0, np.inf, rounding))

    def _estimate_rounding(self, speeds: np.ndarray, squared: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Estimate the relative error (S, k) of squared frequencies due to rounding of the matrices."""
        vector = np.abs(self.basis @ z)
        terms = 1 + speeds[:, None] ** 2 * np.abs(self.growth)
        rounding = rounding_of_matrices(terms, squared, z, vector, np.abs(self.pencil.M))
        return rounding_of_scene(self.pencil, speeds, squared, vector, rounding)

    # Gyroscopic and damped equations ----------------------------------------------------------------

    def _solve_coupled(self, speed: float, count: int) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Eigenvalues (k,), vectors (n, k) and rounding (k,) at one speed."""
        on_springs = self.pencil.shift and not self.pencil.C.any() and not self._has_massless
        if on_springs and (graded := factor_graded(self.pencil, speed)):
            return self._solve_graded(speed, count, *graded)
        stiffness = 1 + speed**2 * self.growth
        T, n = self.basis, self.size
        damping = T.T @ (self.pencil.C + speed * self.pencil.G) @ T
        time = np.sqrt(1 / self.lowest_at_rest)  # unit of time in which the frequencies are of order 1
        if self.pencil.shift or self._has_massless:
            K = np.diag(stiffness) - self.pencil.shift * self.mass
            R = condense(self.mass, K) if self._has_massless else np.eye(n)
            inverse, y = solve_first_order(*(R.T @ A @ R for A in (self.mass / time**2, damping / time, K)))
            y = R @ y[: R.shape[1]]
        else:
            gyroscopic = not self.pencil.C.any() and stiffness.min() > 0
            solve = _solve_gyroscopic if gyroscopic else _solve_general
            inverse, y = solve(self.mass / time**2, damping / time, stiffness)
        turns = self._free_turns(speed)
        if turns.size:
            inverse, y = leave_out_slowest(inverse, y, 2 * turns.shape[1])  # each turn has 0 twice
        s, z = select_lowest(inverse * time, y[:n], count)
        norm = np.sqrt(np.maximum(np.einsum("nk,nm,mk->k", z.conj(), self.mass, z).real, 0.0))
        condition = (1 + speed**2 * np.abs(self.growth)).max() / np.abs(stiffness).min()
        rounding = 8 * _EPS * (np.abs(s) * np.abs(inverse).max() * time + condition)
        lost = norm == 0  # the modal mass is below rounding: nothing is known of such a mode
        modes = s, T @ (z / np.where(lost, np.inf, norm)), np.where(lost, np.inf, rounding)
        return insert_free_turns(turns, *modes, count) if turns.size else modes

    def _solve_graded(
        self, speed: float, count: int, basis: np.ndarray, condition: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """The same of gyroscopic equations on springs, in coordinates in which the stiffness is 1."""
        M, C = (_transformed(basis, A) for A in (self.pencil.M, speed * self.pencil.G))
        time = np.sqrt(np.trace(M) / len(M))
        inverse, y = _solve_gyroscopic(M / time**2, C / time, np.ones(len(M)))
        s, z = select_lowest(inverse * time, y[: len(M)], count)
        norm = np.sqrt(np.einsum("nk,nm,mk->k", z.conj(), M, z).real)
        rounding = 8 * _EPS * (np.abs(s) * np.abs(inverse).max() * time + condition)
        return s, basis @ (z / norm), rounding

    def _free_turns(self, speed: float) -> np.ndarray:
        """Mass-normalised turns about hinges (n, r) on which neither stiffness nor damping acts."""
        if not self.pencil.shift:
            return np.empty((self.size, 0))
        conservative = self._solve_conservative(np.array([speed]), min(self.pencil.planes, self.size))
        return find_free_turns(self.pencil, conservative.eigenvalue[0], conservative.vector[0])


def rounding_of_matrices(
    terms: np.ndarray, squared: np.ndarray, z: np.ndarray, size: np.ndarray, mass: np.ndarray
) -> np.ndarray:
    """Relative error (S, k) of frequencies by rounding of the matrices of conservative equations.

    Parameters
    ----------
    terms : ndarray, shape (S, n)
        The diagonal stiffness with the absolute value of each of its terms.
    squared, z : ndarray, shapes (S, k) and (S, n, k)
        Squared frequencies and modes, in coordinates in which the stiffness is diagonal.
    size : ndarray, shape (S, n, k)
        Absolute values of the modes in the coordinates of the pencil.
    mass : ndarray, shape (n, n) or (S, n, n)
        Absolute values of the mass matrix of the pencil.
    """
    modal_terms = np.einsum("snk,sn->sk", z**2, terms)  # the modal stiffness without cancellation
    modal_norm = (z**2).sum(axis=1) * terms.max(axis=1, keepdims=True)
    with np.errstate(divide="ignore", invalid="ignore"):
        by_terms, by_norm = modal_terms / np.abs(squared), modal_norm / np.abs(squared)
    modal_mass = (size * (mass @ size)).sum(axis=1)  # 1 without cancellation
    growth = max(1.0, terms.shape[1] / ROUNDING_SIZE)  # rounding adds up over the functions
    return growth * (BACKWARD * (by_terms + np.sqrt(by_norm) + 0.375 * by_norm) + _EPS * modal_mass)


def rounding_of_scene(
    pencil: SteadyPencil, speeds: np.ndarray, squared: np.ndarray, size: np.ndarray, rounding: np.ndarray
) -> np.ndarray:
    """Relative error (S, k) of frequencies by rounding, from that of a clamped beam in one plane.

    Two planes add what cancels of large entries of the stiffness of a stiff plane.  The absolute values
    `size` of the modes have shape (S, n, k).
    """
    if pencil.planes == 1:
        return _ON_SPRINGS * rounding if pencil.shift else rounding
    K = np.abs(pencil.K0) + speeds[:, None, None] ** 2 * np.abs(pencil.K2)
    with np.errstate(divide="ignore", invalid="ignore"):
        cancelled = _CANCELLED * (size * (K @ size)).sum(axis=1) / np.abs(squared)
    return _TWO_PLANES * (rounding + cancelled)


@contextmanager
def explained() -> Iterator[None]:
    """Say what a factorization that fails means."""
    try:
        yield
    except np.linalg.LinAlgError as error:
        raise np.linalg.LinAlgError(
            "stiffness, mass and speed span more digits than double precision has: give a lower speed, "
            "a smaller tip inertia, or properties and breakpoints that vary less"
        ) from error


def _shifted_stiffness(pencil: SteadyPencil) -> np.ndarray:
    return pencil.K0 + pencil.shift * pencil.M if pencil.shift else pencil.K0


def _transform_by_inverse(L: np.ndarray, A: np.ndarray) -> np.ndarray:
    """Compute L^-1 A L^-T for triangular L and symmetric A."""
    return _symmetrize(solve_lower(L, solve_lower(L, A).T))


def _transformed(basis: np.ndarray, A: np.ndarray) -> np.ndarray:
    return basis.T @ A @ basis


def _symmetrize(A: np.ndarray) -> np.ndarray:
    return (A + np.swapaxes(A, -1, -2)) / 2


def solve_diagonal(
    mass: np.ndarray, stiffness: np.ndarray, count: int, lowest_at_rest: float | np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve diag(d) z = w^2 M z for the lowest modes of each of many problems.

    Parameters
    ----------
    mass : ndarray, shape (n, n) or (S, n, n)
        M of all problems, or of each.
    stiffness : ndarray, shape (S, n)
        d of each.
    count : int
        Number of modes k.
    lowest_at_rest : float or ndarray, shape (S,)
        Lowest squared frequency at rest.

    Returns
    -------
    squared : ndarray, shape (S, k)
        Squared frequencies w^2.
    z : ndarray, shape (S, n, k)
        Mass-normalised modes.
    rounding : ndarray, shape (S, k)
        Relative error of w by the eigensolver.
    """
    stiff, lowest = stiffness.min(axis=1) >= LEAST_STIFFNESS, lowest_at_rest * np.ones(len(stiffness))
    if stiff.all():
        return _solve_scaled(mass, stiffness, count, lowest)
    S, n = stiffness.shape
    squared, z, rounding = np.empty((S, count)), np.empty((S, n, count)), np.empty((S, count))
    for mask, solve in ((stiff, _solve_scaled), (~stiff, _solve_shifted)):
        if mask.any():
            M = mass[mask] if mass.ndim == 3 else mass
            squared[mask], z[mask], rounding[mask] = solve(M, stiffness[mask], count, lowest[mask])
    return squared, z, rounding


def inverse_squares(mass: np.ndarray, stiffness: np.ndarray, count: int) -> np.ndarray:
    """Find 1/w^2 (S, k) of `solve_diagonal`, where no stiffness is below `LEAST_STIFFNESS`."""
    scale = 1 / np.sqrt(stiffness)
    mu = np.linalg.eigvalsh(scale[:, :, None] * mass * scale[:, None, :])
    return _above_rounding(mu[:, : -count - 1 : -1])


def _solve_scaled(
    M: np.ndarray, d: np.ndarray, count: int, lowest_at_rest: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve diag(d) z = w^2 M z for positive d (S, n): squared frequencies w^2, vectors z, rounding of w."""
    scale = 1 / np.sqrt(d)
    mu, z = _solve_largest(scale[:, :, None] * M * scale[:, None, :], count)
    return 1 / mu, z * scale[:, :, None] / np.sqrt(mu)[:, None, :], forward_error(mu)


def _solve_shifted(
    M: np.ndarray, d: np.ndarray, count: int, lowest_at_rest: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Solve as `_solve_scaled`, but for any d, with the positive definite diag(d) + shift M."""
    shift = _find_shift(M, d, lowest_at_rest)
    K = shift[:, None, None] * M
    K[:, np.arange(d.shape[1]), np.arange(d.shape[1])] += d
    L = np.linalg.cholesky(K)
    half = np.linalg.solve(L, np.broadcast_to(M, K.shape))
    mu, x = _solve_largest(_symmetrize(np.linalg.solve(L, np.swapaxes(half, 1, 2))), count)
    z = np.linalg.solve(np.swapaxes(L, 1, 2), x) / np.sqrt(mu)[:, None, :]
    squared = 1 / mu - shift[:, None]
    cancellation = np.abs(1 / mu / np.where(squared == 0, np.inf, squared))
    return squared, z, forward_error(mu) * cancellation


def _solve_largest(A: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Compute the largest eigenvalues, descending, and their vectors, of a batch of symmetric matrices."""
    n = A.shape[-1]
    if n <= _LARGEST_BATCHED:
        mu, z = np.linalg.eigh(A)
    else:  # most of the time goes into the vectors, of which only a few are computed
        modes = [scipy.linalg.eigh(a, subset_by_index=(n - count, n - 1)) for a in A]
        mu, z = (np.array(values) for values in zip(*modes, strict=True))
    return _above_rounding(mu[:, : -count - 1 : -1]), z[:, :, : -count - 1 : -1]


def _above_rounding(mu: np.ndarray) -> np.ndarray:
    """Raise eigenvalues (..., k), descending, to half their rounding error: it may make them negative."""
    return np.maximum(mu, _FORWARD / 2 * mu[..., :1])


def forward_error(mu: np.ndarray) -> np.ndarray:
    """Relative error of 1/sqrt(mu) (..., k) by the eigensolver, for descending mu."""
    return _FORWARD * mu[..., :1] / mu


def _find_shift(M: np.ndarray, d: np.ndarray, smallest: np.ndarray) -> np.ndarray:
    """Find shifts (S,), `smallest` (S,) times a power of 4, that make diag(d) + shift M positive definite.

    Raises
    ------
    LinAlgError
        If rounding hides whether a shift does.
    """
    low, high = np.full(len(d), -1), np.zeros(len(d), dtype=int)  # exponents that fail, and that are tried
    failing, M = np.arange(len(d)), np.broadcast_to(M, (len(d), *M.shape[-2:]))
    while (
        failing := failing[~_are_definite(M[failing], d[failing], smallest[failing] * 4.0 ** high[failing])]
    ).size:
        low[failing], high[failing] = high[failing], np.maximum(1, 2 * high[failing])
        if high.max() > _LARGEST_SHIFT:
            raise np.linalg.LinAlgError
    while (wide := np.flatnonzero(high - low > 1)).size:
        middle = (low[wide] + high[wide]) // 2
        definite = _are_definite(M[wide], d[wide], smallest[wide] * 4.0**middle)
        low[wide], high[wide] = np.where(definite, low[wide], middle), np.where(definite, middle, high[wide])
    return smallest * 4.0**high


def _are_definite(M: np.ndarray, d: np.ndarray, shift: np.ndarray) -> np.ndarray:
    """Whether diag(d) + shift M is positive definite beyond rounding: M (S, n, n), d (S, n), shifts (S,)."""
    n = d.shape[1]
    K = shift[:, None, None] * M
    K[:, np.arange(n), np.arange(n)] += d
    values = np.linalg.eigvalsh(K)
    return values[:, 0] >= np.maximum(LEAST_STIFFNESS / 2, n * BACKWARD * values[:, -1])


def _solve_gyroscopic(M: np.ndarray, C: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve as `_solve_general` for skew-symmetric C and positive d, by a Hermitian eigenproblem."""
    n, scale = len(d), 1 / np.sqrt(d)
    mu, U = np.linalg.eigh(scale[:, None] * M * scale)
    root = np.sqrt(np.maximum(mu, 0))
    half = U * root
    W = np.zeros((2 * n, 2 * n), dtype=complex)
    W[:n, :n], W[:n, n:], W[n:, :n] = -1j * (scale[:, None] * C * scale), -1j * half, 1j * half.T
    theta, y = np.linalg.eigh(W)
    return theta / 1j, y * np.concatenate([scale, np.ones(n)])[:, None]


def _solve_general(M: np.ndarray, C: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Solve M q'' + C q' + diag(d) q = 0, d without zeros: 1/s (2 n,) and vectors (2 n, 2 n) with q first."""
    n = len(d)
    B = np.zeros((2 * n, 2 * n))
    B[:n, :n], B[:n, n:], B[n:, :n] = -C / d[:, None], -M / d[:, None], np.eye(n)
    return np.linalg.eig(B)


def select_lowest(inverse: np.ndarray, z: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Select the lowest modes from 1/s: Im s > 0, real s > 0, and of each real pair s < 0 the slower."""
    inverse = np.where(np.abs(np.real(inverse)) < _REAL * np.abs(inverse), 1j * np.imag(inverse), inverse)
    inverse = np.where(inverse == 0, _EPS * np.abs(inverse).max(), inverse)
    s = 1 / inverse
    oscillating = np.flatnonzero(s.imag > 0)
    growing = np.flatnonzero((s.imag == 0) & (s.real > 0))
    decaying = np.flatnonzero((s.imag == 0) & (s.real < 0))
    decaying = decaying[np.argsort(-s[decaying].real)]
    slower = decaying[: max(0, (len(decaying) - len(growing)) // 2)]
    modes = np.concatenate([oscillating, growing, slower])
    squared = np.where(np.isin(modes, growing), -1, 1) * np.abs(s[modes]) ** 2
    modes = modes[np.argsort(squared, kind="stable")][:count]
    return s[modes], z[:, modes]
