"""Answers on drum brakes with sliding shoes."""

from brakes.answers.machine import MachineType
from brakes.drawings.sliding import draw_sliding, sliding_sketch
from brakes.machines import Sliding

BRAKE = MachineType(
    Sliding,
    "sliding",
    "Sliding shoes",
    "A drum brake whose shoes slide on an abutment: torque, where the linings touch, when it locks itself.",
    draw_sliding,
    sliding_sketch,
)
