"""Drawings on matplotlib's axes."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.drawing.layout import Fit, Frame, Layout, Rule, Text, arrange, heading
from beamdyn.common.drawing.shapes import Arrow, Disc, Drawing, DrawnShape, Outline, Symbol
from beamdyn.common.drawing.sheet import Paper, Rows, lay_out
from beamdyn.common.drawing.style import AREA, PAPER, ink
from beamdyn.common.drawing.text_width import LINE_HEIGHT

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_INCH = 72.0  # [pt]
_HALO = 2.6
_EDGE = 4.0  # between the frame and the title
_MARKERS = {"pin": "o", "dot": "o", "cross": "+", "diamond": "D"}
_LOWEST, _LETTERS = 1.0, 50.0  # zorder of the first shape, and of texts


def figure_of(rows: Rows, paper: Paper | None = None) -> Figure:
    """Draw drawings beside one another, row by row.

    Parameters
    ----------
    rows : sequence of sequences of Drawing
        The drawings; those of a row share its width evenly, and have one scale.
    paper : Paper, optional
        Size of the figure; by what is drawn if not given.
    """
    from matplotlib.figure import Figure

    paper = paper or Paper.of(rows)
    width, height = paper.width, paper.height
    figure = Figure(figsize=(width / _INCH, height / _INCH))
    for layout in lay_out(rows, paper):
        left, top, right, bottom = layout.frame
        box = (left / width, 1 - bottom / height, (right - left) / width, (bottom - top) / height)
        _fill(figure.add_axes(box), layout)
    return figure


def draw_in(figure: Figure, box: tuple[float, float, float, float], drawing: Drawing) -> Axes:
    """Draw in a part of a figure.

    Parameters
    ----------
    figure : Figure
        Without a layout engine, which would move the axes.
    box : tuple of float
        Left, bottom, width, height in parts of the figure.
    drawing : Drawing
        The drawing.

    Returns
    -------
    Axes
        New axes.
    """
    return draw_on(figure.add_axes(box), drawing)


def draw_on(ax: Axes, drawing: Drawing, fit: Fit | None = None) -> Axes:
    """Draw on axes, whose place in their figure must be final: labels are placed for their size.

    Parameters
    ----------
    ax : Axes
        Where to draw, in the drawing's unit; the title stands within them.
    drawing : Drawing
        The drawing.
    fit : Fit, optional
        Transformation to paper; chosen by what is drawn if not given.

    Returns
    -------
    Axes
        The same, without ticks.
    """
    return _fill(ax, arrange(drawing, frame_of(ax), fit))


def _fill(ax: Axes, layout: Layout) -> Axes:
    """Draw a layout on axes that are as large as its frame."""
    left, top, right, bottom = layout.frame
    drawing, fit = layout.drawing, layout.fit
    low, high = fit.from_paper([(left, bottom), (right, top)])
    ax.set(xlim=(low[0], high[0]), ylim=(low[1], high[1]))
    ax.set_axis_off()
    above = heading(drawing.title, right - left, bottom - top)
    ax.set_title(_literal("\n".join(above.lines)), fontsize=above.letters, color=ink("text").line, y=1.0,
                 pad=-_EDGE, va="top", linespacing=LINE_HEIGHT)  # fmt: skip
    for order, shape in enumerate(drawing.shapes):
        _DRAW[type(shape)](ax, shape, _LOWEST + 0.01 * order, fit)
    for rule in layout.rules:
        _draw_rule(ax, rule, fit)
    for text in layout.texts[len(above.lines) :]:  # the title's come first
        _write(ax, text, fit)
    return ax


def frame_of(ax: Axes) -> Frame:
    """The frame (0, 0, width, height) of axes on paper [pt]."""
    figure: Any = ax.figure
    width, height = ax.get_position().size * figure.figure.get_size_inches() * _INCH
    return 0.0, 0.0, float(width), float(height)


def _literal(text: str) -> str:
    """A text in which matplotlib reads no formula."""
    return text.replace("$", r"\$")


def _colours(shape: DrawnShape) -> tuple[str, str]:
    found = ink(shape.role)
    return found.line, found.area


def _draw_outline(ax: Axes, shape: Outline, order: float, _: Fit) -> None:
    (line, area), points = _colours(shape), np.asarray(shape.points, dtype=float).reshape(-1, 2)
    if shape.filled:
        ax.fill(*points.T, facecolor=area, edgecolor="none", alpha=AREA, zorder=order)
    if shape.width:
        closed = np.vstack([points, points[:1]]) if shape.closed else points
        style: Any = (0, tuple(d / shape.width for d in shape.dash)) if shape.dash else "-"
        ax.plot(*closed.T, color=line, linewidth=shape.width, linestyle=style, zorder=order,
                solid_capstyle="butt", solid_joinstyle="round")  # fmt: skip


def _draw_disc(ax: Axes, shape: Disc, order: float, _: Fit) -> None:
    from matplotlib.patches import Circle

    line, area = _colours(shape)
    style: Any = (0, tuple(d / shape.width for d in shape.dash)) if shape.dash else "-"
    face = area if shape.filled else "none"
    centre = (float(shape.centre[0]), float(shape.centre[1]))
    ax.add_patch(Circle(centre, shape.radius, facecolor=face, edgecolor=line, linewidth=shape.width,
                        linestyle=style, zorder=order))  # fmt: skip


def _draw_symbol(ax: Axes, shape: Symbol, order: float, fit: Fit) -> None:
    line, area = _colours(shape)
    x, y = (float(v) for v in shape.at)
    if shape.kind == "ground":
        half, height = shape.size / 2 / fit.scale, 0.85 * shape.size / fit.scale
        ax.fill((x, x + half, x - half), (y, y - height, y - height), color=line, linewidth=0, zorder=order)
        return
    face = area if shape.kind == "pin" else line
    edge = PAPER.line if shape.kind == "diamond" else line
    ax.plot(x, y, _MARKERS[shape.kind], color=face, markeredgecolor=edge, markersize=shape.size, zorder=order)


def _draw_arrow(ax: Axes, shape: Arrow, order: float, _: Fit) -> None:
    (x0, y0), (x1, y1) = shape.foot, shape.tip
    how = {
        "arrowstyle": "<|-|>" if shape.both else "-|>",
        "color": ink(shape.role).line,
        "linewidth": shape.width,
        "shrinkA": 0,
        "shrinkB": 0,
    }
    ax.annotate("", (x1, y1), (x0, y0), arrowprops=how, zorder=order, annotation_clip=False)


_DRAW: dict[type[DrawnShape], Any] = {
    Outline: _draw_outline,
    Disc: _draw_disc,
    Symbol: _draw_symbol,
    Arrow: _draw_arrow,
}


def _draw_rule(ax: Axes, rule: Rule, fit: Fit) -> None:
    ends = fit.from_paper(rule.ends)
    colour = ink(rule.role).line
    ax.plot(*ends.T, color=colour, linewidth=rule.width, zorder=_LETTERS - 1, solid_capstyle="butt")


def _write(ax: Axes, text: Text, fit: Fit) -> None:
    from matplotlib.patheffects import withStroke

    halo = [withStroke(linewidth=_HALO, foreground=PAPER.line)]
    height = text.letters * LINE_HEIGHT
    top = text.centre[1] - height * (len(text.lines) - 1) / 2
    for i, line in enumerate(text.lines):
        symbol = f"${text.symbol}$ " if text.symbol and i == 0 else ""
        x, y = fit.from_paper((text.centre[0], top + height * i))
        ax.text(x, y, (symbol + _literal(line)).strip(), color=ink(text.role).line, fontsize=text.letters,
                ha="center", va="center_baseline", zorder=_LETTERS, path_effects=halo)  # fmt: skip
