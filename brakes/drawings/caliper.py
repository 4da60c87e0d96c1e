"""A caliper with its curves, in one figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from brakes.calipers import Caliper, CaliperStroke
from brakes.drawings.mechanism import draw_open_and_closed, draw_rim, force_scale
from brakes.drawings.mechanism_stroke import (
    merged,
    plot_advantage,
    plot_couples,
    plot_pad_ratio,
    plot_reactions,
)
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


def caliper_figure(
    caliper: Caliper,
    run: CaliperStroke,
    closed: Equilibrium,
    cable: float | None = None,
    caption: str = "",
) -> Figure:
    """Draw a caliper open and closed, and its advantage, pad ratio and reactions over the stroke.

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    run : CaliperStroke
        Its stroke.
    closed : Equilibrium
        From `Caliper.equilibrium`.
    cable : float, optional
        Travel of the cable at which it is closed [m], marked in the curves; the end of the stroke if not
        given.
    caption : str
        A line under the title.
    """
    from matplotlib.figure import Figure

    place = 1e3 * float(run.cable[-1] if cable is None else cable)
    figure = Figure(figsize=(11.5, 7.6))  # laid out by hand: a layout engine takes twice as long
    sizes = [(joint.is_couple, joint.name, run.magnitudes[joint.name]) for joint in caliper.mechanism.joints]
    forces, couples = (
        {name: size for kind, name, size in sizes if kind is is_couple} for is_couple in (False, True)
    )
    heights = (1, 1, 1.6, 0.8) if merged(couples) else (1, 1, 1.6)
    cells = figure.add_gridspec(
        len(heights), 2, width_ratios=(1.25, 1), height_ratios=heights, wspace=0.2, hspace=0.08,
        left=0.065, right=0.985, bottom=0.075, top=0.94,
    )  # fmt: skip
    ax = draw_caliper(caliper, closed, figure.add_subplot(cells[:, 0]))
    force = f"{run.finger_force:g} N on the lever"
    title = f"{caliper.name}: {place:.3g} mm of cable, {force}; grey: open"
    ax.set_title("\n".join(filter(None, (title, caption))), fontsize=9 if caption else 11)
    curves = [figure.add_subplot(cells[row, 1]) for row in range(len(heights))]
    plot_advantage(run.cable, run.advantage, curves[0])
    plot_pad_ratio(run.cable, run.pad_ratio, curves[1])
    plot_reactions(run.cable, forces, curves[2])
    if len(curves) > 3:
        plot_couples(run.cable, couples, curves[3])
    for axes in curves:
        axes.axvline(place, color="0.4", linewidth=1, linestyle=":")
    for axes in curves[:-1]:
        axes.set_xlabel("")
        axes.tick_params(labelbottom=False)
    return figure
