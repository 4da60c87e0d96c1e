"""Curves over the stroke of a mechanism or a caliper."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beamdyn.common.pictures import COLOURS
from brakes.drawings.mechanism import draw_open_and_closed
from brakes.planar import Equilibrium, Position

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
    """

    travel: np.ndarray
    label: str
    forces: Mapping[str, np.ndarray]
    moments: Mapping[str, np.ndarray]
    place: float


def mechanism_figure(drawn: Position, shown: Equilibrium, heading: str, chart: StrokeChart | None) -> Figure:
    """Draw a mechanism as drawn, at one position with its forces, and its loads over the stroke.

    Parameters
    ----------
    drawn : Position
        Drawn as a shadow.
    shown : Equilibrium
        At one position.
    heading : str
        Title, of one line or more.
    chart : StrokeChart, optional
        Forces and moments have panels of their own.
    """
    from matplotlib.figure import Figure

    width = 12.0 if chart else 7.5
    figure = Figure(figsize=(width, 6))  # laid out by hand: a layout engine takes twice as long
    top = 0.97 - 0.04 * (1 + heading.count("\n"))
    panels = _panels(chart) if chart else []
    cells = figure.add_gridspec(
        max(len(panels), 1), 2 if chart else 1, wspace=0.2, hspace=0.08,
        left=0.8 / width, right=1 - 0.2 / width, bottom=0.1, top=top,
    )  # fmt: skip
    ax = draw_open_and_closed(drawn, shown, figure.add_subplot(cells[:, 0]))
    ax.set_title(heading, fontsize="medium" if "\n" in heading else None)
    for row, (curves, label) in enumerate(panels):
        assert chart is not None
        last = row == len(panels) - 1
        axes = plot_curves(
            chart.travel, curves, figure.add_subplot(cells[row, 1]), chart.label if last else "", label
        )
        axes.axvline(chart.place, color="0.4", linewidth=1, linestyle=":")
        axes.tick_params(labelbottom=last)
    return figure


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
