"""Work-precision of natural frequencies: bases and elements over their number."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import Any, Literal

import numpy as np

from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.bounds import frequency_bounds
from beamdyn.modes.locus import frequency_locus
from beamdyn.modes.modal.error_estimate import EstimatedModes, solve_with_error
from beamdyn.modes.modal.model import Model
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.scene import Scene
from beamdyn.studies.tradeoffs.measurements import Diagram, number_of
from beamdyn.studies.tradeoffs.timing import Family, Setting, measure_families

Basis = Literal["legendre", "eigenfunctions"]
Mesh = Literal["graded", "uniform"]

_LEGENDRE = (*range(1, 13), 14, 16, 18, 20, 24, 28, 32, 40)
_EIGENFUNCTIONS = (1, 2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 28, 40, 56, 80)
_ELEMENTS = (2, 3, 4, 5, 6, 8, 10, 12, 16, 20, 28, 40, 56, 80)
_TOLERANCES = tuple(10.0**-k for k in range(1, 13))
_REFERENCES = (40, 80, 160)  # numbers of functions of the reference, tried in turn
_RESOLVED = 1e-10  # relative error of a reference that is accurate enough


@one_blas_thread()  # the matrices are small: more threads only wait for each other
def frequency_diagram(scene: Scene, speeds: np.ndarray, modes: int = 3, budget: float = 10.0) -> Diagram:
    """Measure error against time of the natural frequencies at one speed or a batch of speeds.

    The time of a basis is that of its matrices and eigenvalues; extrapolated finite elements are solved
    twice, also with half the elements; ``tolerance=`` is the time of the whole call, which also chooses
    the basis and estimates the error.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is not used.
    speeds : ndarray, shape (S,)
        Speeds [rad/s], ascending.
    modes : int
        Number of the lowest modes.
    budget : float
        Time for all measurements [s].

    Returns
    -------
    Diagram

    Raises
    ------
    ArithmeticError
        If the reference is not within the guaranteed bounds.
    """
    exact = solve_reference(scene, speeds, modes)
    true = sizes_of_eigenvalues(exact.eigen.eigenvalue)

    def error(eigenvalues: np.ndarray) -> float:
        with np.errstate(divide="ignore", invalid="ignore"):
            return float(np.abs(sizes_of_eigenvalues(eigenvalues) / true - 1).max())

    measurements, skipped = measure_families(
        list(_families(scene, speeds, modes)), error, resolved := float(exact.error.max()), budget
    )
    at = (
        f"at {speeds[0]:.6g} rad/s"
        if len(speeds) == 1
        else f"at {len(speeds)} speeds to {speeds[-1]:.6g} rad/s"
    )
    reference = f"{exact.model.discretization}; {_compare_with_bounds(exact, float(speeds[-1]), modes)}"
    return Diagram.make(
        f"{number_of(modes, 'frequency', 'frequencies')} {at}",
        "the worst frequency, relative",
        reference,
        resolved,
        measurements,
        skipped,
    )


def sizes_of_eigenvalues(eigenvalues: np.ndarray) -> np.ndarray:
    """Magnitudes of eigenvalues in ascending order, shape (S, m)."""
    return np.sort(np.abs(eigenvalues), axis=-1)


def solve_reference(scene: Scene, speeds: np.ndarray, modes: int) -> EstimatedModes:
    """Compute reference modes, with as many Ritz functions as resolve them."""
    segments = len(scene.modelled_beam.breakpoints) - 1
    for functions in _REFERENCES[:-1]:
        solution = _solve_by_ritz(scene, speeds, modes, functions // segments)
        if solution.error.max() <= _RESOLVED:
            return solution
    return _solve_by_ritz(scene, speeds, modes, _REFERENCES[-1] // segments)


def _solve_by_ritz(scene: Scene, speeds: np.ndarray, modes: int, functions: int) -> EstimatedModes:
    """Solve for modes and their errors with a number of Ritz functions on each segment.

    They are as many that the coarser basis, which gives the errors, has all modes, too.
    """
    return solve_with_error(Model(scene, Ritz(max(functions, 12, 5 * modes // 4 + 3))), speeds, modes)


def _compare_with_bounds(exact: EstimatedModes, speed: float, modes: int) -> str:
    """Check the reference against the guaranteed bounds at a speed; return the outcome in words."""
    try:
        bounds = frequency_bounds(exact.model.scene, speed, modes)
    except ValueError:  # stretch or damping
        return "the guaranteed bounds do not cover this model"
    s = exact.eigen.eigenvalue[-1]
    squared = np.sort(-np.real(s**2))
    slack = 2 * exact.error.max() * np.abs(squared)
    below, above = squared < bounds.lower_squared - slack, squared > bounds.upper_squared + slack
    if below.any() or above.any():
        raise ArithmeticError(f"the reference at {speed:g} rad/s is not within the guaranteed bounds")
    if np.isnan(bounds.width).any():
        return f"within the guaranteed bounds at {speed:.6g} rad/s as far as there are any"
    return f"within the guaranteed bounds at {speed:.6g} rad/s, {bounds.width.max():.0e} apart"


def _families(scene: Scene, speeds: np.ndarray, modes: int) -> Iterator[Family]:
    """All families to measure: Ritz bases, finite elements, and the choice by a tolerance."""
    segments = len(scene.modelled_beam.breakpoints) - 1
    least = -(-modes // segments)  # Legendre functions are counted per segment
    yield _ritz_family(scene, speeds, modes, "legendre", [n for n in _LEGENDRE if n >= least])
    yield _ritz_family(scene, speeds, modes, "eigenfunctions", [n for n in _EIGENFUNCTIONS if n >= modes])
    meshes: tuple[Mesh, ...] = ("graded", "uniform")
    for mesh in meshes:
        yield from _fem_pair(scene, speeds, modes, mesh, segments)
    if (
        not scene.physics.stretch
    ):  # with it modes may cross: a tracked locus then differs from the lowest modes
        cases = (Setting(f"tolerance={t:.0e}", t, _full_call(scene, speeds, modes, t)) for t in _TOLERANCES)
        yield Family("tolerance=", tuple(cases))


def _ritz_family(scene: Scene, speeds: np.ndarray, modes: int, basis: Basis, sizes: Sequence[int]) -> Family:
    """Family of a Ritz basis, over its number of functions."""
    segmented = basis == "legendre" and len(scene.modelled_beam.breakpoints) > 2
    each = "functions a segment" if segmented else "functions"
    cases = (Setting(f"{n} {each}", n, _solve(scene, Ritz(n, basis), speeds, modes)) for n in sizes)
    return Family(f"Ritz, {basis}", tuple(cases))


def _fem_pair(scene: Scene, speeds: np.ndarray, modes: int, mesh: Mesh, segments: int) -> Iterator[Family]:
    """Families of finite elements, plain and extrapolated."""
    from beamdyn.equations.fem import Fem  # loads scikit-fem

    for name, solve, share in (("", _solve, 1), (", extrapolated", _extrapolate, 2)):
        least = max(segments, -(-modes // 2), 2) * share
        cases = (
            Setting(f"{n} elements", n, solve(scene, Fem(n, mesh), speeds, modes))
            for n in _ELEMENTS
            if n >= least
        )
        yield Family(f"elements, {mesh}{name}", tuple(cases))


def _solve(
    scene: Scene, discretization: Discretization, speeds: np.ndarray, modes: int
) -> Callable[[float], Any]:
    """Computation of the eigenvalues by a discretization."""
    return lambda deadline: Model(scene, discretization).solver.eigenvalues(speeds, modes)


def _extrapolate(
    scene: Scene, discretization: Discretization, speeds: np.ndarray, modes: int
) -> Callable[[float], Any]:
    """Richardson extrapolation from half the elements."""
    fine, coarse = (_solve(scene, d, speeds, modes) for d in (discretization, discretization.coarser()))
    gain = 2 ** (discretization.order or 4) - 1

    def run(deadline: float) -> np.ndarray:
        s = fine(deadline)
        return s + (s - coarse(deadline)) / gain

    return run


def _full_call(scene: Scene, speeds: np.ndarray, modes: int, tolerance: float) -> Callable[[float], Any]:
    """Whole call of `natural_modes` or `frequency_locus` with a tolerance."""
    if len(speeds) == 1:
        return lambda deadline: natural_modes(scene, speeds[0], modes, tolerance=tolerance).eigenvalue[None]
    return lambda deadline: frequency_locus(scene, speeds, modes, tolerance=tolerance).eigenvalue
