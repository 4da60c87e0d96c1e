"""A forklift's brakes: how it stops, how its duo-servo shoes move, and the force on every part.

After Yoo et al. 1997, with the mechanics corrected; `brakes.reproduce` has the paper's own version.
"""

from brakes.forklift.duo_servo import BENDIX_12_5, DuoServo, Levers, ShoeMotion
from brakes.forklift.forces import InternalForces, equilibrium_equations, internal_forces
from brakes.forklift.kinematics import (
    Event,
    Kinematics,
    Stage,
    build_seating_mechanism,
    build_turning_mechanism,
    constraint_rank,
    follow_shoes,
)
from brakes.forklift.procedure import Procedure, brake_procedure
from brakes.vehicle import Stop, StopConditions, Truck, stop

__all__ = [
    "BENDIX_12_5",
    "DuoServo",
    "Event",
    "InternalForces",
    "Kinematics",
    "Levers",
    "Procedure",
    "ShoeMotion",
    "Stage",
    "Stop",
    "StopConditions",
    "Truck",
    "brake_procedure",
    "build_seating_mechanism",
    "build_turning_mechanism",
    "constraint_rank",
    "equilibrium_equations",
    "follow_shoes",
    "internal_forces",
    "stop",
]
