"""Harmonic balance of linear equations whose coefficients are periodic in two phases.

    M q'' + C(theta, chi) q' + K(theta, chi) q = f(theta, chi),   theta' = nu_1,  chi' = nu_2

The response q = sum_h q_h exp(i (j theta + k chi)), h = (j, k), is a function of the two phases;
d/dt becomes i Omega_h with Omega_h = j nu_1 + k nu_2.  Whether nu_1 / nu_2 is rational does not matter:
it holds the responses for every phase difference at once.  The coefficients are
trigonometric polynomials, so that a few samples and an FFT give their harmonics exactly.

Which harmonics are kept follows from the equations: those of the load, then those that the periodic
coefficients make of them in one interaction, in two, and so on.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

Pair = tuple[int, int]  # a harmonic (j, k)

_EPS = np.finfo(float).eps
_NEUTRAL = 1e-9  # real part, relative to the largest eigenvalue, below which it is rounding
_SHARE = 0.1  # of a vector, that is 0.5 in a tongue of two modes and near 1 outside
_PEAKS = 6  # largest maxima of the samples over the phases, from which the largest is refined
_REFINEMENTS = 4  # Newton steps; the error of a sample is squared by each


# Equations over the phases ------------------------------------------------------------------------


@dataclass(frozen=True)
class PeriodicSystem:
    """Equations with their coefficients as harmonics, for a batch of S pairs of rates.

    A spectrum has the shape (S, N, N): the harmonic (j, k) stands at [:, j, k], as numpy's FFT has it.

    Parameters
    ----------
    rates : ndarray, shape (S, 2)
        Rates nu_1, nu_2 of the phases [rad/s].
    mean : ndarray, shape (3, S, n, n)
        Constant parts of K, C and M, in this order.
    varying : tuple of (int, ndarray, ndarray)
        Periodic parts: the order of the derivative (0 or 1), a spectrum, its matrix (n, n).
    loads : tuple of (ndarray, ndarray)
        Parts of the load: a spectrum, its vector (n,).
    """

    rates: np.ndarray
    mean: np.ndarray
    varying: tuple[tuple[int, np.ndarray, np.ndarray], ...]
    loads: tuple[tuple[np.ndarray, np.ndarray], ...]

    def __getitem__(self, chosen: np.ndarray | slice) -> PeriodicSystem:
        """The system at some of its rates."""
        return PeriodicSystem(
            self.rates[chosen],
            self.mean[:, chosen],
            tuple((order, spectrum[chosen], matrix) for order, spectrum, matrix in self.varying),
            tuple((spectrum[chosen], vector) for spectrum, vector in self.loads),
        )

    @property
    def size(self) -> int:
        """Number of coordinates n."""
        return self.mean.shape[-1]

    @property
    def forced(self) -> set[Pair]:
        """Harmonics of the load."""
        return set().union(*(list_harmonics(spectrum) for spectrum, _ in self.loads))

    @property
    def coupling(self) -> set[Pair]:
        """Harmonics of the periodic coefficients."""
        return set().union(*(list_harmonics(spectrum) for _, spectrum, _ in self.varying))


def fourier_coefficients(samples: np.ndarray) -> np.ndarray:
    """Harmonics of samples on an even grid of the two phases, of shape (S, N, N); rounding is set to 0."""
    spectrum = np.fft.fft2(samples) / (samples.shape[-1] * samples.shape[-2])
    return np.where(np.abs(spectrum) > 64 * _EPS * np.abs(samples).max(initial=0.0), spectrum, 0)


def is_resolved(spectrum: np.ndarray) -> bool:
    """Whether a spectrum ends well before the highest harmonic that its grid can tell."""
    high = np.abs(_indices(spectrum)) > spectrum.shape[-1] // 4
    return not (spectrum[:, high].any() or spectrum[:, :, high].any())


def list_harmonics(spectrum: np.ndarray) -> set[Pair]:
    """Harmonics (j, k) that are not 0 at every speed."""
    index = _indices(spectrum)
    return {(int(index[a]), int(index[b])) for a, b in np.argwhere(spectrum.any(axis=0))}


def _indices(spectrum: np.ndarray) -> np.ndarray:
    N = spectrum.shape[-1]
    return (np.arange(N) + N // 2) % N - N // 2


# Which harmonics to keep --------------------------------------------------------------------------


def list_reached(start: Iterable[Pair], coupling: set[Pair], steps: int) -> list[list[Pair]]:
    """Harmonics that `start` becomes by interactions with the coupling.

    Parameters
    ----------
    start : iterable of pair
        The harmonics at first, with the opposite of each.
    coupling : set of pair
        The harmonics of the periodic coefficients.
    steps : int
        How many interactions.

    Returns
    -------
    list of list of pair
        The harmonics new after 0, 1, ... interactions; the list ends early where none is new.
    """
    levels, known = [sorted(start)], set(start)
    for _ in range(steps):
        new = {(j + a, k + b) for j, k in levels[-1] for a, b in coupling} - known
        if not new:
            break
        levels.append(sorted(new))
        known |= new
    return levels


def _real_form(harmonics: list[Pair]) -> np.ndarray:
    """Unitary T with (q_h) = T y, where y is real if q is: cosine and sine parts of each pair h, -h."""
    place = {h: i for i, h in enumerate(harmonics)}
    T = np.zeros((len(place), len(place)), dtype=complex)
    for h, i in place.items():
        o = place[-h[0], -h[1]]
        if i == o:
            T[i, i] = 1
        elif i < o:
            T[[i, o], i] = np.sqrt(0.5)
            T[[i, o], o] = np.sqrt(0.5) * np.array([-1j, 1j])
    return T


def _pick(spectrum: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Entries of a spectrum at harmonics of shape (..., 2); 0 where its grid has no such harmonic."""
    half = spectrum.shape[-1] // 2
    inside = (np.abs(pairs) < half).all(axis=-1)
    j, k = np.moveaxis(np.where(inside[..., None], pairs, 0), -1, 0)
    return np.where(inside, spectrum[:, j, k], 0)


