"""The paper's procedure in one call: vehicle, then kinematics, then internal forces (section 5)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from beamdyn.common.array_checks import Numbers
from beamdyn.common.results import Result
from brakes.forklift.duo_servo import BENDIX_12_5, DuoServo, ShoeMotion
from brakes.forklift.forces import InternalForces, internal_forces
from brakes.forklift.vehicle import STANDARD_GRAVITY, Stop, Truck, stop


@dataclass(frozen=True)
class Procedure(Result):
    """Results of the three stages, each carried into the next.

    Attributes
    ----------
    stop : Stop
        The stop; its torque of one brake goes into the forces.
    motion : ShoeMotion
        The shoes' motion; its lever arms go into the forces.
    forces : InternalForces
        The forces.
    """

    stop: Stop
    motion: ShoeMotion
    forces: InternalForces

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to look at, of all three stages."""
        stops = () if np.all(self.stop.stops) else (self.stop.message,)
        return (*stops, *self.motion.interference, *self.forces.warnings)


def brake_procedure(
    truck: Truck,
    geometry: DuoServo = BENDIX_12_5,
    *,
    slope: Numbers,
    speed: Numbers,
    friction: Numbers,
    reaction_time: Numbers,
    rise_time: Numbers,
    piston_force: Numbers,
    clearance: Numbers,
    lining_friction: Numbers | None = None,
    model: Literal["corrected", "as_printed"] = "corrected",
    distance: Literal["exact", "printed"] = "exact",
    factor: Numbers = 1.0,
    g: float = STANDARD_GRAVITY,
) -> Procedure:
    """From slope and speed to the force on every part of a brake.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    geometry : DuoServo
        Its front brakes.
    slope, speed, friction, reaction_time, rise_time, model, distance, factor, g
        As for `stop`; `friction` is that of the front wheels on the ground.
    piston_force : float or ndarray
        P_T [N].
    clearance : float or ndarray
        Between lining and drum at rest [m].
    lining_friction : float or ndarray, optional
        Friction of the lining, to compare with what the torque needs.

    Returns
    -------
    Procedure
        All three results. The torque is that of locked wheels, whether or not the truck stops.

    Raises
    ------
    ValueError
        As for `stop`, `DuoServo.motion` and `internal_forces`.
    """
    stopped = stop(
        truck,
        slope=slope,
        speed=speed,
        friction=friction,
        reaction_time=reaction_time,
        rise_time=rise_time,
        model=model,
        distance=distance,
        factor=factor,
        g=g,
    )
    motion = geometry.motion(clearance)
    forces = internal_forces(
        motion.levers, piston_force=piston_force, torque=stopped.torque_per_brake, friction=lining_friction
    )
    return Procedure(stopped, motion, forces)
