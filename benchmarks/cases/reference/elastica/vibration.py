"""Small motions about an equilibrium: exponents s of exp(s t)."""

from __future__ import annotations

from typing import Any

import numpy as np
from scipy.linalg import lu_factor, lu_solve

from benchmarks.cases.reference.elastica.equations import Pencil
from benchmarks.cases.reference.elastica.equilibrium import State

Complexes = np.ndarray[Any, np.dtype[np.complex128]]

_STILL = 1e-7  # ratio of real part to modulus below which the real part is rounding: s^2 is real to 1e-14
_SWEEPS = 4


def exponents(state: State, count: int = 3) -> Complexes:
    """Compute the `count` exponents of least modulus, one of each pair +-s (Im s > 0, or s > 0).

    Of (1/s^2) q + (1/s) K^-1 G q + K^-1 A q = 0: A integrates, so that 1/s has no large useless values.
    """
    pencil = state.equations.pencil(state.q, state.square)
    factors = lu_factor(pencil.stiffness)
    by_speed, by_acceleration = (lu_solve(factors, m) for m in (pencil.gyroscopic, pencil.inertia))
    n = len(by_speed)
    companion = np.block([[-by_speed, -by_acceleration], [np.eye(n), np.zeros((n, n))]])
    inverse, vectors = np.linalg.eig(companion)
    chosen = _one_of_each_pair(inverse.astype(complex))[:count]
    return np.array([_refined(pencil, complex(1 / inverse[k]), vectors[n:, k]) for k in chosen])


def _one_of_each_pair(inverse: Complexes) -> np.ndarray:
    """Return indices by descending modulus of 1/s, one for each pair +-s; Im s > 0 means Im 1/s < 0."""
    least = _STILL * np.abs(inverse)
    upper = (inverse.imag < -least) | ((np.abs(inverse.imag) <= least) & (inverse.real > 0))
    chosen = np.flatnonzero(upper)
    return chosen[np.argsort(-np.abs(inverse[chosen]))]


def _refined(pencil: Pencil, s: complex, q: np.ndarray) -> complex:
    """Refine an exponent and its mode together by Newton's method."""
    n, against = q.size, q.conj() / np.linalg.norm(q) ** 2
    for _ in range(_SWEEPS):
        matrix = pencil.stiffness + s * pencil.gyroscopic + s**2 * pencil.inertia
        slope = (pencil.gyroscopic + 2 * s * pencil.inertia) @ q
        bordered = np.block([[matrix, slope[:, None]], [against[None], np.zeros((1, 1))]])
        step = np.linalg.solve(bordered, -np.append(matrix @ q, against @ q - 1))
        q, s = q + step[:n], s + step[n]
    return s


def frequencies(state: State, count: int = 3) -> np.ndarray:
    """Compute the lowest `count` frequencies lambda; nan for each exponent with a real part."""
    found = exponents(state, count)
    return np.where(np.abs(found.real) <= _STILL * np.abs(found), np.abs(found.imag), np.nan)


def growth(state: State, count: int = 8) -> float:
    """Compute the largest real part of the lowest exponents +-s; 0 means stable."""
    found = exponents(state, count)
    real = np.where(np.abs(found.real) > _STILL * np.abs(found), np.abs(found.real), 0.0)
    return float(real.max())
