"""Every argument of every public name refuses values of a wrong kind, in one sentence that names it."""

import inspect
import math
from dataclasses import fields
from decimal import Decimal
from fractions import Fraction

import numpy as np
import pytest

import beamdyn as bd
from beamdyn.common.results.result import Result
from brakes import planar
from tests.unit.wrong_values import refusals_missing

BEAM = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
SCENE = bd.Scene(BEAM, bd.Mount(0.2))
DAMPED = bd.Scene(BEAM, bd.Mount(0.2), damping_ratio=0.01)
MOVING = bd.Scene(BEAM, bd.Mount(0.2), bd.RollingWheel(0.3, 20.0, bd.RoadWave(0.3, 0.01)))
PULSATING = bd.Scene(BEAM, bd.Mount(0.2), bd.PulsatingRotation(5.0, 0.1, 100.0))
LAYERS = bd.Harvester(1e-4, 7750.0, e31=-10.0, c11e=6e10, eps33s=1.3e-8, resistance=1e5)
HARVESTING = bd.Scene(LAYERS.on(BEAM), bd.Mount(0.2), MOVING.motion, damping_ratio=0.01)
RUN, RESPONSE = bd.simulate(MOVING, 0.02, 2, 1e-3), bd.steady_response(MOVING, [5.0], 2)
LOADS = bd.transient_loads(RUN, at=[0.0])

SECTIONS = {
    "stations": [0.0, 1.0],
    "stiffness": [np.diag([1e9, 1e8, 1e8, 1e6, 4e6, 1e6])] * 2,
    "mass": [np.diag([100.0, 100.0, 100.0, 3.0, 1.0, 2.0])] * 2,
}


def tabulated(stations, values):
    return bd.Beam.rectangular(0.05, bd.Table(stations, values), 0.0002, 200e9, 7850.0)


