"""Modes over many speeds, interpolated between those at a few.

Without damping squared frequencies are smooth functions of the speed, and so are the modes, but for sharp
veerings; without gyroscopic terms, of the squared speed.  They are interpolated in Chebyshev points of an
interval.  The error of the interpolant is estimated by its coefficients of highest degree: where they exceed
rounding, there are more points, and then the interval is halved, down to a few speeds, which are solved each.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.polynomial import chebyshev

from beamdyn.common.numerics import assign
from beamdyn.modes.modal.eigenproblem import Eigen, Eigensolver

_FEW = 160  # largest number of speeds that are solved individually
_INTERVALS = 8, 16, 32  # numbers of intervals between the points, doubled in turn
# Part of a series' coefficients, the last third, whose size tells whether the series converges fast enough.
_HIGHEST = 3
# Misfit of interpolated squared frequencies in addition to rounding, included in the stated error.
_MISFIT = 1e-12
_MISFIT_OF_MODES = 1e-7  # misfit of interpolated modes over their largest coordinate: modes are only compared
_LEBESGUE = 3.0  # growth of rounding errors by interpolation: Lebesgue constant of 17 to 33 points

Solve = Callable[[np.ndarray], Eigen]  # a function that computes modes at given speeds [rad/s]


def solve_over_speeds(solver: Eigensolver, speeds: np.ndarray, count: int) -> Eigen:
    """Compute the `count` lowest modes at speeds (S,) [rad/s], as `Eigensolver.solve` does."""
    if len(speeds) <= _FEW or solver.pencil.C.any():
        return solver.solve(speeds, count)
    return _solve_over(solver, speeds, lambda some: solver.solve(some, count))


def eigenvalues_over_speeds(solver: Eigensolver, speeds: np.ndarray, count: int) -> np.ndarray:
    """Compute the eigenvalues of the `count` lowest modes at speeds (S,), shape (S, count)."""
    if len(speeds) <= _FEW:
        return solver.eigenvalues(speeds, count)

    def solve(some: np.ndarray) -> Eigen:
        found = solver.solve(some, count)
        return Eigen(found.eigenvalue, found.vector[:, :0], found.rounding)

    return (solve(speeds) if solver.pencil.C.any() else _solve_over(solver, speeds, solve)).eigenvalue


def _solve_over(solver: Eigensolver, speeds: np.ndarray, solve: Solve) -> Eigen:
    """Solve modes at speeds of either sign; reversed gyroscopic modes have conjugate vectors.

    For a growing mode, the reversed rotation has the decaying one, which was not found: such speeds are
    solved individually.
    """
    # Both senses of rotation have the same frequencies.
    sizes, place = np.unique(np.abs(speeds), return_inverse=True)
    found, backwards = _solve_ascending(solver, sizes, solve), speeds < 0
    if len(sizes) < len(speeds) or backwards.any():
        found = Eigen(found.eigenvalue[place], found.vector[place], found.rounding[place])
    if not np.iscomplexobj(found.vector):
        return found
    vector = np.where(backwards[:, None, None], found.vector.conj(), found.vector)
    turned = Eigen(found.eigenvalue.copy(), vector, found.rounding.copy())
    growing = backwards & (np.real(found.eigenvalue) != 0).any(axis=1)
    if growing.any():
        each = solve(speeds[growing])
        turned.eigenvalue[growing], turned.vector[growing] = each.eigenvalue, each.vector
        turned.rounding[growing] = each.rounding
    return turned


def _solve_ascending(solver: Eigensolver, speeds: np.ndarray, solve: Solve) -> Eigen:
    """Compute modes at ascending speeds from 0, by Chebyshev points, doubled until they suffice.

    Without gyroscopic terms modes are smooth functions of the squared speed, else of the speed.
    """
    if len(speeds) <= _FEW:
        return solve(speeds)
    power = 2 if solver.conservative else 1
    known, (low, high) = None, speeds[[0, -1]] ** power
    for intervals in _INTERVALS:
        nodes = np.clip(low + (high - low) * (1 + _nodes(intervals)) / 2, low, high) ** (1 / power)
        if known is None:
            known = solve(nodes)
        else:
            between, places = solve(nodes[1::2]), np.arange(1, len(known.eigenvalue))
            known = Eigen(
                np.insert(known.eigenvalue, places, between.eigenvalue, axis=0),
                np.insert(known.vector, places, between.vector, axis=0),
                np.insert(known.rounding, places, between.rounding, axis=0),
            )
        if (found := _interpolate(solver, known, speeds, power)) is not None:
            return found
    parts = [_solve_ascending(solver, part, solve) for part in np.array_split(speeds, 2)]
    joined = zip(*((p.eigenvalue, p.vector, p.rounding) for p in parts), strict=True)
    return Eigen(*map(np.concatenate, joined))


def _nodes(intervals: int) -> np.ndarray:
    """Compute the Chebyshev points of [-1, 1], including its ends, ascending."""
    return -np.cos(np.pi * np.arange(intervals + 1) / intervals)


def _interpolate(solver: Eigensolver, eigen: Eigen, speeds: np.ndarray, power: int) -> Eigen | None:
    """Interpolate modes at ascending speeds from Chebyshev points; None where these are too few."""
    if (np.real(eigen.eigenvalue) * np.imag(eigen.eigenvalue)).any():  # flutter is not interpolated
        return None
    points, count = eigen.eigenvalue.shape
    (low, high), t = speeds[[0, -1]] ** power, _nodes(points - 1)
    squared, vector = np.real(-(eigen.eigenvalue**2)), _align(eigen.vector, solver.pencil.M)
    at_nodes = np.concatenate([squared, vector.reshape(points, -1)], axis=1)
    series = np.linalg.solve(chebyshev.chebvander(t, points - 1), at_nodes)
    misfit = np.abs(series[-(points // _HIGHEST) :]).sum(axis=0)
    # Relative misfits: 0 for values that are 0 at all speeds; inf for a value 0 at only one of them.
    size, of_squares = np.abs(squared).min(axis=0), np.where(misfit[:count] > 0, np.inf, 0.0)
    np.divide(misfit[:count], size, out=of_squares, where=size > 0)
    of_modes = misfit[count:].max(initial=0.0) <= _MISFIT_OF_MODES * np.abs(vector).max(initial=0.0)
    if not (of_modes and (of_squares <= _MISFIT + eigen.rounding.min(axis=0)).all()):
        return None
    values = chebyshev.chebvander(2 * (speeds**power - low) / (high - low) - 1, points - 1) @ series
    squares = np.real(values[:, :count])
    root = np.sqrt(np.abs(squares))
    return Eigen(
        eigenvalue=np.where(squares > 0, 1j * root, root),
        vector=values[:, count:].reshape(len(speeds), -1, count),
        rounding=np.tile(_LEBESGUE * eigen.rounding.max(axis=0) + of_squares, (len(speeds), 1)),
    )


def _align(vector: np.ndarray, mass: np.ndarray) -> np.ndarray:
    """Give modes (S, n, k) at successive speeds the same signs, or phases if they are complex."""
    if not vector.size:
        return vector
    products = np.einsum("snk,snk->sk", vector[:-1], mass @ vector[1:].conj())
    size = np.abs(products)
    turns = np.where(size > 0, products / np.where(size > 0, size, 1.0), 1.0)
    return np.concatenate([vector[:1], vector[1:] * np.cumprod(turns, axis=0)[:, None, :]])


_NORMALIZED = 2e-6  # distance of a squared norm from 1 that counts as rounding


def track(vectors: np.ndarray, mass: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Follow modes from each speed to the next by the modal assurance criterion (MAC).

    Parameters
    ----------
    vectors : ndarray, shape (S, n, k)
        Mode vectors at each speed, by ascending frequency; mass-normalised, or nearly so where the mass
        varies with the speed.
    mass : ndarray, shape (n, n)
        Mass matrix.

    Returns
    -------
    order : ndarray of int, shape (S, k)
        ``order[s, i]`` is the index at speed s of the mode that is the i-th at the first speed.
    confidence : ndarray, shape (S, k)
        MAC with the same mode at the speed before, minus the largest MAC of that mode with any other: 1
        is certain, 0 or less a guess.
    """
    weighted = mass @ vectors
    squares = np.einsum("snk,snk->sk", vectors.conj(), weighted).real
    squares = np.where(np.abs(squares - 1) < _NORMALIZED, 1.0, squares)
    mac = np.abs(np.swapaxes(vectors[:-1].conj(), 1, 2) @ weighted[1:]) ** 2
    mac /= squares[:-1, :, None] * squares[1:, None, :]
    S, _, k = vectors.shape
    order, confidence = np.tile(np.arange(k), (S, 1)), np.ones((S, k))
    successor = mac.argmax(axis=2)  # successor of each mode, which has the largest sum of MACs
    unique = (np.sort(successor, axis=1) == np.arange(k)).all(axis=1)
    for s in np.flatnonzero(~unique):
        successor[s] = assign(-mac[s])
    for s in np.flatnonzero((successor != np.arange(k)).any(axis=1)):
        order[s + 1 :] = successor[s][order[s]]  # holds until the next exchange
    matched = np.take_along_axis(mac, successor[:, :, None], axis=2)[:, :, 0]
    others = mac.copy()
    np.put_along_axis(others, successor[:, :, None], -1.0, axis=2)
    margin = matched - others.max(axis=2, initial=0.0)
    confidence[1:] = np.take_along_axis(margin, order[:-1], axis=1)
    return order, confidence
