"""Strips bent and twisted in space by a tip load: Exudyn's beams and CalculiX's solids against ours.

Run: python -m benchmarks.peers.in_space [--solids N].  Random rectangular strips at rest carry a dead force
and a dead moment at the tip, both in random directions; strips that are also solved by solids carry only a
force.  The load grows until the section at the tip has rotated by up to 90 deg.  All models have shear,
stretch and Saint-Venant's torsion; ours also has the shortening by twist.  x runs along the strip, y across
the thickness, z across the width.  Exudyn uses geometrically exact beams of two nodes, whose error falls with
the square of the element length, on two meshes with extrapolation.  CalculiX uses elements C3D20R, with the
force spread evenly over the tip face.
"""

from __future__ import annotations

import argparse
import os
import subprocess
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import date
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from rich.console import Console
from rich.markup import escape
from rich.table import Table

import beamdyn as bd
from beamdyn.modes.modal.equilibrium import DeflectedSolver
from beamdyn.modes.modal.model import Model
from benchmarks.peers import calculix, exudyn, hexahedra, ours, page, tables
from benchmarks.peers.bent import DISPLACEMENTS
from benchmarks.peers.measure import OURS
from benchmarks.rows import markdown_table

Row = tuple[str, ...]

SEED, CASES, SOLIDS = 33, 20, 5
MESHES = (40, 80)  # numbers of Exudyn's beam elements
COUNTS = (40, 2, 2)  # numbers of solid elements along the strip, through the thickness and across the width
MODULUS, DENSITY, POISSON = 200e9, 7850.0, 0.3
_STEP = 1.3  # factor by which the load grows from step to step
_COARSE = bd.Ritz(6)  # basis while the load grows
HEAD = (
    *("case", "length : width : thickness", "tip turns by", "Exudyn, 40 beams", "80 beams", "limit"),
    *("limit, without shortening", "CalculiX, solids"),
)
INTRODUCTION = """
Written by `python -m benchmarks.peers.in_space` on {day}.  Versions: {versions}.

Random strips of steel, 1 m long, under a dead force, from the sixth on with a dead moment, too, both in
random directions, at the tip. Distances of the tips from that of beamdyn, over the length; 1e-3 is wanted
beside Exudyn's geometrically exact beams, 1e-2 beside solids.

All have shear, stretch and Saint-Venant's torsion. Exudyn's error falls with the square of the length of its
beams, and the limit is that of 40 and 80 of them. Its beams are not shortened by twist, as helical fibres
are: that is what is left, as the next column shows, for which beamdyn leaves it out, too. The solids are
C3D20R, 40 along, 2 through the thickness and 2 across the width, with Poisson's ratio 0.3, a clamped root
face and the force spread over the face at the tip.

"""
DECK = """*NODE
{nodes}
*ELEMENT, TYPE=C3D20R, ELSET=BEAM
{elements}
*NSET, NSET=ROOT
{root}
*NSET, NSET=TIP
{tip}
*BOUNDARY
ROOT, 1, 3
*MATERIAL, NAME=STEEL
*ELASTIC
{youngs_modulus:g}, {poissons_ratio:g}
*SOLID SECTION, ELSET=BEAM, MATERIAL=STEEL
*STEP, NLGEOM, INC=400
*STATIC
0.05, 1, 1e-5, 0.1
*CLOAD
{loads}
*NODE PRINT, NSET=TIP
U
*END STEP
"""


@dataclass(frozen=True)
class Case:
    """A strip of unit length [m] and the load at its tip."""

    width: float
    thickness: float
    load: bd.TipLoad

    @property
    def scene(self) -> bd.Scene:
        """The strip at rest, with the physics that all programs have."""
        beam = bd.Beam.rectangular(1.0, self.width, self.thickness, MODULUS, DENSITY, poissons_ratio=POISSON)
        physics = bd.Physics(
            2, shear=True, rotary_inertia=True, stretch=True, torsion=True, large_deflection=True
        )
        return bd.Scene(beam, bd.Mount(setting_angle=np.pi), physics=physics, tip_load=self.load)

    @property
    def stiffness(self) -> np.ndarray:
        """Stiffnesses (6,) of the section: EA, GA in y and z, GJ, EI about y and z."""
        beam = self.scene.modelled_beam
        each = (
            *(beam.axial_stiffness, beam.shear_stiffness, beam.second_shear_stiffness),
            *(beam.torsion_stiffness, beam.second_bending_stiffness, beam.bending_stiffness),
        )
        return np.array([float(profile(np.zeros(1))[0]) for profile in each if profile is not None])


