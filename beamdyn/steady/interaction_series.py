"""Harmonic balance as a series, whose terms add one interaction with the periodic coefficients each.

In the modes of the mean equations, without damping, each harmonic h of each mode a stands by itself:

    (k_a - Omega_h^2 + i Omega_h c_aa) y_ha = f_ha - (what couples it with other harmonics and modes)

The coupling is by the periodic coefficients and by damping, and weak beside the factor on the left but near
a resonance.  So the equations are solved with the last response on the right-hand side, again and again: each
time multiplies the error by the ratio of the two, some 1e-3, and a few times reach the rounding error.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from beamdyn.steady.mean_modes import MeanModes
from beamdyn.steady.periodic_system import Pair, PeriodicSystem, list_harmonics, select_harmonics

_MOST_TERMS = 12  # each then shrinks the error to a twentieth; where it does not, the series is given up
_SETTLED = 4 * np.finfo(float).eps  # change by a term, over the response
_WORTH_LEAVING_OUT = 0.25  # share of rates that have settled: fewer cost less than new arrays


def sum_interactions(system: PeriodicSystem, harmonics: Sequence[Pair]) -> tuple[np.ndarray, np.ndarray]:
    """Sum the series for some harmonics of the response.

    Parameters
    ----------
    system : PeriodicSystem
        The equations at S pairs of rates.
    harmonics : sequence of pair, length H
        Harmonics to keep; with each, its opposite.

    Returns
    -------
    response : ndarray of complex, shape (S, H, n)
        q_h; nan where the series has not settled.
    settled : ndarray of bool, shape (S,)
        Whether it has, to rounding error.
    """
    S, n = len(system.rates), system.size
    response, settled = np.full((S, len(harmonics), n), np.nan, dtype=complex), np.zeros(S, dtype=bool)
    try:
        mean = MeanModes.of_system(system)
    except np.linalg.LinAlgError:
        return response, settled
    half = [h for h in harmonics if h >= (0, 0)]  # those of the others are conjugate
    with np.errstate(all="ignore"):  # it may diverge, or a harmonic be in resonance
        y, settled = _sum(_Series.of_system(system, mean, half))
    q = np.einsum("snm,hms->shn", mean.shapes, y)
    index = {h: i for i, h in enumerate(half)}
    for place, h in enumerate(harmonics):
        response[:, place] = q[:, index[h]] if h in index else q[:, index[-h[0], -h[1]]].conj()
    return response, settled


def _sum(series: _Series) -> tuple[np.ndarray, np.ndarray]:
    """Response (H, n, S), nan where it has not settled, and whether it has (S,)."""
    y = series.load * series.compliance
    found, left = np.full_like(y, np.nan), np.arange(y.shape[-1])
    done = np.zeros(len(left), dtype=bool)
    for _ in range(_MOST_TERMS):
        last, y = y, series.respond(y)
        size = _size(y)
        settled = (_size(y - last) <= _SETTLED * size) & np.isfinite(size)
        done[left[settled]] = True
        found[..., left[settled]] = y[..., settled]
        if settled.all():
            break
        if settled.mean() >= _WORTH_LEAVING_OUT:
            y, left, series = y[..., ~settled], left[~settled], series[~settled]
    return found, done


def _size(y: np.ndarray) -> np.ndarray:
    """Size (S,) of responses (H, n, S)."""
    return (np.abs(np.real(y)) + np.abs(np.imag(y))).sum(axis=(0, 1))


@dataclass(frozen=True)
class _Products:
    """Products of the response with periodic coefficients of one matrix.

    Parameters
    ----------
    order : int
        Derivative of the response: 0 or 1.
    matrix : ndarray, shape (n, n, S)
        Matrix, in modes.
    factors : tuple of ndarray, shape (S,)
        Harmonics of the coefficients.
    places : tuple of (ndarray, ndarray)
        For each, where products go among the H harmonics, and where they come from among these and their
        conjugates.
    """

    order: int
    matrix: np.ndarray
    factors: tuple[np.ndarray, ...]
    places: tuple[tuple[np.ndarray, np.ndarray], ...]

    def __getitem__(self, chosen: np.ndarray) -> _Products:
        factors = tuple(factor[chosen] for factor in self.factors)
        return replace(self, matrix=self.matrix[..., chosen], factors=factors)

    def sum(self, both: np.ndarray, count: int) -> np.ndarray:
        """Forces (H, n, S) by the harmonics of the response and their conjugates (2 H, n, S)."""
        product = np.zeros((count, *both.shape[1:]), dtype=complex)
        for factor, (to, source) in zip(self.factors, self.places, strict=True):
            product[to] += factor * both[source]
        return _multiply(self.matrix, product)


@dataclass(frozen=True)
class _Series:
    """What the terms are made of, for H harmonics, n modes and S pairs of rates, these last.

    Parameters
    ----------
    load : ndarray of complex, shape (H, n, S)
        Load.
    compliance : ndarray of complex, shape (H, n, S)
        Response of each mode to a load of each harmonic, by itself.
    rate : ndarray of complex, shape (H, 1, S)
        i Omega_h [1/s].
    damping : ndarray, shape (n, n, S), or None
        Damping between different modes; None if there is none.
    products : tuple of _Products
        Products with the periodic coefficients.
    """

    load: np.ndarray
    compliance: np.ndarray
    rate: np.ndarray
    damping: np.ndarray | None
    products: tuple[_Products, ...]

    @classmethod
    def of_system(cls, system: PeriodicSystem, mean: MeanModes, harmonics: list[Pair]) -> _Series:
        """Series for harmonics of which none is the opposite of another."""
        h, C = np.array(harmonics), system.mean[1]
        rate = 1j * (h @ system.rates.T)[:, None]
        damping = mean.transform(C) if C.any() else None
        resistance = mean.squared.T + rate**2
        if damping is not None:
            own = np.arange(system.size)
            resistance = resistance + rate * damping[own, own]
            damping[own, own] = 0.0
        load = np.zeros((len(h), system.size, len(system.rates)), dtype=complex)
        for spectrum, vector in system.loads:
            in_modes = np.einsum("snm,sn->ms", mean.shapes, vector)
            load += select_harmonics(spectrum, h).T[:, None] * in_modes
        products = tuple(_products(each, mean, harmonics) for each in system.varying)
        return cls(load, 1 / resistance, rate, damping, products)

    def __getitem__(self, chosen: np.ndarray) -> _Series:
        damping = None if self.damping is None else self.damping[..., chosen]
        products = tuple(each[chosen] for each in self.products)
        load, compliance, rate = (each[..., chosen] for each in (self.load, self.compliance, self.rate))
        return _Series(load, compliance, rate, damping, products)

    def respond(self, y: np.ndarray) -> np.ndarray:
        """Response (H, n, S) to the load, and to what the last response y couples."""
        force, both = self.load.copy(), np.concatenate([y, y.conj()])
        for products in self.products:
            of_rate = np.concatenate([self.rate, -self.rate]) if products.order else 1.0
            force -= products.sum(of_rate * both, len(y))
        if self.damping is not None:
            force -= self.rate * _multiply(self.damping, y)
        return force * self.compliance


def _products(
    varying: tuple[int, np.ndarray, np.ndarray], mean: MeanModes, harmonics: list[Pair]
) -> _Products:
    """Products with the periodic coefficients (order, spectrum, matrices) among some harmonics."""
    order, spectrum, matrix = varying
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
    return _Products(order, mean.transform(matrix), tuple(factors), tuple(places))


def _multiply(matrix: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Products (H, n, S) of matrices (n, n, S) with y (H, n, S)."""
    total = np.empty_like(y)
    for row, out in zip(matrix, np.moveaxis(total, 1, 0), strict=True):
        out[:] = (row * y).sum(axis=1)
    return total
