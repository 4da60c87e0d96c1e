"""Derivatives of the matrices of a model, and of its coarser one, by the numbers of its scene."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from beamdyn.common.checks import InvalidValue
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.equations.equations_of_motion import SteadyPencil
from beamdyn.modal.model import Model
from beamdyn.sensitivities.interpolation import evaluate_nearby
from beamdyn.sensitivities.perturbation import PencilChange
from beamdyn.sensitivities.scene_numbers import SceneNumber
from beamdyn.studies.inputs import scene_of

_EPSILON = 16 * np.finfo(float).eps  # rounding error of an integral, relative to the largest part


@dataclass(frozen=True)
class Changes:
    """Derivatives of the matrices by each of n numbers.

    Parameters
    ----------
    of : tuple of list of PencilChange
        Those of the model, and those of the coarser one.
    rounding : ndarray, shape (n,)
        Their rounding error, relative to the matrices [1 / unit of the number].
    refusals : tuple of str
        Which numbers cannot change alone, and why: their derivatives are nan.
    """

    of: tuple[list[PencilChange], list[PencilChange]]
    rounding: np.ndarray
    refusals: tuple[str, ...]


@one_blas_thread()  # the matrices are small: more threads only wait for each other
def changes_of(model: Model, numbers: Sequence[SceneNumber]) -> Changes:
    """Evaluate the equations of a model around each number."""
    fine, coarse, rounding, refusals = [], [], [], []
    for number in numbers:
        try:
            both, weights = evaluate_nearby(
                number, lambda value, name=number.name: _pencils(model, name, value)
            )
        except InvalidValue as error:
            of_both = [_unknown(len(pencil.M)) for pencil in steady_pencils(model, model.equations.coarse)]
            refusals.append(f"{number.name} cannot change alone, so that it has no derivative: {error}")
            weights = np.zeros(1)
        else:
            of_both = [PencilChange.of([pair[k] for pair in both], weights) for k in (0, 1)]
        fine.append(of_both[0])
        coarse.append(of_both[1])
        rounding.append(_EPSILON * np.abs(weights).sum())
    return Changes((fine, coarse), np.array(rounding), tuple(refusals))


def _pencils(model: Model, name: str, value: float) -> tuple[SteadyPencil, SteadyPencil]:
    """The equations of both models with another value of a number."""
    scene = scene_of(model.scene, {name: value})
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
