"""Stability charts over two numbers of a scene in periodic motion.

The monodromy matrix is a smooth function of the numbers, though its eigenvalues are not: it is integrated at
a few pairs of numbers and interpolated at all others.  Scenes that remain undecided are integrated
individually; so are all scenes if the number of cycles in the common period varies over the chart, or if
there is no common period.

In shapes of arrays, A and B count values of the two inputs.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property, partial
from os import PathLike
from time import perf_counter
from typing import Any, ClassVar

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, ascending
from beamdyn.common.inputs.described import Designs, VariedInput, check_designs
from beamdyn.common.parallel.tasks import Task, TaskRunner
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.stability_charts import plot_stability_chart
from beamdyn.common.results.columns import evenly_spread
from beamdyn.common.results.one_line import counted, error_at_most, warned
from beamdyn.common.results.pictures import Axes
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.snapshots import ADDED_LATER, FieldsOnly
from beamdyn.common.results.statements import TOLERANCE, Statement, announced_of_plain_beam, joined
from beamdyn.common.words import InputName, Words
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.modal.model import ModalBasis
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.numbers import check_path, unit_of
from beamdyn.scene.scene import Scene, SceneResult
from beamdyn.scene.validity import warn_of_left_out
from beamdyn.studies.floquet.exponents import largest_exponent
from beamdyn.studies.floquet.interpolation import interpolate_on_grid
from beamdyn.studies.floquet.monodromy import (
    COARSER,
    Monodromy,
    PeriodicScenes,
    check_periodic,
    meet_again,
    period_of,
    rates_of,
)
from beamdyn.studies.floquet.multipliers import STABLE, UNDECIDED, UNSTABLE, multipliers_of
from beamdyn.studies.study import VERSIONS

_NAMES = "status", "growth_rate", "growth_rate_error", "spectral_radius", "period"
_TASK = 16  # number of scenes in a task
_JUDGED = 3  # number of values of each number at which the model error is computed
# Largest relative variation with which ratios of phase rates, and products of the period and a number, count
# as constant over the chart.
_ROUNDING = 1e-12
_MOST_ENTRIES = 20_000_000  # largest total number of entries of all matrices, so that they fit into memory


@dataclass(frozen=True)
class StabilityChart(SceneResult, JudgedByRepeating):
    """Stability of free vibration about a periodic motion, over two numbers of the scene.

    `left_out` contains the estimated relative change of the magnitude of the largest multiplier by each
    neglected physical effect, at three values of each number (9,), `model_error` the magnitude of the sum of
    these changes; both are computed at first use.

    Parameters
    ----------
    inputs : tuple of VariedInput
        The two numbers, each with its `name`, `unit` and `values` in SI: (A,) and (B,).
    status : ndarray of str, shape (A, B)
        "stable", "unstable", or "undecided" if the errors allow either.
    growth_rate : ndarray, shape (A, B)
        Largest growth rate of free vibration [1/s]; 0 for stable motion without damping.
    growth_rate_error : ndarray, shape (A, B)
        Estimated error of the growth rate [1/s], for the modes in the model.
    spectral_radius : ndarray, shape (A, B)
        Magnitude of the largest multiplier: the growth factor over a period.
    period : ndarray, shape (A, B)
        Period of the equations of motion [s].
    integrated : int
        Number of scenes whose free vibration was integrated; the others were interpolated.
    modes : int
        Number of modes at rest of each uncoupled displacement; 0 if it is not known, in files of old.
    warnings : tuple of str
        Warnings about the validity and accuracy of the result.
    provenance : Provenance
        How the result was computed.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> motion = bd.PulsatingRotation(50.0, fluctuation=0.1, frequency=124.0)
    >>> scene = bd.Scene(strip, bd.Mount(radius=0.215), motion)
    >>> vary = {"motion.frequency": [110.0, 124.0], "motion.fluctuation": [0.01, 0.1]}
    >>> bd.stability_chart(scene, vary, modes=1).status.tolist()
    [['stable', 'stable'], ['stable', 'unstable']]
    """

    inputs: tuple[VariedInput, ...]
    status: np.ndarray
    growth_rate: np.ndarray
    growth_rate_error: np.ndarray
    spectral_radius: np.ndarray
    period: np.ndarray
    integrated: int
    modes: int = field(default=0, repr=False, kw_only=True, metadata=ADDED_LATER)

    judged_value = "the largest multiplier"
    counted: ClassVar[str] = "place"
    follows_stiffness: ClassVar[bool] = False

    def headline(self) -> Iterator[str]:
        """Yield the number of points with each status and the error, for the one-line summary.

        See `Result.headline`.
        """
        names = joined(" and ", (InputName(each.name) for each in self.inputs))
        yield Words(f"{self.status.size} points over ", names)
        found = ((name, int((self.status == name).sum())) for name in (STABLE, UNSTABLE, UNDECIDED))
        yield from (f"{number} {name}" for name, number in found if number)
        yield from (error_at_most(self.growth_rate_error, "1/s"), warned(self.warnings))

    @property
    def _few(self) -> list[np.ndarray]:
        """For each of the two inputs, the indices of the values at which the model error is computed."""
        return [evenly_spread(len(each.values), _JUDGED) for each in self.inputs]

    def judged(self, found: StabilityChart) -> np.ndarray:
        """Return the magnitude of the largest multiplier in `found` at the points with a model error: (9,).

        There are fewer points if a number of the chart has fewer than three values.
        """
        own = found.status.shape == self.status.shape
        return (found.spectral_radius[np.ix_(*self._few)] if own else found.spectral_radius).ravel()

    @property
    def as_far_as_judged(self) -> Mapping[str, Any]:
        """Arguments of a chart with only the values at which the model error is computed."""
        pairs = zip(self.inputs, self._few, strict=True)
        return {"vary": {each.name: each.values[few] for each, few in pairs}}

    def model_warnings(self, tolerance: float | None = None) -> list[Statement]:
        """List warnings of points with another verdict if there are more modes, and of the model error.

        The points are those at which the model error is computed.
        """
        return [*self._other_verdicts, *super().model_warnings(tolerance)]

    @cached_property
    def _other_verdicts(self) -> tuple[Statement, ...]:
        basis = ModalBasis(self.modes).refined() if self.modes and self.again is not None else None
        if basis is None or self.again is None:
            return ()
        more = self.again(self.scene, modes=basis.modes, **self.as_far_as_judged).status
        own = self.status[np.ix_(*self._few)]
        other = int(((own != more) & (own != UNDECIDED) & (more != UNDECIDED)).sum())
        said = f"at {other} of {own.size} points the verdict is another one with {basis.modes} modes"
        return (Statement(f"{said}: give more modes", kind=TOLERANCE, quantity="modes"),) if other else ()

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the growth rate of unstable free vibration, and mark undecided points."""
        rate = np.where(self.status == UNSTABLE, self.growth_rate, np.nan)
        return plot_stability_chart(self.inputs, rate, self.status == UNDECIDED, ax)


