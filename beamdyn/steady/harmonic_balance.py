"""Harmonic balance of linear equations whose coefficients are periodic in two phases.

    M q'' + C(theta, chi) q' + K(theta, chi) q = f(theta, chi),   theta' = nu_1,  chi' = nu_2

The response q = sum_h q_h exp(i (j theta + k chi)), h = (j, k), is a function of the two phases;
d/dt becomes i Omega_h with Omega_h = j nu_1 + k nu_2.  Whether nu_1 / nu_2 is rational does not matter:
the solution covers every phase difference at once.  The coefficients are
trigonometric polynomials, so that an FFT of a few samples gives their harmonics exactly.

The equations determine which harmonics are kept: those of the load, then those that their products with
the periodic coefficients (interactions) add once, twice, and so on.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

Pair = tuple[int, int]  # a harmonic (j, k)

_EPS = np.finfo(float).eps
_MAXIMA = 6  # largest local maxima of the samples over the phases, which are refined
_NEWTON_STEPS = 4  # each squares the error


# Equations over the phases ------------------------------------------------------------------------


@dataclass(frozen=True)
class PeriodicSystem:
    """Equations with coefficients periodic in two phases, as harmonics, for a batch of S pairs of rates.

    A spectrum has the shape (S, N, N): the harmonic (j, k) is at [:, j, k], as in numpy's FFT.

    Parameters
    ----------
    rates : ndarray, shape (S, 2)
        Rates nu_1, nu_2 of the phases [rad/s].
    mean : ndarray, shape (3, S, n, n)
        Constant parts of K, C and M, in this order: of the derivatives 0, 1 and 2.
    varying : tuple of (int, ndarray, ndarray)
        Periodic parts: the order of the derivative (0 for K, 1 for C), a spectrum, its matrices (S, n, n).
    loads : tuple of (ndarray, ndarray)
        Terms of the load: a spectrum, its vectors (S, n).
    """

    rates: np.ndarray
    mean: np.ndarray
    varying: tuple[tuple[int, np.ndarray, np.ndarray], ...]
    loads: tuple[tuple[np.ndarray, np.ndarray], ...]

    def __getitem__(self, chosen: np.ndarray | slice) -> PeriodicSystem:
        """System at the chosen pairs of rates."""
        return PeriodicSystem(
            self.rates[chosen],
            self.mean[:, chosen],
            tuple((order, spectrum[chosen], matrix[chosen]) for order, spectrum, matrix in self.varying),
            tuple((spectrum[chosen], vector[chosen]) for spectrum, vector in self.loads),
        )

    def part(self, coordinates: np.ndarray) -> PeriodicSystem:
        """Equations of some coordinates, which no term couples with others."""
        rows = coordinates[:, None]
        varying = ((order, spectrum, A[:, rows, coordinates]) for order, spectrum, A in self.varying)
        loads = ((spectrum, vector[:, coordinates]) for spectrum, vector in self.loads)
        return PeriodicSystem(
            self.rates,
            self.mean[..., rows, coordinates],
            tuple(term for term in varying if term[2].any()),
            tuple(load for load in loads if load[1].any()),
        )

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.mean.shape[-1]

    @property
    def load_harmonics(self) -> set[Pair]:
        """Harmonics of the load."""
        return set().union(*(list_harmonics(spectrum) for spectrum, _ in self.loads))

    @property
    def coupling(self) -> set[Pair]:
        """Harmonics of the periodic coefficients."""
        return set().union(*(list_harmonics(spectrum) for _, spectrum, _ in self.varying))


def fourier_coefficients(samples: np.ndarray) -> np.ndarray:
    """Harmonics of samples (S, N, N) on a uniform grid of the phases; rounding error is set to 0."""
    spectrum = np.fft.fft2(samples) / (samples.shape[-1] * samples.shape[-2])
    return np.where(np.abs(spectrum) > 64 * _EPS * np.abs(samples).max(initial=0.0), spectrum, 0)


def is_resolved(spectrum: np.ndarray) -> bool:
    """Whether a spectrum vanishes in the upper half of the harmonics that its grid resolves."""
    high = np.abs(_indices(spectrum)) > spectrum.shape[-1] // 4
    return not (spectrum[:, high].any() or spectrum[:, :, high].any())


def list_harmonics(spectrum: np.ndarray) -> set[Pair]:
    """List the harmonics (j, k) that differ from 0 at some speed."""
    index = _indices(spectrum)
    return {(int(index[a]), int(index[b])) for a, b in np.argwhere(spectrum.any(axis=0))}


def _indices(spectrum: np.ndarray) -> np.ndarray:
    """Harmonic number at each index of an axis of a spectrum."""
    N = spectrum.shape[-1]
    return (np.arange(N) + N // 2) % N - N // 2


# Which harmonics to keep --------------------------------------------------------------------------


def generate_harmonics(start: Iterable[Pair], coupling: set[Pair], interactions: int) -> list[list[Pair]]:
    """Generate the harmonics that arise by interactions with the periodic coefficients.

    Parameters
    ----------
    start : iterable of pair
        Initial harmonics; with each, its opposite.
    coupling : set of pair
        Harmonics of the periodic coefficients.
    interactions : int
        Number of interactions.

    Returns
    -------
    list of list of pair
        Levels: the harmonics first reached by 0, 1, ... interactions; ends early if a level adds none.
    """
    levels, seen = [sorted(start)], set(start)
    for _ in range(interactions):
        new = {(j + a, k + b) for j, k in levels[-1] for a, b in coupling} - seen
        if not new:
            break
        levels.append(sorted(new))
        seen |= new
    return levels


def _real_basis(harmonics: list[Pair]) -> np.ndarray:
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


def _select(spectrum: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Select harmonics (..., 2) of a spectrum; 0 where its grid has no such harmonic."""
    half = spectrum.shape[-1] // 2
    inside = (np.abs(pairs) < half).all(axis=-1)
    j, k = np.moveaxis(np.where(inside[..., None], pairs, 0), -1, 0)
    return np.where(inside, spectrum[:, j, k], 0)


