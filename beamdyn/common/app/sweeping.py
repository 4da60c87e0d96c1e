"""Sweeps on the page: an input of a screen against its results, as a picture and as a file."""

from __future__ import annotations

from typing import Any

from nicegui import ui

from beamdyn.common.app.documents import Screen, Sweeps
from beamdyn.common.app.entries import tables_of
from beamdyn.common.app.session import Work
from beamdyn.common.app.shown import csv_text, picture, svg


class SweepPanel:
    """A folded panel below a screen's results."""

    def __init__(self, work: Work, screen: Screen, sweeps: Sweeps) -> None:
        self.work, self.screen, self.sweeps = work, screen, sweeps
        self._found: Any = None
        with ui.expansion("Sweep an input").classes("w-full section").props("dense"):
            self._text: Any = ui.input("input=start:stop:count unit", value=sweeps.example).classes("w-full")
            self._results: Any = ui.select(
                list(sweeps.names), value=sweeps.results.split(","), multiple=True, label="results"
            ).classes("w-full")
            with ui.row():
                ui.button("Sweep", on_click=self._run).props("no-caps")
                ui.button("Sweep as CSV", icon="download", on_click=self._csv).props("flat no-caps")
                ui.button("Sweep as SVG", icon="download", on_click=self._svg).props("flat no-caps")
            self._said: Any = ui.label().classes("mistake").props('role="alert"')
            self._picture: Any = ui.html("", sanitize=False).classes("w-full")

    def _run(self) -> bool:
        tables = tables_of(self.work.needed(self.screen), self.work.inputs)
        try:
            self._found = self.sweeps.run(tables, self._text.value, ",".join(self._results.value))
            self._drawn = svg(self.sweeps.draw(self._found))
        except (ValueError, ArithmeticError) as error:
            self._said.set_text(str(error))
            return False
        self._said.set_text("")
        self._picture.set_content(
            picture(self._drawn, f"{self._text.value}: {', '.join(self._results.value)}")
        )
        return True

    def _csv(self) -> None:
        if self._run():
            ui.download.content(csv_text(self.sweeps.rows(self._found)), "sweep.csv")

    def _svg(self) -> None:
        if self._run():
            ui.download.content(self._drawn, "sweep.svg")
