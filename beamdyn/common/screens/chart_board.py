"""The charts of a screen on the page."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from itertools import count
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.drawing.chart import Chart
from beamdyn.common.screens.chart_options import marks_of, options_of
from beamdyn.common.screens.page_writer import PageWriter

_HOW = "A chart that has the focus is zoomed by + and -, moved by the arrow keys, and shown whole by 0."
_NO_TOOLBOX = {"toolbox": {"show": False}}  # while something is held: it would be made anew for each picture


class _ShownChart:
    """A chart below its heading on the page; its element is kept and given new data."""

    def __init__(self, writer: PageWriter) -> None:
        self._writer = writer
        self._options: dict[str, Any] = {}
        self.place: Any = ui.element("div")
        with self.place:
            self.heading: Any = ui.label().classes("chart-title").props('role="heading" aria-level="3"')
            self.element: Any = ui.echart({}, renderer="svg").classes("chart").props('role="img" tabindex=0')
        self.element.on("keydown", js_handler=f"(event) => zoomChart(event, {self.element.id})")
        # What the component restores is what it was given first: the present data follow.
        self.element.on("chart:restore", self.update, args=[])

    @property
    def id(self) -> int:
        """Number of its element."""
        return self.element.id

    def fill(self, chart: Chart) -> None:
        """Show another chart."""
        self.heading.set_text(chart.title)
        last, self._options = self._options, options_of(chart)
        self._options["toolbox"]["feature"]["mySave"][":onclick"] = "saveChart"
        with self.element.props.suspend_updates():
            self.element.props["aria-label"] = chart.words
        if self._writer.is_ahead:
            others = {name: value for name, value in self._options.items() if last.get(name) != value}
            self._writer.write(self.element, {"options": _without_scripts(others) | _NO_TOOLBOX})
            self._writer.tell_later(self)
        else:
            self.update()

    def update(self) -> None:
        """Tell NiceGUI what is shown; not while something is held, as that takes time for each number."""
        with self.element.props.suspend_updates():
            self.element.props["options"] = self._options
        self.element.update()

    def move_cursor(self, chart: Chart) -> None:
        """Show the marks of a chart, of which nothing else has changed."""
        self._options["series"][0] = marks_of(chart)
        self.element.run_chart_method("setOption", {"series": self._options["series"][:1]})


class ChartBoard:
    """Charts below one another; their elements are kept and given new data, so that zooming lasts.

    Parameters
    ----------
    words : str
        Description of the charts.
    writer : PageWriter
        Writer of the charts while something is held.
    """

    def __init__(self, words: str, writer: PageWriter) -> None:
        self._writer = writer
        self._made: list[_ShownChart] = []
        self._charts: list[Chart] = []  # that are shown
        self._shown: list[dict[str, Any]] = []  # their options without their cursors
        self._column: Any = ui.element("div").classes("w-full charts")
        self._column.props["data-words"] = words
        self._how: Any = ui.label(_HOW).classes("status")
        self._how.set_visibility(False)

    def _options_without_cursor(self, chart: Chart, i: int) -> dict[str, Any]:
        """Options of a chart; those that are shown where nothing else than its cursor has changed."""
        if i < len(self._charts):
            shown, rest = self._charts[i], [each.name for each in fields(Chart) if each.name != "cursor"]
            if all(getattr(shown, name) is getattr(chart, name) for name in rest):
                return self._shown[i]
        return options_of(replace(chart, cursor=None))

    def _elements(self) -> Iterator[Any]:
        """Places and headings of the charts."""
        for made in self._made:
            yield from (made.place, made.heading)

    def show(self, charts: Sequence[Chart]) -> None:
        """Show these charts in place of the last ones."""
        while len(self._made) < len(charts):
            with self._column:
                self._made.append(_ShownChart(self._writer))
        with self._writer.writing(self._column, self._how, *self._elements()):
            last, self._shown = self._shown, [*map(self._options_without_cursor, charts, count())]
            self._charts = [*charts]
            for i, made in enumerate(self._made):
                made.place.set_visibility(i < len(charts))
            if last != self._shown:
                self._column.props["data-picture"] = f"{crc32(json.dumps(self._shown).encode()):08x}"
                self._column.update()
                self._how.set_visibility(bool(charts))
            for i, (made, chart) in enumerate(zip(self._made, charts, strict=False)):
                if i < len(last) and (last[i] is self._shown[i] or last[i] == self._shown[i]):
                    made.move_cursor(chart)
                else:
                    made.fill(chart)


def _without_scripts(options: dict[str, Any]) -> dict[str, Any]:
    """Options without those that the component reads as scripts, which do not change."""
    return {
        name: _without_scripts(value) if isinstance(value, dict) else value
        for name, value in options.items()
        if not name.startswith(":")
    }
