"""The strip of Epps and Chandra (1996), straight and swept by 15 deg: ratios of frequencies, beam and solid.

Run: python -m benchmarks.peers.swept [--elements 75].  CalculiX solves the strips by elements C3D20R about
the static state under rotation.  Compared is the ratio of each frequency of the swept strip to that of the
straight strip, at rest and at 750 rpm, so that effects of clamp and camber on both strips cancel.  The solids
have no Coriolis force.
"""

from __future__ import annotations

import argparse
import math
import subprocess
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

import beamdyn as bd
from benchmarks.peers import hexahedra
from benchmarks.peers.bent import without_coriolis
from benchmarks.peers.solids import AT_REST, DECK, TURNING
from benchmarks.peers.tapered import rows
from benchmarks.rows import Row, show

INCH = 0.0254
STRAIGHT, SWEPT, WIDTH, THICKNESS, RADIUS = (INCH * size for size in (31.5, 6.0, 1.0, 0.063, 2.5))
MODULUS, DENSITY, POISSON = 73.0844e9, 2682.41, 0.325
SPEEDS, SWEEP = (0.0, 750 * math.pi / 30), math.radians(15.0)
ACROSS, COMPARED, BOUND = (1, 4), 6, 0.02


def solid_frequencies(sweep: float, speed: float, elements: int) -> np.ndarray:
    """Compute the lowest frequencies [Hz] of the strip as a solid, also of motions across the width."""
    counts = (elements, *ACROSS)
    number = hexahedra.numbers(counts)
    of_root = [n for place, n in number.items() if place[0] == 0]
    turning = TURNING.format(speed_squared=speed**2, axis=-RADIUS, y=1.0, z=0.0)
    deck = DECK.format(
        nodes="\n".join(_node_lines(sweep, counts, number)),
        elements="\n".join(hexahedra.elements(counts, number)),
        root="\n".join(f"{n}," for n in of_root),
        lines=f"{of_root[0]},",
        youngs_modulus=MODULUS,
        poissons_ratio=POISSON,
        density=DENSITY,
        static=turning if speed else AT_REST,
        modes=COMPARED + 4,
    )
    with TemporaryDirectory() as folder:
        Path(folder, "strip.inp").write_text(deck)
        subprocess.run(["ccx", "-i", "strip"], cwd=folder, capture_output=True, check=True)
        return rows(Path(folder, "strip.dat").read_text(), "(RAD/TIME)")[:COMPARED, -2]


def _node_lines(
    sweep: float, counts: tuple[int, int, int], number: dict[hexahedra.Place, int]
) -> Iterator[str]:
    """Yield number and coordinates [m] of each node: x along the root, y thickness, z width."""
    for place, n in number.items():
        xi, eta, zeta = (step / (2 * count) for step, count in zip(place, counts, strict=True))
        s, y, across = xi * (STRAIGHT + SWEPT), (eta - 0.5) * THICKNESS, (zeta - 0.5) * WIDTH
        beyond = s - STRAIGHT
        if abs(beyond) < 1e-9:  # the section at the kink lies on the bisector of the angle
            x, z = STRAIGHT - across * math.tan(sweep / 2), across
        elif beyond < 0:
            x, z = s, across
        else:
            x = STRAIGHT + beyond * math.cos(sweep) - across * math.sin(sweep)
            z = beyond * math.sin(sweep) + across * math.cos(sweep)
        yield f"{n}, {x:.12g}, {y:.12g}, {z:.12g}"


def beam_frequencies(sweep: float, speed: float) -> np.ndarray:
    """Compute the frequencies [Hz] of the strip as a beam in space, without the Coriolis force."""
    kink = STRAIGHT / (STRAIGHT + SWEPT)
    angle = bd.Table([0.0, kink, kink, 1.0], [0.0, 0.0, sweep, sweep])
    beam = bd.Beam.rectangular(
        STRAIGHT + SWEPT, WIDTH, THICKNESS, MODULUS, DENSITY, poissons_ratio=POISSON, sweep=angle
    )
    physics = bd.Physics(2, shear=True, rotary_inertia=True, torsion=True, large_deflection=True)
    scene = bd.Scene(beam, bd.Mount(RADIUS, math.pi, math.pi / 2), physics=physics)
    return without_coriolis(bd.natural_modes(scene, speed, COMPARED, bd.Ritz(9)))


def measure(elements: int) -> Iterator[Row]:
    """Yield the ratios of the beam and of the solid, and their difference."""
    for speed in SPEEDS:
        ours, theirs = (
            solve(SWEEP) / solve(0.0)
            for solve in (
                lambda sweep, speed=speed: beam_frequencies(sweep, speed),
                lambda sweep, speed=speed: solid_frequencies(sweep, speed, elements),
            )
        )
        for mode, (own, solid) in enumerate(zip(ours, theirs, strict=True), 1):
            what = f"{speed * 30 / math.pi:.0f} rpm, mode {mode}: ratio of 15 deg to 0, beam and solid"
            yield what, f"{own:.4f}, {solid:.4f}: {own / solid - 1:+.2%}", f"{BOUND:.0%}"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--elements", type=int, default=75, help="along the strip; a multiple of 25")
    elements = parser.parse_args().elements
    show("a strip swept at its tip beside solids", lambda: measure(elements))


if __name__ == "__main__":
    main()