def convolution_matrix(spectrum: np.ndarray, harmonics: list[Pair], shift: Pair = (0, 0)) -> np.ndarray:
    """Matrices (S, H, H) of the product with a spectrum: its harmonic h - h' + shift is at (h, h')."""
    h = np.array(harmonics)
    return _select(spectrum, h[:, None] - h[None, :] + np.array(shift))


# Forced response ----------------------------------------------------------------------------------


def solve_harmonic_balance(system: PeriodicSystem, levels: list[list[Pair]]) -> tuple[np.ndarray, np.ndarray]:
    """Solve for the harmonics of the response, with all levels and without the last one.

    Parameters
    ----------
    system : PeriodicSystem
        The equations at S pairs of rates.
    levels : list of list of pair
        Harmonics to keep, from `generate_harmonics`; H in all.

    Returns
    -------
    response, truncated : ndarray of complex, shape (S, H, n)
        q_h, in the order of the levels; nan where the equations are singular.  `truncated` has zeros in
        the last level.
    """
    harmonics = [h for level in levels for h in level]
    H, n = len(harmonics), system.size
    T = _real_basis(harmonics)
    A, b = _assemble(system, harmonics, T)
    size = n * (H - len(levels[-1])) if len(levels) > 1 else 0
    truncated = np.zeros_like(b)
    truncated[:, :size] = _solve(A[:, :size, :size], b[:, :size])
    return T @ _solve(A, b).reshape(-1, H, n), T @ truncated.reshape(-1, H, n)


