"""Answers of designs one by one, by the analysis of a single scene; of a response, for all speeds at once."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.announced import unannounced
from beamdyn.common.designs import rows_of
from beamdyn.common.pickling import FieldsOnly
from beamdyn.scene.numbers import unit_of, with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.spectrum.critical import CriticalPoint, critical_point
from beamdyn.spectrum.modes import natural_modes
from beamdyn.steady.crossings import label_crossing
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import steady_response
from beamdyn.studies.answers import REFUSED, Caution, DesignAnswers
from beamdyn.studies.critical_speeds import BUCKLES, DOES_NOT_BUCKLE, NOT_FOUND
from beamdyn.studies.crossings import NO_LINE, NO_RESONANCE, RESONATES, crossing_key, line_key, lines_of
from beamdyn.studies.questions import OF_RESPONSES, StudyQuestion
from beamdyn.transient.chunks import DONE
from beamdyn.transient.sweep import sweep

SINGLE_CALLS = "single calls"
_FAILURES = (ValueError, ArithmeticError)


class SpeedAnswer(NamedTuple):
    """Answer of one design at S speeds: values, errors and states (S, k), and its warnings.

    `warned` says at which speeds these hold; at all if it is None.  `refusals` say why there is no answer.
    """

    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: tuple[str, ...]
    warned: np.ndarray | None = None
    refusals: tuple[str, ...] = ()

    @property
    def is_warned(self) -> np.ndarray:
        """Whether a warning holds at each speed, (S,)."""
        everywhere = np.full(len(self.value), bool(self.warnings))
        return everywhere if self.warned is None else self.warned


@dataclass(frozen=True)
class SingleDesigns(FieldsOnly):
    """Designs that are answered one by one.

    Parameters
    ----------
    question : StudyQuestion
        What is asked of them.
    columns : mapping of str to ndarray, shape (N,)
        Their inputs, but for the speed.
    speeds : ndarray, shape (N, S)
        Speeds of each [rad/s]; (N, 1), and not used, where the answer belongs to none.
    """

    question: StudyQuestion
    columns: Mapping[str, np.ndarray]
    speeds: np.ndarray

    def answers(self) -> DesignAnswers:
        """The answers of the designs; one that is refused has the reason as a caution."""
        designs = rows_of(dict(self.columns)) if self.columns else [{}]
        with unannounced():
            found = [_answer(self.question, *each) for each in zip(designs, self.speeds, strict=True)]
        value, error, status = (np.array([answer[i] for answer in found]) for i in range(3))
        return DesignAnswers(value, error, status, (*self._cautions(designs, found),), SINGLE_CALLS)

    def _cautions(
        self, designs: Sequence[Mapping[str, float]], found: Sequence[SpeedAnswer]
    ) -> list[Caution]:
        """How many answers are refused, and how many have warnings, with those of the first."""
        refused = [int((answer.status[:, 0] == REFUSED).sum()) for answer in found]
        warned = [int(answer.is_warned.sum()) for answer in found]
        without = _caution("there is no answer", designs, refused, [answer.refusals for answer in found])
        limited = _caution("there are warnings", designs, warned, [answer.warnings for answer in found])
        return [*without, *limited]


def _caution(
    words: str,
    designs: Sequence[Mapping[str, float]],
    counts: Sequence[int],
    reasons: Sequence[tuple[str, ...]],
) -> Iterator[Caution]:
    """Yield of how many answers something holds, and why of the first."""
    if any(counts):
        first = next(i for i, count in enumerate(counts) if count)
        at = ", ".join(f"{name} = {v:.6g} {unit_of(name)}".rstrip() for name, v in designs[first].items())
        yield Caution(words, sum(counts), 0.0, f" {words}{at and '; at ' + at}: {'; '.join(reasons[first])}")


def _answer(question: StudyQuestion, design: Mapping[str, float], speeds: np.ndarray) -> SpeedAnswer:
    """The answer of a design at its speeds; of all at once, or where these are refused of each."""
    analysis = _ANALYSES[question.what]
    try:
        return analysis(question, with_numbers(question.scene, design), speeds)
    except _FAILURES as error:
        if len(speeds) == 1:
            shape = 1, question.numbers
            states = np.full(shape, REFUSED)
            nothing = np.full(shape, np.nan), np.full(shape, np.inf), states
            return SpeedAnswer(*nothing, warnings=(), refusals=(str(error),))
    each = [_answer(question, design, speeds[[i]]) for i in range(len(speeds))]
    return _together(each)


def _together(each: Sequence[SpeedAnswer]) -> SpeedAnswer:
    return SpeedAnswer(
        value=np.concatenate([answer.value for answer in each]),
        error=np.concatenate([answer.error for answer in each]),
        status=np.concatenate([answer.status for answer in each]),
        warnings=tuple(dict.fromkeys(said for answer in each for said in answer.warnings)),
        warned=np.concatenate([answer.is_warned for answer in each]),
        refusals=tuple(dict.fromkeys(said for answer in each for said in answer.refusals)),
    )


def _frequencies(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    def at(speed: float) -> SpeedAnswer:
        found = natural_modes(scene, speed, question.modes, question.discretization, question.tolerance)
        return SpeedAnswer(found.frequency[None], found.error[None], found.status[None], found.warnings)

    return _together([at(speed) for speed in speeds.tolist()])


def _critical_speed(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    found = critical_point(scene, question.discretization, question.tolerance)
    answer = (np.array([[each]]) for each in (found.speed, found.error, _state_of(found)))
    return SpeedAnswer(*answer, warnings=found.warnings)


def _state_of(found: CriticalPoint) -> str:
    if np.isinf(found.error):
        return NOT_FOUND
    return BUCKLES if np.isfinite(found.speed) else DOES_NOT_BUCKLE


def _crossings(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    """The lowest crossing of each mode with each line."""
    found = resonance_speeds(scene, question.speed, question.modes, discretization=question.discretization)
    lowest: dict[Any, Any] = {}
    for crossing in found:  # they ascend in speed
        lowest.setdefault(crossing_key(crossing), crossing)
    there = {line_key(*each) for each in lines_of(scene, question.speed)}
    shape = 1, question.numbers
    value, error = np.full(shape, np.nan), np.zeros(shape)
    status = np.full(shape, max(RESONATES, NO_RESONANCE, NO_LINE, key=len))
    for i, resonance in enumerate(question.resonances):
        crossing = lowest.pop(resonance.key, None)
        status[0, i] = NO_RESONANCE if resonance.key[:2] in there else NO_LINE
        if crossing is not None:
            value[0, i], error[0, i], status[0, i] = crossing.speed, crossing.error, RESONATES
    more = [
        f"there is also one at {c.speed:.6g} rad/s: {label_crossing(c.line, c.kind, c.mode, c.second_mode)}"
        for c in lowest.values()
    ]
    return SpeedAnswer(value, error, status, (*found.warnings, *more))


def _amplitude(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    tolerance, (ascending, order) = question.tolerance or OF_RESPONSES, _ascending(speeds)
    found = steady_response(scene, ascending, tolerance=tolerance, discretization=question.discretization)
    with np.errstate(divide="ignore", invalid="ignore"):  # the errors of a response are relative to its bound
        error = (found.error + found.mode_error) * found.bound / found.amplitude
    error = np.where(np.isnan(error), np.inf, error)
    columns = (values[order, None] for values in (found.amplitude, error, np.asarray(found.status)))
    warned = found.is_warned[order] if found.warnings else None
    return SpeedAnswer(*columns, warnings=found.warnings, warned=warned)


def _peak(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    tolerance, (ascending, order) = question.tolerance or OF_RESPONSES, _ascending(speeds)
    options: dict[str, Any] = {"tolerance": tolerance, "discretization": question.discretization}
    found = sweep(scene, ascending, question.window, **options)
    with np.errstate(divide="ignore", invalid="ignore"):
        error = (found.time_error + found.mode_error * found.largest) / found.peaks
    error = np.where(np.isnan(error), np.inf, error)
    failed = [status for status in found.status if status != DONE]
    status = np.where(np.isin(found.status, failed), "failed", DONE)
    columns = (values[order, None] for values in (found.peaks, error, status))
    warned = found.is_warned(tolerance)[order] if found.warnings else None
    return SpeedAnswer(*columns, warnings=(*found.warnings, *dict.fromkeys(failed)), warned=warned)


def _ascending(speeds: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """The speeds in ascending order, each once, and the place of each of those given."""
    ascending, order = np.unique(speeds, return_inverse=True)
    return ascending, order


_ANALYSES: dict[str, Callable[[StudyQuestion, Scene, np.ndarray], SpeedAnswer]] = {
    "frequencies": _frequencies,
    "critical_speed": _critical_speed,
    "crossings": _crossings,
    "amplitude": _amplitude,
    "peak": _peak,
}