# Each public name of beamdyn, or a way to make it, with valid arguments.
CALLS = {
    "Beam": (bd.Beam, {field.name: getattr(BEAM, field.name) for field in fields(bd.Beam)}),
    "Beam.rectangular": (
        bd.Beam.rectangular,
        {"length": 0.05, "width": 0.01, "thickness": 0.0002, "youngs_modulus": 200e9, "density": 7850.0}
        | {"tip": None, "breakpoints": (), "twist": 0.1, "poissons_ratio": 0.3, "point_masses": ()}
        | {"point_springs": (), "sweep": None, "prebend": 0.1},
    ),
    "Beam.from_stiffness": (
        bd.Beam.from_stiffness,
        {"length": 0.05, "mass_per_length": 0.0157, "bending_stiffness": 1.3e-3, "axial_stiffness": 4e5}
        | {"outer_fibre": 1e-4, "tip": None, "breakpoints": (), "second_bending_stiffness": 3.0, "twist": 0.1}
        | {"shear_stiffness": 1e5, "second_shear_stiffness": 1e5}
        | {"rotary_inertia": 5e-11, "second_rotary_inertia": 1e-7, "point_masses": ()}
        | {"point_springs": (), "torsion_stiffness": 0.1, "warping_stiffness": 1e-9}
        | {"sweep": 0.1, "prebend": None}
        | {"mass_offset": 1e-3, "tension_offset": -1e-3},
    ),
    "Beam.from_matrices": (
        bd.Beam.from_matrices,
        {"length": 5.0, "matrices": bd.SectionMatrices.at_stations(**SECTIONS), "tip": None, "twist": 0.1}
        | {"breakpoints": (), "point_masses": (), "point_springs": (), "sweep": None, "prebend": 0.1},
    ),
    "SectionMatrices": (
        bd.SectionMatrices,
        {name: getattr(bd.SectionMatrices.at_stations(**SECTIONS), name) for name in ("stiffness", "mass")},
    ),
    "SectionMatrices.at_stations": (bd.SectionMatrices.at_stations, SECTIONS),
    "PointMass": (bd.PointMass, {"position": 0.02, "mass": 1e-3}),
    "PointSpring": (bd.PointSpring, {"position": 0.02, "stiffness": 1.0, "direction": "bending"}),
    "Damping": (
        bd.Damping,
        {"ratios": [0.01], "mass_factor": 0.1, "stiffness_factor": 1e-6, "tip_damper": 0.01},
    ),
    "TipLoad": (bd.TipLoad, {"force": [0.0, 1.0, 0.0], "moment": [0.0, 0.0, 1.0], "follows": False}),
    "Harvester": (
        bd.Harvester,
        {"thickness": 1e-4, "density": 7750.0, "connection": "series", "e31": -10.0, "c11e": 6e10}
        | {"eps33s": 1.3e-8, "d31": None, "s11e": None, "eps33t": None}
        | {"start": 0.0, "end": 0.03, "resistance": 1e5, "strain_limit": 5e-4, "poissons_ratio": 0.3},
    ),
    "TipMass": (
        bd.TipMass,
        dict.fromkeys(
            ("mass", "offset", "inertia", "transverse_inertia", "axial_inertia", "offset_across"), 1e-9
        ),
    ),
    "Mount": (
        bd.Mount,
        {"radius": 0.2, "setting_angle": 0.0, "bending_angle": 0.0}
        | {"root_stiffness": 1.0, "second_root_stiffness": math.inf, "precone": 0.0},
    ),
    "Physics": (
        bd.Physics,
        {
            "planes": 1,
            "shear": False,
            "rotary_inertia": False,
            "camber": False,
            "torsion": False,
            "stretch": False,
        }
        | {"large_deflection": False, "branch": "straight"},
    ),
    "Scene": (
        bd.Scene,
        {"beam": BEAM, "mount": bd.Mount(), "motion": None, "damping_ratio": 0.0, "gravity": 0.0}
        | {"physics": bd.Physics(), "damping": bd.Damping(), "label": "a", "units": {"speed": "rpm"}}
        | {"tip_load": bd.TipLoad()},
    ),
    "Table": (tabulated, {"stations": [0, 0.5, 1], "values": [0.01] * 3}),
    "SteadyRotation": (bd.SteadyRotation, {"speed": 5.0}),
    "SpinUp": (bd.SpinUp, {"speed": 5.0, "duration": 1.0, "law": "smooth"}),
    "SampledRotation": (
        bd.SampledRotation,
        {"times": [0.0, 1.0, 2.0], "speeds": [0.0, 1.0, 2.0], "interpolation": "cubic"},
    ),
    "SampledTranslation": (
        bd.SampledTranslation,
        {"times": [0.0, 1.0, 2.0], "along_n1": [0.0, 1.0, 2.0], "along_n2": (), "along_n3": ()}
        | {"rotation": 5.0, "interpolation": "linear"},
    ),
    "PulsatingRotation": (bd.PulsatingRotation, {"speed": 5.0, "fluctuation": 0.1, "frequency": 3.0}),
    "ShakenCarrier": (
        bd.ShakenCarrier,
        {"frequency": 3.0, "along_n1": 1.0, "along_n2": 0.0, "along_n3": 0.0, "rotation": 5.0},
    ),
    "RotationFunction": (
        bd.RotationFunction,
        {"angle": lambda t: 5 * t, "speed": lambda t: 5 + 0 * t, "acceleration": lambda t: 0 * t}
        | {"t_end": 1.0, "breakpoints": (), "scale": 1.0},
    ),
    "RoadWave": (bd.RoadWave, {"wavelength": 0.3, "velocity_amplitude": 0.01, "height": None}),
    "RollingWheel": (bd.RollingWheel, {"rolling_radius": 0.3, "speed": 5.0, "road": None}),
    "UserMotion": (bd.UserMotion, {"function": bd.SpinUp(5.0, 1.0).at, "breakpoints": (), "t_end": 1.0}),
    "Ritz": (bd.Ritz, {"functions": 14, "basis": "legendre"}),
    "Fem": (bd.Fem, {"elements": 40, "mesh": "graded", "on_each": 2}),
    "draw": (bd.draw, {"scene": SCENE}),
    "natural_modes": (
        bd.natural_modes,
        {"scene": SCENE, "speed": 5.0, "modes": 2, "discretization": "ritz", "tolerance": 0.1},
    ),
    "frequency_locus": (
        bd.frequency_locus,
        {"scene": SCENE, "speeds": [1.0, 2.0], "modes": 2, "discretization": "ritz", "tolerance": 0.1},
    ),
    "critical_point": (
        bd.critical_point,
        {"scene": SCENE, "discretization": "ritz", "tolerance": 0.1},
    ),
    "critical_speed": (
        bd.critical_speed,
        {"scene": SCENE, "discretization": "ritz", "tolerance": 0.1},
    ),
    "equilibrium": (
        bd.equilibrium,
        {"scene": SCENE, "speed": 5.0, "branch": "straight", "discretization": "ritz", "tolerance": 0.1},
    ),
    "equilibrium_branches": (
        bd.equilibrium_branches,
        {"scene": SCENE, "top_speed": 5.0, "discretization": "ritz"},
    ),
    "backbone": (
        bd.backbone,
        {"scene": SCENE, "speed": 5.0, "mode": 1, "discretization": "ritz", "tolerance": 1e-3},
    ),
    "setting_angle_limits": (
        bd.setting_angle_limits,
        {"scene": SCENE, "top_speed": 100.0, "discretization": "ritz", "tolerance": 1e-3},
    ),
    "frequency_bounds": (bd.frequency_bounds, {"scene": SCENE, "speed": 5.0, "modes": 2}),
    "resonance_speeds": (
        bd.resonance_speeds,
        {"scene": MOVING, "top_speed": 100.0, "modes": 2, "order": 1, "discretization": "ritz"}
        | {"tolerance": 1e-3},
    ),
    "steady_response": (
        bd.steady_response,
        {"scene": MOVING, "speeds": [5.0, 6.0], "modes": 2, "harmonics": 1, "tolerance": 1e-3}
        | {"discretization": "ritz"},
    ),
    "harvest": (
        bd.harvest,
        {
            "scene": HARVESTING,
            "speeds": [5.0, 6.0],
            "modes": 2,
            "tolerance": 1e-3,
            "discretization": "ritz",
            "road": None,
        },
    ),
    "best_resistance": (
        bd.best_resistance,
        {
            "scene": HARVESTING,
            "speed": 5.0,
            "modes": 1,
            "tolerance": 1e-3,
            "discretization": "ritz",
            "road": None,
        },
    ),
    "transient_harvest": (bd.transient_harvest, {"run": bd.simulate(HARVESTING, 0.02, 2, 1e-3)}),
    "HarvestedVoltage": (bd.HarvestedVoltage, {}),
    "HarvestedCurrent": (bd.HarvestedCurrent, {}),
    "LayerStrain": (bd.LayerStrain, {"position": 0.02}),
    "floquet_multipliers": (
        bd.floquet_multipliers,
        {"scene": PULSATING, "modes": 2, "discretization": "ritz"},
    ),
    "stability_chart": (
        bd.stability_chart,
        {"scene": PULSATING, "vary": {"speed": [5.0], "mount.radius": [0.1]}, "modes": 2}
        | {"discretization": "ritz", "workers": 1, "store": None},
    ),
    "stability_limits": (
        bd.stability_limits,
        {"scene": PULSATING, "vary": {"speed": [5.0], "mount.radius": [0.1]}, "modes": 2}
        | {"discretization": "ritz", "workers": 1, "store": None},
    ),
    "simulate": (
        bd.simulate,
        {"scene": MOVING, "t_end": 0.02, "modes": 2, "tolerance": 1e-3, "method": "auto"}
        | {"discretization": "ritz", "initial": "rest", "t_eval": None},
    ),
    "static_loads": (
        bd.static_loads,
        {"scene": SCENE, "speeds": 5.0, "at": [0.0], "points": [(0.0, 0.0)], "angle": 0.1}
        | {"youngs_modulus": 1e9, "discretization": "ritz", "tolerance": 1e-3},
    ),
    "transient_loads": (
        bd.transient_loads,
        {"run": RUN, "at": [0.0], "points": [(0.0, 0.0)], "t": [0.01], "youngs_modulus": 1e9},
    ),
    "steady_loads": (
        bd.steady_loads,
        {"response": RESPONSE, "at": [0.0], "points": [(0.0, 0.0)], "youngs_modulus": 1e9},
    ),
    "count_cycles": (
        bd.count_cycles,
        {"loads": LOADS, "quantity": "moment", "station": 0, "component": 0, "start": 0.0, "end": 0.02},
    ),
    "sweep": (
        bd.sweep,
        {"scene": MOVING, "speeds": [5.0], "window": (0.0, 0.02), "t_end": None, "modes": 2}
        | {"tolerance": 1e-3, "workers": 1, "executor": None, "store": None, "progress": None}
        | {"discretization": "ritz", "chunk": 40},
    ),
    "campbell": (
        bd.campbell,
        {"scenes": [SCENE], "speeds": [0.0, 5.0], "modes": 2, "per_rev": [1, 2], "rated": 4.0}
        | {
            "operating": (3.0, 5.0),
            "unit": "rpm",
            "bounds": False,
            "discretization": "ritz",
            "tolerance": 0.1,
        },
    ),
    "study": (
        bd.study,
        {"scene": SCENE, "vary": {"mount.radius": [0.1]}, "what": "frequencies", "speed": 5.0, "modes": 2}
        | {"combine": "product", "discretization": "ritz", "tolerance": 0.1}
        | {"workers": 1, "executor": None, "progress": None, "store": None, "window": None},
    ),
    "spread": (
        bd.spread,
        {"scene": SCENE, "inputs": {"mount.radius": "+-1%"}, "what": "frequencies", "samples": 128}
        | {"seed": 0, "speed": 5.0, "modes": 2, "window": None, "discretization": "ritz"}
        | {"tolerance": 0.1, "workers": 1, "executor": None, "progress": None, "store": None},
    ),
    "Uniform": (bd.Uniform, {"low": 1.0, "high": 2.0, "text": "1 to 2"}),
    "Normal": (bd.Normal, {"mean": 1.0, "deviation": 2.0, "text": "sd 2"}),
    "BaseMotion": (bd.BaseMotion, {"direction": "n3"}),
    "PointForce": (bd.PointForce, {"position": 0.02, "direction": "bending"}),
    "DeflectionAt": (bd.DeflectionAt, {"position": 0.02, "direction": "bending"}),
    "AccelerationAt": (bd.AccelerationAt, {"position": 0.02, "direction": "bending"}),
    "MomentAtRoot": (bd.MomentAtRoot, {}),
    "StrainAtRoot": (bd.StrainAtRoot, {}),
    "PowerSpectrum": (
        bd.PowerSpectrum,
        {"frequencies": [1.0, 2.0], "values": [1.0, 1.0], "interpolation": "log"},
    ),
    "RoadRoughness": (
        bd.RoadRoughness,
        {"roughness": 64e-6, "waviness": 2.0, "lowest": 0.01, "highest": 10.0},
    ),
    "matrices": (
        bd.matrices,
        {"scene": SCENE, "speed": 5.0, "modes": 2, "discretization": "ritz", "inputs": ["bending"]}
        | {"tolerance": 1e-3},
    ),
    "state_space": (
        bd.state_space,
        {"scene": SCENE, "speed": 5.0, "inputs": ["bending"], "outputs": ["tip"], "modes": 2}
        | {"discretization": "ritz", "tolerance": 1e-3},
    ),
    "frequency_response": (
        bd.frequency_response,
        {"scene": DAMPED, "speed": 5.0, "frequencies": [1.0, 2.0], "input": "bending", "output": "tip"}
        | {"modes": 2, "tolerance": 1e-3, "discretization": "ritz"},
    ),
    "random_response": (
        bd.random_response,
        {"scene": DAMPED, "speed": 5.0, "psd": bd.PowerSpectrum([1, 2], [1, 1]), "input": "bending"}
        | {"output": "tip", "frequencies": [1.0], "modes": 2, "tolerance": 1e-3, "discretization": "ritz"},
    ),
    "random_loads": (
        bd.random_loads,
        {"scene": DAMPED, "speed": 5.0, "psd": bd.PowerSpectrum([1, 2], [1, 1]), "input": "bending"}
        | {"duration": 60.0, "at": [0.0], "points": [(1e-4, 0.0)], "youngs_modulus": 2e11, "modes": 2}
        | {"tolerance": 1e-2, "discretization": "ritz"},
    ),
    "DisplayUnits": (bd.DisplayUnits, {"speed": "rpm", "length": "mm"}),
    "frequency_sensitivities": (
        bd.frequency_sensitivities,
        {"scene": SCENE, "speed": 5.0, "modes": 2, "inputs": ["beam.length"], "discretization": "ritz"}
        | {"tolerance": 0.1},
    ),
    "MeasuredFrequencies": (
        bd.MeasuredFrequencies,
        {"frequency": [65.0], "speeds": [0.0], "uncertainty": 0.1, "rounding": 0.05, "labels": ["flap 1"]}
        | {"positions": [0.0, 0.05], "shapes": [[0.0, 1.0]], "source": "a.csv", "speed_unit": "rpm"},
    ),
    "MeasuredHistory": (
        bd.MeasuredHistory,
        {"time": [0.0, 0.1, 0.2], "value": [0.0, 1.0, 0.0], "names": ["tip"], "uncertainty": 0.1}
        | {"rounding": 0.05, "source": "a.csv"},
    ),
    "MeasuredPeaks": (
        bd.MeasuredPeaks,
        {"speed": [1.0, 2.0, 3.0], "value": [0.0, 1.0, 0.0], "window": [1.0, 2.0], "names": ["largest tip"]}
        | {"uncertainty": 0.1, "rounding": 0.05, "source": "a.csv"},
    ),
    "MeasuredLoads": (
        bd.MeasuredLoads,
        {"position": [0.0, 0.1, 0.2], "value": [0.0, 1.0, 0.0], "names": ["moment"], "speed": 5.0}
        | {"uncertainty": 0.1, "rounding": 0.05, "source": "a.csv"},
    ),
    "MeasuredResponse": (
        bd.MeasuredResponse,
        {"frequency": [1.0, 2.0, 3.0], "magnitude": [0.0, 1.0, 0.0], "phase": [0.0, 1.0, 0.0]}
        | {"output": "tip", "input": "bending", "speed": 5.0, "uncertainty": 0.1, "rounding": 0.05}
        | {"source": "a.csv"},
    ),
    "compare": (bd.compare, {"scene": SCENE, "data": bd.MeasuredFrequencies([65.0])}),
    "identify": (
        bd.identify,
        {"scene": SCENE, "data": bd.MeasuredFrequencies([65.0]), "free": {"beam.thickness": None}}
        | {"starts": 1, "seed": 0},
    ),
    "design": (
        bd.design,
        {"scene": SCENE, "free": {"beam.thickness": (1e-4, 4e-4)}, "seed": 0, "tolerance": 1e-3}
        | {"targets": [bd.Target("frequencies", equals=80.0)], "discretization": "ritz"},
    ),
    "Target": (
        bd.Target,
        {"what": "frequencies", "equals": 80.0, "at_least": None, "at_most": None, "best": None}
        | {"speed": 5.0, "mode": 1, "line": "", "window": None},
    ),
    "read_measurements": (
        bd.read_measurements,
        {"path": "examples/strip_shells.csv", "speeds": None, "columns": None},
    ),
    "critical_speed_sensitivities": (
        bd.critical_speed_sensitivities,
        {"scene": SCENE, "inputs": ["beam.length"], "discretization": "ritz", "tolerance": 0.1},
    ),
    "crossing_sensitivities": (
        bd.crossing_sensitivities,
        {"scene": MOVING, "top_speed": 60.0, "modes": 2, "inputs": ["beam.length"], "order": 1}
        | {"discretization": "ritz", "tolerance": 1e-3},
    ),
    "terms": (bd.terms, {"scene": MOVING}),
    "tradeoff": (
        bd.tradeoff,
        {"scene": SCENE, "speed": 5.0, "modes": 2, "t_end": None, "budget": 1.0, "progress": None},
    ),
    "load_scene": (bd.load_scene, {"path": "examples/blade.toml"}),
    "read_deck": (bd.read_deck, {"path": "examples/blade_stations.csv", "length": 40.0, "hub_radius": 1.25}),
}
SWITCHES = ("shear", "rotary_inertia", "camber", "torsion", "stretch", "large_deflection")
CURVES = "MeasuredHistory", "MeasuredPeaks", "MeasuredLoads", "MeasuredResponse"
# What of the wrong values is right after all.
ALLOWED = {
    **{f"Physics.{name}": {"truth", "numpy's truth"} for name in SWITCHES},
    "Scene.label": {"text"},
    "Scene.units": {"dictionary"},
    "sweep.store": {"text"},
    "study.store": {"text"},
    "stability_chart.store": {"text"},
    "stability_limits.store": {"text"},
    "spread.store": {"text"},
    "Uniform.text": {"text"},
    "Normal.text": {"text"},
    "campbell.bounds": {"truth", "numpy's truth"},
    "TipLoad.follows": {"truth", "numpy's truth"},
    "sweep.progress": {"class"},
    "tradeoff.progress": {"class"},
    "study.progress": {"class"},
    "spread.progress": {"class"},
    "load_scene.path": {"text"},
    "read_deck.path": {"text"},
    "read_measurements.path": {"text"},
    "read_measurements.columns": {"dictionary"},
    "MeasuredFrequencies.source": {"text"},
    **{f"{name}.source": {"text"} for name in CURVES},
    **{f"{name}.uncertainty": {"nan"} for name in CURVES},
    **{f"MeasuredResponse.{name}": {"text"} for name in ("output", "input")},
    "MeasuredFrequencies.labels": {"empty", "empty array"},
    "MeasuredFrequencies.uncertainty": {"nan"},
    "MeasuredFrequencies.speed_unit": {"text"},
    **{f"{name}.breakpoints": {"empty", "empty array"} for name in CALLS},
    **{f"{name}.point_masses": {"empty", "empty array"} for name in CALLS},
    **{f"{name}.point_springs": {"empty", "empty array"} for name in CALLS},
    "Damping.ratios": {"empty", "empty array"},
    **{f"SampledTranslation.along_n{axis}": {"empty", "empty array"} for axis in (2, 3)},
}


