"""Set up axes of plots, draw lines that differ in colour and dashes, and write notes below a figure."""

from __future__ import annotations

import textwrap
from collections.abc import Iterable, Sequence
from contextlib import suppress
from typing import Any

import numpy as np

from beamdyn.common.results.columns import DisplayUnits
from beamdyn.common.results.pictures import COLOURS, DASHES, Axes, Figure, add_legend, new_axes

# Line styles by the main motion of a mode: bending in two directions, torsion, camber.
MOTION_DASHES = "-", "--", ":", "-."
_LETTERS = 15.0  # characters of a note that fit into an inch
_COLOUR = "#5a4200"  # text colour of the notes


def set_up_axes(ax: Axes | None, xlabel: str, ylabel: str) -> Axes:
    """Label axes, and give them a grid and tick numbers without offset; make new axes if none are given."""
    ax = new_axes() if ax is None else ax
    ax.set_xlabel(xlabel, fontsize=12)
    ax.set_ylabel(ylabel, fontsize=12)
    ax.tick_params(labelsize=11)
    for axis in ("x", "y"):
        with suppress(AttributeError):  # raised if given axes have a scale without offset, such as log
            ax.ticklabel_format(axis=axis, useOffset=False)
    ax.margins(x=0.02)
    ax.grid(color="0.85", linewidth=0.7)
    ax.set_axisbelow(True)
    return ax


def panels(count: int, ax: Axes | None = None, columns: int = 2) -> tuple[Axes, list[Axes]]:
    """Replace axes by several panels in the same area, by default two in a row.

    Parameters
    ----------
    count : int
        Number of panels.
    ax : Axes, optional
        Axes whose area is divided into panels; axes of a new figure if not given.
    columns : int
        Largest number of panels in a row.

    Returns
    -------
    Axes
        The axes that the panels replace, which are hidden.
    list of Axes
        The panels, row by row from the top left.
    """
    columns = min(columns, count)
    rows = -(-count // columns)
    if ax is None:
        ax = new_axes(6.5 * columns, 4.5 * rows)
    place, figure = ax.get_subplotspec(), ax.get_figure()
    if place is None or figure is None:
        raise ValueError("ax: give axes made by subplots, whose area can be divided")
    ax.set_axis_off()
    grid = place.subgridspec(rows, columns)
    return ax, [figure.add_subplot(grid[divmod(i, columns)]) for i in range(count)]


def speed_label(units: DisplayUnits) -> str:
    """Return the label of the axis of rotational speed, with its display unit."""
    return f"angular speed [{units.speed_unit().name}]"


def position_label(units: DisplayUnits) -> str:
    """Return the label of the axis of positions along the beam, with its display unit."""
    return f"position along the beam [{units.length_unit('m').name}]"


def draw_lines(ax: Axes, x: np.ndarray, rows: Iterable[np.ndarray], labels: Sequence[str]) -> None:
    """Draw lines that differ in colour and, when all colours are used, in dashes."""
    for i, (y, label) in enumerate(zip(rows, labels, strict=True)):
        _draw_line(ax, x, y, label=label, linewidth=1.8, **line_style(i))


def line_style(i: int) -> dict[str, Any]:
    """Return the colour and dashes of line i."""
    cycle, colour = divmod(i, len(COLOURS))
    return {"color": COLOURS[colour], "linestyle": DASHES[cycle % len(DASHES)]}


def _draw_line(
    ax: Axes, x: np.ndarray, y: np.ndarray, isolated: np.ndarray | None = None, **style: Any
) -> None:
    """Draw a line; an isolated value between two gaps gets a marker, as a line would not show it."""
    (line,) = ax.plot(x, y, **style)
    isolated = _is_isolated(y) if isolated is None else isolated
    if isolated.any():
        line.set(marker=".", markevery=isolated)


def _is_isolated(y: np.ndarray) -> np.ndarray:
    known = np.pad(np.isfinite(y), 1)
    return known[1:-1] & ~known[:-2] & ~known[2:]


def draw_by_plane(ax: Axes, x: np.ndarray, y: np.ndarray, kinds: np.ndarray, style: dict[str, Any]) -> None:
    """Draw a line whose dashes change with the main motion: `MOTION_DASHES[kinds[i]]` after sample i.

    The pieces with different dashes are joined without gaps.
    """
    starts, isolated = [0, *(np.flatnonzero(np.diff(kinds)) + 1).tolist()], _is_isolated(y)
    for start, stop in zip(starts, [*(s + 1 for s in starts[1:]), len(x)], strict=True):
        piece, dashes = slice(start, stop), MOTION_DASHES[kinds[start]]
        _draw_line(ax, x[piece], y[piece], isolated[piece], linestyle=dashes, **style)


def style_by_plane(i: int) -> dict[str, Any]:
    """Return the colour of line i, and its width, which changes when all colours are used."""
    cycle, colour = divmod(i, len(COLOURS))
    return {"color": COLOURS[colour], "linewidth": max(1.8 - 0.6 * cycle, 0.6)}


def name_colour(ax: Axes, label: str, i: int) -> None:
    """Add a legend entry in the colour of line i, without dashes, as these may vary along the line."""
    style = style_by_plane(i)
    ax.plot([], [], label=label, color=style["color"], linewidth=3 * style["linewidth"])


def name_planes(ax: Axes, words: Sequence[str], drawn: np.ndarray | None = None) -> Axes:
    """Add the meanings of `MOTION_DASHES` to the legend, all or those numbered `drawn`; draw the legend."""
    for k in range(len(words)) if drawn is None else np.unique(drawn):
        ax.plot([], [], linestyle=MOTION_DASHES[k], color="0.3", linewidth=1.8, label=words[k])
    return add_legend(ax)


def note_below(figure: Figure, sentences: Sequence[str]) -> Figure:
    """Write sentences below the axes of a figure whose constrained layout makes space for them.

    Parameters
    ----------
    figure : Figure
        The figure.
    sentences : sequence of str
        The sentences, each of which is a paragraph; may be empty.

    Returns
    -------
    Figure
        The given figure.
    """
    width = int(_LETTERS * figure.get_size_inches()[0])
    lines = [line for sentence in sentences for line in textwrap.wrap(sentence, width)]
    if lines:
        figure.supxlabel("\n".join(lines), x=0.01, ha="left", fontsize=9, color=_COLOUR)
    return figure
