"""Largest Lyapunov exponent of free vibration, if coefficients have two incommensurate frequencies.

There is no period and no monodromy matrix.  Over a period T of the faster phase, a state is mapped by a
matrix A that depends on the slower phase theta there, smoothly and periodically.  The map over m such periods
is

    B_m(theta) = A(theta + (m - 1) alpha) ... A(theta),    B_2m(theta) = B_m(theta + m alpha) B_m(theta),

with the advance alpha of the slower phase in T, and the largest exponent lies between two bounds:

- it is at most the mean over theta of log |B_m| / (m T), for every m (logarithms of norms are subadditive);
- let p_k be the product of the first k singular values of a matrix, and mu the least ratio, over theta, of
  the k-th singular value of B_m to the next.  If log p_k of B_2m equals the sum of log p_k of its two factors
  within log(mu)/2 at every theta, the mean of log p_k(B_2m) - log p_k(B_m) over theta, divided by m T, is the
  sum of the k largest exponents, with an error of the order of 1/mu (the avalanche principle).  This sum
  divided by k is at most the largest exponent.  If k is the number of all singular values, the sum is the
  mean of log |det A| / T, without error.

Without damping a stable motion has the exponent 0.  No bound separates it from a small exponent: the status
is "undecided", with a bound on the growth rate.

References
----------
Goldstein and Schlag (2001), Annals of Mathematics 154, 155-203; of matrices of any size: Duarte and Klein
(2016), Lyapunov Exponents of Linear Cocycles, chapter 2.  Their constants are not computed: 10 stands for the
constant of the error, which is negligible where the ratio is large.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import reduce
from typing import NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.equations.equations_of_motion import Equations
from beamdyn.scene.scene import Scene
from beamdyn.studies.floquet.monodromy import COARSER_STEPS, count_steps, rates_of, scaled_states
from beamdyn.studies.floquet.multipliers import STABLE, UNDECIDED, UNSTABLE
from beamdyn.transient.gauss import step_maps, tableau
from beamdyn.transient.system import ModalSystem

_STAGES = 8
_FIRST, _MOST = 8, 128  # number of harmonics of the slower phase at the first attempt, and at the last
# Largest number of periods of the faster phase that are integrated; their ends sample the slower phase.
_PERIODS = 4096
# Condition number of the harmonics at the ends of the periods, above which the ends do not sample the full
# circle.
_SPREAD = 30.0
_RESOLVED = 1e-12  # ratio of the last harmonics to the matrix, below which the harmonics are resolved
_GRID = 4  # number of values of the slower phase for each harmonic
_FINEST = 2048  # largest number of grid values of the slower phase, for maps over several periods
_SMOOTH = 1e-8  # difference of two means of a logarithm over the grid, above which the mean is unresolved
# Smallest norm of a map over the slower phase, relative to the largest, that its Fourier series resolves.
_EVEN = 1e-6
_DOUBLINGS = 18
_APART = 1e3  # smallest ratio of neighbouring singular values that counts as separated
_KNOWN = 1e-9  # smallest singular value, over the largest, that is above rounding
# Assumed constant in the error of the avalanche principle, which is this constant times 1/mu.
_CONSTANT = 10.0
_ROUNDING = 1e-13  # rounding error of the logarithm of a norm, per step


class LargestExponent(NamedTuple):
    """Largest Lyapunov exponent as a growth rate with its error, from two bounds.

    Parameters
    ----------
    rate, error : float
        Growth rate and its error [1/s].
    status : {"stable", "unstable", "undecided"}
        Stability of the motion, by the growth rate and its error.
    period : float
        Period of the faster phase [s].
    """

    rate: float
    error: float
    status: str
    period: float


def largest_exponent(scene: Scene, equations: Equations) -> LargestExponent:
    """Bound the largest exponent of free vibration in modal coordinates with unit mass matrix.

    Raises
    ------
    InvalidValue
        If the motion has more than two frequencies, or one phase hardly advances in 4096 periods of the
        other.
    """
    assert scene.motion is not None
    rates = rates_of(scene)
    if len(rates) > 2:
        bound = "its phases have more than two rates without a common period"
        remedy = "give at most two, or rates with a common period"
        raise InvalidValue("scene.motion", scene.motion, bound, remedy)
    slow, fast = sorted(rates)
    system, T = ModalSystem(equations, scene.motion), 2 * math.pi / fast
    _, K, _ = system.coefficients(np.linspace(0, 16 * T, 257))
    steps, alpha = count_steps(K, T, scene.motion.rates), 2 * math.pi * slow / fast
    fine = Cocycle.of(system, T, alpha, steps)
    rough = Cocycle.of(system, T, alpha, math.ceil(COARSER_STEPS * steps))
    (low, high), coarse = fine.bounds(), rough.bounds()
    error = max(abs(low - coarse[0]), abs(high - coarse[1])) + (fine.tail + _ROUNDING * steps) / T
    rate, error = (low + high) / 2, abs(high - low) / 2 + error
    verdict = UNSTABLE if rate > error else STABLE if rate < -error else UNDECIDED
    return LargestExponent(rate, error, verdict, T)


@dataclass(frozen=True)
class Cocycle:
    """Map of the state over a period [s] of the faster phase: its harmonics -M to M in the slower phase.

    `alpha` is the advance of the slower phase in this period [rad], `tail` the size of the last harmonics
    relative to the largest.
    """

    harmonics: np.ndarray
    period: float
    alpha: float
    tail: float

    @classmethod
    def of(cls, system: ModalSystem, T: float, alpha: float, steps: int) -> Cocycle:
        """Integrate successive periods T until their maps resolve the dependence on the slower phase.

        The slower phase advances by `alpha` [rad] in each period; each period is integrated in `steps` steps.
        """
        nothing = np.zeros((0, 2 * system.size, 2 * system.size))
        maps, most = scaled_states(system.equations, T, nothing), _FIRST
        while True:
            count, basis = _cover(alpha, most)
            more = [_over_period(system, T, steps, k) for k in range(len(maps), count)]
            maps = (
                np.concatenate([maps, scaled_states(system.equations, T, np.array(more))]) if more else maps
            )
            found = np.linalg.lstsq(basis, maps[:count].reshape(count, -1), rcond=None)[0]
            found = found.reshape(-1, *maps.shape[1:])
            size = np.abs(found).max(axis=(1, 2))
            tail = float(size[[0, 1, -2, -1]].max() / size.max())
            if tail <= _RESOLVED or 2 * most > _MOST:
                return cls(found, T, alpha, tail)
            most *= 2

    def bounds(self) -> tuple[float, float]:
        """Compute two bounds [1/s] between which the largest exponent lies."""
        M, size = len(self.harmonics) // 2, self.harmonics.shape[1]
        count = _GRID * (M + 1)
        padded = np.zeros((count, size, size), dtype=complex)
        padded[np.arange(-M, M + 1)] = self.harmonics
        B = np.fft.ifft(padded, axis=0).real * count
        of_all = np.linalg.slogdet(B)[1]  # -inf if rounding hides components that decay within a period
        mean, doubt = _mean(of_all) if np.isfinite(of_all).all() else (-math.inf, 0.0)
        low = float(max(mean - doubt, of_all.min())) / size / self.period
        high = float(np.log(np.linalg.norm(B, 2, axis=(1, 2)).max())) / self.period
        p, log_scale, m, k = _products(B), 0.0, 1, np.arange(1, size)
        for _ in range(_DOUBLINGS):
            if (fine := _fine_enough(B)) is None:
                break
            if len(fine) > len(B):
                B, p = fine, _products(fine)
            after = _turned(B, m * self.alpha)
            C = after @ B
            scale = float(np.linalg.norm(C, axis=(1, 2)).max())
            C, log_twice = C / scale, 2 * log_scale + math.log(scale)
            q, time = _products(C), m * self.period
            mean, doubt = _mean(q[:, 0])
            high = min(high, float(mean + doubt + log_twice) / (2 * time))
            mu = np.exp(-np.diff(_values(p), axis=1).max(axis=0))
            lost = np.abs((_products(after) + p - q)[:, :-1] - k * math.log(scale))
            known = (mu > _APART) & (lost.max(axis=0) < np.log(mu) / 2)
            known &= (_values(q) - q[:, :1])[:, :-1].min(axis=0) > math.log(_KNOWN)
            if known.any():
                gained, doubt = _mean((q - p)[:, :-1])
                gained, error = gained + k * (log_twice - log_scale), _CONSTANT / mu + doubt
                low = max(low, float(((gained - error) / k)[known].max()) / time)
                high = min(high, float(gained[0] + error[0]) / time) if known[0] else high
            B, p, log_scale, m = C, q, log_twice, 2 * m
        return low, high


def _products(B: np.ndarray) -> np.ndarray:
    """Compute logarithms (P, m) of the products of the first 1 to m singular values of P matrices (m, m)."""
    values = np.linalg.svd(B, compute_uv=False)
    return np.cumsum(np.log(np.maximum(values, np.finfo(float).tiny)), axis=1)


def _values(p: np.ndarray) -> np.ndarray:
    """Convert logarithms of products of the first singular values to logarithms of each singular value."""
    return np.diff(p, axis=1, prepend=0.0)


def _turned(B: np.ndarray, angle: float) -> np.ndarray:
    """Interpolate matrices at evenly spaced phases to phases shifted by an angle, by a Fourier series."""
    factor = np.exp(1j * np.fft.fftfreq(len(B), 1 / len(B)) * angle)[:, None, None]
    return np.fft.ifft(np.fft.fft(B, axis=0) * factor, axis=0).real


def _mean(values: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Compute means over a grid of phases, and their errors from means over every other phase.

    The errors are inf if the grid does not resolve the values.
    """
    even, odd = values[::2].mean(axis=0), values[1::2].mean(axis=0)
    apart = np.abs(even - odd)
    return (even + odd) / 2, np.where(apart > _SMOOTH, np.inf, apart)


