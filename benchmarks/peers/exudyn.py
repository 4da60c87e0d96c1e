"""Exudyn: the transient of Table 3 (Lee and Yoo 2019) with plane ANCF cable elements.

The carrier's centre is fixed; its acceleration acts as a load on the mass, which is equivalent and keeps
coordinates small.  Prescribed motion is given by Exudyn's symbolic functions, which run in C++, twice as fast
as Python functions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from time import perf_counter
from typing import Any

import numpy as np

from benchmarks.peers import measure
from benchmarks.peers.measure import Point, given, peak
from benchmarks.peers.ours import largest_deflection

NAME = "Exudyn"
BETTER = "large deflections, motion past buckling, many bodies with joints and contact, any control"
SPEED, DURATION = 55.0, 10.0  # speed [rad/s] and duration [s] of the spin-up
RUNS = 2


@dataclass(frozen=True)
class Setting:
    """Number of cable elements, time step [s], and axial stiffness over that of the beam.

    With a reduced axial stiffness, Newton's iterations converge in one step, at strains of about 1e-3.
    """

    cables: int
    step: float
    softening: float = 1.0

    def __str__(self) -> str:
        soft = "" if self.softening == 1 else f", axial stiffness x {self.softening:g}"
        return f"{self.cables} cables, step {1e3 * self.step:g} ms{soft}"


SETTINGS = (
    Setting(8, 5e-4),
    Setting(8, 5e-4, 1e-3),
    Setting(2, 5e-4, 1e-3),
    Setting(4, 2.5e-4, 1e-3),
    Setting(4, 1e-4, 1e-3),
    Setting(8, 1e-4),
)
TARGET = (str(SETTINGS[0]), 150.0)


def version() -> str | None:
    return measure.installed("exudyn")


def points() -> Iterator[Point]:
    """Yield times of the solver alone, without building the model and reading the deflection."""
    for setting in SETTINGS:
        runs = [run(setting) for _ in range(RUNS)]
        error = abs(peak(*runs[-1][1:]) / largest_deflection() - 1)
        yield Point(measure.ROLLING, NAME, str(setting), min(time for time, *_ in runs), error)


def run(setting: Setting) -> tuple[float, np.ndarray, np.ndarray]:
    """Run a setting; return the computing time [s], and the tip deflection [m] over time [s]."""
    import exudyn

    exudyn.config.printToConsole = False
    system, sensor, _alive = model(setting)
    system.Assemble()
    settings = solver(exudyn, setting)
    start = perf_counter()
    system.SolveDynamic(settings, showHints=False)
    time = perf_counter() - start
    t, x, y, _ = np.array(system.GetSensorStoredData(sensor)).T
    return time, t, deflection(t, x, y)


def solver(exudyn: Any, setting: Setting) -> Any:
    """Return solver settings: generalised-alpha method with default damping, unstable here without it."""
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = setting.step
    settings.linearSolver.solverType = exudyn.LinearSolverType.EXUdense
    integration = settings.timeIntegration
    integration.endTime = measure.T_END
    integration.numberOfSteps = round(measure.T_END / setting.step)
    integration.newton.absoluteTolerance = 1e-7  # force [N] below 1e-4 of the loads; rounding ends at 5e-9
    integration.newton.relativeTolerance = 1e-6
    # The modified Newton method fails at the full axial stiffness.
    integration.newton.useModifiedNewton = setting.softening < 1
    return settings


# Motion: angle, speed and acceleration of the carrier, with the functions of numpy or of exudyn.symbolic ----


def angle(m: Any, t: Any) -> Any:
    return spin_up_angle(m, t, SPEED, DURATION)


def spin_up_angle(m: Any, t: Any, speed: float, duration: float) -> Any:
    """Compute the angle after a smooth spin-up of a duration [s] to a speed [rad/s]."""
    x = t / duration
    spin_up = speed * duration * (x * x / 2 + (m.cos(2 * math.pi * x) - 1) / (4 * math.pi**2))
    return m.IfThenElse(t < duration, spin_up, speed * duration / 2 + speed * (t - duration))


def speed(m: Any, t: Any) -> Any:
    x = t / DURATION
    spin_up = SPEED * (x - m.sin(2 * math.pi * x) / (2 * math.pi))
    return m.IfThenElse(t < DURATION, spin_up, SPEED + 0 * t)


def acceleration(m: Any, t: Any) -> Any:
    spin_up = SPEED / DURATION * (1 - m.cos(2 * math.pi * t / DURATION))
    return m.IfThenElse(t < DURATION, spin_up, 0 * t)


def root(m: Any, t: Any) -> list[Any]:
    """Compute displacements x, y [m] of the root and changes of its slope, for rotation about -z."""
    r, c, s = given()["radius"], m.cos(angle(m, t)), m.sin(angle(m, t))
    return [r * (1 - c), r * s, c - 1, -1 * s]


def load(m: Any, t: Any) -> list[Any]:
    """Compute minus the acceleration of the centre [m/s2]: it rolls along x, follows the road along y."""
    data = given()
    k = 2 * math.pi * data["rolling_radius"] / data["road_wavelength"]
    road = data["road_velocity_amplitude"] * k * speed(m, t) * m.cos(k * angle(m, t))
    return [-1 * data["rolling_radius"] * acceleration(m, t), -1 * road, 0 * t]


def deflection(t: np.ndarray, x: np.ndarray, y: np.ndarray) -> np.ndarray:
    """Compute the tip deflection across the beam's axis [m] from the position of the tip."""
    turned = angle(Numpy, t)
    return x * np.sin(turned) + y * np.cos(turned)


