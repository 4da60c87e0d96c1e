"""Eigenvalues of the steady equations, all speeds of a request as one batch.

The stiffness at rest sets the coordinates and the eigenproblem is solved inverted, as
M v = mu K v: the lowest modes, which are wanted, are then the largest eigenvalues and keep all
their digits however many functions the basis has.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg
from scipy.linalg import solve_triangular

from beamdyn.equations.equations_of_motion import SteadyPencil

_EPS = np.finfo(float).eps
# Rounding, fitted by benchmarks/stated_frequency_errors.py to 720 frequencies of random scenes; the matrices
# are graded, and keep more digits than their norm tells.
_BACKWARD = 8 * _EPS  # of the stiffness, relative to the sum of its terms and to its norm
_FORWARD = 0.5 * _EPS  # of the eigensolution, relative to its largest eigenvalue; a fifth is seen at mode 100
_SAFE = 0.1  # share of the stiffness at rest that must be left for a solution without a shift
_DENSE = 64  # largest matrices whose eigenvectors are computed all, in one batched call
_MANY = 40  # functions from which their number shows in the rounding: measured
_REAL = 1e-8  # relative growth below which a coupled mode counts as stable: rounding of a double root


@dataclass(frozen=True)
class Eigen:
    """Lowest modes over a batch of S speeds.

    Parameters
    ----------
    eigenvalue : ndarray, shape (S, k)
        s in q = v exp(s t), of each pair the one with Im s > 0, or else the larger [1/s].
    vector : ndarray, shape (S, n, k)
        Mass-normalised vectors v; real where the equations are conservative.
    rounding : ndarray, shape (S, k)
        Estimated relative error of |s| by rounding.
    """

    eigenvalue: np.ndarray
    vector: np.ndarray
    rounding: np.ndarray


class Solver:
    """Solves one pencil at any speeds.

    Parameters
    ----------
    pencil : SteadyPencil
        The equations at steady speed.
    """

    def __init__(self, pencil: SteadyPencil) -> None:
        self.pencil = pencil
        L = np.linalg.cholesky(pencil.K0)
        growth, Q = np.linalg.eigh(_congruent(L, pencil.K2))
        self.growth = growth  # K = diag(1 + speed^2 growth) in these coordinates
        self.basis = solve_triangular(L, Q, trans="T", lower=True)
        self.mass = _symmetric(Q.T @ _congruent(L, pencil.M) @ Q)
        self.rest = 1 / np.linalg.eigvalsh(self.mass)[-1]  # lowest squared frequency at rest

    @property
    def size(self) -> int:
        """Number of modes of the equations."""
        return len(self.growth)

    @property
    def critical_speed(self) -> float:
        """Lowest speed at which the stiffness is singular [rad/s]; inf if there is none."""
        return float(1 / np.sqrt(-self.growth[0])) if self.growth[0] < 0 else np.inf

    @property
    def critical_rounding(self) -> float:
        """Estimated relative error of the critical speed by rounding."""
        return float(2 * _BACKWARD * np.abs(self.growth).max() / abs(self.growth[0]))

    def solve(self, speeds: np.ndarray, count: int) -> Eigen:
        """The `count` lowest modes at each speed."""
        if self.pencil.conservative:
            return self._conservative(speeds, count)
        solved = [self._coupled(speed, count) for speed in speeds]
        return Eigen(
            *(
                np.array([getattr(e, name)[0] for e in solved])
                for name in ("eigenvalue", "vector", "rounding")
            )
        )

    def eigenvalues(self, speeds: np.ndarray, count: int) -> np.ndarray:
        """Eigenvalues alone, without vectors where that saves time."""
        stiffness = 1 + speeds[:, None] ** 2 * self.growth
        if not self.pencil.conservative or stiffness.min() < _SAFE:
            return self.solve(speeds, count).eigenvalue
        scale = 1 / np.sqrt(stiffness)
        mu = np.linalg.eigvalsh(scale[:, :, None] * self.mass * scale[:, None, :])
        return 1j / np.sqrt(mu[:, : -count - 1 : -1])

    # Real symmetric problem -----------------------------------------------------------------------

    def _conservative(self, speeds: np.ndarray, count: int) -> Eigen:
        stiffness = 1 + speeds[:, None] ** 2 * self.growth
        safe = stiffness.min(axis=1) >= _SAFE
        n = len(self.growth)
        squared, z = np.empty((len(speeds), count)), np.empty((len(speeds), n, count))
        rounding = np.empty((len(speeds), count))
        for chosen, solve in ((safe, _scaled), (~safe, _shifted)):
            if chosen.any():
                squared[chosen], z[chosen], rounding[chosen] = solve(
                    self.mass, stiffness[chosen], count, self.rest
                )
        rounding += self._rounding(speeds, squared, z)
        root = np.sqrt(np.abs(squared))
        eigenvalue = np.where(squared > 0, 1j * root, root)
        return Eigen(eigenvalue, self.basis @ z, np.where(squared == 0, np.inf, rounding))

    def _rounding(self, speeds: np.ndarray, squared: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Relative error of the squared frequencies by the entries of the matrices, shape (S, k)."""
        terms = 1 + speeds[:, None] ** 2 * np.abs(self.growth)
        cancelled = np.einsum("snk,sn->sk", z**2, terms)  # sum of the terms whose difference is left
        norm = (z**2).sum(axis=1) * terms.max(axis=1, keepdims=True)
        with np.errstate(divide="ignore", invalid="ignore"):
            left, share = cancelled / np.abs(squared), norm / np.abs(squared)
        size = np.abs(self.basis @ z)
        inertia = (size * (np.abs(self.pencil.M) @ size)).sum(axis=1)  # entry by entry; their sum is 1
        grown = max(1.0, len(self.growth) / _MANY)  # rounding adds up over the functions
        return grown * (_BACKWARD * (left + np.sqrt(share) + 0.375 * share) + _EPS * inertia)

    # Gyroscopic and damped problems ---------------------------------------------------------------

    def _coupled(self, speed: float, count: int) -> Eigen:
        stiffness = 1 + speed**2 * self.growth
        T, n = self.basis, len(self.growth)
        damping = T.T @ (self.pencil.C + speed * self.pencil.G) @ T
        gyroscopic = not self.pencil.C.any() and stiffness.min() > 0
        solve = _gyroscopic if gyroscopic else _general
        time = np.sqrt(1 / self.rest)
        inverse, y = solve(self.mass / time**2, damping / time, stiffness)
        s, z = _one_of_each_pair(inverse * time, y[:n], count)
        norm = np.sqrt(np.einsum("nk,nm,mk->k", z.conj(), self.mass, z).real)
        cond = (1 + speed**2 * np.abs(self.growth)).max() / np.abs(stiffness).min()
        rounding = 8 * _EPS * (np.abs(s) * np.abs(inverse).max() * time + cond)
        return Eigen(s[None], (T @ (z / norm))[None], rounding[None])


