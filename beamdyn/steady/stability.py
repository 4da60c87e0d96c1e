"""Stability of free motion about the steady response, by Hill's method for phases of rotation and road.

A free motion is exp(s t) times a function of the phases.  Where the ratio of the rates is irrational there
is no period and no monodromy matrix, but the exponents s are still eigenvalues of the operator of harmonic
balance, here in the modes of the mean equations:

    (s + i Omega_h) z_h = diag(sigma) z_h + sum_g V_(h-g) z_g

Here sigma are the eigenvalues of the mean equations, and V the harmonics of the periodic coefficients.  With
V = 0 the exponents s are sigma_a - i Omega_h.  Each stays in the Gershgorin disc about that value with the
radius rho_a, the sum of its row of |V|.  If there is no damping, and the mean energy is positive, an exponent
leaves the imaginary axis only by meeting one of opposite energy (Krein).  So the motion is stable if no disc
of a sigma_a overlaps one of a conjugate sigma_b - i Omega_h; it is also stable if all discs lie left of the
axis.  If there is no damping, the radii of discs that are far from others are reduced before this comparison,
by scaling the coordinates.

Eigenvalues are computed only where discs still overlap.  The matrix then has the harmonics between which the
motion resonates, (0, 0) and the h of the overlaps, and those that a few multiplications of these by the
periodic coefficients (interactions) add.  The number of interactions is increased until the growth rate has
converged.

In shapes of arrays, S counts speeds, n coordinates, m eigenvalues of the mean equations, and H harmonics.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import reduce

import numpy as np
import scipy.sparse
from scipy.sparse.linalg import ArpackError, eigs

from beamdyn.common.inputs.checks import NoModelAnswer
from beamdyn.steady.harmonic_balance import convolution_matrix
from beamdyn.steady.periodic_system import MeanModes, Pair, PeriodicSystem, generate_harmonics

# Largest number of interactions with the periodic coefficients through which two modes resonate.
TONGUE_ORDER = 2
_ROUNDING = 1e-9  # largest real part, over the largest |eigenvalue|, that counts as rounding error
# Relative change of the growth rate by one more interaction, below which the rate has converged.
_SETTLED = 1e-6
_MOST_INTERACTIONS = 4  # largest number of interactions beyond the resonant harmonics
_MOST_OUTSIDE = 0.1  # largest share of an accepted eigenvector in the outermost harmonics
# Eigenvalues of Hill's matrix are taken for copies of one exponent if their real parts differ by at most this
# fraction of the change of the growth rate by the resonance.
_SAME_RATE = 0.05
_NEAREST = 8  # number of eigenvalues followed from one number of interactions to the next
_OFF = 1e-4  # offset of a shift from an eigenvalue, over the largest |eigenvalue|, to avoid a singular matrix
_SINGULAR = (
    "the equations with periodic coefficients are singular: the excitation is too strong for "
    "the beam's stiffness; check the size and the unit of each value"
)
_STATIONARY = 1e-9  # frequency of a harmonic that counts as 0, relative to the larger rate of the two phases
_MOST_STEPS = 6  # number of interactions within which a harmonic of frequency 0 is sought
_PHASES = 8  # number of phase differences tried for commensurate rates; the fastest growth counts
_BETWEEN_PHASES = 0.1  # error by phases not tried, relative to the range of growth rates at those tried


def growth_rate(system: PeriodicSystem) -> tuple[np.ndarray, np.ndarray]:
    """Compute the largest growth rate of a free motion, 0 or less where it is stable, and its error [1/s].

    Instability tongues of up to two interactions are detected.  Those of higher order, which exist without
    damping near every rational combination of the rates, are narrower, and the slightest damping closes them.

    Parameters
    ----------
    system : PeriodicSystem
        The equations, at S pairs of phase rates.

    Returns
    -------
    rate, error : ndarray, shape (S,)
        The error of modes that resonate is the change by the last interaction whose harmonics are kept; where
        the rates are commensurate, a tenth of the differences between the phases tried is added.  The rate of
        other modes is that of the mean equations, and its error is the second-order shift by the periodic
        coefficients.  Where motions by the mean equations neither grow nor decay, as without damping, the
        shift is taken not to change the growth rate 0, which then has no error.  The error is infinite where
        the mean equations are singular.
    """
    A, periodic = _first_order(system)
    sigma, R = _solve_mean(system, A)
    rate, error = _largest_real_part(sigma, np.abs(sigma).max(axis=1)), np.zeros(len(A))
    if not system.coupling:
        return rate, error
    singular = np.abs(sigma).min(axis=1) == 0
    error[singular] = np.inf
    rows = np.flatnonzero(~singular)
    if len(rows):
        R, n = R[rows], system.size
        # Scale the eigenvectors so that the periodic coefficients V, as matrices in these modes, have
        # symmetric magnitudes.  Otherwise a small Gershgorin disc of one mode, whose radius is a row sum,
        # would mean a large one of another.
        R = R / (np.linalg.norm(R[:, :n], axis=1) * np.sqrt(np.abs(sigma[rows])))[:, None, :]
        V = _balance(sigma[rows], [(f[rows], np.linalg.solve(R, B[rows] @ R)) for f, B in periodic])
        free = _MeanMotion(system.rates[rows], system.coupling, sigma[rows], V)
        shift, damped = np.zeros((len(rows), sigma.shape[1])), np.flatnonzero(rate[rows])
        shift[damped] = free[damped].second_order_shift()
        error[rows] = shift.max(axis=1)
        for i, resonances in free.resonances(rate[rows] <= 0):
            rate[rows[i]], error[rows[i]] = _combine(sigma[rows[i]], shift[i], resonances)
    return rate, error


def fastest_growth(parts: Sequence[PeriodicSystem]) -> tuple[np.ndarray, np.ndarray]:
    """Compute the largest growth rate of free motion among uncoupled parts, and its error [1/s]."""
    rates, errors = np.swapaxes([growth_rate(part) for part in parts], 0, 1)
    largest = rates.max(axis=0)
    above, below = errors + (rates - largest), errors + (largest - rates)
    return largest, np.maximum(above.max(axis=0), below.min(axis=0))


def _combine(sigma: np.ndarray, shift: np.ndarray, resonances: list[_Resonance]) -> tuple[float, float]:
    """Return the largest growth rate of resonant and other modes, and its error [1/s].

    The other modes have the eigenvalues sigma, and `shift` is the error of their growth rates.
    """
    scale, resonant = np.abs(sigma).max(), {resonance.mode for resonance in resonances}
    alone = [a for a in range(len(sigma)) if np.imag(sigma[a]) >= 0 and a not in resonant]
    found = [resonance.growth_rate(scale) for resonance in resonances]
    found += [(float(_largest_real_part(sigma[[a]], scale)), float(shift[a])) for a in alone]
    rate, error = np.transpose(found)
    largest = rate.max()
    return float(largest), float(max((rate + error).max() - largest, largest - (rate - error).max()))


def _largest_real_part(s: np.ndarray, scale: np.ndarray | float) -> np.ndarray:
    """Return the largest real part of exponents s; 0 if it is only a rounding error relative to `scale`."""
    largest = np.real(s).max(axis=-1)
    return np.where(np.abs(largest) <= _ROUNDING * scale, 0.0, largest)


# First-order equations in the modes of the mean equations --------------------------------------------


def _first_order(system: PeriodicSystem) -> tuple[np.ndarray, list[tuple[np.ndarray, np.ndarray]]]:
    """Build the first-order equations of free motion: constant A, and spectra c with their matrices B.

    y' = (A + sum_h c_h B e^(i h.phi)) y for y = (w q, q'), with w [rad/s] so that both are of similar size.
    """
    K, C, M = system.mean
    S, n = len(K), system.size
    K, C = np.linalg.solve(M, K), np.linalg.solve(M, C)
    w = np.sqrt(np.abs(K).max(axis=(1, 2)))[:, None, None]
    w = np.where(w == 0, 1.0, w)  # no stiffness: coordinate of an uncoupled circuit
    A = np.zeros((S, 2 * n, 2 * n))
    A[:, :n, n:], A[:, n:, :n], A[:, n:, n:] = w * np.eye(n), -K / w, -C
    periodic = []
    for order, spectrum, matrix in system.varying:
        B = np.zeros_like(A)
        B[:, n:, n * order : n * order + n] = -np.linalg.solve(M, matrix) / (1 if order else w)
        periodic.append((spectrum, B))
    # A coordinate without stiffness, such as the flux of a circuit, is not a state, but its rate is.
    states = np.append(~system.without_stiffness, np.ones(n, dtype=bool))
    if states.all():
        return A, periodic
    return A[:, states][..., states], [(f, B[:, states][..., states]) for f, B in periodic]


def _solve_mean(system: PeriodicSystem, A: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute eigenvalues and eigenvectors of A, the first-order form of the mean equations at each speed.

    If there is no damping, they are computed from mass and stiffness.
    """
    if system.mean[1].any():
        return np.linalg.eig(A)
    modes, n = MeanModes.of_system(system), system.size
    root = np.sqrt(-modes.squared.astype(complex))
    sigma = np.concatenate([root, -root], axis=1)
    shapes = np.tile(modes.shapes, 2)
    return sigma, np.concatenate([A[:, :1, n, None] * shapes, sigma[:, None] * shapes], axis=1)


