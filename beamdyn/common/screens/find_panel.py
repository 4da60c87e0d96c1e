"""Panel of a screen: it finds the value of an input for which a result has a wanted value."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from typing import Any

from nicegui import ui

from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.rendering import picture
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.computations import BusyRow, LatestComputation
from beamdyn.common.screens.form_entries import Entries, is_bare, tables_of
from beamdyn.common.screens.open_document import OpenDocument
from beamdyn.common.screens.page_writer import toggle
from beamdyn.common.screens.processes import RunsTasks
from beamdyn.common.screens.screens import Backwards, Screen
from beamdyn.common.screens.sweep_panel import inputs_with_value

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
