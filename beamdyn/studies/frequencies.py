"""Natural frequencies of designs that differ in numbers only, in one basis, by batched eigenproblems."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from beamdyn.common.pickling import FieldsOnly
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.ritz import Ritz
from beamdyn.modal.choice import DEFAULT_TARGET, DiscretizationChoice, list_models
from beamdyn.modal.many_designs import ManyModes, solve_many
from beamdyn.studies.similar import PencilFamily, SimilarDesigns

CHUNK = 1024  # designs of a task
_ENTRIES = 300_000  # of matrices of one size at once, which fit into the processor's cache


@dataclass(frozen=True)
class SolvedDesigns:
    """Frequencies of R designs at S speeds each.

    Parameters
    ----------
    squared : ndarray, shape (R, S, k)
        Squared angular frequencies [rad2/s2]; negative where the beam diverges, nan where there are none.
    error : ndarray, shape (R, S, k)
        Estimated relative error of the frequencies.
    deflection : ndarray, shape (R, S)
        Static tip deflection by rotation over the length, its size; nan from the critical speed on.
    functions : int
        Largest number of functions that was needed.
    """

    squared: np.ndarray
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
    """

    designs: SimilarDesigns
    speeds: np.ndarray
    modes: int
    discretization: DiscretizationChoice
    tolerance: float | None

    @property
    def target(self) -> float:
        """Relative error to be met."""
        return DEFAULT_TARGET if self.tolerance is None else self.tolerance

    @cached_property
    def _families(self) -> dict[Discretization, PencilFamily]:
        return {}

    def bases(self) -> Iterator[Discretization]:
        """Bases to try in turn."""
        reference, cheapest = self.designs.reference, self.tolerance is not None
        models = list_models(reference, self.discretization, self.modes, self.target, cheapest)
        return (model.discretization for model in models)

    @property
    def can_be_batched(self) -> bool:
        """Whether the functions are the same in all designs."""
        if self.discretization != "ritz" and not isinstance(self.discretization, Ritz):
            return False
        first = next(self.bases())
        return isinstance(first, Ritz) and first.basis != "moments"

    def split(self) -> list[SimilarFrequencies]:
        """The designs of each task: they follow from the request, not from the workers."""
        return [self._part(slice(start, start + CHUNK)) for start in range(0, self.designs.count, CHUNK)]

    def _part(self, rows: slice) -> SimilarFrequencies:
        part = replace(self, designs=self.designs.part(rows), speeds=self.speeds[rows])
        part.__dict__["_families"] = self._families  # common to all within a process
        return part

    def solve(self) -> SolvedDesigns:
        """Solve the designs, in finer and finer bases until all errors meet the target."""
        pending, shape = np.arange(self.designs.count), (*self.speeds.shape, self.modes)
        squared, error = np.full(shape, np.nan), np.full(shape, np.inf)
        deflection, functions = np.full(shape[:2], np.nan), 0
        for basis in self.bases():
            unmet = []
            for batch in self._batches(pending, basis):
                if (found := self._solve_batch(batch, basis)) is None:
                    continue  # rounding of so many functions: the last result is the best
                squared[batch], error[batch], functions = found.squared, found.error, _size(basis)
                across = self.designs.across[batch][:, None] / self.designs.reference.beam.length
                deflection[batch] = np.abs(found.static) * across
                unmet.append(batch[~found.meet(self.target)])
            if not (pending := np.concatenate([np.empty(0, dtype=int), *unmet])).size:
                break
        time = self.designs.time[:, None, None]
        return SolvedDesigns(squared / time**2, error, deflection, functions)

    def _batches(self, designs: np.ndarray, basis: Discretization) -> list[np.ndarray]:
        """Split designs so that the matrices of each part fit into the cache."""
        most = max(1, _ENTRIES // (_size(basis) ** 2 * self.speeds.shape[1]))
        return np.split(designs, range(most, len(designs), most))

    def _solve_batch(self, designs: np.ndarray, basis: Discretization) -> ManyModes | None:
        """Solve designs; None for one that rounding leaves without a solution."""
        if basis not in self._families:
            self._families[basis] = self.designs.family(basis)
        family, weights = self._families[basis], self.designs.weights(designs)
        speeds = self.speeds[designs] * self.designs.time[designs, None]
        load = weights @ family.load
        try:
            stack = family.stack(weights)
            return solve_many(stack, family.coarse, speeds, self.modes, load, family.tip)
        except np.linalg.LinAlgError:
            return None if len(designs) == 1 else self._solve_halves(designs, basis)

    def _solve_halves(self, designs: np.ndarray, basis: Discretization) -> ManyModes:
        """Solve two halves, of which one failed; designs without a solution get none."""
        halves = np.array_split(designs, 2)
        found = [self._solve_batch(half, basis) or _none(half, self.speeds, self.modes) for half in halves]
        joined = zip(*((f.squared, f.error, f.rounding, f.static) for f in found), strict=True)
        return ManyModes(*map(np.concatenate, joined))


def join(parts: list[SolvedDesigns]) -> SolvedDesigns:
    """Put the results of tasks together."""
    squared, error, deflection = (
        np.concatenate(values)
        for values in zip(*((p.squared, p.error, p.deflection) for p in parts), strict=True)
    )
    return SolvedDesigns(squared, error, deflection, max(part.functions for part in parts))


def _none(designs: np.ndarray, speeds: np.ndarray, modes: int) -> ManyModes:
    shape = (len(designs), speeds.shape[1], modes)
    nothing, unknown = np.full(shape, np.nan), np.full(shape, np.inf)
    return ManyModes(nothing, unknown, unknown, nothing[:, :, 0])


def _size(basis: Discretization) -> int:
    assert isinstance(basis, Ritz)
    return basis.functions
