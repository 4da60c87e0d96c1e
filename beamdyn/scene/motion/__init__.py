"""Motions of the carrier: its angle, speed and acceleration, and the acceleration of its centre.

A rotation turns about a fixed centre; a rolling wheel also travels, as far as its rotation says.
Angles are not reduced to one turn: a double holds 1e8 rad to 1.5e-8 rad, and phases that follow from
the angle (of the road, of gravity) to no more.  At a jump, values are those after it.
"""

from beamdyn.scene.motion.base import Line, Motion, MotionSample
from beamdyn.scene.motion.checks import check_consistent, check_picklable
from beamdyn.scene.motion.rolling import RoadWave, RollingWheel, UserMotion
from beamdyn.scene.motion.rotations import (
    Rotation,
    RotationFunction,
    SampledRotation,
    SpinUp,
    SteadyRotation,
)

KINDS: dict[str, type[Motion]] = {
    "steady": SteadyRotation,
    "spin_up": SpinUp,
    "sampled": SampledRotation,
    "rolling": RollingWheel,
}
"""Motions that files and forms offer, by their kind; a table that names no kind is of the first."""

__all__ = [
    "KINDS",
    "Line",
    "Motion",
    "MotionSample",
    "RoadWave",
    "RollingWheel",
    "Rotation",
    "RotationFunction",
    "SampledRotation",
    "SpinUp",
    "SteadyRotation",
    "UserMotion",
    "check_consistent",
    "check_picklable",
]
