"""Results of designs that are analysed one at a time, and the changes by neglected effects.

For steady responses, all speeds of a design are solved at once.

In shapes of arrays, S counts speeds of a design, k results at each, and N designs.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.inputs.described import rows_of
from beamdyn.common.results import statements
from beamdyn.common.results.snapshots import FieldsOnly
from beamdyn.loads.steady_loads import steady_loads
from beamdyn.modes.critical import critical_point
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects
from beamdyn.modes.modes import natural_modes
from beamdyn.scene.numbers import SPEED, unit_of, with_numbers
from beamdyn.scene.scene import Scene
from beamdyn.steady.crossings import label_crossing
from beamdyn.steady.harvest import harvest
from beamdyn.steady.resonance import resonance_speeds
from beamdyn.steady.response import steady_response
from beamdyn.studies.answers import REFUSED, Caution, DesignAnswers
from beamdyn.studies.batched import BUCKLES, DOES_NOT_BUCKLE, NOT_FOUND
from beamdyn.studies.questions import OF_RESPONSES, StudyQuestion
from beamdyn.studies.resonance_speeds import (
    NO_LINE,
    NO_RESONANCE,
    RESONATES,
    crossing_key,
    line_key,
    lines_of,
)
from beamdyn.transient.chunks import DONE
from beamdyn.transient.sweep import sweep

_FAILURES = (ValueError, ArithmeticError)


class SpeedAnswer(NamedTuple):
    """Result of one design at S speeds: values, errors and statuses (S, results), and warnings.

    `warned` marks the speeds of the warnings; None means all speeds.  `refusals` state why there is no
    result; `effects` returns the changes of the result at the first speed by neglected effects.
    """

    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: tuple[str, ...]
    warned: np.ndarray | None = None
    refusals: tuple[str, ...] = ()
    effects: Callable[[], LeftOutEffects | None] = lambda: None

    @property
    def is_warned(self) -> np.ndarray:
        """Whether a warning applies at each speed."""
        return np.full(len(self.value), bool(self.warnings)) if self.warned is None else self.warned


@dataclass(frozen=True)
class SingleDesigns(FieldsOnly):
    """Designs that are analysed one at a time.

    Parameters
    ----------
    question : StudyQuestion
        Question that the study asks of each design.
    columns : mapping of str to ndarray, shape (N,)
        Inputs of the designs, except the speed.
    speeds : ndarray, shape (N, speeds)
        Speeds of each design [rad/s]; (N, 1), and not used, if the result does not depend on a speed.
    """

    question: StudyQuestion
    columns: Mapping[str, np.ndarray]
    speeds: np.ndarray

    def answers(self) -> DesignAnswers:
        """Compute the results of the designs; if a design is refused, a warning gives the reason."""
        designs = rows_of(dict(self.columns)) if self.columns else [{}]
        with statements.unannounced():
            found = [_answer(self.question, *each) for each in zip(designs, self.speeds, strict=True)]
        value, error, status = (np.array([answer[i] for answer in found]) for i in range(3))
        # There are at most two warnings: of refused results, and of results with warnings.  Each of the two
        # has the number of these results, and the reasons of the first one only.
        refused = [int((answer.status[:, 0] == REFUSED).sum()) for answer in found]
        warned = [int(answer.is_warned.sum()) for answer in found]
        without = _caution("there is no answer", designs, refused, [answer.refusals for answer in found])
        limited = _caution("there are warnings", designs, warned, [answer.warnings for answer in found])
        return DesignAnswers(value, error, status, (*without, *limited), "single calls")


def _caution(
    words: str,
    designs: Sequence[Mapping[str, float]],
    counts: Sequence[int],
    reasons: Sequence[tuple[str, ...]],
) -> Iterator[Caution]:
    """Yield a warning with the number of results concerned, the first such design, and the reason.

    Each design has a number of such results in `counts`; there is no warning if all these numbers are 0.
    """
    if any(counts):
        first = next(i for i, count in enumerate(counts) if count)
        at = statements.joined(
            ", ", (statements.InputValue(name, v, unit_of(name) or "") for name, v in designs[first].items())
        )
        said = f" {words}", *(("; at ", at) if at else ()), ": ", statements.joined("; ", reasons[first])
        kinds = {*map(statements.kind_of, reasons[first])} - {""}
        kind = statements.OUTSIDE if statements.OUTSIDE in kinds else min(kinds, default=statements.NO_ANSWER)
        yield Caution(words, sum(counts), 0.0, statements.Statement(*said, kind=kind))


def _answer(question: StudyQuestion, design: Mapping[str, float], speeds: np.ndarray) -> SpeedAnswer:
    """Compute the result of one design at all speeds together; if that fails, speed by speed."""
    try:
        return _ANALYSES[question.what](question, with_numbers(question.scene, design), speeds)
    except _FAILURES as error:
        if len(speeds) == 1:
            shape = 1, question.numbers
            nothing = np.full(shape, np.nan), np.full(shape, np.inf), np.full(shape, REFUSED)
            return SpeedAnswer(*nothing, warnings=(), refusals=(str(error),))
    return _together([_answer(question, design, speeds[[i]]) for i in range(len(speeds))])


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


def _answer_frequencies(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    how = question.modes, question.discretization, question.tolerance
    found = [natural_modes(scene, speed, *how) for speed in speeds.tolist()]
    each = [SpeedAnswer(m.frequency[None], m.error[None], m.status[None], m.warnings) for m in found]
    return _together(each)._replace(effects=lambda: found[0].left_out_effects)


def _answer_critical_speed(question: StudyQuestion, scene: Scene, _: np.ndarray) -> SpeedAnswer:
    found = critical_point(scene, question.discretization, question.tolerance)
    state = BUCKLES if np.isfinite(found.speed) else DOES_NOT_BUCKLE
    state = NOT_FOUND if np.isinf(found.error) else state
    answer = (np.array([[each]]) for each in (found.speed, found.error, state))
    return SpeedAnswer(
        *answer, warnings=found.warnings, effects=lambda: found.left_out_effects.at(np.newaxis)
    )


def _answer_crossings(question: StudyQuestion, scene: Scene, _: np.ndarray) -> SpeedAnswer:
    """Find the lowest speed at which each mode crosses each excitation line."""
    found = resonance_speeds(scene, question.speed, question.modes, 1, question.discretization)
    keys, lowest = [crossing_key(each) for each in found], dict[Any, Any]()
    for key, crossing in zip(keys, found, strict=True):  # in order of speed: the lowest crossing is first
        lowest.setdefault(key, crossing)
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
        statements.Words(
            "there is also one at ",
            statements.Speeds(c.speed),
            f": {label_crossing(c.line, c.kind, c.mode, c.second_mode)}",
        )
        for c in lowest.values()
    ]

    def effects() -> LeftOutEffects:
        """Return the changes of the crossings by neglected effects; nan if there is no crossing."""
        places = [keys.index(each.key) if each.key in keys else -1 for each in question.resonances]
        known = found.left_out_effects
        changes = {name: np.append(change, np.nan)[places] for name, change in known.changes.items()}
        return replace(known, changes=changes, shape=(len(places),))

    return SpeedAnswer(value, error, status, (*found.warnings, *more), effects=effects)


def _answer_amplitude(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    found = steady_response(scene, np.unique(speeds), **_options_of_responses(question))
    # The errors are relative to `bound`; convert them to absolute errors.
    error = (found.error + found.mode_error) * found.bound
    warned = found.is_warned if found.warnings else None
    return _at_each(speeds, found, (found.amplitude, error, np.asarray(found.status)), warned)


def _answer_strain(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    """Find the largest strain in steady response: of piezoelectric layers, or, without any, of the beam."""
    if scene.beam.electrodes is not None:
        found = harvest(scene, np.unique(speeds), **_options_of_responses(question))
        return _at_each(speeds, found, (found.strain, found.strain_error, np.asarray(found.status)), None)
    response = steady_response(scene, np.unique(speeds), **_options_of_responses(question))
    found = steady_loads(response)
    found.check_known("strain")
    largest = np.abs(found.strain).max(axis=(1, 2))
    error = np.broadcast_to(found.strain_error, found.strain.shape).max(axis=(1, 2))
    warned = response.is_warned if response.warnings else None
    return _at_each(speeds, found, (largest, error, np.asarray(response.status)), warned)


def _answer_power(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    found = harvest(scene, np.unique(speeds), **_options_of_responses(question))
    answer = found.power, found.error * np.abs(found.power), np.asarray(found.status)
    return _at_each(speeds, found, answer, None)


def _answer_peak(question: StudyQuestion, scene: Scene, speeds: np.ndarray) -> SpeedAnswer:
    options = _options_of_responses(question)
    found = sweep(scene, np.unique(speeds), question.window, **options)
    error = found.time_error + found.mode_error * found.largest
    failed = tuple(dict.fromkeys(status for status in found.status if status != DONE))
    status = np.where(np.isin(found.status, failed), "failed", DONE)
    warned = found.is_warned(options["tolerance"]) if found.warnings else None
    return _at_each(speeds, found, (found.peaks, error, status), warned, failed)


def _options_of_responses(question: StudyQuestion) -> dict[str, Any]:
    return {"tolerance": question.tolerance or OF_RESPONSES, "discretization": question.discretization}


def _at_each(
    speeds: np.ndarray,
    found: Any,
    answer: tuple[np.ndarray, np.ndarray, np.ndarray],
    warned: np.ndarray | None,
    failed: tuple[str, ...] = (),
) -> SpeedAnswer:
    """Build the result at each of `speeds`, which may repeat, from the result `found` at distinct speeds.

    `answer` has values, absolute errors and statuses at the distinct speeds in ascending order; `warned`
    marks those with a warning; `failed` are further warnings, beside those of `found`.
    """
    order = np.unique(speeds, return_inverse=True)[1]
    value, error, status = answer
    with np.errstate(divide="ignore", invalid="ignore"):
        error = error / value
    columns = (each[order, None] for each in (value, np.where(np.isnan(error), np.inf, error), status))
    where = None if warned is None else warned[order]
    warnings = (*found.warnings, *failed)
    return SpeedAnswer(*columns, warnings=warnings, warned=where, effects=lambda: found.left_out_effects)


_ANALYSES: dict[str, Callable[[StudyQuestion, Scene, np.ndarray], SpeedAnswer]] = {
    "frequencies": _answer_frequencies,
    "critical_speed": _answer_critical_speed,
    "crossings": _answer_crossings,
    "amplitude": _answer_amplitude,
    "peak": _answer_peak,
    "strain": _answer_strain,
    "power": _answer_power,
}


# Neglected effects ----------------------------------------------------------------------------------


def left_out_of_design(
    question: StudyQuestion, scene: Scene, design: Mapping[str, float]
) -> LeftOutEffects | None:
    """Compute how much neglected effects change the result of a design.

    Parameters
    ----------
    question : StudyQuestion
        The question.
    scene : Scene
        The scene of the design.
    design : mapping of str to float
        Inputs of the design, by name.

    Returns
    -------
    LeftOutEffects or None
        Relative changes (m,) of the m numbers of the result; None if there is no result.
    """
    speeds = np.array([design.get(SPEED, question.speed)])
    try:
        with statements.unannounced():  # without warnings, as the study has issued them already
            return _ANALYSES[question.what](question, scene, speeds).effects()
    except _FAILURES:
        return None


def join_effects(each: Sequence[LeftOutEffects | None], numbers: int) -> LeftOutEffects:
    """Join the changes by effects for p designs with m numbers each to arrays (p, m).

    The changes are nan if a design has none.
    """
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
