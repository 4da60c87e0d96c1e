"""Foldable panels of a screen: comparison with another design, further parts of a result, the sketch."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

from nicegui import ui

from beamdyn.common.drawing.layout import lay_out
from beamdyn.common.drawing.sketch import Sketcher, sketch_paper
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.rendering import picture
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.compared_designs import (
    differences_html,
    headline_html,
    input_differences,
    result_differences,
)
from beamdyn.common.screens.computations import BusyRow, LatestComputation
from beamdyn.common.screens.open_document import OpenDocument, OtherDesign, ShownAnswer
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.processes import RunsTasks
from beamdyn.common.screens.screens import Screen


class ComparisonPanel:
    """Tables of inputs and results that differ from another design; hidden without a comparison.

    Parameters
    ----------
    work : OpenDocument
        The open input file, with its results.
    screen : Screen
        The screen that contains the panel.
    solver : RunsTasks
        Object that computes the other design in a worker process.
    solved : callable
        Called when the computation of the other design has ended or failed.
    """

    def __init__(
        self, work: OpenDocument, screen: Screen, solver: RunsTasks, solved: Callable[[], object]
    ) -> None:
        self.work, self.screen, self._solver, self._solved = work, screen, solver, solved
        self._way = LatestComputation(self._settle, self._fail, self._tell)
        self._asked: OtherDesign | None = None
        self._fold: Any = ui.expansion("Compared", value=True).classes("w-full section").props("dense")
        with self._fold:
            self._busy = BusyRow(self.close, "solving the other design")
            self._said: Any = ui.label().classes("mistake")
            self._inputs: Any = ui.html("", sanitize=False).classes("w-full")
            self._results: Any = ui.html("", sanitize=False).classes("w-full")
        self._fold.set_visibility(False)

    def solve(self) -> None:
        """Start the computation of the other design, unless it is running."""
        if (other := self.work.other) is None or (self._way.busy and other is self._asked):
            return
        self._asked, given = other, dict(other.entries)
        self._entitle()
        self._way.want(lambda: self._solver.submit(page_tasks.solve, self.work.document, self.screen, given))

    def close(self) -> None:
        """Cancel the computation of the other design."""
        self._way.cancel()

    def _tell(self) -> None:
        self._busy.show(self._way.slow, self._way.words)

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        if self._fold.is_deleted or not last:
            return
        self._tell()
        if self._asked is self.work.other:
            self.work.compared[self.screen.name] = page_tasks.outcome_of(future, self.work, self.screen)
            self._solved()

    def _fail(self, error: Exception) -> None:
        self._said.set_text(f"The other design cannot be shown: {error}")

    def _entitle(self) -> OtherDesign | None:
        """Show the panel with the other design's name, or hide it; return that design or None."""
        if other := self.work.other:
            self._fold.set_text(f"Compared with {other.name}")
        self._fold.set_visibility(other is not None)
        return other

    def show(self, answered: ShownAnswer) -> None:
        """Compare a result with the result of the other design, if that is available."""
        if (other := self._entitle()) is None:
            return
        found, there = self.work.compared.get(self.screen.name), self.work.other_answer(self.screen)
        mistakes = {} if found is None or isinstance(found, ShownAnswer) else found
        self._said.set_text(" ".join(each for sentences in mistakes.values() for each in sentences))
        wanted = [entry for entry in self.work.inputs if entry.path in self.work.entries]
        inputs = [*input_differences(self.work.entries, other.entries, wanted)]
        self._inputs.set_content(differences_html(inputs, "inputs", other.name))
        results = [] if there is None else [*result_differences(answered.tables, there.tables)]
        self._results.set_content("" if there is None else differences_html(results, "results", other.name))


def headline_of(work: OpenDocument, screen: Screen, answered: ShownAnswer) -> str:
    """Return the most important results as HTML, beside those of the compared design."""
    there = work.other_answer(screen)
    other = () if there is None else there.headline
    return headline_html(answered.headline, other, work.other.name if work.other else "")


class PicturePanel:
    """Part of the display of a result that another process makes; until it is ready, the old one is shown.

    Parameters
    ----------
    make : callable
        ``make(answer)`` returns a future with the part as HTML.
    writer : PageWriter
        Object that updates the part on the page while a handle or slider is held.
    """

    def __init__(self, make: Callable[[Any], asyncio.Future[str]], writer: PageWriter) -> None:
        self._make, self._writer = make, writer
        self._answer: Any = None
        self._way = LatestComputation(self._settle, self._fail)
        self._frame: Any = ui.html("", sanitize=False).classes("w-full drawing-frame")

    def show(self, answer: object) -> None:
        """Start making the part for another result, and show it when ready."""
        self._answer = answer
        self._fill()

    def put(self, answer: object, part: str) -> None:
        """Show the given part, which was made for another result; cancel the part that is being made."""
        self.close()
        self._answer = answer
        self._write(part)

    def close(self) -> None:
        """Cancel the part that is being made."""
        self._way.cancel()

    def _fill(self) -> None:
        if self._answer is not None:
            self._way.want(lambda: self._make(self._answer), gives_way=True)

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        if self._frame.is_deleted or future.cancelled():
            return
        error = future.exception()
        if error is not None:
            return self._fail(error)
        self._write(future.result())

    def _write(self, part: str) -> None:
        with self._writer.writing(self._frame):
            self._frame.set_content(part)

    def _fail(self, error: BaseException) -> None:
        self._frame.set_content(picture(f"There is no drawing: {error}", ""))


class FoldedPanel(PicturePanel):
    """A foldable part of a result, which is made when the user unfolds it.

    Parameters
    ----------
    title : str
        Title of the part.
    make, writer
        As for `PicturePanel`.
    """

    def __init__(self, title: str, make: Callable[[Any], asyncio.Future[str]], writer: PageWriter) -> None:
        self.title = title
        self._fold: Any = ui.expansion(title, on_value_change=self._fill)
        with self._fold.classes("w-full section folded").props("dense"):
            super().__init__(make, writer)

    def _fill(self) -> None:
        if self._fold.value:
            super()._fill()


class SketchPanel:
    """The explanatory sketch of a form, which can be folded; hidden if there is none.

    Parameters
    ----------
    sketch : callable
        ``sketch(entries)`` returns rows of drawings.
    entries : mapping
        Field texts at first.
    shown : bool
        Whether the panel is unfolded at first.
    """

    def __init__(self, sketch: Sketcher, entries: Mapping[str, str], shown: bool) -> None:
        self._shown = shown
        self._fold: Any = None
        self._sketch = sketch
        if made := _drawn(sketch, entries):
            self._fold = ui.expansion("What the symbols mean", value=shown)
            with self._fold.classes("w-full section sketch").props("dense"):
                self._drawing: Any = ui.html(made, sanitize=False)

    def show(self, entries: Mapping[str, str]) -> None:
        """Show the sketch that belongs to the given field texts."""
        if self._fold is not None:
            self._drawing.set_content(_drawn(self._sketch, entries))

    @property
    def shown(self) -> bool:
        """Return whether the sketch is unfolded."""
        return bool(self._fold.value) if self._fold is not None else self._shown

    def fold(self) -> None:
        """Fold the sketch."""
        self._shown = False
        if self._fold is not None:
            self._fold.close()


def _drawn(sketch: Sketcher, entries: Mapping[str, str]) -> str:
    """Return a sketch as an element of the page; "" if there is none."""
    rows = sketch(entries)
    if not rows:
        return ""
    paper = sketch_paper(rows)
    return element(lay_out(rows, paper), paper)
