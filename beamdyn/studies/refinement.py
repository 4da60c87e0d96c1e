"""Similar designs solved in finer and finer bases: each in the smallest that a single call would choose."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass

import numpy as np

from beamdyn.accuracy.refinement import refine
from beamdyn.equations.discretization import Discretization
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.modal.discretization_choice import (
    DEFAULT_TARGET,
    DiscretizationChoice,
    list_models,
    within_reach,
)
from beamdyn.scene.scene import Scene

_WITH_TIP_BODY = 1e-7  # target with a body at the tip: looser bases miss modes in layers
_ENTRIES = 300_000  # of matrices of one size at once, which fit into the processor's cache


@dataclass(frozen=True)
class BasisAnswers:
    """Answers of R designs in a basis.

    Parameters
    ----------
    arrays : tuple of ndarray, shape (R, ...)
        The answers.
    met : ndarray of bool, shape (R,)
        Whether their errors meet the target, or rounding.
    """

    arrays: tuple[np.ndarray, ...]
    met: np.ndarray


Solve = Callable[[np.ndarray, Discretization], BasisAnswers]  # of designs (R,) in a basis


@dataclass(frozen=True)
class Refinement:
    """The bases in which designs are solved in turn.

    Parameters
    ----------
    reference : Scene
        Their reference.
    modes : int
        Number of modes.
    discretization : {"ritz"} or Ritz
        As for `natural_modes`.
    tolerance : float, optional
        As for `natural_modes`.
    """

    reference: Scene
    modes: int
    discretization: DiscretizationChoice
    tolerance: float | None

    def bases(self) -> Iterator[Discretization]:
        """Bases to try in turn."""
        cheapest = self.tolerance is not None and self.reference.beam.tip is None
        models = list_models(self.reference, self.discretization, self.modes, self._target, cheapest)
        return (model.discretization for model in models)

    @property
    def _target(self) -> float:
        """Relative error to aim at; with a body at the tip small enough to resolve a layer there."""
        target = DEFAULT_TARGET if self.tolerance is None else self.tolerance
        return target if self.reference.beam.tip is None else min(target, _WITH_TIP_BODY)

    def target_of(self, basis: Discretization) -> float:
        """Relative error to be met in a basis."""
        return within_reach(basis, self._target)

    @property
    def can_be_batched(self) -> bool:
        """Whether the functions are the same in all designs."""
        return self.discretization == "ritz" or isinstance(self.discretization, Ritz)

    def solve(self, count: int, speeds: int, solve: Solve) -> tuple[list[np.ndarray], int]:
        """Solve designs at so many speeds each, in finer and finer bases until all meet the target.

        Returns
        -------
        answers : list of ndarray, shape (N, ...)
            Of each design those of the last basis in which it has any; nan where it has none.
        functions : int
            Largest number of functions that was needed.
        """
        bases, answers, functions = self.bases(), list[np.ndarray](), 0

        def solve_finer(pending: np.ndarray) -> np.ndarray | None:
            """Solve designs in the next basis: those whose errors do not meet the target, None at the end."""
            nonlocal answers, functions
            if (basis := next(bases, None)) is None:
                return None
            unmet = [np.empty(0, dtype=int)]
            most = max(1, _ENTRIES // (_size(basis) ** 2 * speeds))
            for batch in np.split(pending, range(most, len(pending), most)):
                for part, found in _solve_or_halve(solve, batch, basis):
                    answers = answers or [_nothing(count, array) for array in found.arrays]
                    for kept, array in zip(answers, found.arrays, strict=True):
                        kept[part] = array
                    functions = max(functions, _size(basis))
                    unmet.append(part[~found.met])
            return np.concatenate(unmet)

        refine(np.arange(count), solve_finer, lambda pending: not pending.size)
        return answers, functions


def _solve_or_halve(
    solve: Solve, batch: np.ndarray, basis: Discretization
) -> Iterator[tuple[np.ndarray, BasisAnswers]]:
    """Yield solved designs; those that rounding of so many functions leaves unsolved are left out."""
    try:
        yield batch, solve(batch, basis)
    except np.linalg.LinAlgError:
        if len(batch) > 1:
            for half in np.array_split(batch, 2):
                yield from _solve_or_halve(solve, half, basis)


def _nothing(count: int, like: np.ndarray) -> np.ndarray:
    return np.full((count, *like.shape[1:]), np.nan, dtype=like.dtype)


def _size(basis: Discretization) -> int:
    assert isinstance(basis, Ritz)
    return basis.functions
