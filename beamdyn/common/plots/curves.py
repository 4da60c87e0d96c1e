"""Plots of results over varied inputs, of loads along the span, and of errors over computing time."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from beamdyn.common.plots.axes_and_lines import line_style, position_label, set_up_axes
from beamdyn.common.plots.maps import MapAnswer, MapInput, map_size, plot_maps
from beamdyn.common.results.columns import SI_UNITS, DisplayUnits, evenly_spread
from beamdyn.common.results.pictures import COLOURS, Axes, Figure, add_legend, new_figure

_MOST_CURVES = 8
# Crosses that mark missing values: height of the lowest row, and row distance, in heights of the axes.
_LOWEST, _ROW = 0.02, 0.03
_GREY = "0.5"
_FEW = 4  # largest number of cases drawn as single lines along the span; of more cases a band is drawn
_MARKERS = "osD^vXP"
_SAME = 1e-6  # difference of two curves that is too small to see, as a fraction of the largest value
_FEWEST_BARS = 3  # a bar chart with fewer names leaves empty space, so that the bars are not wider


# Parameter sweeps ------------------------------------------------------------------------------------


def sweep_figure(swept: Any) -> Figure:
    """Draw a parameter sweep: over one input, a panel per unit; over several inputs, a map per result.

    Parameters
    ----------
    swept : InputSweep
        See `beamdyn.common.edge.input_sweep.InputSweep`.

    Returns
    -------
    Figure
    """
    if len(swept.values) > 1 and swept.combine == "product":
        return _maps_of(swept)
    groups = panels_of(swept)
    figure = new_figure(7.5, max(4.5, 2.7 * len(groups)))
    panels = np.atleast_1d(figure.subplots(len(groups), 1, sharex=True))
    for ax, (heading, labels, values) in zip(panels, groups, strict=True):
        order = np.argsort(swept.values[0], kind="stable") if swept.combine == "zip" else slice(None)
        curves(ax, swept.values[0][order], values[:, order], labels)
        ax.set_ylabel(heading)
        if mark_missing(ax, "no answer") or len(labels) > 1:
            ax.legend(fontsize=9)
    panels[-1].set_xlabel(input_words(swept, 0))
    return figure


def _maps_of(swept: Any) -> Figure:
    """Draw each result over two or more varied inputs as a map."""
    words = [_input_name(path) for path in swept.inputs]
    inputs = [MapInput(*each) for each in zip(words, swept.units, swept.values, strict=True)]
    answers = [
        MapAnswer(_named(name, unit), values, np.where(np.isfinite(values), "", "no answer"))
        for name, unit, values in zip(swept.results, swept.result_units, swept.found, strict=True)
    ]
    figure = new_figure(*map_size(inputs, answers))
    plot_maps(inputs, answers, figure.subplots())
    return figure


def panels_of(swept: Any) -> list[tuple[str, list[str], np.ndarray]]:
    """Return panels over one varied input: heading, names of curves, and curves (m, n) of the same unit.

    Parameters
    ----------
    swept : InputSweep
        Results over one varied input.
    """
    results = [*zip(swept.results, swept.result_units, swept.found, strict=True)]
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


def input_words(swept: Any, place: int) -> str:
    """Return the name of a varied input with its unit, without the name of the table that contains it.

    Parameters
    ----------
    swept : InputSweep
        The sweep.
    place : int
        Index of the input in the sweep.
    """
    return _named(_input_name(swept.inputs[place]), swept.units[place])


def _input_name(path: str) -> str:
    return (path.partition(".")[2] or path).replace(".", " ").replace("_", " ")


def _named(name: str, unit: str) -> str:
    """Return a name with blanks for underscores, followed by its unit in brackets."""
    return f"{name.replace('_', ' ')} [{unit}]" if unit else name.replace("_", " ")


def curves(ax: Axes, x: np.ndarray, values: np.ndarray, labels: Sequence[str]) -> Axes:
    """Draw curves (curves, n) in different colours and styles; of many curves, only some evenly spaced ones.

    Parameters
    ----------
    ax : Axes
        Axes on which to draw.
    x : ndarray, shape (n,)
        Positions on the horizontal axis.
    values : ndarray, shape (curves, n)
        Values of the curves; a value that is not finite leaves a gap.
    labels : sequence of str
        Names of the curves.
    """
    values = np.where(np.isfinite(values), values, np.nan)
    for place, i in enumerate(evenly_spread(len(values), _MOST_CURVES)):
        label = labels[i] if np.isfinite(values[i]).any() else f"{labels[i]}: none"
        ax.plot(x, values[i], linewidth=1.6, label=label, **line_style(place))
    grid(ax)
    return ax


def mark_missing(ax: Axes, label: str) -> bool:
    """Mark x values at which a curve has no value by crosses at the bottom, in the colour of the curve.

    Parameters
    ----------
    ax : Axes
        Axes with the curves.
    label : str
        Text in the legend that explains the crosses.

    Returns
    -------
    bool
        Whether any curve lacks a value.
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
    """Draw a light grid behind the curves."""
    ax.grid(color="0.9", linewidth=0.8)
    ax.set_axisbelow(True)


