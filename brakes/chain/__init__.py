"""From pedal or lever to wheels: actuation by line or cable, braking force, fading and heat of a stop."""

from brakes.chain.braked import (
    Actuation,
    BrakedStop,
    WheelBrakes,
    actuate,
    brake_from_pedal,
    force_for,
    ratio_for,
)
from brakes.chain.heat import Drums, Heat, fade_of_stops, heat_of_stop
from brakes.chain.lines import BrakeCable, HydraulicLine
from brakes.chain.pedal import Pedal

__all__ = [
    "Actuation",
    "BrakeCable",
    "BrakedStop",
    "Drums",
    "Heat",
    "HydraulicLine",
    "Pedal",
    "WheelBrakes",
    "actuate",
    "brake_from_pedal",
    "fade_of_stops",
    "force_for",
    "heat_of_stop",
    "ratio_for",
]
