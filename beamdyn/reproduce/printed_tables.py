"""Comparison with printed tables of other sources: every value, summaries, and errata with their proofs."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from dataclasses import replace
from functools import cache
from typing import Any

import numpy as np
from numpy.polynomial import Polynomial
from rich.console import Group

import beamdyn as bd
from beamdyn.common.edge.console import table
from beamdyn.common.results.published import values_alone
from beamdyn.equations.assembly import assemble_over
from beamdyn.equations.discretization import FIXED, Discretization
from beamdyn.published import load
from beamdyn.reproduce.blades import entries_of_blades, stations
from beamdyn.reproduce.entries import PrintedValue, Summary, compare_modes, summarize_entries

PAPERS = ("bir_2009", "bir_2010", "hamza_cherif_houmat_2004", "ozdemir_kaya_2006", "code_aster")
BLADES = ("iea_15", "nrel_5", "bmodes_test01")
_DISCRETIZATIONS = {"Ritz": "ritz", "FE": "fem"}
_STRETCHED: dict[str, tuple[Discretization, Discretization]] = {
    "ritz": (bd.Ritz(16), bd.Ritz(24)),
    "fem": (bd.Fem(40), bd.Fem(80)),
}
_ROUNDING = 1e-13  # relative error of the converged axial stretch

Entries = Mapping[str, Sequence[PrintedValue]]  # printed values, by their source
Errata = Sequence[tuple[str, PrintedValue]]


def _by_source(entries: Iterable[tuple[str, PrintedValue]]) -> Entries:
    groups: dict[str, list[PrintedValue]] = {}
    for source, entry in entries:
        groups.setdefault(source, []).append(entry)
    return groups


def summarize(entries_by: Callable[[str], Entries]) -> list[Summary]:
    """Summarize printed values by source and discretization; `entries_by(discretization)` compares them."""
    found = {name: entries_by(discretization) for name, discretization in _DISCRETIZATIONS.items()}
    sources = next(iter(found.values()))
    return [summarize_entries(source, name, found[name][source]) for source in sources for name in found]


# Tables of the papers --------------------------------------------------------------------------------


def compare_papers() -> tuple[list[Summary], Errata]:
    """Compare all printed values: return summaries by source and discretization, and errata with sources."""
    found = all_entries(next(iter(_DISCRETIZATIONS.values())))
    errata = [(source, entry) for source, entries in found.items() for entry in entries if entry.exact]
    return summarize(all_entries), errata


@cache
def all_entries(discretization: str) -> Entries:
    """Compare all values of papers and blades by one discretization."""
    rows = ((case, entries_of_case(case, discretization)) for paper in PAPERS for case in cases(paper))
    return _by_source(
        [
            *((case["name"], entry) for case, entries in rows for entry in entries),
            *_cable(discretization),
            *_stretch(discretization),
            *((f"{source}, computed", entry) for source, entry in entries_of_blades(discretization)),
        ]
    )


def cases(paper: str) -> Iterator[dict[str, Any]]:
    """Yield the cases of a paper's tables: one for each row, with the data that rows of a table share.

    Besides the keys of ``rotating_beams.toml``, cases have ``where``, which names the row, ``factor``, the
    ratio of printed to nondimensional values, and ``exact``, values by an independent method by mode
    number. Mass and stiffness are those of a linearly tapering rectangular section, unless they are given.
    """
    for printed in load(paper).get("table", []):
        shared = {"factor": 1.0} | {key: value for key, value in printed.items() if key != "rows"}
        for row in printed["rows"]:
            taper = row.get("width_taper", 0.0), row.get("thickness_taper", 0.0)
            width, thickness = (Polynomial([1.0, -share]) for share in taper)
            section = {"mass": (width * thickness).coef, "stiffness": (width * thickness**3).coef}
            where = f"gamma {row['gamma']:g}" if "gamma" in row else "b {:g}, h {:g}".format(*taper)
            yield shared | {"where": where, "exact": {}} | section | row


def beams() -> dict[str, str]:
    """Describe the beam of each table of the papers, by the name of the table."""
    papers = [load(name) for name in PAPERS]
    alone = [paper[key] for paper in papers for key in ("cable", "stretch") if key in paper]
    tables = [table for paper in papers for table in paper.get("table", [])]
    return {table["name"]: table["beam"] for table in (*tables, *alone)}


def entries_of_case(case: Mapping[str, Any], discretization: str) -> Iterator[PrintedValue]:
    """Compare the printed values of a case with computed ones.

    An erratum also has guaranteed bounds, except with stretch, for which there are none.
    """
    scene, printed, factor = nondimensional_scene(case), case["frequency"], case["factor"]
    modes = bd.natural_modes(scene, case["gamma"], len(printed), discretization)
    for entry in compare_modes(case["where"], printed, factor * np.abs(modes.eigenvalue), modes.error):
        exact, bounds = case["exact"].get(str(entry.mode), ""), None
        if exact and not scene.physics.stretch:
            found, unit = bd.frequency_bounds(scene, case["gamma"], entry.mode), 2 * math.pi * factor
            bounds = unit * float(found.lower[entry.mode - 1]), unit * float(found.upper[entry.mode - 1])
        yield replace(entry, exact=exact, bounds=bounds)


def _cable(discretization: str) -> Iterator[tuple[str, PrintedValue]]:
    """Compare the frequencies over speed of a hinged, very flexible beam with those of a cable."""
    cable = load("bir_2009")["cable"]
    speed, printed = cable["gamma"], cable["ratio"]
    scene = bd.Scene(
        bd.Beam.from_stiffness(1.0, 1.0, 1.0), bd.Mount(0.0, math.pi, math.pi / 2, root_stiffness=0.0)
    )
    modes = bd.natural_modes(scene, speed, len(printed), discretization)
    ratios = np.abs(modes.eigenvalue) / speed
    for entry in compare_modes(f"gamma {speed:g}", printed, ratios, modes.error):
        yield cable["name"], entry


def _stretch(discretization: str) -> Iterator[tuple[str, PrintedValue]]:
    """Compare the centrifugal stretch of a beam at its tip [m] with the closed form."""
    given = values_alone(load("code_aster")["stretch"])
    area = 1e-4  # arbitrary area [m2]: the stretch does not depend on it
    mass, stiffness = given["density"] * area, given["youngs_modulus"] * area
    beam = bd.Beam.from_stiffness(given["length"], mass, 1.0, axial_stiffness=stiffness)
    coarse, fine = (tip_stretch(beam, given["speed"], d) for d in _STRETCHED[discretization])
    error = abs(fine - coarse) + _ROUNDING * abs(fine)
    yield given["name"], PrintedValue("tip", 1, given["stretch"], fine, error)


def tip_stretch(beam: bd.Beam, speed: float, discretization: Discretization) -> float:
    """Compute the tip's stretch [m] for a beam pointing outward from the axis at a steady speed [rad/s]."""
    scene = bd.Scene(beam, bd.Mount(0.0, math.pi), physics=bd.Physics(stretch=True))
    spaces = discretization.spaces(scene.modelled_beam)
    equations = assemble_over(scene, spaces)
    pencil = equations.steady().part(equations.places(["stretch"]))
    q = np.linalg.solve(pencil.K0 + speed**2 * pencil.K2, speed**2 * pencil.f2)
    return float(spaces.functions(FIXED._replace(stiffness="axial_stiffness")).end(0) @ q)


