"""Equal brakes at the wheels, whose torque is proportional to the force on their actuators."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from beamdyn.common.inputs.array_checks import Numbers, keep_checked
from beamdyn.common.inputs.described import Described


@dataclass(frozen=True)
class WheelBrakes:
    """Equal brakes on the braked wheels; every value may be an array, one entry per design.

    Parameters
    ----------
    c_star : float or ndarray
        Brake factor C* = torque / (force on the actuator times drum radius).
    drum_radius : float or ndarray
        Radius r at which the linings rub [m].
    wheel_radius : float or ndarray
        Radius of the braked wheels [m].
    number : float or ndarray
        Number of brakes.

    Raises
    ------
    ValueError
        If a value is not positive, or the number of brakes is not whole.

    Examples
    --------
    >>> brakes = chain.WheelBrakes(c_star=4.0, drum_radius=0.15, wheel_radius=0.4)
    >>> round(brakes.force_per_actuator_force, 6)
    3.0
    """

    c_star: Annotated[Numbers, Described("", "C*", "torque over actuator's force times drum radius", above=0)]
    drum_radius: Annotated[Numbers, Described("m", "r", "radius at which the linings rub", above=0)]
    wheel_radius: Annotated[Numbers, Described("m", "r_w", "radius of the braked wheels", above=0)]
    number: Annotated[Numbers, Described("", "n", "number of brakes", least=1, whole=True)] = 2.0

    def __post_init__(self) -> None:
        keep_checked(self)

    @property
    def force_per_actuator_force(self) -> Numbers:
        """Braking force of all braked wheels along the ground, over the force on each actuator."""
        return self.number * self.c_star * self.drum_radius / self.wheel_radius
