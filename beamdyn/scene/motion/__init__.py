"""Motions of the carrier: its angle, speed and angular acceleration, and the acceleration of its centre.

A rotation is about a fixed centre; a rolling wheel also travels, without slip.  Angles are not reduced to
one turn: in double precision an angle of 1e8 rad, and any phase computed from it (of the road, of gravity),
is accurate to 1.5e-8 rad.  At a jump, the values of a motion are those after the jump.
"""

from beamdyn.scene.motion.base import Line, Motion, MotionSample, check_consistent, check_picklable
from beamdyn.scene.motion.oscillating import PulsatingRotation, SampledTranslation, ShakenCarrier
from beamdyn.scene.motion.rolling import RoadWave, RollingWheel, UserMotion
from beamdyn.scene.motion.rotations import Rotation, RotationFunction, SampledRotation, SpinUp, SteadyRotation

KINDS: dict[str, type[Motion]] = {
    "steady": SteadyRotation,
    "spin_up": SpinUp,
    "pulsating": PulsatingRotation,
    "sampled": SampledRotation,
    "rolling": RollingWheel,
    "shaken": ShakenCarrier,
    "sampled_translation": SampledTranslation,
}
"""Motions by the kind that names them in files and forms; the first is the default."""

__all__ = [
    "KINDS",
    "Line",
    "Motion",
    "MotionSample",
    "PulsatingRotation",
    "RoadWave",
    "RollingWheel",
    "Rotation",
    "RotationFunction",
    "SampledRotation",
    "SampledTranslation",
    "ShakenCarrier",
    "SpinUp",
    "SteadyRotation",
    "UserMotion",
    "check_consistent",
    "check_picklable",
]
