"""Plot charts on matplotlib axes, for picture files."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import Any

from beamdyn.common.drawing.shapes import Chart
from beamdyn.common.drawing.strokes import ink
from beamdyn.common.results.pictures import COLOURS, Axes, Figure

_LETTERS, _TITLE = 9, 11  # font sizes of the texts and of the title [pt]
_OF_LABEL = 16  # most characters in a line of the label of the y axis
_PALE, _CURSOR = "0.6", "0.4"
_GAP = 0.01  # distance of a text from the bottom of the axes, as a fraction of their height
_BESIDE: dict[str, Any] = {"va": "bottom"}
_ALONG: dict[str, Any] = {"ha": "right", "va": "top", "rotation": 90}
# Height of the top of the text at a vertical line, as a fraction of the axes' height: below the legend.
_BEHIND_LEGEND = 0.92


def plot_chart(ax: Axes, chart: Chart) -> Axes:
    """Plot a chart, with its title.

    Parameters
    ----------
    ax : Axes
        Axes on which to draw the chart.
    chart : Chart
        The chart.

    Returns
    -------
    Axes
        The axes that were given.
    """
    colours = [_PALE if n is None else COLOURS[n % len(COLOURS)] for n in chart.colour_numbers]
    for curve, colour in zip(chart.curves, colours, strict=True):
        style, width = "--" if curve.dashed else "-", 1.0 if curve.pale else 1.8
        ax.plot(curve.x, curve.y, style, color=colour, linewidth=width, label=curve.name)
    for points in chart.points:
        x, y = ([at[k] for at in points.at] for k in (0, 1))
        ax.plot(x, y, "o", color=ink(points.role).line, markerfacecolor="white", label=points.name)
    colour_of = {curve.name: colour for curve, colour in zip(chart.curves, colours, strict=True)}
    across = ax.get_xaxis_transform()
    for mark in chart.marks:  # a vertical line with its text, beside the bottom end or along the top end
        colour = colour_of.get(mark.curve, _CURSOR)
        ax.axvline(mark.at, color=colour, linewidth=1.2, linestyle=":" if mark.at_foot else "-.")
        height, place = (_GAP, _BESIDE) if mark.at_foot else (_BEHIND_LEGEND, _ALONG)
        text = ax.text(mark.at, height, f" {mark.text} ", color=colour, fontsize=_LETTERS, transform=across)
        text.set(**place)
    if chart.cursor is not None:
        ax.axvline(chart.cursor, color=_CURSOR, linewidth=1, linestyle=":")
    for band in chart.bands:
        ax.axvspan(band.low, band.high, color=_PALE, alpha=0.16, linewidth=0, label=band.text)
    for axis, direction in ((chart.x, "x"), (chart.y, "y")):
        scale = {"scale": "log"} if axis.logarithmic else {}
        ends = {"lim": (axis.low, axis.high)} if (axis.low, axis.high) != (None, None) else {}
        given = {"label": axis.title} | scale | ends
        ax.set(**{f"{direction}{name}": value for name, value in given.items()})
    ax.set_title(chart.title, fontsize=_TITLE)
    ax.grid(color="0.9", linewidth=0.8)
    ax.set_axisbelow(True)
    ax.legend(fontsize=_LETTERS)
    return ax


def plot_charts_of_one_x(
    figure: Figure, charts: Sequence[Chart], left: float, heights: Sequence[float]
) -> None:
    """Plot charts with a common x axis below one another in a figure, right of `left`, without titles.

    Parameters
    ----------
    figure : Figure
        The figure; it must not have a layout engine, which would move the axes.
    charts : sequence of Chart
        The charts.
    left : float
        Left edge of the axes, as a fraction of the figure's width.
    heights : sequence of float
        Heights of the charts, relative to one another.
    """
    edges = {"left": left, "right": 0.985, "bottom": 0.09, "top": 0.96}
    cells = figure.add_gridspec(len(charts), 1, height_ratios=heights, hspace=0.08, **edges)
    for row, chart in enumerate(charts):
        ax = plot_chart(figure.add_subplot(cells[row, 0]), chart)
        ax.set_title("")
        # The label of the y axis is wrapped, so that it is not longer than the axes are high.
        ax.set_ylabel(fill(chart.y.title, _OF_LABEL))
        if row < len(charts) - 1:
            ax.set_xlabel("")
            ax.tick_params(labelbottom=False)
