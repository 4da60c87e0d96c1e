"""A small result of every class of both packages, for tests that walk over all of them."""

from __future__ import annotations

import importlib
import pkgutil
import tomllib
from collections.abc import Callable
from dataclasses import fields, replace
from functools import cache
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

import beamdyn as bd
import brakes
from beamdyn.common.edge.input_sweep import InputSweep
from beamdyn.common.results.result import Result
from benchmarks.cases.scenes import AFTER_SHORT_SPIN_UP, HARVESTER, SHORT_SPIN_UP
from brakes import chain, drum, forklift, machines, vehicle
from brakes.answers.caliper import CALIPER, MECHANISM
from brakes.answers.drum import BRAKE as DRUM
from brakes.answers.forklift import FORKLIFT
from brakes.answers.machine import MACHINES
from brakes.answers.vehicle import BRAKE as VEHICLE
from brakes.app.bases import base
from brakes.calipers import NAMED, stop
from brakes.reproduce.forklift_as_printed import newton_raphson, stop_as_printed
from tests.unit.decks_written import LENGTH, elastodyn_blade

BENT = bd.Scene(
    bd.Beam.rectangular(0.6, 0.06, 0.012, 210e9, 7850.0),
    bd.Mount(0.2, setting_angle=np.pi / 2),
    physics=bd.Physics(large_deflection=True),
)
DAMPED = replace(HARVESTER, damping_ratio=0.01)
PULSATING = bd.Scene(HARVESTER.beam, HARVESTER.mount, bd.PulsatingRotation(50.0, 0.1, 123.9))
LAYERED = bd.load_scene(Path(__file__).parents[2] / "examples" / "bimorph.toml")
BENDIX = forklift.BENDIX_12_5
ROUGH = bd.PowerSpectrum([5.0, 60.0, 200.0], [1.0, 3.0, 0.2])
SPEEDS = np.linspace(0.0, 100.0, 41)
SHOE = drum.Shoe(0.138, 0.05, lining=(0.5, 1.9), pivot=(0.02, -0.11), force_arm=0.115)
TRUCK = forklift.Truck(5950.0, (1.049, 0.359), 3500.0, (-1.2, 0.45), front_wheel_radius=0.4, wheelbase=1.89)
STOP = forklift.StopConditions(0.1, 20 / 3.6, 0.7, reaction_time=0.5, rise_time=0.3)
LINE, PEDAL = chain.HydraulicLine(0.02222, 0.03175), chain.Pedal(5.0, 450.0, booster=3.0)
BICYCLE, ROAD = vehicle.Vehicle(80.0, 0.62, 1.1, 1.02), vehicle.Road(0.1, 0.8)


def _from_pedal() -> Any:
    text = base("forklift").replace('piston_force = "11650 N"', "lining_friction = 0.39")
    text += '[pedal]\nratio = 5\nforce = "450 N"\nbooster = 3\n[line]\nmaster_bore = "22.22 mm"\n'
    tables = tomllib.loads(text + 'cylinder_bore = "31.75 mm"')
    return FORKLIFT.answer(tables, "forklift").pedal


def _deck() -> bd.Deck:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "blade.dat"
        path.write_text(elastodyn_blade())
        return bd.read_deck(path, length=LENGTH, hub_radius=1.25)


def _caliper() -> Any:
    return NAMED["dual-pivot"]().build()


def _answer(brake: Any) -> Any:
    return brake.answer(tomllib.loads(base(brake.name)), brake.name)


def _friction() -> Any:
    tables = (Path(__file__).parents[2] / "examples" / "block_brake.toml").read_text()
    return MECHANISM.answer(tomllib.loads(tables), "block_brake").friction


def _sweep_of_a_brake() -> Any:
    return DRUM.sweep(tomllib.loads(base("drum")), "drum", [DRUM.example_sweep])[0]


def _transient() -> bd.Transient:
    return bd.simulate(SHORT_SPIN_UP, 0.3, 2)


