"""Gauss collocation for a stiffness that varies slowly with the speed, and weakly about its slow variation.

The equations are q'' + C(t) q' + (K(t) + sum_m e_m(t) G_m) q = sum_l g_l(t) P_l with constant G_m and P_l. C
and K depend on the speed.  With e = 0 the maps of the steps are smooth functions of time, which are
interpolated between a few steps by Chebyshev polynomials; at steady speed one step represents all.  The
effect of e follows from a power series in the values of e at the nodes, up to the second order.  So no step
needs a factorisation of its own, and the maps of many steps are one product of matrices.

In shapes of arrays, N counts steps, n coordinates, s nodes in a step, m the factors e, l the factors g, p
Chebyshev polynomials, and P the steps between which maps are interpolated.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from functools import cache, reduce
from typing import NamedTuple

import numpy as np

from beamdyn.transient import chebyshev, gauss

_POINTS = (25, 37)  # odd numbers of Chebyshev points in a segment of changing speed that are tried in turn
# Smallest number of steps per Chebyshev point for which interpolation is cheaper than solving every step.
_FEWEST_STEPS = 6
_MOST_VALUES = 4_000_000  # largest number of stored values of the expanded maps at changing speed, some 30 MB
# Assumed ratio of the largest stiffness variation e to its largest sample.
_LARGEST_SAMPLED = 1.5
# Number of squarings of a matrix before taking its norm, which gives a close bound of the spectral radius.
_SQUARINGS = 3
_SAMPLES = 257  # number of samples of e, the variation of the stiffness, among which the largest is sought
# Least frequency by which velocity errors are divided, as a fraction of the largest frequency of all modes.
_SLOWEST = 1e-3
_SINGLE_ROUNDING = 1e-6  # relative rounding error of sums in single precision
_STEPS = 192  # number of steps evaluated as one batch
# Number of steps for whose nodes the factors e of the stiffness and g of the loads are evaluated in one call:
# a call costs more than the values.
_SAMPLED = 16 * _STEPS


@dataclass(frozen=True)
class ModulatedSystem:
    """Equations q'' + C(t) q' + (K(t) + sum_m e_m(t) G_m) q = sum_l g_l(t) P_l with small factors e.

    Parameters
    ----------
    slow : callable
        Function from times (...) [s] to C, (..., n, n) or None, and K, (..., n, n), which depend on the
        speed.
    steady : bool
        Whether C and K are constant.
    G : ndarray, shape (m, n, n)
        Matrices G_m of the varying stiffness.
    P : ndarray, shape (l, n)
        Vectors P_l of the loads.
    scalars : callable
        Function from times (...) [s] to e, shape (..., m), and g, shape (..., l).
    lines : ndarray, shape (f,)
        Known angular frequencies [rad/s] of e and g at steady speed.
    """

    slow: Callable[[np.ndarray], tuple[np.ndarray | None, np.ndarray]]
    steady: bool
    G: np.ndarray
    P: np.ndarray
    scalars: Callable[[np.ndarray], tuple[np.ndarray, np.ndarray]]
    lines: np.ndarray


class _Steps(NamedTuple):
    """Equal steps of length h from time `first` [s], their tableau, and the accuracy after all steps."""

    system: ModulatedSystem
    first: float
    h: float
    number: int
    table: gauss.Tableau
    accuracy: float


@dataclass(frozen=True)
class _StepMapSeries:
    """Maps of steps that begin at P Chebyshev points, as a power series in the stiffness factors e.

    The accelerations at the nodes are a = (L + sum_m D_m Z_m)^-1 (R0 + sum_m D_m R_m) z, D_m = diag(e_m),
    with z = (q, v, g at the nodes) of 2 n + s l entries.  L is the matrix of the collocation equations and R0
    that of their right-hand side, both for e = 0; Z_m and R_m are the contributions of G_m.  To the second
    order in D,
    a = X0 z + Y D (R - Z X0) z - Y D Z Y D (R - Z X0) z, summed over m, with Y = L^-1 and X0 = Y R0.

    Parameters
    ----------
    Y, X0 : ndarray, shape (P, s n, s n) and (P, s n, 2 n + s l)
    R, Z : ndarray, shape (m, s n, 2 n + s l) and (m, s n, s n)
    h : float
        Step size [s].
    table : Tableau
        Coefficients of the collocation.
    """

    Y: np.ndarray
    X0: np.ndarray
    R: np.ndarray
    Z: np.ndarray
    h: float
    table: gauss.Tableau

    @classmethod
    def at(cls, system: ModulatedSystem, times: np.ndarray, h: float, table: gauss.Tableau) -> _StepMapSeries:
        """Expand the accelerations of steps of length h [s] that begin at given times [s]."""
        C, K = system.slow(times[:, None] + h * table.c)
        P, s, n, _ = K.shape
        Y = np.linalg.inv(gauss.left_side(C, K, h, table))
        free = gauss.right_side(C, K, np.zeros((P, s, n)), h, table)[:, :, 1:]
        loads = np.einsum("ij,la->iajl", np.eye(s), system.P).reshape(s * n, -1)
        # Contribution of q and v at the start of a step to the displacements at the nodes.
        drift = np.stack([np.ones(s), h * table.c], axis=1)
        R = -np.einsum("ix,mab->miaxb", drift, system.G).reshape(-1, s * n, 2 * n)
        R = np.concatenate([R, np.zeros((len(R), *loads.shape))], axis=2)
        Z = h**2 * np.einsum("ij,mab->miajb", table.A2, system.G).reshape(-1, s * n, s * n)
        return cls(Y, np.concatenate([Y @ free, Y @ loads], axis=2), R, Z, h, table)

    def every(self, stride: int) -> _StepMapSeries:
        """Select the series at every `stride`-th Chebyshev point."""
        return replace(self, Y=self.Y[::stride], X0=self.X0[::stride])

    @property
    def size(self) -> int:
        """Number n of coordinates."""
        return self.Y.shape[1] // len(self.table.c)

    def constant(self) -> np.ndarray:
        """Compute the maps from z to the state at the end of a step, for stiffness factors of 0."""
        return gauss.add_drift(gauss.increment(self.X0, self.h, self.table), self.h, first=0)[:, None]

    def _parts(self) -> tuple[np.ndarray, np.ndarray]:
        """Compute two factors of the series: maps from forces at nodes to the end of a step, and W.

        The nodes are the s collocation points in a step.  The first array, (P, s, 2 n, n), maps forces at the
        nodes to the state at the end of the step, for stiffness factors e = 0.  The second is
        W = R - Z X0, (P, m, s, n, 2 n + s l): the change of the forces at the nodes per unit of each factor
        e, for each entry of z: the state at the start of the step, and the load factors g at the nodes.  R
        and Z are the contributions of the factors to the right and the left side of the collocation
        equations; X0 maps z to the accelerations at the nodes for e = 0.
        """
        P, s, n = len(self.Y), len(self.table.c), self.size
        ends = gauss.increment(self.Y, self.h, self.table).reshape(P, 2 * n, s, n)
        W = self.R - self.Z @ self.X0[:, None]
        return np.moveaxis(ends, 2, 1), W.reshape(P, len(self.Z), s, n, W.shape[-1])

    def first(self) -> np.ndarray:
        """Compute the terms of first order in the stiffness factors in the maps to the end of a step.

        There is one term for each factor and node, along the second axis.
        """
        ends, W = self._parts()
        found = ends[:, None] @ W
        return found.reshape(len(found), -1, *found.shape[3:])

    def second(self) -> np.ndarray:
        """Compute the terms of second order in the stiffness factors in the maps to the end of a step.

        The m factors e have m s values at the s nodes of a step.  The shape is
        (P, m s (m s + 1) / 2, 2 n, :): a term for each pair e_k, e_l with k <= l of these values.
        """
        ends, W = self._parts()
        P, m, s, n, columns = W.shape
        ZY = (self.Z @ self.Y[:, None]).reshape(P, m, s, n, s * n)
        left = (ends[:, None] @ ZY).reshape(P, m * s * 2 * n, s, n).swapaxes(1, 2)
        # Terms in which e_k acts first, and then e_l acts on the resulting motion.
        pairs = (left[:, None] @ W).reshape(P, m * s, m * s, 2 * n, columns)
        rows, cols = _pairs(m * s)
        found = pairs[:, rows, cols]
        found += pairs[:, cols, rows]
        return np.multiply(found, np.where(rows == cols, -0.5, -1.0)[:, None, None], out=found)

    def ratio(self) -> np.ndarray:
        """Bound the ratio of successive terms of the series, per unit of each factor e."""
        A = self.Z @ self.Y[:, None]
        norm = np.linalg.norm(A, axis=(2, 3)) + 1e-300
        A = A / norm[:, :, None, None]
        for _ in range(_SQUARINGS):
            A = A @ A
        return (norm * np.linalg.norm(A, axis=(2, 3)) ** (0.5**_SQUARINGS)).max(axis=0)


@dataclass(frozen=True)
class _Expansion:
    """Maps of all steps as sums of Chebyshev polynomials of the step's beginning, times monomials in e.

    Parameters
    ----------
    maps : list of Polynomials, of shapes (p_o, k_o, 2 n, 2 n + s l)
        The maps to the end of a step, for the k_o monomials of orders 0, 1 and 2.
    X0, Y : Polynomials, of shape (p, s n, :)
        X0 and Y of `_StepMapSeries`.
    ratio : ndarray, shape (m,)
        Ratio of successive terms of the series for e_m = 1.
    point : _StepMapSeries
        The series at the Chebyshev points.
    """

    maps: list[chebyshev.Polynomials]
    X0: chebyshev.Polynomials
    Y: chebyshev.Polynomials
    ratio: np.ndarray
    point: _StepMapSeries

    @classmethod
    def of(cls, steps: _Steps, points: int) -> _Expansion | None:
        """Expand the maps of steps in Chebyshev polynomials through a number of points.

        Returns None if the polynomials through these points are not accurate enough after all steps.
        """
        system, first, h, count, table, accuracy = steps
        begin = first + (count - 1) * h * (1 + chebyshev.extrema(points)) / 2
        point = _StepMapSeries.at(system, begin, h, table)
        e, _ = system.scalars(np.linspace(first, first + count * h, _SAMPLES)[1:-1])
        largest, ratio = _LARGEST_SAMPLED * np.abs(e).max(axis=0), point.every(3).ratio()
        rows, columns = _scales(system, point.constant(), first, table)
        maps, allowed = [], accuracy / count
        orders = point.constant, point.first, point.every(2).second
        monomials = _monomials_by_order(np.repeat(largest, len(table.c))[None])
        for k, (order, factor) in enumerate(zip(orders, monomials, strict=True)):
            values = chebyshev.expand(order())
            size = (np.abs(values * (rows[:, None] * columns)).max(axis=(2, 3)) * factor).sum(axis=1)
            if len(size) > 1 and size[-1] > allowed:  # these Chebyshev points are too few
                return None
            rough = k > 0 and size.sum() * _SINGLE_ROUNDING <= allowed
            maps.append(chebyshev.Polynomials(values, size, allowed).shortened(rough))
        change = float(ratio @ largest)  # ratio of the first-order change to the unperturbed map
        X0, Y = chebyshev.expand(point.X0), chebyshev.expand(point.Y)
        # Errors of accelerations are compared as those of displacements: divided by squared frequencies.
        forces = np.tile(rows[point.size :] ** 2, len(table.c))
        size = np.abs(X0 * (forces[:, None] * columns)).max(axis=(1, 2))
        terms = chebyshev.Polynomials(X0, size, min(chebyshev.NEGLIGIBLE * accuracy, 1.0) * size.max())
        size, share = np.abs(Y).max(axis=(1, 2)), accuracy / max(change, accuracy)
        varied = chebyshev.Polynomials(Y, size, min(chebyshev.NEGLIGIBLE * share, 1.0) * size.max())
        rough = change * _SINGLE_ROUNDING <= accuracy
        return cls(maps, terms.shortened(rough=False), varied.shortened(rough), ratio, point)

    def over(self, start: float, end: float) -> _Block:
        """Return the maps of steps that begin between `start` and `end` on the scale [-1, 1] of all steps.

        Fewer polynomials suffice for this part than for all steps.
        """
        parts = *self.maps, self.X0, self.Y
        local = chebyshev.to_part(max(len(part.values) for part in parts), start, end)
        *maps, X0, Y = (part.over(local) for part in parts)
        return _Block(tuple(maps), X0, Y, self.point)


@dataclass(frozen=True)
class _Block:
    """Maps of neighbouring steps, by polynomials that are accurate for these steps only."""

    maps: tuple[np.ndarray, ...]
    X0: np.ndarray
    Y: np.ndarray
    point: _StepMapSeries

    def polynomials(self, x: np.ndarray) -> np.ndarray:
        """Evaluate the p Chebyshev polynomials that the block needs, at x in [-1, 1]: p columns."""
        return chebyshev.polynomials(x, max(len(values) for values in (*self.maps, self.X0, self.Y)))

    def steps(self, T: np.ndarray, e: np.ndarray) -> np.ndarray:
        """Compute maps of steps from the polynomials' values T at the steps' starts, and from factors e."""
        rows, columns = self.maps[0].shape[2:]
        # One sum for each precision: terms for which single precision suffices are summed in it.
        sums: dict[np.dtype, np.ndarray] = {}
        for monomials, values in zip(_monomials_by_order(e), self.maps, strict=True):
            kind = values.dtype
            factor = _products(T.astype(kind), monomials.astype(kind), values)
            term = factor @ values.reshape(factor.shape[1], rows * columns)
            sums[kind] = sums[kind] + term if kind in sums else term
        return reduce(np.add, sums.values()).reshape(len(e), rows, columns)

    def accelerations(self, T: np.ndarray, e: np.ndarray, z: np.ndarray) -> np.ndarray:
        """Compute accelerations at the nodes of steps from T and e, as for `steps`, and vectors z (rows)."""
        R, Z, n = self.point.R, self.point.Z, self.point.size
        factor = np.repeat(
            e.reshape(len(e), len(Z), len(self.point.table.c)).swapaxes(0, 1), n, axis=2
        )  # shape (factors, steps, nodes x coordinates)
        total = _evaluate(self.X0, T, z)
        more = (factor * (z @ R.swapaxes(1, 2) - total @ Z.swapaxes(1, 2))).sum(axis=0)
        kind = self.Y.dtype
        T, more = T.astype(kind), more.astype(kind)
        again = _evaluate(self.Y, T, more) @ Z.swapaxes(1, 2)
        more -= (factor * again).sum(axis=0)
        return total + _evaluate(self.Y, T, more)


def _products(T: np.ndarray, monomials: np.ndarray, values: np.ndarray) -> np.ndarray:
    """In each row, multiply each value in T by each entry of `monomials`: (rows, products).

    A row of T has the values of Chebyshev polynomials at the start of one step.  Only the first len(values)
    of them are used, one for each coefficient in `values`.  The products are the weights with which these
    coefficients are summed.
    """
    return (T[:, : len(values), None] * monomials[:, None, :]).reshape(len(T), -1)


def _evaluate(coefficients: np.ndarray, T: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Evaluate a series of matrices with Chebyshev polynomials T (rows), and multiply them with z (rows)."""
    p, rows, columns = coefficients.shape
    return _products(T, z, coefficients) @ coefficients.swapaxes(1, 2).reshape(p * columns, rows)


