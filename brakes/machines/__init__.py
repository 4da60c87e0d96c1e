"""Brakes whose linings are pressed by one force: bands, discs, plates, cones, blocks and sliding shoes.

Each brake is a frozen dataclass of its dimensions; `solve_brake` computes its forces, forward or in reverse,
from the actuating force, the largest pressure or the torque.
"""

from brakes.machines.annulus import Cone, Disc, Plates
from brakes.machines.band import Band
from brakes.machines.block import Block
from brakes.machines.machine import LiningResult, Machine, MachineResult, solve_brake
from brakes.machines.sliding import Sliding

__all__ = [
    "Band",
    "Block",
    "Cone",
    "Disc",
    "LiningResult",
    "Machine",
    "MachineResult",
    "Plates",
    "Sliding",
    "solve_brake",
]
