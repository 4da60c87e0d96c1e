"""Ranges of a scene's results over tolerances of its inputs: first-order, worst-case and Monte Carlo."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from os import PathLike
from typing import Any

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, NoModelAnswer, check_used, kind, one_of
from beamdyn.common.parallel.tasks import Progress
from beamdyn.common.results.columns import SI_UNITS, DisplayUnits
from beamdyn.common.results.statements import announced, unannounced
from beamdyn.common.spreading import DEFAULT_SAMPLES, tolerances
from beamdyn.common.spreading.first_order import KnownDerivatives
from beamdyn.common.spreading.solve import SpreadAnswers, solve_spread
from beamdyn.common.spreading.spread_result import Spread
from beamdyn.common.spreading.statistics import check_samples, check_seed
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.model_error.left_out_changes import nothing_known
from beamdyn.modes.model_error.left_out_effects import LeftOutEffects, StatesModelError
from beamdyn.scene.numbers import SCALE, SPEED, check_path, number_at, unit_of, with_numbers
from beamdyn.scene.rectangle import SECTION_UNITS
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.studies.one_by_one import left_out_of_design
from beamdyn.studies.questions import KINDS, OPTIONS, StudyQuestion, What
from beamdyn.studies.sensitivities.sensitivities import (
    critical_speed_sensitivities,
    crossing_sensitivities,
    frequency_sensitivities,
)
from beamdyn.studies.sensitivities.sensitivity_result import numbers_of
from beamdyn.studies.study import speed_of_study, study
from beamdyn.studies.study_result import Study

# Argument named in the error that refuses derivatives for nonlinear equations.
_NONLINEAR = "physics.large_deflection"


def known_derivatives(question: StudyQuestion, inputs: Sequence[tolerances.SpreadInput]) -> KnownDerivatives:
    """Compute the derivatives of a result with respect to inputs, where the equations of motion give them.

    Parameters
    ----------
    question : StudyQuestion
        The question; if it asks for crossings, with its `resonances`.
    inputs : sequence of SpreadInput
        The inputs.
    """
    known = {number.name for number in numbers_of(question.scene)} | {SPEED}
    rows = {each.name: row for row, each in enumerate(inputs) if each.name in known}
    if question.kind.needs_motion or not rows:
        return KnownDerivatives()
    scene, of_modes = question.scene, (question.speed, question.modes)
    options: dict[str, Any] = {"inputs": [*rows], "discretization": question.discretization}
    try:
        with unannounced():
            if question.what == "crossings":
                found = crossing_sensitivities(scene, *of_modes, **options)
            elif question.what == "critical_speed":
                found = critical_speed_sensitivities(scene, tolerance=question.tolerance, **options)
            else:
                found = frequency_sensitivities(scene, *of_modes, tolerance=question.tolerance, **options)
    except ValueError as error:
        return KnownDerivatives(warnings=_said(error))
    # Each number of the result gets its derivatives: nan if it is a crossing that was not found, and those of
    # the crossing at the lowest speed if several have its label.
    none = np.full(len(found.inputs), np.nan)
    places = {name: k for k, name in reversed([*enumerate(found.answers)])}
    value, error = (
        np.stack([values[:, places[n]] if n in places else none for n in question.labels or places], axis=1)
        for values in (found.derivative, found.error)
    )
    return KnownDerivatives({rows[each.name]: (value[i], error[i]) for i, each in enumerate(found.inputs)})


def _said(refusal: ValueError) -> tuple[str, ...]:
    """Make a warning that slopes are differences between designs, and why there are no derivatives.

    It is empty if derivatives cannot be expected: for a beam that does not buckle, and with large deflection.
    """
    if isinstance(refusal, NoModelAnswer) or (
        isinstance(refusal, InvalidValue) and refusal.field == _NONLINEAR
    ):
        return ()
    return (f"first order: slopes are differences between designs, as derivatives are refused: {refusal}",)


# Ranges of a scene's results over tolerances of its inputs --------------------------------------------


@dataclass(frozen=True)
class SceneSpread(Spread, StatesModelError):
    """Ranges of k results of a scene over the tolerances of d inputs.

    The fields are as in `Spread`.  `left_out` contains the estimated relative change of each result of the
    nominal design by each neglected physical effect, `model_error` (k,) the magnitude of the sum of these
    changes; both are computed at first use.
    """

    question: StudyQuestion = field(repr=False)

    judged_by_solving = True
    judged_value = "the nominal design"
    counted = "answer"

    @property
    def scene(self) -> Scene:
        """Scene with the nominal values of the inputs."""
        return self.question.scene

    @property
    def display_units(self) -> DisplayUnits:
        """Units of tables and columns: SI, unless `in_units` has set others."""
        return vars(self).get("_display_units") or SI_UNITS

    @cached_property
    def left_out_effects(self) -> LeftOutEffects:
        """Relative changes of the nominal design's results by each neglected effect."""
        return left_out_of_design(self.question, self.scene, {}) or nothing_known(self.scene)


