"""Frequencies, critical speeds and amplitudes over all combinations of inputs."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping, Sequence
from concurrent.futures import Executor
from contextlib import nullcontext
from dataclasses import dataclass
from time import perf_counter
from typing import Any, Literal

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.announced import announced
from beamdyn.common.checks import InvalidValue, count, function, one_of, real, within
from beamdyn.common.parallel.workers import Workers, one_blas_thread
from beamdyn.common.results import Provenance
from beamdyn.modal.choice import (
    TOLERANCES,
    DiscretizationChoice,
    check_discretization,
    warn_of_missed_tolerance,
)
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import (
    LARGE_DEFLECTION,
    LARGE_STRAIN,
    check_speeds,
    warn_of_left_out,
    warn_of_static_deflection,
    warn_of_strain,
)
from beamdyn.studies.frequencies import SimilarFrequencies, SolvedDesigns, join
from beamdyn.studies.inputs import (
    SPEED,
    VariedInput,
    check_combination,
    check_inputs,
    columns_of,
    corners,
    scene_of,
    shape_of,
)
from beamdyn.studies.one_by_one import ANALYSES, CHUNK, REFUSED, DesignAnswer, StudyQuestion, answer_designs
from beamdyn.studies.result import Study
from beamdyn.studies.similar import SimilarDesigns, differ_in_numbers_only

_MOST_CORNERS = 10  # inputs of which all combinations of smallest and largest values are checked first
_LARGE_ERROR = 1e-6  # of a frequency, beyond which it is said to be unresolved
Progress = Callable[[int, int], None]


@announced
@one_blas_thread()  # the matrices are small: more threads only wait for each other
def study(
    scene: Scene,
    vary: Mapping[str, Sequence[float] | np.ndarray],
    what: Literal["frequencies", "critical_speed", "amplitude"] = "frequencies",
    *,
    speed: float = 0.0,
    modes: int = 3,
    combine: Literal["product", "zip"] = "product",
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> Study:
    """Answer a question of all combinations of inputs of a scene.

    Frequencies of slender beams that are clamped, undamped and without precone, in one plane, are those of
    one beam with other tip bodies, radii, angles and speeds: one basis and batched eigenproblems serve all
    designs.  Everything else is solved design by design.  Either way the answers and their errors are those
    of single calls, within their stated errors.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is used for amplitudes alone.
    vary : mapping of str to sequence of float
        Values in SI of each input, by its name in scene files: "beam.thickness", "beam.tip.mass",
        "mount.radius", "mount.setting_angle", "model.damping_ratio" and others; and "speed" [rad/s].
        Sides and material are those of a rectangular section.
    what : {"frequencies", "critical_speed", "amplitude"}
        The answer: natural frequencies, the speed at which the beam buckles, or the steady amplitude of its
        tip under its motion.
    speed : float
        Speed of frequencies and amplitudes [rad/s] where it is not varied.
    modes : int
        Number of frequencies.
    combine : {"product", "zip"}
        Combine each value with each of the other inputs, or take the first of all, the second of all, ...
    discretization, tolerance
        As for `natural_modes`; the tolerance of amplitudes as for `steady_response`.
    workers : int
        Number of processes; the answer is the same to the bit for any.
    executor : Executor, optional
        Any of `concurrent.futures`, in place of workers.
    progress : callable, optional
        Called as progress(done, total) with the numbers of designs.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If an argument is out of its range, or no design has an answer.
    """
    start = perf_counter()
    check_scene(scene)
    inputs = check_inputs(vary)
    check_combination(combine, inputs)
    one_of("what", what, tuple(ANALYSES))
    check_discretization(discretization)
    speed, modes = real("speed", speed, "rad/s"), count("modes", modes)
    workers = _check_means(workers, executor, progress)
    tolerance = None if tolerance is None else within("tolerance", tolerance, *TOLERANCES)
    question = StudyQuestion(scene, what, speed, modes, discretization, tolerance)
    request = _Request(question, inputs, combine)
    request.check()
    run = _TaskRunner(workers, executor, progress or (lambda done, total: None))
    answer = request.batched(run) or request.one_by_one(run)
    shape = (*shape_of(inputs, combine), *((modes,) if what == "frequencies" else ()))
    return Study(
        what=what,
        unit=ANALYSES[what][0],
        inputs=inputs,
        combine=combine,
        value=answer.value.reshape(shape),
        error=answer.error.reshape(shape),
        status=answer.status.reshape(shape),
        warnings=tuple(dict.fromkeys(answer.warnings)),
        provenance=Provenance(__version__, answer.method, answer.compared_with, perf_counter() - start),
        scene=scene,
    )


def _check_means(workers: int, executor: Executor | None, progress: Progress | None) -> int:
    if executor is not None and not hasattr(executor, "submit"):
        raise InvalidValue("executor", executor, "give an Executor, as in concurrent.futures")
    workers = count("workers", workers)
    if executor is not None and workers > 1:
        raise InvalidValue("workers", workers, "an executor is given too", "give one of them")
    if progress is not None:
        function("progress", progress, "it takes the numbers of finished designs and of all")
    return workers


@dataclass(frozen=True)
class _TaskRunner:
    """Where tasks are run: in this process, in workers, or by an executor."""

    workers: int
    executor: Executor | None
    progress: Progress

    def map(self, solve: Callable[[Any], Any], tasks: Sequence[Any], sizes: Sequence[int]) -> list[Any]:
        """Results of the tasks, in their order; `sizes` are their numbers of designs."""
        total, done, results = sum(sizes), 0, []
        alone = self.executor is None and (self.workers == 1 or len(tasks) == 1)
        pool = nullcontext(self.executor) if self.executor or alone else Workers(self.workers)
        with pool as executor:
            pairs = [(solve, task) for task in tasks]
            found = map(_solve, pairs) if executor is None else executor.map(_solve, pairs)
            for result, size in zip(found, sizes, strict=True):
                results.append(result)
                self.progress(done := done + size, total)
        return results


def _solve(pair: tuple[Callable[[Any], Any], Any]) -> Any:
    solve, task = pair
    with one_blas_thread():
        return solve(task)


@dataclass(frozen=True)
class _AnswersOfAll:
    """Answers (N, k) of all designs in the order of the product."""

    value: np.ndarray
    error: np.ndarray
    status: np.ndarray
    warnings: list[str]
    method: str
    compared_with: str


@dataclass(frozen=True)
class _Request:
    """A question of designs, whose arguments have been checked one by one."""

    question: StudyQuestion
    inputs: tuple[VariedInput, ...]
    combine: str

    @property
    def names(self) -> set[str]:
        """Names of the inputs."""
        return {each.name for each in self.inputs}

    def check(self) -> None:
        """Refuse designs of which any is no scene, before anything is computed."""
        question, columns = self.question, columns_of(self.inputs, self.combine)
        if SPEED in columns:
            if question.what == "critical_speed":
                bound, remedy = f"{question.what} belongs to no speed", "vary other inputs"
                raise InvalidValue("vary", SPEED, bound, remedy)
            check_speeds(columns[SPEED], SPEED)
        check_speeds(question.speed, SPEED)
        of_scene = {name: values for name, values in columns.items() if name != SPEED}
        if of_scene:
            _check_scenes(question.scene, of_scene, self.combine)

    # All at once ------------------------------------------------------------------------------------

    def batched(self, run: _TaskRunner) -> _AnswersOfAll | None:
        """The answer by batched eigenproblems; None where designs differ in more than numbers."""
        question = self.question
        names = self.names - {SPEED}
        if question.what != "frequencies" or not differ_in_numbers_only(question.scene, names):
            return None
        task = self._similar()
        if not task.can_be_batched:
            return None
        parts = task.split()
        found = join(run.map(SimilarFrequencies.solve, parts, [part.speeds.size for part in parts]))
        squared, error = (self._in_order(values) for values in (found.squared, found.error))
        cases = [squared > 0, squared < 0, squared == 0]
        status = np.select(cases, ["stable", "divergence", "neutral"], REFUSED)
        with np.errstate(invalid="ignore"):
            frequency = np.where(squared >= 0, np.sqrt(np.abs(squared)) / (2 * np.pi), np.nan)
        warnings = [*_warn_of_batch(task, found, question)]
        basis = f"Ritz, at most {found.functions} functions, batched"
        return _AnswersOfAll(frequency, error, status, warnings, basis, "the coarser basis of each")

    @property
    def _others(self) -> list[VariedInput]:
        return [each for each in self.inputs if each.name != SPEED]

    def _similar(self) -> SimilarFrequencies:
        """The designs without their speeds, and these (N, S)."""
        question, others = self.question, self._others
        columns = columns_of(others, self.combine) if others else {}
        first = {name: float(values[0]) for name, values in columns.items()}
        designs = SimilarDesigns(scene_of(question.scene, first), first, columns)
        own = next((each.values for each in self.inputs if each.name == SPEED), np.array([question.speed]))
        together = self.combine == "zip" and SPEED in self.names and bool(others)
        speeds = own[:, None] if together else np.tile(own, (designs.count, 1))
        numbers = question.modes, question.discretization, question.tolerance
        return SimilarFrequencies(designs, speeds, *numbers)

    def _in_order(self, values: np.ndarray) -> np.ndarray:
        """Answers (N, S, k) in the order of the inputs, (N S, k)."""
        if self.combine == "zip" or SPEED not in self.names:
            return values.reshape(-1, values.shape[-1])
        place = [each.name for each in self.inputs].index(SPEED)
        of_others = [len(each.values) for each in self._others]
        grid = values.reshape(*of_others, *values.shape[1:])
        return np.moveaxis(grid, -2, place).reshape(-1, values.shape[-1])

    # One by one -------------------------------------------------------------------------------------

    def one_by_one(self, run: _TaskRunner) -> _AnswersOfAll:
        """The answer by single calls."""
        columns = columns_of(self.inputs, self.combine)
        designs = [
            dict(zip(columns, map(float, row), strict=True)) for row in zip(*columns.values(), strict=True)
        ]
        parts = [designs[start : start + CHUNK] for start in range(0, len(designs), CHUNK)]
        solve = _Single(self.question)
        of_parts = run.map(solve, parts, [*map(len, parts)])
        found: list[DesignAnswer] = [answer for part in of_parts for answer in part]
        refused = [answer.status[0] == REFUSED for answer in found]
        if all(refused):
            raise ValueError(f"none of {len(found)} designs has an answer; {found[0].warnings[0]}")
        value, error, status = (np.array([answer[i] for answer in found]) for i in range(3))
        warnings = [*_warn_of_singles(designs, found, self.inputs)]
        return _AnswersOfAll(value, error, status, warnings, "single calls", "that of each call")


@dataclass(frozen=True)
class _Single:
    """A task of designs that are solved one by one."""

    question: StudyQuestion

    def __call__(self, designs: Sequence[Mapping[str, float]]) -> list[DesignAnswer]:
        return answer_designs(self.question, designs)


def _check_scenes(scene: Scene, columns: Mapping[str, np.ndarray], combine: str) -> None:
    """Make the scenes of extreme values: bounds are monotone in each input, so that all designs keep them."""
    few = len(columns) <= _MOST_CORNERS
    try:
        for design in corners(columns) if few else ():
            scene_of(scene, design)
        if few:
            return
    except InvalidValue:
        if combine == "product":
            raise
    for row in zip(*columns.values(), strict=True):
        scene_of(scene, dict(zip(columns, map(float, row), strict=True)))


# Warnings -----------------------------------------------------------------------------------------


def _warn_of_batch(task: SimilarFrequencies, found: SolvedDesigns, question: StudyQuestion) -> Iterator[str]:
    """Yield what `natural_modes` warns of, for the design where it is worst, with the number of such."""
    yield from warn_of_left_out(question.scene)
    speeds = task.speeds
    unstable = np.any(found.squared < 0, axis=2)
    if unstable.any():
        yield f"{_of(unstable)}: the beam diverges; see status"
    strain = task.designs.strains(speeds)
    if (strain > LARGE_STRAIN).any():
        yield f"{_of(strain > LARGE_STRAIN)}: {next(warn_of_strain(float(np.nanmax(strain))))}"
    bent = found.deflection > LARGE_DEFLECTION
    if bent.any():
        worst = np.unravel_index(np.nanargmax(found.deflection), speeds.shape)
        said = warn_of_static_deflection(found.deflection[worst][None], 1.0, speeds[worst][None])
        yield f"{_of(bent)}: {next(said)}"
    missing = np.any(np.isnan(found.squared), axis=2)
    if missing.any():
        yield f"{_of(missing)} there is no answer: rounding of the matrices leaves none"
    largest = found.error.max(initial=0.0)
    if question.tolerance is not None:
        yield from warn_of_missed_tolerance(largest, question.tolerance)
    elif largest > _LARGE_ERROR:
        inexact = np.any(found.error > _LARGE_ERROR, axis=2)
        yield f"{_of(inexact)} the estimated relative error is above {_LARGE_ERROR:g}: see error"


def _of(which: np.ndarray) -> str:
    return f"at {int(which.sum())} of {which.size} designs"


def _warn_of_singles(
    designs: Sequence[Mapping[str, float]], found: Sequence[DesignAnswer], inputs: Sequence[VariedInput]
) -> Iterator[str]:
    """Yield of how many designs the answers have warnings, and those of the first."""
    refused = [answer.status[0] == REFUSED for answer in found]
    warned = [bool(answer.warnings) and not no for answer, no in zip(found, refused, strict=True)]
    for which, words in ((refused, "there is no answer"), (warned, "there are warnings")):
        if any(which):
            first = which.index(True)
            at = ", ".join(f"{i.name} = {designs[first][i.name]:.6g} {i.unit}".strip() for i in inputs)
            said = "; ".join(found[first].warnings)
            yield f"at {sum(which)} of {len(found)} designs {words}; at {at}: {said}"
