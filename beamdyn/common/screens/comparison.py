"""Comparison of two designs: inputs and results that differ, and the other design's drawing and curves."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import TYPE_CHECKING, NamedTuple

from beamdyn.common.drawing.chart import Chart, ChartAxis, ChartCurve
from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Outline
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.edge.inputs import Input
from beamdyn.common.screens.form_entries import Entries
from beamdyn.common.screens.history import differing
from beamdyn.common.screens.input_words import given_or_default, label
from beamdyn.common.screens.screens import KeyResult

if TYPE_CHECKING:
    from rich.console import RenderableType
    from rich.table import Table

_MOST = 60  # differences of results that are listed
_DASH = (4.0, 2.5)
_NUMBER = re.compile(r"\(?([-+]?\d+\.?\d*(?:e[-+]?\d+)?)\s*([^\d\s)][^)]*)?\)?", re.ASCII)  # and its unit


@dataclass(frozen=True)
class OtherDesign:
    """A design that the open one is compared with.

    Parameters
    ----------
    name : str
        Name of the design.
    entries : mapping
        Its entries.
    """

    name: str
    entries: Entries


class Difference(NamedTuple):
    """An input or result that differs: its name, its value here, and that of the other design."""

    words: str
    here: str
    there: str

    @property
    def change(self) -> str:
        """Relative difference of the value here from the other; "" unless both are numbers of one unit."""
        here, there = (_NUMBER.fullmatch(text) for text in (self.here, self.there))
        if here is None or there is None or here[2] != there[2] or not float(there[1]):
            return ""
        return f"{100 * (float(here[1]) - float(there[1])) / abs(float(there[1])):+.3g} %"


def input_differences(
    here: Mapping[str, str], there: Mapping[str, str], inputs: Sequence[Input]
) -> Iterator[Difference]:
    """Inputs whose texts differ, in their order; a default stands for what is not given."""
    differ = differing(here, there)
    known = {entry.path: entry for entry in inputs}
    for path in (*known, *sorted(differ - {*known})):
        if path in differ:
            words = label(known[path]) if path in known else path
            values = (_value(entries, path, known.get(path)) for entries in (here, there))
            yield Difference(words, *values)


def _value(entries: Mapping[str, str], path: str, entry: Input | None) -> str:
    text = entries.get(path, "").strip()
    return text or ("not given" if entry is None else given_or_default(entry, ""))


def result_differences(
    here: Iterable[RenderableType], there: Iterable[RenderableType]
) -> Iterator[Difference]:
    """Numbers that differ in tables which both designs have, as they are shown."""
    for one, other in zip(_tables(here), _tables(there), strict=False):
        if [c.header for c in one.columns] == [c.header for c in other.columns]:
            yield from _cells_that_differ(one, other)


def _tables(parts: Iterable[RenderableType]) -> Iterator[Table]:
    from rich.console import Group
    from rich.table import Table

    for part in parts:
        if isinstance(part, Group):
            yield from _tables(part.renderables)
        elif isinstance(part, Table):
            yield part


def _cells_that_differ(one: Table, other: Table) -> Iterator[Difference]:
    """Cells of the same row and column."""
    here, there = [*_rows(one)], [*_rows(other)]
    name_of = _naming(here, there)
    theirs = {name_of(row): row.numbers for row in there}
    for row in here:
        numbers = theirs.get(name_of(row), row.numbers)
        name = name_of(row) + row.unit
        yield from (Difference(name + h, a, numbers[h]) for h, a in row.numbers.items() if a != numbers[h])


class _TableRow(NamedTuple):
    """A row of a table: its number, words and unit, and its numbers by the heads of their columns."""

    number: int
    words: str
    unit: str
    numbers: dict[str, str]

    @property
    def place(self) -> str:
        """Its first number, such as the speed of which the others are results."""
        head, text = next(iter(self.numbers.items()), ("", ""))
        return f"{head.removeprefix(', ')} {text}"

    @property
    def counted(self) -> str:
        """Its words and its number."""
        return ", ".join(filter(None, (self.words, f"row {self.number}")))


def _naming(here: Sequence[_TableRow], there: Sequence[_TableRow]) -> Callable[[_TableRow], str]:
    """How to match rows of two tables: by words of their own, else by places in both, else by numbers."""
    if all(len({row.words for row in rows}) == len(rows) for rows in (here, there)):
        return lambda row: row.words or row.counted
    common = {row.place for row in here} & {row.place for row in there}
    by_place = len(common) > 1 and len(here[0].numbers) > 1
    return (lambda row: row.place) if by_place else (lambda row: row.counted)


def _rows(table: Table) -> Iterator[_TableRow]:
    """Rows of a table; the head is "" of a single column of numbers."""
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
    """A table of differences in HTML, the first of many; a sentence where there is none."""
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
    """The most important results in HTML, with those of another design beside them."""
    theirs = dict(other)
    parts = []
    for words, value in results:
        said = f"{name}: {theirs[words]}" if words in theirs and theirs[words] != value else ""
        beside = f'<span class="other">{escape(said)}</span>' if said else ""
        parts.append(f"<div><dt>{escape(words)}</dt><dd>{escape(value)}{beside}</dd></div>")
    return f'<dl class="headline">{"".join(parts)}</dl>' if parts else ""


def with_other_curves(charts: Sequence[Chart], other: Sequence[Chart], name: str) -> Sequence[Chart]:
    """Charts with the curves of another design's charts, pale and dashed, if these have the same axes."""
    if [chart.x.title + chart.y.title for chart in charts] != [c.x.title + c.y.title for c in other]:
        return charts
    return [_with_curves(chart, there, name) for chart, there in zip(charts, other, strict=True)]