@cache
def _pairs(d: int) -> tuple[np.ndarray, np.ndarray]:
    """List the indices k <= l of all pairs of d numbers."""
    return np.triu_indices(d)


def _scales(
    system: ModulatedSystem, constant: np.ndarray, t: float, table: gauss.Tableau
) -> tuple[np.ndarray, np.ndarray]:
    """Compute factors of rows and of columns that make the entries of maps comparable.

    Errors of velocity are divided by the angular frequency, errors of loads by each load's largest effect in
    a step.
    """
    K = system.slow(np.array([t]))[1][0]
    n, frequency = len(K), np.sqrt(np.abs(np.diag(K)))
    frequency = np.maximum(frequency, frequency.max() * _SLOWEST + 1e-300)
    rows = np.concatenate([np.ones(n), 1 / frequency])
    effect = np.abs(constant[:, 0, :, 2 * n :] * rows[:, None]).max(axis=(0, 1)).reshape(len(table.c), -1)
    loads = np.tile(1 / (effect.max(axis=0) + 1e-300), len(table.c))
    return rows, np.concatenate([np.ones(n), frequency, loads])


def propagate_modulated(
    system: ModulatedSystem,
    t0: float,
    t1: float,
    steps: int,
    q0: np.ndarray,
    v0: np.ndarray,
    stages: int,
    accuracy: float,
) -> gauss.Segment | None:
    """Integrate over equal steps, whose maps from state to state are power series in the stiffness factors e.

    Over time, the coefficients of the series are interpolated by Chebyshev polynomials.

    Parameters
    ----------
    system : ModulatedSystem
        The equations.
    t0, t1, steps, q0, v0, stages
        As for `propagate`.
    accuracy : float
        Largest allowed relative error by truncating the series, estimated as rho^3 times the number of steps,
        where rho is the ratio of successive terms, and by truncating the Chebyshev polynomials.

    Returns
    -------
    Segment or None
        Segment; None if the stiffness varies too strongly for the series, or too fast for the polynomials.
    """
    h, table = (t1 - t0) / steps, gauss.tableau(stages)
    expansion = _expand(_Steps(system, t0, h, steps, table, accuracy))
    if expansion is None:
        return None
    state, acceleration = gauss.allocate_steps(steps, stages, q0, v0)
    for block, e, g in _blocks(system, t0, h, steps, table):
        if steps * (expansion.ratio * np.abs(e).max(axis=(0, 1))).sum() ** 3 > accuracy:
            return None
        start, end = (2 * k / max(steps - 1, 1) - 1 for k in (block.start, block.stop - 1))
        ends = slice(block.start, block.stop + 1)
        _advance_block(expansion.over(start, end), e, g, state[ends], acceleration[block])
    return gauss.Segment(t0, h, state, acceleration)


