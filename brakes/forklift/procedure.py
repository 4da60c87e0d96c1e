"""All three stages in one call: stop of the vehicle, motion of the shoes, internal forces (section 5)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.common.array_checks import Numbers
from beamdyn.common.results import Result
from brakes.forklift.duo_servo import ShoeMotion
from brakes.forklift.forces import InternalForces, internal_forces
from brakes.forklift.vehicle import Stop, StopConditions, Truck, stop


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
        """Warnings of all three stages."""
        stops = () if np.all(self.stop.stops) else (self.stop.message,)
        return (*stops, *self.motion.interference, *self.forces.warnings)


def brake_procedure(
    truck: Truck,
    conditions: StopConditions,
    motion: ShoeMotion,
    *,
    piston_force: Numbers,
    lining_friction: Numbers | None = None,
) -> Procedure:
    """From slope and speed to the force on every part of a brake.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing of the stop.
    motion : ShoeMotion
        How the shoes of its front brakes move, from `DuoServo.move_shoes`.
    piston_force : float or ndarray
        P_T [N].
    lining_friction : float or ndarray, optional
        Friction of the lining, to compare with what the torque needs.

    Returns
    -------
    Procedure
        All three results. The torque is that of locked wheels, whether or not the truck stops.

    Raises
    ------
    ValueError
        As for `stop` and `internal_forces`.
    """
    stopped = stop(truck, conditions)
    forces = internal_forces(
        motion.levers, piston_force=piston_force, torque=stopped.torque_per_brake, friction=lining_friction
    )
    return Procedure(stopped, motion, forces)
