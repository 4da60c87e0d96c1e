"""Plots of bent beams at rest on their carrier, from arrays."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.plots.plots import new_axes, speed_label
from beamdyn.common.results.display_units import SI_UNITS, DisplayUnits
from beamdyn.common.results.pictures import COLOURS


def plot_bent_beam(along: np.ndarray, across: np.ndarray, ax: Axes | None = None, title: str = "") -> Axes:
    """Draw a bent beam to one scale: its positions along the straight beam and across it, over its length."""
    ax = new_axes() if ax is None else ax
    ax.plot(along, across, color=COLOURS[0])
    ax.plot([0, 1], [0, 0], color="0.7", linewidth=0.8)
    labels = {"xlabel": "along the beam at rest, over its length", "ylabel": "deflection over the length"}
    ax.set(title=title, **labels)
    ax.set_aspect("equal", adjustable="datalim")  # fills the axes, however little the beam bends
    return ax


def plot_branches(
    branches: Sequence[tuple[str, np.ndarray, np.ndarray, np.ndarray]],
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw branches of equilibria over speed: solid where they are stable, dashed where not.

    Parameters
    ----------
    branches : sequence of tuple
        Name, speeds (k,) [rad/s], tip deflections over the length (k,) and stability (k,) of each.
    ax : Axes, optional
        Where to draw; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    ax = new_axes() if ax is None else ax
    for colour, (name, speeds, tip, stable) in zip(COLOURS, branches, strict=False):
        for where, style, word in ((stable, "-", "stable"), (_with_neighbours(~stable), "--", "unstable")):
            if where.any():
                ax.plot(
                    units.speed_unit().of(speeds),
                    np.where(where, tip, np.nan),
                    style,
                    color=colour,
                    label=f"{name}, {word}",
                )
    ax.set(xlabel=speed_label(units), ylabel="tip deflection over the length")
    ax.legend()
    return ax


def _with_neighbours(where: np.ndarray) -> np.ndarray:
    """Extend a selection of points by those next to it, so that lines meet."""
    extended = where.copy()
    extended[1:] |= where[:-1]
    extended[:-1] |= where[1:]
    return extended
