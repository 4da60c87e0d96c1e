"""Vibration of a cantilever on a carrier that rotates and translates.

The public face; names load their modules when first used, so that importing the package is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0"

__all__ = [
    "Beam",
    "Crossing",
    "Crossings",
    "Fem",
    "FrequencyBounds",
    "GaussCollocation",
    "Locus",
    "Modes",
    "Mount",
    "Ritz",
    "RoadWave",
    "RollingWheel",
    "RotationFunction",
    "SampledRotation",
    "Scene",
    "SpinUp",
    "SteadyResponse",
    "SteadyRotation",
    "Sweep",
    "SweepInterrupted",
    "Table",
    "TipMass",
    "Tradeoff",
    "Transient",
    "UserMotion",
    "critical_point",
    "critical_speed",
    "frequency_bounds",
    "frequency_locus",
    "load_scene",
    "natural_modes",
    "resonance_speeds",
    "setting_angle_limits",
    "simulate",
    "steady_response",
    "sweep",
    "terms",
    "tradeoff",
]

_HOME = {
    "Beam": "beam",
    "Crossing": "resonance",
    "Crossings": "resonance",
    "Fem": "fem",
    "FrequencyBounds": "bounds",
    "GaussCollocation": "integrators",
    "Locus": "spectrum",
    "Modes": "spectrum",
    "Mount": "scene",
    "Ritz": "ritz",
    "RoadWave": "motion",
    "RollingWheel": "motion",
    "RotationFunction": "motion",
    "SampledRotation": "motion",
    "Scene": "scene",
    "SpinUp": "motion",
    "SteadyResponse": "steady",
    "SteadyRotation": "motion",
    "Sweep": "sweeps",
    "SweepInterrupted": "sweeps",
    "Table": "profile",
    "TipMass": "beam",
    "Tradeoff": "tradeoffs",
    "Transient": "transient",
    "UserMotion": "motion",
    "critical_point": "stability",
    "critical_speed": "stability",
    "frequency_bounds": "bounds",
    "frequency_locus": "spectrum",
    "load_scene": "config",
    "natural_modes": "spectrum",
    "resonance_speeds": "resonance",
    "setting_angle_limits": "stability",
    "simulate": "transient",
    "steady_response": "steady",
    "sweep": "sweeps",
    "terms": "inventory",
    "tradeoff": "tradeoffs",
}

if TYPE_CHECKING:
    from beamdyn.beam import Beam, TipMass
    from beamdyn.bounds import FrequencyBounds, frequency_bounds
    from beamdyn.config import load_scene
    from beamdyn.fem import Fem
    from beamdyn.integrators import GaussCollocation
    from beamdyn.inventory import terms
    from beamdyn.motion import (
        RoadWave,
        RollingWheel,
        RotationFunction,
        SampledRotation,
        SpinUp,
        SteadyRotation,
        UserMotion,
    )
    from beamdyn.profile import Table
    from beamdyn.resonance import Crossing, Crossings, resonance_speeds
    from beamdyn.ritz import Ritz
    from beamdyn.scene import Mount, Scene
    from beamdyn.spectrum import Locus, Modes, frequency_locus, natural_modes
    from beamdyn.stability import critical_point, critical_speed, setting_angle_limits
    from beamdyn.steady import SteadyResponse, steady_response
    from beamdyn.sweeps import Sweep, SweepInterrupted, sweep
    from beamdyn.tradeoffs import Tradeoff, tradeoff
    from beamdyn.transient import Transient, simulate


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _HOME:
        raise AttributeError(f"module 'beamdyn' has no attribute {name!r}")
    return getattr(import_module(f"beamdyn.{_HOME[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
