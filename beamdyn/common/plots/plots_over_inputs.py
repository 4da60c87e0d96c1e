"""Plots of an answer over an input of a scene."""

from __future__ import annotations

import textwrap
from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.plots.curves import curves, mark_missing
from beamdyn.common.plots.plots import add_legend, set_up_axes

_TITLE = 80  # characters of a line of the title


def plot_over_input(
    x: np.ndarray,
    rows: np.ndarray,
    labels: Sequence[str],
    xlabel: str,
    ylabel: str,
    ax: Axes | None = None,
    title: str = "",
    missing: str = "no answer",
) -> Axes:
    """Draw curves over an input.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Values of the input.
    rows : ndarray, shape (m, n)
        The curves, with crosses at the bottom where they are not finite; of many, some spread evenly are
        drawn.
    labels : sequence of str
        One a curve; empty for a single one.
    xlabel, ylabel : str
        Labels of the axes.
    ax : Axes, optional
        Where to draw; a new one by default.
    title : str
        What holds of all curves, wrapped.
    missing : str
        What the crosses mean.
    """
    ax = set_up_axes(ax, xlabel, ylabel)
    order = np.argsort(x, kind="stable")
    curves(ax, x[order], rows[:, order], labels)
    ax.set_title("\n".join(textwrap.wrap(title, _TITLE)), fontsize=10)
    return add_legend(ax) if mark_missing(ax, missing) or any(labels) else ax


def plot_bars(
    names: Sequence[str], rows: np.ndarray, labels: Sequence[str], xlabel: str, ax: Axes | None = None
) -> Axes:
    """Draw horizontal bars of n names for k answers, the name with the longest bar on top.

    Parameters
    ----------
    names : sequence of str
        The names, shape (n,).
    rows : ndarray, shape (n, k)
        Lengths; those that are not finite are left out.
    labels : sequence of str
        One an answer.
    xlabel : str
        Label of the axis.
    ax : Axes, optional
        Where to draw; a new one by default.
    """
    ax = set_up_axes(ax, xlabel, "")
    finite = np.where(np.isfinite(rows), rows, 0.0)
    order = np.argsort(np.abs(finite).max(axis=1, initial=0.0), kind="stable")
    height = 0.8 / max(rows.shape[1], 1)
    for k, label in enumerate(labels):
        places = np.arange(len(names)) + (rows.shape[1] / 2 - k - 0.5) * height
        ax.barh(places, finite[order, k], height, label=label)
    ax.set_yticks(np.arange(len(names)), [str(names[i]) for i in order])
    ax.axvline(0.0, color="0.4", linewidth=0.8)
    return add_legend(ax)