def plot_bars(
    names: Sequence[str], rows: np.ndarray, labels: Sequence[str], xlabel: str, ax: Axes | None = None
) -> Axes:
    """Draw horizontal bars for k results of n names; the name with the longest bar is at the top.

    Parameters
    ----------
    names : sequence of str
        The names, shape (n,).
    rows : ndarray, shape (n, k)
        Lengths of the bars; a bar whose length is not finite is omitted.
    labels : sequence of str
        Names of the k results.
    xlabel : str
        Label of the horizontal axis.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    """
    ax = set_up_axes(ax, xlabel, "")
    finite = np.where(np.isfinite(rows), rows, 0.0)
    order = np.argsort(np.abs(finite).max(axis=1, initial=0.0), kind="stable")
    height = 0.8 / max(rows.shape[1], 1)
    for k, label in enumerate(labels):
        places = np.arange(len(names)) + (rows.shape[1] / 2 - k - 0.5) * height
        ax.barh(places, finite[order, k], height, label=label)
    ax.set_yticks(np.arange(len(names)), [str(names[i]) for i in order])
    room = max(_FEWEST_BARS - len(names), 0) / 2 + 0.5
    ax.set_ylim(-room, len(names) - 1 + room)
    ax.axvline(0.0, color="0.4", linewidth=0.8)
    return add_legend(ax)


# Loads -----------------------------------------------------------------------------------------------


def plot_along_span(
    x: np.ndarray,
    values: np.ndarray,
    labels: Sequence[str],
    quantity: str,
    ax: Axes | None = None,
    units: DisplayUnits = SI_UNITS,
) -> Axes:
    """Draw a quantity along the beam in a colour per component: few cases as lines, more as a band.

    Equal components are drawn as one curve.

    Parameters
    ----------
    x : ndarray, shape (S,)
        Positions along the beam [m]; a position with a jump of the quantity occurs twice.
    values : ndarray, shape (C, S, k)
        Values of k components in C cases, such as instants of time.
    labels : sequence of str, length k
        Names of the components, for the legend.
    quantity : str
        Name of the quantity, with its unit.
    ax : Axes, optional
        Axes to draw on; new axes if not given.
    units : DisplayUnits, optional
        Units of the axes; the arrays are SI.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, position_label(units), quantity)
    x = units.length_unit("m").of(x)
    for k, label in _alike(values, labels):
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


def _alike(values: np.ndarray, labels: Sequence[str]) -> list[tuple[int, str]]:
    """Return the index of one component (last axis) for each set of equal ones, with all their names.

    Curves of equal components would cover one another.
    """
    least = _SAME * np.nanmax(np.abs(values), initial=0.0)
    named: dict[int, list[str]] = {}
    for k, label in enumerate(labels):
        own = values[..., k]
        first = next((i for i in named if np.allclose(values[..., i], own, 0, least, equal_nan=True)), k)
        named.setdefault(first, []).append(label)
    return [(k, " and ".join(each)) for k, each in named.items()]


def plot_load_over_time(
    t: np.ndarray, values: np.ndarray, labels: Sequence[str], quantity: str, ax: Axes | None = None
) -> Axes:
    """Draw a quantity at one position on the beam over time, one line per component.

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
    """Draw the number of load cycles that have at least a given range, over the range.

    Parameters
    ----------
    ranges, counts : ndarray, shape (n,)
        Range and count (1 or 1/2) of each cycle.
    quantity : str
        Name of the range, with its unit.
    ax : Axes, optional
        Axes to draw on; new axes if not given.

    Returns
    -------
    Axes
    """
    ax = set_up_axes(ax, "cycles of at least this range", quantity)
    order = np.argsort(-ranges)
    ax.step(np.cumsum(counts[order]), ranges[order], where="pre", color=COLOURS[0], linewidth=1.8)
    ax.set_xscale("log")
    return ax


# Errors over computing time --------------------------------------------------------------------------


_CROWDED = 3.0  # ratio of the limits of a logarithmic axis above which labels of all minor ticks may overlap


def plot_work_precision(
    families: Mapping[str, np.ndarray], front: np.ndarray, title: str = "", ax: Axes | None = None
) -> Axes:
    """Draw error over computing time: a line per family of settings, and the Pareto front as a broad band.

    Parameters
    ----------
    families : mapping of str to ndarray, shape (settings, 2)
        Computing times [s] and relative errors, by name of the family; an error above 1 (no correct digit) is
        drawn as 1.
    front : ndarray, shape (settings, 2)
        Computing times [s] and relative errors of the Pareto-optimal measurements.
    title : str
        Title above the axes.
    ax : Axes, optional
        Axes to draw on; new axes if not given.

    Returns
    -------
    Axes
    """
    from matplotlib.ticker import LogFormatterSciNotation

    class FewLabels(LogFormatterSciNotation):
        """Formatter of minor ticks: labels those at 2 and 6 times powers of ten, or all on a short axis.

        An axis is short if the ratio of its limits is at most 3.
        """

        def __call__(self, x: float, pos: int | None = None) -> str:
            assert self.axis is not None
            low, high = self.axis.get_view_interval()
            crowded = high > _CROWDED * low and f"{x:.0e}"[0] not in "26"
            return "" if crowded else super().__call__(x, pos)

    ax = set_up_axes(ax, "time [s]", "relative error")
    ax.set(xscale="log", yscale="log")
    ax.set_title(title, fontsize=11)
    ax.tick_params(which="minor", labelsize=8)
    ax.xaxis.set_minor_formatter(FewLabels(minor_thresholds=(1.15, 0.3)))
    ax.plot(*_clip(front).T, color="0.85", linewidth=9, solid_capstyle="round", label="Pareto front")
    for i, (name, points) in enumerate(families.items()):
        marker = _MARKERS[i % len(_MARKERS)]
        ax.plot(*_clip(points).T, marker=marker, markersize=4, linewidth=1.2, label=name, **line_style(i))
    return add_legend(ax)


def _clip(points: np.ndarray) -> np.ndarray:
    """Drop points whose error is not positive, which a logarithmic axis cannot show; limit errors to 1."""
    return np.minimum(points[points[:, 1] > 0], [np.inf, 1.0])
