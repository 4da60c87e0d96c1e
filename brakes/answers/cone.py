"""Answers on cone brakes."""

from brakes.answers.machine import MachineType
from brakes.drawings.annulus import cone_sketch, draw_cone
from brakes.machines import Cone

BRAKE = MachineType(
    Cone,
    "cone",
    "Cone brake",
    "A cone pressed into a cup: torque, pressure new and worn in, and whether it sticks.",
    draw_cone,
    cone_sketch,
)
