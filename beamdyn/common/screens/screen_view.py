"""A screen on the page: the form on the left, the results on the right."""

from __future__ import annotations

import asyncio
from collections.abc import Callable
from contextlib import nullcontext
from dataclasses import replace
from functools import partial
from html import escape
from time import monotonic
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import html
from beamdyn.common.results.one_line import few_digits
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.computations import BusyRow, LatestComputation, download
from beamdyn.common.screens.controls import BranchChoice, Player
from beamdyn.common.screens.draggable_drawing import DraggableDrawing
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
    with_other_curves,
)
from beamdyn.common.screens.processes import RunsTasks, Task
from beamdyn.common.screens.screen_parts import Handle
from beamdyn.common.screens.screens import Screen
from beamdyn.common.screens.sweep_panel import FindPanel, SweepPanel

_NOT_SHOWN = "The answer cannot be shown, for a reason that the program does not know: {!r}"
_NO_FILE = "No file is made: the present inputs have no complete answer; the messages on the screen say why."
_STALE = "Stale: for the entries before."
# Shortest time between two updates of the charts while the drawing moves [s]; an update takes 5 to 10 ms.
_CHARTS_APART = 0.1
_MUCH = 0.01  # computing time of tables and notes [s] above which the drawing is computed and shown first
# Delay of the charts after a drawing that the slider moves, so that the browser paints the drawing first [s].
_DRAWN_FIRST = 0.03


