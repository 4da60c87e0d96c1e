"""Plots over frequency: responses and spectra."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.axes import Axes

from beamdyn.common.plots.plots import add_legend, set_up_axes


def plot_frequency_response(
    curves: Sequence[tuple[np.ndarray, np.ndarray]],
    ylabel: str,
    labels: Sequence[str],
    ax: Axes | None = None,
) -> Axes:
    """Draw magnitudes over frequency on logarithmic axes.

    Parameters
    ----------
    curves : sequence of (ndarray, ndarray), each of shape (F,)
        Frequencies [Hz], of which 0 is not drawn, and magnitudes.
    ylabel : str
        Label of the vertical axis.
    labels : sequence of str, one a curve
        For the legend; an empty one has no entry.
    ax : Axes, optional
        Where to draw; new axes if not given.
    """
    ax = set_up_axes(ax, "frequency [Hz]", ylabel)
    for (frequencies, size), label in zip(curves, labels, strict=True):
        drawn = frequencies > 0
        ax.loglog(frequencies[drawn], size[drawn], label=label or None)
    return add_legend(ax) if any(labels) else ax
