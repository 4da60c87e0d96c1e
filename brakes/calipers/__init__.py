"""Bicycle calipers: force and travel of the pads over the stroke, with friction and wear."""

from brakes.calipers.caliper import Caliper
from brakes.calipers.designs import (
    NAMED,
    Cantilever,
    CentrePull,
    Design,
    DualPivot,
    EeBrake,
    SinglePivot,
    VBrake,
)
from brakes.calipers.results import CaliperStroke, PadWear, PivotFriction
from brakes.calipers.stopping import Stance, StoppingDistance, stop

__all__ = [
    "NAMED",
    "Caliper",
    "CaliperStroke",
    "Cantilever",
    "CentrePull",
    "Design",
    "DualPivot",
    "EeBrake",
    "PadWear",
    "PivotFriction",
    "SinglePivot",
    "Stance",
    "StoppingDistance",
    "VBrake",
    "stop",
]
