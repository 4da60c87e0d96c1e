"""Natural frequencies of designs that differ in numbers only, in one basis, by batched eigenproblems."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from beamdyn.common.results.statements import GROWING, NO_ANSWER, TOLERANCE, Statement, after
from beamdyn.equations.discretization import Discretization
from beamdyn.modes.modal.discretization_choice import warn_of_missed_tolerance
from beamdyn.modes.modal.many_designs import PencilStack, solve_many
from beamdyn.scene.validity import (
    LARGE_DEFLECTION,
    LARGE_STRAIN,
    warn_of_static_deflection,
    warn_of_strain,
)
from beamdyn.studies.answers import REFUSED, Caution, DesignAnswers, caution_where
from beamdyn.studies.refinement import BasisAnswers, Refinement
from beamdyn.studies.similar import PencilFamily, SimilarDesigns

_LARGE_ERROR = 1e-6  # of a frequency, beyond which it is said to be unresolved


@dataclass(frozen=True)
class SolvedDesigns:
    """Frequencies of R designs at S speeds each.

    Parameters
    ----------
    eigenvalue : ndarray of complex, shape (R, S, k)
        s in exp(s t) [1/s]; nan where there are none.
    error : ndarray, shape (R, S, k)
        Estimated relative error of the frequencies.
    deflection : ndarray, shape (R, S)
        Static tip deflection by rotation over the length, its size; nan from the critical speed on.
    functions : int
        Largest number of functions that was needed.
    """

    eigenvalue: np.ndarray
    error: np.ndarray
    deflection: np.ndarray
    functions: int


def solve_frequencies(
    designs: SimilarDesigns, refinement: Refinement, speeds: np.ndarray, ratio: np.ndarray | None = None
) -> SolvedDesigns:
    """Solve similar designs, each in the smallest basis that a single call would choose.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    refinement : Refinement
        The bases, and the number of modes.
    speeds : ndarray, shape (N, S)
        Speeds of each [rad/s].
    ratio : ndarray, shape (N,), optional
        Damping ratio of each; undamped if not given.
    """

    def solve(rows: np.ndarray, basis: Discretization) -> BasisAnswers:
        stack, coarse, family, weights = stacks_of(designs, rows, basis)
        damped = None if ratio is None else ratio[rows]
        load = np.einsum("rt,tdn,rd->rn", weights, family.loads, designs.across[rows], optimize=True)
        at, estimate = speeds[rows] * designs.time[rows, None], designs.estimate(basis)
        found = solve_many(stack, coarse, at, refinement.modes, load, family.tips, damped, estimate)
        target = np.maximum(refinement.target_of(basis), 3 * found.rounding)
        met = np.all(found.error <= target, axis=(1, 2))
        deflection = found.static / designs.reference.beam.length
        return BasisAnswers((found.eigenvalue, found.error, deflection), met)

    found, functions = refinement.solve(len(speeds), speeds.shape[1], solve)
    shape = (*speeds.shape, refinement.modes)
    nothing = np.full(shape, np.nan, dtype=complex), np.full(shape, np.nan), np.full(speeds.shape, np.nan)
    eigenvalue, error, deflection = found or nothing
    error = np.where(np.isnan(eigenvalue), np.inf, error)
    return SolvedDesigns(eigenvalue / designs.time[:, None, None], error, deflection, functions)


def frequencies_of(
    designs: SimilarDesigns, refinement: Refinement, speeds: np.ndarray, ratio: np.ndarray | None
) -> DesignAnswers:
    """The frequencies of similar designs, with what limits them; arguments as of `solve_frequencies`."""
    found = solve_frequencies(designs, refinement, speeds, ratio)
    s = found.eigenvalue
    growing, oscillating, none = np.real(s) > 0, np.imag(s) != 0, np.isnan(s)
    words = [REFUSED, "flutter", "divergence", "stable", "neutral"]
    status = np.select([none, growing & oscillating, growing, oscillating, s == 0], words, "overdamped")
    frequency = np.where(np.isin(status, ("stable", "neutral")), np.imag(s) / (2 * np.pi), np.nan)
    method = f"Ritz, at most {found.functions} functions, batched"
    cautions = (
        *_cautions_of_theory(designs, speeds, found.deflection, status),
        *cautions_of_refused(status),
        *cautions_of_error(found.error, refinement.tolerance),
    )
    return DesignAnswers(frequency, found.error, status, cautions, method)


def _cautions_of_theory(
    designs: SimilarDesigns, speeds: np.ndarray, deflection: np.ndarray, status: np.ndarray
) -> Iterator[Caution]:
    """Yield where linear theory ends, as `natural_modes` warns of it."""
    unstable = np.isin(status, ("divergence", "flutter")).any(axis=2)
    diverges = Statement(": the beam diverges; see status", kind=GROWING)
    yield from caution_where(unstable, "a", 0.0, diverges)
    strain = designs.strains(speeds)
    large, bent = strain > LARGE_STRAIN, deflection > LARGE_DEFLECTION
    if large.any():
        said = after(": ", next(warn_of_strain(float(np.nanmax(strain)))))
        yield from caution_where(large, "b", strain, said)
    if bent.any():
        at = np.unravel_index(np.nanargmax(deflection), bent.shape)
        said = next(warn_of_static_deflection(deflection[at][None], 1.0, speeds[at][None]))
        yield from caution_where(bent, "c", deflection, after(": ", said))


def cautions_of_refused(status: np.ndarray) -> Iterable[Caution]:
    """A caution of designs whose answers (R, S, k) rounding leaves unsolved, if there are any."""
    said = Statement(" there is no answer: rounding of the matrices leaves none", kind=NO_ANSWER)
    return caution_where((status == REFUSED).any(axis=2), "d", 0.0, said)


def cautions_of_error(error: np.ndarray, tolerance: float | None) -> Iterator[Caution]:
    """Yield a caution of errors (R, S, k) past a tolerance, or past what is promised without one."""
    worst, limit = error.max(axis=2), _LARGE_ERROR if tolerance is None else tolerance
    said: str = Statement(f" the estimated relative error is above {limit:g}: see error", kind=TOLERANCE)
    if tolerance is not None and worst.max() > tolerance:
        said = after(": ", next(warn_of_missed_tolerance(float(worst.max()), tolerance)))
    yield from caution_where(worst > limit, "e", worst, said)


def stacks_of(
    designs: SimilarDesigns, rows: np.ndarray, basis: Discretization
) -> tuple[PencilStack, PencilStack, PencilFamily, np.ndarray]:
    """Matrices of some designs in a basis and in the coarser one, of which family, and with which weights."""
    family, weights = designs.family(basis), designs.weights(rows)
    stack = family.stack(weights)
    if family.coarse is not None:
        return stack, stack.part(family.coarse), family, weights
    return stack, designs.family(basis.coarser()).stack(weights), family, weights
