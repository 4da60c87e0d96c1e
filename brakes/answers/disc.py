"""Answers on disc brakes."""

from brakes.answers.machine import MachineType
from brakes.drawings.annulus import disc_sketch, draw_disc
from brakes.machines import Disc

BRAKE = MachineType(
    Disc,
    "disc",
    "Disc brake",
    "A pad on each side of a disc, fixed or floating caliper: torque, forces and pressure, new and worn in.",
    draw_disc,
    disc_sketch,
)