def _congruent(L: np.ndarray, A: np.ndarray) -> np.ndarray:
    """L^-1 A L^-T."""
    return _symmetric(solve_triangular(L, solve_triangular(L, A, lower=True).T, lower=True))


def _symmetric(A: np.ndarray) -> np.ndarray:
    return (A + np.swapaxes(A, -1, -2)) / 2


def _scaled(
    M: np.ndarray, d: np.ndarray, count: int, rest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Modes of (diag d, M) for positive d of shape (S, n): squared frequencies, vectors, rounding."""
    scale = 1 / np.sqrt(d)
    mu, z = _largest(scale[:, :, None] * M * scale[:, None, :], count)
    return 1 / mu, z * scale[:, :, None] / np.sqrt(mu)[:, None, :], _FORWARD * mu[:, :1] / mu


def _shifted(
    M: np.ndarray, d: np.ndarray, count: int, rest: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The same for any d, through the definite pencil (diag d + shift M, M)."""
    shift = _definite_shift(M, d, rest)
    K = shift[:, None, None] * M
    K[:, np.arange(len(M)), np.arange(len(M))] += d
    L = np.linalg.cholesky(K)
    half = np.linalg.solve(L, np.broadcast_to(M, K.shape))
    mu, x = _largest(_symmetric(np.linalg.solve(L, np.swapaxes(half, 1, 2))), count)
    z = np.linalg.solve(np.swapaxes(L, 1, 2), x) / np.sqrt(mu)[:, None, :]
    squared = 1 / mu - shift[:, None]
    lost = mu[:, :1] / mu * np.abs(1 / mu / np.where(squared == 0, np.inf, squared))
    return squared, z, _FORWARD * lost


def _largest(A: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The largest eigenvalues, descending, and their vectors, of a batch of symmetric matrices."""
    n = A.shape[-1]
    if n <= _DENSE:
        mu, z = np.linalg.eigh(A)
    else:  # large matrices: most of the time is in the vectors, which only a few are wanted of
        solved = [scipy.linalg.eigh(a, subset_by_index=(n - count, n - 1)) for a in A]
        mu, z = np.array([m for m, _ in solved]), np.array([v for _, v in solved])
    return mu[:, : -count - 1 : -1], z[:, :, : -count - 1 : -1]


def _definite_shift(M: np.ndarray, d: np.ndarray, rest: float) -> np.ndarray:
    """A shift for each row of d, within four times the least that makes diag d + shift M definite."""
    shift = np.full(len(d), rest)
    todo = np.ones(len(d), dtype=bool)
    while todo.any():
        K = shift[todo, None, None] * M
        K[:, np.arange(len(M)), np.arange(len(M))] += d[todo]
        low = np.linalg.eigvalsh(K)[:, 0] < _SAFE / 2
        todo[todo] = low
        shift[todo] *= 4
    return shift


def _gyroscopic(M: np.ndarray, C: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """1/s and (q, s q) of M q'' + C q' + diag(d) q = 0 for skew C and positive d: a Hermitian problem."""
    n, scale = len(d), 1 / np.sqrt(d)
    mu, U = np.linalg.eigh(scale[:, None] * M * scale)
    root = np.sqrt(np.maximum(mu, 0))
    half = U * root
    W = np.zeros((2 * n, 2 * n), dtype=complex)
    W[:n, :n], W[:n, n:], W[n:, :n] = -1j * (scale[:, None] * C * scale), -1j * half, 1j * half.T
    theta, y = np.linalg.eigh(W)
    return theta / 1j, y * np.concatenate([scale, np.ones(n)])[:, None]


def _general(M: np.ndarray, C: np.ndarray, d: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """1/s and (q, s q) of M q'' + C q' + diag(d) q = 0 for any regular d."""
    n = len(d)
    B = np.zeros((2 * n, 2 * n))
    B[:n, :n], B[:n, n:], B[n:, :n] = -C / d[:, None], -M / d[:, None], np.eye(n)
    return np.linalg.eig(B)


def _one_of_each_pair(inverse: np.ndarray, z: np.ndarray, count: int) -> tuple[np.ndarray, np.ndarray]:
    """The lowest modes: s with Im s > 0, unstable real ones, and the slower of two decaying real ones."""
    inverse = np.where(np.abs(np.real(inverse)) < _REAL * np.abs(inverse), 1j * np.imag(inverse), inverse)
    inverse = np.where(inverse == 0, _EPS * np.abs(inverse).max(), inverse)
    s = 1 / inverse
    oscillating = np.flatnonzero(s.imag > 0)
    growing = np.flatnonzero((s.imag == 0) & (s.real > 0))
    decaying = np.flatnonzero((s.imag == 0) & (s.real < 0))
    decaying = decaying[np.argsort(-s[decaying].real)]
    slower = decaying[: max(0, (len(decaying) - len(growing)) // 2)]
    chosen = np.concatenate([oscillating, growing, slower])
    order = np.where(np.isin(chosen, growing), -1, 1) * np.abs(s[chosen]) ** 2
    chosen = chosen[np.argsort(order, kind="stable")][:count]
    return s[chosen], z[:, chosen]
