"""Answers on block brakes."""

from brakes.answers.machine import MachineType
from brakes.drawings.block import block_sketch, draw_block
from brakes.machines import Block

BRAKE = MachineType(
    Block,
    "block",
    "Block brake",
    "Blocks on levers outside a drum: torque, pressure, fulcrum forces, and when it locks itself.",
    draw_block,
    block_sketch,
)