@pytest.mark.parametrize(
    ("call", "name"), [(call, name) for call, (_, good) in CALLS.items() for name in good]
)
def test_a_wrong_kind_is_refused_by_name(call, name):
    make, good = CALLS[call]
    assert refusals_missing(make, good, name, ALLOWED.get(f"{call}.{name}", ())) == {}


def test_the_table_holds_every_public_name_and_argument():
    made_by_the_package = {
        name
        for name in bd.__all__
        if isinstance(item := getattr(bd, name), type) and issubclass(item, Result | Exception)
    }
    covered = {call.partition(".")[0] for call in CALLS}
    rest = set(bd.__all__) - made_by_the_package - covered
    made_elsewhere = {"Crossing", "GaussCollocation", "Line", "MotionSample", "Polynomial", "Profile"}
    made_elsewhere |= {"OmittedEffect"}  # in the terms of a scene
    made_elsewhere |= {"EquilibriumBranch", "JudgedEffect", "PhysicsChoice"}  # parts of results
    made_elsewhere |= {"LineCrossing", "Margin"}  # parts of a diagram
    made_elsewhere |= {"LargestLoad", "RoadHarvest"}  # parts of loads, of a harvest
    made_elsewhere |= {"SceneNumber", "VariedInput"}  # parts of studies
    made_elsewhere |= {"OneNumberFit", "NotSeparable"}  # parts of comparisons and identifications
    made_elsewhere |= {
        "FirstOrderRange",
        "Scatter",
        "SobolIndices",
        "SpreadInput",
        "WorstCases",
    }  # of spreads
    made_elsewhere |= {"IgnoredProperty", "ModePolynomial", "PropertyStep", "ShapeCheck"}  # parts of decks
    made_elsewhere |= {"ParametricTerm", "RandomStatistics"}  # parts of random responses and loads
    made_elsewhere |= {"load"}  # reads files: tests/unit/test_load.py
    assert rest == made_elsewhere | {"Discretization", "Motion", "Rotation"}  # the last are base classes
    for make, good in CALLS.values():
        set_by_analyses = {"physics_choice"}
        assert {*inspect.signature(make).parameters} - {"options"} - set_by_analyses == {*good}


