"""Plots of mode shapes and of bent beams, from arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.plots.axes_and_lines import (
    draw_lines,
    name_colour,
    name_planes,
    new_axes,
    position_label,
    set_up_axes,
    style_by_plane,
)
from beamdyn.common.results.display_units import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS, add_legend


def plot_shapes(
    x: np.ndarray,
    shapes: np.ndarray,
    labels: Sequence[str],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw mode shapes, each over its own largest deflection.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m].
    shapes : ndarray, shape (m, n)
        Deflections of the modes, real, in any unit.
    labels : sequence of str, length m
        For the legend.
    ax : Axes, optional
        Where to draw; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    largest = np.abs(shapes).max(axis=1, keepdims=True)
    scaled = shapes / np.where(largest == 0, 1.0, largest)
    ax = _set_up_shapes(ax, units)
    draw_lines(ax, units.length_unit("m").of(x), scaled, labels)
    return add_legend(ax)


def plot_shapes_by_plane(
    x: np.ndarray,
    shapes: np.ndarray,
    labels: Sequence[str],
    directions: tuple[str, str],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw mode shapes in two directions, both over the largest deflection in either.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Positions along the beam [m].
    shapes : ndarray, shape (m, 2, n)
        Deflections of the modes, real, in any unit; those in the first direction are drawn solid.
    labels : sequence of str, length m
        For the legend.
    directions : tuple of str
        The two directions in words, for the legend.
    ax : Axes, optional
        Where to draw; new axes if not given.
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
            ax.plot(x, row, dashes, **style_by_plane(i))
        name_colour(ax, label, i)
    return name_planes(ax, directions)


def _set_up_shapes(ax: Axes | None, units: DisplayUnits = SI_UNITS) -> Axes:
    """Label the axes for mode shapes, each over its largest deflection, and draw the beam at rest."""
    ax = set_up_axes(ax, position_label(units), "deflection / its largest value")
    ax.axhline(0, color="0.4", linewidth=0.8)
    return ax


def plot_bent_beam(along: np.ndarray, across: np.ndarray, ax: Axes | None = None, title: str = "") -> Axes:
    """Draw a bent beam to one scale: its positions along the straight beam and across it, over its length."""
    ax = new_axes() if ax is None else ax
    ax.plot(along, across, color=COLOURS[0])
    ax.plot([0, 1], [0, 0], color="0.7", linewidth=0.8)
    labels = {"xlabel": "along the beam at rest, over its length", "ylabel": "deflection over the length"}
    ax.set(title=title, **labels)
    ax.set_aspect("equal", adjustable="datalim")  # fills the axes, however little the beam bends
    return ax
