"""Beams that bend in two directions, with twist, or shear and rotary inertia, beside pyBModes and CalculiX.

Run: python -m benchmarks.peers.physics.  It takes about six minutes and 7 GB (the finest mesh), prints the
tables, and writes them as a section of docs/peers.md; other sections of the page are unchanged.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from datetime import date
from itertools import pairwise

import numpy as np

from benchmarks.cases.two_planes import models
from benchmarks.peers import calculix, ours, page, pybmodes, tables, tapered, twisted
from benchmarks.peers.measure import OURS
from benchmarks.peers.tapered import CLAMPED, HELD_AXIALLY, Blade
from benchmarks.rows import markdown_table, show_table

INTRODUCTION = """
Written by `python -m benchmarks.peers.physics` on {day}.  Versions: {versions}.
"""
TWISTED = """
### Twisted blades: pyBModes

Blades of wind turbines from tables of stations: two directions of bending and the pre-twist, in either
program without torsion, offsets and inertia of the sections. Frequencies in Hz, and the largest relative
change from the coarser mesh and difference from beamdyn; the mesh is refined until it changes by less
than {converged:g}. Elements of pyBModes have the properties at their middle, so that its error falls to
a quarter when they are halved; the last row of a blade is the limit of that by extrapolation (Richardson)
from the two coarsest meshes, whose frequencies are not yet blurred by rounding, as those of 1600 elements
are by some 1e-6.
"""
TWISTED_HEAD = ("blade", "speed [rpm]", "program", "1", "2", "3", "4", "5", "change", "difference")
TAPERED = """
### A short tapered blade: CalculiX's solid elements

Steel, 1 m long on a hub of 0.1 m, {width} wide and {thickness} thick from root to tip, so that it is ten
times longer than wide; C3D20R elements, a nonlinear static step under the centrifugal load, then the
frequencies. Rows of meshes (elements along length, thickness, width) and those below them: frequency of
the solid over that of the beam, less 1, in thousandths. The beam has shear, by Cowper's coefficient, and
rotary inertia, unless the row says otherwise; such a row is beside the finest mesh.
"""
TAPERED_HEAD = (
    *("Poisson's ratio, root", "speed [rad/s]", "solid beside"),
    *(f"{direction} {number}" for direction in ("flap", "edge") for number in (1, 2, 3)),
)
NOTES = """
- Shear and rotary inertia are needed here: without them the beam is off by the row "slender beam".
- With Poisson's ratio 0 the solid and the beam agree within 1e-3. What remains in the edge at rest is
  the taper: a beam knows the section, not that its sides are slanted. Without taper the first
  frequencies agree within 1e-5.
- Turning at 200 rad/s adds up to 6e-4. Most of it is the axial stress of rotation, which in a solid adds
  to E in bending (row "E + stress"): an effect of the size of the axial strain, at the root 5e-4,
  without taper 9e-4.
- With Poisson's ratio 0.3 a clamped face hinders the contraction of the section near the root, which
  makes the solid stiffer, and the stress at the edges of the face is singular, which lowers the order.
  "Held axially" the face may contract: the difference falls by 1 to 4 thousandths.
- What then remains in higher modes is the shear coefficient: Cowper's 10 (1 + nu) / (12 + 11 nu) is for
  any rectangle. Hutchinson's (2001) counts the section's width and its contraction: 0.867 in the edge
  and, five times wider than deep, {flap:.1f} in the flap. With it all differences are below 1e-3, those
  of the edge being the taper's again.
- A frequency step of CalculiX counts the centrifugal stress and the softening by rotation, not the
  Coriolis force, which in a beam couples bending in the plane with stretch only.
