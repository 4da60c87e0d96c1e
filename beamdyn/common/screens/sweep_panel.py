"""The panel of a screen for parameter sweeps: charts, picture and CSV file of results over an input."""

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
from beamdyn.common.edge.rendering import csv_text
from beamdyn.common.edge.varied_inputs import Coordinate, numbers
from beamdyn.common.plots.curves import input_words, panels_of
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.computations import BusyRow, download
from beamdyn.common.screens.form_entries import Entries, in_unit, table_of, tables_of, usual_unit
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_writer import PageWriter, toggle
from beamdyn.common.screens.processes import RunsTasks, TakesTooLong
from beamdyn.common.screens.screens import Screen, Sweeps

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
