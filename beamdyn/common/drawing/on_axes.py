"""Draw machine drawings and charts on matplotlib axes, for picture files."""

from __future__ import annotations

from collections.abc import Sequence
from textwrap import fill
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.drawing import strokes
from beamdyn.common.drawing.layout import Fit, Frame, Layout, Paper, Rows, arrange, heading, lay_out
from beamdyn.common.drawing.shapes import Chart, Drawing
from beamdyn.common.drawing.strokes import GROUND, HALO, Letters, Stroke, colour, ink, letters_of, strokes_of
from beamdyn.common.drawing.text_width import LINE_HEIGHT
from beamdyn.common.results.pictures import COLOURS, Axes, Figure, new_figure

if TYPE_CHECKING:
    from matplotlib.patches import Patch
    from matplotlib.path import Path

_INCH = 72.0  # one inch [pt]
_EDGE = 4.0  # distance between the frame and the title [pt]


def figure_of(rows: Rows, paper: Paper | None = None) -> Figure:
    """Make a figure with rows of drawings; the drawings of a row are side by side.

    Parameters
    ----------
    rows : sequence of sequences of Drawing
        The drawings; those of a row have equal widths and the same scale.
    paper : Paper, optional
        Size of the figure; if not given, it is chosen from the proportions of the drawings.
    """
    paper = paper or Paper.of(rows)
    width, height = paper.width, paper.height
    figure = new_figure(width / _INCH, height / _INCH, layout=None)
    for layout in lay_out(rows, paper):
        left, top, right, bottom = layout.frame
        box = (left / width, 1 - bottom / height, (right - left) / width, (bottom - top) / height)
        _fill(figure.add_axes(box), layout)
    return figure


def draw_in(figure: Figure, box: tuple[float, float, float, float], drawing: Drawing) -> Axes:
    """Draw a drawing in a part of a figure.

    Parameters
    ----------
    figure : Figure
        The figure; it must not have a layout engine, which would move the axes.
    box : tuple of float
        Left, bottom, width and height, as fractions of the figure.
    drawing : Drawing
        The drawing.

    Returns
    -------
    Axes
        New axes.
    """
    return draw_on(figure.add_axes(box), drawing)


def draw_on(ax: Axes, drawing: Drawing, fit: Fit | None = None) -> Axes:
    """Draw a drawing on axes whose size is final, as labels are placed for this size.

    Parameters
    ----------
    ax : Axes
        Axes on which to draw, in the drawing's length unit; the title is drawn inside the axes.
    drawing : Drawing
        The drawing.
    fit : Fit, optional
        Transformation to paper; if not given, the drawing is made as large as the axes allow.

    Returns
    -------
    Axes
        The given axes, without ticks.
    """
    return _fill(ax, arrange(drawing, frame_of(ax), fit))


def _fill(ax: Axes, layout: Layout) -> Axes:
    """Draw a layout on axes that have the size of its frame."""
    left, top, right, bottom = layout.frame
    drawing, fit = layout.drawing, layout.fit
    low, high = fit.from_paper([(left, bottom), (right, top)])
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    ax.set_axis_off()
    above = heading(drawing.title, right - left, bottom - top)
    ax.set_title(_literal("\n".join(above.lines)), fontsize=above.letters, color=colour("text"), y=1.0,
                 pad=-_EDGE, va="top", linespacing=LINE_HEIGHT)  # fmt: skip
    for stroke in strokes_of(layout):
        _draw(ax, stroke, fit)
    for text in layout.texts[len(above.lines) :]:  # the first texts are the lines of the title
        for line in letters_of(text):
            _write(ax, line, fit)
    return ax


def frame_of(ax: Axes) -> Frame:
    """Return the frame (0, 0, width, height) of axes on paper [pt]."""
    figure: Any = ax.figure
    width, height = ax.get_position().size * figure.figure.get_size_inches() * _INCH
    return 0.0, 0.0, float(width), float(height)


def _literal(text: str) -> str:
    """Escape a text, so that matplotlib does not read parts of it as a formula."""
    return text.replace("$", r"\$")


def _draw(ax: Axes, stroke: Stroke, fit: Fit) -> Patch:
    """Draw a path or a circle; its points are converted from paper [pt] to the units of the axes."""
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Circle, PathPatch

    pen = stroke.pen
    style: Any = {
        "facecolor": to_rgba(colour(pen.fill), pen.opacity) if pen.fill else "none",
        "edgecolor": colour(pen.line) if pen.line else "none",
        "linewidth": pen.width if pen.line else 0.0,
        "linestyle": (0, tuple(d / pen.width for d in pen.dash)) if pen.dash and pen.line else "-",
        "capstyle": "butt",
        "joinstyle": "round",
    }
    if isinstance(stroke, strokes.Circle):
        x, y = fit.from_paper(stroke.centre)
        return ax.add_patch(Circle((float(x), float(y)), stroke.radius / fit.scale, **style))
    return ax.add_patch(PathPatch(_path(stroke, fit), **style))


def _path(stroke: strokes.Polylines, fit: Fit) -> Path:
    from matplotlib.path import Path

    ways = [fit.from_paper(run) for run in stroke.runs]
    if not stroke.closed:
        return Path.make_compound_path(*map(Path, ways))
    return Path.make_compound_path(*(Path(np.vstack([way, way[:1]]), closed=True) for way in ways))


def _write(ax: Axes, line: Letters, fit: Fit) -> None:
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=HALO, foreground=colour(GROUND))]
    symbol = f"${line.symbol}$ " if line.symbol else ""
    x, y = fit.from_paper((line.middle, line.baseline))
    ax.text(x, y, (symbol + _literal(line.words)).strip(), color=colour(line.colour), fontsize=line.size,
            ha="center", va="baseline", path_effects=halo)  # fmt: skip


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
    for curve, chosen in zip(chart.curves, colours, strict=True):
        style, width = "--" if curve.dashed else "-", 1.0 if curve.pale else 1.8
        ax.plot(curve.x, curve.y, style, color=chosen, linewidth=width, label=curve.name)
    for points in chart.points:
        x, y = ([at[k] for at in points.at] for k in (0, 1))
        ax.plot(x, y, "o", color=ink(points.role).line, markerfacecolor="white", label=points.name)
    colour_of = {curve.name: chosen for curve, chosen in zip(chart.curves, colours, strict=True)}
    across = ax.get_xaxis_transform()
    for mark in chart.marks:  # a vertical line, its text at the top, or if `at_foot` at the bottom
        chosen = colour_of.get(mark.curve, _CURSOR)
        ax.axvline(mark.at, color=chosen, linewidth=1.2, linestyle=":" if mark.at_foot else "-.")
        height, place = (_GAP, _BESIDE) if mark.at_foot else (_BEHIND_LEGEND, _ALONG)
        text = ax.text(mark.at, height, f" {mark.text} ", color=chosen, fontsize=_LETTERS, transform=across)
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
