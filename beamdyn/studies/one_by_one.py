"""Answers of designs one by one, by the analysis of a single scene."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.announced import unannounced
from beamdyn.modal.choice import DiscretizationChoice
from beamdyn.scene.scene import Scene
from beamdyn.spectrum.critical import CriticalPoint, critical_point
from beamdyn.spectrum.modes import natural_modes
from beamdyn.steady.response import steady_response
from beamdyn.studies.inputs import SPEED, scene_of

CHUNK = 16  # designs of a task
REFUSED = "refused"
_OF_RESPONSES = 1e-5  # tolerance of `steady_response` by default


class DesignAnswer(NamedTuple):
    """Answer of one design: values, errors and states (k,), and its warnings."""

    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: tuple[str, ...]


@dataclass(frozen=True)
class StudyQuestion:
    """What is asked of every design.

    Parameters
    ----------
    scene : Scene
        The scene, of which inputs are replaced.
    what : str
        Name of the answer in `ANALYSES`.
    speed : float
        Speed of designs without one of their own [rad/s].
    modes : int
        Number of modes.
    discretization, tolerance
        As for `natural_modes`.
    """

    scene: Scene
    what: str
    speed: float
    modes: int
    discretization: DiscretizationChoice
    tolerance: float | None

    @property
    def numbers(self) -> int:
        """How many numbers the answer of a design has."""
        return self.modes if self.what == "frequencies" else 1


def _frequencies(question: StudyQuestion, design: Mapping[str, float]) -> DesignAnswer:
    speed = design.get(SPEED, question.speed)
    scene = scene_of(question.scene, design)
    found = natural_modes(scene, speed, question.modes, question.discretization, question.tolerance)
    return DesignAnswer(found.frequency, found.error, found.status, found.warnings)


def _critical_speed(question: StudyQuestion, design: Mapping[str, float]) -> DesignAnswer:
    scene = scene_of(question.scene, design)
    found = critical_point(scene, question.discretization, question.tolerance)
    answer = (np.array([each]) for each in (found.speed, found.error, _state_of(found)))
    return DesignAnswer(*answer, warnings=found.warnings)


def _amplitude(question: StudyQuestion, design: Mapping[str, float]) -> DesignAnswer:
    scene, tolerance = scene_of(question.scene, design), question.tolerance or _OF_RESPONSES
    speeds = [design.get(SPEED, question.speed)]
    found = steady_response(scene, speeds, tolerance=tolerance, discretization=question.discretization)
    with np.errstate(divide="ignore", invalid="ignore"):  # the errors of a response are relative to its bound
        error = (found.error + found.mode_error) * found.bound / found.amplitude
    return DesignAnswer(found.amplitude, np.nan_to_num(error, nan=np.inf), found.status, found.warnings)


def _state_of(found: CriticalPoint) -> str:
    if np.isinf(found.error):
        return "not found"
    return "buckles" if np.isfinite(found.speed) else "does not buckle"


# Analyses by what is asked for, with the unit of the answer.
ANALYSES: dict[str, tuple[str, Callable[[StudyQuestion, Mapping[str, float]], DesignAnswer]]] = {
    "frequencies": ("Hz", _frequencies),
    "critical_speed": ("rad/s", _critical_speed),
    "amplitude": ("m", _amplitude),
}


def answer_designs(question: StudyQuestion, designs: Sequence[Mapping[str, float]]) -> list[DesignAnswer]:
    """Answer a question of designs one by one; one that is refused has the reason as its warning."""
    with unannounced():
        return [_answer(question, design) for design in designs]


def _answer(question: StudyQuestion, design: Mapping[str, float]) -> DesignAnswer:
    analysis: Any = ANALYSES[question.what][1]
    try:
        return analysis(question, design)
    except (ValueError, ArithmeticError) as error:
        nothing = np.full(question.numbers, np.nan)
        states = np.full(question.numbers, REFUSED)
        return DesignAnswer(nothing, np.full(question.numbers, np.inf), states, (str(error),))
