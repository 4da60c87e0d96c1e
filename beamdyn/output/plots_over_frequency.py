"""Plots over frequency: responses and spectra."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.output.plots import add_legend, set_up_axes


def plot_frequency_response(
    frequencies: np.ndarray, size: np.ndarray, ylabel: str, labels: Sequence[str], ax: Axes | None = None
) -> Axes:
    """Draw magnitudes over frequency on logarithmic axes, one line a column.

    Parameters
    ----------
    frequencies : ndarray, shape (F,)
        Frequencies [Hz]; 0 is not drawn.
    size : ndarray, shape (F, k)
        Magnitudes.
    ylabel : str
        Label of the vertical axis.
    labels : sequence of str, length k
        For the legend; an empty one has no entry.
    ax : Axes, optional
        Where to draw; new axes if not given.
    """
    ax = set_up_axes(ax, "frequency [Hz]", ylabel)
    drawn = frequencies > 0
    for column, label in zip(size[drawn].T, labels, strict=True):
        ax.loglog(frequencies[drawn], column, label=label or None)
    return add_legend(ax) if any(labels) else ax
