"""Stop, motion of the shoes and internal forces of a forklift's brakes in one call (Yoo et al. 1997)."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from beamdyn.common.inputs.array_checks import Numbers
from beamdyn.common.inputs.checks import kind
from beamdyn.common.results.one_line import spanned, warned
from beamdyn.common.results.result import Result
from brakes.forklift.duo_servo import ShoeMotion
from brakes.forklift.forces import InternalForces, internal_forces
from brakes.vehicle import Stop, StopConditions, Truck, stop


@dataclass(frozen=True)
class Procedure(Result):
    """Results of the three stages of a forklift's braking: stop, motion of the shoes, and internal forces.

    Attributes
    ----------
    stop : Stop
        The truck's stop; its torque of one brake is used for the forces.
    motion : ShoeMotion
        Motion of the shoes; its lever arms are used for the forces.
    forces : InternalForces
        Forces in each front brake.

    Examples
    --------
    >>> truck = forklift.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = forklift.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> motion = forklift.BENDIX_12_5.move_shoes(0.0106)
    >>> found = forklift.brake_procedure(truck, conditions, motion, piston_force=11650.0)
    >>> bool(found.forces.torque == found.stop.torque_per_brake)
    True
    """

    stop: Stop
    motion: ShoeMotion
    forces: InternalForces

    def headline(self) -> Iterator[str]:
        """Yield the parts of the result's one-line summary; see `Result.headline`."""
        yield f"stop in {spanned(self.stop.distance, 'm')}"
        yield f"drum turns {spanned(np.degrees(self.motion.drum_turn), 'deg')}"
        yield f"C* {spanned(self.forces.c_star)}"
        yield warned(self.warnings)

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings of all three stages, one sentence each."""
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
    """Compute stop, shoe motion and brake forces, from slope and speed to the force on every part.

    Parameters
    ----------
    truck : Truck
        The truck and its load.
    conditions : StopConditions
        Road, speed and timing of the stop.
    motion : ShoeMotion
        Motion of the shoes of the front brakes, from `DuoServo.move_shoes`.
    piston_force : float or ndarray
        Force P_T of the piston on the trailing shoe [N].
    lining_friction : float or ndarray, optional
        Friction of the lining, to compare with the friction that the torque needs.

    Returns
    -------
    Procedure
        All three results. The torque is that of locked wheels, whether or not the truck stops.

    Raises
    ------
    ValueError
        As for `stop` and `internal_forces`.

    References
    ----------
    Yoo et al. (1997), section 5, with the mechanics corrected.

    Examples
    --------
    >>> truck = forklift.Truck(
    ...     5950, (1.049, 0.359), 3500, (-1.20, 0.450), front_wheel_radius=0.40, wheelbase=1.89
    ... )
    >>> conditions = forklift.StopConditions(0.3019, 20 / 3.6, friction=0.7, reaction_time=0.5, rise_time=0.3)
    >>> motion = forklift.BENDIX_12_5.move_shoes(0.0106)
    >>> found = forklift.brake_procedure(truck, conditions, motion, piston_force=11650.0)
    >>> round(float(found.stop.distance), 2)  # m
    13.42
    """
    kind("motion", motion, ShoeMotion, "DuoServo.move_shoes gives one")
    stopped = stop(truck, conditions)
    given = {"torque": stopped.torque_per_brake, "friction": lining_friction}
    forces = internal_forces(motion.levers, piston_force=piston_force, **given)
    return Procedure(stopped, motion, forces)
