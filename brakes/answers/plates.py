"""Answers on multi-plate brakes."""

from brakes.answers.machine import MachineType
from brakes.drawings.annulus import draw_plates, plates_sketch
from brakes.machines import Plates

BRAKE = MachineType(
    Plates,
    "plates",
    "Multi-plate brake",
    "Rings pressed together: torque and pressure, new and worn in.",
    draw_plates,
    plates_sketch,
)
