"""Panels of a screen that can be folded: comparison with another design, further parts, and the sketch."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Mapping
from typing import Any

from nicegui import ui

from beamdyn.common.drawing.sheet import lay_out
from beamdyn.common.drawing.sketch import Sketcher, sketch_paper
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.rendering import picture
from beamdyn.common.screens.compared_designs import (
    differences_html,
    headline_html,
    input_differences,
    result_differences,
)
from beamdyn.common.screens.computations import LatestComputation
from beamdyn.common.screens.open_document import OpenDocument, ShownAnswer
from beamdyn.common.screens.screens import Screen


class ComparisonPanel:
    """Tables of the inputs and results that differ; hidden while no other design is compared.

    Parameters
    ----------
    work : OpenDocument
        The document.
    screen : Screen
        Which of its screens.
    """

    def __init__(self, work: OpenDocument, screen: Screen) -> None:
        self.work, self.screen = work, screen
        self._fold: Any = ui.expansion("Compared", value=True).classes("w-full section").props("dense")
        with self._fold:
            self._said: Any = ui.label().classes("mistake")
            self._inputs: Any = ui.html("", sanitize=False).classes("w-full")
            self._results: Any = ui.html("", sanitize=False).classes("w-full")
        self._fold.set_visibility(False)

    def show(self, answered: ShownAnswer) -> None:
        """Compare an answer with that of the other design, if that has been solved."""
        other = self.work.other
        self._fold.set_visibility(other is not None)
        if other is None:
            return
        self._fold.set_text(f"Compared with {other.name}")
        found, there = self.work.compared.get(self.screen.name), self.work.other_answer(self.screen)
        mistakes = {} if found is None or isinstance(found, ShownAnswer) else found
        self._said.set_text(" ".join(each for sentences in mistakes.values() for each in sentences))
        wanted = [entry for entry in self.work.inputs if entry.path in self.work.entries]
        inputs = [*input_differences(self.work.entries, other.entries, wanted)]
        self._inputs.set_content(differences_html(inputs, "inputs", other.name))
        results = [] if there is None else [*result_differences(answered.tables, there.tables)]
        self._results.set_content("" if there is None else differences_html(results, "results", other.name))


def headline_of(work: OpenDocument, screen: Screen, answered: ShownAnswer) -> str:
    """The most important results of an answer in HTML, beside those of the design it is compared with."""
    there = work.other_answer(screen)
    other = () if there is None else there.headline
    return headline_html(answered.headline, other, work.other.name if work.other else "")


class PicturePanel:
    """A part of an answer, made in another process; the last one stays until it has come.

    Parameters
    ----------
    make : callable
        ``make(answer)`` returns a future of the part as HTML.
    """

    def __init__(self, make: Callable[[Any], asyncio.Future[str]]) -> None:
        self._make = make
        self._answer: Any = None
        self._way = LatestComputation(self._settle, self._fail)
        self._frame: Any = ui.html("", sanitize=False).classes("w-full drawing-frame")

    def show(self, answer: object) -> None:
        """Show another answer."""
        self._answer = answer
        self._fill()

    def close(self) -> None:
        """End what is being made."""
        self._way.cancel()

    def _fill(self) -> None:
        if self._answer is not None:
            self._way.want(lambda: self._make(self._answer))

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        if self._frame.is_deleted or future.cancelled():
            return
        error = future.exception()
        if error is not None:
            return self._fail(error)
        self._frame.set_content(future.result())

    def _fail(self, error: BaseException) -> None:
        self._frame.set_content(picture(f"There is no drawing: {error}", ""))


class FoldedPanel(PicturePanel):
    """A part of an answer that folds out, and is made only then.

    Parameters
    ----------
    title : str
        Title of the part.
    make : callable
        As for `PicturePanel`.
    """

    def __init__(self, title: str, make: Callable[[Any], asyncio.Future[str]]) -> None:
        self.title = title
        self._fold: Any = ui.expansion(title, on_value_change=self._fill)
        with self._fold.classes("w-full section folded").props("dense"):
            super().__init__(make)

    def _fill(self) -> None:
        if self._fold.value:
            super()._fill()


class SketchPanel:
    """The sketch of a form, which can be folded; nothing is shown where there is none.

    Parameters
    ----------
    sketch : callable
        ``sketch(entries)``: rows of drawings.
    entries : mapping
        Entries of the form at first.
    shown : bool
        Whether it is unfolded.
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
        """Show the sketch for other entries."""
        if self._fold is not None:
            self._drawing.set_content(_drawn(self._sketch, entries))

    @property
    def shown(self) -> bool:
        """Whether it is unfolded."""
        return bool(self._fold.value) if self._fold is not None else self._shown

    def fold(self) -> None:
        """Fold it."""
        self._shown = False
        if self._fold is not None:
            self._fold.close()


def _drawn(sketch: Sketcher, entries: Mapping[str, str]) -> str:
    """A sketch as an element of the page; "" where there is none."""
    rows = sketch(entries)
    if not rows:
        return ""
    paper = sketch_paper(rows)
    return element(lay_out(rows, paper), paper)
