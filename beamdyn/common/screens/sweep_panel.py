"""Panels of a screen that vary an input: sweeps, and the search for a value that gives a wanted result."""

from __future__ import annotations

import asyncio
import math
import tomllib
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor
from contextlib import suppress
from functools import partial
from time import monotonic
from typing import Any

import numpy as np
from nicegui import ui

from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartCurve, ChartPoints
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.input_sweep import InputSweep, sweep_csv
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import csv_text, picture
from beamdyn.common.edge.varied_inputs import Coordinate, numbers
from beamdyn.common.plots.curves import input_words, panels_of
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.computations import BusyRow, LatestComputation, download
from beamdyn.common.screens.form_entries import Entries, in_unit, is_bare, table_of, tables_of, usual_unit
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_writer import PageWriter, toggle
from beamdyn.common.screens.processes import RunsTasks, TakesTooLong
from beamdyn.common.screens.screens import Backwards, Screen, Sweeps

_FEW = 60  # largest number of values of a sweep for which the points on the curves are marked


def sweep_charts(swept: InputSweep) -> list[Chart]:
    """Make the charts of results over one input, one chart for each unit of the results.

    Points at the bottom of a chart mark values of the input without a result.

    Parameters
    ----------
    swept : InputSweep
        The sweep.
    """
    over = input_words(swept, 0)
    order = np.argsort(swept.values[0], kind="stable")
    x = swept.values[0][order]
    axis = ChartAxis(over, low=float(x[0]), high=float(x[-1])) if len(x) > 1 else ChartAxis(over)
    charts = []
    for heading, names, found in panels_of(swept):
        values = np.where(np.isfinite(found), found, np.nan)[:, order]
        named = [*zip(names, found[:, order], strict=True)]
        curves = [ChartCurve(name, x, y, points=len(x) <= _FEW) for name, y in named]
        foot = float(np.nanmin(values)) if np.isfinite(values).any() else 0.0
        lacking = [
            (place, foot, f"{name}: no answer at {place:.5g}")
            for name, y in named
            for place in x[~np.isfinite(y)].tolist()
        ]
        points = [ChartPoints("no answer", lacking)] if lacking else []
        charts.append(Chart(f"{heading} over {over}", axis, ChartAxis(heading), curves, points))
    return charts


# Suggested number of values of a sweep, and the largest distance of these values from the present value, as a
# fraction of it.
_COUNT, _AROUND = 21, 0.2


_Request = tuple[Entries, str, str]  # field texts, input with values, names of results


