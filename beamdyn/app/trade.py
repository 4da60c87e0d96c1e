"""The screen of the trade-off: the time that digits of natural frequencies take, and the cheapest model."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from functools import lru_cache
from time import process_time
from typing import TYPE_CHECKING, Any

import numpy as np
from rich.console import RenderableType

from beamdyn import natural_modes
from beamdyn.analyses.results.cautions import notes_of, warnings_of
from beamdyn.analyses.results.of_studies import diagram_csv, diagram_table
from beamdyn.app.mode_shapes import headline as headline_of_modes
from beamdyn.app.scene_form import DRAGS, read_aside, read_at_speed
from beamdyn.app.scene_screen import left_out_table, scene_screen
from beamdyn.common.drawing.chart import Chart, ChartAxis, ChartCurve, ChartPoints
from beamdyn.common.edge.tables import table
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

_BUDGET = 2.0  # time for all measurements of a diagram [s]
_RUNS = 5  # runs of the chosen model, the shortest of which counts
_KEPT = 8  # scenes whose measurements are kept
_LARGEST, _LEAST = 1.0, 1e-14  # relative errors that are drawn
_ROUNDING = 1e-9  # relative, of a power of ten
_FAMILIES = {"tolerance=": "chosen by tolerance"}  # called so in Python


@dataclass(frozen=True)
class Trade:
    """The model chosen for a tolerance, and measurements of others to compare it with.

    Parameters
    ----------
    digits : int
        Digits to keep.
    modes : Modes
        Natural modes by the model that `tolerance` chooses.
    time : float
        Shortest processor time of the whole call, with the choice of the model [s].
    numerical : Diagram
        Numerical error against time.
    of_physics : Diagram
        Numerical error with model error against time.
    """

    digits: int
    modes: Modes
    time: float
    numerical: Diagram
    of_physics: Diagram

    @property
    def tolerance(self) -> float:
        """Relative error allowed."""
        return 10.0**-self.digits

    def cheapest(self, diagram: Diagram) -> Digit | None:
        """The cheapest measurement with as many digits as asked for; None if none has them."""
        each = (d for d in diagram.per_digit if abs(d.error / self.tolerance - 1) < _ROUNDING)
        return next(each, None)


def solve(tables: Mapping[str, Any]) -> Trade:
    """The chosen model, and measurements of others."""
    digits = int(read_aside(tables, "trade").digits)
    scene, speed, modes = read_at_speed(tables)
    scene = plain_physics(scene)
    found, times = [], []
    for _ in range(_RUNS):
        start = process_time()
        found.append(natural_modes(scene, speed, modes, tolerance=10.0**-digits))
        times.append(process_time() - start)
    return Trade(digits, found[-1], min(times), *_measure(scene, speed, modes))


@lru_cache(maxsize=_KEPT)
def _measure(scene: Scene, speed: float, modes: int) -> tuple[Diagram, Diagram]:
    """Errors against times of models of a scene, which do not depend on the digits that are asked for."""
    return (
        frequency_diagram(scene, np.array([speed]), modes, _BUDGET),
        physics_diagram(scene, speed, modes, _BUDGET),
    )


# Charts -------------------------------------------------------------------------------------------


def charts(answer: Trade, _: float = 0.0) -> Sequence[Chart]:
    """Error against time: the numerical error alone, and with the model error."""
    made = [_chart(answer, answer.numerical, "Error of the numbers")]
    if answer.of_physics.measurements:
        made.append(_chart(answer, answer.of_physics, "Error with that of the model"))
    return made


def _chart(answer: Trade, diagram: Diagram, name: str) -> Chart:
    """Errors against times [ms]; errors outside the chart are drawn at its edge."""
    families: dict[str, list[tuple[float, float]]] = {}
    for m in diagram.measurements:
        if 0 < m.error < np.inf:
            families.setdefault(_FAMILIES.get(m.family, m.family), []).append((m.time, m.error))
    families["Pareto front"] = [(m.time, m.error) for m in diagram.front if m.error > 0]
    curves = []
    for family, points in families.items():
        time, error = np.array(points).reshape(-1, 2).T
        pale = family == "Pareto front"
        error = np.clip(error, _LEAST, _LARGEST)
        curves.append(ChartCurve(family, 1e3 * time, error, pale=pale, points=not pale))
    times, tolerance = [m.time for m in diagram.measurements], answer.tolerance
    ends = 1e3 * np.array([min(times), max(times)])
    limit = ChartCurve(f"tolerance {tolerance:.0e}", ends, np.full(2, tolerance), dashed=True, pale=True)
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
        [*curves, limit],
        [ChartPoints(f"cheapest with {answer.digits} digits", cheapest)] if cheapest else [],
    )


# Tables and files ---------------------------------------------------------------------------------


def tables(answer: Trade) -> Sequence[RenderableType]:
    """The chosen model and the cheapest ones; then all digits, and what the physics leaves out."""
    numbers, physics = answer.cheapest(answer.numerical), answer.cheapest(answer.of_physics)
    n = f"{answer.digits} digit{'s' * (answer.digits > 1)}"
    found = "nothing measured keeps them" if numbers is None else _describe(numbers)
    sentences, diagrams = [f"Cheapest numbers with {n} of this model: {found}."], [answer.numerical]
    if answer.of_physics.measurements:
        least = say_size(min(m.error for m in answer.of_physics.measurements))
        missed = f"nothing measured has them; the least error is {least}"
        found = missed if physics is None else _describe(physics)
        sentences.append(f"Cheapest with {n} in all, the physics included: {found}.")
        diagrams.append(answer.of_physics)
    effects = left_out_table(answer.modes.left_out_effects, "frequencies")
    return [_chosen_table(answer), *sentences, effects, *map(diagram_table, diagrams)]


def _describe(digit: Digit) -> str:
    """A measurement in words: the physics and setting of the model, and its time."""
    physics = "physics as given" if digit.family == "as given" else digit.family
    return f"{physics}, {digit.setting}, in {1e3 * digit.time:.3g} ms"


def _chosen_table(answer: Trade) -> RenderableType:
    """Table of what the tolerance chooses, and its errors, mode by mode."""
    modes, tolerance, rows = answer.modes, answer.tolerance, []
    each = zip(modes.frequency, modes.error, modes.model_error.tolist(), strict=True)
    for i, (frequency, error, of_model) in enumerate(each, 1):
        if not error <= tolerance:
            verdict = "the numbers miss the tolerance"
        elif np.isnan(of_model):
            verdict = "kept by the numbers; that of the model is not known"
        elif of_model <= tolerance:
            verdict = "kept"
        else:
            verdict = "kept by the numbers; the physics misses the tolerance"
        rows.append((str(i), f"{frequency:.10g}", f"{error:.0e}", say_size(of_model), verdict))
    title = (
        f"At {modes.display_units.speed_unit().say(modes.speed)}, tolerance {tolerance:.0e}: "
        f"{modes.provenance.method}, in {1e3 * answer.time:.3g} ms"
    )
    return table(title, ("mode", "frequency [Hz]", "numerical error", "model error", "digits"), rows, (4,))


def rows(answer: Trade) -> Iterator[Sequence[object]]:
    """All measurements: of the numerical error, and of that with the model error."""
    for name, diagram in (("numerical", answer.numerical), ("with_model_error", answer.of_physics)):
        heads, *lines = diagram_csv(diagram)
        if name == "numerical":
            yield "error_of", *heads
        yield from ((name, *line) for line in lines)


def draw(answer: Trade, _: float = 0.0) -> Figure:
    """The diagrams side by side."""
    known = [d for d in (answer.numerical, answer.of_physics) if d.measurements]
    figure = new_figure(6.5 * len(known), 5.0)
    for diagram, ax in zip(known, np.atleast_1d(figure.subplots(1, len(known))), strict=True):
        diagram.plot(ax)
    return note_below(figure, notes_of(answer.modes))


def headline(answer: Trade) -> Iterator[KeyResult]:
    """The cheapest model measured, the time that the chosen one takes, and its errors."""
    digit = answer.cheapest(answer.of_physics if answer.of_physics.measurements else answer.numerical)
    cheapest = "none measured" if digit is None else _describe(digit)
    yield KeyResult("cheapest, physics included", cheapest)
    yield KeyResult("time of the chosen model", number(1e3 * answer.time, "ms"))
    yield from [*headline_of_modes(answer.modes)][1:]


TRADE = scene_screen(
    "Trade",
    "The cheapest model that keeps so many digits of the natural frequencies at a speed.",
    solve,
    ("trade", "operation", "options"),
    tables=tables,
    draw=draw,
    notes=lambda answer: warnings_of(answer.modes, answer.tolerance),
    rows=rows,
    drags=(Drag("trade.digits", 1, 10, 1, ""), Drag("operation.speed", 0.0, 150.0, 1.0, "rad/s"), *DRAGS),
    charts=charts,
    headline=headline,
)
