"""The spin-up of an outward beam (Kane; Simo and Vu-Quoc): Exudyn's cables against the elastica.

In the literature the spin-up takes 15 s; in a third of this time the beam bends by 18 % of its length, beyond
linear theory.  The cable elements lie along x at the start and rotate about -z; the root's position is fixed,
its slope prescribed.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import Any

import numpy as np

import beamdyn as bd
from beamdyn.published import load
from benchmarks.cases.scenes import BLADE_SPIN_UP
from benchmarks.peers import exudyn, measure
from benchmarks.peers.exudyn import Numpy, clamp

DURATIONS = (15.0, 5.0)  # durations of the spin-up [s]
T_END, SAMPLES = 20.0, 2001
TOLERANCE = 1e-5


@dataclass(frozen=True)
class Setting:
    """Number of cable elements, time step [s], and axial stiffness over that of the published beam.

    The published beam stretches, which the elastica leaves out: stretch delays the free vibration after the
    fast spin-up.  A stiffer axis takes more cables, as it locks the bending of a few.
    """

    cables: int
    step: float
    stiffening: float = 1.0

    def __str__(self) -> str:
        stiff = "" if self.stiffening == 1 else f", axial stiffness x {self.stiffening:g}"
        return f"{self.cables} cables, step {1e3 * self.step:g} ms{stiff}"


SETTINGS = (
    *(Setting(8, 1e-3), Setting(16, 1e-3), Setting(32, 1e-3)),
    Setting(16, 5e-4),
    Setting(12, 1e-3, 4.0),
)


@dataclass(frozen=True)
class Run:
    """Deflection of the tip across the rotating axis [m] at `times`, and the computing time [s]."""

    tip: np.ndarray
    time: float

    @property
    def largest(self) -> float:
        """Largest deflection [m]."""
        return float(np.abs(self.tip).max())

    def differs_from(self, other: Run) -> float:
        """Return the largest difference at any time, over the other run's largest deflection."""
        return float(np.abs(self.tip - other.tip).max()) / other.largest


def times() -> np.ndarray:
    """Return the times of the samples [s]."""
    return np.linspace(0.0, T_END, SAMPLES)


def given() -> dict[str, float]:
    """Load the published beam and its spin-up, in SI units."""
    entries = load("rotating_beams")["spin_up"]
    return {name: entry["value"] for name, entry in entries.items() if name != "source"}


def elastica(duration: float) -> Run:
    """Simulate a spin-up of a given duration [s] by beamdyn with large deflection."""
    return _simulate(duration, bd.Physics(large_deflection=True))


def linear(duration: float) -> Run:
    """Simulate a spin-up of a given duration [s] by the linear theory of beamdyn."""
    return _simulate(duration, bd.Physics())


def _simulate(duration: float, physics: bd.Physics) -> Run:
    scene = replace(BLADE_SPIN_UP, motion=bd.SpinUp(given()["speed"], duration), physics=physics)
    time, run = measure.shortest(
        lambda: bd.simulate(scene, T_END, tolerance=TOLERANCE, t_eval=times()), runs=1
    )
    return Run(run.tip, time)


# Exudyn -------------------------------------------------------------------------------------------


@lru_cache
def cables(duration: float, setting: Setting) -> Run:
    """Simulate a spin-up of a given duration [s] by Exudyn; the time is that of the solver alone."""
    import exudyn as solver

    solver.config.printToConsole = False
    system, sensor, _alive = model(duration, setting)
    system.Assemble()
    settings = settings_of_solver(solver, setting)
    time, _ = measure.shortest(lambda: system.SolveDynamic(settings, showHints=False), 1)
    t, x, y, _ = np.array(system.GetSensorStoredData(sensor)).T
    return Run(np.interp(times(), t, deflection(t, x, y, duration)), time)


def settings_of_solver(solver: Any, setting: Setting) -> Any:
    """Return settings of the generalised-alpha method with default damping."""
    settings = solver.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = T_END / (SAMPLES - 1)
    settings.linearSolver.solverType = solver.LinearSolverType.EXUdense
    integration = settings.timeIntegration
    integration.endTime = T_END
    integration.numberOfSteps = round(T_END / setting.step)
    # Force [N]; rounding ends near 5e-7 with an axial stiffness of 1e8 N.
    integration.newton.absoluteTolerance = 1e-6
    integration.newton.relativeTolerance = 1e-8
    return settings


def angle(m: Any, t: Any, duration: float) -> Any:
    """Compute the angle of the carrier, with the functions of numpy or of exudyn.symbolic."""
    return exudyn.spin_up_angle(m, t, given()["speed"], duration)


def deflection(t: np.ndarray, x: np.ndarray, y: np.ndarray, duration: float) -> np.ndarray:
    """Compute the tip deflection across the rotated axis [m] from the position of the tip."""
    turned = angle(Numpy, t, duration)
    return x * np.sin(turned) + y * np.cos(turned)


def model(duration: float, setting: Setting) -> tuple[Any, int, list[Any]]:
    """Build the system; return it, the tip's sensor, and objects that must be kept while it is used."""
    import exudyn as solver
    from exudyn.beams import GenerateBeamElementsAlongLine
    from exudyn.itemInterface import Cable2D

    def root(m: Any, t: Any) -> list[Any]:
        turned = angle(m, t, duration)
        return [0 * t, 0 * t, m.cos(turned) - 1, -1 * m.sin(turned)]

    container = solver.SystemContainer()
    system = container.AddSystem()
    data = given()
    cable = Cable2D(
        massPerLength=data["line_density"],
        bendingStiffness=data["bending_stiffness"],
        axialStiffness=data["axial_stiffness"] * setting.stiffening,
    )
    end = [data["length"], 0, 0]
    parts = GenerateBeamElementsAlongLine(system, [0, 0, 0], end, setting.cables, cable)
    alive = [container, *clamp(system, parts["nodes"][0], root)]
    return system, exudyn.sense_position(system, parts["nodes"][-1]), alive