def _balance(
    sigma: np.ndarray, V: list[tuple[np.ndarray, np.ndarray]]
) -> list[tuple[np.ndarray, np.ndarray]]:
    """Scale overdamped modes in the coefficients V: each acts on the others as strongly as these on it.

    Scaled like oscillating modes, the slowly decaying mode of a circuit with a large resistance would enlarge
    the Gershgorin discs of all other modes in proportion to that resistance.
    """
    parts = (np.abs(f).sum(axis=(1, 2))[:, None, None] * np.abs(v) for f, v in V)
    size = reduce(np.add, parts) * (1 - np.eye(sigma.shape[1]))
    felt, acts = size.sum(axis=2), size.sum(axis=1)
    scaled = (np.imag(sigma) == 0) & (felt > 0) & (acts > 0)
    d = np.sqrt(np.where(scaled, felt, 1.0) / np.where(scaled, acts, 1.0))
    return [(f, v * d[:, None, :] / d[:, :, None]) for f, v in V]


# Resonant modes and harmonics ------------------------------------------------------------------------


@dataclass(frozen=True)
class _MeanMotion:
    """Free vibration at S pairs of phase rates, in the modes of the equations averaged over both phases.

    Parameters
    ----------
    rates : ndarray, shape (S, 2)
        Rates of the two phases, of rotation and of the road [rad/s].
    coupling : set of (int, int)
        Harmonics of the periodic coefficients: (j, k) has the frequency j rates[:, 0] + k rates[:, 1].
    sigma : ndarray of complex, shape (S, modes)
        Eigenvalues of the mean equations [1/s].
    V : list of (ndarray, ndarray)
        Periodic coefficients of the equations in these modes.  Each is the product of a scalar function of
        the two phases and a constant matrix.  The first array (S, N, N) has the function's Fourier
        coefficients on a grid of N x N phases, that of the harmonic (j, k) at [:, j, k]; the second (S,
        modes, modes) is the matrix.
    """

    rates: np.ndarray
    coupling: set[Pair]
    sigma: np.ndarray
    V: list[tuple[np.ndarray, np.ndarray]]

    def __getitem__(self, chosen: np.ndarray) -> _MeanMotion:
        """Select the free vibration at the chosen pairs of phase rates."""
        V = [(spectrum[chosen], v[chosen]) for spectrum, v in self.V]
        return _MeanMotion(self.rates[chosen], self.coupling, self.sigma[chosen], V)

    @property
    def radius(self) -> np.ndarray:
        """Radius of the Gershgorin disc of each mode, (rates, modes)."""
        parts = (np.abs(f).sum(axis=(1, 2))[:, None] * np.abs(v).sum(axis=2) for f, v in self.V)
        return reduce(np.add, parts)

    def gap(self, harmonics: list[Pair]) -> np.ndarray:
        """Compute sigma_a - sigma_b + i Omega_h [1/s] for all modes a, b and harmonics h.

        The shape is (rates, modes, modes, harmonics); Omega_h is the angular frequency of harmonic h.
        """
        omega = self.rates @ np.array(harmonics).T
        difference = self.sigma[:, :, None] - self.sigma[:, None, :]
        return difference[..., None] + 1j * omega[:, None, None, :]

    def second_order_shift(self) -> np.ndarray:
        """Compute second-order shifts (rates, modes) of eigenvalues by the periodic coefficients."""
        harmonics = sorted(self.coupling)
        h, coupling = np.array(harmonics), self._couple(harmonics)
        opposite = (h[:, None] == -h[None]).all(axis=2).argmax(axis=1)
        product = np.abs(coupling[..., opposite] * np.swapaxes(coupling, 1, 2))
        own = np.arange(product.shape[1])
        # A mode's coupling with itself is left out: its terms of harmonics h and -h cancel, as their gaps are
        # opposite.  So a periodic variation of its own frequency does not shift the growth rate.
        product[:, own, own] = 0
        with np.errstate(divide="ignore", invalid="ignore"):
            shift = np.where(product > 0, product / np.abs(self.gap(harmonics)), 0.0).sum(axis=(2, 3))
        return np.minimum(shift, self.radius)

    def _couple(self, harmonics: list[Pair]) -> np.ndarray:
        """Compute the periodic coefficients between all modes: (rates, modes, modes, harmonics)."""
        spectra = (convolution_matrix(f, [(0, 0), *harmonics])[:, 1:, 0] for f, _ in self.V)
        parts = (f[:, None, None] * v[..., None] for f, (_, v) in zip(spectra, self.V, strict=True))
        return reduce(np.add, parts)

    def shrunk_radius(self, harmonics: list[Pair]) -> np.ndarray:
        """Compute the radii (rates, modes) of Gershgorin discs, reduced by scaling the coordinates.

        Seen from one disc, another is close if its distance is at most twice the largest radius, else far.
        Scaling the coordinates of the far discs by t < 1 multiplies, in the row of the one disc, the terms of
        coupling with far discs by t, and keeps those with close discs.  The radii of the far discs grow by
        1/t, to at most half of their distance.
        """
        radius, distance = self.radius, np.abs(self.gap(harmonics))
        close = 2 * radius.max(axis=1)[:, None, None, None]
        between = ((distance > close) & (distance <= 2 * close)).any(axis=(1, 2, 3))
        nearest = np.where(distance > close, distance, np.inf).min(axis=(1, 2, 3))
        direct = (np.abs(self._couple(harmonics)) * (distance <= close)).sum(axis=(2, 3))
        scaled = direct + (close[:, 0, 0] / nearest[:, None]) * (radius - direct)
        return np.where(between[:, None], radius, np.minimum(radius, scaled))

    def resonances(self, considered: np.ndarray) -> Iterator[tuple[int, list[_Resonance]]]:
        """Yield index and resonances of each pair of phase rates at which discs of modes overlap.

        Only discs of modes of opposite energy are compared.  `considered`, shape (S,), marks the pairs of
        phase rates to be examined.
        """
        levels = generate_harmonics([(0, 0)], self.coupling, TONGUE_ORDER)
        harmonics = [h for level in levels for h in level]
        overlap = self._overlap(harmonics, self.radius) & considered[:, None, None, None]
        undamped = np.abs(np.real(self.sigma)).max(axis=1) <= _ROUNDING * np.abs(self.sigma).max(axis=1)
        rows = np.flatnonzero(undamped & overlap.any(axis=(1, 2, 3)))
        overlap[rows] = self[rows]._overlap(harmonics, self[rows].shrunk_radius(harmonics))
        # Harmonics are in the order of their interactions: the first one of frequency 0 has the fewest.
        reached = generate_harmonics([(0, 0)], self.coupling, _MOST_STEPS)[1:]
        pairs = np.array([h for level in reached for h in level])
        for i in np.flatnonzero(overlap.any(axis=(1, 2, 3))):
            V, found = [(f[i : i + 1], v[i]) for f, v in self.V], []
            still = np.abs(pairs @ self.rates[i]) <= _STATIONARY * np.abs(self.rates[i]).max()
            first = [(int(j), int(k)) for j, k in pairs[still][:1]]
            stationary = first[0] if first else None
            for a in np.flatnonzero(overlap[i].any(axis=(1, 2))):
                partners = {(0, 0)} | {harmonics[k] for k in np.flatnonzero(overlap[i, a].any(axis=0))}
                found.append(
                    _Resonance(self.rates[i], self.coupling, self.sigma[i], V, int(a), partners, stationary)
                )
            yield int(i), found

    def _overlap(self, harmonics: list[Pair], radius: np.ndarray) -> np.ndarray:
        """Return which discs of modes of opposite energy overlap, shape (rates, modes, modes, harmonics).

        If all discs lie left of the imaginary axis, none counts as overlapping.
        """
        near = np.abs(self.gap(harmonics)) <= (radius[:, :, None] + radius[:, None, :])[..., None]
        opposite = (np.imag(self.sigma) >= 0)[:, :, None] & (np.imag(self.sigma) <= 0)[:, None, :]
        rightmost = (np.real(self.sigma) + radius).max(axis=1) > 0
        return near & opposite[..., None] & rightmost[:, None, None, None]


