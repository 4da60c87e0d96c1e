"""Answers on band brakes."""

from brakes.answers.machine import MachineType
from brakes.drawings.band import band_sketch, draw_band
from brakes.machines import Band

BRAKE = MachineType(
    Band,
    "band",
    "Band brake",
    "A band around a drum, simple or differential: torque, tensions, pressure, and when it locks itself.",
    draw_band,
    band_sketch,
)
