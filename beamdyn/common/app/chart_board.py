"""The charts of a screen on the page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.app.chart_options import chart_colours, marks_of, options_of
from beamdyn.common.app.page_writer import PageWriter
from beamdyn.common.drawing.chart import Chart

STYLE = (
    chart_colours(":root")
    + chart_colours(".body--dark", dark=True)
    + """
.chart { width: 100%; max-width: 1000px; height: clamp(330px, 52vh, 480px); contain: strict; }
.chart-title { font-weight: 600; margin-top: 0.4rem; }
"""
)


_HOW = "A chart that has the focus is zoomed by + and -, moved by the arrow keys, and shown whole by 0."
# What the signs of a chart do, by keys; each a change of the part [%] that is shown.
_KEYS = """(event) => {
  const chart = getElement(%d)?.chart, zoom = chart?.getOption().dataZoom?.[0];
  if (!zoom || event.ctrlKey || event.altKey || event.metaKey) return;
  const {start, end} = zoom, step = 0.1 * (end - start);
  const to = {"+": [start + step, end - step], "=": [start + step, end - step],
    "-": [start - 1.25 * step, end + 1.25 * step], "0": [0, 100],
    ArrowLeft: [Math.max(start - step, 0), end - Math.min(step, start)],
    ArrowRight: [start + Math.min(step, 100 - end), Math.min(end + step, 100)]}[event.key];
  if (!to) return;
  event.preventDefault();
  chart.dispatchAction({type: "dataZoom", start: Math.max(to[0], 0), end: Math.min(to[1], 100)});
}"""

_NO_SIGNS = {"toolbox": {"show": False}}  # while something is held: they are made anew for each picture


class ChartBoard:
    """Charts below one another; each is kept and given new data, so that zooming lasts.

    Parameters
    ----------
    words : str
        What they show.
    writer : PageWriter
        What writes them while something is held.
    """

    def __init__(self, words: str, writer: PageWriter) -> None:
        self._writer = writer
        self._made: list[tuple[Any, Any]] = []  # headings and charts
        self._shown: list[dict[str, Any]] = []  # options, but for what moves with the player
        self._column: Any = ui.column().classes("w-full gap-0 charts")
        self._column.props["data-words"] = words
        self._how: Any = ui.label(_HOW).classes("status")
        self._how.set_visibility(False)

    def show(self, charts: Sequence[Chart]) -> None:
        """Show these charts in place of the last ones."""
        while len(self._made) < len(charts):
            with self._column:
                self._made.append(self._make())
        with self._writer.writing(self._column, self._how, *(heading for heading, _ in self._made)):
            self._put(charts)

    def _put(self, charts: Sequence[Chart]) -> None:
        for i, parts in enumerate(self._made):
            for part in parts:
                part.set_visibility(i < len(charts))
        last, self._shown = self._shown, [options_of(replace(chart, cursor=None)) for chart in charts]
        if last != self._shown:
            self._column.props["data-picture"] = f"{crc32(json.dumps(self._shown).encode()):08x}"
            self._column.update()
            self._how.set_visibility(bool(charts))
        for i, ((heading, made), chart) in enumerate(zip(self._made, charts, strict=False)):
            if last[i : i + 1] == [self._shown[i]]:  # the cursor alone has moved
                made.run_chart_method("setOption", {"series": [marks_of(chart)]})
                continue
            heading.set_text(chart.title)
            self._fill(made, chart)

    def _fill(self, made: Any, chart: Chart) -> None:
        with made.props.suspend_updates():
            made.props["aria-label"] = chart.words
            last, made.props["options"] = made.props["options"], (options := options_of(chart))
        if self._writer.is_ahead:
            others = {name: value for name, value in options.items() if last.get(name) != value}
            self._writer.write(made, {"options": _without_scripts(others) | _NO_SIGNS})
            self._writer.tell_later(made)
        else:
            made.update()

    def _make(self) -> tuple[Any, Any]:
        """A heading, and a chart below it that keys zoom and move."""
        heading = ui.label().classes("chart-title").props('role="heading" aria-level="3"')
        chart = ui.echart({}, renderer="svg").classes("chart").props('role="img" tabindex=0')
        chart.on("keydown", js_handler=_KEYS % chart.id)
        return heading, chart


def _without_scripts(options: dict[str, Any]) -> dict[str, Any]:
    """Options without those that the component reads as scripts, which stay what they are."""
    return {
        name: _without_scripts(value) if isinstance(value, dict) else value
        for name, value in options.items()
        if not name.startswith(":")
    }