class SweepPanel:
    """A foldable panel below the results, which computes results over a varied input.

    Parameters
    ----------
    work : OpenDocument
        The open input file, with its results.
    screen : Screen
        The screen that contains the panel.
    sweeps : Sweeps
        The sweeps that the screen offers.
    solver : RunsTasks
        Object that runs the sweeps in worker processes.
    """

    def __init__(self, work: OpenDocument, screen: Screen, sweeps: Sweeps, solver: RunsTasks) -> None:
        self.work, self.screen, self.sweeps, self._solver = work, screen, sweeps, solver
        self._future: asyncio.Future[page_tasks.Swept] | None = None  # the sweep that is being computed
        self._found: tuple[_Request, InputSweep] | None = None
        self._shown: Entries | None = None
        path, _, values = sweeps.example.partition("=")
        self._fold: Any = ui.expansion("Sweep an input", on_value_change=self.state)
        with self._fold.classes("w-full section").props("dense"):
            with ui.row().classes("w-full"):
                self._input: Any = ui.select(
                    [path], value=path, label="input", with_input=True, on_change=self._suggest
                ).classes("grow")
                self._low, self._high, self._count = map(ui.input, ("from", "to", "how many values"))
            self._write_range(values)
            self._results: Any = ui.select(
                sweeps.results.split(","), value=sweeps.results.split(","), multiple=True, label="results"
            ).classes("w-full")
            with ui.row().classes("items-center"):
                ui.button("Sweep", on_click=self.show).props("no-caps")
                self._busy = BusyRow(self.close, "computing the sweep")
                for kind in ("CSV", "SVG", "PNG"):
                    take = partial(self._download, kind.lower())
                    ui.button(f"Sweep as {kind}", icon="download", on_click=take).props("flat no-caps")
            self._said: Any = ui.label().props('role="alert"').style("white-space: pre-line")
            self._late: Any = ui.label("This sweep is outdated: an input has changed.").classes("status")
            self._good: Any = ui.element("div").classes("w-full")
            with self._good:
                self._charts = ChartBoard(f"{screen.name}: charts of the sweep", PageWriter())

    def state(self) -> None:
        """If the panel is open: update the available inputs and results, and grey an outdated sweep."""
        if not self._fold.value:
            return
        paths, needed = [*self._inputs()], self.work.needed(self.screen)
        self._input.set_options(paths, value=self._input.value if self._input.value in paths else paths[0])
        with suppress(ConfigError):  # an error in the design, which the screen itself shows
            names = [*self.sweeps.names(tables_of(needed, self.work.inputs))]
            kept = [name for name in self._results.value if name in names]
            self._results.set_options(names, value=kept or names[:1])
        stale = self._shown not in (None, needed)
        self._late.set_visibility(stale)
        toggle(self._good, "greyed", stale)

    def _inputs(self) -> dict[str, Input]:
        return inputs_with_value(self.work, self.screen)

    def _suggest(self) -> None:
        """Suggest values around the present value of the chosen input."""
        if (entry := self._inputs().get(self._input.value)) is not None:
            self._write_range(around(entry, self.work.entries))

    def _write_range(self, text: str) -> None:
        """Write a text "start:stop:count unit" into the fields; both limits get the unit."""
        numbers, _, unit = text.partition(" ")
        low, high, count = numbers.split(":")
        for field, shown in (
            (self._low, f"{low} {unit}"),
            (self._high, f"{high} {unit}"),
            (self._count, count),
        ):
            field.set_value(shown.strip())

    @property
    def _range(self) -> str:
        """Return the texts of the fields as "start:stop:count unit".

        If a limit has no unit, it is assumed to have the unit of the other limit.
        """
        (low, _, unit), (high, _, other) = (
            (f.value or "").strip().partition(" ") for f in (self._low, self._high)
        )
        if unit and other and unit.strip() != other.strip():
            low = in_unit(f"{low} {unit}", self._inputs()[self._input.value].quantity, other.strip())
            low = low.partition(" ")[0]
        return f"{low}:{high}:{(self._count.value or '').strip()} {(other or unit).strip()}".strip()

    async def _run(self) -> InputSweep | None:
        """Run the sweep, after stopping a running one; return None and show the reason if it fails."""
        text, names = f"{self._input.value}={self._range}", ",".join(self._results.value)
        request = (self.work.needed(self.screen), text, names)
        if self._found is not None and self._found[0] == request:
            return self._found[1]
        self.close()
        document, entries = self.work.document, dict(self.work.entries)
        future = self._future = self._solver.submit(
            page_tasks.sweep, document, self.screen, entries, text, names
        )
        start = monotonic()
        swept: page_tasks.Swept
        try:
            while not future.done():
                self._busy.show(True, f"{monotonic() - start:.0f} s")
                await asyncio.wait([future], timeout=1.0)
            swept = await future
        except asyncio.CancelledError:
            swept = "Cancelled."
        except (TakesTooLong, BrokenExecutor) as error:
            swept = f"Given up: {error}. Sweep fewer values."
        finally:
            if self._future is future:
                self._future = None
                self._busy.show(False)
        words, kind = (swept, "mistake") if isinstance(swept, str) else ("\n".join(swept.warnings), "warning")
        self._said.set_text(words)
        self._said.classes(add=kind if words else "", remove="mistake warning")
        if isinstance(swept, str):
            return None
        self._found = request, swept
        return swept

    def close(self) -> None:
        """Cancel the sweep that is being computed."""
        if self._future is not None:
            self._future.cancel()

    async def show(self) -> None:
        """Run the sweep and show its charts."""
        if swept := await self._run():
            self._charts.show(sweep_charts(swept))
            self._shown = self._found[0][0] if self._found else None
            self.state()

    def report(self) -> tuple[str, InputSweep] | None:
        """Return title and result of the sweep that is shown; None if there is none, or it is outdated."""
        if self._found is None or self._shown != self.work.needed(self.screen):
            return None
        (_, text, names), swept = self._found
        title = f"Sweep of {self.screen.name}: {names.replace(',', ', ')} over {text}"
        return title, swept

    async def _download(self, kind: str) -> None:
        """Download the rows of the sweep ("csv"), or its picture ("svg" or "png")."""
        swept = await self._run()
        if swept and kind == "csv":
            ui.download.content(csv_text(sweep_csv(swept)).encode(), "sweep.csv")
        elif swept:
            made = self._solver.submit(page_tasks.sweep_file, self.work.document, self.screen, swept, kind)
            await download(made, f"sweep.{kind}")


def inputs_with_value(work: OpenDocument, screen: Screen) -> dict[str, Input]:
    """Return the inputs of a screen that are numbers with a given or default value, by path."""
    known = [i for i in work.inputs if table_of(i.path) in screen.needs]
    there = [i for i in known if work.entries.get(i.path) or i.default is not None]
    return {entry.path: entry for entry in numbers(there)}


def around(entry: Input, entries: Mapping[str, str]) -> str:
    """Return values around the present value of an input, or its default, as "start:stop:count unit"."""
    number, unit = _given(entry, entries)
    low, high = (number * (1 - _AROUND), number * (1 + _AROUND)) if number else (0.0, 1.0)
    return f"{low:.3g}:{high:.3g}:{_COUNT} {unit}".strip()


