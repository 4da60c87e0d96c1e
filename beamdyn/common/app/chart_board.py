"""The charts of a screen on the page."""

from __future__ import annotations

import json
from collections.abc import Sequence
from dataclasses import replace
from typing import Any
from zlib import crc32

from nicegui import ui

from beamdyn.common.app.chart import Chart, chart_colours, marks_of, options_of

STYLE = (
    chart_colours(":root")
    + chart_colours(".body--dark", dark=True)
    + """
.chart { width: 100%; max-width: 1000px; height: clamp(330px, 52vh, 480px); }
.chart-title { font-weight: 600; margin-top: 0.4rem; }
"""
)


class ChartBoard:
    """Charts below one another; each is kept and given new data, so that zooming lasts.

    Parameters
    ----------
    words : str
        What they show.
    """

    def __init__(self, words: str) -> None:
        self._made: list[tuple[Any, Any]] = []  # headings and charts
        self._shown: list[dict[str, Any]] = []  # options, but for what moves with the player
        self._column: Any = ui.column().classes("w-full gap-0 charts")
        self._column.props["data-words"] = words

    def show(self, charts: Sequence[Chart]) -> None:
        """Show these charts in place of the last ones."""
        while len(self._made) < len(charts):
            with self._column:
                heading = ui.label().classes("chart-title").props('role="heading" aria-level="3"')
                self._made.append(
                    (heading, ui.echart({}, renderer="svg").classes("chart").props('role="img"'))
                )
        for i, parts in enumerate(self._made):
            for part in parts:
                part.set_visibility(i < len(charts))
        last, self._shown = self._shown, [options_of(replace(chart, cursor=None)) for chart in charts]
        if last != self._shown:
            self._column.props["data-picture"] = f"{crc32(json.dumps(self._shown).encode()):08x}"
            self._column.update()
        for i, ((heading, made), chart) in enumerate(zip(self._made, charts, strict=False)):
            if last[i : i + 1] == [self._shown[i]]:  # the cursor alone has moved
                made.run_chart_method("setOption", {"series": [marks_of(chart)]})
                continue
            heading.set_text(chart.title)
            made.props["aria-label"] = chart.words
            made.props["options"] = options_of(chart)
            made.update()