# What is right ----------------------------------------------------------------------------------------


@pytest.mark.parametrize("number", [Decimal("0.2"), Fraction(1, 5), np.float64(0.2), np.array(0.2)])
def test_whatever_converts_itself_is_a_number(number):
    mount, tip = bd.Mount(number), bd.TipMass(number)
    assert (type(mount.radius), mount.radius, type(tip.mass)) == (float, 0.2, float)
    assert planar.Pin("p", "arm", "ground", (0.0, 0.0), radius=number).radius == 0.2
    beam = bd.Beam.rectangular(number, 0.01, 0.0002, 200e9, 7850.0)
    assert np.isfinite(bd.natural_modes(bd.Scene(beam, mount), Decimal(5), np.int64(2)).frequency).all()


def test_one_speed_may_be_given_where_many_are():
    assert bd.frequency_locus(SCENE, speeds=50.0).frequency.shape == (1, 3)
    assert bd.steady_response(MOVING, speeds=50).speeds.tolist() == [50.0]
    assert bd.sweep(MOVING, speeds=np.float32(5), window=(0.0, 0.02), modes=2).speeds.tolist() == [5.0]


@pytest.mark.parametrize("speed", [1e300, -1e300])
def test_a_speed_whose_powers_overflow_is_refused_by_name(speed):
    for call, name in [("natural_modes", "speed"), ("frequency_locus", "speeds"), ("tradeoff", "speed")]:
        make, good = CALLS[call]
        with pytest.raises(ValueError, match=f"^{name} = .*give at most 1e\\+50 rad/s"):
            make(**(good | {name: speed}))


