"""Harmonic balance of linear equations whose coefficients are periodic in two phases.

The response q = sum_h q_h exp(i (j theta + k chi)), h = (j, k), is a function of the two phases of a
`PeriodicSystem`; d/dt becomes i Omega_h with Omega_h = j nu_1 + k nu_2.  Whether nu_1 / nu_2 is rational does
not matter: the solution covers every phase difference at once.

The equations determine which harmonics are kept: those of the load, then those that their products with
the periodic coefficients (interactions) add once, twice, and so on.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.steady.interaction_series import sum_interactions
from beamdyn.steady.periodic_system import Pair, PeriodicSystem, select_harmonics

_MOST_ENTRIES = 10**7  # entries of the matrices that are solved at once: 80 MB


def solve_harmonic_balance(system: PeriodicSystem, harmonics: Sequence[Pair]) -> np.ndarray:
    """Solve for some harmonics of the response: by interaction after interaction, else all at once.

    Parameters
    ----------
    system : PeriodicSystem
        The equations at S pairs of rates.
    harmonics : sequence of pair, length H
        Harmonics to keep; with each, its opposite.

    Returns
    -------
    ndarray of complex, shape (S, H, n)
        q_h; nan where the equations are singular.
    """
    response, settled = sum_interactions(system, harmonics)
    others, entries = np.flatnonzero(~settled), (system.size * len(harmonics)) ** 2
    for rows in np.array_split(others, 1 + len(others) * entries // _MOST_ENTRIES):
        if len(rows):
            response[rows] = solve_at_once(system[rows], harmonics)
    return response


def solve_at_once(system: PeriodicSystem, harmonics: Sequence[Pair]) -> np.ndarray:
    """Solve for some harmonics of the response by one matrix over all of them, at each pair of rates."""
    T = _real_basis(harmonics)
    y = _solve(*_assemble(system, harmonics, T))
    return T @ y.reshape(-1, len(harmonics), system.size)


def convolution_matrix(spectrum: np.ndarray, harmonics: Sequence[Pair], shift: Pair = (0, 0)) -> np.ndarray:
    """Matrices of the product with a function of the phases that is given by its spectrum.

    Parameters
    ----------
    spectrum : ndarray of complex, shape (S, N, N)
        Harmonics of the function.
    harmonics : sequence of pair, length H
        Harmonics of what it is multiplied with, and of the product.
    shift : pair
        Added to the harmonic h - h' of the spectrum that stands at (h, h').

    Returns
    -------
    ndarray of complex, shape (S, H, H)
    """
    h = np.array(harmonics)
    return select_harmonics(spectrum, h[:, None] - h[None, :] + np.array(shift))


def _real_basis(harmonics: Sequence[Pair]) -> np.ndarray:
    """Unitary T with (q_h) = T y, where y is real for real q: cosine and sine parts of each pair h, -h."""
    index = {h: i for i, h in enumerate(harmonics)}
    T = np.zeros((len(index), len(index)), dtype=complex)
    for h, i in index.items():
        opposite = index[-h[0], -h[1]]
        if i == opposite:
            T[i, i] = 1
        elif i < opposite:
            T[[i, opposite], i] = np.sqrt(0.5)
            T[[i, opposite], opposite] = np.sqrt(0.5) * np.array([-1j, 1j])
    return T


def _assemble(
    system: PeriodicSystem, harmonics: Sequence[Pair], T: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Assemble real equations A y = b: K - Omega_h^2 M, i Omega_h C, and the periodic coefficients."""
    h = np.array(harmonics)
    S, H, n = len(system.rates), len(h), system.size
    K, C, M = system.mean
    omega = system.rates @ h.T
    A = np.zeros((S, H, n, H, n))
    diagonal = np.arange(H)
    A[:, diagonal, :, diagonal] = np.moveaxis(K[:, None] - (omega**2)[..., None, None] * M[:, None], 1, 0)
    D = ((T.conj().T * 1j) @ (h.T[:, :, None] * T)).real  # matrices of d/dtheta and d/dchi, shape (2, H, H)
    rate = np.einsum("sp,pab->sab", system.rates, D)
    if C.any():
        A += np.einsum("sab,sij->saibj", rate, C)
    for order, spectrum, matrix in system.varying:
        R = np.real(T.conj().T @ convolution_matrix(spectrum, harmonics) @ T)
        A += np.einsum("sab,sij->saibj", R @ rate if order else R, matrix)
    load = sum(
        (select_harmonics(f, h)[..., None] * vector[:, None] for f, vector in system.loads),
        np.zeros((S, H, n)),
    )
    return A.reshape(S, H * n, H * n), np.real(T.conj().T @ load).reshape(S, H * n)


def _solve(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    """Solve a batch of equations; nan for those that are singular."""
    try:
        return np.linalg.solve(A, b[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if len(A) == 1:
            return np.full_like(b, np.nan)
        return np.concatenate([_solve(A[i : i + 1], b[i : i + 1]) for i in range(len(A))])
