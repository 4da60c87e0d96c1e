"""Exudyn on the eeBrake caliper: forces of all joints, open and closed, with 1 N on both pads.

Run: python -m benchmarks.peers.eebrake [cable travel in mm].  The cable is modelled as a rigid bar, whose
force is the tension: with a free motion Exudyn's static solver moves to another equilibrium without a
warning.
"""

from __future__ import annotations

import sys
from typing import Any

import numpy as np

from benchmarks.peers.measure import installed
from brakes.calipers import EeBrake
from brakes.planar import Equilibrium, Force, Pin

NAME = "Exudyn"
TRAVELS = (0.0, 3.5e-3)  # travel of the cable [m]: open and closed


def version() -> str | None:
    return installed("exudyn")


def ours(travel: float) -> Equilibrium:
    """Solve the equilibrium with the finger's force that gives each pad 1 N."""
    caliper = EeBrake().build()
    per_newton = caliper.stroke([travel]).advantage[0, 0]
    return caliper.equilibrium(travel, 1.0 / per_newton)


def theirs(answer: Equilibrium) -> tuple[dict[str, np.ndarray], float]:
    """Compute forces of the pins on their first bodies [N], and the tension [N], by Exudyn."""
    import exudyn

    exudyn.config.printToConsole = False
    container = exudyn.SystemContainer()
    system = container.AddSystem()
    joints, cable = model(system, answer)
    system.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.staticSolver.newton.absoluteTolerance = 1e-13
    settings.staticSolver.newton.relativeTolerance = 1e-13
    system.SolveStatic(settings, showHints=False)
    multipliers = np.array(system.systemData.GetAECoordinates())
    forces = {name: multipliers[system.systemData.GetObjectLTGAE(number)] for name, number in joints.items()}
    return forces, float(multipliers[system.systemData.GetObjectLTGAE(cable)][0])


def model(system: Any, answer: Equilibrium) -> tuple[dict[str, int], int]:
    """Build bodies at their points of reference, pins, cable and pads; return numbers of pins and cable."""
    from exudyn.itemInterface import (
        DistanceConstraint,
        LoadForceVector,
        MarkerBodyPosition,
        NodeRigidBody2D,
        ObjectGround,
        RevoluteJoint2D,
        RigidBody2D,
    )

    mechanism, place = answer.position.mechanism, answer.position
    ground = system.AddObject(ObjectGround())
    bodies = {"ground": ground}
    for body in mechanism.bodies:
        node = system.AddNode(NodeRigidBody2D(referenceCoordinates=[0, 0, 0]))
        bodies[body] = system.AddObject(RigidBody2D(mass=1, inertia=1, nodeNumber=node))

    def marker(body: str, at: tuple[float, float]) -> int:
        x, y = place.point(body, at)
        return system.AddMarker(MarkerBodyPosition(bodyNumber=bodies[body], localPosition=[x, y, 0]))

    joints = {}
    for joint in mechanism.joints:
        assert isinstance(joint, Pin)
        ends = [marker(body, joint.at) for body in (joint.body, joint.other)]
        joints[joint.name] = system.AddObject(RevoluteJoint2D(markerNumbers=ends))
    for load in mechanism.loads:
        if isinstance(load, Force):
            vector = [*(answer.amplitudes[load.name] * np.array(load.direction)), 0]
            system.AddLoad(LoadForceVector(markerNumber=marker(load.body, load.at), loadVector=vector))
    wire = next(load for load in mechanism.loads if load.name == "cable")
    ends = [marker(wire.body, wire.at), marker(wire.other, wire.to)]
    span = np.linalg.norm(place.point(wire.body, wire.at) - place.point(wire.other, wire.to))
    return joints, system.AddObject(DistanceConstraint(markerNumbers=ends, distance=span))


def worst(travel: float) -> tuple[float, float]:
    """Compute the largest difference of a pin's force, and that of the tension, per newton on a pad."""
    answer = ours(travel)
    forces, tension = theirs(answer)
    pins = min(  # the sign depends on the body to which the force is assigned: the same for all pins
        max(np.abs(force - sign * answer.reactions[name]).max() for name, force in forces.items())
        for sign in (1, -1)
    )
    return float(pins), abs(abs(tension) - float(answer.amplitudes["cable"]))


def main() -> None:
    if version() is None:
        print(f"{NAME} is not installed: pip install exudyn")
        return
    for travel in [float(x) * 1e-3 for x in sys.argv[1:]] or TRAVELS:
        pins, tension = worst(travel)
        cable = f"{NAME} {version()}, cable {1e3 * travel:g} mm"
        print(f"{cable}: pins differ by {pins:.1e} N, tension by {tension:.1e} N")


if __name__ == "__main__":
    main()
