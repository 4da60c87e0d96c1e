"""Answers of designs one by one, by the analysis of a single scene, and what effects left out would change.

Of a response, all speeds of a design are solved at once.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.inputs.designs import rows_of
from beamdyn.common.results.announced import unannounced
from beamdyn.common.results.pickling import FieldsOnly
from beamdyn.common.results.statements import (
    NO_ANSWER,
    OUTSIDE,
    InputValue,
    Speeds,
    Statement,
    Words,
    joined,
    kind_of,
)
from beamdyn.modes.critical import CriticalPoint, critical_point
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.modes import Modes, natural_modes
from beamdyn.scene.numbers import SPEED, unit_of, with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import Crossings, label_crossing
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import SteadyResponse, steady_response
from beamdyn.studies.answers import REFUSED, Caution, DesignAnswers
from beamdyn.studies.batched import BUCKLES, DOES_NOT_BUCKLE, NOT_FOUND
from beamdyn.studies.crossings import NO_LINE, NO_RESONANCE, RESONATES, crossing_key, line_key, lines_of
from beamdyn.studies.questions import OF_RESPONSES, StudyQuestion
from beamdyn.transient.chunks import DONE
from beamdyn.transient.sweep import Sweep, sweep

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
        # How many answers are refused, and how many have warnings, with those of the first.
        refused = [int((answer.status[:, 0] == REFUSED).sum()) for answer in found]
        warned = [int(answer.is_warned.sum()) for answer in found]
        without = _caution("there is no answer", designs, refused, [answer.refusals for answer in found])
        limited = _caution("there are warnings", designs, warned, [answer.warnings for answer in found])
        return DesignAnswers(value, error, status, (*[*without, *limited],), SINGLE_CALLS)


def _caution(
    words: str,
    designs: Sequence[Mapping[str, float]],
    counts: Sequence[int],
    reasons: Sequence[tuple[str, ...]],
) -> Iterator[Caution]:
    """Yield of how many answers something holds, and why of the first."""
    if any(counts):
        first = next(i for i, count in enumerate(counts) if count)
        at = joined(", ", (InputValue(name, v, unit_of(name) or "") for name, v in designs[first].items()))
        said = f" {words}", *(("; at ", at) if at else ()), ": ", joined("; ", reasons[first])
        kinds = {*map(kind_of, reasons[first])} - {""}
        kind = OUTSIDE if OUTSIDE in kinds else min(kinds, default=NO_ANSWER)
        yield Caution(words, sum(counts), 0.0, Statement(*said, kind=kind))


def _answer(question: StudyQuestion, design: Mapping[str, float], speeds: np.ndarray) -> SpeedAnswer:
    """The answer of a design at its speeds; of all at once, or where these are refused of each."""
    analysis = _ANALYSES[question.what]
    try:
        asked = _Asked(question, with_numbers(question.scene, design), speeds)
        return analysis.read(asked, analysis.solve(asked))
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


# Analyses -----------------------------------------------------------------------------------------


class _Asked(NamedTuple):
    """A question of one scene at speeds (S,) [rad/s]; a single one that is not used, where it has none."""

    question: StudyQuestion
    scene: Scene
    speeds: np.ndarray


def _own_effects(_: _Asked, found: Any) -> LeftOutEffects:
    return found.left_out_effects


@dataclass(frozen=True)
class _SingleCall:
    """How a kind of question is answered: by an analysis, from whose result answer and model error are read.

    Parameters
    ----------
    solve : callable
        Makes the result of what is asked.
    read : callable
        The answer that a result has, at each of the speeds.
    effects : callable
        What the effects left out would change in the numbers of an answer.
    """

    solve: Callable[[_Asked], Any]
    read: Callable[[_Asked, Any], SpeedAnswer]
    effects: Callable[[_Asked, Any], LeftOutEffects] = _own_effects


def _solve_modes(asked: _Asked) -> list[Modes]:
    how = asked.question.modes, asked.question.discretization, asked.question.tolerance
    return [natural_modes(asked.scene, speed, *how) for speed in asked.speeds.tolist()]


def _read_modes(_: _Asked, found: list[Modes]) -> SpeedAnswer:
    return _together(
        [SpeedAnswer(m.frequency[None], m.error[None], m.status[None], m.warnings) for m in found]
    )


def _solve_critical_point(asked: _Asked) -> CriticalPoint:
    return critical_point(asked.scene, asked.question.discretization, asked.question.tolerance)


def _read_critical_point(_: _Asked, found: CriticalPoint) -> SpeedAnswer:
    state = BUCKLES if np.isfinite(found.speed) else DOES_NOT_BUCKLE
    state = NOT_FOUND if np.isinf(found.error) else state
    answer = (np.array([[each]]) for each in (found.speed, found.error, state))
    return SpeedAnswer(*answer, warnings=found.warnings)


def _solve_crossings(asked: _Asked) -> Crossings:
    question = asked.question
    return resonance_speeds(asked.scene, question.speed, question.modes, 1, question.discretization)


def _read_crossings(asked: _Asked, found: Crossings) -> SpeedAnswer:
    """The lowest crossing of each mode with each line."""
    question, lowest = asked.question, dict[Any, Any]()
    for crossing in found:  # they ascend in speed
        lowest.setdefault(crossing_key(crossing), crossing)
    there = {line_key(*each) for each in lines_of(asked.scene, question.speed)}
    shape = 1, question.numbers
    value, error = np.full(shape, np.nan), np.zeros(shape)
    status = np.full(shape, max(RESONATES, NO_RESONANCE, NO_LINE, key=len))
    for i, resonance in enumerate(question.resonances):
        crossing = lowest.pop(resonance.key, None)
        status[0, i] = NO_RESONANCE if resonance.key[:2] in there else NO_LINE
        if crossing is not None:
            value[0, i], error[0, i], status[0, i] = crossing.speed, crossing.error, RESONATES
    more = [
        Words(
            "there is also one at ",
            Speeds(c.speed),
            f": {label_crossing(c.line, c.kind, c.mode, c.second_mode)}",
        )
        for c in lowest.values()
    ]
    return SpeedAnswer(value, error, status, (*found.warnings, *more))


def _effects_of_crossings(asked: _Asked, found: Crossings) -> LeftOutEffects:
    """Changes of the lowest crossing of each mode with each line; nan where there is none."""
    keys = [crossing_key(each) for each in found]
    places = [keys.index(each.key) if each.key in keys else -1 for each in asked.question.resonances]
    effects = found.left_out_effects
    changes = {name: np.append(change, np.nan)[places] for name, change in effects.changes.items()}
    return replace(effects, changes=changes, shape=(len(places),))


def _solve_response(asked: _Asked) -> SteadyResponse:
    return steady_response(asked.scene, np.unique(asked.speeds), **_options_of_responses(asked))


def _solve_sweep(asked: _Asked) -> Sweep:
    return sweep(asked.scene, np.unique(asked.speeds), asked.question.window, **_options_of_responses(asked))


def _options_of_responses(asked: _Asked) -> dict[str, Any]:
    question = asked.question
    return {"tolerance": question.tolerance or OF_RESPONSES, "discretization": question.discretization}


def _read_amplitudes(asked: _Asked, found: SteadyResponse) -> SpeedAnswer:
    error = (found.error + found.mode_error) * found.bound  # both are relative to the bound
    warned = found.is_warned if found.warnings else None
    return _read_responses(asked, found, (found.amplitude, error, np.asarray(found.status)), warned)


def _read_peaks(asked: _Asked, found: Sweep) -> SpeedAnswer:
    error = found.time_error + found.mode_error * found.largest
    failed = [status for status in found.status if status != DONE]
    status = np.where(np.isin(found.status, failed), "failed", DONE)
    warned = found.is_warned(asked.question.tolerance or OF_RESPONSES) if found.warnings else None
    return _read_responses(asked, found, (found.peaks, error, status), warned, tuple(dict.fromkeys(failed)))


def _read_responses(
    asked: _Asked,
    found: Any,
    answer: tuple[np.ndarray, np.ndarray, np.ndarray],
    warned: np.ndarray | None,
    failed: tuple[str, ...] = (),
) -> SpeedAnswer:
    """Values, relative errors and states at each speed given, of those at all speeds, each once."""
    order = np.unique(asked.speeds, return_inverse=True)[1]
    value, error, status = answer
    with np.errstate(divide="ignore", invalid="ignore"):
        error = error / value
    columns = (each[order, None] for each in (value, np.where(np.isnan(error), np.inf, error), status))
    where = None if warned is None else warned[order]
    return SpeedAnswer(*columns, warnings=(*found.warnings, *failed), warned=where)


_ANALYSES: dict[str, _SingleCall] = {
    "frequencies": _SingleCall(_solve_modes, _read_modes, lambda _, found: found[0].left_out_effects),
    "critical_speed": _SingleCall(
        _solve_critical_point, _read_critical_point, lambda _, found: found.left_out_effects.at(np.newaxis)
    ),
    "crossings": _SingleCall(_solve_crossings, _read_crossings, _effects_of_crossings),
    "amplitude": _SingleCall(_solve_response, _read_amplitudes),
    "peak": _SingleCall(_solve_sweep, _read_peaks),
}


# Effects left out ---------------------------------------------------------------------------------


def left_out_of_design(
    question: StudyQuestion, scene: Scene, design: Mapping[str, float]
) -> LeftOutEffects | None:
    """Find how much effects left out would change the answer of a design.

    Parameters
    ----------
    question : StudyQuestion
        What is asked.
    scene : Scene
        The scene of the design.
    design : mapping of str to float
        Its inputs.

    Returns
    -------
    LeftOutEffects or None
        Relative changes (m,) of its m numbers; None if it has no answer.
    """
    asked = _Asked(question, scene, np.array([design.get(SPEED, question.speed)]))
    analysis = _ANALYSES[question.what]
    try:
        with unannounced():  # the study has warned
            return analysis.effects(asked, analysis.solve(asked))
    except _FAILURES:
        return None


def join_effects(each: Sequence[LeftOutEffects | None], numbers: int) -> LeftOutEffects:
    """The effects of p designs with m numbers each as one, of shape (p, m); nan where one has none."""
    known = [effects for effects in each if effects is not None]
    names = dict.fromkeys(name for effects in known for name in effects.changes)
    nothing = np.full(numbers, np.nan)

    def of(effects: LeftOutEffects | None, name: str) -> np.ndarray:
        if effects is None:
            return nothing
        return np.broadcast_to(effects.changes.get(name, 0.0), (numbers,))

    return LeftOutEffects(
        changes={name: np.array([of(effects, name) for effects in each]) for name in names},
        not_known={name: why for effects in reversed(known) for name, why in effects.not_known.items()},
        assumed={name: why for effects in known for name, why in effects.assumed.items()},
        not_modelled=known[0].not_modelled if known else (),
        reasons={name: why for effects in known for name, why in effects.reasons.items()},
        shape=(len(each), numbers),
    )
