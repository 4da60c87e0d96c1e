"""Frequencies of a scene by the second method, with their numerical uncertainties."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

import beamdyn as bd
from benchmarks.cases.reference.of_two_planes import blade_of_scene
from benchmarks.cases.reference.twisted_beam import Blade, solve
from benchmarks.cases.reference.twisted_beam.mesh import graded

_ROUNDING = 2e-14  # least relative uncertainty of a squared frequency
_FALL = 0.1  # least ratio of successive changes that is relied on: a smaller ratio may be accidental
_FINEST = 64  # largest number of pieces of the whole beam
_REST = 1e-12  # rounding error of the zero squared frequency of a free hinge, over 1 + gamma^2
_QUOTIENT = 1.0  # uncertainty of the extrapolation, over the difference of eigenvalue and energy quotient


@dataclass(frozen=True)
class Known:
    """Eigenvalues [1/s], by ascending squared frequency, and their relative uncertainties.

    They are imaginary for modes that vibrate and positive for those that diverge.  An eigenvalue whose
    magnitude is below `zero` [1/s] counts as 0, with the uncertainty 0.
    """

    eigenvalue: np.ndarray
    uncertainty: np.ndarray
    zero: float


def known_frequencies(scene: bd.Scene, speed: float, count: int) -> Known:
    """Return the frequencies on the first mesh whose refinement changes only rounding."""
    blade, unit = blade_of_scene(scene)
    gamma = speed * unit
    stops = graded((blade.mass, *blade.stiffness[: blade.planes]), scene.beam.breakpoints)
    blade = replace(blade, breakpoints=stops[1:-1])
    meshes = _meshes(len(stops) - 1)
    squares, _ = _solve(blade, gamma, count, next(meshes))
    change, error = np.full(count, np.nan), np.full(count, np.inf)
    for pieces in meshes:
        finer, rounding = _solve(blade, gamma, count, pieces)
        before, change = change, np.abs(finer - squares)
        squares = finer
        next_change = np.where(change < _FALL * before, _FALL, 1.0) * change
        error = np.maximum(next_change, rounding)
        still = np.abs(squares) < _REST * (1 + gamma**2)
        settled = (next_change <= rounding) | still
        if settled.all() and np.isfinite(before).all():
            break
    still = np.abs(squares) < _REST * (1 + gamma**2)
    error = np.where(still, 0.0, error / np.where(still, 1.0, np.abs(squares)))
    zero = float(np.sqrt(_REST * (1 + gamma**2))) / unit
    return Known(np.sqrt(-np.where(still, 0.0, squares) + 0j) / unit, error, zero)


def _solve(blade: Blade, gamma: float, count: int, pieces: int) -> tuple[np.ndarray, np.ndarray]:
    """Compute squared frequencies by collocation on one mesh, and their uncertainty by rounding.

    Rounding in the solution usually changes the quotient of energies twice as much as the eigenvalue:
    both together give the value without it.
    """
    found = solve(blade, gamma, count, pieces)
    apart = found.quotients - found.squares
    squares = found.squares - apart
    return squares, np.maximum(_ROUNDING * np.abs(squares), _QUOTIENT * np.abs(apart))


def _meshes(segments: int) -> Iterator[int]:
    """Yield numbers of pieces of each segment."""
    pieces = 2 if segments < 3 else 1
    while pieces < 8 or pieces * segments <= _FINEST:
        yield pieces
        pieces *= 2