def _toeplitz(spectrum: np.ndarray, harmonics: list[Pair]) -> np.ndarray:
    """Matrices (S, H, H) with the entry of harmonic h - h' at (h, h')."""
    h = np.array(harmonics)
    return _pick(spectrum, h[:, None] - h[None, :])


# Forced response ----------------------------------------------------------------------------------


def solve_balance(system: PeriodicSystem, levels: list[list[Pair]]) -> tuple[np.ndarray, np.ndarray]:
    """Harmonics of the response, and of the response without the last level.

    Parameters
    ----------
    system : PeriodicSystem
        The equations at S pairs of rates.
    levels : list of list of pair
        Harmonics to keep, as `list_reached` gives them; H in all.

    Returns
    -------
    response, shorter : ndarray of complex, shape (S, H, n)
        q_h, in the order of the levels; nan where the equations are singular.
    """
    harmonics = [h for level in levels for h in level]
    H, n = len(harmonics), system.size
    T = _real_form(harmonics)
    A, b = _assemble(system, harmonics, T)
    kept = n * (H - len(levels[-1])) if len(levels) > 1 else 0
    shorter = np.zeros_like(b)
    shorter[:, :kept] = _solve(A[:, :kept, :kept], b[:, :kept])
    return T @ _solve(A, b).reshape(-1, H, n), T @ shorter.reshape(-1, H, n)


