"""Comparison with the printed tables of other papers: every value, and errata with their proofs."""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from rich.console import Group

from beamdyn.common.edge.tables import table
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.discretization import FIXED, Discretization
from beamdyn.equations.fem import Fem
from beamdyn.equations.ritz import Ritz
from beamdyn.modes.bounds import frequency_bounds
from beamdyn.modes.modes import natural_modes
from beamdyn.published import load
from beamdyn.reproduce.blades import entries_of_blades, stations
from beamdyn.reproduce.entries import PrintedValue, Summary, summarize_entries
from beamdyn.reproduce.others import nondimensional_scene
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import Mount
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene

PAPERS = ("bir_2009", "bir_2010", "hamza_cherif_houmat_2004", "ozdemir_kaya_2006", "code_aster")
BLADES = ("iea_15", "nrel_5", "bmodes_test01")
_DISCRETIZATIONS = {"Ritz": "ritz", "FE": "fem"}
_STRETCHED: dict[str, tuple[Discretization, Discretization]] = {
    "ritz": (Ritz(16), Ritz(24)),
    "fem": (Fem(40), Fem(80)),
}
_ROUNDING = 1e-13  # relative error of a converged stretch

Errata = Sequence[tuple[str, PrintedValue]]


def compare_papers() -> tuple[list[Summary], Errata]:
    """Compare all values: summaries by source and discretization, and the errata with their sources."""
    summaries: list[Summary] = []
    errata: dict[tuple[str, str, int], tuple[str, PrintedValue]] = {}
    for source in all_entries("ritz"):
        for name, discretization in _DISCRETIZATIONS.items():
            entries = all_entries(discretization)[source]
            summaries.append(summarize_entries(source, name, entries))
            for entry in entries:
                if entry.exact:
                    errata.setdefault((source, entry.where, entry.mode), (source, entry))
    return summaries, [*errata.values()]


@cache
def all_entries(discretization: str) -> Mapping[str, Sequence[PrintedValue]]:
    """All values by their source."""
    groups: dict[str, list[PrintedValue]] = {}
    for paper in PAPERS:
        for case in cases(paper):
            groups.setdefault(case["name"], []).extend(entries_of_case(case, discretization))
    for source, entry in (*_cable(discretization), *_stretch(discretization)):
        groups.setdefault(source, []).append(entry)
    for source, entry in entries_of_blades(discretization):
        groups.setdefault(f"{source}, computed", []).append(entry)
    return groups


def cases(paper: str) -> Iterator[dict[str, Any]]:
    """Cases of the tables of a paper: a row each, with what the rows of its table share.

    Besides the keys of ``rotating_beams.toml`` they have ``where``, the row in words, ``factor`` of the
    printed values over the nondimensional ones, and ``exact``, third values by the number of the mode.
    """
    for printed in load(paper).get("table", []):
        shared = {"factor": 1.0} | {key: value for key, value in printed.items() if key != "rows"}
        for row in printed["rows"]:
            yield shared | {"where": _where(row), "exact": {}} | _section(row) | row


def _where(row: Mapping[str, Any]) -> str:
    if "gamma" in row:
        return f"gamma {row['gamma']:g}"
    return f"b {row['width_taper']:g}, h {row['thickness_taper']:g}"


def _section(row: Mapping[str, Any]) -> dict[str, Any]:
    """Mass and stiffness of a rectangular section that tapers linearly, as polynomials in x/L."""
    width = Polynomial([1.0, -row.get("width_taper", 0.0)])
    thickness = Polynomial([1.0, -row.get("thickness_taper", 0.0)])
    return {"mass": (width * thickness).coef, "stiffness": (width * thickness**3).coef}


def beams() -> dict[str, str]:
    """The beam of each table of the papers, in words, by the name of the table."""
    papers = [load(name) for name in PAPERS]
    alone = [paper[key] for paper in papers for key in ("cable", "stretch") if key in paper]
    tables = [table for paper in papers for table in paper.get("table", [])]
    return {table["name"]: table["beam"] for table in (*tables, *alone)}