def _blocks(
    system: ModulatedSystem, t0: float, h: float, steps: int, table: gauss.Tableau
) -> Iterator[tuple[slice, np.ndarray, np.ndarray]]:
    """Yield blocks of N steps, with the factors e (N, s, m) and g (N, s, l) at the s nodes of each step."""
    for first in range(0, steps, _SAMPLED):
        last = min(first + _SAMPLED, steps)
        e, g = system.scalars(t0 + h * (np.arange(first, last)[:, None] + table.c))
        for k in range(first, last, _STEPS):
            here = slice(k - first, min(k + _STEPS, last) - first)
            yield slice(k, min(k + _STEPS, last)), e[here], g[here]


def _advance_block(
    local: _Block, e: np.ndarray, g: np.ndarray, state: np.ndarray, acceleration: np.ndarray
) -> None:
    """Compute the states state[1:] of a block of N steps from state[0], and accelerations at their nodes."""
    N, columns = len(e), state.shape[1]
    T = local.polynomials(2 * np.arange(N) / max(N - 1, 1) - 1)
    # One row per step: the factors at all of its nodes.
    e, g = np.moveaxis(e, 2, 1).reshape(N, -1), g.reshape(N, -1)
    maps = local.steps(T, e)
    affine = np.empty((N, columns - 1, columns))
    np.matmul(maps[:, :, columns - 1 :], g[:, :, None], out=affine[:, :, :1])
    affine[:, :, 1:] = maps[:, :, : columns - 1]
    gauss.advance(affine, state)
    z = np.concatenate([state[:-1, 1:], g], axis=1)
    acceleration[:] = local.accelerations(T, e, z).reshape(acceleration.shape)


def _expand(steps: _Steps) -> _Expansion | None:
    """Expand the maps of steps with the fewest Chebyshev points that suffice; None if none suffices."""
    system, s = steps.system, len(steps.table.c)
    if system.steady:
        return _Expansion.of(steps, 1)
    n, d = system.G.shape[1], len(system.G) * s
    width = 2 * n * (2 * n + s * len(system.P))
    for points in _POINTS:
        terms = points + points * d + points * d * d // 4
        if steps.number < _FEWEST_STEPS * points or terms * width > _MOST_VALUES:
            return None
        if (found := _Expansion.of(steps, points)) is not None:
            return found
    return None


def _monomials_by_order(e: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Compute the monomials of each row of e (N, d) up to the second order, one array for each order.

    The monomials are 1, all e_k, and all e_k e_l with k <= l.
    """
    rows, columns = _pairs(e.shape[1])
    return np.ones((len(e), 1)), e, e[:, rows] * e[:, columns]