def _with_curves(chart: Chart, there: Chart, name: str) -> Chart:
    """A chart with the curves of another one, and axes long enough for both."""
    pale = [_pale(curve, name) for curve in there.curves if not curve.pale]
    return replace(
        chart,
        x=_around_both(chart.x, there.x),
        y=_around_both(chart.y, there.y),
        curves=[*chart.curves, *pale],
    )


def _around_both(axis: ChartAxis, there: ChartAxis) -> ChartAxis:
    """An axis that spans two; an end that follows from the curves in one of them does so here."""
    lows, highs = (axis.low, there.low), (axis.high, there.high)
    return replace(axis, low=_if_given(min, lows), high=_if_given(max, highs))


def _if_given(choose: Callable[..., float], ends: tuple[float | None, float | None]) -> float | None:
    known = [end for end in ends if end is not None]
    return choose(known) if len(known) == len(ends) else None


def _pale(curve: ChartCurve, name: str) -> ChartCurve:
    return replace(curve, name=f"{curve.name}, {name[:30]}", pale=True, dashed=True, points=False)


def with_ghost(rows: Rows, other: Rows, name: str) -> Rows:
    """Drawings with the outlines of another design beneath them."""
    if [len(row) for row in rows] != [len(row) for row in other]:
        return rows
    return [
        [_with_ghost(*pair, name) for pair in zip(row, there, strict=True)]
        for row, there in zip(rows, other, strict=True)
    ]


def _with_ghost(drawing: Drawing, other: Drawing, name: str) -> Drawing:
    ghosts = [_ghost(s) for s in other.shapes if isinstance(s, Outline | Disc)]
    said = [name[:40], other.scale] if other.scale != drawing.scale else [name[:40]]
    key = {**drawing.key, "other": ", ".join(said)}
    return replace(drawing, shapes=[*ghosts, *drawing.shapes], key=key)


def _ghost(shape: Outline | Disc) -> DrawnShape:
    return replace(shape, role="other", width=max(shape.width, 1.0), dash=_DASH, filled=False)
