"""Linear equations whose coefficients are periodic in two phases, as harmonics.

    M q'' + C(theta, chi) q' + K(theta, chi) q = f(theta, chi),   theta' = nu_1,  chi' = nu_2

The harmonic (j, k) is the part that varies as exp(i (j theta + k chi)).  The coefficients are trigonometric
polynomials, so that an FFT of a few samples gives their harmonics exactly.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

Pair = tuple[int, int]  # a harmonic (j, k)

_EPS = np.finfo(float).eps


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
    if (samples == samples[:, :1, :1]).all():
        constant = np.zeros(samples.shape, dtype=complex)
        constant[:, 0, 0] = samples[:, 0, 0]
        return constant
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


def select_harmonics(spectrum: np.ndarray, pairs: np.ndarray) -> np.ndarray:
    """Select harmonics (..., 2) of a spectrum; 0 where its grid has no such harmonic."""
    half = spectrum.shape[-1] // 2
    inside = (np.abs(pairs) < half).all(axis=-1)
    j, k = np.moveaxis(np.where(inside[..., None], pairs, 0), -1, 0)
    return np.where(inside, spectrum[:, j, k], 0)


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
