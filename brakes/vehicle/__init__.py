"""Vehicles with two axles: stops, parking and hill hold, pitching over, and which axle locks first."""

from brakes.vehicle.axles import Truck, Vehicle
from brakes.vehicle.backwards import Needed, friction_to_hold, friction_to_stop
from brakes.vehicle.braking import Braking, braking_limits
from brakes.vehicle.holding import Holding, Road, hold
from brakes.vehicle.slowing import Approach, Slowing, slow_down
from brakes.vehicle.stop import Stop, StopConditions, stop

__all__ = [
    "Approach",
    "Braking",
    "Holding",
    "Needed",
    "Road",
    "Slowing",
    "Stop",
    "StopConditions",
    "Truck",
    "Vehicle",
    "braking_limits",
    "friction_to_hold",
    "friction_to_stop",
    "hold",
    "slow_down",
    "stop",
]
