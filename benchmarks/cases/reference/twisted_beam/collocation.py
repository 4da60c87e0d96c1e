"""Eigenvalues of the twisted beam's equations by collocation at Gauss points."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import scipy.sparse as sp
from scipy.sparse.linalg import LinearOperator, eigs, splu

from benchmarks.cases.reference.twisted_beam.blade import Blade
from benchmarks.cases.reference.twisted_beam.energy import quotient
from benchmarks.cases.reference.twisted_beam.equations import (
    Section,
    rates,
    root_conditions,
    sections_at,
    tip_conditions,
)
from benchmarks.cases.reference.twisted_beam.mesh import Mesh

_NODES = 12
_AGREEMENT = 1e-11  # largest relative difference of eigenvalues and energy quotients
_FINEST = 64  # largest number of pieces of each interval between breakpoints


@dataclass(frozen=True)
class Solution:
    """Lowest eigenvalues lambda^2, and the quotients of the energies of their modes."""

    squares: np.ndarray
    quotients: np.ndarray


def solve(blade: Blade, gamma: float, count: int = 4, pieces: int = 4, nodes: int = _NODES) -> Solution:
    """Compute the lowest `count` values of lambda^2 by collocation at Gauss points.

    Parameters
    ----------
    pieces
        Number of pieces of each interval between breakpoints.
    nodes
        Number of Gauss points in each piece.
    """
    mesh = Mesh.make(blade.breakpoints, pieces, nodes)
    section = sections_at(blade, mesh)
    still, moving = _assemble(blade, gamma, mesh, section)
    found, vectors = _lowest(still, moving, count)
    states = vectors[_places(mesh, blade.planes)]  # (pieces, nodes, 4 d, count)
    last = vectors[-4 * blade.planes :]
    quotients = [
        quotient(blade, gamma, mesh, section, states[..., k], vectors[: 4 * blade.planes, k], last[:, k])
        for k in range(count)
    ]
    return Solution(found, np.array(quotients))


def converged(blade: Blade, gamma: float, count: int = 4, rtol: float = 1e-12) -> tuple[np.ndarray, float]:
    """Return the lowest lambda^2 on the first mesh that changes all by less than `rtol`, and the change.

    The values are quotients of energies, which agree with the eigenvalues to 1e-11.
    """
    before, pieces, least = solve(blade, gamma, count, 1).quotients, 2, math.inf
    while pieces <= _FINEST:
        solution = solve(blade, gamma, count, pieces)
        found = solution.quotients
        least = float(np.max(np.abs(found - before) / np.maximum(np.abs(found), 1e-3)))
        if least <= rtol and np.allclose(solution.squares, found, rtol=_AGREEMENT, atol=_AGREEMENT):
            return found, least
        before, pieces = found, 2 * pieces
    raise ArithmeticError(f"not converged: the finest mesh changes lambda^2 by {least:.1e}")


def _places(mesh: Mesh, planes: int) -> np.ndarray:
    """Return the indices of the states at the nodes among all unknowns: shape (pieces, nodes, 4 d)."""
    size = 4 * planes
    pieces, nodes = mesh.x.shape
    whole = np.arange(pieces * (nodes + 1) * size).reshape(pieces, nodes + 1, size)
    return whole[:, 1:]


def _assemble(blade: Blade, gamma: float, mesh: Mesh, section: Section) -> tuple[sp.csc_array, sp.csc_array]:
    """Assemble A and B of A y = lambda^2 B y; unknowns are states at starts and nodes, then at the tip."""
    still, moving = rates(section, gamma)
    return assemble(blade, mesh, still, moving, tip_conditions(blade, gamma))


def assemble(
    blade: Blade,
    mesh: Mesh,
    still: np.ndarray,
    moving: np.ndarray,
    at_tip: tuple[np.ndarray, np.ndarray],
) -> tuple[sp.csc_array, sp.csc_array]:
    """Assemble A and B from rates (pieces, nodes, 4 d, 4 d) and conditions at the tip."""
    pieces, nodes = mesh.x.shape
    d = 4 * blade.planes
    to_nodes = np.vstack([mesh.inner, mesh.weights])  # the last row integrates over the whole piece
    identity = np.hstack([np.tile(-np.eye(d), (nodes + 1, 1)), np.eye((nodes + 1) * d)])
    wide = pieces * (nodes + 1) * d + d
    left, right = sp.lil_array((wide, wide)), sp.lil_array((wide, wide))
    root, (tip, tip_inertia) = root_conditions(blade), at_tip
    left[: d // 2, :d] = root
    for k, h in enumerate(mesh.steps):
        start = k * (nodes + 1) * d
        rows = slice(d // 2 + start, d // 2 + start + (nodes + 1) * d)
        part = identity.copy()
        part[:, d:-d] -= h * _weighted(to_nodes, still[k])
        left[rows, start : start + (nodes + 2) * d] = part
        right[rows, start + d : start + (nodes + 1) * d] = h * _weighted(to_nodes, moving[k])
    left[-(d // 2) :, -d:], right[-(d // 2) :, -d:] = tip, tip_inertia
    return left.tocsc(), right.tocsc()


def _weighted(weights: np.ndarray, rates: np.ndarray) -> np.ndarray:
    """Compute the matrix of sum_j weights[i, j] rates[j] y_j."""
    rows, columns = weights.shape
    d = rates.shape[-1]
    return np.einsum("ij,jab->iajb", weights, rates).reshape(rows * d, columns * d)


def _lowest(left: sp.csc_array, right: sp.csc_array, count: int) -> tuple[np.ndarray, np.ndarray]:
    """Compute lowest eigenvalues and vectors by inverse Arnoldi iteration, shifted as hinges have 0."""
    shift = -1.0
    inverse = splu(sp.csc_matrix(left - shift * right))
    operator = LinearOperator(left.shape, matvec=lambda y: inverse.solve(right @ y), dtype=float)
    wanted = count + 4
    start = np.random.default_rng(1).normal(size=left.shape[0])
    values, vectors = eigs(operator, wanted, v0=start, ncv=6 * wanted, tol=0)
    squares = shift + 1 / values
    order = np.argsort(squares.real)[:count]
    if np.abs(squares[order].imag).max() > 1e-7 * np.abs(squares[order]).max():
        raise ArithmeticError(f"eigenvalues that should be real are {squares[order]}")
    pairs = [_refined(left, right, float(squares[k].real), vectors[:, k].real) for k in order]
    return np.array([value for value, _ in pairs]), np.stack([vector for _, vector in pairs], axis=1)


def _refined(
    left: sp.csc_array, right: sp.csc_array, value: float, vector: np.ndarray
) -> tuple[float, np.ndarray]:
    """Refine an eigenpair by inverse iteration: Arnoldi's method is accurate for the lowest value only."""
    shift = value + 1e-6 * max(1.0, abs(value))
    inverse = splu(sp.csc_matrix(left - shift * right))
    for _ in range(2):
        vector = vector / np.linalg.norm(vector)
        vector, before = inverse.solve(right @ vector), vector
        value = shift + float(before @ before / (before @ vector))
    return value, vector
