"""Harmonic balance of equations with coefficients periodic in two phases: of rotation and of the road.

The response q = sum_h q_h exp(i (j theta + k chi)), h = (j, k), is a function of the two phases of a
`PeriodicSystem`; d/dt becomes i Omega_h with Omega_h = j nu_1 + k nu_2.  Whether nu_1 / nu_2 is rational does
not matter: the solution covers every phase difference at once.

The equations determine which harmonics are kept: those of the load, then those that are added when these are
multiplied by the periodic coefficients (an interaction) once, twice, and so on.

The equations are solved as a series, whose terms add one interaction each.  In the undamped modes of the mean
equations, there is one equation for each harmonic h of each mode a:

    (k_a - Omega_h^2 + i Omega_h c_aa) y_ha = f_ha - (terms that couple it with other harmonics and modes)

with the modal stiffness k_a, damping c_aa, response y_ha and load f_ha for unit modal mass.  The coupling
terms come from the periodic coefficients and from damping; they are small, relative to the factor in brackets
on the left, except near a resonance.  So the equations are solved iteratively, with the response of the
previous iteration in the coupling terms: each iteration multiplies the error by the ratio of the coupling to
that factor, some 1e-3, so that a few iterations reach rounding error.

Where damping, a gyroscopic term or a circuit couples modes strongly, the matrix of the mean equations at each
Omega_h replaces that factor, and only the periodic coefficients count as coupling.

In shapes of arrays, H counts harmonics, n coordinates, S speeds, and N samples of a phase.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.steady.periodic_system import MeanModes, Pair, PeriodicSystem, list_harmonics, select_harmonics

_MOST_ENTRIES = 10**7  # largest number of matrix entries solved as one batch: 80 MB, or 160 MB if complex
# Largest number of terms of the series: enough to converge if each term divides the error by 5.
_MOST_TERMS = 24
_SETTLED = 4 * np.finfo(float).eps  # relative change by one term below which the series has converged
# Pairs of phase rates that have converged are removed from the arrays only if they are at least this fraction
# of the pairs in them: the arrays are copied for this, which takes time, too.
_WORTH_LEAVING_OUT = 0.25


def solve_harmonic_balance(system: PeriodicSystem, harmonics: Sequence[Pair]) -> np.ndarray:
    """Solve for given harmonics of the response by a series of interactions.

    At phase rates at which no series converges, one matrix of all harmonics is solved instead.

    Parameters
    ----------
    system : PeriodicSystem
        The equations at S pairs of phase rates [rad/s].
    harmonics : sequence of pair, length H
        Harmonics (j, k) to keep; for each, the opposite (-j, -k) must also be in the sequence.

    Returns
    -------
    ndarray of complex, shape (S, H, coordinates)
        Harmonics q_h of the response; nan where the equations are singular.
    """
    response, settled = sum_interactions(system, harmonics, _Series.by_modes)
    for rows in _batches(~settled, system.size**2 * len(harmonics)):
        response[rows], settled[rows] = sum_interactions(system[rows], harmonics, _Series.by_matrices)
    for rows in _batches(~settled, (system.size * len(harmonics)) ** 2):
        response[rows] = solve_at_once(system[rows], harmonics)
    return response


def _batches(chosen: np.ndarray, entries: int) -> list[np.ndarray]:
    """Split the indices of chosen pairs of phase rates, each with a number of entries, into batches."""
    indices = np.flatnonzero(chosen)
    parts = np.array_split(indices, 1 + len(indices) * entries // _MOST_ENTRIES)
    return [part for part in parts if len(part)]


def solve_at_once(system: PeriodicSystem, harmonics: Sequence[Pair]) -> np.ndarray:
    """Solve for given harmonics of the response by one linear system for all of them, without a series.

    Arguments and result are those of `solve_harmonic_balance`.
    """
    T = _real_basis(harmonics)
    A, b = _assemble(system, harmonics, T)
    try:
        y = np.linalg.solve(A, b[..., None])[..., 0]
    except np.linalg.LinAlgError:  # results are nan at phase rates at which the equations are singular
        if len(A) == 1:
            return np.full((1, len(harmonics), system.size), np.nan, dtype=complex)
        parts = (solve_at_once(system[i : i + 1], harmonics) for i in range(len(A)))
        return np.concatenate([*parts])
    return T @ y.reshape(-1, len(harmonics), system.size)


def convolution_matrix(spectrum: np.ndarray, harmonics: Sequence[Pair], shift: Pair = (0, 0)) -> np.ndarray:
    """Build the matrices from the harmonics of a factor to the harmonics of its product with a function.

    Parameters
    ----------
    spectrum : ndarray of complex, shape (S, samples, samples)
        Harmonics of the function, which depends on the two phases.
    harmonics : sequence of pair, length H
        Harmonics (j, k) of the factor (columns of the matrices), and of the product (rows).
    shift : pair
        Offset: the entry (h, h') of a matrix is the harmonic h - h' + shift of the spectrum.

    Returns
    -------
    ndarray of complex, shape (S, H, H)
    """
    h = np.array(harmonics)
    return select_harmonics(spectrum, h[:, None] - h[None, :] + np.array(shift))


def _real_basis(harmonics: Sequence[Pair]) -> np.ndarray:
    """Build the unitary matrix T, shape (H, H), from cosine and sine parts to complex harmonics.

    Each pair of opposite harmonics h, -h has one cosine part and one sine part, in the places of h and -h.
    """
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
    """Assemble real equations of harmonic balance for the cosine and sine parts of all harmonics.

    The diagonal block of a harmonic h is K - Omega_h^2 M + i Omega_h C; the periodic coefficients couple
    different harmonics.  The matrix T of `_real_basis` makes the equations real.

    Return the matrices, shape (S, H n, H n), and the right-hand sides, shape (S, H n).
    """
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
        _add_products(A, rate, C)
    for order, spectrum, matrix in system.varying:
        R = np.real(T.conj().T @ convolution_matrix(spectrum, harmonics) @ T)
        _add_products(A, R @ rate if order else R, matrix)
    load = sum(
        (select_harmonics(f, h)[..., None] * vector[:, None] for f, vector in system.loads),
        np.zeros((S, H, n)),
    )
    A = A.reshape(S, H * n, H * n)
    if (free := system.is_free(h)).any():
        speed, place = np.nonzero(free.reshape(S, H * n))
        A[speed, place, place] = 1.0
    return A, np.real(T.conj().T @ load).reshape(S, H * n)


def _add_products(A: np.ndarray, factors: np.ndarray, matrices: np.ndarray) -> None:
    """Add products of factors and matrices to the blocks of A, in place.

    The block of two harmonics is A[:, g, :, h] in the array A of shape (S, H, n, H, n).  The product of
    `factors`[:, g, h], shape (S,), and of the matrices, shape (S, n, n), is added to it.  Pairs of harmonics
    whose factors are 0, which are most of them, are skipped.
    """
    row, column = np.nonzero(factors.any(axis=0))
    A[:, row, :, column] += factors[:, row, column].T[..., None, None] * matrices


# Series of interactions ----------------------------------------------------------------------------


def sum_interactions(
    system: PeriodicSystem,
    harmonics: Sequence[Pair],
    series_of: Callable[[PeriodicSystem, list[Pair]], _Series | None],
) -> tuple[np.ndarray, np.ndarray]:
    """Sum a series of interactions for given harmonics of the response.

    Parameters
    ----------
    system : PeriodicSystem
        The equations at S pairs of phase rates [rad/s].
    harmonics : sequence of pair, length H
        Harmonics (j, k) to keep; for each, the opposite (-j, -k) must also be in the sequence.
    series_of : callable
        Function that builds the series, or returns None if it does not exist.

    Returns
    -------
    response : ndarray of complex, shape (S, H, coordinates)
        Harmonics q_h of the response; nan where the series has not converged.
    settled : ndarray of bool, shape (S,)
        Whether the series has converged to rounding error.
    """
    S, n = len(system.rates), system.size
    response, settled = np.full((S, len(harmonics), n), np.nan, dtype=complex), np.zeros(S, dtype=bool)
    half = [h for h in harmonics if h >= (0, 0)]  # the harmonics -h are the conjugates of these
    with np.errstate(all="ignore"):  # the series may diverge, or a harmonic may be in resonance
        if (series := series_of(system, half)) is None:
            return response, settled
        shapes, y = series.shapes, series.comply(series.load)
        found, left = np.full_like(y, np.nan), np.arange(S)
        for _ in range(_MOST_TERMS):
            last, y = y, series.respond(y)
            size = _size(y)
            now = (_size(y - last) <= _SETTLED * size) & np.isfinite(size)
            settled[left[now]] = True
            found[..., left[now]] = y[..., now]
            if now.all():
                break
            if now.mean() >= _WORTH_LEAVING_OUT:
                y, left, series = y[..., ~now], left[~now], series[~now]
    q = np.einsum("snm,hms->shn", shapes, found)
    index = {h: i for i, h in enumerate(half)}
    for place, h in enumerate(harmonics):
        response[:, place] = q[:, index[h]] if h in index else q[:, index[-h[0], -h[1]]].conj()
    return response, settled


def _size(y: np.ndarray) -> np.ndarray:
    """Compute one magnitude (S,) of the response y (harmonics, modes, S) for each pair of phase rates.

    It is the sum of the magnitudes of all real and imaginary parts.
    """
    return (np.abs(np.real(y)) + np.abs(np.imag(y))).sum(axis=(0, 1))


@dataclass(frozen=True)
class _Products:
    """Products of the response with the periodic coefficients of one matrix of the equations.

    Parameters
    ----------
    order : int
        Order of the response's derivative: 0 or 1.
    matrix : ndarray, shape (coordinates, coordinates, S)
        Matrix in modal coordinates.
    factors : tuple of ndarray, shape (S,)
        Complex amplitudes of the harmonics of the periodic coefficient.
    places : tuple of (ndarray, ndarray)
        For each factor, the indices of the harmonics to which its products contribute, among the H harmonics;
        and the indices of the harmonics that it multiplies, among the H harmonics followed by their
        conjugates.
    """

    order: int
    matrix: np.ndarray
    factors: tuple[np.ndarray, ...]
    places: tuple[tuple[np.ndarray, np.ndarray], ...]

    @classmethod
    def of(
        cls, order: int, spectrum: np.ndarray, matrix: np.ndarray, mean: MeanModes, harmonics: list[Pair]
    ) -> _Products:
        """Build the products of a response of given harmonics with one periodic coefficient.

        `spectrum` has the harmonics of the coefficient; `matrix`, (S, n, n), is transformed to the modes
        `mean`.  None of the harmonics of the response is the opposite of another.
        """
        index = {h: i for i, h in enumerate(harmonics)}
        for (j, k), i in tuple(index.items()):
            index.setdefault((-j, -k), len(harmonics) + i)
        factors, places = [], []
        for a, b in sorted(list_harmonics(spectrum)):
            pairs = [(i, index.get((j - a, k - b), -1)) for i, (j, k) in enumerate(harmonics)]
            if met := [pair for pair in pairs if pair[1] >= 0]:
                factors.append(spectrum[:, a, b])
                to, source = np.transpose(met)
                places.append((to, source))
        return cls(order, mean.transform(matrix), tuple(factors), tuple(places))

    def __getitem__(self, chosen: np.ndarray) -> _Products:
        factors = tuple(factor[chosen] for factor in self.factors)
        return replace(self, matrix=self.matrix[..., chosen], factors=factors)

    def sum(self, both: np.ndarray, count: int) -> np.ndarray:
        """Sum the products with all harmonics of the response and their conjugates: forces (H, n, S).

        The array `both`, (2 H, n, S), has the H = `count` harmonics and then their conjugates.
        """
        product = np.zeros((count, *both.shape[1:]), dtype=complex)
        for factor, (to, source) in zip(self.factors, self.places, strict=True):
            product[to] += factor * both[source]
        return _multiply(self.matrix, product)


@dataclass(frozen=True)
class _Series:
    """Terms of a series of interactions, for H harmonics, n modes or coordinates and S pairs of phase rates.

    Of the H harmonics, none is the opposite of another.

    Parameters
    ----------
    shapes : ndarray, shape (S, coordinates, n)
        Modes, in columns.
    load : ndarray of complex, shape (H, n, S)
        Harmonics of the modal load.
    compliance : ndarray of complex, shape (H, n, S) or (H, n, n, S)
        Response of each uncoupled mode to a load of each harmonic, or matrix of the responses of all.
    rate : ndarray of complex, shape (H, 1, S)
        Factor i Omega_h [1/s] of a time derivative.
    damping : ndarray, shape (n, n, S), or None
        Damping between different modes that `compliance` does not contain; None if there is none.
    products : tuple of _Products
        Products with the periodic coefficients.
    """

    shapes: np.ndarray
    load: np.ndarray
    compliance: np.ndarray
    rate: np.ndarray
    damping: np.ndarray | None
    products: tuple[_Products, ...]

    @classmethod
    def by_modes(cls, system: PeriodicSystem, harmonics: list[Pair]) -> _Series | None:
        """Build the series in the undamped modes of the mean equations.

        There is none without stiffness, or without mass.
        """
        h, C = np.array(harmonics), system.mean[1]
        if system.is_free(h).any():  # without stiffness a static response is infinite
            return None
        try:
            mean = MeanModes.of_system(system)
        except np.linalg.LinAlgError:
            return None
        rate = _rates(system, h)
        damping = mean.transform(C) if C.any() else None
        resistance = mean.squared.T + rate**2
        if damping is not None:
            own = np.arange(system.size)
            resistance = resistance + rate * damping[own, own]
            damping[own, own] = 0.0
        return cls._of(system, harmonics, mean, 1 / resistance, damping)

    @classmethod
    def by_matrices(cls, system: PeriodicSystem, harmonics: list[Pair]) -> _Series | None:
        """Build the series in the coordinates, with the inverse matrices of the mean equations.

        There is none if a matrix is singular.
        """
        (K, C, M), h = system.mean, np.array(harmonics)
        rate = _rates(system, h)[:, 0, :, None, None]
        matrices = K + rate * C + rate**2 * M
        own = np.arange(system.size)
        matrices[..., own, own] += np.swapaxes(system.is_free(h), 0, 1)
        try:
            compliance = np.ascontiguousarray(np.moveaxis(np.linalg.inv(matrices), 1, -1))
        except np.linalg.LinAlgError:
            return None
        coordinates = np.broadcast_to(np.eye(system.size), K.shape)
        return cls._of(system, harmonics, MeanModes(np.zeros(K.shape[:2]), coordinates), compliance, None)

    @classmethod
    def _of(
        cls,
        system: PeriodicSystem,
        harmonics: list[Pair],
        mean: MeanModes,
        compliance: np.ndarray,
        damping: np.ndarray | None,
    ) -> _Series:
        """Build the series with the loads and the periodic coefficients of a system in given modes."""
        h = np.array(harmonics)
        load = np.zeros((len(h), system.size, len(system.rates)), dtype=complex)
        for spectrum, vector in system.loads:
            in_modes = np.einsum("snm,sn->ms", mean.shapes, vector)
            load += select_harmonics(spectrum, h).T[:, None] * in_modes
        products = tuple(_Products.of(*each, mean, harmonics) for each in system.varying)
        return cls(mean.shapes, load, compliance, _rates(system, h), damping, products)

    def __getitem__(self, chosen: np.ndarray) -> _Series:
        damping = None if self.damping is None else self.damping[..., chosen]
        products = tuple(each[chosen] for each in self.products)
        load, compliance, rate = (each[..., chosen] for each in (self.load, self.compliance, self.rate))
        return _Series(self.shapes, load, compliance, rate, damping, products)

    def respond(self, y: np.ndarray) -> np.ndarray:
        """Compute the next iterate of the response (H, n, S), with coupling terms from the last iterate y."""
        force, both = self.load.copy(), np.concatenate([y, y.conj()])
        for products in self.products:
            of_rate = np.concatenate([self.rate, -self.rate]) if products.order else 1.0
            force -= products.sum(of_rate * both, len(y))
        if self.damping is not None:
            force -= self.rate * _multiply(self.damping, y)
        return self.comply(force)

    def comply(self, force: np.ndarray) -> np.ndarray:
        """Compute the response (H, n, S) to forces (H, n, S) without coupling terms."""
        return force * self.compliance if self.compliance.ndim == 3 else _multiply(self.compliance, force)


def _rates(system: PeriodicSystem, h: np.ndarray) -> np.ndarray:
    """Compute the factors i Omega_h [1/s] of time derivatives of the harmonics h: (H, 1, S)."""
    return 1j * (h @ system.rates.T)[:, None]


def _multiply(matrix: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Multiply y (H, n, S), for each pair of phase rates, by matrices (n, n, S), or (H, n, n, S)."""
    total = np.empty_like(y)
    for row, out in zip(np.moveaxis(matrix, -3, 0), np.moveaxis(total, 1, 0), strict=True):
        out[:] = (row * y).sum(axis=1)
    return total
