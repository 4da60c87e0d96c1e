"""Vibration of a cantilever on a carrier that rotates and translates.

The public face; names load their modules when first used, so that importing the package is quick.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

from beamdyn._version import __version__ as __version__
from beamdyn.common.results.shown_by import MEDIA, SHOWN_BY

MEDIA.append("beamdyn.common.edge.views")
SHOWN_BY.update(
    (f"beamdyn.{room}", f"beamdyn.{module}")
    for module, rooms in {
        "common.edge.spread_tables": ("common",),
        "files.decks.deck_tables": ("files",),
        "analyses.results.of_linear_models": ("linear",),
        "analyses.results.of_loads": ("loads",),
        "analyses.results.of_modes": ("equations", "modes", "scene"),
        "analyses.results.of_motion": ("steady", "transient"),
        "analyses.results.of_studies": ("studies",),
    }.items()
    for room in rooms
)

# The public names by their module.
_NAMES = {
    "studies.campbell.crossings": ("LineCrossing", "Margin"),
    "studies.campbell.diagram": ("Campbell", "campbell"),
    "common.results.announced": ("OutsideLinearTheory",),
    "common.results.result": ("load",),
    "scene.rotor": ("RotorDrawing", "draw"),
    "common.results.display_units": ("DisplayUnits",),
    "common.edge.config": ("ConfigError",),
    "files.scenes": ("load_scene",),
    "files.decks.audit": ("DeckAudit", "ModePolynomial", "PropertyStep", "ShapeCheck"),
    "files.decks.blade": ("IgnoredProperty",),
    "files.decks.deck": ("Deck", "read_deck"),
    "equations.discretization": ("Discretization",),
    "equations.fem": ("Fem",),
    "equations.ritz": ("Ritz",),
    "equations.effects": ("OmittedEffect",),
    "equations.terms": ("Terms", "terms"),
    "scene.beam": ("Beam",),
    "scene.points": ("PointMass", "PointSpring", "TipMass"),
    "scene.damping": ("Damping",),
    "loads.cycles": ("LoadCycles", "count_cycles"),
    "loads.load_statistics": ("RandomStatistics",),
    "loads.random_loads": ("RandomLoads", "random_loads"),
    "loads.span_loads": ("LargestLoad", "SpanLoads"),
    "loads.static_loads": ("StaticLoads", "static_loads"),
    "loads.steady_loads": ("SteadyLoads", "steady_loads"),
    "loads.transient_loads": ("TransientLoads", "transient_loads"),
    "scene.motion": (
        "Line",
        "Motion",
        "MotionSample",
        "RoadWave",
        "RollingWheel",
        "Rotation",
        "RotationFunction",
        "SampledRotation",
        "SampledTranslation",
        "SpinUp",
        "SteadyRotation",
        "UserMotion",
    ),
    "linear.inputs_outputs": (
        "AccelerationAt",
        "BaseMotion",
        "DeflectionAt",
        "MomentAtRoot",
        "PointForce",
        "StrainAtRoot",
    ),
    "linear.frequency_response": ("FrequencyResponse", "frequency_response"),
    "linear.matrices": ("Matrices", "matrices", "state_space"),
    "linear.mean_square": ("ParametricTerm",),
    "linear.random_response": ("RandomResponse", "random_response"),
    "linear.spectra": ("PowerSpectrum", "RoadRoughness"),
    "modes.modal.equilibrium": ("NoEquilibrium",),
    "scene.mount": ("Mount",),
    "scene.physics": ("JudgedEffect", "Physics", "PhysicsChoice"),
    "scene.profile": ("Polynomial", "Profile", "Table"),
    "scene.scene": ("Scene",),
    "modes.backbone": ("Backbone", "backbone"),
    "modes.bounds": ("FrequencyBounds", "frequency_bounds"),
    "modes.critical": ("CriticalPoint", "critical_point", "critical_speed"),
    "modes.equilibria": (
        "Equilibrium",
        "EquilibriumBranch",
        "EquilibriumBranches",
        "equilibrium",
        "equilibrium_branches",
    ),
    "studies.sensitivities.result": ("SceneNumber", "Sensitivities"),
    "studies.sensitivities.sensitivities": (
        "critical_speed_sensitivities",
        "crossing_sensitivities",
        "frequency_sensitivities",
    ),
    "modes.locus": ("Locus", "frequency_locus"),
    "modes.modes": ("Modes", "natural_modes"),
    "modes.setting_angles": ("SettingAngleLimits", "setting_angle_limits"),
    "steady.resonance": ("Crossing", "Crossings", "resonance_speeds"),
    "steady.response": ("SteadyResponse", "steady_response"),
    "common.inputs.designs": ("VariedInput",),
    "common.parallel.tasks": ("StudyInterrupted",),
    "common.spreading.first_order": ("FirstOrderRange",),
    "common.spreading.result": ("Spread",),
    "common.spreading.statistics": ("Scatter", "SobolIndices"),
    "common.spreading.tolerances": ("Normal", "SpreadInput", "Uniform"),
    "common.spreading.worst_case": ("WorstCases",),
    "studies.spread": ("spread",),
    "studies.result": ("Study",),
    "studies.study": ("study",),
    "studies.tradeoffs.tradeoff": ("Tradeoff", "tradeoff"),
    "transient.scipy_integrators": ("GaussCollocation",),
    "transient.simulate": ("simulate",),
    "transient.sweep": ("Sweep", "SweepInterrupted", "sweep"),
    "transient.transient": ("Transient",),
}
_MODULE_OF = {name: module for module, names in _NAMES.items() for name in names}
__all__ = sorted(_MODULE_OF)  # pyright: ignore[reportUnsupportedDunderAll]

if TYPE_CHECKING:
    from numpy.polynomial import Polynomial

    from beamdyn.common.edge.config import ConfigError
    from beamdyn.common.inputs.designs import VariedInput
    from beamdyn.common.parallel.tasks import StudyInterrupted
    from beamdyn.common.results.announced import OutsideLinearTheory
    from beamdyn.common.results.display_units import DisplayUnits
    from beamdyn.common.results.result import load
    from beamdyn.common.spreading.first_order import FirstOrderRange
    from beamdyn.common.spreading.result import Spread
    from beamdyn.common.spreading.statistics import Scatter, SobolIndices
    from beamdyn.common.spreading.tolerances import Normal, SpreadInput, Uniform
    from beamdyn.common.spreading.worst_case import WorstCases
    from beamdyn.equations.discretization import Discretization
    from beamdyn.equations.effects import OmittedEffect
    from beamdyn.equations.fem import Fem
    from beamdyn.equations.ritz import Ritz
    from beamdyn.equations.terms import Terms, terms
    from beamdyn.files.decks.audit import DeckAudit, ModePolynomial, PropertyStep, ShapeCheck
    from beamdyn.files.decks.blade import IgnoredProperty
    from beamdyn.files.decks.deck import Deck, read_deck
    from beamdyn.files.scenes import load_scene
    from beamdyn.linear.frequency_response import FrequencyResponse, frequency_response
    from beamdyn.linear.inputs_outputs import (
        AccelerationAt,
        BaseMotion,
        DeflectionAt,
        MomentAtRoot,
        PointForce,
        StrainAtRoot,
    )
    from beamdyn.linear.matrices import Matrices, matrices, state_space
    from beamdyn.linear.mean_square import ParametricTerm
    from beamdyn.linear.random_response import RandomResponse, random_response
    from beamdyn.linear.spectra import PowerSpectrum, RoadRoughness
    from beamdyn.loads.cycles import LoadCycles, count_cycles
    from beamdyn.loads.load_statistics import RandomStatistics
    from beamdyn.loads.random_loads import RandomLoads, random_loads
    from beamdyn.loads.span_loads import LargestLoad, SpanLoads
    from beamdyn.loads.static_loads import StaticLoads, static_loads
    from beamdyn.loads.steady_loads import SteadyLoads, steady_loads
    from beamdyn.loads.transient_loads import TransientLoads, transient_loads
    from beamdyn.modes.backbone import Backbone, backbone
    from beamdyn.modes.bounds import FrequencyBounds, frequency_bounds
    from beamdyn.modes.critical import CriticalPoint, critical_point, critical_speed
    from beamdyn.modes.equilibria import (
        Equilibrium,
        EquilibriumBranch,
        EquilibriumBranches,
        equilibrium,
        equilibrium_branches,
    )
    from beamdyn.modes.locus import Locus, frequency_locus
    from beamdyn.modes.modal.equilibrium import NoEquilibrium
    from beamdyn.modes.modes import Modes, natural_modes
    from beamdyn.modes.setting_angles import SettingAngleLimits, setting_angle_limits
    from beamdyn.scene.beam import Beam
    from beamdyn.scene.damping import Damping
    from beamdyn.scene.motion import (
        Line,
        Motion,
        MotionSample,
        RoadWave,
        RollingWheel,
        Rotation,
        RotationFunction,
        SampledRotation,
        SampledTranslation,
        SpinUp,
        SteadyRotation,
        UserMotion,
    )
    from beamdyn.scene.mount import Mount
    from beamdyn.scene.physics import JudgedEffect, Physics, PhysicsChoice
    from beamdyn.scene.points import PointMass, PointSpring, TipMass
    from beamdyn.scene.profile import Profile, Table
    from beamdyn.scene.rotor import RotorDrawing, draw
    from beamdyn.scene.scene import Scene
    from beamdyn.steady.crossings import Crossing, Crossings
    from beamdyn.steady.resonance import resonance_speeds
    from beamdyn.steady.response import SteadyResponse, steady_response
    from beamdyn.studies.campbell.crossings import LineCrossing, Margin
    from beamdyn.studies.campbell.diagram import Campbell, campbell
    from beamdyn.studies.result import Study
    from beamdyn.studies.sensitivities.result import SceneNumber, Sensitivities
    from beamdyn.studies.sensitivities.sensitivities import (
        critical_speed_sensitivities,
        crossing_sensitivities,
        frequency_sensitivities,
    )
    from beamdyn.studies.spread import spread
    from beamdyn.studies.study import study
    from beamdyn.studies.tradeoffs.tradeoff import Tradeoff, tradeoff
    from beamdyn.transient.scipy_integrators import GaussCollocation
    from beamdyn.transient.simulate import simulate
    from beamdyn.transient.sweep import Sweep, SweepInterrupted, sweep
    from beamdyn.transient.transient import Transient


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name not in _MODULE_OF:
        raise AttributeError(f"module 'beamdyn' has no attribute {name!r}")
    return getattr(import_module(f"beamdyn.{_MODULE_OF[name]}"), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