def _given(entry: Input, entries: Mapping[str, str]) -> tuple[float, str]:
    """Return number and unit of the text in an input's field, or of the input's default."""
    text, default, unit = entries.get(entry.path, ""), entry.default, entry.quantity.unit
    if isinstance(entry, Coordinate):  # a coordinate is one of the two values of a point
        whole: Any = entry.of.default or (0.0, 0.0)
        default = whole[entry.place]
        try:
            point = tomllib.loads(f"value = {entries.get(entry.of.path, '')}")["value"]
            text = str(point[entry.place])
        except (ValueError, RecursionError, LookupError, TypeError):
            text = ""
    number, _, given = text.strip().partition(" ")
    with suppress(ValueError):
        return float(number), given
    if not isinstance(default, int | float) or math.isinf(default):
        return 0.0, unit
    usual = usual_unit(unit)
    number = in_unit(f"{default!r} {unit}", entry.quantity, usual).partition(" ")[0] if unit else default
    return float(number), usual


# Finding the value of an input -------------------------------------------------------------------------


_WITHIN = "from:to:samples unit, such as 10:30:9 km/h; if empty, a tenth to ten times the present value"


class FindPanel:
    """A foldable panel below the results, for inverse questions: which input gives a wanted result.

    Parameters
    ----------
    work : OpenDocument
        The open input file, with its results.
    screen : Screen
        The screen that contains the panel.
    backwards : Backwards
        The inverse questions that the screen offers.
    solver : RunsTasks
        Object that runs the searches in worker processes.
    """

    def __init__(self, work: OpenDocument, screen: Screen, backwards: Backwards, solver: RunsTasks) -> None:
        self.work, self.screen, self.backwards, self._solver = work, screen, backwards, solver
        self._way = LatestComputation(self._settle, self._fail, self._tell)
        self._asked: Entries | None = None  # texts of the form's fields when the last search was started
        self._units: dict[str, str] = {}  # unit of each available result, by its name
        self._fold: Any = ui.expansion("Find an input", on_value_change=self.state)
        with self._fold.classes("w-full section").props("dense"):
            with ui.row().classes("w-full"):
                self._input: Any = self._select("input that is sought", backwards.input)
                self._within: Any = ui.input("within", placeholder=_WITHIN).classes("grow")
            with ui.row().classes("w-full"):
                self._result: Any = self._select("so that the result", backwards.result)
                self._target: Any = ui.input("is").classes("grow")
            with ui.row().classes("items-center"):
                ui.button("Find", on_click=self.ask).props("no-caps")
                self._busy = BusyRow(self.close, "searching")
            self._late: Any = ui.label("This answer is outdated: an input has changed.").classes("status")
            self._found: Any = ui.html("", sanitize=False).classes("w-full shown").props('role="alert"')
        self._tell()

    def _select(self, label: str, chosen: str) -> Any:
        made = ui.select([chosen], value=chosen, label=label, with_input=True, on_change=self._name_unit)
        return made.classes("grow")

    def state(self) -> None:
        """If the panel is open: update the available inputs and results, and grey an outdated result."""
        if not self._fold.value:
            return
        needed = self.work.needed(self.screen)
        self._offer(self._input, [*inputs_with_value(self.work, self.screen)])
        with suppress(ConfigError):  # an error in the design, which the screen itself shows
            self._units = dict(self.backwards.units(tables_of(needed, self.work.inputs)))
            self._offer(self._result, [*self._units])
            self._name_unit()
        stale = self._asked not in (None, needed)
        self._late.set_visibility(stale)
        toggle(self._found, "greyed", stale)

    def _offer(self, select: Any, names: list[str]) -> None:
        select.set_options(names, value=select.value if select.value in names else names[0])

    def _name_unit(self) -> None:
        self._target.props["suffix"] = self._units.get(self._result.value, "")

    def ask(self) -> None:
        """Start the search; its result is shown when it is available."""
        within, target = ((field.value or "").strip() for field in (self._within, self._target))
        unit = self._units.get(self._result.value, "") if is_bare(target) else ""
        sought = f"{self._input.value}={within}" if within else f"{self._input.value}"
        so_that = f"{self._result.value} = {target} {unit}".rstrip()
        self._asked, entries = self.work.needed(self.screen), dict(self.work.entries)
        given = self.work.document, self.screen, entries, sought, so_that
        self._way.want(lambda: self._solver.submit(page_tasks.find, *given))
        self._tell()
        self.state()

    def close(self) -> None:
        """Cancel the running search."""
        self._way.cancel()

    def _tell(self) -> None:
        self._busy.show(self._way.slow, self._way.words)

    def _settle(self, future: asyncio.Future[str], last: bool) -> None:
        """Show the input value that the search has found, or the reason why it found none.

        `future` is that of the finished search; `last` tells whether no newer search was requested.
        """
        if self._found.is_deleted:
            return
        self._tell()
        error = None if future.cancelled() else future.exception()
        if future.cancelled():
            self._found.set_content("<p>Cancelled.</p>")
        elif error is not None:
            self._fail(error)
        else:
            self._found.set_content(future.result())

    def _fail(self, error: BaseException) -> None:
        self._found.set_content(picture(f"Given up: {error}. Give narrower bounds.", ""))
