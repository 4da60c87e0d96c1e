"""Plots of modes that bend in two directions: one drawn solid, the other dashed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.plots.plots import (
    add_legend,
    is_isolated,
    number_modes,
    set_up_axes,
    set_up_shapes,
    speed_label,
)
from beamdyn.common.results.display_units import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS


def plot_locus_by_plane(
    speeds: np.ndarray,
    frequency: np.ndarray,
    share: np.ndarray,
    directions: tuple[str, str],
    ax: Axes | None = None,
    labels: Sequence[str] | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw natural frequencies over speed, solid where a mode bends mostly in one direction, else dashed.

    Parameters
    ----------
    speeds, frequency, ax, labels, units
        As for `beamdyn.common.plots.plots.plot_locus`.
    share : ndarray, shape (S, m)
        Share of each mode's energy in the first direction, which is drawn solid.
    directions : tuple of str
        The two directions in words, for the legend.

    Returns
    -------
    Axes
    """
    speeds = units.speed_unit().of(np.asarray(speeds))
    ax = set_up_axes(ax, speed_label(units), "natural frequency [Hz]")
    names = labels or number_modes(np.shape(frequency)[1])
    columns = zip(np.transpose(frequency), np.transpose(share) >= 0.5, names, strict=True)
    for i, (y, solid, label) in enumerate(columns):
        draw_by_plane(ax, speeds, y, solid, style_by_plane(i))
        _name_colour(ax, label, i)
    ax.update_datalim([(speeds[0], 0), (speeds[-1], 0)], updatey=False)
    return _name_planes(ax, [f"mostly {direction}" for direction in directions])


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
    ax, x = set_up_shapes(ax, units), units.length_unit("m").of(x)
    for i, (both, label) in enumerate(zip(scaled, labels, strict=True)):
        ax.plot(x, both[0], "-", **style_by_plane(i))
        ax.plot(x, both[1], "--", **style_by_plane(i))
        _name_colour(ax, label, i)
    return _name_planes(ax, directions)


def draw_by_plane(ax: Axes, x: np.ndarray, y: np.ndarray, solid: np.ndarray, style: dict[str, Any]) -> None:
    """Draw a line whose dashes change from sample to sample; its pieces meet at a sample."""
    starts = [0, *(np.flatnonzero(np.diff(solid)) + 1).tolist()]
    isolated = is_isolated(y)
    for start, stop in zip(starts, [*(s + 1 for s in starts[1:]), len(x)], strict=True):
        dashes = "-" if solid[start] else "--"
        (line,) = ax.plot(x[start:stop], y[start:stop], dashes, **style)
        if (alone := isolated[start:stop]).any():
            line.set(marker=".", markevery=alone)


def style_by_plane(i: int) -> dict[str, Any]:
    """Colour of line i, and its width, which changes when the colours are used up."""
    cycle, colour = divmod(i, len(COLOURS))
    return {"color": COLOURS[colour], "linewidth": max(1.8 - 0.6 * cycle, 0.6)}


def _name_colour(ax: Axes, label: str, i: int) -> None:
    """Name line i in the legend by its colour, as its dashes may change."""
    style = style_by_plane(i)
    ax.plot([], [], label=label, color=style["color"], linewidth=3 * style["linewidth"])


def _name_planes(ax: Axes, words: Sequence[str]) -> Axes:
    for dashes, text in zip(("-", "--"), words, strict=True):
        ax.plot([], [], dashes, color="0.3", linewidth=1.8, label=text)
    return add_legend(ax)