_REMEDY = 'give a dictionary, such as {"beam.thickness": "+-2%", "mount.radius": Uniform(0.19, 0.21)}'


@announced
def spread(
    scene: Scene,
    inputs: Mapping[str, str | tolerances.Distribution],
    what: What = "frequencies",
    *,
    samples: int = DEFAULT_SAMPLES,
    seed: int = 0,
    speed: float | None = None,
    modes: int | None = None,
    window: tuple[float, float] | None = None,
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    store: str | PathLike[str] | None = None,
    progress: Callable[[int, int], object] | None = None,
) -> SceneSpread:
    """Compute the ranges of a result over tolerances of inputs, and the most important input.

    Inputs are independent of each other.  In worst cases each input is at the end of its tolerance that makes
    the result smallest or largest; random designs give mean, standard deviation, percentiles and Sobol'
    indices, by `scipy.stats.sobol_indices`.  All designs are computed by `study`.

    Parameters
    ----------
    scene : Scene
        The scene with the nominal values.
    inputs : mapping of str to str, Uniform or Normal
        Inputs with tolerances, by their names as in `study`, each with its tolerance: "+-2%" or "+1% -2%" of
        the scene's value, within which all values are equally likely; "sd 1%", normally distributed with this
        standard deviation; without the percent sign numbers in SI, also "1.9e-4 to 2.1e-4"; or
        `Uniform(low, high)`, `Normal(mean, deviation)` in SI.
    what : {"frequencies", "critical_speed", "crossings", "amplitude", "peak", "strain", "power"}
        Name of the result, as in `study`.
    samples : int
        Number n of designs in each of 2 + d random samples, d being the number of inputs: a power of two from
        128 on; for other numbers the next such power is used.
    seed : int
        Seed of the random designs.
    speed, modes, window, discretization, tolerance, workers, executor, store, progress
        As for `study`; the total number in `progress` increases by the designs of the worst cases, at most to
        twice its first value.

    Returns
    -------
    Spread
        With `model_error` and `left_out` of the nominal design, computed at their first use.

    Raises
    ------
    ValueError
        If an argument is out of its range, a tolerance reaches values that an input cannot have, or no design
        has a result.
    StudyInterrupted
        If the executor fails; finished parts are in the store.

    References
    ----------
    Indices: Saltelli et al. (2010), Computer Physics Communications 181, 259; worst cases: Kolda, Lewis and
    Torczon (2003), SIAM Review 45, 385.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> found = bd.spread(bd.Scene(strip), {"beam.thickness": "+-2%"}, modes=1, samples=128)
    >>> round(float(found.worst.largest[0] / found.nominal[0]), 6)  # proportional
    1.02
    """
    check_scene(scene)
    one_of("what", what, tuple(KINDS))
    used, cautions = check_samples(samples)
    at = speed_of_study(scene, what, speed, isinstance(inputs, Mapping) and SPEED in inputs)
    check_used(what, OPTIONS, speed=speed, modes=modes, window=window)
    uncertain = check_tolerances(scene, inputs, at)
    options: dict[str, Any] = {
        "speed": None if SPEED in inputs else speed,
        "modes": modes,
        "window": window,
        "discretization": discretization,
        "tolerance": tolerance,
    }
    how = {"workers": workers, "executor": executor, "store": store, "progress": progress}
    answers = _StudyAnswers(scene, what, options | how)

    def derivatives() -> KnownDerivatives:
        return known_derivatives(replace(answers.first.question, speed=at), uncertain)

    found = solve_spread(what, uncertain, used, check_seed(seed), answers, derivatives, cautions)
    values = {each.name: getattr(found, each.name) for each in fields(found)}
    return SceneSpread(**values, question=replace(answers.first.question, speed=at))


