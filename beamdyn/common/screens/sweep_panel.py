"""The panel of a screen that sweeps an input: charts, picture and CSV of the results."""

from __future__ import annotations

import asyncio
import math
import tomllib
from collections.abc import Mapping
from concurrent.futures import BrokenExecutor
from contextlib import suppress
from typing import Any

from nicegui import ui

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.input_sweep import InputSweep, sweep_csv
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import csv_text
from beamdyn.common.edge.varied_inputs import Coordinate, numbers
from beamdyn.common.screens import tasks
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.downloads import download
from beamdyn.common.screens.form_entries import Entries, in_unit, tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.processes import TakesTooLong, TaskTaker
from beamdyn.common.screens.screens import Screen, Sweeps
from beamdyn.common.screens.sweep_charts import sweep_charts

_USUAL = {"m": "mm", "rad": "deg"}  # units where none is given
_COUNT, _AROUND = 21, 0.2  # number of values suggested for a sweep, and their range over the present value


_Request = tuple[Entries, str, str]  # the design, the input with its values, the results


class SweepPanel:
    """A panel below a screen's results that sweeps an input, and can be folded.

    Parameters
    ----------
    work : OpenDocument
        The document.
    screen : Screen
        Which of its screens.
    sweeps : Sweeps
        The sweeps that the screen offers.
    solver : TaskTaker
        Runs the sweeps.
    """

    def __init__(self, work: OpenDocument, screen: Screen, sweeps: Sweeps, solver: TaskTaker) -> None:
        self.work, self.screen, self.sweeps, self._solver = work, screen, sweeps, solver
        self._future: asyncio.Future[tasks.Swept] | None = None  # the sweep that is under way
        self._found: tuple[_Request, InputSweep] | None = None
        self._shown: Entries | None = None
        path, _, values = sweeps.example.partition("=")
        self._fold: Any = ui.expansion("Sweep an input", on_value_change=self.state)
        with self._fold.classes("w-full section").props("dense"):
            with ui.row().classes("w-full"):
                self._input: Any = ui.select(
                    [path], value=path, label="input", with_input=True, on_change=self._suggest
                ).classes("grow")
                self._values: Any = ui.input("start:stop:count unit", value=values).classes("grow")
            self._results: Any = ui.select(
                sweeps.results.split(","), value=sweeps.results.split(","), multiple=True, label="results"
            ).classes("w-full")
            with ui.row().classes("items-center"):
                ui.button("Sweep", on_click=self.show).props("no-caps")
                self._busy: Any = ui.row().classes("items-center")
                with self._busy:
                    ui.spinner(size="sm").props('role="status" aria-label="computing the sweep"')
                    ui.button("Cancel", on_click=self.close).props("outline no-caps")
                self._busy.set_visibility(False)
                for kind in ("CSV", "SVG", "PNG"):
                    ui.button(
                        f"Sweep as {kind}", icon="download", on_click=getattr(self, kind.lower())
                    ).props("flat no-caps")
            self._said: Any = ui.label().props('role="alert"').style("white-space: pre-line")
            self._late: Any = ui.label("An input has changed since: this sweep is stale.").classes("status")
            self._good: Any = ui.element("div").classes("w-full")
            with self._good:
                self._charts = ChartBoard(f"{screen.name}: charts of the sweep", PageWriter())

    def state(self) -> None:
        """While it is open: update the inputs and results offered, and grey a stale sweep."""
        if self._fold.value:
            self._offer()
            stale = self._shown not in (None, self.work.needed(self.screen))
            self._late.set_visibility(stale)
            self._good.classes(add="greyed" if stale else "", remove="" if stale else "greyed")

    def _offer(self) -> None:
        paths = [*self._inputs()]
        self._input.set_options(paths, value=self._input.value if self._input.value in paths else paths[0])
        with suppress(ConfigError):  # then the screen says what is wrong
            names = [*self.sweeps.names(self._tables())]
            kept = [name for name in self._results.value if name in names]
            self._results.set_options(names, value=kept or names[:1])

    def _inputs(self) -> dict[str, Input]:
        """The inputs that have a value, given or by default."""
        entries, needs = self.work.entries, self.screen.needs
        known = [i for i in self.work.inputs if (i.path.partition(".")[0] if "." in i.path else "") in needs]
        there = [i for i in known if entries.get(i.path) or i.default is not None]
        return {entry.path: entry for entry in numbers(there)}

    def _tables(self) -> dict[str, Any]:
        return tables_of(self.work.needed(self.screen), self.work.inputs)

    def _suggest(self) -> None:
        """Suggest values around the present one of the input that has been chosen."""
        if (entry := self._inputs().get(self._input.value)) is not None:
            self._values.set_value(around(entry, self.work.entries))

    async def _run(self) -> InputSweep | None:
        """Run the sweep; None if it fails, with the reason shown."""
        text = f"{self._input.value}={self._values.value}"
        names = ",".join(self._results.value)
        request = (self.work.needed(self.screen), text, names)
        if self._found is not None and self._found[0] == request:
            return self._found[1]
        swept = await self._swept(text, names)
        if isinstance(swept, str):
            self._say(swept, "mistake")
            return None
        self._say("\n".join(swept.warnings), "warning")
        self._found = request, swept
        return swept

    async def _swept(self, text: str, names: str) -> tasks.Swept:
        """The sweep, or why there is none; one that is under way is ended first."""
        self.close()
        document, entries = self.work.document, dict(self.work.entries)
        future = self._future = self._solver.submit(tasks.sweep, document, self.screen, entries, text, names)
        self._busy.set_visibility(True)
        try:
            return await future
        except asyncio.CancelledError:
            return "Cancelled."
        except (TakesTooLong, BrokenExecutor) as error:
            return f"Given up: {error}. Sweep fewer values."
        finally:
            if self._future is future:
                self._future = None
                self._busy.set_visibility(False)

    def close(self) -> None:
        """End the sweep that is under way."""
        if self._future is not None:
            self._future.cancel()

    def _say(self, words: str, kind: str) -> None:
        self._said.set_text(words)
        self._said.classes(add=kind if words else "", remove="mistake warning")

    async def show(self) -> None:
        """Show the sweep."""
        if swept := await self._run():
            self._charts.show(sweep_charts(swept))
            self._shown = self._found[0][0] if self._found else None
            self.state()

    def report(self) -> tuple[str, InputSweep] | None:
        """Title and result of the sweep that is shown; None while there is none, or it is stale."""
        if self._found is None or self._shown != self.work.needed(self.screen):
            return None
        (_, text, names), swept = self._found
        title = f"Sweep of {self.screen.name}: {names.replace(',', ', ')} over {text}"
        return title, swept

    async def csv(self) -> None:
        """Download the rows of the sweep."""
        if swept := await self._run():
            ui.download.content(csv_text(sweep_csv(swept)).encode(), "sweep.csv")

    async def svg(self) -> None:
        """Download its picture as SVG."""
        await self._take("svg")

    async def png(self) -> None:
        """Download its picture as PNG."""
        await self._take("png")

    async def _take(self, kind: str) -> None:
        if swept := await self._run():
            made = self._solver.submit(tasks.sweep_file, self.work.document, self.screen, swept, kind)
            await download(made, f"sweep.{kind}")


