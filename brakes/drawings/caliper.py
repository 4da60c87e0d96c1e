"""A caliper with its curves, in one figure."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from beamdyn.common.drawing.chart import Chart, ChartAxis
from beamdyn.common.drawing.chart_on_axes import plot_charts_of_one_x
from beamdyn.common.drawing.shapes import Drawing
from brakes.calipers import Caliper, CaliperStroke
from brakes.drawings.mechanism import open_and_closed
from brakes.drawings.mechanism_stroke import merged, named_curves, travel_axis
from brakes.planar import Equilibrium, Position

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_HEIGHTS = (1.0, 1.0, 1.6, 0.8)  # of the charts over the stroke, relative to one another


def caliper_drawing(caliper: Caliper, closed: Equilibrium, title: str = "") -> Drawing:
    """A caliper open (outlined in grey) and closed on the rim, with its forces; in mm.

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
    """Title of a drawing at a travel of the cable [m]."""
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
    charts = stroke_charts(caliper, run, place)
    plot_charts_of_one_x(figure, charts, 0.605, _HEIGHTS[: len(charts)])
    return figure


def stroke_charts(caliper: Caliper, run: CaliperStroke, cable: float) -> list[Chart]:
    """Advantage, velocity of the pads and reactions over the stroke, marked at a travel of the cable [m].

    Parameters
    ----------
    caliper : Caliper
        The caliper.
    run : CaliperStroke
        Its stroke.
    cable : float
        Where the cursor is [m].
    """
    sizes = [(joint.is_couple, joint.name, run.magnitudes[joint.name]) for joint in caliper.mechanism.joints]
    forces, couples = (
        {name: size for kind, name, size in sizes if kind is is_couple} for is_couple in (False, True)
    )
    shown = (
        ("Mechanical advantage of each pad", ChartAxis("pad force / finger force"), _sides(run.advantage)),
        (
            "Velocity ratio of each pad",
            ChartAxis("pad travel / cable travel"),
            _sides(run.pad_ratio),
        ),
        ("Forces of the joints", ChartAxis("force of the joint", "N"), merged(forces)),
        ("Couples of the joints", ChartAxis("couple of the joint", "N m"), merged(couples)),
    )
    x = 1e3 * run.cable
    travel = travel_axis("cable travel", "mm", x)
    return [
        Chart(title, travel, axis, named_curves(x, curves), cursor=1e3 * cable)
        for title, axis, curves in shown
        if curves
    ]


def _sides(pair: np.ndarray) -> dict[str, np.ndarray]:
    return {"right pad": pair[:, 0], "left pad": pair[:, 1]}