# Eigenvalues of resonant modes -----------------------------------------------------------------------


@dataclass(frozen=True)
class _Resonance:
    """A mode that resonates with others through the periodic coefficients, at one pair of phase rates.

    Parameters
    ----------
    rates, coupling, sigma, V
        As for `_MeanMotion`, at one pair of phase rates.
    mode : int
        Index of the mode, in the harmonic (0, 0).
    harmonics : set of pair
        Harmonics of the modes whose discs overlap the disc of this mode, and (0, 0).
    stationary : pair or None
        A harmonic h, not (0, 0), of frequency 0, if the rates are commensurate.
    """

    rates: np.ndarray
    coupling: set[Pair]
    sigma: np.ndarray
    V: list[tuple[np.ndarray, np.ndarray]]
    mode: int
    harmonics: set[Pair]
    stationary: Pair | None

    def growth_rate(self, scale: float) -> tuple[float, float]:
        """Compute the growth rate and its error [1/s], largest over the phase between commensurate rates.

        `scale` is the largest |eigenvalue| of the mean equations.
        """
        phases = np.arange(_PHASES if self.stationary else 1) * (2 * np.pi / _PHASES)
        rates, errors = np.transpose([self._growth_rate_at(phase, scale) for phase in phases])
        return float(rates.max()), float(errors.max() + _BETWEEN_PHASES * np.ptp(rates))

    def _growth_rate_at(self, phase: float, scale: float) -> tuple[float, float]:
        """Compute the growth rate and its error [1/s] at a given phase between commensurate rates.

        Harmonics are added until the growth rate has converged; `scale` is as for `growth_rate`.
        """
        hill, inner = self._hill_matrix(1, phase)
        s, z = np.linalg.eig(hill.toarray())
        rate, near, error = *self._select(s, z, inner, scale), np.inf
        for interactions in range(2, _MOST_INTERACTIONS + 1):
            last, (hill, inner) = rate, self._hill_matrix(interactions, phase)
            rate, near = self._select(*_nearest_eigenvalues(hill, near, scale), inner, scale)
            error = abs(rate - last)
            if error <= _SETTLED * abs(rate):
                break
        return rate, error

    def _select(self, s: np.ndarray, z: np.ndarray, inner: int, scale: float) -> tuple[float, complex]:
        """Select the growth rate from eigenvalues s and vectors z of Hill's matrix, and the next start value.

        The start value is the exponent near which the next, larger Hill's matrix is searched for eigenvalues.

        Hill's matrix has copies s + i Omega_h of every exponent s, one for each harmonic h.  Copies whose
        vector is large in the outermost harmonics (rows from `inner` on) are wrong, because the neighbours of
        these harmonics are missing.  Of the other copies, the one with the smallest part in the outermost
        harmonics is the most accurate.
        """
        outer = (np.abs(z[inner:]) ** 2).sum(axis=0) / (np.abs(z) ** 2).sum(axis=0)
        s, outer = s[outer < _MOST_OUTSIDE], outer[outer < _MOST_OUTSIDE]
        if not (len(s) and _largest_real_part(s, scale)):
            return 0.0, self.sigma[self.mode]
        fastest, alone = np.real(s).max(), np.real(self.sigma[self.mode])
        copies = np.real(s) >= fastest - _SAME_RATE * abs(fastest - alone)
        best = s[copies][outer[copies].argmin()]
        return float(np.real(best)), complex(best)

    def _hill_matrix(self, interactions: int, phase: float) -> tuple[scipy.sparse.csc_array, int]:
        """Build Hill's matrix for the harmonics within a number of interactions, and count its inner rows.

        Inner rows, which come first, are those of the harmonics within one interaction fewer.  If the rates
        are commensurate, a harmonic other than (0, 0) has the frequency 0.  Harmonics that differ by it are
        merged; `phase` is its phase [rad].
        """
        levels = generate_harmonics(self.harmonics, self.coupling, interactions)
        inner = dict.fromkeys(self._fold(h) for level in levels[:-1] for h in level)
        harmonics = list(inner | dict.fromkeys(map(self._fold, levels[-1])))
        omega = np.array(harmonics) @ self.rates
        hill = scipy.sparse.diags_array((self.sigma - 1j * omega[:, None]).ravel()).tocsc()
        for spectrum, v in self.V:
            hill += scipy.sparse.kron(self._folded_convolution(spectrum, harmonics, phase), v, format="csc")
        return hill, len(inner) * len(self.sigma)

    def _fold(self, h: Pair) -> Pair:
        """Return the representative of harmonics that differ from h by multiples of `stationary`."""
        if self.stationary is None:
            return h
        (j, k), (a, b) = h, self.stationary
        turns = int(np.floor((j * a + k * b) / (a * a + b * b) + 0.5))
        return j - turns * a, k - turns * b

    def _folded_convolution(self, spectrum: np.ndarray, harmonics: list[Pair], phase: float) -> np.ndarray:
        """Build the matrix that multiplies a function, given by its harmonics, by the function of a spectrum.

        Harmonics of equal frequency are merged; `phase` is as for `_hill_matrix`.
        """
        if self.stationary is None:
            return convolution_matrix(spectrum, harmonics)[0]
        most = 1 + (np.ptp(harmonics, axis=0).max() + spectrum.shape[-1] // 2) // max(
            map(abs, self.stationary)
        )
        total = np.zeros((len(harmonics), len(harmonics)), dtype=complex)
        for m in range(-most, most + 1):
            shift = m * self.stationary[0], m * self.stationary[1]
            total += np.exp(1j * m * phase) * convolution_matrix(spectrum, harmonics, shift)[0]
        return total


def _nearest_eigenvalues(
    hill: scipy.sparse.csc_array, near: complex, scale: float
) -> tuple[np.ndarray, np.ndarray]:
    """Compute the eigenvalues of a sparse matrix nearest to the value `near`, and their eigenvectors.

    The search is shifted from `near` by a small fraction of `scale`, as the matrix may be singular there.
    """
    start = np.ones(hill.shape[0], dtype=complex)
    try:
        return eigs(hill, min(_NEAREST, hill.shape[0] - 2), sigma=near + _OFF * scale, v0=start)
    except ArpackError:
        s, z = np.linalg.eig(hill.toarray())
        return s, z
    except RuntimeError:  # the LU factorization failed: the matrix is singular
        raise NoModelAnswer(_SINGULAR) from None