"""


# pyBModes -----------------------------------------------------------------------------------------


def twisted_rows() -> Iterator[tuple[str, ...]]:
    """Yield frequencies of each blade and speed by beamdyn and pyBModes."""
    for blade in models()["blade"]:
        name, rpm = blade["name"], blade["speed_rpm"]
        own = twisted.our_frequencies(name, rpm)
        yield twisted.NAMES[name], f"{rpm:g}", OURS, *map(hertz, own), "", ""
        if pybmodes.version() is None:
            yield "", "", f"{pybmodes.NAME} {tables.MISSING}", *[""] * 7
        else:
            yield from pybmodes_rows(name, rpm, own)


def pybmodes_rows(name: str, rpm: float, own: np.ndarray) -> Iterator[tuple[str, ...]]:
    meshes = [*twisted.refined(name, rpm)]
    for elements, theirs, change in meshes:
        yield pybmodes_row(f"{elements} elements", theirs, own, change)
    limit = twisted.extrapolated(*(theirs for _, theirs, _ in meshes[:2]))
    yield pybmodes_row("limit", limit, own)


def pybmodes_row(mesh: str, theirs: np.ndarray, own: np.ndarray, change: float = math.nan) -> tuple[str, ...]:
    changed = "" if math.isnan(change) else f"{change:.1e}"
    difference = f"{np.abs(theirs / own - 1).max():.1e}"
    return "", "", f"{pybmodes.NAME}, {mesh}", *map(hertz, theirs), changed, difference


def hertz(frequency: float) -> str:
    return f"{frequency:.6f}"


# CalculiX -----------------------------------------------------------------------------------------

BLADES = {
    "0, clamped": Blade(),
    "0, clamped, no taper": Blade(tapered=False),
    "0.3, clamped": Blade(0.3),
    "0.3, held axially": Blade(0.3, HELD_AXIALLY),
}


def tapered_rows() -> Iterator[tuple[str, ...]]:
    """Yield differences in frequency between solid and beam for each blade and speed."""
    if calculix.version() is None:
        yield "", "", f"{calculix.NAME} {tables.MISSING}", *[""] * 6
        return
    for name, blade in BLADES.items():
        for speed in tapered.SPEEDS:
            first = (name, f"{speed:g}")
            for row in calculix_rows(blade, speed):
                yield *first, *row
                first = ("", "")


def calculix_rows(blade: Blade, speed: float) -> Iterator[tuple[str, ...]]:
    own = tapered.beam_frequencies(tapered.beam(blade), speed)
    yield "frequency of the beam [Hz]", *(f"{frequency:.3f}" for frequency in own)
    solids = [tapered.solid_frequencies(blade, counts, speed) for counts in tapered.MESHES]
    for counts, solid in zip(tapered.MESHES, solids, strict=True):
        yield " x ".join(map(str, counts)), *thousandths(solid, own)
    yield "order of convergence", *orders(solids)
    for name, other in other_beams(blade, speed):
        yield name, *thousandths(solids[-1], other)


def other_beams(blade: Blade, speed: float) -> Iterator[tuple[str, np.ndarray]]:
    """Yield variants of the beam that show the size of each effect."""
    own = tapered.beam(blade)
    if blade.root == CLAMPED:
        yield "slender beam", tapered.beam_frequencies(own, speed, tapered.SLENDER)
    if blade.poissons_ratio == 0 and speed:
        stressed = tapered.with_stress_of_rotation(blade, speed)
        yield "E + stress", tapered.beam_frequencies(stressed, speed)
    if blade.root == HELD_AXIALLY:
        yield "Hutchinson's shear", tapered.beam_frequencies(tapered.with_hutchinsons_shear(blade), speed)


def thousandths(solid: np.ndarray, own: np.ndarray) -> Iterator[str]:
    yield from (f"{1e3 * difference:+.2f}" for difference in solid / own - 1)


def orders(solids: Sequence[np.ndarray]) -> Iterator[str]:
    """Yield the order of convergence from three meshes.

    The order is None if the last change is within the last digit that CalculiX prints.
    """
    first, last = (np.abs(fine / coarse - 1) for coarse, fine in pairwise(solids))
    for before, after in zip(first, last, strict=True):
        yield f"{np.log2(before / after):.1f}" if after > 2e-6 else "converged"


# The page -----------------------------------------------------------------------------------------


def section(twisted_body: Sequence[tuple[str, ...]], tapered_body: Sequence[tuple[str, ...]]) -> str:
    """Write the section of docs/peers.md on two planes, twist and shear."""
    versions = f"{OURS} {ours.version()}, {tables.versions((pybmodes, calculix))}"
    width, thickness = (f"{root:g} to {tip:g} m" for root, tip in (tapered.WIDTH, tapered.THICKNESS))
    ratio = tapered.WIDTH[0] / tapered.THICKNESS[0]
    parts = (
        page.HEADING,
        INTRODUCTION.format(day=date.today(), versions=versions),
        TWISTED.format(converged=twisted.CONVERGED) + "\n" + markdown_table(TWISTED_HEAD, twisted_body),
        TAPERED.format(width=width, thickness=thickness),
        "\n" + markdown_table(TAPERED_HEAD, tapered_body),
        NOTES.format(flap=tapered.hutchinson(ratio, 0.3)),
    )
    return "".join(parts)


if __name__ == "__main__":
    tables_of_section = ((TWISTED_HEAD, twisted_rows()), (TAPERED_HEAD, tapered_rows()))
    page.write_section(section(*(show_table(*each) for each in tables_of_section)))
