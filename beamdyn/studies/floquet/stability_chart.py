"""Charts of stability over two numbers of a scene in periodic motion.

The monodromy matrix is a smooth function of the numbers of the scene, though its eigenvalues are not: it is
integrated at a few pairs of numbers and interpolated at all others.  What that leaves undecided is integrated
by itself.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import partial
from os import PathLike
from time import perf_counter
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np

from beamdyn._version import __version__
from beamdyn.common.inputs.checks import InvalidValue, ascending
from beamdyn.common.inputs.designs import Designs, VariedInput, check_designs
from beamdyn.common.parallel.tasks import Task, TaskRunner
from beamdyn.common.parallel.workers import one_blas_thread
from beamdyn.common.plots.stability_charts import plot_stability_chart
from beamdyn.common.results.one_line import counted, error_at_most, warned
from beamdyn.common.results.read_only import FieldsOnly
from beamdyn.common.results.result import Provenance
from beamdyn.common.results.statements import TOLERANCE, Statement, announced_of_plain_beam
from beamdyn.modes.modal.discretization_choice import DiscretizationChoice
from beamdyn.modes.repeated import JudgedByRepeating, repeatable
from beamdyn.scene.numbers import check_path, unit_of
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import warn_of_left_out
from beamdyn.studies.floquet.interpolation import interpolate_on_grid
from beamdyn.studies.floquet.monodromy import COARSER, Monodromy
from beamdyn.studies.floquet.multipliers import STABLE, UNDECIDED, UNSTABLE, multipliers_of
from beamdyn.studies.floquet.period import period_of
from beamdyn.studies.floquet.periodic_scenes import PeriodicScenes, check_periodic
from beamdyn.studies.study import VERSIONS

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_TASK = 16  # scenes of a task
_JUDGED = 3  # values of each number at which the model error is computed
_ROUNDING = 1e-12  # relative, of a product that is constant
_MOST_ENTRIES = 20_000_000  # of all matrices, so that they fit into memory


@dataclass(frozen=True)
class StabilityChart(JudgedByRepeating):
    """Stability of free motion about a periodic motion, over two numbers of the scene.

    `model_error` and `left_out`, computed when asked for, are what the physics left out would change in the
    size of the largest multiplier, at three values of each number (9,).

    Parameters
    ----------
    inputs : tuple of VariedInput
        The two numbers, each with its `name`, `unit` and `values` in SI: (A,) and (B,).
    status : ndarray of str, shape (A, B)
        "stable", "unstable", or "undecided" where the errors allow either.
    growth_rate : ndarray, shape (A, B)
        Largest growth rate of free motion [1/s]; 0 without damping where it is stable.
    growth_rate_error : ndarray, shape (A, B)
        Its estimated error [1/s], of the modes that are kept.
    spectral_radius : ndarray, shape (A, B)
        Size of the largest multiplier: the growth over a period.
    period : ndarray, shape (A, B)
        Period of the equations of motion [s].
    integrated : int
        Number of scenes whose free motion was integrated; others were interpolated.
    warnings : tuple of str
        Limitations of the result.
    provenance : Provenance
        How it was computed.

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
    warnings: tuple[str, ...]
    provenance: Provenance
    scene: Scene = field(repr=False)

    judged_value = "the largest multiplier"
    counted: ClassVar[str] = "place"
    follows_stiffness: ClassVar[bool] = False

    def headline(self) -> Iterator[str]:
        """How many points are stable, and the error, in one line; see `Result.headline`."""
        yield f"{self.status.size} points over {' and '.join(each.name for each in self.inputs)}"
        found = ((name, int((self.status == name).sum())) for name in (STABLE, UNSTABLE, UNDECIDED))
        yield from (f"{number} {name}" for name, number in found if number)
        yield from (error_at_most(self.growth_rate_error, "1/s"), warned(self.warnings))

    @property
    def _few(self) -> list[np.ndarray]:
        """Places along each number at which the model error is computed."""
        sizes = [len(each.values) for each in self.inputs]
        return [np.unique(np.linspace(0, n - 1, min(n, _JUDGED)).round().astype(int)) for n in sizes]

    def judged(self, found: StabilityChart) -> np.ndarray:
        """Sizes of the largest multiplier, of which the model error is stated: shape (9,) or fewer."""
        own = found.status.shape == self.status.shape
        return (found.spectral_radius[np.ix_(*self._few)] if own else found.spectral_radius).ravel()

    @property
    def as_far_as_judged(self) -> Mapping[str, Any]:
        """The values at which the model error is computed."""
        pairs = zip(self.inputs, self._few, strict=True)
        return {"vary": {each.name: each.values[few] for each, few in pairs}}

    def plot(self, ax: Axes | None = None) -> Axes:
        """Draw the growth rate where free motion grows, and mark what is undecided."""
        rate = np.where(self.status == UNSTABLE, self.growth_rate, np.nan)
        return plot_stability_chart(self.inputs, rate, self.status == UNDECIDED, ax)


