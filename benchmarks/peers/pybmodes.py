"""pyBModes: the uniform outward blade, bending out of the plane of rotation (flap).

The elements of pyBModes also stretch, twist and bend in the plane; these deformations are made stiff, so that
flap modes come first.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

from benchmarks.peers import measure
from benchmarks.peers.measure import Point, best_threads

NAME = "pyBModes"
BETTER = (
    "whole blades and towers: flap, lag, stretch and torsion coupled by twist and offsets, OpenFAST's files"
)
TARGET = ("27 elements", 200.0)
ELEMENTS = (40, 27, 20, 10, 5, 3)
MAIN = """--- Main ---
Uniform blade

--- General ---
f echo
1 beam_type
{rpm:.17g} rot_rpm
1.0 rpm_mult
{radius:.17g} radius
{hub:.17g} hub_rad
0. precone
0. bl_thp
1 hub_conn
20 modepr
t TabDelim
f mid_node_tw

--- Tip mass ---
0. tip_mass
0. cm_loc
0. cm_axial
0. ixx_tip
0. iyy_tip
0. izz_tip
0. ixy_tip
0. izx_tip
0. iyz_tip

--- Distributed properties ---
1 id_mat
'sections.dat' sec_props_file

Scaling
1.0 sec_mass_mult
1.0 flp_iner_mult
1.0 lag_iner_mult
1.0 flp_stff_mult
1.0 edge_stff_mult
1.0 tor_stff_mult
1.0 axial_stff_mult
1.0 cg_offst_mult
1.0 sc_offst_mult
1.0 tc_offst_mult

--- Elements ---
{elements} nselt
Boundaries
{boundaries}
"""
SECTIONS = """Uniform blade
2 n_secs

sec_loc str_tw tw_iner mass_den flp_iner edge_iner flp_stff edge_stff tor_stff axial_stff cg sc tc
(-) (deg) (deg) (kg/m) (kg-m) (kg-m) (Nm^2) (Nm^2) (Nm^2) (N) (m) (m) (m)
0 0 0 1 1e-8 1e-8 1 100 100 1e6 0 0 0
1 0 0 1 1e-8 1e-8 1 100 100 1e6 0 0 0
"""


def version() -> str | None:
    return measure.installed("pyBModes")


def points() -> Iterator[Point]:
    """Yield times of a solution for one mode, without reading the main file and checking the model."""
    exact = measure.blade_frequencies()
    for elements in ELEMENTS:
        results = {speed: solve(elements, speed) for speed in exact}
        time = sum(time for time, _ in results.values()) / len(results)
        error = measure.largest_error({speed: frequency for speed, (_, frequency) in results.items()}, exact)
        yield Point(measure.BLADE, NAME, f"{elements} elements", time, error)


def solve(elements: int, speed: float) -> tuple[float, float]:
    """Measure the shortest time [s]; return also the first frequency, nondimensional."""
    with model(deck(elements, speed), SECTIONS) as blade:
        time, result = best_threads(lambda: blade.run(n_modes=1, check_model=False))
    return time, 2 * math.pi * result.frequencies[0]


@contextmanager
def model(main_file: str, sections: str) -> Iterator[Any]:
    """Yield pyBModes' blade from the texts of its input files, which exist only inside the context."""
    from pybmodes.models import RotatingBlade

    with TemporaryDirectory() as folder:
        main = Path(folder, "blade.bmi")
        main.write_text(main_file)
        Path(folder, "sections.dat").write_text(sections)
        yield RotatingBlade(main)


def deck(elements: int, speed: float) -> str:
    """Return the text of pyBModes' main input file."""
    return MAIN.format(
        rpm=speed * 30 / math.pi,
        radius=1.0,
        hub=0.0,
        elements=elements,
        boundaries=" ".join(f"{x:.17g}" for x in np.linspace(0, 1, elements + 1)),
    )
