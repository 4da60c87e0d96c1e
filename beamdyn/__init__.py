"""Vibration of a cantilever on a carrier that rotates and translates.

Public interface: a name loads its module when first used, so that importing the package is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from beamdyn._version import __version__ as __version__

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

_MODULES = {
    "Beam": "scene.beam",
    "Crossing": "steady.resonance",
    "Crossings": "steady.resonance",
    "Fem": "equations.fem",
    "FrequencyBounds": "spectrum.bounds",
    "GaussCollocation": "transient.gauss",
    "Locus": "spectrum.modes",
    "Modes": "spectrum.modes",
    "Mount": "scene.mount",
    "Ritz": "equations.ritz",
    "RoadWave": "scene.motion",
    "RollingWheel": "scene.motion",
    "RotationFunction": "scene.motion",
    "SampledRotation": "scene.motion",
    "Scene": "scene.scene",
    "SpinUp": "scene.motion",
    "SteadyResponse": "steady.response",
    "SteadyRotation": "scene.motion",
    "Sweep": "transient.sweep",
    "SweepInterrupted": "transient.chunk_collector",
    "Table": "scene.profile",
    "TipMass": "scene.beam",
    "Tradeoff": "tradeoffs",
    "Transient": "transient.simulate",
    "UserMotion": "scene.motion",
    "critical_point": "spectrum.critical",
    "critical_speed": "spectrum.critical",
    "frequency_bounds": "spectrum.bounds",
    "frequency_locus": "spectrum.modes",
    "load_scene": "config",
    "natural_modes": "spectrum.modes",
    "resonance_speeds": "steady.resonance",
    "setting_angle_limits": "spectrum.critical",
    "simulate": "transient.simulate",
    "steady_response": "steady.response",
    "sweep": "transient.sweep",
    "terms": "equations.terms",
    "tradeoff": "tradeoffs",
}

if TYPE_CHECKING:
    from beamdyn.config import load_scene
    from beamdyn.equations.fem import Fem
    from beamdyn.equations.ritz import Ritz
    from beamdyn.equations.terms import terms
    from beamdyn.scene.beam import Beam, TipMass
    from beamdyn.scene.motion import (
        RoadWave,
        RollingWheel,
        RotationFunction,
        SampledRotation,
        SpinUp,
        SteadyRotation,
        UserMotion,
    )
    from beamdyn.scene.mount import Mount
    from beamdyn.scene.profile import Table
    from beamdyn.scene.scene import Scene
    from beamdyn.spectrum.bounds import FrequencyBounds, frequency_bounds
    from beamdyn.spectrum.critical import critical_point, critical_speed, setting_angle_limits
    from beamdyn.spectrum.modes import Locus, Modes, frequency_locus, natural_modes
    from beamdyn.steady.resonance import Crossing, Crossings, resonance_speeds
    from beamdyn.steady.response import SteadyResponse, steady_response
    from beamdyn.tradeoffs import Tradeoff, tradeoff
    from beamdyn.transient.chunk_collector import SweepInterrupted
    from beamdyn.transient.gauss import GaussCollocation
    from beamdyn.transient.simulate import Transient, simulate
    from beamdyn.transient.sweep import Sweep, sweep


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _MODULES:
        raise AttributeError(f"module 'beamdyn' has no attribute {name!r}")
    return getattr(import_module(f"beamdyn.{_MODULES[name]}"), name)


def __dir__() -> list[str]:
    return sorted([*globals(), *__all__])