@announced_of_plain_beam
@repeatable
@one_blas_thread()  # the matrices are small: more threads only wait for each other
def stability_chart(
    scene: Scene,
    vary: Mapping[str, Sequence[float] | np.ndarray],
    modes: int = 3,
    discretization: DiscretizationChoice = "ritz",
    workers: int = 1,
    store: str | PathLike[str] | None = None,
) -> StabilityChart:
    """Decide where free motion about a periodic motion is stable, over two numbers of the scene.

    Parameters
    ----------
    scene : Scene
        The scene, as for `floquet_multipliers`.
    vary : mapping of str to sequence of float
        Values in SI, ascending, of two numbers by their names in scene files, such as "motion.frequency" and
        "motion.fluctuation", or "speed" and "mount.setting_angle".
    modes : int
        Number of modes at rest of each field.
    discretization : {"ritz", "fem"} or Discretization
        As for `natural_modes`.
    workers : int
        Number of processes; the answer is the same to the bit for any.
    store : str or Path, optional
        Folder in which the integrated scenes are kept; those found there are not computed again.

    Returns
    -------
    StabilityChart

    Raises
    ------
    ValueError
        If there are not two numbers, an argument is out of its range, or the motion does not repeat itself
        after the same number of turns everywhere.

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
    method = f"{model.discretization}, {scenes.modes} modes, Gauss collocation of order 16, interpolated"
    return StabilityChart(
        inputs=grid.inputs,
        status=found["status"],
        growth_rate=found["rate"],
        growth_rate_error=found["error"],
        spectral_radius=found["radius"],
        period=found["period"],
        integrated=integrated,
        warnings=(*_warnings(scenes.scene, found["status"]), *run.warnings),
        provenance=Provenance(__version__, method, COARSER, perf_counter() - start),
        scene=scenes.scene,
    )


def _check_inputs(vary: Mapping[str, Sequence[float] | np.ndarray]) -> tuple[VariedInput, ...]:
    """Check the two numbers and their values."""
    if not isinstance(vary, Mapping) or len(vary) != 2:
        bound, remedy = "a chart is over two numbers", 'such as {"motion.frequency": [...], "speed": [...]}'
        raise InvalidValue("vary", vary, bound, remedy)
    paths = [check_path("vary", path) for path in vary]
    values = [ascending(f"vary[{path!r}]", each) for path, each in vary.items()]
    return tuple(VariedInput(path, unit_of(path) or "", x) for path, x in zip(paths, values, strict=True))


@dataclass(frozen=True)
class Points(FieldsOnly):
    """Some of the scenes, by their numbers, whose free motion is to be integrated: a task."""

    scenes: PeriodicScenes
    numbers: tuple[dict[str, float], ...]


def integrate(points: Points) -> list[Monodromy]:
    """Integrate the free motions of a task."""
    return [points.scenes.monodromy(each) for each in points.numbers]


@dataclass(frozen=True)
class _Grid:
    """Scenes over two numbers, and their stability.

    Parameters
    ----------
    scenes : PeriodicScenes
        The scenes.
    inputs : tuple of VariedInput
        The two numbers.
    run : TaskRunner
        Integrates the scenes.
    """

    scenes: PeriodicScenes
    inputs: tuple[VariedInput, ...]
    run: TaskRunner

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape (A, B) of the chart."""
        return Designs(self.inputs).shape

    def numbers(self, place: int) -> dict[str, float]:
        """The numbers at a place of the flattened chart."""
        return Designs(self.inputs).at(*map(int, np.unravel_index(place, self.shape)))

    def solved(self) -> tuple[dict[str, np.ndarray], int]:
        """Arrays (A, B) by name, and how many scenes were integrated for them."""
        motion, integrated = self._interpolated()
        found = _verdicts(motion)
        undecided = np.flatnonzero(found["status"] == UNDECIDED)
        if integrated == len(motion.period):  # nothing was interpolated
            undecided = undecided[:0]
        alone = self._integrated([self.numbers(place) for place in undecided.tolist()])
        for place, each in zip(undecided.tolist(), alone, strict=True):
            for name, value in _verdicts(each).items():
                found[name][place] = value[0]
        return {name: each.reshape(self.shape) for name, each in found.items()}, integrated + len(undecided)

    def _integrated(self, numbers: Sequence[dict[str, float]]) -> list[Monodromy]:
        """The monodromy matrices of some scenes."""
        found: dict[int, list[Monodromy]] = {}
        tasks = [
            Task(partial(Points, self.scenes, tuple(numbers[k : k + _TASK])), min(_TASK, len(numbers) - k), k)
            for k in range(0, len(numbers), _TASK)
        ]
        self.run.run(integrate, tasks, found.__setitem__)
        return [each for k in sorted(found) for each in found[k]]

    def _sets_the_period(self, place: int) -> bool:
        """Whether the period is inverse to a number, whose reciprocal is then the smoother variable."""
        first, values = self.numbers(0), self.inputs[place].values
        ends = [{**first, self.inputs[place].name: float(values[k])} for k in (0, -1)]
        periods = np.array([period_of(self.scenes.at(end)).time for end in ends])
        products = periods * values[[0, -1]]
        return bool(np.ptp(periods) > 0 and np.ptp(products) <= _ROUNDING * np.abs(products).max())

    def _interpolated(self) -> tuple[Monodromy, int]:
        """Monodromy matrices (A B, m, m), and how many of them were integrated."""
        errors, turns, damped = [0.0], set(), set()
        names = [each.name for each in self.inputs]

        inverse = [self._sets_the_period(place) for place in range(2)]

        def numbers_of(variables: tuple[float, float]) -> dict[str, float]:
            each = zip(names, variables, inverse, strict=True)
            return {name: 1 / x if inverted else x for name, x, inverted in each}

        def entries(motion: Monodromy) -> np.ndarray:
            errors.append(float(motion.error[0]))
            turns.add(motion.turns)
            damped.add(motion.form is None)
            form = np.zeros_like(motion.matrix) if motion.form is None else motion.form
            return np.concatenate([motion.matrix.ravel(), form.ravel(), motion.period])

        pairs = zip(self.inputs, inverse, strict=True)
        first, second = (1 / each.values if inverted else each.values for each, inverted in pairs)
        size = self.scenes.size

        def sampled(pairs: list[tuple[float, float]]) -> list[np.ndarray]:
            return [*map(entries, self._integrated([*map(numbers_of, pairs)]))]

        on_grid = interpolate_on_grid(sampled, (first, second), lambda: max(errors), slice(size**2))
        if len(turns) > 1:
            bound = "its phases meet again after other numbers of turns at other places of the chart"
            raise InvalidValue("vary", names, bound, "vary what leaves the ratio of its rates")
        flat = on_grid.value.reshape(-1, 2 * size**2 + 1)
        matrix, form = flat[:, :-1].reshape(-1, 2, size, size).swapaxes(0, 1)
        error = np.full(len(flat), max(errors) + size * on_grid.error)  # the norm of an error of all entries
        return Monodromy(
            matrix, error, flat[:, -1], None if True in damped else form, max(turns)
        ), on_grid.samples


def _verdicts(motion: Monodromy) -> dict[str, np.ndarray]:
    """Arrays (P,) by name, of P monodromy matrices."""
    found = multipliers_of(motion)
    rate, error = found.growth
    names = ("status", "rate", "error", "radius", "period")
    values = found.verdict, rate, error, found.size[:, 0], motion.period
    return dict(zip(names, map(np.array, values), strict=True))


def _warnings(scene: Scene, status: np.ndarray) -> Iterator[Statement]:
    """Yield what limits the chart."""
    yield from warn_of_left_out(scene)
    if number := int((status == UNDECIDED).sum()):
        said = f"at {counted(number, 'point')} of {status.size} the errors allow either: see status"
        yield Statement(said, kind=TOLERANCE, quantity="undecided", value=number / status.size)
