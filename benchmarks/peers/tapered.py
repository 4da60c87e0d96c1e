"""A short tapered steel blade: CalculiX's solid elements against a beam with shear and rotary inertia.

The blade is ten times longer than wide and points outward; x runs along it from the root, y across the
thickness (along the axis of rotation), z across the width.
"""

from __future__ import annotations

import math
import re
import subprocess
from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import dropwhile, product, takewhile
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.scene.profile import to_profile
from benchmarks.peers import hexahedra
from benchmarks.peers.hexahedra import Place

# Length [m], hub radius [m], modulus [Pa], density [kg/m3].
LENGTH, HUB, YOUNGS_MODULUS, DENSITY = 1.0, 0.1, 210e9, 7850.0
WIDTH, THICKNESS = (0.1, 0.06), (0.02, 0.01)  # width and thickness [m], each at the root and at the tip
SPEEDS = (0.0, 200.0)  # speeds [rad/s]
# Numbers of elements along the blade, its thickness and its width.
MESHES = ((20, 1, 2), (40, 2, 4), (80, 4, 8))
MODES = 14  # number of modes, which include the first three of both directions
CLAMPED, HELD_AXIALLY = "clamped", "held axially"
DECK = """*NODE
{nodes}
*ELEMENT, TYPE=C3D20R, ELSET=BLADE
{elements}
*NSET, NSET=ROOT
{root_nodes}
{root}
*MATERIAL, NAME=STEEL
*ELASTIC
{youngs_modulus:g}, {poissons_ratio:g}
*DENSITY
{density:g}
*SOLID SECTION, ELSET=BLADE, MATERIAL=STEEL
{static}*FREQUENCY
{modes}
*END STEP
"""
AT_REST = "*STEP\n"
TURNING = """*STEP, NLGEOM
*STATIC
*DLOAD
BLADE, CENTRIF, {speed_squared:.12g}, {axis:g}, 0, 0, 0, 1, 0
*END STEP
*STEP, PERTURBATION
"""


@dataclass(frozen=True)
class Blade:
    """A blade, and the support of the solid's root face.

    Parameters
    ----------
    poissons_ratio : float
        Poisson's ratio of the material.
    root : str
        `CLAMPED`: every node of the face.  `HELD_AXIALLY`: every node along the beam only, across it the
        mean of the face, so that the face may contract.
    tapered : bool
        Whether the blade tapers; otherwise its section is everywhere that at the middle.
    """

    poissons_ratio: float = 0.0
    root: str = CLAMPED
    tapered: bool = True

    def width(self) -> Polynomial:
        """Width [m] over x/L."""
        return self._along(WIDTH)

    def thickness(self) -> Polynomial:
        """Thickness [m] over x/L."""
        return self._along(THICKNESS)

    def _along(self, ends: tuple[float, float]) -> Polynomial:
        root, tip = ends
        return Polynomial([root, tip - root]) if self.tapered else Polynomial([(root + tip) / 2])


# CalculiX -----------------------------------------------------------------------------------------


def solid_frequencies(blade: Blade, counts: tuple[int, int, int], speed: float) -> np.ndarray:
    """Compute the first three frequencies of flap, then of edge [Hz], shape (6,)."""
    with TemporaryDirectory() as folder:
        Path(folder, "blade.inp").write_text(deck(blade, counts, speed))
        subprocess.run(["ccx", "-i", "blade"], cwd=folder, capture_output=True)
        return sorted_by_direction(Path(folder, "blade.dat").read_text())


def deck(blade: Blade, counts: tuple[int, int, int], speed: float) -> str:
    """Return CalculiX' input file; spin softening is included, the Coriolis force is not."""
    number = hexahedra.numbers(counts)
    root_nodes = "\n".join(f"{n}," for place, n in number.items() if place[0] == 0)
    return DECK.format(
        nodes="\n".join(node_lines(blade, counts, number)),
        elements="\n".join(hexahedra.elements(counts, number)),
        root_nodes=root_nodes,
        root="\n".join(root_lines(blade.root, counts, number)),
        youngs_modulus=YOUNGS_MODULUS,
        poissons_ratio=blade.poissons_ratio,
        density=DENSITY,
        static=TURNING.format(speed_squared=speed**2, axis=-HUB) if speed else AT_REST,
        modes=MODES,
    )


def node_lines(blade: Blade, counts: tuple[int, int, int], number: dict[Place, int]) -> Iterator[str]:
    """Yield number and coordinates [m] of each node."""
    width, thickness = blade.width(), blade.thickness()
    for place, n in number.items():
        xi, eta, zeta = (step / (2 * count) for step, count in zip(place, counts, strict=True))
        y, z = (eta - 0.5) * thickness(xi), (zeta - 0.5) * width(xi)
        yield f"{n}, {xi * LENGTH:.12g}, {y:.12g}, {z:.12g}"