def _assemble(system: PeriodicSystem, harmonics: list[Pair], T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Assemble real equations A y = b: K - Omega_h^2 M, i Omega_h C, and the periodic coefficients."""
    h = np.array(harmonics)
    S, H, n = len(system.rates), len(h), system.size
    K, C, M = system.mean
    omega = system.rates @ h.T
    A = np.zeros((S, H, n, H, n))
    diagonal = np.arange(H)
    A[:, diagonal, :, diagonal] = np.moveaxis(K[:, None] - (omega**2)[..., None, None] * M[:, None], 1, 0)
    D = ((T.conj().T * 1j) @ (h.T[:, :, None] * T)).real  # of d/dtheta and d/dchi, shape (2, H, H)
    rate = np.einsum("sp,pab->sab", system.rates, D)
    if C.any():
        A += np.einsum("sab,sij->saibj", rate, C)
    for order, spectrum, matrix in system.varying:
        R = np.real(T.conj().T @ convolution_matrix(spectrum, harmonics) @ T)
        A += np.einsum("sab,sij->saibj", R @ rate if order else R, matrix)
    load = sum(
        (_select(f, h)[..., None] * vector[:, None] for f, vector in system.loads), np.zeros((S, H, n))
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


# Largest value over the phases --------------------------------------------------------------------


def largest_over_phases(amplitude: np.ndarray, harmonics: np.ndarray) -> np.ndarray:
    """Find the largest |u| of the vector u = sum_h Re(a_h exp(i h.phi)) over both phases phi.

    The largest maxima of samples are refined by Newton's method.

    Parameters
    ----------
    amplitude : ndarray of complex, shape (S, d, H)
        a_h, of d components.
    harmonics : ndarray of int, shape (H, 2)
        The harmonics h.

    Returns
    -------
    ndarray, shape (S,)
    """
    h = harmonics
    degree = np.abs(h).max(axis=0, initial=0)
    N = np.where(degree > 0, 6 * (degree + 1), 1)
    padded = np.zeros((*amplitude.shape[:2], *N), dtype=complex)
    padded[..., h[:, 0] % N[0], h[:, 1] % N[1]] = amplitude
    sampled = np.hypot.reduce(np.fft.ifft2(padded, norm="forward").real, axis=1)
    best = sampled.max(axis=(1, 2))
    phases = _find_maxima(sampled) * (2 * np.pi / N)
    for _ in range(_NEWTON_STEPS):
        size, slope, curvature = _evaluate_size(amplitude, h, phases)
        best = np.fmax(best, np.abs(size).max(axis=1))
        phases = phases + _ascent_step(size, slope, curvature, 2 * np.pi / N.max())
    return np.fmax(best, np.abs(_evaluate_size(amplitude, h, phases)[0]).max(axis=1))


def _ascent_step(value: np.ndarray, slope: np.ndarray, curvature: np.ndarray, longest: float) -> np.ndarray:
    """Newton's step towards larger |u|: with the magnitude of the curvatures, so that it avoids saddles."""
    k, axes = np.linalg.eigh(curvature)
    size = np.abs(k)
    inverse = np.where(size > 1e-8 * size.max(axis=-1, keepdims=True), 1 / np.where(size > 0, size, 1), 0)
    along = np.einsum("spab,spa->spb", axes, slope) * inverse * np.sign(value)[..., None]
    return np.einsum("spab,spb->spa", axes, np.clip(along, -longest, longest))


def _find_maxima(sampled: np.ndarray) -> np.ndarray:
    """Find the indices (S, P, 2) of the largest local maxima of the samples."""
    top = np.ones(sampled.shape, dtype=bool)
    for shift in ((a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)):
        top &= sampled >= np.roll(sampled, shift, axis=(1, 2))
    flat = np.where(top, sampled, -1.0).reshape(len(sampled), np.prod(sampled.shape[1:]))
    chosen = np.argpartition(-flat, min(_MAXIMA, flat.shape[1] - 1), axis=1)[:, :_MAXIMA]
    return np.stack(np.unravel_index(chosen, sampled.shape[1:]), axis=-1)


def _evaluate_size(
    a: np.ndarray, h: np.ndarray, phases: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evaluate |u|, with the sign of the first component, its gradient and second derivatives."""
    u, slope, curvature = _evaluate(a, h, phases)
    size = np.copysign(np.hypot.reduce(u, axis=1), u[:, 0])
    divisor = np.where(size == 0, 1.0, size)
    direction = u / divisor[:, None]
    along = np.einsum("sdp,sdpa->spa", direction, slope)
    turning = slope - direction[..., None] * along[:, None]  # the slope that changes the direction only
    bending = np.einsum("sdp,sdpab->spab", direction, curvature)
    sideways = turning / divisor[:, None, :, None]
    return size, along, bending + np.einsum("sdpa,sdpb->spab", turning, sideways)


def _evaluate(a: np.ndarray, h: np.ndarray, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Evaluate u (S, d, P), its gradient and its matrix of second derivatives at phases (S, P, 2).

    In real numbers, as products with the cosines and sines of h.phi, which takes a sixth of the time.
    """
    (S, d, _), P = a.shape, phases.shape[1]
    first = h.T.astype(float)
    even = np.concatenate([np.ones((1, len(h))), -(first[:, None] * first).reshape(4, -1)])
    angle = phases @ first
    cos, sin = np.cos(angle), np.sin(angle)
    real, imaginary = np.real(a), np.imag(a)
    value_and_curvature = _sum_waves(even, real, -imaginary, cos, sin)
    slope = _sum_waves(-first, imaginary, real, cos, sin)
    return value_and_curvature[..., 0], slope, value_and_curvature[..., 1:].reshape(S, d, P, 2, 2)


def _sum_waves(
    weights: np.ndarray, of_cos: np.ndarray, of_sin: np.ndarray, cos: np.ndarray, sin: np.ndarray
) -> np.ndarray:
    """Sums over h of w_h (x_h cos + y_h sin): (S, d, P, k) of weights w (k, H), x and y (S, d, H)."""
    S, d, H = of_cos.shape
    factors = (
        (x[:, :, None] * weights).reshape(S, d * len(weights), H).swapaxes(1, 2) for x in (of_cos, of_sin)
    )
    sums = sum(wave @ factor for wave, factor in zip((cos, sin), factors, strict=True))
    return np.reshape(sums, (S, cos.shape[1], d, len(weights))).swapaxes(1, 2)
