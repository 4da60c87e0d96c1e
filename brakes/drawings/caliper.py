"""A caliper with its curves, in one figure."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from beamdyn.common.drawing.shapes import Drawing
from brakes.calipers import Caliper, CaliperStroke
from brakes.drawings.mechanism import open_and_closed
from brakes.drawings.mechanism_stroke import (
    merged,
    plot_advantage,
    plot_couples,
    plot_pad_ratio,
    plot_reactions,
)
from brakes.planar import Equilibrium, Position

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def caliper_drawing(caliper: Caliper, closed: Equilibrium, title: str = "") -> Drawing:
    """A caliper open (as a shadow) and closed on the rim, with its forces; in mm.

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    closed : Equilibrium
        From `Caliper.equilibrium`.
    title : str
        Title; the caliper's name if not given.
    """
    place = closed.position
    shapes = [shape for name in caliper.pads for shape in caliper.mechanism.load(name).shapes()]
    both_push = [shape.style for shape in shapes] == ["force", "force"]
    faces = np.array([place.point(*shape.ends[0]) for shape in shapes]) if both_push else None
    open_ = Position(place.mechanism, np.zeros_like(place.coordinates))
    return open_and_closed(open_, closed, title or caliper.name, faces)


def title_of(caliper: Caliper, run: CaliperStroke, cable: float) -> str:
    """What a drawing at some travel of the cable [m] shows."""
    return f"{caliper.name}: {1e3 * cable:.3g} mm of cable, {run.finger_force:g} N on the lever; grey: open"


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

    from beamdyn.common.drawing.on_axes import draw_in

    figure = Figure(figsize=(11.5, 7.6))  # laid out by hand: a layout engine takes twice as long
    place = float(run.cable[-1] if cable is None else cable)
    title = "\n".join(filter(None, (title_of(caliper, run, place), caption)))
    draw_in(figure, (0.005, 0.01, 0.545, 0.985), caliper_drawing(caliper, closed, title))
    plot_stroke(figure, caliper, run, place, left=0.605)
    return figure


def curves_figure(caliper: Caliper, run: CaliperStroke, cable: float) -> Figure:
    """Draw advantage, pad ratio and reactions over the stroke, marked at a travel of the cable [m]."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(7.0, 7.6))
    plot_stroke(figure, caliper, run, cable, left=0.1)
    return figure


def plot_stroke(figure: Any, caliper: Caliper, run: CaliperStroke, cable: float, left: float) -> None:
    """Plot the curves over the stroke below one another, from a part of the figure's width on."""
    sizes = [(joint.is_couple, joint.name, run.magnitudes[joint.name]) for joint in caliper.mechanism.joints]
    forces, couples = (
        {name: size for kind, name, size in sizes if kind is is_couple} for is_couple in (False, True)
    )
    heights = (1, 1, 1.6, 0.8) if merged(couples) else (1, 1, 1.6)
    cells = figure.add_gridspec(
        len(heights), 1, height_ratios=heights, hspace=0.08, left=left, right=0.985, bottom=0.075, top=0.965
    )
    curves = [figure.add_subplot(cells[row, 0]) for row in range(len(heights))]
    plot_advantage(run.cable, run.advantage, curves[0])
    plot_pad_ratio(run.cable, run.pad_ratio, curves[1])
    plot_reactions(run.cable, forces, curves[2])
    if len(curves) > 3:
        plot_couples(run.cable, couples, curves[3])
    for axes in curves:
        axes.axvline(1e3 * cable, color="0.4", linewidth=1, linestyle=":")
    for axes in curves[:-1]:
        axes.set_xlabel("")
        axes.tick_params(labelbottom=False)