class ScreenView:
    """The view of one screen of an open input file.

    Parameters
    ----------
    work : OpenDocument
        The open input file, with its results.
    screen : Screen
        The screen to show.
    edited : callable
        Called after a field of this screen has changed.
    open_file : callable
        ``open_file(text, name)`` opens a file that was made from the result.
    solver : RunsTasks
        Object that computes results in worker processes.
    """

    def __init__(
        self,
        work: OpenDocument,
        screen: Screen,
        edited: Callable[[], object],
        open_file: Callable[[str, str], object],
        solver: RunsTasks,
    ) -> None:
        self.work, self.screen, self._edited, self._solver = work, screen, edited, solver
        self._open_file = open_file
        self.narrow = False  # whether the page is narrow, so that drawings are made narrow, too
        self._drawn = False
        # What drawing and charts show, as returned by `_to_draw`; None while the charts are not up to date.
        self._drawn_of: object = None
        self._sentences: list[tuple[str, str]] = []  # sentences that are shown, with their CSS classes
        self._way = LatestComputation(self._settle, self._fail, self.state)
        self._holds = False  # whether the user holds a slider of the form
        self._charted = 0.0  # time at which the charts were last updated [s]
        self._player: Player | None = None
        self._previews = False  # whether a preliminary result is shown, or soon will be
        self._writer = PageWriter(lambda: self.dragged or self._previews or self._plays)
        self._asked: Entries = {}  # field texts of the computation requested last
        # Field texts for which a picture was last requested; pictures of preliminary results do not count.
        self._pictured: Entries = {}
        self._sketch: SketchPanel | None = None
        with ui.element("div").classes("screen"):
            self._left: Any = ui.column().classes("left gap-1")
            with ui.column().classes("right gap-2"):
                self._make_head()
                self._make_results()
        # Inputs of the form; None until the form is made, which is done late so that pages open sooner.
        self._shape: list[str] | None = None
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
                self._busy = BusyRow(self._way.cancel)
            self._said: Any = ui.column().classes("said gap-1 w-full").props('role="alert"')

    def _make_downloads(self) -> None:
        with ui.row().classes("gap-2"):
            if (follows := self.screen.follows) is not None:
                ui.button(follows.words, on_click=self._open_following).props("flat dense no-caps")
            for kind in ("SVG", "PNG", "CSV"):
                button = ui.button(kind, on_click=partial(self._download, kind.lower()), icon="download")
                button.props(f'flat dense no-caps aria-label="download {self.screen.name} as {kind}"')

    def _make_results(self) -> None:
        screen, name = self.screen, self.screen.name
        self._made: list[PicturePanel] = []  # parts of the result that other processes make
        self._good: Any = ui.element("div").classes("w-full shown")
        with self._good:
            with ui.column().classes("pictures gap-2"):
                if screen.slider is not None:  # `view` keeps the scale of the drawing while the slider moves
                    self._player = Player(screen.slider, self._writer, lambda: self._draw(self.board.view))
                self._branch = BranchChoice(self._draw)
                self.board = DraggableDrawing(f"{name}: drawing of the result", self._moved, self._writer)
                self._charts = ChartBoard(f"{name}: charts of the result", self._writer)
                if screen.picture is not None:
                    self._made.append(PicturePanel(self._make_picture, self._writer))
            with ui.column().classes("numbers gap-2"):
                self.comparison = ComparisonPanel(self.work, screen, self._solver, self.show)
                self._tables: Any = ui.html("", sanitize=False).classes("w-full tables")
                self._made += [
                    FoldedPanel(
                        part.title, lambda answer, i=i: self._make(page_tasks.folded, answer, i), self._writer
                    )
                    for i, part in enumerate(screen.more)
                ]
        with ui.column().classes("after w-full gap-2"):
            sweeps, backwards, known = screen.sweeps, screen.backwards, (self.work, screen)
            self.sweep = None if sweeps is None else SweepPanel(*known, sweeps, self._solver)
            find = None if backwards is None else FindPanel(*known, backwards, self._solver)
            self._asking = [panel for panel in (self.sweep, find) if panel is not None]

    # The form -----------------------------------------------------------------------------------------

    def rebuild(self) -> None:
        """Make the form again, for example after another file was opened."""
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
        """Return the descriptions of the inputs that have a field: all that are not in lists."""
        lists = self.screen.lists
        return [entry for entry in self.work.inputs if lists is None or not lists.covers(entry.path)]

    @property
    def _has_shape(self) -> bool:
        """Return whether the form has exactly one field for each present input."""
        return [entry.path for entry in self._fielded] == self._shape

    def _listed(self, entries: Entries) -> None:
        """Store field texts that were changed in the lists, and compute the result."""
        self.work.show(entries)
        self._put_entries()
        self.solve()
        self._edited()

    def _changed(self, path: str, text: str) -> None:
        if self.work.entries.get(path) == text:
            return  # the text is stored already, if a handle was moved
        self.work.put(path, text)
        if not self._has_shape:
            self.rebuild()
        elif self._sketch is not None and path in self._choices:
            self._sketch.show(self.work.entries)
        self.form.hide(self.work.idle)
        self._previews = self._drawn  # if True, the page is rendered later, and the picture appears sooner
        self.solve(held=self._holds)
        if not self._holds:  # while a slider is held, texts are neither stored nor reported to other screens
            self._edited()

    def _hold(self, held: bool) -> None:
        """Store whether the user holds a slider of the form; on release, compute the full result."""
        self._holds = held
        if not held:
            self.solve()
            self._edited()

    def enter(self) -> None:
        """Update the form when the screen is shown again, and compute the result if it is outdated.

        Also compute it if the running computation is for other field texts, as after undo.
        """
        self._put_entries()
        if self._lists is not None:
            self._lists.show(self.work.entries)
        failed, other = self.work.mistakes.get(self.screen.name), self._asked != self.work.needed(self.screen)
        if self.work.stale(self.screen) or failed or other or not self._drawn:
            self.solve()

    def _put_entries(self) -> None:
        """Show the texts in the form, which is made again only if its fields have changed."""
        if not self._has_shape:
            return self.rebuild()
        self.form.put(self.work.entries)
        self.form.hide(self.work.idle)
        if self._sketch is not None:
            self._sketch.show(self.work.entries)

    # Results ------------------------------------------------------------------------------------------

    @property
    def _answered(self) -> ShownAnswer | None:
        """Return the latest result of this screen; None if there is none."""
        return self.work.answered.get(self.screen.name)

    def _make(self, task: Task, *given: Any) -> asyncio.Future[Any]:
        """Run a task for this screen in a worker process."""
        return self._solver.submit(task, self.work.document, self.screen, *given)

    def _make_picture(self, answer: Any) -> asyncio.Future[Any]:
        return self._make(page_tasks.picture_part, answer, self.narrow)

    def solve(self, held: bool = False) -> None:
        """Start the computation of the result for the present field texts.

        The old result is shown until the new one is available.  If field texts change meanwhile, only their
        last state is computed next.

        Parameters
        ----------
        held : bool
            Whether the user drags a handle or slider: then only what the drawing needs is computed.
        """
        entries, drawn = dict(self.work.entries), self._answered
        self._asked = self.work.needed(self.screen)
        completes = drawn is not None and not drawn.is_whole and self.work.drawn(self.screen)
        if completes and not held:
            self._way.want(partial(self._make, page_tasks.solve, entries, drawn), gives_way=True)
        elif self.screen.picture is not None or (drawn is not None and (held or drawn.rest > _MUCH)):
            self._draw_first(entries, held)
        else:
            self._way.want(partial(self._make, page_tasks.solve, entries))
        self.state()

    def _draw_first(self, entries: Entries, held: bool) -> None:
        """Compute what the drawing needs for the given field texts; cancel a picture that is being made.

        While the user drags, each picture that has been started is shown; while the user types, only the last
        one.
        """
        if self.screen.picture is not None:
            self._made[0].close()
            self._pictured = {}
        start = partial(self._make, page_tasks.solve_for_drawing, entries, self.narrow)
        self._way.want(start, gives_way=not held)

    async def settled(self) -> None:
        """Wait until the result for the present field texts is computed."""
        await self._way.done()

    def close(self) -> None:
        """Cancel all computations, because the page was closed."""
        for more in self._made:
            more.close()
        self._way.cancel()
        self.comparison.close()
        for panel in self._asking:
            panel.close()

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        """Show a finished result; if it failed, show why, and grey the old result.

        `last` tells whether no newer result was requested.
        """
        if self._left.is_deleted:
            return
        outcome, before = outcome_of(future, self.work, self.screen), self._answered
        if not last and not isinstance(outcome, ShownAnswer):
            return
        if last:
            self.board.forget_steps()
        is_part = False
        # With a preliminary result, the tables of the result before stay on the page.
        if isinstance(outcome, ShownAnswer) and not outcome.is_whole:
            is_part, kept = True, before or outcome
            outcome = replace(outcome, tables=kept.tables, notes=kept.notes, rest=kept.rest)
        self._previews = is_part
        self.work.keep(self.screen, outcome)
        mistakes = at_fault(self.work, self.screen)
        self.form.mark(mistakes)
        if not mistakes or (not self.dragged and "waits" in self._tables.classes):
            self.show()
        self._show_sentences(mistakes)
        if last and is_part and not self.dragged:
            return self.solve()
        self.state()
        if not self.dragged:
            self._writer.synchronize()  # after all changes, so that the page is rendered only once
            self._edited()

    def _fail(self, error: Exception) -> None:
        """Show that a result cannot be displayed, although parts of it may already be on the page."""
        self._previews = False
        self.work.answered.pop(self.screen.name, None)
        self.work.mistakes[self.screen.name] = mistakes = {"": [_NOT_SHOWN.format(error)]}
        self.state()
        self._writer.synchronize()
        self._show_sentences(mistakes)

    def state(self) -> None:
        """Show whether the result is up to date, and grey it during a long computation."""
        busy, slow, held = self._way.busy, self._way.slow, self.dragged
        stale, drawn = self.work.stale(self.screen), self.work.drawn(self.screen)
        failed = bool(self.work.mistakes.get(self.screen.name))
        follows = not failed and ((held and not slow) or (drawn and busy))
        words = _STALE if self._answered else "No result yet."
        state = "Computing. " if busy else "Refused. " if failed else ""
        now = f"{state}{words}" if stale else state.strip() or "Up to date."
        waits = "The drawing follows; the tables wait." if held else "The tables follow."
        waits = f"Preliminary. {waits}" if self._answered and self._answered.is_rough else waits
        with self._writer.writing(self._head, self._good, self._status, *self._busy.parts):
            self._busy.show(slow, self._way.words)
            toggle(self._head, "stale", stale and not follows)
            toggle(self._good, "greyed", stale and (failed or (slow and not drawn) or not (busy or held)))
            toggle(self._good, "refused", stale and failed)
            self._status.set_text(waits if follows and (held or stale) else now)
        for panel in self._asking:
            panel.state()

    def _show_sentences(self, mistakes: dict[str, list[str]]) -> None:
        """Show the errors and the warnings of the result.

        Errors of form fields have the CSS class at-field: they are visible only on a narrow page, where the
        form, which shows them at its fields, is out of sight.
        """
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
                if kind == "warning":  # a long warning unfolds under the pointer or with the focus
                    shown.props("tabindex=0")

    # Display of results -------------------------------------------------------------------------------

    @property
    def dragged(self) -> bool:
        """Return whether the user holds a handle or a slider of the form."""
        return self._holds or self.board.held is not None

    @property
    def _plays(self) -> bool:
        """Return whether the slider above the drawing moves, by animation or by the user."""
        return self._player is not None and self._player.moves

    @property
    def progress(self) -> float:
        """Return the position of the slider above the drawing."""
        return self.screen.last if self._player is None else self._player.place

    def show(self) -> None:
        """Show the latest result, and the design with which it is compared."""
        answered = self._answered
        if answered is None:
            return
        with self._writer.writing(self._headline, self._good, self._tables, self._head, self._status):
            self._headline.set_content(headline_of(self.work, self.screen, answered))
            self._good.props["data-solved"] = f"{crc32(repr(answered.entries).encode()):08x}"
            toggle(self._tables, "waits", not answered.is_whole)
            self.state()  # within `writing`, so that its changes are sent to the page with the others
        if self._drawn_of != self._to_draw(answered):
            self._draw()
        if answered.picture:
            self._made[0].put(answered.answer, answered.picture)
        elif self.screen.picture is not None and answered.entries != self._pictured:
            self._pictured = answered.entries
            self._made[0].show(answered.answer)
        if answered.is_whole:  # a preliminary result has only drawing and picture
            self._tables.set_content(html(answered.tables))
            self.comparison.show(answered)
            for more in self._made[self.screen.picture is not None :]:
                more.show(answered.answer)

    def be_narrow(self, narrow: bool) -> None:
        """Draw for a narrow page from now on, or for a wide page."""
        if narrow == self.narrow:
            return
        self.narrow = narrow
        if narrow and self._sketch is not None:
            self._sketch.fold()
        self._draw()
        if self.screen.picture is not None and self._answered is not None:
            self._made[0].show(self._answered.answer)

    def _draw(self, view: Viewport | None = None) -> None:
        """Draw the latest result; charts beside a moving drawing are updated less often."""
        answered, screen, place = self._answered, self.screen, self.progress
        if answered is None:
            return
        answer, there = self._drawn_answer(answered), self.work.other_answer(screen)
        name = self.work.other.name if self.work.other else ""
        other = () if there is None else screen.drawings(there.answer, place)
        made = draw_sheet(screen, answer, place, self.board.held or view, other, name, self.narrow)
        self._drawn, self._drawn_of = True, None
        plays = self._player is not None and self._player.plays
        moves = plays or (self.dragged and made.view is not None)
        self.board.show(made, partial(describe_place, entries=self.work.entries, inputs=self.work.inputs))
        if moves and monotonic() - self._charted < _CHARTS_APART:
            return
        if self._plays and made.view is not None:
            asyncio.get_running_loop().call_later(_DRAWN_FIRST, self._show_charts)
        else:
            self._show_charts()
        self._charted, self._drawn_of = monotonic(), self._to_draw(answered)

    def _show_charts(self) -> None:
        """Show the charts of the latest result."""
        answered, screen, place = self._answered, self.screen, self.progress
        if answered is None or screen.charts is None or self._left.is_deleted:
            return
        there, name = self.work.other_answer(screen), self.work.other.name if self.work.other else ""
        with few_digits() if answered.is_rough else nullcontext():
            charts = screen.charts(self._drawn_answer(answered), place)
        if there is not None:
            charts = with_other_curves(charts, screen.charts(there.answer, place), name)
        self._charts.show(charts)

    def _to_draw(self, answered: ShownAnswer) -> object:
        """Return what determines the drawing, in order to find out whether it must be drawn again.

        This is a tuple of the field texts, whether the result is preliminary, and the other design if that is
        computed.
        """
        return answered.entries, answered.is_rough, self.work.other_answer(self.screen) and self.work.other

    def _drawn_answer(self, answered: ShownAnswer) -> Any:
        """Return the result with the chosen solution branch, for the drawing."""
        return self._branch.choose(answered.answer, self.screen.branches(answered.answer))

    def _moved(self, handle: Handle, target: Place, done: bool) -> None:
        """Write the new position of a handle into the fields, and compute the result.

        `done` tells whether the user has released the handle.
        """
        if self._player is not None:
            self._player.pause()
        texts = changed_texts(handle, target, self.work.entries, self.work.inputs)
        for path, text in texts.items():
            self.work.put(path, text)
        self.form.write(texts)
        if self._lists is not None:  # advice on missing items is shown when the handle is released
            (self._lists.show if done else self._lists.follow)(self.work.entries)
        if texts or done:
            self.solve(held=not done)
            if done:
                self._edited()

    async def _answer_for_file(self) -> ShownAnswer | None:
        """Wait for an up-to-date result and return it.

        If it is only preliminary, or there is none, notify the user and return None.
        """
        await self.settled()
        answered = self._answered
        if answered is None or answered.is_rough:
            ui.notify(_NO_FILE, type="negative")
            return None
        return answered

    async def _open_following(self) -> None:
        """Wait until the result is up to date, make a file of another kind from it, and open that file."""
        if self.screen.follows is not None and (answered := await self._answer_for_file()):
            self._open_file(self.screen.follows.text(answered.answer), self.screen.name)

    async def _download(self, kind: str) -> None:
        """Download the drawing ("svg" or "png") or the numbers ("csv")."""
        if answered := await self._answer_for_file():
            if kind == "csv":
                made = self._make(page_tasks.rows_file, answered.answer)
            else:
                made = self._make(page_tasks.drawing_file, self._drawn_answer(answered), self.progress, kind)
            await download(made, f"{self.screen.name.lower().replace(' ', '-')}.{kind}")
