"""One screen on the page: the form on the left, the results on the right."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from dataclasses import replace
from functools import partial
from html import escape
from time import monotonic
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import html
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.compared_designs import with_other_curves
from beamdyn.common.screens.computations import LatestComputation, download
from beamdyn.common.screens.controls import BranchChoice, Player
from beamdyn.common.screens.draggable_drawing import DraggableDrawing
from beamdyn.common.screens.find_panel import FindPanel
from beamdyn.common.screens.form import Form
from beamdyn.common.screens.form_entries import Entries, options_of
from beamdyn.common.screens.handles import Place, Viewport, changed_texts, describe_place, draw_sheet
from beamdyn.common.screens.list_editor import ListEditor
from beamdyn.common.screens.open_document import OpenDocument, ShownAnswer
from beamdyn.common.screens.page_tasks import at_fault, outcome_of
from beamdyn.common.screens.page_writer import PageWriter, toggle
from beamdyn.common.screens.panels import (
    ComparisonPanel,
    FoldedPanel,
    PicturePanel,
    SketchPanel,
    headline_of,
)
from beamdyn.common.screens.processes import RunsTasks, Task
from beamdyn.common.screens.screen_parts import Handle
from beamdyn.common.screens.screens import Screen
from beamdyn.common.screens.sweep_panel import SweepPanel

_NOT_SHOWN = "The answer cannot be shown, for a reason that the program does not know: {!r}"
_STALE = "Stale: for the entries before."
_CHARTS_APART = 0.1  # pictures of charts beside a drawing that moves: a browser takes 5 to 10 ms for each [s]


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
    solver : RunsTasks
        Solver that makes the answers.
    """

    def __init__(
        self, work: OpenDocument, screen: Screen, edited: Callable[[], object], solver: RunsTasks
    ) -> None:
        self.work, self.screen, self._edited, self._solver = work, screen, edited, solver
        self.narrow = False  # the page, so that drawings have narrow paper
        self._drawn = False
        self._sentences: list[tuple[str, str]] = []  # that are shown, with their classes
        self._way = LatestComputation(self._settle, self._fail, self.state)
        self._holds = False  # a slider of the form
        self._charted = 0.0  # when the charts were shown last [s]
        self._player: Player | None = None
        self._writer = PageWriter(lambda: self.dragged or (self._player is not None and self._player.moves))
        self._partial = False  # whether the tables shown are those of an answer before
        self._sketch: SketchPanel | None = None
        with ui.element("div").classes("screen"):
            self._left: Any = ui.column().classes("left gap-1")
            with ui.column().classes("right gap-2"):
                self._make_head()
                self._make_results()
        self._shape: list[str] | None = None  # its form is made when it comes to the front: pages open sooner
        self.state()

    def _make_head(self) -> None:
        self._head: Any = ui.column().classes("head")
        with self._head:
            with ui.row().classes("titled"):
                ui.html(escape(self.screen.name), tag="h2", sanitize=False)
                self._make_downloads()
            ui.label(self.screen.purpose).classes("text-body2")
            self._headline: Any = ui.html("", sanitize=False).classes("w-full")
            with ui.row().classes("items-center gap-2"):
                self._status: Any = ui.label().classes("status").props('role="status" aria-live="polite"')
                ui.label(_STALE).classes("newer")
                self._busy: Any = ui.row().classes("items-center gap-2")
                with self._busy:
                    ui.spinner(size="sm").props('aria-hidden="true"')
                    self._time: Any = ui.label().classes("status")
                    ui.button("Cancel", on_click=self._way.cancel).props("dense outline no-caps size=sm")
            self._said: Any = ui.column().classes("said gap-1 w-full").props('role="alert"')

    def _make_downloads(self) -> None:
        with ui.row().classes("gap-2"):
            for kind in ("SVG", "PNG", "CSV"):
                button = ui.button(kind, on_click=partial(self._download, kind.lower()), icon="download")
                button.props(f'flat dense no-caps aria-label="download {self.screen.name} as {kind}"')

    def _make_results(self) -> None:
        screen, name = self.screen, self.screen.name
        self._made: list[PicturePanel] = []  # parts that other processes make
        self._good: Any = ui.element("div").classes("w-full shown")
        with self._good:
            with ui.column().classes("pictures gap-2"):
                if screen.slider is not None:  # it draws to the same scale
                    self._player = Player(screen.slider, self._writer, lambda: self._draw(self.board.view))
                self._branch = BranchChoice(self._draw)
                self.board = DraggableDrawing(f"{name}: drawing of the result", self._moved, self._writer)
                self._charts = ChartBoard(f"{name}: charts of the result", self._writer)
                if screen.picture is not None:
                    self._made.append(PicturePanel(self._make_picture))
            with ui.column().classes("numbers gap-2"):
                self.comparison = ComparisonPanel(self.work, screen)
                self._tables: Any = ui.html("", sanitize=False).classes("w-full tables")
                self._made += [
                    FoldedPanel(part.title, lambda answer, i=i: self._make(page_tasks.folded, answer, i))
                    for i, part in enumerate(screen.more)
                ]
        with ui.column().classes("after w-full gap-2"):
            sweeps, backwards, known = screen.sweeps, screen.backwards, (self.work, screen)
            self.sweep = None if sweeps is None else SweepPanel(*known, sweeps, self._solver)
            find = None if backwards is None else FindPanel(*known, backwards, self._solver)
            self._asking = [panel for panel in (self.sweep, find) if panel is not None]

    # The form -----------------------------------------------------------------------------------------

    def rebuild(self) -> None:
        """Make the form again, for instance after another file has been opened."""
        shown = not self.narrow if self._sketch is None else self._sketch.shown
        work, lists, fielded = self.work, self.screen.lists, self._fielded
        self._left.clear()
        with self._left:
            self._sketch = SketchPanel(self.screen.sketch, work.entries, shown)
            self._lists = (
                None if lists is None else ListEditor(lists, lambda: work.entries, self._listed, self._writer)
            )
            self.form = Form(work, self.screen, fielded, self._changed, self._hold, self._writer)
        self._shape = [entry.path for entry in fielded]
        self._choices = {entry.path for entry in fielded if options_of(entry)}
        self.form.mark(at_fault(work, self.screen))
        self.form.hide(work.idle)
        self.state()

    @property
    def _fielded(self) -> list[Input]:
        """Descriptions of the inputs that have a field of the form: all that are not in lists."""
        lists = self.screen.lists
        return [entry for entry in self.work.inputs if lists is None or not lists.covers(entry.path)]

    @property
    def _has_shape(self) -> bool:
        """Whether the form has a field for each input that there is now."""
        return [entry.path for entry in self._fielded] == self._shape

    def _listed(self, entries: Entries) -> None:
        """Something in the lists has changed."""
        self.work.show(entries)
        self._put_entries()
        self.solve()
        self._edited()

    def _changed(self, path: str, text: str) -> None:
        if self.work.entries.get(path) == text:
            return  # written by a point of the drawing that was moved
        self.work.put(path, text)
        if not self._has_shape:
            self.rebuild()
        elif self._sketch is not None and path in self._choices:
            self._sketch.show(self.work.entries)
        self.form.hide(self.work.idle)
        self.solve(held=self._holds)
        if not self._holds:  # what is written on the way is neither stored nor told to other screens
            self._edited()

    def _hold(self, held: bool) -> None:
        """A slider of the form has been taken hold of; or let go, and then all is solved."""
        self._holds = held
        if not held:
            self.solve()
            self._edited()

    def enter(self) -> None:
        """Come to the front: show what other screens have written, and solve if the answer shown is stale."""
        self._put_entries()
        if self._lists is not None:
            self._lists.show(self.work.entries)
        stale = self._partial or self.work.stale(self.screen)
        if stale or self.work.mistakes.get(self.screen.name) or not self._drawn:
            self.solve()

    def _put_entries(self) -> None:
        """Make the entries stand in the form, which is made again only if its fields are others."""
        if not self._has_shape:
            return self.rebuild()
        self.form.put(self.work.entries)
        self.form.hide(self.work.idle)
        if self._sketch is not None:
            self._sketch.show(self.work.entries)

    # Answers ------------------------------------------------------------------------------------------

    @property
    def _answered(self) -> ShownAnswer | None:
        """The latest answer."""
        return self.work.answered.get(self.screen.name)

    def _make(self, task: Task, *given: Any) -> asyncio.Future[Any]:
        """Have something made for this screen."""
        return self._solver.submit(task, self.work.document, self.screen, *given)

    def _make_picture(self, answer: Any) -> asyncio.Future[Any]:
        return self._make(page_tasks.picture_part, answer, self.narrow)

    def solve(self, held: bool = False) -> None:
        """Have the present entries solved, and the answer shown when it comes; the last one stays until then.

        What changes meanwhile is solved next, its last state alone.

        Parameters
        ----------
        held : bool
            Whether something is being dragged: then as far as the drawing shows it.
        """
        task = page_tasks.solve_for_drawing if held and self._answered else page_tasks.solve
        self._way.want(partial(self._make, task, dict(self.work.entries)))
        self.state()

    async def settled(self) -> None:
        """Wait until the present entries have been solved."""
        await self._way.done()

    def close(self) -> None:
        """End what is under way: the page is gone."""
        for more in self._made:
            more.close()
        self._way.cancel()
        for panel in self._asking:
            panel.close()

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        """Show an answer; or say why there is none to the newest entries, and leave the last one, greyed."""
        if self._left.is_deleted:
            return
        outcome, before = outcome_of(future, self.work, self.screen), self._answered
        if not last and not isinstance(outcome, ShownAnswer):
            return
        if last:
            self.board.forget_steps()
        if isinstance(outcome, ShownAnswer):
            self._partial = before is not None and not outcome.tables
            if before is not None and self._partial:  # made for a drawing alone: it keeps what stood there
                outcome = replace(outcome, tables=before.tables, notes=before.notes)
        self.work.keep(self.screen, outcome)
        mistakes = at_fault(self.work, self.screen)
        self.form.mark(mistakes)
        if not mistakes or (not self.dragged and "waits" in self._tables.classes):
            self.show()
        self.state()
        self._show_sentences(mistakes)
        if not self.dragged:
            self._writer.synchronize()  # not before: the page would be rendered twice
            self._edited()

    def _fail(self, error: Exception) -> None:
        """Say that an answer cannot be shown; what stands there may be parts of it."""
        self.work.answered.pop(self.screen.name, None)
        self.work.mistakes[self.screen.name] = mistakes = {"": [_NOT_SHOWN.format(error)]}
        self.state()
        self._writer.synchronize()
        self._show_sentences(mistakes)

    def state(self) -> None:
        """Say whether the answer shown is the present one, and grey it where another one takes its time."""
        busy, slow, held = self._way.busy, self._way.slow, self.dragged
        stale = self.work.stale(self.screen) or (self._partial and not held)
        failed = bool(self.work.mistakes.get(self.screen.name))
        follows = held and not (failed or slow)
        toggle(self._head, "stale", stale and not follows)
        toggle(self._good, "greyed", stale and (slow or failed or not busy))
        toggle(self._good, "refused", stale and failed)
        self._busy.set_visibility(slow)
        self._time.set_text(self._way.words)
        words = _STALE if self._answered else "No result yet."
        state = "Computing. " if busy else "Refused. " if failed else ""
        now = f"{state}{words}" if stale else state.strip() or "Up to date."
        self._status.set_text("The drawing follows; the tables wait." if follows else now)
        for panel in self._asking:
            panel.state()

    def _show_sentences(self, mistakes: dict[str, list[str]]) -> None:
        """Show the mistakes outside this form, and the warnings of the answer."""
        answered, fields = self._answered, self.form.fields
        each = [(said, path in fields) for path, sentences in mistakes.items() for said in sentences]
        sentences = [(said, "mistake") for said, at_field in each if not at_field]
        sentences += [(said, "mistake at-field") for said, at_field in each if at_field]
        if answered and not mistakes:
            sentences += [(note, "warning") for note in answered.notes]
        if sentences == self._sentences:
            return
        self._sentences = sentences
        self._said.clear()
        with self._said:
            for said, kind in dict.fromkeys(sentences):
                shown = ui.label(f"Warning: {said}" if kind == "warning" else said).classes(kind)
                if kind == "warning":  # its first line; all of it when it is pointed at or has the focus
                    shown.props("tabindex=0")

    # What is shown ------------------------------------------------------------------------------------

    @property
    def dragged(self) -> bool:
        """Whether a point or a slider of the form is held."""
        return self._holds or self.board.held is not None

    @property
    def progress(self) -> float:
        """Place of the slider above the drawing."""
        return self.screen.last if self._player is None else self._player.place

    def show(self) -> None:
        """Show the latest answer, and the design that it is compared with."""
        answered, held = self._answered, self.dragged
        if answered is None:
            return
        with self._writer.writing(self._headline, self._good):
            self._headline.set_content(headline_of(self.work, self.screen, answered))
            self._good.props["data-solved"] = f"{crc32(repr(answered.entries).encode()):08x}"
        self._draw()
        toggle(self._tables, "waits", held)
        if not held:  # while a point is moved, its drawing alone follows
            self._tables.set_content(html(answered.tables))
            self.comparison.show(answered)
            for more in self._made:
                more.show(answered.answer)

    def be_narrow(self, narrow: bool) -> None:
        """Draw on narrow paper from now on, or on wide."""
        if narrow == self.narrow:
            return
        self.narrow = narrow
        if narrow and self._sketch is not None:
            self._sketch.fold()
        self._draw()
        if self.screen.picture is not None and self._answered is not None:
            self._made[0].show(self._answered.answer)

    def _draw(self, view: Viewport | None = None) -> None:
        """Draw the latest answer; charts beside a drawing that moves follow at their own rate."""
        answered, screen, place = self._answered, self.screen, self.progress
        if answered is None:
            return
        answer, there = self._drawn_answer(answered), self.work.other_answer(screen)
        name = self.work.other.name if self.work.other else ""
        other = () if there is None else screen.drawings(there.answer, place)
        made = draw_sheet(screen, answer, place, self.board.held or view, other, name, self.narrow)
        self._drawn = True
        plays = self._player is not None and self._player.plays
        moves = plays or (self.dragged and made.view is not None)
        if screen.charts is not None and (not moves or monotonic() - self._charted >= _CHARTS_APART):
            self._charted = monotonic()
            charts = screen.charts(answer, place)
            if there is not None:
                charts = with_other_curves(charts, screen.charts(there.answer, place), name)
            self._charts.show(charts)
        self.board.show(made, partial(describe_place, entries=self.work.entries, inputs=self.work.inputs))

    def _drawn_answer(self, answered: ShownAnswer) -> Any:
        """The answer, with the branch drawn that is chosen."""
        return self._branch.choose(answered.answer, self.screen.branches(answered.answer))

    def _moved(self, handle: Handle, target: Place, done: bool) -> None:
        """Write the new place of a handle into the fields, and solve."""
        if self._player is not None:
            self._player.pause()
        texts = changed_texts(handle, target, self.work.entries, self.work.inputs)
        for path, text in texts.items():
            self.work.put(path, text)
        self.form.write(texts)
        if self._lists is not None:  # what is missing is told at rest
            (self._lists.show if done else self._lists.follow)(self.work.entries)
        if texts or done:
            self.solve(held=not done)
            if done:
                self._edited()

    async def _download(self, kind: str) -> None:
        """Download the drawing, as "svg" or "png", or the numbers, as "csv"."""
        await self.settled()
        if answered := self._answered:
            if kind == "csv":
                made = self._make(page_tasks.rows_file, answered.answer)
            else:
                made = self._make(page_tasks.drawing_file, self._drawn_answer(answered), self.progress, kind)
            await download(made, f"{self.screen.name.lower().replace(' ', '-')}.{kind}")