def random_case(number: int) -> Case:
    """Draw the case with a number; the first cases, also solved by solids, have a force but no moment."""
    rng = np.random.default_rng([SEED, number])
    width = 1 / rng.uniform(30, 60)
    thickness, wanted = width / rng.uniform(1, 4), np.radians(rng.uniform(30, 90))
    force, moment = rng.normal(size=(2, 3))
    unit = MODULUS * width * thickness**3 / 12
    couple = 0.3 * unit * moment / np.linalg.norm(moment) * (number >= SOLIDS)
    case = Case(width, thickness, bd.TipLoad(unit * force / np.linalg.norm(force), couple))
    while True:
        load = case.load
        grown = replace(load, force=_STEP * np.array(load.force), moment=_STEP * np.array(load.moment))
        further = replace(case, load=grown)
        if bd.equilibrium(further.scene, 0.0, discretization=_COARSE).tip_angle > wanted:
            return case
        case = further


# Exudyn -------------------------------------------------------------------------------------------


def exudyn_tip(case: Case, count: int) -> np.ndarray:
    """Compute the position (3,) of the tip [m] with a number of Exudyn's beam elements."""
    import exudyn as solver
    from exudyn.itemInterface import (
        Force,
        GenericJoint,
        MarkerBodyRigid,
        MarkerNodeRigid,
        NodeRigidBodyEP,
        ObjectBeamGeometricallyExact,
        ObjectGround,
        Torque,
    )

    solver.config.printToConsole = False
    container = solver.SystemContainer()
    system, section = container.AddSystem(), solver.BeamSection()
    section.stiffnessMatrix = np.diag(case.stiffness)
    places = ([k / count, 0, 0, 1, 0, 0, 0] for k in range(count + 1))
    nodes = [system.AddNode(NodeRigidBodyEP(referenceCoordinates=place)) for place in places]
    for ends in pairwise(nodes):
        beam = ObjectBeamGeometricallyExact(nodeNumbers=[*ends], length=1 / count, sectionData=section)
        system.AddObject(beam)
    ground = system.AddMarker(MarkerBodyRigid(bodyNumber=system.AddObject(ObjectGround())))
    root, tip = (system.AddMarker(MarkerNodeRigid(nodeNumber=nodes[k])) for k in (0, -1))
    system.AddObject(GenericJoint(markerNumbers=[ground, root], constrainedAxes=[1] * 6))
    system.AddLoad(Force(markerNumber=tip, loadVector=list(case.load.force)))
    system.AddLoad(Torque(markerNumber=tip, loadVector=list(case.load.moment)))
    system.Assemble()
    system.SolveStatic(_settings(solver, case.stiffness.min()), showHints=False)
    return np.array(system.GetNodeOutput(nodes[-1], solver.OutputVariableType.Position))


def _settings(solver: Any, force: float) -> Any:
    """Return settings with which Newton's iterations end at rounding of the axial force; `force` in N."""
    settings = solver.SimulationSettings()
    settings.solution.file.write = False
    settings.linearSolver.solverType = solver.LinearSolverType.EigenSparse
    settings.staticSolver.numberOfLoadSteps = 10
    settings.staticSolver.newton.relativeTolerance = 1e-8
    settings.staticSolver.newton.absoluteTolerance = 1e-6 * force
    return settings


