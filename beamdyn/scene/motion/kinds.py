"""Motions by the kind that names them in files and forms."""

from beamdyn.scene.motion.base import Motion
from beamdyn.scene.motion.oscillating import PulsatingRotation, SampledTranslation, ShakenCarrier
from beamdyn.scene.motion.rolling import RollingWheel
from beamdyn.scene.motion.rotations import SampledRotation, SpinUp, SteadyRotation

KINDS: dict[str, type[Motion]] = {
    "steady": SteadyRotation,
    "spin_up": SpinUp,
    "pulsating": PulsatingRotation,
    "sampled": SampledRotation,
    "rolling": RollingWheel,
    "shaken": ShakenCarrier,
    "sampled_translation": SampledTranslation,
}
"""The first kind is the default."""
