"""Curves over the stroke of a mechanism or a caliper."""

from __future__ import annotations

from collections.abc import Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beamdyn.common.drawing.shapes import Drawing
from beamdyn.common.pictures import COLOURS

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

_STYLES = ("-", "--", "-.", ":")


class StrokeChart(NamedTuple):
    """Loads over a stroke.

    travel : (S,), travel of the driver, in the unit of its label.
    label : of its axis.
    forces, moments : (S,) by name [N], [N m].
    place : the travel to mark.
    locked : (S,) by name, where the mechanism locks.
    """

    travel: np.ndarray
    label: str
    forces: Mapping[str, np.ndarray]
    moments: Mapping[str, np.ndarray]
    place: float
    locked: Mapping[str, np.ndarray] = MappingProxyType({})


def mechanism_figure(drawing: Drawing, chart: StrokeChart | None) -> Figure:
    """Draw a mechanism and its loads over the stroke.

    Parameters
    ----------
    drawing : Drawing
        From `brakes.drawings.mechanism.open_and_closed`.
    chart : StrokeChart, optional
        Forces and moments have panels of their own.
    """
    from matplotlib.figure import Figure

    from beamdyn.common.drawing.on_axes import draw_in

    width = 12.0 if chart else 7.5
    figure = Figure(figsize=(width, 6))  # laid out by hand: a layout engine takes twice as long
    draw_in(figure, (0.005, 0.01, (6.2 if chart else width) / width - 0.01, 0.98), drawing)
    if chart is not None:
        plot_chart(figure, chart, left=7.0 / width)
    return figure


def chart_figure(chart: StrokeChart) -> Figure:
    """Draw the loads over the stroke."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 6.0))
    plot_chart(figure, chart, left=0.12)
    return figure


def plot_chart(figure: Figure, chart: StrokeChart, left: float) -> None:
    """Plot forces and moments below one another, from a part of the figure's width on."""
    panels = _panels(chart)
    cells = figure.add_gridspec(len(panels), 1, hspace=0.08, left=left, right=0.985, bottom=0.1, top=0.95)
    for row, (curves, label) in enumerate(panels):
        last = row == len(panels) - 1
        xlabel = chart.label if last else ""
        axes = plot_curves(chart.travel, curves, figure.add_subplot(cells[row, 0]), xlabel, label)
        axes.axvline(chart.place, color="0.4", linewidth=1, linestyle=":")
        _mark_locked(axes, chart, curves)
        axes.tick_params(labelbottom=last)


def _mark_locked(axes: Axes, chart: StrokeChart, curves: Mapping[str, np.ndarray]) -> None:
    """Mark on the axis of zero force where the mechanism locks."""
    for k, name in enumerate(curves):
        if name in chart.locked:
            x = chart.travel[chart.locked[name]]
            label = f"{name}: locks"
            axes.plot(x, np.zeros_like(x), "x", color=COLOURS[k % len(COLOURS)], markersize=5, label=label)
    if chart.locked:
        axes.legend(fontsize="small")


def _panels(chart: StrokeChart) -> list[tuple[Mapping[str, np.ndarray], str]]:
    """The curves of each panel and the label of its axis: newtons and newton metres apart."""
    both = [(chart.forces, "force of the load [N]"), (chart.moments, "moment of the load [N m]")]
    return [panel for panel in both if panel[0]]


def plot_curves(x: np.ndarray, curves: Mapping[str, np.ndarray], ax: Axes, xlabel: str, ylabel: str) -> Axes:
    """Plot named curves over x; curves of one colour differ by their dashes."""
    for k, (name, y) in enumerate(curves.items()):
        colour, style = COLOURS[k % len(COLOURS)], _STYLES[(k // len(COLOURS) + k) % len(_STYLES)]
        ax.plot(x, y, style, color=colour, linewidth=1.9, label=name)
    ax.set(xlabel=xlabel, ylabel=ylabel)
    ax.grid(color="0.88", linewidth=0.7)
    ax.legend(fontsize="small")
    return ax


def plot_advantage(cable: np.ndarray, advantage: np.ndarray, ax: Axes) -> Axes:
    """Plot the force of each pad (S, 2) over that of the finger, over the travel of the cable (S,) [m]."""
    return plot_curves(1e3 * cable, _sides(advantage), ax, "cable travel [mm]", "pad force / finger force")


def plot_pad_ratio(cable: np.ndarray, ratio: np.ndarray, ax: Axes) -> Axes:
    """Plot the velocity of each pad (S, 2) over that of the cable, over its travel (S,) [m]."""
    return plot_curves(1e3 * cable, _sides(ratio), ax, "cable travel [mm]", "pad travel / cable travel")


def plot_reactions(cable: np.ndarray, magnitudes: Mapping[str, np.ndarray], ax: Axes) -> Axes:
    """Plot the joints' forces (S,) [N] over the travel of the cable (S,) [m]; equal ones as one curve."""
    return plot_curves(1e3 * cable, merged(magnitudes), ax, "cable travel [mm]", "force of the joint [N]")


def plot_couples(cable: np.ndarray, magnitudes: Mapping[str, np.ndarray], ax: Axes) -> Axes:
    """Plot the joints' couples (S,) [N m] over the travel of the cable (S,) [m]; equal ones as one curve."""
    return plot_curves(1e3 * cable, merged(magnitudes), ax, "cable travel [mm]", "couple of the joint [N m]")


def merged(curves: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """Drop curves that are zero, and merge equal ones under their joined names."""
    noise = 1e-9 * max((float(np.nanmax(np.abs(y), initial=0.0)) for y in curves.values()), default=0.0)
    groups: list[tuple[list[str], np.ndarray]] = []
    for name, y in curves.items():
        equal = next((names for names, other in groups if np.allclose(y, other, rtol=0, atol=noise)), None)
        if equal is not None:
            equal.append(name)
        elif np.nanmax(np.abs(y), initial=0.0) > noise:
            groups.append(([name], y))
    return {", ".join(names): y for names, y in groups}


def _sides(pair: np.ndarray) -> dict[str, np.ndarray]:
    return {"right pad": pair[:, 0], "left pad": pair[:, 1]}