# Tables of rotating and of twisted beams -----------------------------------------------------------------


@cache
def reference_entries(discretization: str) -> Entries:
    """Compare tables of rotating, twisted and stocky beams, and critical speeds, with computed values."""
    data = load("rotating_beams")
    critical = [case | {"source": "critical speeds, computed"} for case in data["critical"]]
    known = [*data["case"], *(case for case in critical if np.isfinite(case["gamma"]))]
    return _by_source(
        (case["source"], replace(entry, printed=str(float(entry.printed))))  # trailing zeros are removed
        for case in (*known, *load("twisted_beams")["case"])
        for entry in entries_of_reference(case, discretization)
    )


def entries_of_reference(case: Mapping[str, Any], discretization: str) -> list[PrintedValue]:
    """Compare values of a case of ``rotating_beams.toml`` or ``twisted_beams.toml`` with computed ones."""
    scene = twisted_scene(case) if "planes" in case else nondimensional_scene(case)
    if "frequency" not in case:
        point = bd.critical_point(scene, discretization)
        return compare_modes(case["name"], [case["gamma"]], [point.speed], [point.error])
    modes = bd.natural_modes(scene, case["gamma"], len(case["frequency"]), discretization)
    return compare_modes(case["name"], case["frequency"], np.abs(modes.eigenvalue), modes.error)