def entries_of_case(case: Mapping[str, Any], discretization: str) -> Iterator[PrintedValue]:
    """Compare the values of a case."""
    scene, printed, factor = nondimensional_scene(dict(case)), case["frequency"], case["factor"]
    modes = natural_modes(scene, case["gamma"], len(printed), discretization)
    for i, text in enumerate(printed):
        ours = float(factor * abs(modes.eigenvalue[i]))
        exact = case["exact"].get(str(i + 1), "")
        bounds = _guaranteed(scene, case["gamma"], i, factor) if exact else None
        yield PrintedValue(case["where"], i + 1, text, ours, float(modes.error[i]) * ours, exact, bounds)


def _guaranteed(scene: Scene, speed: float, index: int, factor: float) -> tuple[float, float] | None:
    """Guaranteed bounds of a frequency [rad/s], times a factor; None with stretch: no theorem covers it."""
    if scene.physics.stretch:
        return None
    bounds = frequency_bounds(scene, speed, index + 1)
    unit = 2 * math.pi * factor
    return unit * float(bounds.lower[index]), unit * float(bounds.upper[index])


def _cable(discretization: str) -> Iterator[tuple[str, PrintedValue]]:
    """Compare the frequencies over speed of a hinged beam of hardly any stiffness with those of a cable."""
    cable = load("bir_2009")["cable"]
    speed, printed = cable["gamma"], cable["ratio"]
    mount = Mount(0.0, math.pi, math.pi / 2, root_stiffness=0.0)
    modes = natural_modes(
        Scene(Beam.from_stiffness(1.0, 1.0, 1.0), mount), speed, len(printed), discretization
    )
    for i, text in enumerate(printed):
        ours = float(abs(modes.eigenvalue[i])) / speed
        yield cable["name"], PrintedValue(f"gamma {speed:g}", i + 1, text, ours, float(modes.error[i]) * ours)


def _stretch(discretization: str) -> Iterator[tuple[str, PrintedValue]]:
    """Compare the centrifugal stretch [m] with its closed form."""
    given = load("code_aster")["stretch"]
    area = 1e-4  # m2: any, as the stretch does not depend on it
    density, modulus = given["density"]["value"], given["youngs_modulus"]["value"]
    beam = Beam.from_stiffness(given["length"]["value"], density * area, 1.0, axial_stiffness=modulus * area)
    coarse, fine = (tip_stretch(beam, given["speed"]["value"], d) for d in _STRETCHED[discretization])
    error = abs(fine - coarse) + _ROUNDING * abs(fine)
    yield given["name"], PrintedValue("tip", 1, given["stretch"], fine, error)


def tip_stretch(beam: Beam, speed: float, discretization: Discretization) -> float:
    """Stretch of the tip [m] of a beam that points outward from the axis, at a steady speed [rad/s]."""
    scene = Scene(beam, Mount(0.0, math.pi), physics=Physics(stretch=True))
    spaces = discretization.spaces(scene.modelled_beam)
    equations = assemble_over(scene, spaces)
    pencil = equations.steady().part(equations.places(["stretch"]))
    q = np.linalg.solve(pencil.K0 + speed**2 * pencil.K2, speed**2 * pencil.f2)
    return float(spaces.functions(FIXED._replace(stiffness="axial_stiffness")).end(0) @ q)


def errata_table(errata: Errata) -> Group:
    """Table of errata with their proofs."""
    heads = ("source", "at", "mode", "printed", "ours, Ritz", "power series", "bounds", "off by")
    title = (
        "Errata: ours, a third method, the relative width of guaranteed bounds that exclude the print, and\n"
        "by how many units of its last digit the print is off (less than one: cut off or rounded twice)"
    )
    return table(title, heads, ([source, *entry.cells()] for source, entry in errata), (0, 1))


def sources() -> Iterator[str]:
    """Where the tables were taken from, a line each."""
    yield "Sources of the tables:"
    for paper in PAPERS:
        data = load(paper)
        where = data.get("doi") or data.get("url")
        place = f" ({where})" if where else ""
        yield f"  {' and '.join(data['authors'])}, {data['year']}{place}: {data['source']}"
    for name in BLADES:
        yield f"  {stations(name)['title']}: {stations(name)['source']}"
    yield (
        "The third values of errata are those of a power-series determinant in 30 digits; "
        "tests/literature/test_printed_tables.py computes them anew."
    )
