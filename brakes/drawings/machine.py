"""Figures and charts of brakes whose linings are pressed by one force: pressure, and C* over friction."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from matplotlib.figure import Figure

from beamdyn.common.drawing.on_axes import draw_in, plot_chart
from beamdyn.common.drawing.shapes import Chart, ChartAxis, ChartCurve, ChartMark, Drawing
from brakes.machines import MachineResult, solve_brake

_POINTS = 101  # number of points of each curve
FRICTION_SHOWN, LIMIT_SHOWN = 0.8, 1.6  # largest friction in charts: without self-locking, and with it
_SCALES = {"deg": 180 / np.pi, "mm": 1e3}


def beside_charts(drawing: Drawing, charts: Sequence[Chart]) -> Figure:
    """Draw a brake and, beside it, its charts one below the other."""
    figure = Figure(figsize=(11.5, 7.0))
    draw_in(figure, (0.005, 0.01, 0.55, 0.98), drawing)
    rows = len(charts)
    cells = figure.add_gridspec(rows, 1, left=0.62, right=0.985, bottom=0.15 / rows, top=0.955, hspace=0.3)
    for row, chart in enumerate(charts):
        plot_chart(figure.add_subplot(cells[row, 0]), chart)
    return figure


def charts_of(result: MachineResult) -> list[Chart]:
    """Make the charts of pressure, unless the brake locks, and of the brake factor; for a single case."""
    return [factor_chart(result)] if result.locked else [pressure_chart(result), factor_chart(result)]


def pressure_chart(result: MachineResult) -> Chart:
    """Make the chart of the pressure along each lining, with vertical lines to zero at the ends."""
    brake = result.brake
    low, high = (float(end) for end in brake.reach())
    at, scale = np.linspace(low, high, _POINTS), _SCALES[brake.place.shown]
    curves = [
        ChartCurve(
            lining.name,
            scale * np.r_[low, at, high],
            1e-6
            * float(lining.peak_pressure)
            * np.r_[0.0, brake.pressure_on(i, at, float(result.friction), result.reverse), 0.0],
            dashed=bool(i % 2),
        )
        for i, lining in enumerate(result.linings)
    ]
    across = ChartAxis(brake.place.words, brake.place.shown)
    return Chart("Pressure on the linings", across, ChartAxis("pressure", "MPa", low=0.0), curves)


def factor_chart(result: MachineResult) -> Chart:
    """Make the chart of the brake factor C* over friction, for both directions of rotation.

    A mark shows the friction at which the brake locks.
    """
    mu, limit = float(result.friction), float(result.locking_friction)
    ends = 0 < limit < LIMIT_SHOWN and (mu <= limit or bool(result.locked))
    top = 0.995 * limit if ends else max(FRICTION_SHOWN, 1.3 * mu)
    at = np.linspace(1e-3 * top, top, _POINTS)
    ways = [solve_brake(result.brake, friction=at, force=1.0, reverse=way) for way in (False, True)]
    curves = [
        ChartCurve("reverse" if way.reverse else "forward", at, way.c_star, dashed=way.reverse)
        for way in ways
    ]
    own = curves[result.reverse]
    marks = [ChartMark(mu, f"{mu:g}", at_foot=True)]
    if ends:
        marks.append(ChartMark(limit, f"locks at {limit:.3g}", curve=own.name))
    # C* grows without bound towards locking: the range of its axis follows from C* at a lower friction.
    known = np.isfinite(own.y)
    grows = known.any() and any(np.isfinite(way.locking_friction).any() for way in ways)
    near = float(np.interp(min(mu, 0.6 * top), at[known], own.y[known])) if grows else None
    return over_friction("Brake factor", curves, marks, near)


def over_friction(
    title: str, curves: Sequence[ChartCurve], marks: Sequence[ChartMark], near: float | None
) -> Chart:
    """Make a chart of the brake factor C* over friction.

    `near` is a typical C*: the axis of C* ends at 2.5 times `near`, but not below 1. If it is None, the axis
    shows all of the curves.
    """
    high = None if near is None else max(2.5 * near, 1.0)
    factor = ChartAxis("C* = torque / (force * radius)", low=0.0, high=high)
    return Chart(title, ChartAxis("friction of the linings", low=0.0), factor, curves, marks=marks)
