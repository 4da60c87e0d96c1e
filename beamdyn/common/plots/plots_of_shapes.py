"""Plots of mode shapes and of deflected beams, from arrays."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import repeat
from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.plots import axes_and_lines
from beamdyn.common.results.columns import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS, Axes, add_legend

if TYPE_CHECKING:
    from matplotlib.contour import ContourSet

_COLOURS_OF_SIGN, _LEVELS = "RdBu_r", np.linspace(-1, 1, 21)  # colours and contour levels of scaled shapes
_FLAT = 1e-6  # relative deflection below which no nodal lines are drawn
_ASIDE = 0.4  # largest drawn displacement across the width, as a fraction of the width
_PAGE, _MARGIN = (6.5, 4.6), 0.45  # size of a page of panels, and distance between two panels [inch]


def plot_shapes(
    x: np.ndarray,
    shapes: np.ndarray,
    labels: Sequence[str],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw mode shapes along the beam, each divided by its largest deflection.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m].
    shapes : ndarray, shape (m, n)
        Deflections of the modes, real, in any unit.
    labels : sequence of str, length m
        Names of the modes in the legend.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    largest = np.abs(shapes).max(axis=1, keepdims=True)
    scaled = shapes / np.where(largest == 0, 1.0, largest)
    ax = _set_up_shapes(ax, units)
    axes_and_lines.draw_lines(ax, units.length_unit("m").of(x), scaled, labels)
    return add_legend(ax)


def plot_shapes_by_plane(
    x: np.ndarray,
    shapes: np.ndarray,
    labels: Sequence[str],
    directions: tuple[str, str],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw mode shapes in two directions, divided by the largest deflection in either direction.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m].
    shapes : ndarray, shape (m, 2, n)
        Deflections of the modes, real, in any unit; those in the first direction are drawn solid.
    labels : sequence of str, length m
        Names of the modes in the legend.
    directions : tuple of str
        The two directions in words, for the legend.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    largest = np.abs(shapes).max(axis=(1, 2), keepdims=True)
    scaled = shapes / np.where(largest == 0, 1.0, largest)
    ax, x = _set_up_shapes(ax, units), units.length_unit("m").of(x)
    for i, (both, label) in enumerate(zip(scaled, labels, strict=True)):
        for row, dashes in zip(both, ("-", "--"), strict=True):
            ax.plot(x, row, dashes, **axes_and_lines.style_by_plane(i))
        axes_and_lines.name_colour(ax, label, i)
    return axes_and_lines.name_planes(ax, directions)


def plot_surfaces(
    x: np.ndarray,
    y: np.ndarray,
    shapes: np.ndarray,
    across: np.ndarray,
    labels: Sequence[str],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw mode shapes of a strip in plan view, to scale, with nodal lines; each mode has its own panel.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the strip [m].
    y : ndarray, shape (n, positions)
        Positions across the strip [m].
    shapes : ndarray, shape (m, n, positions)
        Deflections of the modes out of the strip, real, in any unit.
    across : ndarray, shape (m, n)
        Displacements along -y, in the same unit; the outline is drawn displaced by them.
    labels : sequence of str, length m
        Titles of the panels.
    ax : Axes, optional
        Axes whose area is divided into panels; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    largest = np.maximum(np.abs(shapes).max(axis=(1, 2)), np.abs(across).max(axis=1))
    scale = 1 / np.where(largest == 0, 1.0, largest)
    width = float(np.ptp(y))
    scaled, moved = shapes * scale[:, None, None], y - _ASIDE * width * (across * scale[:, None])[:, :, None]
    ax, each = axes_and_lines.panels(len(labels), ax, _panels_in_a_row(len(labels), float(x[-1]), width))
    colours = [_draw_surface(*one, units) for one in zip(each, repeat(x), moved, scaled, labels)]
    bar = ax.figure.colorbar(colours[0], ax=each, ticks=[-1, 0, 1], shrink=0.8)
    bar.set_label("deflection / its largest value")
    return ax


def _panels_in_a_row(count: int, length: float, width: float) -> int:
    """Return the number of panels in a row at which strips of a given size are drawn largest."""

    def size(columns: int) -> float:
        rows = -(-count // columns)
        return min((_PAGE[0] / columns - _MARGIN) / length, (_PAGE[1] / rows - _MARGIN) / width)

    return max(range(1, count + 1), key=size)


def _draw_surface(
    ax: Axes, x: np.ndarray, y: np.ndarray, shape: np.ndarray, label: str, units: DisplayUnits
) -> ContourSet:
    """Draw a deflection (at most 1) of a strip clamped at the left, with nodal lines and outline."""
    unit = units.length_unit("m")
    x, y = unit.of(np.broadcast_to(x[:, None], y.shape)), unit.of(y)
    colours = ax.contourf(x, y, shape, levels=_LEVELS, cmap=_COLOURS_OF_SIGN)
    if np.abs(shape).max() > _FLAT:  # deflections that are only rounding errors have no nodal lines
        ax.contour(x[1:], y[1:], shape[1:], levels=[0.0], colors="black", linewidths=1.2)
    outline = [np.concatenate([of[:, 0], of[-1], of[::-1, -1]]) for of in (x, y)]
    ax.plot(*outline, color="0.3", linewidth=0.8)
    ax.plot(x[0], y[0], color="black", linewidth=3.0)
    ax.set_aspect("equal")
    ax.set_title(label, fontsize=9)
    ax.set_xlabel(axes_and_lines.position_label(units), fontsize=9)
    ax.set_ylabel(f"y [{unit.name}]", fontsize=9)
    ax.set_yticks(y[0, [0, -1]])
    ax.tick_params(labelsize=9)
    ax.label_outer()
    return colours


def _set_up_shapes(ax: Axes | None, units: DisplayUnits = SI_UNITS) -> Axes:
    """Label the axes for mode shapes divided by their largest deflection, and draw the beam at rest."""
    label = axes_and_lines.position_label(units)
    ax = axes_and_lines.set_up_axes(ax, label, "deflection / its largest value")
    ax.axhline(0, color="0.4", linewidth=0.8)
    return ax


def plot_bent_beam(
    along: np.ndarray, across: np.ndarray, directions: Sequence[str], ax: Axes | None = None, title: str = ""
) -> Axes:
    """Draw a deflected beam to scale, seen in one or two directions.

    Parameters
    ----------
    along : ndarray, shape (n,)
        Coordinates of n points along the direction of the beam at rest, divided by its length.
    across : ndarray, shape (2, n)
        Coordinates of the points in two directions across it, divided by the length.
    directions : sequence of str, length 1 or 2
        The directions that are drawn, in words; if there are two, they are named in the legend.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    title : str
        Title of the axes.

    Returns
    -------
    Axes
    """
    ax = axes_and_lines.new_axes() if ax is None else ax
    for row, dashes, _ in zip(across, axes_and_lines.MOTION_DASHES, directions, strict=False):
        ax.plot(along, row, dashes, color=COLOURS[0])
    ax.plot([0, 1], [0, 0], color="0.7", linewidth=0.8)
    labels = {"xlabel": "along the beam at rest, over its length", "ylabel": "deflection over the length"}
    ax.set(title=title, **labels)
    ax.set_aspect("equal", adjustable="datalim")  # the curve fills the axes even if the beam bends little
    return axes_and_lines.name_planes(ax, directions) if len(directions) > 1 else ax
