"""Plots of an answer over an input of a scene."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.curves import curves
from beamdyn.output.plots import add_legend, set_up_axes


def plot_over_input(
    x: np.ndarray, rows: np.ndarray, labels: Sequence[str], xlabel: str, ylabel: str, ax: Axes | None = None
) -> Axes:
    """Draw curves over an input.

    Parameters
    ----------
    x : ndarray, shape (n,)
        Values of the input.
    rows : ndarray, shape (m, n)
        The curves, with gaps where they are not finite; of many, some spread evenly are drawn.
    labels : sequence of str
        One a curve; empty for a single one.
    xlabel, ylabel : str
        Labels of the axes.
    ax : Axes, optional
        Where to draw; a new one by default.
    """
    ax = set_up_axes(ax, xlabel, ylabel)
    order = np.argsort(x, kind="stable")
    curves(ax, x[order], rows[:, order], labels)
    return add_legend(ax) if any(labels) else ax
