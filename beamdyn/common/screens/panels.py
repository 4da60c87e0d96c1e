"""Foldable panels of a screen: comparison of two designs, further parts of a result, the sketch."""

from __future__ import annotations

import asyncio
import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from html import escape
from typing import TYPE_CHECKING, Any, NamedTuple

from nicegui import ui

from beamdyn.common.drawing.layout import Rows, lay_out
from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartCurve, Disc, Drawing, Outline
from beamdyn.common.drawing.sketch import Sketcher, sketch_paper
from beamdyn.common.drawing.svg import element
from beamdyn.common.edge.inputs import Input
from beamdyn.common.edge.rendering import picture
from beamdyn.common.screens import page_tasks
from beamdyn.common.screens.computations import BusyRow, LatestComputation
from beamdyn.common.screens.form_entries import NOT_GIVEN, default_words, label
from beamdyn.common.screens.open_document import OpenDocument, OtherDesign, ShownAnswer, differing
from beamdyn.common.screens.page_writer import PageWriter
from beamdyn.common.screens.processes import RunsTasks
from beamdyn.common.screens.screen_parts import KeyResult
from beamdyn.common.screens.screens import Screen

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

_MOST = 60  # largest number of differing results that a comparison lists
_DASH = (4.0, 2.5)


class Difference(NamedTuple):
    """An input or result that differs between two designs: its name, and both values as texts.

    Both values are also stored as numbers; None for a value that is not a number.
    """

    words: str
    here: str
    there: str
    numbers: tuple[float | None, float | None]

    @property
    def change(self) -> str:
        """Return the relative difference from the other design's value; "" unless both are numbers."""
        here, there = self.numbers
        return f"{100 * (here - there) / abs(there):+.3g} %" if here is not None and there else ""


def input_differences(
    here: Mapping[str, str], there: Mapping[str, str], inputs: Sequence[Input]
) -> Iterator[Difference]:
    """Yield the inputs whose texts differ between two designs, in the order of the form.

    For an empty text, the default is shown in brackets.
    """
    differ = differing(here, there)
    known = {entry.path: entry for entry in inputs}
    for path in (*known, *sorted(differ - {*known})):
        if path in differ:
            entry = known.get(path)
            default = NOT_GIVEN if entry is None else default_words(entry)
            usual = default if default == NOT_GIVEN else f"({default})"
            one, other = (entries.get(path, "").strip() for entries in (here, there))
            numbers = _value(one or default, entry), _value(other or default, entry)
            yield Difference(path if entry is None else label(entry), one or usual, other or usual, numbers)


def _value(text: str, entry: Input | None = None) -> float | None:
    """Return the number in a field text, in SI units if the input has a unit; None if there is no number."""
    try:
        number = float(text) if entry is None or not entry.quantity.unit else entry.quantity.convert(text)
    except ValueError:
        return None
    return number if math.isfinite(number) else None


def result_differences(
    here: Iterable[RenderableType], there: Iterable[RenderableType]
) -> Iterator[Difference]:
    """Yield the numbers that differ between the tables of two designs, formatted as in the tables."""
    for one, other in zip(_tables(here), _tables(there), strict=False):
        if [c.header for c in one.columns] != [c.header for c in other.columns]:
            continue
        ours, others = [*_rows(one)], [*_rows(other)]
        name_of = _naming(ours, others)
        theirs = {name_of(row): row.numbers for row in others}
        for row in ours:
            name, numbers = name_of(row) + row.unit, theirs.get(name_of(row), row.numbers)
            for head, a in row.numbers.items():
                if a != (b := numbers[head]):
                    yield Difference(name + head, a, b, (_value(a), _value(b)))


def _tables(parts: Iterable[RenderableType]) -> Iterator[Table]:
    from rich.console import Group
    from rich.table import Table

    for part in parts:
        if isinstance(part, Group):
            yield from _tables(part.renderables)
        elif isinstance(part, Table):
            yield part


class _TableRow(NamedTuple):
    """A row of a table: its number from 1, its texts, the unit, and its numbers by column heading."""

    number: int
    words: str
    unit: str
    numbers: dict[str, str]

    @property
    def place(self) -> str:
        """Return the first number of the row with its heading, such as the speed to which the row belongs."""
        head, text = next(iter(self.numbers.items()), ("", ""))
        return f"{head.removeprefix(', ')} {text}"

    @property
    def counted(self) -> str:
        """Return the texts of the table row, followed by the number of the row."""
        return ", ".join(filter(None, (self.words, f"row {self.number}")))


