"""A forklift's brakes: how it stops, how its duo-servo shoes move, and the force on every part.

After Yoo et al. 1997; the corrected mechanics is the default, `model="as_printed"` the paper's.
"""

from brakes.forklift.duo_servo import BENDIX_12_5, DuoServo, ShoeMotion
from brakes.forklift.forces import InternalForces, internal_forces
from brakes.forklift.kinematics import Event, Kinematics, Stage, constraint_rank, follow, stage_1, stage_2
from brakes.forklift.levers import Levers
from brakes.forklift.newton import NewtonResult, newton_raphson
from brakes.forklift.procedure import Procedure, brake_procedure
from brakes.forklift.vehicle import Stop, Truck, stop

__all__ = [
    "BENDIX_12_5",
    "DuoServo",
    "Event",
    "InternalForces",
    "Kinematics",
    "Levers",
    "NewtonResult",
    "Procedure",
    "ShoeMotion",
    "Stage",
    "Stop",
    "Truck",
    "brake_procedure",
    "constraint_rank",
    "follow",
    "internal_forces",
    "newton_raphson",
    "stage_1",
    "stage_2",
    "stop",
]