@pytest.mark.parametrize(
    ("call", "name", "value", "sentence"),
    [
        ("natural_modes", "modes", 10**9, "modes = 1000000000: Rayleigh-Ritz with 200 Legendre functions"),
        ("resonance_speeds", "order", 1e300, "order = 1e+300: give a whole number from 1 to 20"),
        ("steady_response", "harmonics", 10**6, "harmonics = 1000000: give a whole number from 0 to 20"),
        ("natural_modes", "scene", BEAM, "give a Scene; Scene(beam, mount) makes one of a beam"),
        ("simulate", "modes", "all", "modes = 'all': give a whole number of 1 or more; or \"auto\""),
    ],
)  # fmt: skip
def test_sentence(call, name, value, sentence):
    make, good = CALLS[call]
    with pytest.raises(ValueError) as refusal:
        make(**(good | {name: value}))
    assert sentence in str(refusal.value)


def test_a_road_of_too_short_waves_is_refused():
    with pytest.raises(ValueError, match=r"wavelength = 1e-30 m: .*1e12 waves a turn"):
        bd.RollingWheel(0.3, 5.0, bd.RoadWave(1e-30, 0.01))
    with pytest.raises(ValueError, match="1e12 waves a turn"):
        bd.RollingWheel(1e20, 5.0, bd.RoadWave(1e-20, 0.01))


