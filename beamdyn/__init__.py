"""Vibration of a cantilever on a carrier that rotates and translates.

This module has the public names; each loads its module when first used, so that the import is quick.
"""

from __future__ import annotations

from functools import cache
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

# These imports of the public names are for type checkers only.  At run time `__getattr__` reads from them in
# which module a name is, and loads this module when the name is first used.
if TYPE_CHECKING:
    from numpy.polynomial import Polynomial

    from beamdyn.common.edge.config import ConfigError
    from beamdyn.common.inputs.described import VariedInput
    from beamdyn.common.parallel.tasks import StudyInterrupted
    from beamdyn.common.results.columns import DisplayUnits
    from beamdyn.common.results.result import load
    from beamdyn.common.results.statements import OutsideLinearTheory
    from beamdyn.common.spreading.first_order import FirstOrderRange
    from beamdyn.common.spreading.spread_result import Spread
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
    from beamdyn.files.measured_data import read_measurements
    from beamdyn.files.scenes import load_scene
    from beamdyn.linear.frequency_response import FrequencyResponse, frequency_response
    from beamdyn.linear.inputs_outputs import (
        AccelerationAt,
        BaseMotion,
        DeflectionAt,
        HarvestedCurrent,
        HarvestedVoltage,
        LayerStrain,
        MomentAtRoot,
        PointForce,
        StrainAtRoot,
    )
    from beamdyn.linear.matrices import Matrices, matrices
    from beamdyn.linear.mean_square import ParametricTerm
    from beamdyn.linear.random_response import RandomResponse, random_response
    from beamdyn.linear.spectra import PowerSpectrum, RoadRoughness
    from beamdyn.linear.state_space import state_space
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
    from beamdyn.scene.harvester import Harvester
    from beamdyn.scene.measured_curves import MeasuredHistory, MeasuredLoads, MeasuredPeaks, MeasuredResponse
    from beamdyn.scene.measured_frequencies import MeasuredFrequencies
    from beamdyn.scene.motion.base import Line, Motion, MotionSample
    from beamdyn.scene.motion.oscillating import PulsatingRotation, SampledTranslation, ShakenCarrier
    from beamdyn.scene.motion.rolling import RoadWave, RollingWheel, UserMotion
    from beamdyn.scene.motion.rotations import (
        Rotation,
        RotationFunction,
        SampledRotation,
        SpinUp,
        SteadyRotation,
    )
    from beamdyn.scene.mount import Damping, Mount
    from beamdyn.scene.physics import JudgedEffect, Physics, PhysicsChoice
    from beamdyn.scene.points import PointMass, PointSpring, TipLoad, TipMass
    from beamdyn.scene.profile import Profile, Table
    from beamdyn.scene.rotor import RotorDrawing, draw
    from beamdyn.scene.scene import Scene
    from beamdyn.scene.section_matrices import SectionMatrices
    from beamdyn.steady.best_resistance import BestResistance, best_resistance
    from beamdyn.steady.crossings import Crossing, Crossings
    from beamdyn.steady.harvest import Harvest, harvest
    from beamdyn.steady.resonance import resonance_speeds
    from beamdyn.steady.response import SteadyResponse, steady_response
    from beamdyn.steady.road_harvest import RoadHarvest
    from beamdyn.studies.beside_data.compare import compare
    from beamdyn.studies.beside_data.curve_comparison import CurveComparison
    from beamdyn.studies.beside_data.frequency_comparison import FrequencyComparison
    from beamdyn.studies.beside_data.identify import Identification, identify
    from beamdyn.studies.beside_data.separability import NotSeparable
    from beamdyn.studies.beside_data.single_numbers import OneNumberFit
    from beamdyn.studies.campbell.diagram import Campbell, campbell
    from beamdyn.studies.campbell.line_crossings import LineCrossing, Margin
    from beamdyn.studies.designing.design import FoundDesign, design
    from beamdyn.studies.designing.target import Target
    from beamdyn.studies.floquet.point import FloquetMultipliers, floquet_multipliers
    from beamdyn.studies.floquet.stability_chart import StabilityChart, stability_chart
    from beamdyn.studies.floquet.stability_limits import StabilityLimits, stability_limits
    from beamdyn.studies.sensitivities.sensitivities import (
        critical_speed_sensitivities,
        crossing_sensitivities,
        frequency_sensitivities,
    )
    from beamdyn.studies.sensitivities.sensitivity_result import SceneNumber, Sensitivities
    from beamdyn.studies.spread import spread
    from beamdyn.studies.study import study
    from beamdyn.studies.study_result import Study
    from beamdyn.studies.tradeoffs.tradeoff import Tradeoff, tradeoff
    from beamdyn.transient.harvested_energy import TransientHarvest, transient_harvest
    from beamdyn.transient.scipy_integrators import GaussCollocation
    from beamdyn.transient.simulate import simulate
    from beamdyn.transient.sweep import Sweep, SweepInterrupted, sweep
    from beamdyn.transient.transient import Transient


@cache
def _modules() -> dict[str, str]:
    """Return the module of each public name, read from the block ``if TYPE_CHECKING`` of this file."""
    import ast  # not at the top: it would lengthen the import of this package by a fifth

    with open(__file__, encoding="utf-8") as file:
        tree = ast.parse(file.read())
    (block,) = (node for node in tree.body if isinstance(node, ast.If))
    imports = (node for node in block.body if isinstance(node, ast.ImportFrom))
    return {name.name: str(each.module) for each in imports for name in each.names}


def __getattr__(name: str) -> Any:
    """Load a public name from its module."""
    if name == "__all__":
        return sorted(_modules())
    if name not in _modules():
        raise AttributeError(f"module 'beamdyn' has no attribute {name!r}")
    return getattr(import_module(_modules()[name]), name)


def __dir__() -> list[str]:
    return sorted({*globals(), *_modules()})
