"""Large deflection: the equilibrium against CalculiX's solid elements, a spin-up against Exudyn's cables.

Run: python -m benchmarks.peers.large_deflection.  It takes about four minutes, prints the tables, and writes
them as a section of docs/peers.md; other sections of the page are unchanged.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from datetime import date
from itertools import pairwise

import numpy as np

from benchmarks.peers import bent, calculix, exudyn, ours, page, spin_up, tables
from benchmarks.peers.bent import Case, Solution
from benchmarks.peers.measure import OURS
from benchmarks.peers.spin_up import Run
from benchmarks.rows import markdown_table, show_table, time_text

Row = tuple[str, ...]
INTRODUCTION = """
Written by `python -m benchmarks.peers.large_deflection` on {day}.  Versions: {versions}.
"""
BENT = """
### The harvester bent by rotation: CalculiX's solid elements

The published harvester at a setting angle, Poisson's ratio 0, bending in the plane of rotation: a nonlinear
static step under the centrifugal load, then the frequencies about the equilibrium. Position of the tip from
the root, along the straight beam and across it, over the length; first frequency in the plane of rotation in
Hz, without the Coriolis force, which `*FREQUENCY` leaves out, and with it, by `*COMPLEX FREQUENCY, CORIOLIS`.
Below a row of CalculiX: its difference from beamdyn, of the tip over the length, of frequencies relative, the
largest of the first three.

"""
BENT_HEAD = ("case", "program", "time", "tip along", "tip across", "without Coriolis", "with Coriolis")
SPIN_UP = """
### A beam that spins up: Exudyn's cables

The outward beam of Kane, Ryan and Banerjee (1987) and of Simo and Vu-Quoc (1986), 10 m long, from rest to
6 rad/s: in 15 s as they have it, and in 5 s. Deflection of the tip across the turning axis over 20 s;
the difference from beamdyn and the change from the row above are the largest at any time, over beamdyn's
largest deflection.

"""
SPIN_UP_HEAD = ("spin-up", "program", "setting", "time", "largest deflection [m]", "difference", "change")
NOTES = """
- CalculiX's load follows the deflected shape: with the load of the straight shape the tip at 45 deg would
  stand at 0.9377, -0.3238, at 88.36 deg at 0.3549, -0.8843.
- One element over the width does in a linear step, not in a nonlinear one: the reduced integration of a
  single row leaves motions without stiffness. CalculiX ends Newton's iterations by residuals relative to the
  average force of all iterations, which is large as the axis is stiff: with 1e-6 of it a static step in one
  increment leaves the first frequency off by 8e-4, with 1e-10 by nothing that shows.
- In the complex frequency step the modes of the frequency step are the basis. Its values scatter by about
  3e-5, and by more with more than ten modes.
- What is left of CalculiX's difference does not fall with the mesh: shear and rotary inertia are worth 2e-4
  of the third frequency, and the strain of bending at the solid's surface is 0.3 % at 45 deg, 2 % at
  88.36 deg: more than steel bears, and no longer small beside 1 in a solid.
- Exudyn's cables stretch, as the published beam does, and the elastica does not: stretch lowers the
  frequency of vibration in the plane by 1.5e-4, which delays what is left after the fast spin-up. A stiffer
  axis takes most of that away, but locks the bending of few cables, and more of them then suffer from
  rounding.
"""


# CalculiX -----------------------------------------------------------------------------------------


def bent_rows() -> Iterator[Row]:
    """Yield equilibrium and frequencies of each case by beamdyn and CalculiX."""
    for case in bent.CASES:
        own = bent.beam(case)
        yield str(case), OURS, *solution_cells(own)
        if calculix.version() is None:
            yield "", f"{calculix.NAME} {tables.MISSING}", *[""] * 5
        else:
            yield from calculix_rows(case, own)


def calculix_rows(case: Case, own: Solution) -> Iterator[Row]:
    for elements in bent.ELEMENTS:
        solid = bent.solid(case, elements)
        yield "", f"{calculix.NAME}, {elements} elements", *solution_cells(solid)
        yield "", "difference", "", *map(scientific, bent_differences(solid, own))


def solution_cells(solution: Solution) -> Row:
    tip = (f"{component:.5f}" for component in solution.tip)
    return time_text(solution.time), *tip, f"{solution.static[0]:.4f}", f"{solution.full[0]:.4f}"


def bent_differences(solid: Solution, own: Solution) -> np.ndarray:
    """Compute differences in tip position [lengths], and in frequencies with and without Coriolis force."""
    frequencies = (solid.static / own.static, solid.full / own.full)
    return np.array([*np.abs(solid.tip - own.tip), *(np.abs(ratio - 1).max() for ratio in frequencies)])


def scientific(value: float) -> str:
    return f"{value:.1e}"


# Exudyn -------------------------------------------------------------------------------------------


def spin_up_rows() -> Iterator[Row]:
    """Yield deflections of each spin-up by beamdyn and Exudyn, and by beamdyn's linear theory."""
    for duration in spin_up.DURATIONS:
        own, linear = spin_up.elastica(duration), spin_up.linear(duration)
        yield f"{duration:g} s", OURS, f"tolerance {spin_up.TOLERANCE:g}", *run_cells(own), "", ""
        yield "", OURS, "linear", *run_cells(linear), scientific(linear.differs_from(own)), ""
        if exudyn.version() is None:
            yield "", f"{exudyn.NAME} {tables.MISSING}", *[""] * 5
        else:
            yield from exudyn_rows(duration, own)


def exudyn_rows(duration: float, own: Run) -> Iterator[Row]:
    runs = [spin_up.cables(duration, setting) for setting in spin_up.SETTINGS]
    changes = ["", *(scientific(run.differs_from(before)) for before, run in pairwise(runs))]
    for setting, run, change in zip(spin_up.SETTINGS, runs, changes, strict=True):
        yield "", exudyn.NAME, str(setting), *run_cells(run), scientific(run.differs_from(own)), change


def run_cells(run: Run) -> Row:
    return time_text(run.time), f"{run.largest:.5f}"


# The page -----------------------------------------------------------------------------------------


def section(bent_body: Sequence[Row], spin_up_body: Sequence[Row]) -> str:
    """Write the section of docs/peers.md on large deflection."""
    versions = f"{OURS} {ours.version()}, {tables.versions((calculix, exudyn))}"
    parts = (
        page.LARGE_DEFLECTION,
        INTRODUCTION.format(day=date.today(), versions=versions),
        BENT + markdown_table(BENT_HEAD, bent_body),
        SPIN_UP + markdown_table(SPIN_UP_HEAD, spin_up_body),
        NOTES,
    )
    return "".join(parts)


if __name__ == "__main__":
    tables_of_section = ((BENT_HEAD, bent_rows()), (SPIN_UP_HEAD, spin_up_rows()))
    page.write_section(section(*(show_table(*each) for each in tables_of_section)))
