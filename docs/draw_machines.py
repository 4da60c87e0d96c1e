"""Draw the picture of README.md and of the site's first page: `python docs/draw_machines.py`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.common.drawing.on_axes import draw_in
from beamdyn.common.drawing.shapes import Drawing
from brakes import calipers, forklift
from brakes.drawings.caliper import caliper_drawing
from brakes.drawings.forklift import truck

DOCS = Path(__file__).parent
FINGER, CABLE = 40.0, 3.5e-3  # force on the lever [N], travel of its cable [m]
BOXES = ((0.0, 0.0, 0.34, 1.0), (0.345, 0.0, 0.315, 1.0), (0.665, 0.0, 0.335, 1.0))  # parts of the figure


def harvester() -> Drawing:
    """A strip with a body at its tip on a wheel, at 60 deg."""
    strip = bd.Beam.rectangular(0.05, 0.01, 0.0005, 200e9, 7850.0, tip=bd.TipMass(0.01))
    mount = bd.Mount(radius=0.1, setting_angle=math.radians(60))
    plan = bd.draw(bd.Scene(strip, mount)).drawings()[0][0]
    return replace(plan, title="beamdyn: a cantilever on a wheel")


def bicycle_brake() -> Drawing:
    """The eeBrake, closed."""
    caliper = calipers.EeBrake().build()
    closed = caliper.equilibrium(CABLE, FINGER)
    return caliper_drawing(caliper, closed, f"brakes: a bicycle caliper, {FINGER:g} N on the lever")


def forklift_truck() -> Drawing:
    """The forklift truck of Yoo et al. on its slope."""
    conditions = forklift.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    machine = forklift.Truck(
        5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    )
    stop = forklift.stop(machine, conditions)
    return replace(truck(stop), title=f"brakes: a forklift that stops within {float(stop.distance):.2f} m")


def main() -> None:
    figure = Figure(figsize=(18.0, 6.2))
    for box, drawing in zip(BOXES, (harvester(), bicycle_brake(), forklift_truck()), strict=True):
        draw_in(figure, box, drawing)
    figure.savefig(DOCS / "machines.png", dpi=80)


if __name__ == "__main__":
    main()