def _fine_enough(B: np.ndarray) -> np.ndarray | None:
    """Refine matrices to a grid that resolves the product of two of them; None if no grid does.

    As a product has twice the harmonics of its factors, those of the factors must be negligible in the upper
    half of the grid's harmonics.
    """
    norms = np.linalg.norm(B, axis=(1, 2))
    if norms.min() < _EVEN * norms.max():
        return None
    series, count = np.fft.fft(B, axis=0) / len(B), len(B)
    size = np.abs(series).max(axis=(1, 2))
    orders = np.abs(np.fft.fftfreq(count, 1 / count))
    used = int(orders[size > _RESOLVED * size.max()].max())
    finer = count
    while 4 * used >= finer:
        finer *= 2
    if finer > _FINEST:
        return None
    padded = np.zeros((finer, *B.shape[1:]), dtype=complex)
    padded[np.fft.fftfreq(count, 1 / count).astype(int)] = series
    return B if finer == count else np.fft.ifft(padded, axis=0).real * finer


def _cover(alpha: float, most: int) -> tuple[int, np.ndarray]:
    """Return a number of periods whose ends sample the slower phase all around the circle.

    Return also the harmonics -most to most (columns) of the slower phase at the ends of these periods; the
    slower phase advances by `alpha` [rad] in each period.
    """
    count = min(3 * (2 * most + 1), _PERIODS)
    while True:
        basis = np.exp(1j * np.outer(alpha * np.arange(count), np.arange(-most, most + 1)))
        if np.linalg.cond(basis) < _SPREAD:
            return count, basis
        if count == _PERIODS:
            break
        count = min(2 * count, _PERIODS)
    bound = "the slower phase does not cover the circle in 4096 periods of the faster phase"
    raise InvalidValue("scene.motion", alpha / (2 * math.pi), bound, "take nearby rates with a common period")


def _over_period(system: ModalSystem, T: float, steps: int, k: int) -> np.ndarray:
    """Compute the map of the state (displacements, velocities) over the period from k T to (k + 1) T.

    T is the period of the faster one of the two phases of the motion [s].
    """
    starts = T * (k + np.arange(steps) / steps)
    maps = step_maps(system, starts, T / steps, tableau(_STAGES)).step[:, :, 1:]
    return reduce(lambda before, step: step @ before, maps)
