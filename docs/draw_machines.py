"""Draw the picture of README.md and of the site's first page: `python docs/draw_machines.py`."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

from matplotlib.figure import Figure

import beamdyn as bd
from beamdyn.common.drawing.on_axes import draw_in
from beamdyn.common.drawing.shapes import Drawing
from brakes import calipers
from brakes.drawings.caliper import caliper_drawing

DOCS = Path(__file__).parent
FINGER, CABLE = 40.0, 3.5e-3  # force on the lever [N], travel of its cable [m]
BOXES = ((0.0, 0.0, 0.5, 1.0), (0.51, 0.0, 0.49, 1.0))  # parts of the figure


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


def main() -> None:
    figure = Figure(figsize=(12.5, 6.5))
    for box, drawing in zip(BOXES, (harvester(), bicycle_brake()), strict=True):
        draw_in(figure, box, drawing)
    figure.savefig(DOCS / "machines.png", dpi=110)


if __name__ == "__main__":
    main()
