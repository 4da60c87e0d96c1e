"""The charts of a screen as elements of the page."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import fields, replace
from itertools import count
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.drawing.shapes import Chart
from beamdyn.common.screens.chart_options import marks_of, options_of
from beamdyn.common.screens.page_writer import PageWriter

_HOW = "A chart that has the focus is zoomed by + and -, moved by the arrow keys, and shown whole by 0."
# While a handle or slider is held, the toolbox is hidden: it would be rebuilt for each picture.
_NO_TOOLBOX = {"toolbox": {"show": False}}


class _ShownChart:
    """A chart below its heading; when the chart changes, its element is kept and gets new data."""

    def __init__(self, writer: PageWriter) -> None:
        self._writer = writer
        self._options: dict[str, Any] = {}
        self.place: Any = ui.element("div")
        with self.place:
            self.heading: Any = ui.label().classes("chart-title").props('role="heading" aria-level="3"')
            self.element: Any = ui.echart({}, renderer="svg").classes("chart").props('role="img" tabindex=0')
        self.element.on("keydown", js_handler=f"(event) => zoomChart(event, {self.element.id})")
        # The chart component restores the data that it received first, so the present data are sent again.
        self.element.on("chart:restore", self.update, args=[])

    @property
    def id(self) -> int:
        """Return the identifier of the chart's element on the page."""
        return self.element.id

    def fill(self, chart: Chart, options: dict[str, Any]) -> None:
        """Show another chart; `options` are the options of the chart without its cursor."""
        self.heading.set_text(chart.title)
        series = [marks_of(chart), *options["series"][1:]]
        last, self._options = self._options, _saved_by_script(options) | {"series": series}
        with self.element.props.suspend_updates():
            self.element.props["aria-label"] = chart.words
        if self._writer.is_ahead:
            others = {name: value for name, value in self._options.items() if last.get(name) != value}
            changed = _without_scripts(others) | {"series": series} | _NO_TOOLBOX
            self._writer.write(self.element, {"options": changed})
            self._writer.tell_later(self)
        else:
            self.update()

    def update(self) -> None:
        """Send the chart to the browser through NiceGUI, which takes time in proportion to the data."""
        with self.element.props.suspend_updates():
            self.element.props["options"] = self._options
        self.element.update()

    def move_cursor(self, chart: Chart) -> None:
        """Move the cursor of the chart; everything else is unchanged."""
        self._options["series"][0] = marks_of(chart)
        self.element.run_chart_method("setOption", {"series": self._options["series"][:1]})


class ChartBoard:
    """Charts below one another; their elements are kept and get new data, so that the zoom is kept, too.

    Parameters
    ----------
    words : str
        Description of the charts for screen readers.
    writer : PageWriter
        Object that updates the charts while a handle or slider is held.
    """

    def __init__(self, words: str, writer: PageWriter) -> None:
        self._writer = writer
        self._made: list[_ShownChart] = []
        self._charts: list[Chart] = []  # charts that the page shows
        self._shown: list[dict[str, Any]] = []  # options of the shown charts, without the cursor
        self._sums: list[int] = []  # checksum of each chart's options
        self._column: Any = ui.element("div").classes("w-full charts")
        self._column.props["data-words"] = words
        self._how: Any = ui.label(_HOW).classes("status")
        self._how.set_visibility(False)

    def _options_without_cursor(self, chart: Chart, i: int) -> dict[str, Any]:
        """Return the options of chart i without cursor; reuse the previous ones if nothing else changed."""
        if i < len(self._charts):
            shown, rest = self._charts[i], [each.name for each in fields(Chart) if each.name != "cursor"]
            if all(getattr(shown, name) is getattr(chart, name) for name in rest):
                return self._shown[i]
        return options_of(replace(chart, cursor=None))

    def _sum_of(self, i: int, options: dict[str, Any], last: dict[str, Any]) -> int:
        """Return the checksum of chart i's options; it is stored already if they are the object `last`."""
        return self._sums[i] if options is last else crc32(json.dumps(options).encode())

    def _elements(self) -> Iterator[Any]:
        """Yield the elements of all charts and headings."""
        for made in self._made:
            yield from (made.place, made.heading)

    def show(self, charts: Sequence[Chart]) -> None:
        """Show the given charts in place of the previous ones."""
        while len(self._made) < len(charts):
            with self._column:
                self._made.append(_ShownChart(self._writer))
        with self._writer.writing(self._column, self._how, *self._elements()):
            last, self._shown = self._shown, [*map(self._options_without_cursor, charts, count())]
            self._charts = [*charts]
            for i, made in enumerate(self._made):
                made.place.set_visibility(i < len(charts))
            if last != self._shown:
                self._sums = [*map(self._sum_of, count(), self._shown, [*last, *[{}] * len(charts)])]
                self._column.props["data-picture"] = "-".join(f"{each:08x}" for each in self._sums)
                self._column.update()
                self._how.set_visibility(bool(charts))
            for i, (made, chart) in enumerate(zip(self._made, charts, strict=False)):
                if i < len(last) and (last[i] is self._shown[i] or last[i] == self._shown[i]):
                    made.move_cursor(chart)
                else:
                    made.fill(chart, self._shown[i])


def _saved_by_script(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options with a save button that calls the function `saveChart` of the page's script."""
    toolbox = options["toolbox"]
    feature = toolbox["feature"]
    saving = feature["mySave"] | {":onclick": "saveChart"}
    return options | {"toolbox": toolbox | {"feature": feature | {"mySave": saving}}}


def _without_scripts(options: dict[str, Any]) -> dict[str, Any]:
    """Return the options without scripts (options whose name begins with ":"), which never change."""
    return {
        name: _without_scripts(value) if isinstance(value, dict) else value
        for name, value in options.items()
        if not name.startswith(":")
    }