@pytest.mark.parametrize("size", [5e-324, 1e-300, 1e-60, 1e60, 1e300, 1.7e308])
def test_a_size_beyond_all_use_is_refused_before_it_overflows(size):
    for call in ("Beam.rectangular", "Beam.from_stiffness"):
        make, good = CALLS[call]
        for name in (
            set(good)
            - {"tip", "point_masses", "breakpoints", "twist", "sweep", "prebend"}
            - {"poissons_ratio"}
        ):
            varying = (bd.Table([0, 1], [size, size]), lambda xi, size=size: size * (1 + xi))
            for value in (size, *varying) if name not in ("length", "youngs_modulus", "density") else (size,):
                with pytest.raises(ValueError, match=name):
                    make(**(good | {name: value}))
    for call, name in [
        ("SpinUp", "duration"),
        ("RollingWheel", "rolling_radius"),
        ("RoadWave", "wavelength"),
    ]:
        make, good = CALLS[call]
        with pytest.raises(ValueError, match=name):
            make(**(good | {name: size}))


# Doubtful units ---------------------------------------------------------------------------------------

STRIP = {"length": 0.05, "width": 0.01, "thickness": 0.0002, "youngs_modulus": 200e9, "density": 7850.0}
SECTION = {"length": 0.05, "mass_per_length": 0.0157, "bending_stiffness": 1.3e-3}
SECTION |= {"axial_stiffness": 4e5, "outer_fibre": 1e-4}


