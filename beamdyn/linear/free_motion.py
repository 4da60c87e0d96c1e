"""Free motion of linear equations, M q'' + C q' + K q = 0, independent of the units of coordinates.

Coordinates u are chosen in which K + z^2 M is the unit matrix and M = diag(r^2), and the states are u and
w = r u'.  Then all quantities are times, and for the poles s the eigenvalues of T are 1 / (s - z), where

    T (u, w) = (v, r (u + z v)),    v = -(I + z C)^-1 ((C + z r^2) u + r w).

A stiffness that is positive definite needs no shift z: T = [-C, -r; r, 0] is skew without damping, and has
blocks of two with modal damping, so that eigenvalues and vectors are as accurate as those of
symmetric matrices.  The lowest poles belong to the largest eigenvalues, which keep all digits; coordinates
without mass have r = 0, and infinite poles.

In shapes of arrays, n counts coordinates, m poles, and k loads.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import scipy.linalg

from beamdyn.common.numerics import solve_lower, solve_lower_transposed

_EPS = float(np.finfo(float).eps)
_MASSLESS = 16 * _EPS  # mass r^2 of a coordinate, divided by the largest, up to which it counts as 0
# Ratio of a pole to the shift below which the pole counts as 0: a rounding error eps moves double poles by
# about the square root of eps.
_STILL = 1e-6
_INFINITE = 1e-12  # inverse pole, divided by the largest, up to which it is 0 within rounding
# Squared lowest frequency, divided by that of an elastic mode, below which the stiffness is shifted.
_NEARLY_FREE = 1e-6
_ELASTIC = 2  # number of modes that may lack stiffness, a free rotation in each plane; the next is elastic


@dataclass(frozen=True)
class BalancedCoordinates:
    """Coordinates u with q = basis u, in which K + shift^2 M is the unit matrix and M = diag(roots^2).

    Parameters
    ----------
    basis : ndarray, shape (n, n)
        Coordinates q per unit of each u.
    roots : ndarray, shape (n,)
        Square roots of the mass [s], descending; 0 for coordinates without mass within rounding.
    shift : float
        Shift of the poles [1/s].
    """

    basis: np.ndarray
    roots: np.ndarray
    shift: float

    @property
    def squared(self) -> np.ndarray:
        """Squared undamped frequencies [rad2/s2] of coordinates with mass, ascending in magnitude."""
        found = self.roots[self.roots > 0] ** -2.0 - self.shift**2
        return found[np.argsort(np.abs(found))]


@dataclass(frozen=True)
class FreeMotion:
    """Free motions of linear equations: a load f causes q(s) = sum_k shapes_k shares_k(f) / (1 - s t_k).

    Parameters
    ----------
    inverse_poles : ndarray of complex, shape (m,)
        Inverse poles t_k = 1 / p_k [s], descending in magnitude, Im p > 0 first in pairs; infinite for a
        free rotation, 0 for massless coordinates.
    shapes : ndarray of complex, shape (n, m)
        Coordinates q of each free motion.
    states : ndarray of complex, shape (2 n, m)
        Each free motion in the states u and then w.
    coordinates : BalancedCoordinates
        The coordinates u.
    damping : ndarray, shape (n, n)
        Damping matrix C in the coordinates u [s].
    """

    inverse_poles: np.ndarray
    shapes: np.ndarray
    states: np.ndarray
    coordinates: BalancedCoordinates
    damping: np.ndarray

    @property
    def poles(self) -> np.ndarray:
        """Poles [1/s], ascending in magnitude; infinite for massless coordinates."""
        massless = np.full(np.count_nonzero(self.inverse_poles == 0), np.inf)
        return np.concatenate([self.finite_poles, massless])

    @property
    def finite_poles(self) -> np.ndarray:
        """Poles [1/s] of the coordinates that have mass."""
        inverse = self.inverse_poles[self.inverse_poles != 0]
        free = np.isinf(inverse)
        return np.where(free, 0.0, 1 / np.where(free, 1.0, inverse))

    @property
    def rounding(self) -> float:
        """Rounding error of the inverse poles [s]."""
        size = np.abs(self.inverse_poles)
        return len(self.shapes) * _EPS * float(size.max(where=np.isfinite(size), initial=0.0))

    def shares(self, loads: np.ndarray) -> np.ndarray:
        """Compute the coefficients (poles, k) of the free motions in the responses to k loads in columns."""
        z, r = self.coordinates.shift, self.coordinates.roots[:, None]
        u = np.linalg.solve(np.eye(len(r)) + z * self.damping, self.coordinates.basis.T @ loads)
        return _in_terms_of(self.states, np.vstack([u, z * r * u])) * (1 - z * self.inverse_poles)[:, None]


def free_motion(M: np.ndarray, C: np.ndarray, K: np.ndarray) -> FreeMotion:
    """Solve M q'' + C q' + K q = 0 for positive semidefinite M and symmetric K.

    Parameters
    ----------
    M, C, K : ndarray, shape (coordinates, coordinates)
        Mass, damping with gyroscopic terms, and stiffness.
    """
    chosen = balance(M, K)
    z, r, damping = chosen.shift, chosen.roots, chosen.basis.T @ C @ chosen.basis
    eye = np.eye(len(r))
    v = -np.linalg.solve(eye + z * damping, np.hstack([damping + z * np.diag(r**2), np.diag(r)]))
    w = r[:, None] * (np.hstack([eye, np.zeros_like(eye)]) + z * v)
    shifted, states = scipy.linalg.eig(np.vstack([v, w]))
    still = np.abs(1 + z * shifted) < _STILL
    inverse = np.where(still, np.inf, shifted / np.where(still, 1, 1 + z * shifted))
    inverse = np.where(np.abs(shifted) > _INFINITE * np.abs(shifted).max(), inverse, 0.0)
    order = np.lexsort((np.imag(inverse), -np.abs(inverse)))
    inverse, states = inverse[order], states[:, order]
    return FreeMotion(inverse, chosen.basis @ states[: len(r)], states, chosen, damping)


def balance(M: np.ndarray, K: np.ndarray) -> BalancedCoordinates:
    """Compute coordinates in which K + shift^2 M is the unit matrix and M is diagonal.

    The shift is 0 unless rounding may make K not positive definite, or the beam can nearly move freely.
    """
    try:
        found = _diagonal(M, K, 0.0)
    except np.linalg.LinAlgError:
        found = _diagonal(M, K, _safe_shift(M, K))
    squared = found.squared
    elastic = abs(squared[min(_ELASTIC, len(squared) - 1)])
    if not found.shift and squared[0] > _NEARLY_FREE * elastic:
        return found
    negative = max(0.0, -float(squared.min()))
    return _diagonal(M, K, max(np.sqrt(elastic + 2 * negative), _EPS * _safe_shift(M, K)))


def _diagonal(M: np.ndarray, K: np.ndarray, shift: float) -> BalancedCoordinates:
    """Compute coordinates in which K + shift^2 M is the unit matrix and M is diagonal.

    A LinAlgError is raised if K + shift^2 M is not positive definite.
    """
    L = np.linalg.cholesky(K + shift**2 * M)
    mass = solve_lower(L, solve_lower(L, M).T)
    squared_roots, turned = np.linalg.eigh((mass + mass.T) / 2)
    squared_roots, turned = squared_roots[::-1], turned[:, ::-1]
    roots = np.sqrt(np.where(squared_roots > _MASSLESS * squared_roots[0], squared_roots, 0.0))
    return BalancedCoordinates(solve_lower_transposed(L, turned), roots, shift)


def _safe_shift(M: np.ndarray, K: np.ndarray) -> float:
    """Choose a shift [1/s] with which K + shift^2 M is positive definite.

    It is about as large as the highest frequencies.
    """
    mass, stiffness = np.diag(M), np.abs(np.diag(K))
    massive = mass > _MASSLESS * mass.max()
    shift = np.sqrt(np.max(stiffness[massive] / mass[massive]) or 1.0)
    while not _is_definite(K + shift**2 * M):
        shift *= 2
    return float(2 * shift)


def _is_definite(A: np.ndarray) -> bool:
    try:
        np.linalg.cholesky(A)
    except np.linalg.LinAlgError:
        return False
    return True


def _in_terms_of(vectors: np.ndarray, states: np.ndarray) -> np.ndarray:
    """Express states (columns) as sums of eigenvectors, by least squares if these are dependent."""
    try:
        return np.linalg.solve(vectors, states)
    except np.linalg.LinAlgError:
        return np.linalg.lstsq(vectors, states)[0]
