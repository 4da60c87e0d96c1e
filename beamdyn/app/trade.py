"""The screen on accuracy and cost: computing time per number of correct digits, and the cheapest model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from operator import itemgetter
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import RenderableType

from beamdyn import natural_modes
from beamdyn.analyses.results.cautions import notes_of, warnings_of
from beamdyn.analyses.results.of_studies import diagram_csv, diagram_table
from beamdyn.app.mode_shapes import headline as headline_of_modes
from beamdyn.app.mode_shapes import quick_headline as quick_headline_of_modes
from beamdyn.app.scene_form import COARSE, DRAGS, coarser, read_aside, read_at_speed
from beamdyn.app.scene_screen import left_out_table, scene_screen
from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartCurve, ChartPoints
from beamdyn.common.edge.console import table
from beamdyn.common.plots.axes_and_lines import note_below
from beamdyn.common.results.one_line import number
from beamdyn.common.results.pictures import new_figure
from beamdyn.common.screens.screen_parts import Drag, KeyResult
from beamdyn.modes.model_error.effect_choice import plain_physics
from beamdyn.modes.model_error.left_out_effects import say_size
from beamdyn.modes.modes import Modes
from beamdyn.scene.scene import Scene
from beamdyn.studies.tradeoffs.frequencies import frequency_diagram, physics_diagram
from beamdyn.studies.tradeoffs.measurements import Diagram, Digit

if TYPE_CHECKING:
    from matplotlib.figure import Figure

# Total computing time of a diagram's measurements [s], for a full and for a preliminary result.
_BUDGET, _SOON = 2.0, 0.05
_RUNS = 5  # number of timed runs of the chosen model; the shortest time counts
# Text in place of a diagram or number that a preliminary result lacks: it follows with the full result.
_FOLLOWS = "follows"
_LATER = Diagram.make(_FOLLOWS, "", "", 0.0, ())
_KEPT = 8  # largest number of scenes whose measurements are stored
_LARGEST, _LEAST = 1.0, 1e-14  # largest and smallest relative error shown
_SAME = 1e-9  # relative difference below which two errors, both powers of ten, count as equal
# Names of families of models on the screen, if they differ from the names in Python.
_FAMILIES = {"tolerance=": "chosen by tolerance"}


@dataclass(frozen=True)
class Trade:
    """The model chosen for a tolerance, and measurements of other models for comparison.

    Parameters
    ----------
    digits : int
        Requested number of correct digits.
    modes : Modes
        Natural modes, computed by the model chosen for `tolerance`.
    time : float
        Shortest processor time of the computation, including the choice of the model [s].
    numerical : Diagram
        Numerical error over computing time.
    of_physics : Diagram
        Error, including the model error, over computing time.
    """

    digits: int
    modes: Modes
    time: float
    numerical: Diagram
    of_physics: Diagram

    @property
    def tolerance(self) -> float:
        """Return the allowed relative error for the requested number of digits."""
        return 10.0**-self.digits

    def cheapest(self, diagram: Diagram) -> Digit | None:
        """Return the fastest measurement with the requested number of digits; None if there is none."""
        each = (d for d in diagram.per_digit if abs(d.error / self.tolerance - 1) < _SAME)
        return next(each, None)


def solve(tables: Mapping[str, Any]) -> Trade:
    """Choose the model for the tolerance, and measure error and time of other models for comparison.

    A preliminary result has few measurements, only of the numerical error, and one run of the chosen model,
    whose time is not shown.
    """
    digits = int(read_aside(tables, "trade").digits)
    scene, speed, modes = read_at_speed(tables)
    scene, coarse = plain_physics(scene), COARSE in tables
    found, times = [], []
    for _ in range(1 if coarse else _RUNS):
        start = process_time()
        found.append(natural_modes(scene, speed, modes, tolerance=10.0**-digits))
        times.append(process_time() - start)
    measured = _numbers(scene, speed, modes, _SOON), _LATER
    return Trade(digits, found[-1], min(times), *(measured if coarse else _measure(scene, speed, modes)))


def _numbers(scene: Scene, speed: float, modes: int, budget: float) -> Diagram:
    return frequency_diagram(scene, np.array([speed]), modes, budget)


@lru_cache(maxsize=_KEPT)
def _measure(scene: Scene, speed: float, modes: int) -> tuple[Diagram, Diagram]:
    """Measure computing time, numerical error and total error (with model error) of alternative models.

    The measurements do not depend on the tolerance of the screen, and are therefore cached.
    """
    return _numbers(scene, speed, modes, _BUDGET), physics_diagram(scene, speed, modes, _BUDGET)


# Charts -------------------------------------------------------------------------------------------


def charts(answer: Trade, _: float = 0.0) -> Sequence[Chart]:
    """Make charts of error over computing time: numerical error, and total error with the model error."""
    each = (answer.numerical, "Numerical error"), (answer.of_physics, "Total error, with the model error")
    return [_chart(answer, d, name) for d, name in each if d.measurements or d.title == _LATER.title]


def _chart(answer: Trade, diagram: Diagram, name: str) -> Chart:
    """Make a chart of errors over times [ms]; errors outside the chart are drawn at its edge."""
    families: dict[str, list[tuple[float, float]]] = {}
    for m in diagram.measurements:
        if 0 < m.error < np.inf:
            families.setdefault(_FAMILIES.get(m.family, m.family), []).append((m.time, m.error))
    families["Pareto front"] = [(m.time, m.error) for m in diagram.front if m.error > 0]
    curves = []
    for family, points in filter(itemgetter(1), families.items()):
        time, error = np.array(points).reshape(-1, 2).T
        pale = family == "Pareto front"
        error = np.clip(error, _LEAST, _LARGEST)
        curves.append(ChartCurve(family, 1e3 * time, error, pale=pale, points=not pale))
    times, tolerance = [m.time for m in diagram.measurements], answer.tolerance
    if times:
        ends, limit = 1e3 * np.array([min(times), max(times)]), np.full(2, tolerance)
        curves.append(ChartCurve(f"tolerance {tolerance:.0e}", ends, limit, dashed=True, pale=True))
    digit, cheapest = answer.cheapest(diagram), []
    for m in diagram.measurements:
        if digit is not None and (m.family, m.setting, m.time) == (digit.family, digit.setting, digit.time):
            words = f"{m.family}, {m.setting}\n{1e3 * m.time:.3g} ms, error {m.error:.0e}"
            cheapest = [(1e3 * m.time, float(np.clip(m.error, _LEAST, _LARGEST)), words)]
            break
    return Chart(
        f"{name}: {diagram.title.removeprefix('physics: ')}",
        ChartAxis("time", "ms", logarithmic=True),
        ChartAxis("relative error", logarithmic=True, high=_LARGEST),
        curves,
        [ChartPoints(f"cheapest with {answer.digits} digits", cheapest)] if cheapest else [],
    )


# Tables and files ---------------------------------------------------------------------------------


def tables(answer: Trade) -> Sequence[RenderableType]:
    """Make tables of the chosen model, the cheapest model per number of digits, and neglected effects."""
    numbers, physics = answer.cheapest(answer.numerical), answer.cheapest(answer.of_physics)
    n = f"{answer.digits} digit{'s' * (answer.digits > 1)}"
    found = "no measured setting" if numbers is None else _describe(numbers)
    sentences = [f"Cheapest with {n} correct, the model error not counted: {found}."]
    diagrams = [answer.numerical]
    if answer.of_physics.measurements:
        least = say_size(min(m.error for m in answer.of_physics.measurements))
        missed = f"no measured setting; the least error is {least}"
        found = missed if physics is None else _describe(physics)
        sentences.append(f"Cheapest with {n} correct, the model error included: {found}.")
        diagrams.append(answer.of_physics)
    effects = left_out_table(answer.modes.left_out_effects, "frequencies")
    return [_chosen_table(answer), *sentences, effects, *map(diagram_table, diagrams)]


def _describe(digit: Digit) -> str:
    """Describe a measurement: physical effects and settings of the model, and computing time."""
    physics = "physics as given" if digit.family == "as given" else digit.family
    return f"{physics}, {digit.setting}, in {1e3 * digit.time:.3g} ms"


def _chosen_table(answer: Trade) -> RenderableType:
    """Make a table of the modes of the chosen model, with their errors."""
    modes, tolerance, rows = answer.modes, answer.tolerance, []
    each = zip(modes.frequency, modes.error, modes.model_error.tolist(), strict=True)
    for i, (frequency, error, of_model) in enumerate(each, 1):
        if not error <= tolerance:
            verdict = "the numerical error exceeds the tolerance"
        elif np.isnan(of_model):
            verdict = "numerically correct; the model error is not known"
        elif of_model <= tolerance:
            verdict = "correct"
        else:
            verdict = "numerically correct; the model error exceeds the tolerance"
        rows.append((str(i), f"{frequency:.10g}", f"{error:.0e}", say_size(of_model), verdict))
    title = (
        f"At {modes.display_units.speed_unit().say(modes.speed)}, tolerance {tolerance:.0e}: "
        f"{modes.provenance.method}, in {1e3 * answer.time:.3g} ms"
    )
    return table(title, ("mode", "frequency [Hz]", "numerical error", "model error", "digits"), rows, (4,))


def rows(answer: Trade) -> Iterator[Sequence[object]]:
    """Yield rows of all measurements, first with the numerical error, then with the total error."""
    for name, diagram in (("numerical", answer.numerical), ("with_model_error", answer.of_physics)):
        heads, *lines = diagram_csv(diagram)
        if name == "numerical":
            yield "error_of", *heads
        yield from ((name, *line) for line in lines)


def draw(answer: Trade, _: float = 0.0) -> Figure:
    """Draw the diagrams of numerical error and of total error over computing time, side by side."""
    known = [d for d in (answer.numerical, answer.of_physics) if d.measurements]
    figure = new_figure(6.5 * len(known), 5.0)
    for diagram, ax in zip(known, np.atleast_1d(figure.subplots(1, len(known))), strict=True):
        diagram.plot(ax)
    return note_below(figure, notes_of(answer.modes))


def headline(answer: Trade) -> Iterator[KeyResult]:
    """Yield the cheapest measured model, the computing time of the chosen model, and its errors."""
    digit = answer.cheapest(answer.of_physics if answer.of_physics.measurements else answer.numerical)
    cheapest = "none measured" if digit is None else _describe(digit)
    yield from _of_times(cheapest, number(1e3 * answer.time, "ms"))
    yield from [*headline_of_modes(answer.modes)][1:]


def quick_headline(answer: Trade) -> Iterator[KeyResult]:
    """Yield the numerical error, and placeholders for results whose computation takes long."""
    yield from _of_times(_FOLLOWS, _FOLLOWS)
    yield from [*quick_headline_of_modes(answer.modes)][1:]
    yield KeyResult("model error at most", _FOLLOWS)


def _of_times(cheapest: str, time: str) -> Iterator[KeyResult]:
    """Yield the two results that need many timed runs: cheapest model, and time of the chosen model."""
    yield KeyResult("cheapest, physics included", cheapest)
    yield KeyResult("time of the chosen model", time)


TRADE = scene_screen(
    "Trade",
    "The cheapest model with a given number of correct digits of the natural frequencies at a speed.",
    solve,
    ("trade", "operation", "options"),
    tables=tables,
    draw=draw,
    notes=lambda answer: warnings_of(answer.modes, answer.tolerance),
    rows=rows,
    drags=(Drag("trade.digits", 1, 10, 1, ""), Drag("operation.speed", 0.0, 150.0, 1.0, "rad/s"), *DRAGS),
    charts=charts,
    headline=headline,
    quick_headline=quick_headline,
    coarser=coarser,
)