def root_lines(root: str, counts: tuple[int, int, int], number: dict[Place, int]) -> Iterator[str]:
    """Yield the input lines that support the root face."""
    yield "*BOUNDARY"
    if root == CLAMPED:
        yield "ROOT, 1, 3"
        return
    yield "ROOT, 1, 1"
    along, across = counts[1:]
    yield from mean_is_zero(3, product(range(along), range(across)), number)
    for half in (range(across // 2), range(across // 2, across)):  # halves: the face cannot rotate
        yield from mean_is_zero(2, product(range(along), half), number)


def mean_is_zero(direction: int, faces: Iterator[tuple[int, int]], number: dict[Place, int]) -> Iterator[str]:
    """Yield a constraint: the mean displacement over faces of elements of the root is zero.

    The integral of a shape function over a face is -1/12 of its area at a corner and 1/3 at a middle.  The
    first node of a constraint must not be the first of another: a middle inside each half of the face is.
    """
    weight: dict[Place, float] = {}
    for (b, c), (j, k) in product(faces, product(range(3), repeat=2)):
        place = (0, 2 * b + j, 2 * c + k)
        if place in number:
            weight[place] = weight.get(place, 0.0) + (1 / 3 if j % 2 or k % 2 else -1 / 12)
    ordered = sorted(weight, key=lambda place: (place[2] % 2 == 0, place))
    yield f"*EQUATION\n{len(ordered)}"
    yield from (f"{number[place]}, {direction}, {weight[place]:.12g}" for place in ordered)


_OF_A_MODE = re.compile(r"\s+\d+\s+\S+E[+-]\d+\s")


def rows(text: str, title: str) -> np.ndarray:
    """Read rows of numbers below a title of a .dat file, one for each mode."""
    lines = text.partition(title)[2].splitlines()
    own = takewhile(_OF_A_MODE.match, dropwhile(lambda line: not _OF_A_MODE.match(line), lines))
    return np.array([line.split() for line in own], dtype=float)


def sorted_by_direction(text: str) -> np.ndarray:
    """Return the first three frequencies of flap, then of edge [Hz]; torsion has no direction."""
    modes = rows(text, "E I G E N V A L U E   O U T P U T")
    if not len(modes):
        raise ValueError("the .dat file has no frequency: the static step did not converge")
    taking_part = np.abs(rows(text, "P A R T I C I P A T I O N   F A C T O R S")[:, 1:4])
    bending = taking_part.max(axis=1) > 1e-2 * taking_part.max()
    frequency, direction = modes[bending, 3], taking_part[bending].argmax(axis=1)
    return np.concatenate([frequency[direction == axis][:3] for axis in (1, 2)])


# beamdyn ------------------------------------------------------------------------------------------

THICK = bd.Physics(planes=2, shear=True, rotary_inertia=True)
SLENDER = bd.Physics(planes=2)


def beam(blade: Blade) -> bd.Beam:
    """Build the beam model of the blade, with Cowper's shear coefficient."""
    return bd.Beam.rectangular(
        length=LENGTH,
        width=blade.width(),
        thickness=blade.thickness(),
        youngs_modulus=YOUNGS_MODULUS,
        density=DENSITY,
        poissons_ratio=blade.poissons_ratio,
    )


def with_hutchinsons_shear(blade: Blade) -> bd.Beam:
    """Build the beam model with Hutchinson's shear coefficients for the section at the root."""
    nu, own = blade.poissons_ratio, beam(blade)
    cowper = 10 * (1 + nu) / (12 + 11 * nu)
    ratio = float(blade.width()(0) / blade.thickness()(0))
    flap, edge = hutchinson(ratio, nu), hutchinson(1 / ratio, nu)
    assert own.shear_stiffness is not None and own.second_shear_stiffness is not None
    return replace(
        own,
        shear_stiffness=own.shear_stiffness.scaled(flap / cowper),
        second_shear_stiffness=own.second_shear_stiffness.scaled(edge / cowper),
    )


def with_stress_of_rotation(blade: Blade, speed: float) -> bd.Beam:
    """Build the beam model with the axial stress by rotation added to E in bending, as in a solid."""
    own, width, thickness = beam(blade), blade.width(), blade.thickness()
    moment = (width * thickness * Polynomial([HUB, LENGTH])).integ()
    tension = DENSITY * speed**2 * LENGTH * (moment(1.0) - moment)
    assert own.second_bending_stiffness is not None
    flap, edge = (to_profile("stress", tension * size**2 / 12) for size in (thickness, width))
    return replace(
        own,
        bending_stiffness=own.bending_stiffness + flap,
        second_bending_stiffness=own.second_bending_stiffness + edge,
    )


def hutchinson(ratio: float, nu: float) -> float:
    """Compute Hutchinson's shear coefficient of a rectangle (2001), doi:10.1115/1.1349417.

    `ratio` is width (across the shear force) over depth.  The coefficient includes the lateral contraction of
    wide sections: above a ratio of 5.6 (at nu = 0.3) its inverse is negative, as if shear stiffened the beam.
    """
    n = np.pi * np.arange(1, 200)
    series = np.sum(16 * nu**2 * ratio**5 * (n - ratio * np.tanh(n / ratio)) / (n**5 * (1 + nu)))
    c4 = 4 / 45 * ratio * (-12 - 15 * nu + 5 * nu * ratio**2) + series
    return float(-2 * (1 + nu) / (9 / (4 * ratio) * c4 + nu * (1 - ratio**2)))


def beam_frequencies(own: bd.Beam, speed: float, physics: bd.Physics = THICK) -> np.ndarray:
    """Compute the first three frequencies of flap, then of edge [Hz], shape (6,)."""
    scene = bd.Scene(own, bd.Mount(HUB, math.pi, math.pi / 2), physics=physics)
    modes = bd.natural_modes(scene, speed, MODES)
    flap = modes.plane_share[:, 0] > 0.5
    return np.concatenate([modes.frequency[flap][:3], modes.frequency[~flap][:3]])