def limit(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """Extrapolate a result whose error falls to a quarter from the coarse to the fine mesh."""
    return fine + (fine - coarse) / 3


# CalculiX -----------------------------------------------------------------------------------------


def solid_tip(case: Case, counts: tuple[int, int, int] = COUNTS) -> np.ndarray:
    """Compute the position (3,) of the middle of the face at the tip [m] by solid elements."""
    with TemporaryDirectory() as folder:
        Path(folder, "beam.inp").write_text(deck(case, counts))
        subprocess.run(["ccx", "-i", "beam"], cwd=folder, capture_output=True, check=True)
        found = DISPLACEMENTS.findall(Path(folder, "beam.dat").read_text())
    if not found:
        raise ValueError("the static step did not converge")
    moved = np.array([line.split() for line in found[-1].splitlines()], dtype=float)[:, 1:]
    return np.array([1.0, 0.0, 0.0]) + face_weights(counts) @ moved


def deck(case: Case, counts: tuple[int, int, int]) -> str:
    """Write the input file of a case."""
    number = hexahedra.numbers(counts)
    at_tip = [n for place, n in number.items() if place[0] == 2 * counts[0]]
    sides = np.array([1.0, case.thickness, case.width])
    places = {
        n: (np.array(place) / (2 * np.array(counts)) - [0, 0.5, 0.5]) * sides for place, n in number.items()
    }
    loads = (
        f"{n}, {axis}, {weight * force:.12g}"
        for n, weight in zip(at_tip, face_weights(counts), strict=True)
        for axis, force in enumerate(case.load.force, 1)
    )
    return DECK.format(
        nodes="\n".join(f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, (x, y, z) in places.items()),
        elements="\n".join(hexahedra.elements(counts, number)),
        root="\n".join(f"{n}," for place, n in number.items() if place[0] == 0),
        tip="\n".join(f"{n}," for n in at_tip),
        loads="\n".join(loads),
        youngs_modulus=MODULUS,
        poissons_ratio=POISSON,
    )


def face_weights(counts: tuple[int, int, int]) -> np.ndarray:
    """Compute the fraction of a uniform load on the tip face that acts at each of its nodes, in order."""
    share = {place: 0.0 for place in hexahedra.numbers(counts) if place[0] == 2 * counts[0]}
    for j in range(counts[1]):
        for k in range(counts[2]):
            for b, c in ((b, c) for b in range(3) for c in range(3) if (b, c) != (1, 1)):
                share[2 * counts[0], 2 * j + b, 2 * k + c] += 1 / 3 if 1 in (b, c) else -1 / 12
    return np.array([*share.values()]) / (counts[1] * counts[2])


# Rows ---------------------------------------------------------------------------------------------


def without_shortening(case: Case) -> np.ndarray:
    """Compute the position (3,) of the tip [m] without shortening by twist, as in Exudyn."""
    bent = Model(case.scene, bd.Ritz(14)).bent
    bent = replace(bent, beam=replace(bent.beam, fibres=np.zeros_like(bent.beam.fibres)))
    return bent.beam.at(DeflectedSolver(bent, "straight").load.at_rest).tip


def rows(solids: int) -> Iterator[Row]:
    """Yield the strip, the rotation of its tip, and the distances of the tips, over the length."""
    for number in range(CASES):
        case = random_case(number)
        found = bd.equilibrium(case.scene, 0.0)
        sides = f"{1 / case.width:.1f} : 1 : {case.thickness / case.width:.2f}"
        cells = [str(number), sides, f"{np.degrees(found.tip_angle):.0f} deg"]
        if exudyn.version() is None:
            cells += ["", "", tables.MISSING, ""]
        else:
            tips = [exudyn_tip(case, count) for count in MESHES]
            tips.append(limit(*tips))
            cells += [apart(tip, found.tip) for tip in tips] + [apart(tips[-1], without_shortening(case))]
        beside = number < solids and calculix.version() is not None
        yield (*cells, apart(solid_tip(case), found.tip) if beside else "")


def apart(first: np.ndarray, second: np.ndarray) -> str:
    """Format the distance of two tip positions."""
    return f"{np.linalg.norm(first - second):.1e}"


def section(body: Sequence[Row]) -> str:
    """Write the section of docs/peers.md on strips in space."""
    versions = f"{OURS} {ours.version()}, {tables.versions((calculix, exudyn))}"
    return (
        page.IN_SPACE + INTRODUCTION.format(day=date.today(), versions=versions) + markdown_table(HEAD, body)
    )


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--solids", type=int, default=SOLIDS, help="cases beside solids, from the first")
    table, body = Table(*HEAD), []
    for row in rows(parser.parse_args().solids):
        table.add_row(*map(escape, row))
        body.append(row)
    Console(width=140).print(table)
    page.write_section(section(body))


if __name__ == "__main__":
    main()