def nondimensional_scene(case: Mapping[str, Any]) -> bd.Scene:
    """Build the scene of a nondimensional case: root stiffness, root mass per length and length are 1.

    Parameters
    ----------
    case : mapping
        A ``case`` or ``critical`` of ``rotating_beams.toml``.

    Returns
    -------
    Scene
        Scene whose eigenvalues, at the case's nondimensional speed gamma in rad/s, have the nondimensional
        frequencies as magnitudes.
    """
    delta, alpha = case["delta"], case.get("alpha")
    beam = bd.Beam.from_stiffness(
        1.0,
        mass_per_length=Polynomial(case["mass"]),
        bending_stiffness=Polynomial(case["stiffness"]),
        axial_stiffness=alpha and alpha**2,
        tip=bd.TipMass(**case["tip"]) if "tip" in case else None,
    )
    mount = bd.Mount(abs(delta), 0.0 if delta < 0 else np.pi, float(np.radians(case["bending_angle_deg"])))
    return bd.Scene(beam, mount, physics=bd.Physics(stretch=alpha is not None))


def twisted_scene(case: Mapping[str, Any]) -> bd.Scene:
    """Build the scene of a case of ``twisted_beams.toml``, whose speed in rad/s is the case's gamma."""
    names = ("second_bending_stiffness", "twist", "shear_stiffness", "rotary_inertia")
    given: dict[str, Any] = {name: Polynomial(case[name]) for name in names if name in case}
    beam = bd.Beam.from_stiffness(
        1.0, Polynomial(case["mass_per_length"]), Polynomial(case["bending_stiffness"]), **given
    )
    angles = (float(np.radians(case[name])) for name in ("setting_angle_deg", "bending_angle_deg"))
    shear, rotary = "shear_stiffness" in case, "rotary_inertia" in case
    physics = bd.Physics(planes=case["planes"], shear=shear, rotary_inertia=rotary)
    return bd.Scene(beam, bd.Mount(case["radius"], *angles), physics=physics)


# Tables as printed on the screen -------------------------------------------------------------------------


def summary_table(rows: Iterable[Summary]) -> Group:
    """Build the table of summaries."""
    heads = ("source", "by", "values", "printed to", "deviation", "error", "verdict")
    title = (
        "Beams and blades of other sources: largest relative deviation (without errata) and estimated error"
    )
    return table(title, heads, (row.cells() for row in rows), (0, 1, 6))


def errata_table(errata: Errata) -> Group:
    """Build the table of errata with their proofs."""
    heads = ("source", "at", "mode", "printed", "ours, Ritz", "power series", "bounds", "off by")
    title = (
        "Errata: our value, an independent one, relative width of bounds that exclude the printed value,\n"
        "and deviation of the print in units of its last digit (less than one: cut off or rounded twice)"
    )
    return table(title, heads, ([source, *entry.cells()] for source, entry in errata), (0, 1))


def sources() -> Iterator[str]:
    """Yield the sources of the tables, one line each."""
    yield "Sources of the tables:"
    for paper in PAPERS:
        data = load(paper)
        where = data.get("doi") or data.get("url")
        place = f" ({where})" if where else ""
        yield f"  {' and '.join(data['authors'])}, {data['year']}{place}: {data['source']}"
    for name in BLADES:
        yield f"  {stations(name)['title']}: {stations(name)['source']}"
    yield (
        'The values "power series" of errata are by an independent method: zeros of the determinant of the '
        "tip's boundary conditions; tests/literature/test_printed_tables.py computes them anew in 20 digits."
    )
