"""CalculiX: the harvester that points inward, modelled by solid elements.

A static step applies the centrifugal load.  A frequency step then perturbs this state, with the static stress
and the spin softening.
"""

from __future__ import annotations

import re
import shutil
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

from benchmarks.peers import hexahedra, measure
from benchmarks.peers.measure import Point, given, shortest

NAME = "CalculiX"
BETTER = "solid elements: bodies of any shape, shear, torsion, all directions at once, plasticity, contact"
TARGET = ("40 elements, nonlinear static step", 3000.0)
# Number of elements, and whether the static step is nonlinear.
SETTINGS = ((40, True), (20, False), (10, False), (5, False), (3, False))
DECK = """*NODE
{nodes}
*ELEMENT, TYPE=C3D20R, ELSET=BEAM
{elements}
*NSET, NSET=ROOT
{root}
*BOUNDARY
ROOT, 1, 3
*MATERIAL, NAME=STEEL
*ELASTIC
{youngs_modulus:g}, 0
*DENSITY
{density:g}
*SOLID SECTION, ELSET=BEAM, MATERIAL=STEEL
*STEP{nonlinear}
*STATIC
*DLOAD
BEAM, CENTRIF, {speed_squared:.12g}, {radius:.12g}, 0, 0, 0, 0, 1
*END STEP
*STEP, PERTURBATION
*FREQUENCY
1
*END STEP
"""


def version() -> str | None:
    if shutil.which("ccx") is None:
        return None
    shown = subprocess.run(["ccx", "-v"], capture_output=True, text=True).stdout
    match = re.search(r"Version\s+(\S+)", shown)
    return match[1] if match else "unknown"


def points() -> Iterator[Point]:
    """Yield times of runs, including the start of the process, without writing the input file."""
    exact = measure.harvester_frequencies()
    for elements, nonlinear in SETTINGS:
        results = {speed: solve(deck(elements, speed, nonlinear)) for speed in exact}
        time = sum(time for time, _ in results.values()) / len(results)
        error = measure.largest_error({speed: frequency for speed, (_, frequency) in results.items()}, exact)
        yield Point(measure.HARVESTER, NAME, setting(elements, nonlinear), time, error)


def setting(elements: int, nonlinear: bool) -> str:
    return f"{elements} elements, {'nonlinear' if nonlinear else 'linear'} static step"


def solve(text: str) -> tuple[float, float]:
    """Measure the shortest of several runs [s]; return also the first frequency [Hz]."""
    with TemporaryDirectory() as folder:
        Path(folder, "beam.inp").write_text(text)
        command = ["ccx", "-i", "beam"]
        time, _ = shortest(lambda: subprocess.run(command, cwd=folder, capture_output=True))
        return time, first_frequency(Path(folder, "beam.dat").read_text())


def first_frequency(text: str) -> float:
    """Read the first frequency of a .dat file [Hz]."""
    match = re.search(r"E I G E N V A L U E   O U T P U T.*?^\s+1\s+\S+\s+\S+\s+(\S+)", text, re.S | re.M)
    if match is None:
        raise ValueError("the .dat file has no frequency: the static step did not converge")
    return float(match[1])


def deck(count: int, speed: float, nonlinear: bool) -> str:
    """Write the input file: x along the beam to the axis, y across the thickness, rotation about z."""
    data, counts = given(), (count, 1, 1)
    number = hexahedra.numbers(counts)
    return DECK.format(
        nodes="\n".join(f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, (x, y, z) in nodes(count).items()),
        elements="\n".join(hexahedra.elements(counts, number)),
        root="\n".join(f"{n}," for place, n in number.items() if place[0] == 0),
        nonlinear=", NLGEOM" if nonlinear else "",
        speed_squared=speed**2,
        **{name: data[name] for name in ("youngs_modulus", "density", "radius")},
    )


def nodes(count: int) -> dict[int, tuple[float, float, float]]:
    """Return coordinates [m] by number: x from the root, y and z from the axis of the beam."""
    data = given()
    step = data["length"] / (2 * count), data["thickness"] / 2, data["width"] / 2
    return {
        n: (i * step[0], (j - 1) * step[1], (k - 1) * step[2])
        for (i, j, k), n in hexahedra.numbers((count, 1, 1)).items()
    }
