"""One screen on the page: the form on the left, the results on the right."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from concurrent.futures import Future
from functools import partial
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.app.draggable_drawing import DraggableDrawing
from beamdyn.common.app.folded_drawing import FoldedDrawing
from beamdyn.common.app.form import Form
from beamdyn.common.app.form_entries import Entries
from beamdyn.common.app.handles import Place, changed_texts, describe_place, draw_sheet
from beamdyn.common.app.open_document import OpenDocument, OpenEntries
from beamdyn.common.app.screens import Handle, Screen
from beamdyn.common.app.sweep_panel import SweepPanel
from beamdyn.common.app.threads import in_thread
from beamdyn.common.edge.rendering import csv_text, html, png

SOON = 0.3  # how long the page waits for an answer before it goes on without [s]


class ScreenView:
    """The view of one screen of an open document.

    Parameters
    ----------
    work : OpenDocument
        The document.
    screen : Screen
        Which of its screens.
    edited : callable
        Called after a field of this screen has changed.
    """

    def __init__(self, work: OpenDocument, screen: Screen, edited: Callable[[], object]) -> None:
        self.work, self.screen, self._edited = work, screen, edited
        self._drawn = ""
        self._newest: OpenEntries | None = None  # until it has been solved
        self._awaits: asyncio.Task[None] | None = None  # an answer that did not come soon
        with ui.element("div").classes("screen"):
            self._left: Any = ui.column().classes("left gap-1")
            with ui.column().classes("right gap-2"):
                self._results()
        self.rebuild()

    def _results(self) -> None:
        ui.label(self.screen.purpose).classes("text-body2")
        self._status: Any = ui.label().classes("status").props('role="status" aria-live="polite"')
        self._said: Any = ui.column().classes("gap-1 w-full").props('role="alert"')
        self._good: Any = ui.column().classes("w-full gap-2 shown")
        with self._good:
            self._slider()
            self.board = DraggableDrawing(f"{self.screen.name}: drawing of the result", self._moved)
            self._tables: Any = ui.html("", sanitize=False).classes("w-full")
            self._more = [FoldedDrawing(title, draw) for title, draw in self.screen.more]
        self._exports()
        sweeps = self.screen.sweeps
        self._sweep = None if sweeps is None else SweepPanel(self.work, self.screen, sweeps)

    def _slider(self) -> None:
        slider = self.screen.slider
        self._at: Any = None
        if slider is None:
            return
        marks = ", ".join(f"{i}: '{mark}'" for i, mark in enumerate(slider.marks))
        last = self.screen.last
        self._at = ui.slider(min=0, max=last, step=slider.step, value=last, on_change=self._draw)
        self._at.props(f'aria-label="{slider.label}" :marker-labels="{{{marks}}}" markers=1').classes(
            "slider"
        )

    def _exports(self) -> None:
        with ui.row().classes("gap-2"):
            for kind, make in (("SVG", self._svg), ("PNG", self._png), ("CSV", self._csv)):
                ui.button(f"{kind}", on_click=make, icon="download").props(
                    f'flat dense no-caps aria-label="download {self.screen.name} as {kind}"'
                )

    def rebuild(self) -> None:
        """Make the form again, for instance after another file has been opened."""
        self._left.clear()
        with self._left:
            self.form = Form(
                self.work.inputs, self.screen.sections, self.work.entries, self._changed, self.screen.drags
            )
        self._shape = [entry.path for entry in self.work.inputs]
        self.form.mark(self.work.mistakes.get(self.screen.name, {}))
        self.state()

    def _changed(self, path: str, text: str) -> None:
        if self.work.entries.get(path) == text:
            return  # written by a point of the drawing that was moved
        self.work.put(path, text)
        if not self._has_shape:
            self.rebuild()
        self.solve()
        self._edited()

    def enter(self) -> None:
        """Come to the front: show what other screens have written, and solve if the answer shown is stale."""
        if not (self._has_shape and self.form.shows(self.work.entries)):
            self.rebuild()
        if self.work.stale(self.screen) or self.work.mistakes.get(self.screen.name) or not self._drawn:
            self.solve()

    @property
    def _has_shape(self) -> bool:
        """Whether the form has a field for each input that there is now."""
        return [entry.path for entry in self.work.inputs] == self._shape

    def solve(self) -> None:
        """Solve and show the answer: at once where it comes soon, else when it comes; the last one is greyed.

        What changes meanwhile is solved next, its last state alone.
        """
        self._newest = self.work.attempt(self.screen)
        if self._awaits is None:
            future = in_thread(self._newest.solve)
            try:
                self._settle(future.result(SOON))
            except TimeoutError:
                self._awaits = background_tasks.create(self._await(self._newest, future))
                self.form.mark({})  # it is no quick mistake
        self.state()

    async def _await(self, attempt: OpenEntries, future: Future[Any]) -> None:
        """Show the answer to the newest entries when it comes."""
        try:
            outcome = await asyncio.wrap_future(future)
            while self._newest is not None and self._newest != attempt:
                attempt = self._newest
                outcome = await asyncio.wrap_future(in_thread(attempt.solve))
        finally:
            self._awaits = None
            if not self._left.is_deleted:
                self.state()  # also where a point that was moved has been answered meanwhile
        if self._newest is not None and not self._left.is_deleted:
            self._settle(outcome)
            self._edited()

    async def settled(self) -> None:
        """Wait until the present entries have been solved."""
        if self._awaits is not None:
            await asyncio.wait([self._awaits])

    def _settle(self, outcome: Any) -> None:
        self.work.keep(self.screen, outcome)
        self._tell()

    def _tell(self) -> None:
        """Show the answer; or say why there is none, and leave the last one, greyed."""
        self._newest = None
        mistakes = self.work.mistakes[self.screen.name]
        self.form.mark(mistakes)
        if not mistakes:
            self._show()
        self.state()
        self._say(mistakes)

    def state(self) -> None:
        """Grey the answer shown while it is stale, and say when another is on its way."""
        stale = self.work.stale(self.screen)
        self._good.classes(add="greyed" if stale else "", remove="" if stale else "greyed")
        failed = self.work.mistakes.get(self.screen.name)
        words = (
            "Below is the last good result." if self.work.answered.get(self.screen.name) else "No result yet."
        )
        later = "An input has changed since: this result is stale."
        now = (words if failed else later) if stale else "Up to date."
        self._status.set_text(f"Computing. {words if stale else ''}".strip() if self._awaits else now)
        if self._sweep is not None:
            self._sweep.state()

    def _say(self, mistakes: dict[str, list[str]]) -> None:
        """Show the mistakes outside this form, and the warnings of the answer."""
        self._said.clear()
        answered = self.work.answered.get(self.screen.name)
        elsewhere = [s for path, said in mistakes.items() if path not in self.form.fields for s in said]
        warnings = answered.notes if answered and not mistakes else ()
        with self._said:
            for sentence in elsewhere:
                ui.label(sentence).classes("mistake")
            for sentence in dict.fromkeys(warnings):
                ui.label(f"Warning: {sentence}").classes("warning")

    def _show(self) -> None:
        answered = self.work.answered[self.screen.name]
        self._tables.set_content(html(answered.tables))
        self._draw()
        if self.board.held is None:  # while a point is moved, its drawing alone follows
            for more in self._more:
                more.show(answered.answer)

    def _draw(self) -> None:
        answered = self.work.answered.get(self.screen.name)
        if answered is None:
            return
        made = draw_sheet(self.screen, answered.answer, self.progress, self.board.held)
        self._drawn = made.text
        self.board.show(made, partial(describe_place, entries=self.work.entries, inputs=self.work.inputs))

    def _moved(self, handle: Handle, target: Place, done: bool) -> None:
        """Write the new place of a handle into the fields, and solve."""
        texts = changed_texts(handle, target, self.work.entries, self.work.inputs)
        if texts:
            self._write(texts)
        if done and (not texts or self.work.mistakes.get(self.screen.name)):
            self._show()  # all of what it shows again, where there is no new answer

    def _write(self, texts: Entries) -> None:
        """Write into several fields and solve once."""
        for path, text in texts.items():
            self.work.put(path, text)
        for path, text in texts.items():
            self.form.fields[path].set_value(text)
        self.work.solve(self.screen)  # waited for: the point is held
        self._tell()
        mistakes = self.work.mistakes[self.screen.name]
        if "" in mistakes:  # about no single field: about those written
            self.form.mark(mistakes | dict.fromkeys(texts, mistakes[""]))
        self._edited()

    @property
    def progress(self) -> float:
        """Place of the slider."""
        return float(self._at.value) if self._at is not None else self.screen.last

    async def _svg(self) -> None:
        await self.settled()
        ui.download.content(self._drawn.encode(), f"{self._name}.svg")

    async def _png(self) -> None:
        await self.settled()
        if answered := self.work.answered.get(self.screen.name):
            ui.download.content(png(self.screen.draw(answered.answer, self.progress)), f"{self._name}.png")

    async def _csv(self) -> None:
        await self.settled()
        if answered := self.work.answered.get(self.screen.name):
            ui.download.content(csv_text(self.screen.rows(answered.answer)).encode(), f"{self._name}.csv")

    @property
    def _name(self) -> str:
        return self.screen.name.lower().replace(" ", "-")
