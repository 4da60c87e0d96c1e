"""Plots of loads along the span, from arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.plots.plots import add_legend, position_label, set_up_axes
from beamdyn.common.results.display_units import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS

_FEW = 4  # cases that are drawn as lines; of more, their range is


def plot_along_span(
    x: np.ndarray,
    values: np.ndarray,
    labels: Sequence[str],
    quantity: str,
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw a quantity along the beam, one colour a component: lines of few cases, the range of more.

    Parameters
    ----------
    x : ndarray, shape (S,)
        Stations along the beam [m]; the two sides of a jump have the same.
    values : ndarray, shape (C, S, k)
        Values of C cases, such as times, of k components.
    labels : sequence of str, length k
        Names of the components, for the legend.
    quantity : str
        Name of the quantity, with its unit.
    ax : Axes, optional
        Where to draw; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, position_label(units), quantity)
    x = units.length_unit("m").of(x)
    for k, label in enumerate(labels):
        colour, of_component = COLOURS[k % len(COLOURS)], values[..., k]
        if len(values) <= _FEW:
            for number, row in enumerate(of_component):
                ax.plot(x, row, color=colour, linewidth=1.8, label=label if number == 0 else None)
            continue
        low, high = np.nanmin(of_component, axis=0), np.nanmax(of_component, axis=0)
        ax.fill_between(x, low, high, color=colour, alpha=0.25, linewidth=0)
        ax.plot(x, high, color=colour, linewidth=1.8, label=f"{label}, range")
        ax.plot(x, low, color=colour, linewidth=1.8)
    ax.ticklabel_format(axis="y", style="sci", scilimits=(-3, 4), useOffset=False)
    return add_legend(ax)


def plot_load_over_time(
    t: np.ndarray, values: np.ndarray, labels: Sequence[str], quantity: str, ax: Axes | None = None
) -> Axes:
    """Draw a quantity at one station over time, one line a component.

    Parameters
    ----------
    t : ndarray, shape (T,)
        Times [s].
    values : ndarray, shape (T, k)
        Values of k components.
    labels, quantity, ax
        As for `plot_along_span`.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, "time [s]", quantity)
    for k, label in enumerate(labels):
        ax.plot(t, values[:, k], color=COLOURS[k % len(COLOURS)], linewidth=0.9, label=label)
    ax.margins(x=0)
    return add_legend(ax)


def plot_exceedance(ranges: np.ndarray, counts: np.ndarray, quantity: str, ax: Axes | None = None) -> Axes:
    """Draw the number of cycles whose range is at least as large.

    Parameters
    ----------
    ranges, counts : ndarray, shape (n,)
        Range of each cycle, and how often it counts.
    quantity : str
        Name of the range, with its unit.
    ax : Axes, optional
        Where to draw; new axes if not given.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, "cycles of at least this range", quantity)
    order = np.argsort(-ranges)
    ax.step(np.cumsum(counts[order]), ranges[order], where="pre", color=COLOURS[0], linewidth=1.8)
    ax.set_xscale("log")
    return ax
