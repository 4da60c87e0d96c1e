"""Figures of sweeps: curves of results over inputs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from beamdyn.common.results.pictures import COLOURS

_STYLES = ("-", "--", "-.", ":")
_MOST_CURVES = 8
_LOWEST, _ROW = 0.02, 0.03  # heights of crosses on the axes, and between those of two curves
_GREY = "0.5"


def sweep_figure(swept: Any) -> Figure:
    """Draw a sweep: one panel per result over the first input, one curve per value of the second.

    Parameters
    ----------
    swept : InputSweep
        See `beamdyn.common.edge.input_sweep.InputSweep`.

    Returns
    -------
    Figure
    """
    groups = panels_of(swept)
    figure = Figure(figsize=(7.5, max(4.5, 2.7 * len(groups))), layout="constrained")
    panels = np.atleast_1d(figure.subplots(len(groups), 1, sharex=True))
    for ax, (heading, labels, values) in zip(panels, groups, strict=True):
        order = np.argsort(swept.values[0], kind="stable") if swept.combine == "zip" else slice(None)
        curves(ax, swept.values[0][order], values[:, order], labels)
        ax.set_ylabel(heading)
        if mark_missing(ax, "no answer") or len(labels) > 1:
            ax.legend(title=_second(swept), fontsize=9, title_fontsize=9)
    panels[-1].set_xlabel(input_words(swept, 0))
    return figure


def panels_of(swept: Any) -> list[tuple[str, list[str], np.ndarray]]:
    """Panels of a sweep: heading, names of the curves, the curves (m, n). Results of one unit share a panel.

    Parameters
    ----------
    swept : InputSweep
        See `sweep_figure`.
    """
    results = [*zip(swept.results, swept.result_units, swept.found, strict=True)]
    if _has_curves(swept):
        names = [f"{value:.4g}" for value in swept.values[1]]
        at_first = (slice(None), slice(None), *(0,) * (len(swept.values) - 2))
        return [(_named(name, unit), names, values[at_first].T) for name, unit, values in results]
    groups: dict[str, list[tuple[str, np.ndarray]]] = {}
    for name, unit, values in results:
        groups.setdefault(unit or name, []).append((name, values))
    units = {unit: unit for unit in swept.result_units if unit}
    return [
        (
            _named(", ".join(name for name, _ in group), units.get(key, "")),
            [name.replace("_", " ") for name, _ in group],
            np.array([values for _, values in group]),
        )
        for key, group in groups.items()
    ]


def _has_curves(swept: Any) -> bool:
    """Whether there is a curve for each value of a second input."""
    return len(swept.values) > 1 and swept.combine == "product"


def _second(swept: Any) -> str | None:
    """Heading of the legend: the second input, and further ones at their first value."""
    if not _has_curves(swept):
        return None
    further = [f"{input_words(swept, k)} = {swept.values[k][0]:.4g}" for k in range(2, len(swept.values))]
    return "\n".join([input_words(swept, 1), *further])


def input_words(swept: Any, place: int) -> str:
    """An input in words, without its table.

    Parameters
    ----------
    swept : InputSweep
        The sweep.
    place : int
        Which of its inputs.
    """
    path = swept.inputs[place]
    return _named((path.partition(".")[2] or path).replace(".", " "), swept.units[place])


def curves(ax: Axes, x: np.ndarray, values: np.ndarray, labels: Sequence[str]) -> Axes:
    """Curves, shape (m, n), that differ in colour and style; of many, some spread evenly.

    Parameters
    ----------
    ax : Axes
        Where to draw.
    x : ndarray, shape (n,)
        Places.
    values : ndarray, shape (m, n)
        Heights; there is a gap where they are not finite.
    labels : sequence of str
        One a curve.
    """
    values = np.where(np.isfinite(values), values, np.nan)
    shown = np.unique(np.linspace(0, len(values) - 1, min(len(values), _MOST_CURVES)).round().astype(int))
    for place, i in enumerate(shown):
        style = _STYLES[place // len(COLOURS) % len(_STYLES)] if place >= len(COLOURS) else "-"
        colour = COLOURS[place % len(COLOURS)]
        label = labels[i] if np.isfinite(values[i]).any() else f"{labels[i]}: none"
        ax.plot(x, values[i], color=colour, linestyle=style, linewidth=1.6, label=label)
    grid(ax)
    return ax


def mark_missing(ax: Axes, label: str) -> bool:
    """Mark places where curves have no value by crosses at the bottom, in a row and the colour of each curve.

    Parameters
    ----------
    ax : Axes
        Axes with the curves.
    label : str
        What the crosses mean, for the legend.

    Returns
    -------
    bool
        Whether there are any.
    """
    place = ax.get_xaxis_transform()
    gaps = [(line, np.isnan(np.asarray(line.get_ydata(), dtype=float))) for line in ax.get_lines()]
    lacking = [(line, np.asarray(line.get_xdata())[gap]) for line, gap in gaps if gap.any()]
    for row, (line, x) in enumerate(lacking):
        height = np.full(len(x), _LOWEST + row * _ROW)
        colour = line.get_color() if len(gaps) > 1 else _GREY
        ax.plot(x, height, "x", color=colour, markersize=5, transform=place, label="_")
    if lacking:
        ax.plot([], [], "x", color=_GREY, markersize=5, label=label)
    return bool(lacking)


def grid(ax: Axes) -> None:
    """A light grid behind the curves."""
    ax.grid(color="0.9", linewidth=0.8)
    ax.set_axisbelow(True)


def _named(name: str, unit: str) -> str:
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")
