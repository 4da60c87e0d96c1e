"""Derivatives of the matrices of a model, and of its coarser one, by the numbers of its scene."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from typing import TypeAlias

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.modes.modal.model import Model
from beamdyn.scene.numbers import with_numbers
from beamdyn.studies.sensitivities.interpolation import Nearby, evaluate_nearby
from beamdyn.studies.sensitivities.perturbation import PencilChange
from beamdyn.studies.sensitivities.scene_numbers import SceneNumber

_EPSILON = 32 * np.finfo(float).eps  # rounding error of an integral, relative to the largest part
_RESOLVED = 1e-13  # of the matrices, within an interval: what the last term of a polynomial may be
_ROUNDED = 1e-10  # what rounding alone may be, as of damping by modes
_CONVERGES = 0.1  # most that a narrower interval leaves of it, where it is no rounding
_Pencils: TypeAlias = tuple[SteadyPencil, SteadyPencil]


@dataclass(frozen=True)
class Changes:
    """Derivatives of the matrices by each of n numbers.

    Parameters
    ----------
    of : tuple of list of PencilChange
        Those of the model, and those of the coarser one.
    missed : list of PencilChange
        What those of the model may lack, as their dependence on a number is not resolved.
    rounding : ndarray, shape (n,)
        Their rounding error, relative to the matrices [1 / unit of the number].
    refusals : tuple of str
        Which numbers cannot change alone, and why: their derivatives are nan.
    """

    of: tuple[list[PencilChange], list[PencilChange]]
    missed: list[PencilChange]
    rounding: np.ndarray
    refusals: tuple[str, ...]


@one_blas_thread()  # the matrices are small: more threads only wait for each other
def changes_of(model: Model, numbers: Sequence[SceneNumber]) -> Changes:
    """Evaluate the equations of a model around each number."""
    fine, coarse, missed, rounding, refusals = [], [], [], [], []
    for number in numbers:
        try:
            nearby = _resolved(number, lambda value, name=number.name: _pencils(model, name, value))
        except InvalidValue as error:
            of_fine, of_coarse = (
                _unknown(len(pencil.M)) for pencil in steady_pencils(model, model.equations.coarse)
            )
            refusals.append(f"{number.name} cannot change alone, so that it has no derivative: {error}")
            lacks, weights = of_fine, np.zeros(1)
        else:
            weights = nearby.weights
            of_fine, of_coarse = (
                PencilChange.of([pair[k] for pair in nearby.values], weights) for k in (0, 1)
            )
            lacks = _last(nearby)
        fine.append(of_fine)
        coarse.append(of_coarse)
        missed.append(lacks)
        rounding.append(_EPSILON * np.abs(weights).sum())
    return Changes((fine, coarse), missed, np.array(rounding), tuple(refusals))


def _resolved(number: SceneNumber, evaluate: Callable[[float], _Pencils]) -> Nearby[_Pencils]:
    """Evaluate the equations within the widest interval that resolves them, or else leaves rounding alone."""
    before, best = np.inf, None
    for nearby in evaluate_nearby(number, evaluate):
        share = _missed_share(nearby)
        if best is not None and _CONVERGES * before < share < _ROUNDED:
            return best
        before, best = share, nearby
        if share <= _RESOLVED:
            break
    assert best is not None
    return best


def _missed_share(nearby: Nearby[_Pencils]) -> float:
    """The last term of a model's matrices within an interval, relative to each of them: the largest."""
    last, whole = _last(nearby), nearby.values[0][0]
    pairs = ((getattr(last, f.name), getattr(whole, f.name)) for f in fields(last))
    return max(_largest(part) * nearby.width / (_largest(matrix) or 1.0) for part, matrix in pairs)


def _last(nearby: Nearby[_Pencils]) -> PencilChange:
    """The last term of the derivatives of a model's matrices."""
    return PencilChange.of([fine for fine, _ in nearby.values], nearby.last)


def _largest(matrix: np.ndarray) -> float:
    return float(np.abs(matrix).max(initial=0.0))


def _pencils(model: Model, name: str, value: float) -> _Pencils:
    """The equations of both models with another value of a number."""
    scene = with_numbers(model.scene, {name: value})
    if len(scene.beam.breakpoints) != len(model.scene.beam.breakpoints):
        bound = "a point mass or spring at the tip, or where a section jumps, would leave its place"
        raise InvalidValue(name, value, bound, "move both")
    return steady_pencils(Model(scene, model.discretization), model.equations.coarse)


def steady_pencils(model: Model, coarse: np.ndarray | None) -> tuple[SteadyPencil, SteadyPencil]:
    """The equations of a model at steady speeds, and those of its coarser one.

    The coarser one's are over the functions at the indices `coarse`, where it has no others.
    """
    fine = model.equations.steady()
    return fine, model.coarser.equations.steady() if coarse is None else fine.part(coarse)


def _unknown(size: int) -> PencilChange:
    return PencilChange(*(np.full((size, size), np.nan) for _ in range(5)))
