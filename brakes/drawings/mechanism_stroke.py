"""Curves over the stroke of a mechanism or a caliper."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from types import MappingProxyType
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from beamdyn.common.drawing.chart import Chart, ChartAxis, ChartCurve, ChartPoints
from beamdyn.common.drawing.chart_on_axes import plot_charts_of_one_x
from beamdyn.common.drawing.shapes import Drawing

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class LoadsOverStroke(NamedTuple):
    """Loads over a stroke.

    Parameters
    ----------
    travel : ndarray, shape (S,)
        Travel of the driver, in `unit`.
    driver, unit : str
        Name of the driver, and the unit of its travel.
    forces, moments : mapping of str to ndarray, shape (S,)
        Loads by name [N], [N m].
    place : float
        Travel to mark, in `unit`.
    locked : mapping of str to ndarray of bool, shape (S,)
        Where the mechanism locks, by the name of the load.
    """

    travel: np.ndarray
    driver: str
    unit: str
    forces: Mapping[str, np.ndarray]
    moments: Mapping[str, np.ndarray]
    place: float
    locked: Mapping[str, np.ndarray] = MappingProxyType({})

    def charts(self) -> list[Chart]:
        """Charts of the forces and of the moments, as far as there are any."""
        return [
            self._chart(*each)
            for each in (("Forces", "force", "N", self.forces), ("Moments", "moment", "N m", self.moments))
            if each[-1]
        ]

    def _chart(self, title: str, what: str, unit: str, loads: Mapping[str, np.ndarray]) -> Chart:
        return Chart(
            f"{title} of the loads over the stroke",
            travel_axis(f"travel of {self.driver}", self.unit, self.travel),
            ChartAxis(f"{what} of the load", unit),
            named_curves(self.travel, loads),
            [*self._locked(loads)],
            cursor=self.place,
        )

    def _locked(self, loads: Mapping[str, np.ndarray]) -> Iterator[ChartPoints]:
        """Yield points on the axis of zero force where the mechanism locks."""
        for name in loads:
            if name in self.locked:
                at = self.travel[self.locked[name]].tolist()
                yield ChartPoints(f"{name}: locks", [(x, 0.0, f"{name}: locks") for x in at], "inside")


def mechanism_figure(drawing: Drawing, loads: LoadsOverStroke | None) -> Figure:
    """Draw a mechanism and its loads over the stroke.

    Parameters
    ----------
    drawing : Drawing
        From `brakes.drawings.mechanism.open_and_closed`.
    loads : LoadsOverStroke, optional
        Its loads, forces and moments in an axes each.
    """
    from matplotlib.figure import Figure

    from beamdyn.common.drawing.on_axes import draw_in

    width = 12.0 if loads else 7.5
    figure = Figure(figsize=(width, 6))  # laid out by hand: a layout engine takes twice as long
    draw_in(figure, (0.005, 0.01, (6.2 if loads else width) / width - 0.01, 0.98), drawing)
    if loads is not None:
        charts = loads.charts()
        plot_charts_of_one_x(figure, charts, 7.0 / width, [1.0] * len(charts))
    return figure


def travel_axis(name: str, unit: str, travel: np.ndarray) -> ChartAxis:
    """The axis of the travel, as long as the stroke."""
    return ChartAxis(name, unit, low=float(travel.min()), high=float(travel.max()))


def named_curves(x: np.ndarray, curves: Mapping[str, np.ndarray]) -> list[ChartCurve]:
    """Curves by their names; every other one is dashed, so that equal ones are seen."""
    return [ChartCurve(name, x, y, dashed=bool(k % 2)) for k, (name, y) in enumerate(curves.items())]


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
