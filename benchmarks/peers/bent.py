"""The harvester at a setting angle with large deflection: CalculiX's solid elements against the elastica.

x runs along the straight beam from the root, y across the thickness (in the plane of rotation), z across the
width.  A static step of CalculiX finds the equilibrium, a frequency step the vibration about it without the
Coriolis force, and a complex frequency step the vibration with the Coriolis force.
"""

from __future__ import annotations

import math
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.linalg import eigh

import beamdyn as bd
from benchmarks.cases.scenes import HARVESTER
from benchmarks.peers import hexahedra
from benchmarks.peers.measure import given, shortest
from benchmarks.peers.tapered import rows

ELEMENTS = (20, 40, 80)  # numbers of elements along the beam
ACROSS = (1, 2)  # numbers of elements over the thickness and the width
MODES = 10  # number of modes, at least five of them in the plane; with more, the complex step loses digits
COMPARED = 3  # number of frequencies compared, in the plane of rotation
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
{youngs_modulus:g}, 0
*DENSITY
{density:g}
*SOLID SECTION, ELSET=BEAM, MATERIAL=STEEL
*STEP, NLGEOM
*CONTROLS, PARAMETERS=TIME INCREMENTATION
50, 60, 9, 100, 10, 4, , 60
*CONTROLS, PARAMETERS=FIELD
1e-10, 1e-8
*STATIC
1, 1
*DLOAD
BEAM, CENTRIF, {speed_squared:.12g}, {axis[0]:.12g}, {axis[1]:.12g}, 0, 0, 0, 1
*NODE PRINT, NSET=TIP
U
*END STEP
*STEP, PERTURBATION
*FREQUENCY, STORAGE=YES
{modes}
*END STEP
*STEP, PERTURBATION
*COMPLEX FREQUENCY, CORIOLIS
{modes}
*END STEP
"""


@dataclass(frozen=True)
class Case:
    """The published harvester at a setting angle [deg] and a speed [rad/s]."""

    setting_angle: float
    speed: float

    def __str__(self) -> str:
        return f"{self.setting_angle:.7g} deg, {self.speed:g} rad/s"


CASES = (Case(45.0, 100.0), Case(88.35985, 400.0))


@dataclass(frozen=True)
class Solution:
    """An equilibrium and the vibration about it.

    Parameters
    ----------
    tip : ndarray, shape (2,)
        Position of the tip from the root along b1 and b2, over the length.
    static : ndarray, shape (3,)
        Frequencies in the plane of rotation without the Coriolis force [Hz].
    full : ndarray, shape (3,)
        Frequencies with the Coriolis force [Hz].
    time : float
        Computing time of all steps [s].
    """

    tip: np.ndarray
    static: np.ndarray
    full: np.ndarray
    time: float


# CalculiX -----------------------------------------------------------------------------------------


def solid(case: Case, elements: int) -> Solution:
    """Solve a case by solid elements; the time is that of one run, including the start of the process."""
    with TemporaryDirectory() as folder:
        Path(folder, "beam.inp").write_text(deck(case, elements))
        command = ["ccx", "-i", "beam"]
        time, _ = shortest(lambda: subprocess.run(command, cwd=folder, capture_output=True), 1)
        return read(Path(folder, "beam.dat").read_text(), time)


def deck(case: Case, elements: int) -> str:
    """Return the text of CalculiX' input file for a case.

    One element over the width would do in a linear step; in a nonlinear one the reduced integration of a
    single row leaves motions without stiffness, and Newton's iterations diverge.  They cross large residual
    forces on their way, as the axis is stiff, so that neither the number of iterations nor a residual
    relative to these forces may end them early.
    """
    data, counts = given(), (elements, *ACROSS)
    number = hexahedra.numbers(counts)
    angle = math.radians(case.setting_angle)
    return DECK.format(
        nodes="\n".join(node_lines(counts, number)),
        elements="\n".join(hexahedra.elements(counts, number)),
        root="\n".join(f"{n}," for place, n in number.items() if place[0] == 0),
        tip="\n".join(f"{n}," for place, n in number.items() if place[0] == 2 * elements),
        speed_squared=case.speed**2,
        axis=(data["radius"] * math.cos(angle), data["radius"] * math.sin(angle)),
        modes=MODES,
        **{name: data[name] for name in ("youngs_modulus", "density")},
    )


def node_lines(counts: tuple[int, int, int], number: dict[hexahedra.Place, int]) -> Iterator[str]:
    """Yield number and coordinates [m] of each node; the axis of the beam is y = z = 0."""
    data = given()
    for place, n in number.items():
        xi, eta, zeta = (step / (2 * count) for step, count in zip(place, counts, strict=True))
        y, z = (eta - 0.5) * data["thickness"], (zeta - 0.5) * data["width"]
        yield f"{n}, {xi * data['length']:.12g}, {y:.12g}, {z:.12g}"


DISPLACEMENTS = re.compile(r"^ displacements .*?\n\n((?: +\d+(?: +\S+){3}\n)+)", re.M)
_FREQUENCIES = "E I G E N V A L U E   O U T P U T"


def read(text: str, time: float) -> Solution:
    """Read a .dat file: the face of the tip, its mean displacement, and the frequencies."""
    face = DISPLACEMENTS.search(text)
    if face is None:
        raise ValueError("the .dat file has no displacements: the static step did not converge")
    moved = np.array([line.split() for line in face[1].splitlines()], dtype=float)[:, 1:3]
    tip = np.array([1.0, 0.0]) + moved.mean(axis=0) / given()["length"]
    steps = text.split(_FREQUENCIES)[1:3]
    in_plane = _lies_in_plane(steps[0])
    static, full = (_frequencies(step)[in_plane][:COMPARED] for step in steps)
    return Solution(tip, static, full, time)


def _lies_in_plane(text: str) -> np.ndarray:
    """Return whether each mode has motion along x or y; by symmetry the other modes move along z only."""
    x, y, z = np.abs(rows(text, "P A R T I C I P A T I O N   F A C T O R S")[:, 1:4]).T
    return np.maximum(x, y) > z


def _frequencies(text: str) -> np.ndarray:
    """Read the frequencies [Hz] below the title of a step."""
    return rows(text, "(RAD/TIME)")[:, -2]


# The elastica -------------------------------------------------------------------------------------


def beam(case: Case) -> Solution:
    """Solve a case by beamdyn; the time is that of equilibrium and modes."""
    mount = bd.Mount(given()["radius"], math.radians(case.setting_angle))
    scene = replace(HARVESTER, mount=mount, physics=bd.Physics(large_deflection=True))
    time, (tip, modes) = shortest(
        lambda: (bd.equilibrium(scene, case.speed).tip, bd.natural_modes(scene, case.speed, COMPARED))
    )
    return Solution(tip[:2] / given()["length"], without_coriolis(modes), modes.frequency, time)


def without_coriolis(modes: bd.Modes) -> np.ndarray:
    """Compute frequencies about the same equilibrium without the Coriolis force [Hz], shape (m,)."""
    pencil = modes.model.equations_at(modes.speed).steady()
    stiffness = pencil.K0 + modes.speed**2 * pencil.K2
    inverse_squares = eigh(pencil.M, stiffness, eigvals_only=True)[::-1]
    return 1 / (2 * math.pi * np.sqrt(inverse_squares[: len(modes.frequency)]))
