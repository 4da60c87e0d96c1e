"""Drum brakes with pivoted long shoes: torque, forces, shoe factor and self-locking.

Axes of a shoe (Vardanyan et al. 2019): the drum's centre O is the origin, the shoe lies on the +x
side, its pin at (b, -c), and the actuating force P acts along +x at y = +a. Angles alpha run from -y
(towards the pin) through +x: a point of the drum is r (sin alpha, -cos alpha). Describe a shoe
on the other side as if it lay on the +x side: vectors of its results are in the axes mirrored to its side.
The shoe leads
if the drum's surface moves towards the pin: on the +x side, if the drum turns clockwise.
"""

from brakes.common.energy import stop_energy, temperature_rise
from brakes.common.heat import Duty, Fade, repeat_stops
from brakes.common.loads import wheel_cylinder_force
from brakes.drum.assembly import BrakeResult, DrumBrake, brake_torque, duplex, shoe_torque, simplex
from brakes.drum.shoe import Shoe, ShoeResult

__all__ = [
    "BrakeResult",
    "DrumBrake",
    "Duty",
    "Fade",
    "Shoe",
    "ShoeResult",
    "brake_torque",
    "duplex",
    "repeat_stops",
    "shoe_torque",
    "simplex",
    "stop_energy",
    "temperature_rise",
    "wheel_cylinder_force",
]