BASES = {
    "SceneResult",
    "Answer",
    "PlanarAnswer",
    "RubbingAnswer",
    "OfChosenPhysics",
    "StatesModelError",
    "JudgedByRepeating",
    "TellsKinds",
    "SpanLoads",
    "SlidesOrLocks",
    "RubbingResult",
}
MAKERS: dict[str, Callable[[], Result]] = {
    "Actuation": lambda: chain.actuate(PEDAL, LINE),
    "Backbone": lambda: bd.backbone(BENT, 5.0),
    "BestResistance": lambda: bd.best_resistance(LAYERED, 50.0, 1),
    "BrakeResult": lambda: drum.brake_torque(drum.simplex(SHOE), friction=0.4, force=1e3),
    "BrakedStop": lambda: chain.brake_from_pedal(TRUCK, STOP, PEDAL, LINE, 0.7),
    "Braking": lambda: vehicle.braking_limits(BICYCLE, 0.8, 0.7),
    "BrakeSweep": _sweep_of_a_brake,
    "CaliperAnswer": lambda: _answer(CALIPER),
    "CaliperStroke": lambda: _caliper().stroke(finger=40.0),
    "Campbell": lambda: bd.campbell(HARVESTER, SPEEDS, 2, rated=50.0, bounds=True),
    "CriticalPoint": lambda: bd.critical_point(HARVESTER),
    "Crossings": lambda: bd.resonance_speeds(SHORT_SPIN_UP, 100.0),
    "Deck": _deck,
    "DeckAudit": lambda: _deck().audit,
    "Diagram": lambda: made("Tradeoff").diagrams[0],
    "DrumAnswer": lambda: _answer(DRUM),
    "Equilibrium": lambda: bd.equilibrium(BENT, 5.0),
    "EquilibriumBranches": lambda: bd.equilibrium_branches(BENT, 5.0),
    "Fade": lambda: drum.repeat_stops(drum.Duty(20.0, 50.0, 5.0, stops=2), 0.4, lambda mu: 1000.0 * mu),
    "ForkliftAnswer": lambda: _answer(FORKLIFT),
    "FrequencyComparison": lambda: bd.compare(
        HARVESTER, bd.MeasuredFrequencies([62.1, 389.0], uncertainty=0.5)
    ),
    "CurveComparison": lambda: bd.compare(
        HARVESTER, bd.MeasuredLoads([0.0, 0.025], [-0.37, -0.17], ["axial"], 50.0, rounding=0.005)
    ),
    "Identification": lambda: bd.identify(
        HARVESTER,
        bd.MeasuredFrequencies([62.1, 389.0], uncertainty=0.5),
        {"beam.thickness": None},
    ),
    "FloquetMultipliers": lambda: bd.floquet_multipliers(PULSATING, 2),
    "FoundDesign": lambda: bd.design(
        HARVESTER,
        {"beam.thickness": (1e-4, 4e-4), "mount.radius": (0.1, 0.3)},
        [bd.Target("frequencies", equals=80.0, speed=50.0), bd.Target("critical_speed", at_least=90.0)],
    ),
    "FrequencyBounds": lambda: bd.frequency_bounds(HARVESTER, 50.0),
    "FrequencyResponse": lambda: bd.frequency_response(HARVESTER, 50.0, np.linspace(1.0, 100.0, 60)),
    "FromPedal": _from_pedal,
    "Harvest": lambda: bd.harvest(LAYERED, [20.0, 50.0], 2, road=bd.RoadRoughness("A")),
    "Heat": lambda: chain.heat_of_stop(vehicle.stop(TRUCK, STOP), chain.Drums(18.0, 0.05), 1e5, 0.15),
    "Holding": lambda: vehicle.hold(BICYCLE, ROAD),
    "InputSweep": lambda: InputSweep(("a.x",), ("mm",), (np.arange(3.0),), ("y",), ("N",), (np.ones(3),)),
    "InternalForces": lambda: forklift.internal_forces(BENDIX, piston_force=3e4, torque=9e3, clearance=5e-4),
    "Kinematics": lambda: forklift.follow_shoes(BENDIX, 5e-4),
    "LoadCycles": lambda: cycles_of(made("TransientLoads")),
    "Locus": lambda: bd.frequency_locus(HARVESTER, SPEEDS),
    "MachineAnswer": lambda: _answer(MACHINES["band"]),
    "MachineResult": lambda: machines.solve_brake(
        machines.Band(0.2, 0.05, 3.9, 0.5, 0.1), friction=0.2, force=1e2
    ),
    "Matrices": lambda: bd.matrices(HARVESTER, 50.0, 2),
    "MechanismAnswer": lambda: _answer(MECHANISM),
    "MechanismFriction": _friction,
    "Modes": lambda: bd.natural_modes(HARVESTER, 50.0),
    "Needed": lambda: vehicle.friction_to_hold(BICYCLE, 0.1, "both", "front"),
    "NewtonResult": lambda: newton_raphson(BENDIX.find_levers(5e-4), torque=9e3, piston_force=3e4),
    "PadWear": lambda: _caliper().wear([0.0, 1e-3]),
    "PivotFriction": lambda: _caliper().friction(0.1, 0.004, 40.0),
    "PrintedStop": lambda: stop_as_printed(TRUCK, STOP),
    "Procedure": lambda: forklift.brake_procedure(TRUCK, STOP, made("ShoeMotion"), piston_force=3e4),
    "RandomLoads": lambda: bd.random_loads(DAMPED, 50.0, ROUGH, "bending", at=[0.0, 0.025]),
    "RandomResponse": lambda: bd.random_response(DAMPED, 50.0, 1e-3, frequencies=np.linspace(1.0, 100.0, 60)),
    "RotorDrawing": lambda: bd.draw(HARVESTER),
    "Sensitivities": lambda: bd.frequency_sensitivities(HARVESTER, 50.0),
    "SettingAngleLimits": lambda: bd.setting_angle_limits(HARVESTER, 400.0),
    "ShoeMotion": lambda: BENDIX.move_shoes(5e-4),
    "ShoeResult": lambda: made("BrakeResult").shoes[0],
    "Slowing": lambda: vehicle.slow_down(BICYCLE, ROAD, vehicle.Approach(8.0), 200.0, 0.5),
    "SceneSpread": lambda: bd.spread(HARVESTER, {"beam.thickness": "+-2%"}, samples=128, modes=1, speed=50.0),
    "Spread": lambda: bd.Spread(*(getattr(made("SceneSpread"), each.name) for each in fields(bd.Spread))),
    "StaticLoads": lambda: bd.static_loads(HARVESTER, [0.0, 50.0]),
    "SteadyLoads": lambda: bd.steady_loads(made("SteadyResponse"), at=[0.0, 0.025]),
    "SteadyResponse": lambda: bd.steady_response(SHORT_SPIN_UP, np.linspace(45.0, 50.0, 5), 2),
    "Solutions": lambda: brakes.find(lambda x: x * (4 - x), 3.0, np.linspace(0.5, 5.0, 10)),
    "WholeSolutions": lambda: brakes.find_whole(lambda n: 2.0 * n, 7.0, range(1, 6)),
    "Stop": lambda: forklift.stop(TRUCK, STOP),
    "StoppingDistance": lambda: stop(mass=80.0, speed=5.0, pad_force=1e3, friction=0.4),
    "Study": lambda: bd.study(HARVESTER, {"beam.thickness": [1e-4, 2e-4]}, speed=20.0),
    "StabilityChart": lambda: bd.stability_chart(
        PULSATING, {"motion.frequency": [110.0, 123.9], "motion.fluctuation": [0.01, 0.1]}, 1
    ),
    "StabilityLimits": lambda: bd.stability_limits(
        PULSATING,
        {"motion.frequency": [121.0, 123.9], "motion.fluctuation": [0.08, 0.1]},
        1,
    ),
    "Sweep": lambda: bd.sweep(SHORT_SPIN_UP, [50.0, 53.0], AFTER_SHORT_SPIN_UP, modes=2),
    "Terms": lambda: bd.terms(SHORT_SPIN_UP),
    "Tradeoff": lambda: bd.tradeoff(HARVESTER, 50.0, 1, budget=0.05),
    "Transient": _transient,
    "TransientHarvest": lambda: bd.transient_harvest(bd.simulate(LAYERED, 0.1, 2)),
    "TransientLoads": lambda: bd.transient_loads(_transient(), at=[0.0, 0.025]),
    "VehicleAnswer": lambda: _answer(VEHICLE),
}
EXAMPLES_OF_INPUTS = (
    HARVESTER,
    SHORT_SPIN_UP,
    replace(HARVESTER, label="0.2 mm", physics=bd.Physics(planes=2), damping_ratio=0.01, gravity=9.81),
    HARVESTER.beam,
    HARVESTER.mount,
    bd.Mount(0.1, np.pi, 0.3, precone=0.05, root_stiffness=3.0),
    SHORT_SPIN_UP.motion,
    bd.SteadyRotation(50.0),
    LAYERED,
    bd.RotationFunction(np.sin, np.cos, lambda t: -np.sin(t), 1.0),
)


