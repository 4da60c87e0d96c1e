"""Pictures of spreads: how an answer scatters, and which inputs matter."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.results.pictures import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_BINS = 24
_MOST_PANELS = 4  # answers that a figure shows
_REACH = 1.0  # beyond the 5 % and 95 % points, over their distance, to which a histogram is drawn


def draw_scatter(
    values: np.ndarray, label: str, marks: Sequence[tuple[str, str, str, Sequence[float]]], ax: Axes | None
) -> Axes:
    """Draw a histogram of an answer, with marks.

    Parameters
    ----------
    values : ndarray, shape (n,)
        Answers of random designs; those that are not finite count, but are not drawn.
    label : str
        Of the axis.
    marks : sequence of (label, style, colour, places)
        Vertical lines at places.
    ax : Axes, optional
        Where to draw; new axes if not given.
    """
    ax, drawn = _axes(ax), values[np.isfinite(values)]
    ax.set_xlabel(label)
    ax.set_ylabel("random designs [%]")
    low, high = _seen(drawn)
    if drawn.size:
        weights = np.full(len(drawn), 100 / len(values))
        some = "" if low <= drawn.min() and drawn.max() <= high else ", some beyond the picture"
        within = (max(low, drawn.min()), min(high, drawn.max()))
        ax.hist(drawn, _BINS, range=within, weights=weights, color=COLOURS[5], label=f"random designs{some}")
    for name, style, colour, places in marks:
        shown = [place for place in places if low <= place <= high]
        beyond = ", beyond the picture" if len(shown) < np.isfinite(places).sum() else ""
        for i, place in enumerate(shown or [np.nan]):
            label = "" if i else f"{name}{beyond}"
            ax.axvline(place, linestyle=style, color=colour, linewidth=1.4, label=label)
    ax.legend(fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def _seen(drawn: np.ndarray) -> tuple[float, float]:
    """Ends of what a picture of such answers shows: a few outliers do not make the rest invisible."""
    if not drawn.size:
        return -np.inf, np.inf
    low, high = np.percentile(drawn, [5, 95])
    return low - _REACH * (high - low), high + _REACH * (high - low)


def draw_indices(
    inputs: Sequence[str],
    answers: Sequence[str],
    total: np.ndarray,
    error: np.ndarray,
    first: np.ndarray,
    ax: Axes | None,
) -> Axes:
    """Draw total indices as bars with their standard errors, those of first order as diamonds.

    Parameters
    ----------
    inputs, answers : sequence of str
        The d inputs and k answers; of many answers the first are drawn.
    total, error, first : ndarray, shape (d, k)
        Indices and the errors of the total ones; those that are not finite are left out.
    ax : Axes, optional
        Where to draw; new axes if not given.
    """
    ax, shown = _axes(ax), min(len(answers), len(COLOURS))
    height, rows = 0.8 / shown, np.arange(len(inputs))[::-1]
    if not np.isfinite(total).any():
        ax.text(0.5, 0.5, "no shares: see the warnings", ha="center", va="center", transform=ax.transAxes)
        ax.set_axis_off()
        return ax
    error = np.where(np.isfinite(error), error, 0.0)
    for k in range(shown):
        places = rows + (shown / 2 - k - 0.5) * height
        bars = np.nan_to_num(total[:, k])
        ax.barh(places, bars, height, xerr=error[:, k], color=COLOURS[k], label=answers[k], capsize=2)
        mark = "by the input alone" if k == shown - 1 else ""
        ax.plot(first[:, k], places, "d", color="white", markeredgecolor="0.2", markersize=4, label=mark)
    ax.set_yticks(rows, inputs)
    ax.set_xlabel("share of the variance (total index)")
    ax.grid(color="0.9", linewidth=0.8, axis="x")
    ax.set_axisbelow(True)
    ax.legend(fontsize=9, loc="upper left", bbox_to_anchor=(1.0, 1.0))
    return ax


def spread_figure(spread: Any) -> Figure:
    """Draw how the first answers of a `Spread` scatter, a panel each, and below them which inputs matter."""
    from matplotlib.figure import Figure

    panels = min(len(spread.answers), _MOST_PANELS)
    below = 1.2 + 0.35 * len(spread.inputs)
    figure = Figure(figsize=(7.5, 2.4 * panels + below), layout="constrained")
    axes = figure.subplots(panels + 1, 1, height_ratios=[2.4] * panels + [below])
    for answer in range(panels):
        spread.plot(axes[answer], answer)
    spread.plot_indices(axes[-1])
    return figure


def _axes(ax: Axes | None) -> Axes:
    if ax is not None:
        return ax
    from matplotlib import pyplot

    return pyplot.subplots(figsize=(7.5, 4.0), layout="constrained")[1]
