"""Twisted blades of wind turbines: pyBModes, set up as a beam that only bends in two planes.

Without offsets of the sections, pyBModes' stretch and torsion are not coupled with bending, and its bending
has no rotary inertia.  So any large stiffness of stretch and torsion keeps their modes above the compared
ones.
"""

from __future__ import annotations

import math
from collections.abc import Iterator

import numpy as np

import beamdyn as bd
from benchmarks.cases.blades import blade_scene, stations
from benchmarks.peers import pybmodes

NAMES = {"iea_15": "IEA 15 MW", "nrel_5": "NREL 5 MW", "bmodes_test01": "BModes Test01"}
# Approximate numbers of elements; equally many between neighbouring stations.
ELEMENTS = (200, 400, 800, 1600)
CONVERGED = 2e-5  # relative change of all frequencies below which no finer mesh is solved
MODES = 5
TOLERANCE = 1e-7  # tolerance of our frequencies, far below the compared differences
STIFFNESS = 1e3  # G J over E I, and E A L^2 over E I: the frequencies do not change from 0.1 to 1e14
GYRATION = 1e-6  # square of the radius of gyration of the sections for torsion, over L^2
HEAD = """Blade
{count} n_secs

sec_loc str_tw tw_iner mass_den flp_iner edge_iner flp_stff edge_stff tor_stff axial_stff cg sc tc
(-) (deg) (deg) (kg/m) (kg-m) (kg-m) (Nm^2) (Nm^2) (Nm^2) (N) (m) (m) (m)
"""


def our_frequencies(name: str, rpm: float) -> np.ndarray:
    """Compute the first five frequencies [Hz] of a blade by beamdyn."""
    return bd.natural_modes(blade_scene(name), rpm * math.pi / 30, MODES, tolerance=TOLERANCE).frequency


def their_frequencies(name: str, rpm: float, elements: int) -> np.ndarray:
    """Compute the first five frequencies [Hz] of a blade by pyBModes."""
    with pybmodes.model(main_file(name, rpm, elements), sections(name)) as blade:
        return np.array(blade.run(n_modes=MODES, check_model=False).frequencies)


def refined(name: str, rpm: float) -> Iterator[tuple[int, np.ndarray, float]]:
    """Yield number of elements, frequencies and their largest relative change, until this is small."""
    coarser = np.full(MODES, np.nan)
    for elements in ELEMENTS:
        found = their_frequencies(name, rpm, elements)
        change = float(np.abs(found / coarser - 1).max())
        yield len(boundaries(name, elements)) - 1, found, change
        if change < CONVERGED:
            return
        coarser = found


def boundaries(name: str, elements: int) -> np.ndarray:
    """Return the ends x/L of about a given number of elements, equally many between all stations.

    An element has the mass and stiffness at its middle, so that the error falls with the square of its
    length only if there is a boundary at each station.
    """
    own = stations(name)["stations"]
    intervals = len(own) - 1
    each = max(1, elements // intervals)
    return np.interp(np.arange(intervals * each + 1) / each, np.arange(intervals + 1), own)


def main_file(name: str, rpm: float, elements: int) -> str:
    """Return the text of the main input file, in which the radius is that of the tip."""
    data, ends = stations(name), boundaries(name, elements)
    return pybmodes.MAIN.format(
        rpm=rpm,
        radius=data["length"] + data["hub_radius"],
        hub=data["hub_radius"],
        elements=len(ends) - 1,
        boundaries=" ".join(f"{x:.17g}" for x in ends),
    )


def sections(name: str) -> str:
    """Return the text of the file of section properties."""
    data = stations(name)
    x, mass, twist = data["stations"], data["mass_per_length"], data["twist_deg"]
    flap, edge = data["flap_stiffness"], data["edge_stiffness"]
    inertia, largest = GYRATION * mass * data["length"] ** 2, STIFFNESS * np.maximum(flap, edge)
    none = np.zeros(len(x))
    columns = (x, twist, twist, mass, inertia, inertia, flap, edge, largest, largest / data["length"] ** 2)
    table = np.column_stack([*columns, none, none, none])
    return HEAD.format(count=len(x)) + "".join(f"{' '.join(f'{v:.17g}' for v in row)}\n" for row in table)


def extrapolated(coarse: np.ndarray, fine: np.ndarray) -> np.ndarray:
    """Extrapolate frequencies whose error falls to a quarter with elements of half the length."""
    return fine + (fine - coarse) / 3