class Numpy:
    """The functions of the motion for arrays."""

    sin, cos, IfThenElse = np.sin, np.cos, np.where


# Model --------------------------------------------------------------------------------------------


def model(setting: Setting) -> tuple[Any, int, list[Any]]:
    """Build the system; return it, the tip's sensor, and objects that must be kept while it is used."""
    import exudyn
    from exudyn.beams import GenerateBeamElementsAlongLine

    container = exudyn.SystemContainer()
    system = container.AddSystem()
    start = -given()["radius"]
    end = start + given()["length"]
    parts = GenerateBeamElementsAlongLine(
        system, [start, 0, 0], [end, 0, 0], setting.cables, cable(setting.softening)
    )
    alive = [container, *clamp(system, parts["nodes"][0], root), *loads(system, parts["elements"])]
    return system, sense_position(system, parts["nodes"][-1]), alive


def sense_position(system: Any, node: int) -> int:
    """Add a sensor for the position of a node; return the sensor's number."""
    import exudyn
    from exudyn.itemInterface import SensorNode

    position = exudyn.OutputVariableType.Position
    return system.AddSensor(
        SensorNode(nodeNumber=node, storeInternal=True, writeToFile=False, outputVariableType=position)
    )


def cable(softening: float) -> Any:
    from exudyn.itemInterface import Cable2D

    data = given()
    area = data["width"] * data["thickness"]
    return Cable2D(
        physicsMassPerLength=data["density"] * area,
        physicsBendingStiffness=data["youngs_modulus"] * area * data["thickness"] ** 2 / 12,
        physicsAxialStiffness=data["youngs_modulus"] * area * softening,
    )


def clamp(system: Any, node: int, root: Callable[..., list[Any]]) -> Iterator[Any]:
    """Prescribe the four coordinates of the root by the function `root`."""
    from exudyn.itemInterface import CoordinateConstraint, MarkerNodeCoordinate, NodePointGround

    ground = system.AddNode(NodePointGround())
    fixed = system.AddMarker(MarkerNodeCoordinate(nodeNumber=ground, coordinate=0))
    for k in range(4):
        moved = system.AddMarker(MarkerNodeCoordinate(nodeNumber=node, coordinate=k))
        constraint = system.AddObject(CoordinateConstraint(markerNumbers=[fixed, moved]))
        name = name_user_function("offset")
        function = symbolic(system, offset(k, root), name, itemIndex=constraint)
        system.SetObjectParameter(constraint, name, function)
        yield function


def offset(k: int, root: Callable[..., list[Any]]) -> Callable[..., Any]:
    """Return the motion of one coordinate of the root, in the form of Exudyn's user functions."""
    import exudyn

    def function(mbs, t, itemNumber, lOffset):
        return root(exudyn.symbolic, t)[k]

    return function


def loads(system: Any, elements: list[int]) -> Iterator[Any]:
    """Load every cable element by the inertia force: minus the centre's acceleration."""
    import exudyn
    from exudyn.itemInterface import LoadMassProportional, MarkerBodyMass

    def function(mbs, t, loadVector):
        return load(exudyn.symbolic, t)

    for item in elements:
        marker = system.AddMarker(MarkerBodyMass(bodyNumber=item))
        number = system.AddLoad(LoadMassProportional(markerNumber=marker, loadVector=[0, 0, 0]))
        name = name_user_function("loadVector")
        written = symbolic(system, function, name, itemTypeName="LoadMassProportional")
        system.SetLoadParameter(number, name, written)
        yield written


def name_user_function(quantity: str) -> str:
    """Return the name of Exudyn's parameter for a quantity given as a function of time."""
    return f"{quantity}UserFunction"


def symbolic(system: Any, function: Callable[..., Any], name: str, **item: Any) -> Any:
    from exudyn.advancedUtilities import CreateSymbolicUserFunction

    return CreateSymbolicUserFunction(system, function, name, **item)