def around(entry: Input, entries: Mapping[str, str]) -> str:
    """Values around the present one of an input, as text: start:stop:count unit."""
    number, unit = _given(entry, entries)
    low, high = (number * (1 - _AROUND), number * (1 + _AROUND)) if number else (0.0, 1.0)
    return f"{low:.3g}:{high:.3g}:{_COUNT} {unit}".strip()


def _given(entry: Input, entries: Mapping[str, str]) -> tuple[float, str]:
    """Number and unit of a field's value, or of the default."""
    unit, (text, default) = entry.quantity.unit, _text_and_default(entry, entries)
    number, _, given = text.strip().partition(" ")
    with suppress(ValueError):
        return float(number), given
    if not isinstance(default, int | float) or math.isinf(default):
        return 0.0, unit
    usual = _USUAL.get(unit, unit)
    number = in_unit(f"{default!r} {unit}", entry.quantity, usual).partition(" ")[0] if unit else default
    return float(number), usual


def _text_and_default(entry: Input, entries: Mapping[str, str]) -> tuple[str, Any]:
    """The text of an input's field (of a coordinate its part of the point's text), and the default."""
    if not isinstance(entry, Coordinate):
        return entries.get(entry.path, ""), entry.default
    whole: Any = entry.of.default or (0.0, 0.0)
    return _part(entries.get(entry.of.path, ""), entry.place), whole[entry.place]


def _part(text: str, place: int) -> str:
    """One of the parts of a list in TOML."""
    try:
        return str(tomllib.loads(f"value = {text}")["value"][place])
    except (ValueError, RecursionError, LookupError, TypeError):
        return ""