@pytest.mark.parametrize(
    ("make", "sentence"),
    [
        (lambda: bd.Mount(0.2, 5), r"setting_angle = 5 rad.*286.5 degrees.*math.radians\(5\)"),
        (lambda: bd.Mount(0.2, 0.0, -4.5), "bending_angle = -4.5 rad"),
        (lambda: bd.Beam.rectangular(**(STRIP | {"youngs_modulus": 200})), "= 200 Pa.*0.16 m/s"),
        (lambda: bd.Beam.rectangular(**(STRIP | {"density": 7.85e-9})), "density = 7.85e-09 kg/m3"),
        (
            lambda: bd.Beam.from_stiffness(**(SECTION | {"bending_stiffness": 1.3e3})),
            "bending_stiffness = 1300 N m2.*0.057 m, more than outer_fibre = 0.0001 m",
        ),
        (
            lambda: bd.Beam.from_stiffness(**(SECTION | {"bending_stiffness": 1.3e3, "outer_fibre": None})),
            r"0.057 m, more than length / sqrt\(12\) = 0.0144 m",
        ),
        (
            lambda: bd.Beam.from_stiffness(**(SECTION | {"mass_per_length": 1.57e-8})),
            "mass_per_length = 1.57e-08 kg/m.*5.05e\\+06 m/s",
        ),
        (lambda: bd.Beam.from_stiffness(0.05, 1.57e-9, 1.3e-3), "stiffness = 0.0013 N m2 with length"),
    ],
)  # fmt: skip
def test_doubtful_units_are_warned_of_where_they_are_given(make, sentence):
    with pytest.warns(UserWarning, match=sentence) as caught:
        make()
    assert [warning.filename for warning in caught] == [__file__]


def test_usual_units_are_not_warned_of():
    for angle in (math.pi, 1.5 * math.pi, math.radians(270), -math.radians(359), 3.0, 2 * math.pi):
        bd.Mount(0.2, angle)
    for modulus, density in ((16e9, 11340.0), (10e6, 950.0), (303e9, 1844.0), (1220e9, 3510.0)):
        bd.Beam.rectangular(**(STRIP | {"youngs_modulus": modulus, "density": density}))  # lead to diamond
    bd.Beam.from_stiffness(1.0, 1.0, 1.0, 4900.0)  # without dimension
    bd.Beam.from_stiffness(1.0, 1.0, 1.0)
