"""Natural frequencies of designs that differ in numbers only, in one basis, by batched eigenproblems."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.discretization import Discretization
from beamdyn.modal.choice import DiscretizationChoice, warn_of_missed_tolerance
from beamdyn.modal.many_designs import PencilStack, solve_many
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


@dataclass(frozen=True)
class SimilarFrequencies(FieldsOnly):
    """The frequencies of similar designs: each in the smallest basis that a single call would choose.

    Parameters
    ----------
    designs : SimilarDesigns
        N designs.
    speeds : ndarray, shape (N, S)
        Speeds of each [rad/s].
    modes : int
        Number k of modes.
    discretization : {"ritz"} or Ritz
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`.
    ratio : ndarray, shape (N,), optional
        Damping ratio of each; undamped if not given.
    """

    designs: SimilarDesigns
    speeds: np.ndarray
    modes: int
    discretization: DiscretizationChoice
    tolerance: float | None
    ratio: np.ndarray | None = None

    @cached_property
    def _refinement(self) -> Refinement:
        return Refinement(self.designs.reference, self.modes, self.discretization, self.tolerance)

    def solve(self) -> SolvedDesigns:
        """Solve the designs, in finer and finer bases until all errors meet the target."""
        count, speeds = self.speeds.shape
        found, functions = self._refinement.solve(count, speeds, self._solve_batch)
        if not found:
            shape = (*self.speeds.shape, self.modes)
            found = [
                np.full(shape, np.nan, dtype=complex),
                np.full(shape, np.inf),
                np.full(self.speeds.shape, np.nan),
            ]
        eigenvalue, error, deflection = found
        error = np.where(np.isnan(eigenvalue), np.inf, error)
        return SolvedDesigns(eigenvalue / self.designs.time[:, None, None], error, deflection, functions)

    def _solve_batch(self, rows: np.ndarray, basis: Discretization) -> BasisAnswers:
        designs = self.designs
        family, weights = designs.family(basis), designs.weights(rows)
        stack, speeds = family.stack(weights), self.speeds[rows] * designs.time[rows, None]
        ratio = None if self.ratio is None else self.ratio[rows]
        coarse = coarser_stack(designs, basis, family, stack, weights)
        load = np.einsum("rt,tdn,rd->rn", weights, family.loads, designs.across[rows], optimize=True)
        found = solve_many(
            stack, coarse, speeds, self.modes, load, family.tips, ratio, designs.estimate(basis)
        )
        target = np.maximum(self._refinement.target_of(basis), 3 * found.rounding)
        met = np.all(found.error <= target, axis=(1, 2))
        deflection = found.static / designs.reference.beam.length
        return BasisAnswers((found.eigenvalue, found.error, deflection), met)

    def answers(self) -> DesignAnswers:
        """The answers of the designs, with what limits them."""
        found = self.solve()
        s = found.eigenvalue
        growing, oscillating, none = np.real(s) > 0, np.imag(s) != 0, np.isnan(s)
        words = [REFUSED, "flutter", "divergence", "stable", "neutral"]
        status = np.select([none, growing & oscillating, growing, oscillating, s == 0], words, "overdamped")
        frequency = np.where(np.isin(status, ("stable", "neutral")), np.imag(s) / (2 * np.pi), np.nan)
        method = f"Ritz, at most {found.functions} functions, batched"
        return DesignAnswers(frequency, found.error, status, (*self._cautions(found, status),), method)

    def _cautions(self, found: SolvedDesigns, status: np.ndarray) -> Iterator[Caution]:
        """Yield what `natural_modes` warns of."""
        unstable = np.isin(status, ("divergence", "flutter")).any(axis=2)
        yield from caution_where(unstable, "a", 0.0, ": the beam diverges; see status")
        strain = self.designs.strains(self.speeds)
        large = strain > LARGE_STRAIN
        if large.any():
            yield from caution_where(
                large, "b", strain, f": {next(warn_of_strain(float(np.nanmax(strain))))}"
            )
        bent = found.deflection > LARGE_DEFLECTION
        if bent.any():
            at = np.unravel_index(np.nanargmax(found.deflection), bent.shape)
            said = next(warn_of_static_deflection(found.deflection[at][None], 1.0, self.speeds[at][None]))
            yield from caution_where(bent, "c", found.deflection, f": {said}")
        yield from cautions_of_refused(status)
        yield from cautions_of_error(found.error, self.tolerance)


def cautions_of_refused(status: np.ndarray) -> Iterable[Caution]:
    """A caution of designs whose answers (R, S, k) rounding leaves unsolved, if there are any."""
    said = " there is no answer: rounding of the matrices leaves none"
    return caution_where((status == REFUSED).any(axis=2), "d", 0.0, said)


def cautions_of_error(error: np.ndarray, tolerance: float | None) -> Iterator[Caution]:
    """Yield a caution of errors (R, S, k) past a tolerance, or past what is promised without one."""
    worst, limit = error.max(axis=2), _LARGE_ERROR if tolerance is None else tolerance
    said = f" the estimated relative error is above {limit:g}: see error"
    if tolerance is not None and worst.max() > tolerance:
        said = f": {next(warn_of_missed_tolerance(float(worst.max()), tolerance))}"
    yield from caution_where(worst > limit, "e", worst, said)


def coarser_stack(
    designs: SimilarDesigns,
    basis: Discretization,
    family: PencilFamily,
    stack: PencilStack,
    weights: np.ndarray,
) -> PencilStack:
    """The matrices of designs of some weights in the coarser basis."""
    if family.coarse is not None:
        return stack.part(family.coarse)
    return designs.family(basis.coarser()).stack(weights)
