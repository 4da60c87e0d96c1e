"""Floquet multipliers, the eigenvalues of monodromy matrices, and the stability that follows from them.

To first order, an error d of a matrix moves a multiplier by at most k d.  Here k is its condition number: the
product of the norms of its left and right eigenvector over their inner product.  If two multipliers meet, k
is unbounded, but k times their distance is bounded: the two are a +- sqrt(s) with their mean a, and an error
D of s moves them by at most sqrt(D).

Undamped motion preserves an antisymmetric form, so that multipliers come in pairs z, 1 / conj(z).  A
multiplier near, but off, the unit circle would have its partner equally close on the other side.  One that is
further from all others than the errors has no such partner, and thus is on the circle.  If several meet, they
stay on the circle if the form has the same sign on all of their vectors (Krein).

In shapes of arrays, P is the number of matrices, and m the number of multipliers of each.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.numerics import number_groups
from beamdyn.studies.floquet.monodromy import Monodromy

STABLE, UNSTABLE, UNDECIDED = "stable", "unstable", "undecided"
# Backward error of the eigenvalue solver, relative to the norm of the matrix.
_EIGENVALUES = 8 * np.finfo(float).eps
_SAME_MAGNITUDE = 1e-9  # relative difference of magnitudes that count as equal: those of undamped motion
_SAFETY = 2.0  # safety factor of the first-order bounds
_DEFINITE = 1e-6  # ratio of the form's value to its maximum, above which the sign is certain


@dataclass(frozen=True)
class Multipliers:
    """Multipliers of P monodromy matrices, with errors and Krein signs.

    Parameters
    ----------
    value : ndarray of complex, shape (P, multipliers)
        Multipliers, by descending magnitude, and by descending angle where that is equal.
    error : ndarray, shape (P, multipliers)
        Estimated errors of the multipliers.
    sign : ndarray, shape (P, multipliers), or None
        Krein sign of each multiplier: the sign, 1 or -1, of i x^* J x with its eigenvector x and the
        antisymmetric matrix J of the form that undamped motion preserves.  It is 0 if not known, and for
        multipliers off the unit circle.  None with damping.
    period : ndarray, shape (P,)
        Periods of the motions [s].
    """

    value: np.ndarray
    error: np.ndarray
    sign: np.ndarray | None
    period: np.ndarray

    @cached_property
    def size(self) -> np.ndarray:
        """Magnitudes of the multipliers: (matrices, multipliers)."""
        return np.abs(self.value)

    @cached_property
    def verdict(self) -> np.ndarray:
        """Stability of each motion: "stable", "unstable" or "undecided"."""
        outside = (self.size - self.error > 1).any(axis=1)
        if self.sign is None:
            stable = (self.size + self.error < 1).all(axis=1)
        else:
            # Multipliers of undamped motion leave the unit circle only where two of unlike signs meet.
            reach = self.error[:, :, None] + self.error[:, None, :]
            meet = np.abs(self.value[:, :, None] - self.value[:, None, :]) <= reach
            of_one_sign = self.sign[:, :, None] * self.sign[:, None, :] > 0
            meet &= ~of_one_sign & ~np.eye(self.value.shape[1], dtype=bool)
            beside = np.abs(self.size - 1) > self.error
            stable = ~np.asarray((meet.any(axis=2) | beside).any(axis=1))
        return np.select([outside, stable], [UNSTABLE, STABLE], UNDECIDED)

    @cached_property
    def growth(self) -> tuple[np.ndarray, np.ndarray]:
        """Largest growth rates and their errors [1/s]; 0 for stable motion without damping."""
        with np.errstate(divide="ignore"):
            rate = np.log(self.size).max(axis=1) / self.period
            most = np.log(self.size + self.error).max(axis=1) / self.period
            least = np.log(np.maximum(self.size - self.error, 0.0)).max(axis=1) / self.period
        error = np.maximum(most - rate, rate - least)
        rests = (self.verdict == STABLE) & (self.sign is not None)
        return np.where(rests, 0.0, rate), np.where(rests, 0.0, error)


def multipliers_of(motion: Monodromy) -> Multipliers:
    """Compute the multipliers of monodromy matrices, and their errors."""
    matrix, form = motion.matrix, motion.form
    value, right = np.linalg.eig(matrix)
    order = _order(value)
    value = np.take_along_axis(value, order, axis=1)
    right = np.take_along_axis(right, order[:, None, :], axis=2)
    condition = np.linalg.norm(_inverse(right), axis=2) * np.linalg.norm(right, axis=1)
    moved = motion.error + _EIGENVALUES * np.linalg.norm(matrix, axis=(1, 2))
    first = condition * moved[:, None]
    own = np.where(np.eye(value.shape[1], dtype=bool), np.inf, 0.0)
    gap = (np.abs(value[:, :, None] - value[:, None, :]) + own).min(axis=2)
    with np.errstate(invalid="ignore"):
        bound = np.fmin(_SAFETY * first, np.sqrt(_SAFETY * first * gap))
    sign = None if form is None else _krein_sign(value, bound, right, form)
    return Multipliers(value, np.nan_to_num(bound, nan=np.inf), sign, motion.period)


def _order(value: np.ndarray) -> np.ndarray:
    """Find the order of multipliers: by descending magnitude and, if that is equal, by descending angle."""
    order = np.argsort(-np.abs(value), axis=1, kind="stable")
    ordered = np.take_along_axis(value, order, axis=1)
    group = number_groups(np.abs(ordered), _SAME_MAGNITUDE)
    return np.take_along_axis(order, np.lexsort((-np.angle(ordered), group), axis=1), axis=1)


def _inverse(matrix: np.ndarray) -> np.ndarray:
    """Compute inverses of a batch of matrices; inf if a matrix is singular."""
    try:
        return np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        if len(matrix) == 1:
            return np.full_like(matrix, np.inf)
        return np.concatenate([_inverse(matrix[i : i + 1]) for i in range(len(matrix))])


def _krein_sign(value: np.ndarray, error: np.ndarray, right: np.ndarray, form: np.ndarray) -> np.ndarray:
    """Compute Krein signs of multipliers on the unit circle; 0 if the sign is not certain.

    It is the sign of i x^* J x, with the eigenvector x and the form J that the motion preserves.
    """
    inside = np.real(1j * np.einsum("pim,pij,pjm->pm", right.conj(), form, right))
    largest = np.einsum("pim,pij,pjm->pm", np.abs(right), np.abs(form), np.abs(right))
    known = (np.abs(inside) > _DEFINITE * largest) & (np.abs(np.abs(value) - 1) <= error)
    return np.where(known, np.sign(inside), 0.0)