def _assemble(system: PeriodicSystem, harmonics: list[Pair], T: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Real equations A y = b: K - Omega_h^2 M on the diagonal, i Omega_h C, and the periodic coefficients."""
    h = np.array(harmonics)
    S, H, n = len(system.rates), len(h), system.size
    K, C, M = system.mean
    omega = system.rates @ h.T
    A = np.zeros((S, H, n, H, n))
    every = np.arange(H)
    A[:, every, :, every] = np.moveaxis(K[:, None] - (omega**2)[..., None, None] * M[:, None], 1, 0)
    D = ((T.conj().T * 1j) @ (h.T[:, :, None] * T)).real  # of d/dtheta and d/dchi, shape (2, H, H)
    rate = np.einsum("sp,pab->sab", system.rates, D)
    if C.any():
        A += np.einsum("sab,sij->saibj", rate, C)
    for order, spectrum, matrix in system.varying:
        R = np.real(T.conj().T @ _toeplitz(spectrum, harmonics) @ T)
        A += np.einsum("sab,ij->saibj", R @ rate if order else R, matrix)
    load = sum((_pick(f, h)[..., None] * vector for f, vector in system.loads), np.zeros((S, H, n)))
    return A.reshape(S, H * n, H * n), np.real(T.conj().T @ load).reshape(S, H * n)


def _solve(A: np.ndarray, b: np.ndarray) -> np.ndarray:
    try:
        return np.linalg.solve(A, b[..., None])[..., 0]
    except np.linalg.LinAlgError:
        if len(A) == 1:
            return np.full_like(b, np.nan)
        return np.concatenate([_solve(A[i : i + 1], b[i : i + 1]) for i in range(len(A))])


# Stability ----------------------------------------------------------------------------------------


def growth_rate(system: PeriodicSystem, interactions: int) -> np.ndarray:
    """Largest rate of growth of a free motion [1/s], shape (S,); 0 or less where it is stable.

    A free motion is exp(s t) times a function of the phases (Hill's method in two phases).  Where the
    ratio of the rates is irrational there is no period and no monodromy matrix, but the exponents s
    are still eigenvalues of the balance's operator, here in the modes of the mean equations:

        (s + i Omega_h) z_h = diag(sigma) z_h + sum_g V_(h-g) z_g

    With V = 0 the eigenvalues are sigma_a - i Omega_h.  Each stays in the disc (Gershgorin) of radius
    rho_a, the sum of its row of |V|, about that place.  Without damping, and with a mean energy that
    is positive, an eigenvalue leaves the imaginary axis only by meeting one of opposite energy (Krein),
    so that where no disc of sigma_a meets one of a conjugate sigma_b - i Omega_h, or all discs lie to
    the left, the motion is stable; only where they meet the eigenvalues are computed and the sign of
    their real parts decides.  Tongues of as many interactions as are kept are seen.  Tongues of
    higher order, which exist without damping near every rational combination, are narrower
    than the neglected harmonics resolve, and the slightest damping closes them.

    Parameters
    ----------
    system : PeriodicSystem
        The equations.
    interactions : int
        Interactions with the periodic coefficients that are kept.

    Returns
    -------
    ndarray, shape (S,)
    """
    A, periodic = _first_order(system)
    sigma, R = np.linalg.eig(A)
    largest = np.abs(sigma).max(axis=1)
    rate = _growth_rate(sigma, largest)
    harmonics = [h for level in list_reached([(0, 0)], system.coupling, interactions) for h in level]
    steady = np.flatnonzero((rate <= 0) & (np.abs(sigma).min(axis=1) > 0))
    if len(harmonics) == 1 or not len(steady):
        return rate
    sigma, V = (
        sigma[steady],
        _in_modes(sigma[steady], R[steady], [(f[steady], B[steady]) for f, B in periodic]),
    )
    omega = system.rates[steady] @ np.array(harmonics).T
    meet = _discs_meet(sigma, V, omega)
    for i in np.flatnonzero(meet):
        hill = _hill(sigma[i], [(f[i : i + 1], v[i]) for f, v in V], omega[i], harmonics)
        rate[steady[i]] = _hill_growth(hill, A.shape[-1], largest[steady[i]])
    return rate


def _growth_rate(s: np.ndarray, scale: np.ndarray | float) -> np.ndarray:
    """Largest real part, 0 where it is rounding."""
    largest = np.real(s).max(axis=-1)
    return np.where(np.abs(largest) <= _NEUTRAL * scale, 0.0, largest)


def _first_order(system: PeriodicSystem) -> tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray]]]:
    """The equations y' = (A + sum_h c_h B e^(ih.phi)) y for y = (w q, q'); w makes A's halves alike."""
    K, C, M = system.mean
    S, n = len(K), system.size
    K, C = np.linalg.solve(M, K), np.linalg.solve(M, C)
    w = np.sqrt(np.abs(K).max(axis=(1, 2)))[:, None, None]
    A = np.zeros((S, 2 * n, 2 * n))
    A[:, :n, n:], A[:, n:, :n], A[:, n:, n:] = w * np.eye(n), -K / w, -C
    periodic = []
    for order, spectrum, matrix in system.varying:
        B = np.zeros_like(A)
        B[:, n:, n * order : n * order + n] = -np.linalg.solve(M, matrix) / (1 if order else w)
        periodic.append((spectrum, B))
    return A, periodic


def _in_modes(
    sigma: np.ndarray, R: np.ndarray, periodic: list[tuple[np.ndarray, np.ndarray]]
) -> list[tuple[np.ndarray, np.ndarray]]:
    """V = R^-1 B R with the columns of R scaled to equal action, which makes |V| symmetric."""
    n = R.shape[-1] // 2
    R = R / (np.linalg.norm(R[:, :n], axis=1) * np.sqrt(np.abs(sigma)))[:, None, :]
    return [(spectrum, np.linalg.solve(R, B @ R)) for spectrum, B in periodic]


def _discs_meet(sigma: np.ndarray, V: list[tuple[np.ndarray, np.ndarray]], omega: np.ndarray) -> np.ndarray:
    """Where a disc of positive energy may meet one of negative energy right of the imaginary axis."""
    radius = sum(
        (np.abs(f).sum(axis=(1, 2))[:, None] * np.abs(v).sum(axis=2) for f, v in V), 0 * np.abs(sigma)
    )
    gap = sigma[:, :, None, None] - sigma[:, None, :, None] + 1j * omega[:, None, None, :]
    near = np.abs(gap) <= (radius[:, :, None] + radius[:, None, :])[..., None]
    opposite = (np.imag(sigma) >= 0)[:, :, None] & (np.imag(sigma) <= 0)[:, None, :]
    rightmost = (np.real(sigma) + radius).max(axis=1) > 0
    return (near & opposite[..., None]).any(axis=(1, 2, 3)) & rightmost


def _hill_growth(hill: np.ndarray, n: int, scale: float) -> np.ndarray:
    """Largest real part, of vectors with a good share in the first harmonic, which has all its neighbours.

    Every exponent s comes again as s + i Omega_h about each harmonic; at the rim, where neighbours are cut
    off, these copies are off.  In a tongue the vector is shared by two harmonics in equal parts.
    """
    rate = _growth_rate(np.linalg.eigvals(hill), scale)
    if rate <= 0:
        return rate
    s, z = np.linalg.eig(hill)
    share = (np.abs(z[:n]) ** 2).sum(axis=0) / (np.abs(z) ** 2).sum(axis=0)
    return _growth_rate(s[share > _SHARE], scale)


def _hill(
    sigma: np.ndarray, V: list[tuple[np.ndarray, np.ndarray]], omega: np.ndarray, harmonics: list[Pair]
) -> np.ndarray:
    """The balance's operator at one pair of rates."""
    hill = np.diag((sigma - 1j * omega[:, None]).ravel())
    for spectrum, v in V:
        hill += np.kron(_toeplitz(spectrum, harmonics)[0], v)
    return hill


# Largest value over the phases --------------------------------------------------------------------


def largest_over_phases(amplitude: np.ndarray, harmonics: np.ndarray) -> np.ndarray:
    """Largest |u| of u = sum_h Re(a_h exp(i h.phi)) over both phases.

    The maxima of samples are refined by Newton's method.

    Parameters
    ----------
    amplitude : ndarray of complex, shape (S, H)
        a_h.
    harmonics : ndarray of int, shape (H, 2)
        The harmonics h.

    Returns
    -------
    ndarray, shape (S,)
    """
    h = harmonics
    degree = np.abs(h).max(axis=0, initial=0)
    N = np.where(degree > 0, 6 * (degree + 1), 1)
    padded = np.zeros((len(amplitude), *N), dtype=complex)
    padded[:, h[:, 0] % N[0], h[:, 1] % N[1]] = amplitude
    sampled = np.abs(np.fft.ifft2(padded, norm="forward").real)
    best = sampled.max(axis=(1, 2))
    phases = _peaks(sampled) * (2 * np.pi / N)
    for _ in range(_REFINEMENTS):
        value, slope, curvature = _expansion(amplitude, h, phases)
        best = np.fmax(best, np.abs(value).max(axis=1))
        phases = phases + _uphill(value, slope, curvature, 2 * np.pi / N.max())
    return np.fmax(best, np.abs(_expansion(amplitude, h, phases)[0]).max(axis=1))


def _uphill(value: np.ndarray, slope: np.ndarray, curvature: np.ndarray, longest: float) -> np.ndarray:
    """Newton's step towards larger |u|: with |curvature|, so that it never heads for a saddle."""
    k, axes = np.linalg.eigh(curvature)
    size = np.abs(k)
    inverse = np.where(size > 1e-8 * size.max(axis=-1, keepdims=True), 1 / np.where(size > 0, size, 1), 0)
    along = np.einsum("spab,spa->spb", axes, slope) * inverse * np.sign(value)[..., None]
    return np.einsum("spab,spb->spa", axes, np.clip(along, -longest, longest))


def _peaks(sampled: np.ndarray) -> np.ndarray:
    """Places (S, P, 2) of the largest samples that no neighbour exceeds."""
    top = np.ones(sampled.shape, dtype=bool)
    for shift in ((a, b) for a in (-1, 0, 1) for b in (-1, 0, 1)):
        top &= sampled >= np.roll(sampled, shift, axis=(1, 2))
    flat = np.where(top, sampled, -1.0).reshape(len(sampled), np.prod(sampled.shape[1:]))
    chosen = np.argpartition(-flat, min(_PEAKS, flat.shape[1] - 1), axis=1)[:, :_PEAKS]
    return np.stack(np.unravel_index(chosen, sampled.shape[1:]), axis=-1)


def _expansion(a: np.ndarray, h: np.ndarray, phases: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """u, its gradient and its matrix of second derivatives at phases of shape (S, P, 2)."""
    waves = a[:, None] * np.exp(1j * phases @ h.T)
    return (
        waves.sum(axis=-1).real,
        (1j * waves @ h).real,
        -np.einsum("sph,ha,hb->spab", waves, h, h, optimize=True).real,
    )
