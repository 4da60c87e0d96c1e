"""A caliper with its curves, in one figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from brakes.calipers import Caliper, CaliperStroke
from brakes.drawings.mechanism import draw_open_and_closed, draw_rim, force_scale
from brakes.drawings.mechanism_stroke import plot_advantage, plot_pad_ratio, plot_reactions
from brakes.planar import Equilibrium, Position

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def draw_caliper(caliper: Caliper, closed: Equilibrium, ax: Axes, key: bool = True) -> Axes:
    """Draw a caliper open (as a shadow) and closed on the rim, with its forces.

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    closed : Equilibrium
        From `Caliper.equilibrium`.
    ax : Axes
        Where to draw; in mm.
    key : bool
        Draw the key of colours and scale; without it the title has the scale.
    """
    place = closed.position
    shapes = [shape for name in caliper.pads for shape in caliper.mechanism.load(name).shapes()]
    if [shape.style for shape in shapes] == ["force", "force"]:
        draw_rim(np.array([place.point(*shape.ends[0]) for shape in shapes]), ax)
    draw_open_and_closed(Position(place.mechanism, np.zeros_like(place.coordinates)), closed, ax, key)
    newtons = 1e-3 / force_scale(closed)
    ax.set_title(caliper.name if key else f"{caliper.name} (1 mm is {newtons:.3g} N)")
    return ax


def caliper_figure(caliper: Caliper, run: CaliperStroke, closed: Equilibrium) -> Figure:
    """A figure: the caliper open and closed, and its advantage, pad ratio and reactions over the stroke."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(13, 9), layout="constrained")
    halves: Any = figure.subfigures(1, 2, width_ratios=(1.25, 1))
    ax = draw_caliper(caliper, closed, halves[0].subplots())
    ax.set_title(f"{caliper.name}: open (grey) and closed, {run.finger_force:g} N on the lever")
    curves = halves[1].subplots(3, 1, sharex=True, height_ratios=(1, 1, 1.6))
    plot_advantage(run.cable, run.advantage, curves[0])
    plot_pad_ratio(run.cable, run.pad_ratio, curves[1])
    plot_reactions(run.cable, run.magnitudes, curves[2])
    for axes in curves[:2]:
        axes.set_xlabel("")
    return figure