def cycles_of(loads: bd.TransientLoads) -> bd.LoadCycles:
    """Return cycles like those of `count_cycles`, which needs the package that counts."""
    ranges, means, counts = np.array([1e-4, 3e-4]), np.zeros(2), np.array([1.0, 0.5])
    what = ("strain", 0, 0.0, ranges, means, counts, 0.0, 1.0)
    return bd.LoadCycles(*what, warnings=(), provenance=loads.provenance, scene=loads.scene)


@cache
def made(name: str) -> Any:
    """Return the result of a class, computed once."""
    return MAKERS[name]()


def result_classes() -> dict[str, type[Result]]:
    """Return the classes of results of all modules of both packages, without base classes.

    Modules of screens define none, and may lack the toolkit that they import.
    """
    for package in (bd, brakes):
        for module in pkgutil.walk_packages(package.__path__, f"{package.__name__}."):
            if not {"__main__", "app", "screens"} & {*module.name.split(".")}:
                importlib.import_module(module.name)
    return {kind.__name__: kind for kind in _derived(Result) if kind.__name__ not in BASES}


def _derived(kind: type) -> set[type]:
    own = {each for each in kind.__subclasses__() if each.__module__.startswith(("beamdyn.", "brakes."))}
    return own.union(*map(_derived, own))
