"""One screen on the page: the form on the left, the results on the right."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import partial
from html import escape
from time import monotonic
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import html
from beamdyn.common.screens import tasks
from beamdyn.common.screens.branch_choice import BranchChoice
from beamdyn.common.screens.chart_board import ChartBoard
from beamdyn.common.screens.comparison import with_other_curves
from beamdyn.common.screens.comparison_panel import ComparisonPanel, headline_of
from beamdyn.common.screens.downloads import download
from beamdyn.common.screens.drag_slider import DragSlider
from beamdyn.common.screens.draggable_drawing import DraggableDrawing
from beamdyn.common.screens.folded_panel import FoldedPanel
from beamdyn.common.screens.form import Form
from beamdyn.common.screens.form_entries import Entries
from beamdyn.common.screens.handles import Place, Viewport, changed_texts, describe_place, draw_sheet
from beamdyn.common.screens.input_words import as_on_form, options_of
from beamdyn.common.screens.list_editor import ListEditor
from beamdyn.common.screens.open_document import Answered, OpenDocument
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.player import Player
from beamdyn.common.screens.processes import Task, TaskTaker
from beamdyn.common.screens.refusals import at_fault, outcome_of
from beamdyn.common.screens.screens import Handle, Screen
from beamdyn.common.screens.sketch_panel import SketchPanel
from beamdyn.common.screens.sweep_panel import SweepPanel
from beamdyn.common.screens.under_way import UnderWay

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
    solver : TaskTaker
        Solver that makes the answers.
    """

    def __init__(
        self, work: OpenDocument, screen: Screen, edited: Callable[[], object], solver: TaskTaker
    ) -> None:
        self.work, self.screen, self._edited, self._solver = work, screen, edited, solver
        self._drawn = ""
        self.narrow = False  # the page, so that drawings have narrow paper
        self._sentences: tuple[list[str], list[str], list[str]] = [], [], []
        self._way = UnderWay(self._settle, self._fail, self.state)
        self._holds = False  # a slider of the form
        self._charted = 0.0  # when the charts were shown last [s]
        self._swings = False  # the slider above the drawing
        self._writer = PageWriter(lambda: self.dragged or self._swings or self._plays)
        self._partial = False  # whether the tables shown are those of an answer before
        self._sketch: SketchPanel | None = None
        with ui.element("div").classes("screen"):
            self._left: Any = ui.column().classes("left gap-1")
            with ui.column().classes("right gap-2"):
                self._results()
        self._shape: list[str] | None = None  # its form is made when it comes to the front: pages open sooner
        self.state()

    def _results(self) -> None:
        self._head: Any = ui.column().classes("head")
        with self._head:
            ui.html(escape(self.screen.name), tag="h2", sanitize=False)
            ui.label(self.screen.purpose).classes("text-body2")
            self._headline: Any = ui.html("", sanitize=False).classes("w-full")
            with ui.row().classes("items-center gap-2"):
                self._status: Any = ui.label().classes("status").props('role="status" aria-live="polite"')
                ui.label(_STALE).classes("newer")
                self._busy: Any = ui.row().classes("items-center gap-2")
                with self._busy:
                    ui.spinner(size="sm").props('aria-hidden="true"')
                    ui.button("Cancel", on_click=self._way.cancel).props("dense outline no-caps size=sm")
            self._said: Any = ui.column().classes("said gap-1 w-full").props('role="alert"')
        self._good: Any = ui.element("div").classes("w-full shown")
        with self._good:
            with ui.column().classes("pictures gap-2"):
                self._slider()
                self._branch = BranchChoice(self._draw)
                words = f"{self.screen.name}: drawing of the result"
                self.board = DraggableDrawing(words, self._moved, self._writer)
                self._charts = ChartBoard(f"{self.screen.name}: charts of the result", self._writer)
            with ui.column().classes("numbers gap-2"):
                self.comparison = ComparisonPanel(self.work, self.screen)
                self._tables: Any = ui.html("", sanitize=False).classes("w-full")
                self._more = [
                    FoldedPanel(part.title, partial(self._folded, number))
                    for number, part in enumerate(self.screen.more)
                ]
        with ui.column().classes("after w-full gap-2"):
            self._exports()
            sweeps = self.screen.sweeps
            self._sweep = None if sweeps is None else SweepPanel(self.work, self.screen, sweeps, self._solver)

    def _slider(self) -> None:
        slider = self.screen.slider
        self._at: Any = None
        self._player: Player | None = None
        if slider is None:
            return
        marks = ", ".join(f"{i}: '{mark}'" for i, mark in enumerate(slider.marks))
        last = self.screen.last
        with ui.row().classes("stroke w-full"):
            self._at = DragSlider(
                self._swing, min=0, max=last, step=slider.step, value=last, on_change=self._turn
            )
            self._at.props(f'aria-label="{slider.label}" :marker-labels="{{{marks}}}" markers=1').classes(
                "slider"
            )
            self._player = Player(
                self._at, slider.label, slider.course(last, slider.seconds), self._writer, self._turn
            )

    def _exports(self) -> None:
        with ui.row().classes("gap-2"):
            for kind, make in (
                ("SVG", partial(self._take, "svg")),
                ("PNG", partial(self._take, "png")),
                ("CSV", self._csv),
            ):
                ui.button(f"{kind}", on_click=make, icon="download").props(
                    f'flat dense no-caps aria-label="download {self.screen.name} as {kind}"'
                )

    def rebuild(self) -> None:
        """Make the form again, for instance after another file has been opened."""
        shown = not self.narrow if self._sketch is None else self._sketch.shown
        self._left.clear()
        with self._left:
            self._sketch = SketchPanel(self.screen.sketch, self.work.entries, shown)
            self._lists = self._make_lists()
            self.form = Form(
                self._fielded, self.screen.sections, self.work.entries, self._changed, self.screen.drags,
                self._hold, self.work.document.headings, self._writer,
            )  # fmt: skip
        self._shape = [entry.path for entry in self._fielded]
        self._choices = {entry.path for entry in self._fielded if options_of(entry)}
        self.form.mark(self._mistakes())
        self.form.hide(self.work.idle)
        self.state()

    def _make_lists(self) -> ListEditor | None:
        lists = self.screen.lists
        if lists is None:
            return None
        return ListEditor(lists, lambda: self.work.entries, self._listed, self._writer)

    @property
    def _fielded(self) -> list[Input]:
        """Descriptions of the inputs that have a field of the form: all that are not in lists."""
        lists = self.screen.lists
        return [entry for entry in self.work.inputs if lists is None or not lists.covers(entry.path)]

    def _listed(self, entries: Entries) -> None:
        """Something in the lists has changed."""
        self.work.show(entries)
        self.put_entries()
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

    @property
    def dragged(self) -> bool:
        """Whether a point or a slider of the form is held."""
        return self._holds or self.board.held is not None

    def enter(self) -> None:
        """Come to the front: show what other screens have written, and solve if the answer shown is stale."""
        self.put_entries()
        if self._lists is not None:
            self._lists.show(self.work.entries)
        stale = self._partial or self.work.stale(self.screen)
        if stale or self.work.mistakes.get(self.screen.name) or not self._drawn:
            self.solve()

    def put_entries(self) -> None:
        """Make the entries stand in the form, which is made again only if its fields are others."""
        if not self._has_shape:
            return self.rebuild()
        self.form.put(self.work.entries)
        self.form.hide(self.work.idle)
        if self._sketch is not None:
            self._sketch.show(self.work.entries)

    @property
    def _has_shape(self) -> bool:
        """Whether the form has a field for each input that there is now."""
        return [entry.path for entry in self._fielded] == self._shape

    def solve(self, held: bool = False) -> None:
        """Have the present entries solved, and the answer shown when it comes; the last one stays until then.

        What changes meanwhile is solved next, its last state alone.

        Parameters
        ----------
        held : bool
            Whether something is being dragged: then as far as the drawing shows it.
        """
        task = tasks.glance if held and self.work.answered.get(self.screen.name) else tasks.solve
        document, entries = self.work.document, dict(self.work.entries)
        self._way.want(lambda: self._solver.submit(task, document, self.screen, entries))
        self.state()

    async def settled(self) -> None:
        """Wait until the present entries have been solved."""
        await self._way.done()

    def close(self) -> None:
        """End what is under way: the page is gone."""
        for more in self._more:
            more.close()
        self._way.cancel()
        if self._sweep is not None:
            self._sweep.close()

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        """Show an answer; or say why there is none to the newest entries, and leave the last one, greyed."""
        if self._left.is_deleted:
            return
        outcome = outcome_of(future, self.work, self.screen)
        if not last and not isinstance(outcome, Answered):
            return
        if last:
            self.board.forget_steps()
        self.work.keep(self.screen, self._complete(outcome))
        mistakes = self._mistakes()
        self.form.mark(mistakes)
        if not mistakes or (not self.dragged and "waits" in self._tables.classes):
            self._show()
        self.state()
        self._say(mistakes)
        if not self.dragged:
            self._writer.synchronize()  # not before: the page would be rendered twice
            self._edited()

    def _fail(self, error: Exception) -> None:
        """Say that an answer cannot be shown; what stands there may be parts of it."""
        self.work.answered.pop(self.screen.name, None)
        self.work.mistakes[self.screen.name] = {"": [_NOT_SHOWN.format(error)]}
        self.state()
        self._writer.synchronize()
        self._say(self.work.mistakes[self.screen.name])

    def _complete(self, outcome: Any) -> Any:
        """An answer that was made for a drawing alone keeps the tables and notes of the one before it."""
        before = self.work.answered.get(self.screen.name)
        if not isinstance(outcome, Answered):
            return outcome
        self._partial = False
        if before is None or outcome.tables:
            return outcome
        self._partial = True
        return replace(outcome, tables=before.tables, notes=before.notes)

    def _mistakes(self) -> dict[str, list[str]]:
        return at_fault(self.work, self.screen)

    def state(self) -> None:
        """Say whether the answer shown is the present one, and grey it where another one takes its time."""
        busy, slow, held = self._way.busy, self._way.slow, self.dragged
        stale = self.work.stale(self.screen) or (self._partial and not held)
        failed = bool(self.work.mistakes.get(self.screen.name))
        follows = held and not (failed or slow)
        _toggle(self._head, "stale", stale and not follows)
        _toggle(self._good, "greyed", stale and (slow or failed or not busy))
        _toggle(self._good, "refused", stale and failed)
        self._busy.set_visibility(slow)
        words = _STALE if self.work.answered.get(self.screen.name) else "No result yet."
        state = "Computing. " if busy else "Refused. " if failed else ""
        now = f"{state}{words}" if stale else state.strip() or "Up to date."
        self._status.set_text("The drawing follows; the tables wait." if follows else now)
        if self._sweep is not None:
            self._sweep.state()

    def _say(self, mistakes: dict[str, list[str]]) -> None:
        """Show the mistakes outside this form, and the warnings of the answer."""
        answered = self.work.answered.get(self.screen.name)
        elsewhere = [*_sentences(mistakes, lambda path: path not in self.form.fields)]
        at_fields = [*_sentences(mistakes, lambda path: path in self.form.fields)]
        warnings = answered.notes if answered and not mistakes else ()
        if (elsewhere, at_fields, [*warnings]) == self._sentences:
            return
        self._sentences = elsewhere, at_fields, [*warnings]
        self._said.clear()
        with self._said:
            for sentence in elsewhere:
                ui.label(sentence).classes("mistake")
            for sentence in at_fields:
                ui.label(sentence).classes("mistake at-field")
            for sentence in dict.fromkeys(warnings):
                ui.label(f"Warning: {self._as_on_form(sentence)}").classes("warning")

    def _as_on_form(self, said: str) -> str:
        return as_on_form(said, self.work.inputs, self.work.document.headings)

    def _show(self) -> None:
        answered = self.work.answered.get(self.screen.name)
        if answered is None:
            return
        with self._writer.writing(self._headline, self._good):
            self._headline.set_content(headline_of(self.work, self.screen, answered))
            self._good.props["data-solved"] = f"{crc32(repr(answered.entries).encode()):08x}"
        self._draw()
        self._tables.classes(add="waits" if self.dragged else "", remove="" if self.dragged else "waits")
        if not self.dragged:  # while a point is moved, its drawing alone follows
            self._tables.set_content(self._as_on_form(html(answered.tables)))
            self.comparison.show(answered)
            for more in self._more:
                more.show(answered.answer)

    def be_narrow(self, narrow: bool) -> None:
        """Draw on narrow paper from now on, or on wide."""
        if narrow == self.narrow:
            return
        self.narrow = narrow
        if narrow and self._sketch is not None:
            self._sketch.fold()
        self._draw()

    def compare(self) -> None:
        """Show the design that this one is compared with, or none."""
        if self.work.answered.get(self.screen.name):
            self._show()

    @property
    def _plays(self) -> bool:
        """Whether the slider above the drawing is played."""
        return self._player is not None and self._player.plays

    def _swing(self, place: float, done: bool) -> None:
        """The slider above the drawing has been moved; or let go."""
        self._swings = not done
        with self._writer.writing(self._at):
            self._at.set_value(place)

    def _turn(self) -> None:
        """Draw at the slider's new place, to the same scale."""
        self._draw(self.board.view)

    def _draw(self, view: Viewport | None = None) -> None:
        answered = self.work.answered.get(self.screen.name)
        if answered is None:
            return
        answer, there = self._drawn_answer(answered), self._other_answer()
        other = () if there is None else self.screen.drawings(there, self.progress)
        name = self.work.other.name if self.work.other else ""
        made = draw_sheet(
            self.screen, answer, self.progress, self.board.held or view, other, name, self.narrow
        )
        self._drawn = made.name or self.screen.name
        moves = self._plays or (self.dragged and made.view is not None)
        if not moves or monotonic() - self._charted >= _CHARTS_APART:
            self._chart(answer)
        self.board.show(made, partial(describe_place, entries=self.work.entries, inputs=self.work.inputs))

    def _drawn_answer(self, answered: Answered) -> Any:
        """The answer, with the branch drawn that is chosen."""
        return self._branch.choose(answered.answer, self.screen.branches(answered.answer))

    def _other_answer(self) -> Any:
        """The answer to the design that this one is compared with, if there is one."""
        there = self.work.compared.get(self.screen.name)
        return there.answer if there is not None else None

    def _chart(self, answer: Any) -> None:
        """Show the charts, also while a point is moved: they are light."""
        if self.screen.charts is None:
            return
        self._charted = monotonic()
        charts, there = self.screen.charts(answer, self.progress), self._other_answer()
        if there is not None and self.work.other is not None:
            charts = with_other_curves(charts, self.screen.charts(there, self.progress), self.work.other.name)
        self._charts.show(charts)

    def _make(self, task: Task, *given: Any) -> asyncio.Future[Any]:
        """Have something made for this screen."""
        return self._solver.submit(task, self.work.document, self.screen, *given)

    def _folded(self, number: int, answer: Any) -> asyncio.Future[str]:
        """Have one of the parts made that fold out."""
        return self._make(tasks.folded, answer, number)

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

    def sweep_report(self) -> tuple[str, InputSweep] | None:
        """Title and result of the sweep that is shown; None if there is none."""
        return None if self._sweep is None else self._sweep.report()

    @property
    def progress(self) -> float:
        """Place of the slider."""
        return float(self._at.value) if self._at is not None else self.screen.last

    async def _take(self, kind: str) -> None:
        """Download the drawing, as "svg" or "png"."""
        await self.settled()
        if answered := self.work.answered.get(self.screen.name):
            answer = self._drawn_answer(answered)
            made = self._make(tasks.drawing_file, answer, self.progress, kind)
            await download(made, f"{self._name}.{kind}")

    async def _csv(self) -> None:
        """Download the numbers."""
        await self.settled()
        if answered := self.work.answered.get(self.screen.name):
            await download(self._make(tasks.rows_file, answered.answer), f"{self._name}.csv")

    @property
    def _name(self) -> str:
        return self.screen.name.lower().replace(" ", "-")


def _toggle(element: Any, name: str, on: bool) -> None:
    """Give an element a class, or take it away."""
    element.classes(add=name if on else "", remove="" if on else name)


def _sentences(mistakes: Mapping[str, list[str]], of: Callable[[str], bool]) -> dict[str, None]:
    """Mistakes of the paths for which `of` holds, each sentence once."""
    return dict.fromkeys(sentence for path, said in mistakes.items() if of(path) for sentence in said)