@announced_of_plain_beam
@repeatable
@one_blas_thread()  # with small matrices, further threads only slow each other down
def stability_chart(
    scene: Scene,
    vary: Mapping[str, Sequence[float] | np.ndarray],
    modes: int = 3,
    discretization: DiscretizationChoice = "ritz",
    workers: int = 1,
    store: str | PathLike[str] | None = None,
) -> StabilityChart:
    """Decide for which values of two numbers of a scene free vibration about its periodic motion is stable.

    Parameters
    ----------
    scene : Scene
        The scene, as for `floquet_multipliers`.
    vary : mapping of str to sequence of float
        Values in SI, ascending, of two numbers by their names in scene files, such as "motion.frequency" and
        "motion.fluctuation", or "speed" and "mount.setting_angle".
    modes : int
        Number of modes at rest of each uncoupled displacement, such as bending in each plane.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    workers : int
        Number of processes; the result is bitwise the same for any number.
    store : str or Path, optional
        Folder in which results of scenes are saved; scenes found there are not computed again.

    Returns
    -------
    StabilityChart

    Raises
    ------
    ValueError
        If there are not two numbers, an argument is out of its range, or the motion is not periodic.

    References
    ----------
    As for `floquet_multipliers`: Nayfeh and Mook (1979), chapter 5; interpolation by Chebyshev polynomials.

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> scene = bd.Scene(strip, motion=bd.ShakenCarrier(frequency=130.0, along_n1=100.0))
    >>> vary = {"motion.frequency": np.linspace(100, 160, 31), "motion.along_n1": np.linspace(0, 500, 21)}
    >>> found = bd.stability_chart(scene, vary, modes=1)
    >>> round(float((found.status == "unstable").mean()), 2)
    0.05
    """
    start = perf_counter()
    inputs = _check_inputs(vary)
    scenes = check_periodic(scene, modes, discretization, inputs)
    check_designs(Designs(inputs), most=_MOST_ENTRIES // scenes.size**2)
    run = TaskRunner(workers, None, store, "beamdyn stability chart", VERSIONS)
    grid = _Grid(scenes, inputs, run)
    found, integrated = grid.solved()
    model, _ = scenes.modal(scenes.at(grid.numbers(0)))
    basis = f"{model.discretization}, {counted(scenes.modes, 'mode')}"
    method = f"{basis}, Gauss collocation of order 16, interpolated"
    return StabilityChart(
        inputs=grid.inputs,
        **found,
        integrated=integrated,
        modes=scenes.modes,
        warnings=(*_warnings(scenes.scene, found["status"]), *run.warnings),
        provenance=Provenance.since(start, method, COARSER),
        scene=scenes.scene,
    )


def _check_inputs(vary: Mapping[str, Sequence[float] | np.ndarray]) -> tuple[VariedInput, ...]:
    """Check the two numbers of a chart and their values."""
    if not isinstance(vary, Mapping) or len(vary) != 2:
        bound, remedy = "a chart is over two numbers", 'such as {"motion.frequency": [...], "speed": [...]}'
        raise InvalidValue("vary", vary, bound, remedy)
    paths = [check_path("vary", path) for path in vary]
    values = [ascending(f"vary[{path!r}]", each) for path, each in vary.items()]
    return tuple(VariedInput(path, unit_of(path) or "", x) for path, x in zip(paths, values, strict=True))


@dataclass(frozen=True)
class Points(FieldsOnly):
    """Task: scenes, given by their numbers, whose free vibration is to be integrated."""

    scenes: PeriodicScenes
    numbers: tuple[dict[str, float], ...]


def integrate(points: Points) -> list[Monodromy]:
    """Integrate the free vibration of each scene of a task."""
    return [points.scenes.monodromy(each) for each in points.numbers]


def judge(points: Points) -> list[dict[str, np.ndarray]]:
    """Return the stability of each scene of a task: arrays (1,) by name, see `_verdicts`.

    The stability follows from the Floquet multipliers, or from the largest Lyapunov exponent if the motion
    has no period.
    """
    return [_verdict(points.scenes, numbers) for numbers in points.numbers]


def _verdict(scenes: PeriodicScenes, numbers: dict[str, float]) -> dict[str, np.ndarray]:
    """Compute the stability of one scene: arrays (1,) by name, as `_verdicts` returns them."""
    if meet_again(scene := scenes.at(numbers)):
        return _verdicts(scenes.monodromy(numbers))
    found = largest_exponent(scene, scenes.equations(scene))
    radius = math.exp(found.rate * found.period)
    values = found.status, found.rate, found.error, radius, found.period
    return {name: np.array([value]) for name, value in zip(_NAMES, values, strict=True)}


@dataclass(frozen=True)
class _Grid:
    """Scenes on a grid of two numbers, and the computation of their stability.

    Parameters
    ----------
    scenes : PeriodicScenes
        The scenes.
    inputs : tuple of VariedInput
        The two numbers.
    run : TaskRunner
        Runner of the tasks that integrate the scenes.
    """

    scenes: PeriodicScenes
    inputs: tuple[VariedInput, ...]
    run: TaskRunner

    @property
    def shape(self) -> tuple[int, ...]:
        """Numbers of values of the two inputs: the shape of the chart."""
        return Designs(self.inputs).shape

    def numbers(self, place: int) -> dict[str, float]:
        """Return the numbers of the scene with a given index in the flattened chart."""
        return Designs(self.inputs).at(*map(int, np.unravel_index(place, self.shape)))

    def solved(self) -> tuple[dict[str, np.ndarray], int]:
        """Compute the stability as arrays of the chart's shape, by name, and count integrated scenes."""
        if not self._keeps_ratio():
            places = range(math.prod(self.shape))
            each = self._run(judge, [self.numbers(place) for place in places])
            found = {name: np.concatenate([one[name] for one in each]) for name in _NAMES}
            return {name: values.reshape(self.shape) for name, values in found.items()}, len(places)
        motion, integrated = self._interpolated()
        found = _verdicts(motion)
        undecided = np.flatnonzero(found["status"] == UNDECIDED)
        if integrated == len(motion.period):  # all were integrated, none was interpolated
            undecided = undecided[:0]
        alone = self._integrated([self.numbers(place) for place in undecided.tolist()])
        for place, each in zip(undecided.tolist(), alone, strict=True):
            for name, value in _verdicts(each).items():
                found[name][place] = value[0]
        return {name: each.reshape(self.shape) for name, each in found.items()}, integrated + len(undecided)

    def _keeps_ratio(self) -> bool:
        """Return whether the ratios of all phase rates are the same at corners and midpoints of the chart."""
        rows, columns = (sorted({0, n // 2, n - 1}) for n in self.shape)
        scenes = [self.scenes.at(Designs(self.inputs).at(i, j)) for i in rows for j in columns]
        rates = [np.array(rates_of(each)) for each in scenes]
        # Where the carrier stands still, the rate of rotation is missing.
        if len({len(each) for each in rates}) > 1:
            return False
        ratios = np.array([each / each[0] for each in rates])
        return bool((np.ptp(ratios, axis=0) <= _ROUNDING * ratios[0]).all()) and meet_again(scenes[0])

    def _integrated(self, numbers: Sequence[dict[str, float]]) -> list[Monodromy]:
        """Integrate the monodromy matrices of some scenes."""
        return self._run(integrate, numbers)

    def _run(self, do: Callable[[Points], list[Any]], numbers: Sequence[dict[str, float]]) -> list[Any]:
        """Apply a function to scenes in parallel tasks, and return its results in the order of the scenes."""
        found: dict[int, list[Any]] = {}
        tasks = [
            Task(partial(Points, self.scenes, tuple(numbers[k : k + _TASK])), min(_TASK, len(numbers) - k), k)
            for k in range(0, len(numbers), _TASK)
        ]
        self.run.run(do, tasks, found.__setitem__)
        return [each for k in sorted(found) for each in found[k]]

    def _sets_the_period(self, place: int) -> bool:
        """Return whether the period is inversely proportional to the input with the index `place`.

        The reciprocal of such an input is a smoother variable.
        """
        first, values = self.numbers(0), self.inputs[place].values
        ends = [{**first, self.inputs[place].name: float(values[k])} for k in (0, -1)]
        periods = np.array([period_of(self.scenes.at(end)).time for end in ends])
        products = periods * values[[0, -1]]
        return bool(np.ptp(periods) > 0 and np.ptp(products) <= _ROUNDING * np.abs(products).max())

    def _interpolated(self) -> tuple[Monodromy, int]:
        """Interpolate the monodromy matrices of all A B points, and count those that were integrated."""
        errors, turns, damped = [0.0], [1], set()
        names = [each.name for each in self.inputs]

        inverse = [self._sets_the_period(place) for place in range(2)]

        def numbers_of(variables: tuple[float, float]) -> dict[str, float]:
            each = zip(names, variables, inverse, strict=True)
            return {name: 1 / x if inverted else x for name, x, inverted in each}

        def entries(motion: Monodromy) -> np.ndarray:
            errors.append(float(motion.error[0]))
            turns.append(motion.turns)
            damped.add(motion.form is None)
            form = np.zeros_like(motion.matrix) if motion.form is None else motion.form
            return np.concatenate([motion.matrix.ravel(), form.ravel(), motion.period])

        pairs = zip(self.inputs, inverse, strict=True)
        first, second = (1 / each.values if inverted else each.values for each, inverted in pairs)
        size = self.scenes.size

        def sampled(pairs: list[tuple[float, float]]) -> list[np.ndarray]:
            return [*map(entries, self._integrated([*map(numbers_of, pairs)]))]

        on_grid = interpolate_on_grid(sampled, (first, second), lambda: max(errors), slice(size**2))
        flat = on_grid.value.reshape(-1, 2 * size**2 + 1)
        matrix, form = flat[:, :-1].reshape(-1, 2, size, size).swapaxes(0, 1)
        # The norm of a matrix is at most its size times the largest entry, here the interpolation error.
        error = np.full(len(flat), max(errors) + size * on_grid.error)
        return Monodromy(
            matrix, error, flat[:, -1], None if True in damped else form, max(turns)
        ), on_grid.samples


def _verdicts(motion: Monodromy) -> dict[str, np.ndarray]:
    """Compute the stability that follows from monodromy matrices, by name.

    It consists of the status, the largest growth rate and its error [1/s], the magnitude of the largest
    Floquet multiplier, and the period [s].
    """
    found = multipliers_of(motion)
    rate, error = found.growth
    values = found.verdict, rate, error, found.size[:, 0], motion.period
    return dict(zip(_NAMES, map(np.array, values), strict=True))


def _warnings(scene: Scene, status: np.ndarray) -> Iterator[Statement]:
    """Yield warnings about the chart: neglected effects, and undecided points."""
    yield from warn_of_left_out(scene)
    if number := int((status == UNDECIDED).sum()):
        said = f"at {counted(number, 'point')} of {status.size} stability is undecided: see status"
        yield Statement(said, kind=TOLERANCE, quantity="undecided", value=number / status.size)
