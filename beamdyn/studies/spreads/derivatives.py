"""Derivatives of the answers of a scene that are known from its equations."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer
from beamdyn.common.results.announced import unannounced
from beamdyn.common.spreading.slopes import KnownDerivatives
from beamdyn.common.spreading.tolerances import SpreadInput
from beamdyn.scene.numbers import SPEED
from beamdyn.studies.questions import StudyQuestion
from beamdyn.studies.sensitivities.result import Sensitivities
from beamdyn.studies.sensitivities.scene_numbers import numbers_of
from beamdyn.studies.sensitivities.sensitivities import (
    critical_speed_sensitivities,
    crossing_sensitivities,
    frequency_sensitivities,
)

_NONLINEAR = "physics.large_deflection"  # the argument that is refused as it has no derivatives


def known_derivatives(question: StudyQuestion, inputs: Sequence[SpreadInput]) -> KnownDerivatives:
    """Derivatives by inputs, as far as equations give them.

    Parameters
    ----------
    question : StudyQuestion
        What is asked; crossings with their resonances.
    inputs : sequence of SpreadInput
        The inputs.
    """
    solve = {
        "frequencies": _of_frequencies,
        "critical_speed": _of_critical_speed,
        "crossings": _of_crossings,
    }.get(question.what)
    known = {number.name for number in numbers_of(question.scene)} | {SPEED}
    rows = {each.name: row for row, each in enumerate(inputs) if each.name in known}
    if solve is None or not rows:
        return KnownDerivatives()
    try:
        with unannounced():
            found, columns = solve(question, [*rows])
    except ValueError as error:
        return KnownDerivatives(warnings=_said(error))
    value, error = (_columns(each, columns) for each in (found.derivative, found.error))
    return KnownDerivatives({rows[each.name]: (value[i], error[i]) for i, each in enumerate(found.inputs)})


def _said(refusal: ValueError) -> tuple[str, ...]:
    """Why all slopes are those of designs; nothing where the answer has no derivatives by its nature.

    These are a beam that does not buckle, and large deflection.
    """
    if isinstance(refusal, NoModelAnswer) or (
        isinstance(refusal, InvalidValue) and refusal.field == _NONLINEAR
    ):
        return ()
    return (f"first order: its slopes are those of designs, as derivatives are refused: {refusal}",)


def _columns(values: np.ndarray, columns: Sequence[int | None]) -> np.ndarray:
    """Those of the answers, in their order; nan for those that are missing."""
    none = np.full(len(values), np.nan)
    return np.stack([none if column is None else values[:, column] for column in columns], axis=1)


def _of_frequencies(question: StudyQuestion, names: list[str]) -> tuple[Sensitivities, list[int | None]]:
    options = question.discretization, question.tolerance
    found = frequency_sensitivities(question.scene, question.speed, question.modes, names, *options)
    return found, [*range(question.modes)]


def _of_critical_speed(question: StudyQuestion, names: list[str]) -> tuple[Sensitivities, list[int | None]]:
    options = question.discretization, question.tolerance
    return critical_speed_sensitivities(question.scene, names, *options), [0]


def _of_crossings(question: StudyQuestion, names: list[str]) -> tuple[Sensitivities, list[int | None]]:
    """Those of the lowest crossing of each mode with each line."""
    options = {"inputs": names, "discretization": question.discretization}
    found = crossing_sensitivities(question.scene, question.speed, question.modes, **options)
    wanted = [each.label for each in question.resonances]
    return found, [found.answers.index(name) if name in found.answers else None for name in wanted]