def _naming(here: Sequence[_TableRow], there: Sequence[_TableRow]) -> Callable[[_TableRow], str]:
    """Return the function that names the rows of two tables: by their texts, if these are unique.

    Otherwise rows are named by their first number, if the tables have several of these in common, or else by
    texts and row number.
    """
    if all(len({row.words for row in rows}) == len(rows) for rows in (here, there)):
        return lambda row: row.words or row.counted
    common = {row.place for row in here} & {row.place for row in there}
    by_place = len(common) > 1 and len(here[0].numbers) > 1
    return (lambda row: row.place) if by_place else (lambda row: row.counted)


def _rows(table: Table) -> Iterator[_TableRow]:
    """Yield the rows of a table; a single column of numbers has the heading ""."""
    heads = [str(column.header) for column in table.columns]
    words = {head for head, column in zip(heads, table.columns, strict=True) if column.justify == "left"}
    single = len(heads) - len(words) == 1
    for number, row in enumerate(zip(*(column.cells for column in table.columns), strict=True), 1):
        cells = {head: str(cell) for head, cell in zip(heads, row, strict=True)}
        name = ", ".join(cells[head] for head in heads if head in words - {"unit"} and cells[head])
        unit = f" [{cells['unit']}]" if cells.get("unit") else ""
        numbers = {"" if single else f", {head}": cells[head] for head in heads if head not in words}
        yield _TableRow(number, name, unit, numbers)


def differences_html(differences: Sequence[Difference], what: str, other: str) -> str:
    """Return an HTML table of the differences, at most 60; a sentence if there are none.

    `what` says what differs, such as inputs; `other` is the name of the other design.
    """
    if not differences:
        return f"<p>The {escape(what)} are the same.</p>"
    rows = "".join(
        f'<tr><td class="words">{escape(d.words)}</td><td class="number design">{escape(d.here)}</td>'
        f'<td class="number design">{escape(d.there)}</td><td class="number">{d.change}</td></tr>'
        for d in differences[:_MOST]
    )
    more = len(differences) - _MOST
    said = f"<p>{more} more differ.</p>" if more > 0 else ""
    return (
        f'<div class="scrolls" tabindex="0"><table><thead><tr><th class="words">{escape(what)}</th>'
        f'<th class="number">here</th><th class="number design">{escape(other)}</th>'
        f'<th class="number">change</th></tr></thead>'
        f"<tbody>{rows}</tbody></table></div>{said}"
    )


def headline_html(results: Sequence[KeyResult], other: Sequence[KeyResult] = (), name: str = "") -> str:
    """Return the most important results as HTML, beside the results of another design."""
    theirs = dict(other)
    parts = []
    for words, value in results:
        said = f"{name}: {theirs[words]}" if words in theirs and theirs[words] != value else ""
        beside = f'<span class="other">{escape(said)}</span>' if said else ""
        parts.append(f"<div><dt>{escape(words)}</dt><dd>{escape(value)}{beside}</dd></div>")
    return f'<dl class="headline">{"".join(parts)}</dl>' if parts else ""


def with_other_curves(charts: Sequence[Chart], other: Sequence[Chart], name: str) -> Sequence[Chart]:
    """Add another design's curves, dashed and grey, to charts that have the same axes."""
    if [chart.x.title + chart.y.title for chart in charts] != [c.x.title + c.y.title for c in other]:
        return charts

    def around(axis: ChartAxis, there: ChartAxis) -> ChartAxis:
        """Return an axis for both charts; limits that are automatic in either chart stay automatic."""
        low = None if axis.low is None or there.low is None else min(axis.low, there.low)
        high = None if axis.high is None or there.high is None else max(axis.high, there.high)
        return replace(axis, low=low, high=high)

    def pale(curve: ChartCurve) -> ChartCurve:
        return replace(curve, name=f"{curve.name}, {name[:30]}", pale=True, dashed=True, points=False)

    made = []
    for chart, there in zip(charts, other, strict=True):
        curves = [*chart.curves, *(pale(curve) for curve in there.curves if not curve.pale)]
        made.append(replace(chart, x=around(chart.x, there.x), y=around(chart.y, there.y), curves=curves))
    return made


def with_ghost(rows: Rows, other: Rows, name: str) -> Rows:
    """Draw the outlines of another design behind the drawings."""
    if [len(row) for row in rows] != [len(row) for row in other]:
        return rows

    def beneath(drawing: Drawing, there: Drawing) -> Drawing:
        ghosts = [
            replace(shape, role="other", width=max(shape.width, 1.0), dash=_DASH, filled=False)
            for shape in there.shapes
            if isinstance(shape, Outline | Disc)
        ]
        words = [name[:40], there.scale] if there.scale != drawing.scale else [name[:40]]
        key = {**drawing.key, "other": ", ".join(words)}
        return replace(drawing, shapes=[*ghosts, *drawing.shapes], key=key)

    return [[*map(beneath, *pair)] for pair in zip(rows, other, strict=True)]


# Panels ------------------------------------------------------------------------------------------------


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
