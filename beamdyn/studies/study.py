"""Studies: results over all combinations of inputs, or for designs that are given one by one."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, replace
from functools import cached_property, partial
from os import PathLike
from time import perf_counter
from typing import Any, Literal

import numpy as np
import scipy

from beamdyn._version import __version__
from beamdyn.common.inputs import checks
from beamdyn.common.inputs.described import Designs, VariedInput, check_designs, rows_of
from beamdyn.common.parallel.tasks import Progress, Task, TaskRunner
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import announced
from beamdyn.common.words import Words
from beamdyn.modes.modal.discretization_choice import TOLERANCES, DiscretizationChoice, check_discretization
from beamdyn.scene.names_elsewhere import ROLLING_WHEEL
from beamdyn.scene.numbers import SPEED, check_path, is_of_motion, unit_of, with_numbers
from beamdyn.scene.scene import Scene, check_scene
from beamdyn.scene.validity import check_speeds, warn_of_left_out
from beamdyn.studies.answers import REFUSED, AnswerArrays, DesignAnswers
from beamdyn.studies.batched import critical_speeds_of, frequencies_of
from beamdyn.studies.one_by_one import SingleDesigns
from beamdyn.studies.questions import KINDS, MODES, OPTIONS, WINDOW, StudyQuestion, What
from beamdyn.studies.resonance_speeds import crossings_of, list_resonances
from beamdyn.studies.similar import Nodes, SimilarDesigns, differ_in_numbers_only, nodes_of
from beamdyn.studies.study_result import Study

VERSIONS = (
    __version__,
    np.__version__,
    scipy.__version__,
)  # packages whose versions affect the last bits of stored results
_KIND = "beamdyn study"
_BATCHED, _SINGLE = 1024, 16  # number of results per task, for designs solved in batches and one by one
_AT_ONCE = 100_000  # number of designs whose quantities are computed at once
# Largest number of inputs of which all combinations of smallest and largest values are checked first.
_MOST_CORNERS = 10


@announced
@one_blas_thread()  # with small matrices, further threads only slow each other down
def study(
    scene: Scene,
    vary: Mapping[str, Sequence[float] | np.ndarray],
    what: What = "frequencies",
    *,
    speed: float | None = None,
    modes: int | None = None,
    window: tuple[float, float] | None = None,
    combine: Literal["product", "zip"] = "product",
    discretization: DiscretizationChoice = "ritz",
    tolerance: float | None = None,
    workers: int = 1,
    executor: Executor | None = None,
    store: str | PathLike[str] | None = None,
    progress: Progress | None = None,
) -> Study:
    """Compute one kind of result for many designs: all combinations of inputs, or designs one by one.

    For frequencies, critical speeds and resonance speeds of slender beams, all designs are represented by one
    reference beam with different tip bodies, springs, radii, angles and speeds, and solved in one basis by
    batched eigenproblems.  All other results are computed design by design; those that need a motion, such as
    amplitudes, at all speeds of a design at once.  Both ways give the results of single analyses, within the
    stated errors.

    Parameters
    ----------
    scene : Scene
        The scene; its motion is used for crossings, amplitudes, peaks, strains and power.
    vary : mapping of str to sequence of float
        Values in SI of each input, by its name in scene files: "beam.thickness", "beam.tip.mass",
        "mount.radius", "mount.setting_angle", "model.damping_ratio" and others; "speed" [rad/s]; for
        amplitudes, peaks, strains and power also numbers of the motion, such as "motion.road.wavelength"; and
        factors of properties that vary along the beam, such as "beam.scale.bending_stiffness".  Width,
        thickness and material can be varied only for a beam of rectangular section.
    what : {"frequencies", "critical_speed", "crossings", "amplitude", "peak", "strain", "power"}
        The result: natural frequencies; the speed at which the beam buckles; the speeds at which each mode
        meets each excitation line; the steady amplitude of the tip; its largest deflection in a time window
        of a transient from rest; the largest strain along the span in steady motion (of the layers, if the
        beam carries a harvester); or the mean power of the harvester.
    speed : float, optional
        Speed of frequencies, amplitudes, peaks, strains and power if it is not varied, and top speed of
        crossings [rad/s]; by default 0 for frequencies, otherwise the final speed of the motion.
    modes : int, optional
        Number of modes of frequencies and crossings; 3 if not given.
    window : tuple of float, optional
        Beginning and end of the time window for peaks [s], at whose end each transient ends; 20 to 30 s by
        default.
    combine : {"product", "zip"}
        "product": all combinations of the values of the inputs; "zip": the first values of all inputs
        together, then their second values, and so on.
    discretization, tolerance
        As for `natural_modes`; the tolerance of amplitudes, strains and power as for `steady_response`, that
        of peaks as for `sweep`.
    workers : int
        Number of processes; the result is bitwise the same for any number.
    executor : Executor, optional
        Any of `concurrent.futures`, in place of workers.
    store : str or Path, optional
        Folder in which finished parts are saved; parts found there are not computed again.
    progress : callable, optional
        Called as progress(done, total) with the numbers of designs.

    Returns
    -------
    Study

    Raises
    ------
    ValueError
        If an argument is out of its range or the result does not depend on it, or if no design has a result.
    StudyInterrupted
        If the executor fails; finished parts are in the store.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> vary = {"beam.thickness": [0.0002, 0.0004], "mount.radius": [0.1, 0.2, 0.3]}
    >>> bd.study(bd.Scene(strip, bd.Mount(radius=0.2)), vary, "critical_speed").value.shape
    (2, 3)
    """
    start = perf_counter()
    check_scene(scene)
    designs = Designs(_check_inputs(vary), combine)
    check_designs(designs)
    checks.one_of("what", what, tuple(KINDS))
    check_discretization(discretization)
    run = TaskRunner(workers, executor, store, _KIND, VERSIONS, progress)
    varied = SPEED in {each.name for each in designs.inputs}
    at = speed_of_study(scene, what, speed, varied)
    checks.check_used(what, OPTIONS, speed=speed, modes=modes, window=window)
    if varied and speed is not None:
        raise checks.InvalidValue(
            "speed", speed, "the speed is varied, too", "leave one of the two out", "rad/s"
        )
    modes = checks.count("modes", MODES if modes is None else modes)
    tolerance = None if tolerance is None else checks.within("tolerance", tolerance, *TOLERANCES)
    # Only results that need a motion depend on the motion's numbers.
    of_motion = (each.name for each in designs.inputs if is_of_motion(each.name))
    if not KINDS[what].needs_motion and (name := next(of_motion, None)):
        bound = (
            f"only amplitudes, peaks, strains and power are studied over numbers of the motion, not {what}"
        )
        raise checks.InvalidValue("vary", name, bound, "ask for one of these, or vary other inputs")
    question = StudyQuestion(
        scene, what, at, modes, discretization, tolerance, check_window(WINDOW if window is None else window)
    )
    request = _Request(question, designs)
    request.check()
    if what == "crossings":
        resonances = list_resonances(scene, request.others, at, modes)
        request = replace(request, question=replace(question, resonances=resonances))
    found = request.solve(run)
    left_out = warn_of_left_out(scene) if request.is_similar else ()
    compared_with = "the coarser basis of each" if request.is_similar else "that of each call"
    several = bool(request.question.labels)
    shape = (*designs.shape, request.question.numbers) if several else designs.shape
    return Study(
        what=what,
        unit=KINDS[what].unit,
        inputs=tuple(designs.inputs),
        combine=combine,
        labels=request.question.labels,
        value=request.in_order(found.value).reshape(shape),
        error=request.in_order(found.error).reshape(shape),
        status=request.in_order(found.status).reshape(shape),
        warnings=(*left_out, *found.warnings(), *run.warnings),
        provenance=Provenance.since(start, found.method, compared_with),
        scene=scene,
        question=request.question,
    )


# Arguments ----------------------------------------------------------------------------------------


def _check_inputs(vary: Any) -> tuple[VariedInput, ...]:
    """Check the inputs, and return them with their values as arrays."""
    if not isinstance(vary, Mapping) or not vary:
        remedy = 'give a dictionary, such as {"beam.thickness": [1e-4, 2e-4], "speed": [0.0, 50.0]}'
        raise checks.InvalidValue("vary", vary, "it names no input", remedy)
    inputs = []
    for name, values in vary.items():
        array = checks.real_array(check_path("vary", name), values)
        if not array.size:
            raise checks.InvalidValue(name, values, "it is empty; give at least one value")
        inputs.append(VariedInput(name, unit_of(name) or "", array))
    return tuple(inputs)


def speed_of_study(scene: Scene, what: str, speed: float | None, varied: bool) -> float:
    """Return the speed [rad/s] of designs that do not vary it.

    Raise an error if the speed is varied for a result that does not depend on it, or if the scene lacks a
    motion that the result needs.

    Parameters
    ----------
    scene, what, speed
        As for `study`.
    varied : bool
        Whether the speed is one of the inputs.
    """
    if speed is not None:
        at = checks.real("speed", speed, "rad/s")
    else:
        final = 0.0 if scene.motion is None or what == "frequencies" else scene.motion.final_speed
        at = final if np.isfinite(final) else 0.0
    check_speeds(at, SPEED)
    kind = KINDS[what]
    if kind.needs_motion and scene.motion is None:
        remedy = Words("such as ", ROLLING_WHEEL)
        raise checks.InvalidValue("scene.motion", None, f"a study of {what} needs a motion", remedy)
    if what == "crossings":
        checks.positive("speed", at, "rad/s", "it is the top speed up to which crossings are sought")
    if varied and not kind.has_speed:
        bound = f"a {kind.word} is itself a speed that is sought, and does not depend on another"
        raise checks.InvalidValue("vary", SPEED, bound, "leave speed out and vary other inputs")
    return at


def check_window(window: tuple[float, float]) -> tuple[float, float]:
    """Check a time window, and return its beginning and end [s]."""
    ends = checks.as_floats(window)
    if ends is None or ends.shape != (2,) or not (0 <= ends[0] < ends[1] < np.inf):
        bound = "give its beginning and its end [s], two ascending numbers such as (20.0, 30.0)"
        raise checks.InvalidValue("window", window, bound)
    return float(ends[0]), float(ends[1])


def _check_scenes(scene: Scene, designs: Designs) -> None:
    """Raise an error unless all designs are valid scenes.

    For few inputs it suffices that all combinations of their smallest and largest values are valid.
    """
    few = len(designs.inputs) <= _MOST_CORNERS
    try:
        for design in designs.extremes() if few else ():
            with_numbers(scene, design)
        if few:
            return
    except checks.InvalidValue:
        if designs.combine == "product":
            raise
    for rows in designs.chunks(_AT_ONCE):
        for design in rows_of(designs.columns(rows)):
            with_numbers(scene, design)


# The request --------------------------------------------------------------------------------------


def _answer(task: SimilarTask | SingleDesigns) -> DesignAnswers:
    """Compute the results of a task; defined at module level so that worker processes can call it."""
    return task.answers()


@dataclass(frozen=True)
class SimilarTask:
    """Task of a study: similar designs that are solved together.

    Parameters
    ----------
    question : StudyQuestion
        Question that the study asks of each design.
    designs : SimilarDesigns
        N designs.
    columns : mapping of str to ndarray, shape (N,)
        Inputs of the designs, except the speed.
    speeds : ndarray, shape (N, speeds)
        Speeds of each design [rad/s].
    """

    question: StudyQuestion
    designs: SimilarDesigns
    columns: Mapping[str, np.ndarray]
    speeds: np.ndarray

    def answers(self) -> DesignAnswers:
        """Compute the results of the designs."""
        question, designs = self.question, self.designs
        refinement = question.refinement(designs.reference)
        if question.what == "frequencies":
            own = np.full(designs.count, question.scene.damping_ratio)
            ratio = self.columns.get("model.damping_ratio", own)  # damping ratio of each design
            return frequencies_of(designs, refinement, self.speeds, ratio if ratio.any() else None)
        if question.what == "critical_speed":
            return critical_speeds_of(designs, refinement, self._single)
        return crossings_of(designs, refinement, question.scene, question.resonances, question.speed)

    def _single(self, rows: np.ndarray) -> DesignAnswers:
        columns = {name: values[rows] for name, values in self.columns.items()}
        return SingleDesigns(self.question, columns, self.speeds[rows]).answers()


@dataclass(frozen=True)
class _Request:
    """Checked request of a study: a question, and the designs for which it is to be answered."""

    question: StudyQuestion
    designs: Designs

    @cached_property
    def others(self) -> Designs:
        """Designs without the speed as an input."""
        return self.designs.without(SPEED)

    @cached_property
    def own_speeds(self) -> np.ndarray | None:
        """Speeds that are varied [rad/s]; None if the speed is not an input."""
        return next((each.values for each in self.designs.inputs if each.name == SPEED), None)

    @property
    def together(self) -> bool:
        """Whether the speed is varied together with other inputs, so that each design has its own speed."""
        return self.designs.combine == "zip" and self.own_speeds is not None and bool(self.others.inputs)

    @property
    def speeds(self) -> int:
        """Number S of speeds of each design."""
        return 1 if self.together or self.own_speeds is None else len(self.own_speeds)

    def check(self) -> None:
        """Raise an error if any design is not a valid scene, before anything is computed."""
        if self.own_speeds is not None:
            check_speeds(self.own_speeds, SPEED)
        if self.others.inputs:
            _check_scenes(self.question.scene, self.others)
        question = self.question
        if question.what == "crossings" and question.tolerance is not None and not self.is_similar:
            bound = "these designs are solved one by one, and their crossings without a tolerance"
            raise checks.InvalidValue("tolerance", question.tolerance, bound, "leave it out")

    def solve(self, run: TaskRunner) -> AnswerArrays:
        """Compute the results: in one basis if the designs are similar beams, otherwise one by one.

        The size of tasks follows from the request alone, so that results do not depend on the number of
        processes.  Responses of a design are solved at all its speeds in one task.
        """
        found = AnswerArrays((self.others.count, self.speeds, self.question.numbers))
        size = _BATCHED if self.is_similar else _SINGLE
        whole = not self.is_similar and self.question.kind.needs_motion
        block = self.speeds if whole else min(self.speeds, size)
        tasks = [
            Task(partial(self._task, rows, at), (rows.stop - rows.start) * (at.stop - at.start), (rows, at))
            for rows in self.others.chunks(max(1, size // block))
            for first in range(0, self.speeds, block)
            for at in [slice(first, min(first + block, self.speeds))]
        ]
        run.run(_answer, tasks, found.put)
        if (refused := found.count(REFUSED)) and refused == found.value.size:
            raise checks.NoModelAnswer(
                f"none of {self.designs.count} designs has an answer; {next(found.warnings())}"
            )
        return found

    def _task(self, rows: slice, at: slice) -> SimilarTask | SingleDesigns:
        """Build a task for some designs, each with some of its speeds."""
        columns = self._columns(rows)
        if self.together:
            assert self.own_speeds is not None
            speeds = self.own_speeds[rows, None]
        else:
            own = np.array([self.question.speed]) if self.own_speeds is None else self.own_speeds
            speeds = np.tile(own[at], (rows.stop - rows.start, 1))
        if not self.is_similar:
            return SingleDesigns(self.question, columns, speeds)
        designs = replace(self._similar(rows), nodes=self._nodes)
        return SimilarTask(self.question, designs, columns, speeds)

    def _columns(self, rows: slice) -> dict[str, np.ndarray]:
        return self.others.columns(rows) if self.others.inputs else {}

    # All designs in one basis --------------------------------------------------------------------------

    @cached_property
    def is_similar(self) -> bool:
        """Whether the designs are similar beams, so that one basis suffices for all."""
        question, names = self.question, {each.name for each in self.others.inputs}
        scene, is_batched = question.scene, question.what in _BATCHED_KINDS
        if not is_batched or not differ_in_numbers_only(scene, names - {"model.damping_ratio"}):
            return False
        if question.what == "crossings" and scene.physics.planes == 2:
            return False  # the lines of each plane excite only the modes of this plane
        return (
            question.refinement(self._reference).can_be_batched
            and all(self._similar(rows).can_be_solved for rows in self.others.chunks(_AT_ONCE))
            and replace(self._similar(slice(0, 1)), nodes=self._nodes).has_few_nodes(self.designs.count)
        )

    @cached_property
    def _first(self) -> dict[str, float]:
        return {name: float(values[0]) for name, values in self._columns(slice(0, 1)).items()}

    @cached_property
    def _reference(self) -> Scene:
        """Scene of the first design, without damping and motion, which do not affect its modes."""
        return replace(with_numbers(self.question.scene, self._first).undamped, motion=None)

    @cached_property
    def _nodes(self) -> Nodes:
        return nodes_of(self._similar(rows) for rows in self.others.chunks(_AT_ONCE))

    def _similar(self, rows: slice) -> SimilarDesigns:
        return SimilarDesigns(self._reference, self._first, self._columns(rows))

    # Results ----------------------------------------------------------------------------------------

    def in_order(self, values: np.ndarray) -> np.ndarray:
        """Arrange k results of N designs at S speeds, (N, S, k), in the order of the inputs."""
        if self.own_speeds is None or self.designs.combine == "zip":
            return values
        place = [each.name for each in self.designs.inputs].index(SPEED)
        return np.moveaxis(values.reshape(*self.others.shape, *values.shape[1:]), -2, place)


_BATCHED_KINDS = {"frequencies", "critical_speed", "crossings"}
