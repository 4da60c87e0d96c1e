"""Frequencies of a scene by the second method, and to how many digits these are known."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

import beamdyn as bd
from benchmarks.cases.reference.of_two_planes import blade_of_scene
from benchmarks.cases.reference.twisted_beam import solve

_ROUNDING = 2e-14  # relative change of a squared frequency from mesh to mesh that is rounding
_SLOWEST = 0.1  # ratio of the changes of two refinements above which the mesh is not the cause
_FINEST = 64  # pieces of the whole beam
_REST = 1e-12  # nondimensional squared frequency of a beam that turns freely about its hinge


@dataclass(frozen=True)
class Known:
    """Angular frequencies [rad/s], the lowest first, and their relative uncertainties.

    A frequency of 0 has the uncertainty 0.
    """

    omega: np.ndarray
    uncertainty: np.ndarray


def known_frequencies(scene: bd.Scene, speed: float, count: int) -> Known:
    """Those of the first mesh whose refinement changes nothing but rounding.

    The eigenvalues of the collocation are taken: the quotients of energies that `converged` gives lose more
    digits near the critical speed.
    """
    blade, unit = blade_of_scene(scene)
    meshes = _meshes(len(scene.beam.breakpoints) - 1)
    squares = solve(blade, speed * unit, count, next(meshes)).squares
    change, error = np.full(count, np.nan), np.full(count, np.inf)
    for pieces in meshes:
        finer = solve(blade, speed * unit, count, pieces).squares
        before, change = change, np.abs(finer - squares)
        squares = finer
        ratio = np.where(change < _SLOWEST * before, change / before, 1.0)
        error = change * ratio  # the order of convergence is high: the next change is smaller at least so
        settled = (error <= _ROUNDING * np.abs(squares)) | (ratio == 1.0) | (np.abs(squares) < _REST)
        if settled.all() and np.isfinite(before).all():
            break
    error = np.maximum.accumulate(error)  # rounding changes no frequency less than a lower one
    still = np.abs(squares) < _REST
    relative = np.maximum(error / np.where(still, np.inf, np.abs(squares)), _ROUNDING)
    return Known(np.sqrt(np.where(still, 0.0, squares)) / unit, np.where(still, 0.0, relative))


def _meshes(segments: int) -> Iterator[int]:
    """Numbers of pieces of each segment."""
    pieces = 1
    while pieces == 1 or pieces * segments <= _FINEST:
        yield pieces
        pieces *= 2