@dataclass
class _StudyAnswers:
    """Function that computes the results of designs by `study`.

    The results of each call are arranged in columns as those of the first call.
    """

    scene: Scene
    what: Any
    options: Mapping[str, Any]
    _studies: list[Study] = field(default_factory=list)
    _done: int = 0  # number of designs in earlier calls

    @property
    def first(self) -> Study:
        """Study of the first call."""
        return self._studies[0]

    def __call__(self, columns: dict[str, np.ndarray]) -> SpreadAnswers:
        """Compute the results of designs that are given as columns of inputs."""
        options = {**self.options, "progress": self._progress}
        with unannounced():
            found = study(self.scene, columns, self.what, combine="zip", **options)
        self._done += len(found.value)
        if not self._studies:
            self._studies.append(found)
        names = self.first.labels or (self.first.question.kind.word,)
        parts = (each.reshape(len(found.value), -1) for each in (found.value, found.error, found.status))
        value, error, status = (self._in_order(found, part) for part in parts)
        return SpreadAnswers(
            answers=names,
            units=(found.unit,) * len(names),
            value=value,
            error=error,
            status=status,
            warnings=found.warnings,
            method=found.provenance.method,
            compared_with=found.provenance.compared_with,
        )

    @property
    def _progress(self) -> Progress | None:
        """Callback for progress, which counts the designs of all calls so far.

        Its total increases with each call, as the number of worst cases is not known beforehand.
        """
        said, before = self.options["progress"], self._done
        return said if not before else said and (lambda done, total: said(before + done, before + total))

    def _in_order(self, found: Study, values: np.ndarray) -> np.ndarray:
        """Sort result columns by the labels of the first study; other designs may cross fewer lines."""
        if found.labels == self.first.labels:
            return values
        none = np.full(len(values), np.nan if values.dtype.kind == "f" else "not excited")
        known = {label: values[:, i] for i, label in enumerate(found.labels)}
        return np.stack([known.get(label, none) for label in self.first.labels], axis=1)


# Tolerances ---------------------------------------------------------------------------------------


def check_tolerances(
    scene: Scene, inputs: Mapping[str, str | tolerances.Distribution], speed: float
) -> tuple[tolerances.SpreadInput, ...]:
    """Check tolerances, and return the inputs with their distributions.

    Raises
    ------
    InvalidValue
        If no tolerances are given, an input is unknown or not in the scene, or a tolerance is not valid or
        reaches values that the input cannot have.
    """
    if not isinstance(inputs, Mapping) or not inputs:
        raise InvalidValue("inputs", inputs, "it names no input", _REMEDY)
    made = []
    for key, given in inputs.items():
        name = check_path("inputs", key)
        nominal, unit = nominal_value(scene, name, speed), unit_of(name) or ""
        if name == SPEED and not nominal and isinstance(given, str) and "%" in given:
            bound = "a percentage is of the speed, which is 0"
            raise InvalidValue(f"tolerances[{SPEED!r}]", given, bound, "give spread a speed [rad/s], too")
        if isinstance(given, str):
            given = tolerances.parse_tolerance(name, given, nominal, unit, _in_si(name, given, unit))
        kind(name, given, tolerances.Uniform | tolerances.Normal, _REMEDY)
        made.append(tolerances.SpreadInput(name, unit, nominal, given))
        tolerances.check_holds(made[-1])
        check_reach(scene, made[-1])
    return tuple(made)


def nominal_value(scene: Scene, name: str, speed: float) -> float:
    """Return the nominal value of an input in SI: a number of the scene, or `speed` for the input "speed".

    Raises
    ------
    InvalidValue
        If the scene has no such number, or it varies along the beam, or is infinite.
    """
    if name == SPEED:
        return speed
    value = number_at(scene, name)
    key = name.removeprefix("beam.")
    if key in SECTION_UNITS and number_at(scene, "beam.density") is None:
        bound = "the properties of the beam are not those of a rectangular section"
        raise InvalidValue("spread", name, bound, "give a spread of beam.bending_stiffness or the like")
    if value is None:
        raise InvalidValue("spread", name, "the scene has no such number", "give it one, or leave it out")
    if np.isnan(value):
        remedy = f"give a spread of {SCALE}{key}, which multiplies it"
        raise InvalidValue("spread", name, "it varies along the beam", remedy)
    if np.isinf(value):
        raise InvalidValue("spread", name, f"the scene's value is {value:g}", "give it a finite one first")
    return value


def _in_si(name: str, text: str, unit: str) -> tolerances.Convert:
    def convert(number: str, written: str) -> float:
        if written not in ("", unit):
            bound = f"a tolerance given as text has percentages, or numbers in {unit or 'SI'}"
            raise InvalidValue(name, text, bound, tolerances.without_unit(text, written, unit))
        return float(number)

    return convert


def check_reach(scene: Scene, given: tolerances.SpreadInput) -> None:
    """Raise an error if the scene is invalid with an input at either end of its tolerance.

    All other inputs keep their nominal values.
    """
    for end in given.distribution.reach:
        try:
            with_numbers(scene, {given.name: end})
        except InvalidValue as error:
            said = {"where": f", which {given.text} reaches", "unit": error.unit or given.unit}
            raise replace(error, **said, remedy="give a smaller spread") from None
