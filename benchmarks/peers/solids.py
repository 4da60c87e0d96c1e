"""Random rectangular cantilevers as solid bodies: CalculiX, elements C3D20R, extrapolated over three meshes.

x runs along the strip from its root, y across its thickness (the direction in which the beam bends), z across
its width.  The root face is fixed in all directions.  A static step with large displacements under the
centrifugal load precedes the frequency step about this state: static stress and spin softening are included,
Coriolis forces are not.
"""

from __future__ import annotations

import math
import re
import subprocess
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
from scipy.optimize import linear_sum_assignment

import beamdyn as bd
from benchmarks.peers import hexahedra
from benchmarks.peers.tapered import rows

Counts = tuple[int, int, int]  # numbers of elements along x, y, z

BENDING, TORSION, CAMBER, OTHER, STRETCH = "bending", "torsion", "camber", "other direction", "stretch"
KINDS = (BENDING, TORSION, CAMBER, OTHER, STRETCH)
MODES = 12  # number of requested modes
_TOWARDS_ROOT, _TOWARDS_EDGES = 2.0, 1.5  # exponents of grading of the mesh towards clamp and corners
# Ratios of width to thickness: above the first, one element through the thickness; above the second, two.
_THIN, _THICK = 25.0, 6.0
# Length over thickness above which a strip is replaced by a thicker one, and the ratio of that one.
_SLENDEREST, _THICKENED = 900.0, 600.0
_MOST_STRAIN = 2e-3  # largest strain due to rotation at the root, which steel can bear
_ORDERS = 0.8, 4.0  # least and largest plausible order of convergence
_LEAST_ERROR = 2e-5  # least estimated relative error of a frequency; smaller estimates were found to be wrong
_LONGEST = 900.0  # time limit of one mesh [s]
_OVERLAP = 0.5  # overlap of two mode shapes on two meshes above which they are the same mode
DECK = """*NODE, NSET=ALL
{nodes}
*ELEMENT, TYPE=C3D20R, ELSET=STRIP
{elements}
*NSET, NSET=ROOT
{root}
*NSET, NSET=LINES
{lines}
*BOUNDARY
ROOT, 1, 3
*MATERIAL, NAME=STEEL
*ELASTIC
{youngs_modulus:.12g}, {poissons_ratio:.12g}
*DENSITY
{density:.12g}
*SOLID SECTION, ELSET=STRIP, MATERIAL=STEEL
{static}*FREQUENCY
{modes}
*NODE PRINT, NSET=LINES
U
*END STEP
"""
AT_REST = "*STEP\n"
TURNING = """*STEP, NLGEOM
*STATIC
*DLOAD
STRIP, CENTRIF, {speed_squared:.12g}, {axis:.12g}, 0, 0, 0, {y:.12g}, {z:.12g}
*END STEP
*STEP, PERTURBATION
"""


@dataclass(frozen=True)
class Strip:
    """A cantilever of rectangular section that rotates; lengths in m, angles in degrees.

    Parameters
    ----------
    setting_angle : float
        0 (the strip points inward) or 180 (outward).
    bending_angle : float
        Angle of the thickness direction out of the plane of rotation.
    taper : callable, optional
        Function of x/L: factors of thickness and width of a tapered strip.
    """

    length: float
    width: float
    thickness: float
    youngs_modulus: float  # [Pa]
    density: float  # [kg/m3]
    poissons_ratio: float
    radius: float = 0.0  # distance from the axis of rotation to the root [m]
    setting_angle: float = 0.0
    bending_angle: float = 0.0
    speed: float = 0.0  # [rad/s]
    taper: Callable[[float], tuple[float, float]] | None = None

    def scene(self, physics: bd.Physics | None = None) -> bd.Scene:
        """Build the scene of the strip as a beam; with default physics, the slender beam."""
        beam = bd.Beam.rectangular(
            *(self.length, self.width, self.thickness, self.youngs_modulus, self.density),
            poissons_ratio=self.poissons_ratio,
        )
        mount = bd.Mount(self.radius, math.radians(self.setting_angle), math.radians(self.bending_angle))
        return bd.Scene(beam, mount, physics=physics or bd.Physics())

    def time_unit(self) -> float:
        """Unit of time [s] in which speeds and frequencies have no dimension: root of rho A L^4 / EI."""
        return self.length**2 / self.thickness * math.sqrt(12 * self.density / self.youngs_modulus)


def random_strip(rng: np.random.Generator) -> Strip:
    """Draw a strip: at rest (a third), inward below 0.9 of the critical speed, or outward to gamma 5.

    The speed is limited by the strain that steel bears, so that short and thick strips rotate more slowly.
    """
    length = _rounded(10 ** rng.uniform(-1.5, 0))
    width = _rounded(length / 10 ** rng.uniform(math.log10(2.5), math.log10(50)))
    thickness = _rounded(width / 10 ** rng.uniform(0, 2))
    drawn = rng.uniform(190e9, 215e9), rng.uniform(7700, 8000), rng.uniform(0, 0.45)
    modulus, density, nu = map(_rounded, drawn)
    motion, share = rng.integers(3), rng.uniform()
    radius = _rounded(length * 10 ** (rng.uniform(0.1, 1) if motion == 1 else rng.uniform(-1, 0.7)))
    angles = 0.0 if motion == 1 else 180.0, float(rng.choice([0.0, 30.0, 90.0]))
    strip = Strip(length, width, thickness, modulus, density, nu, radius, *angles)
    if motion == 0:
        return strip
    middle = radius - length / 2 if motion == 1 else radius + length / 2
    most = math.sqrt(_MOST_STRAIN * modulus / (density * length * middle))
    fastest = 0.9 * bd.critical_speed(strip.scene()) if motion == 1 else 5 / strip.time_unit()
    return replace(strip, speed=_rounded(share * min(fastest, most)))


def _rounded(value: float) -> float:
    """Round to six digits, as in the file of references."""
    return float(f"{value:.6g}")


# Solids -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Mode:
    """A mode on one mesh: its frequency [Hz] and its displacements, of shape (points along, lines, 3)."""

    frequency: float
    shape: np.ndarray

    @property
    def shares(self) -> np.ndarray:
        """Fraction of each of `KINDS` in the squared displacements of the mid-surface."""
        u, v, w = np.moveaxis(self.shape, 2, 0)
        # Weights that give the coefficients of Legendre polynomials across the width.
        weights = [1 / 6, 2 / 3, 1 / 6], [-0.5, 0, 0.5], [1 / 3, -2 / 3, 1 / 3]
        mean, odd, even = (v @ each for each in weights)
        parts = mean, odd / math.sqrt(3), even / math.sqrt(5), w.mean(axis=1), u.mean(axis=1)
        squares = np.array([part @ part for part in parts])
        return squares / squares.sum()

    @property
    def kind(self) -> str:
        """Kind of the mode: the one with the greatest fraction."""
        return KINDS[int(self.shares.argmax())]


def meshes(strip: Strip) -> tuple[Counts, Counts, Counts]:
    """Return three meshes, each twice as fine as the previous one, except through a thin strip."""
    ratio = strip.width / strip.thickness
    if ratio > _THIN:
        along, through, across = 8, (1, 1, 1), 4
    elif ratio > _THICK:
        along, through, across = 8, (2, 2, 2), 2
    else:
        along, through, across = 6, (1, 2, 4), 2
    coarse, medium, fine = (
        (along * n, count, across * n) for n, count in zip((1, 2, 4), through, strict=True)
    )
    return coarse, medium, fine


def solid_modes(strip: Strip, counts: Counts, modes: int = MODES) -> list[Mode]:
    """Compute modes of the solid on one mesh, in ascending order of frequency."""
    with TemporaryDirectory() as folder:
        Path(folder, "strip.inp").write_text(deck(strip, counts, modes))
        subprocess.run(["ccx", "-i", "strip"], cwd=folder, capture_output=True, timeout=_LONGEST)
        return read_modes(Path(folder, "strip.dat").read_text())


def deck(strip: Strip, counts: Counts, modes: int = MODES) -> str:
    """Return the text of CalculiX' input file for a mesh."""
    number = hexahedra.numbers(counts)
    sides = coordinates(strip, counts)
    points = (
        (n, *_tapered(strip, *(side[step] for side, step in zip(sides, place, strict=True))))
        for place, n in number.items()
    )
    psi = math.radians(strip.bending_angle)
    inward = strip.setting_angle == 0
    static = TURNING.format(
        speed_squared=strip.speed**2,
        axis=strip.radius if inward else -strip.radius,
        y=math.sin(psi),
        z=math.cos(psi),
    )
    return DECK.format(
        nodes="\n".join(f"{n}, {x:.12g}, {y:.12g}, {z:.12g}" for n, x, y, z in points),
        elements="\n".join(hexahedra.elements(counts, number)),
        root="\n".join(f"{n}," for place, n in number.items() if place[0] == 0),
        lines="\n".join(f"{n}," for n in line_nodes(counts, number)),
        static=static if strip.speed else AT_REST,
        modes=modes,
        youngs_modulus=strip.youngs_modulus,
        poissons_ratio=strip.poissons_ratio,
        density=strip.density,
    )


def _tapered(strip: Strip, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Map a position in the strip of constant section to the tapered strip."""
    if strip.taper is None:
        return x, y, z
    thicker, wider = strip.taper(x / strip.length)
    return x, y * thicker, z * wider


def coordinates(strip: Strip, counts: Counts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return positions [m] of nodes along x, y, z, at steps of half an element."""
    along, through, across = (np.linspace(0, 1, count + 1) for count in counts)
    side = 2 * across - 1
    corners = (
        strip.length * along**_TOWARDS_ROOT,
        strip.thickness * (through - 0.5),
        strip.width / 2 * np.sign(side) * (1 - (1 - np.abs(side)) ** _TOWARDS_EDGES),
    )
    x, y, z = (
        np.interp(np.arange(2 * count + 1) / 2, np.arange(count + 1), places)
        for count, places in zip(counts, corners, strict=True)
    )
    return x, y, z


def line_nodes(counts: Counts, number: dict[hexahedra.Place, int]) -> list[int]:
    """Return the mid-surface nodes along both edges and between them, without nodes at the root."""
    along, through, across = counts
    if across % 2:
        raise ValueError("an even number of elements across has nodes in the middle")
    return [number[2 * i, through, k] for i in range(1, along + 1) for k in (0, across, 2 * across)]


def read_modes(text: str) -> list[Mode]:
    """Read the modes of a .dat file."""
    values = rows(text, "E I G E N V A L U E   O U T P U T")
    if not len(values):
        raise ValueError("the .dat file has no frequency: the static step did not converge")
    # Fortran writes exponents of three digits without the letter E.
    text = re.sub(r"(?<=\d)-(?=\d{3}\b)", "E-", text)
    blocks = re.split(r"displacements \(vx,vy,vz\) for set LINES.*\n", text)[1:]
    lines = [[line.split() for line in block.strip().partition("\n\n")[0].splitlines()] for block in blocks]
    shapes = np.array(lines, dtype=float)[:, :, 1:].reshape(len(blocks), -1, 3, 3)
    return [Mode(f, shape) for f, shape in zip(values[:, 3].tolist(), shapes, strict=True)]


# Reference ----------------------------------------------------------------------------------------


@dataclass(frozen=True)
class SolidMode:
    """A mode of the solid body.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    number : int
        Number of the mode within its kind, from 1.
    frequency : float
        Extrapolated frequency [Hz].
    error : float
        Estimated relative error of the extrapolated frequency.
    by_mesh : tuple of float
        Frequencies of the three meshes [Hz], from the coarsest.
    share : float
        Fraction of the kind in the squared displacements.
    """

    kind: str
    number: int
    frequency: float
    error: float
    by_mesh: tuple[float, ...]
    share: float


def reference(strip: Strip, counts: Sequence[Counts] = (), modes: int = MODES) -> list[SolidMode]:
    """Compute modes of the strip as a solid body, extrapolated from three meshes, in ascending order."""
    body = thickened(strip)
    counts = counts or meshes(body)
    *coarser, finest = (solid_modes(body, each, modes) for each in counts)
    paired = [pair(each, finest) for each in coarser]
    found: list[SolidMode] = []
    for k, mode in enumerate(finest):
        before = [each[partner[k]].frequency for each, (partner, _) in zip(coarser, paired, strict=True)]
        by_mesh = (*before, mode.frequency)
        frequency, error = extrapolate(by_mesh)
        if min(overlap[k] for _, overlap in paired) < _OVERLAP:
            frequency, error = mode.frequency, float(np.ptp(by_mesh)) / mode.frequency
        if counts[0][1] == counts[-1][1]:
            error += error_through_thickness(body, mode.kind, counts[0][1])
        error += error_by_rounding(body, mode.frequency)
        factor, uncertain = thinner(strip, body, mode.kind)
        number = 1 + sum(other.kind == mode.kind for other in finest[:k])
        scaled = (*(factor * each for each in by_mesh),)
        share = float(mode.shares.max())
        found.append(SolidMode(mode.kind, number, factor * frequency, error + uncertain, scaled, share))
    return sorted(found, key=lambda mode: mode.frequency)


def thickened(strip: Strip) -> Strip:
    """Return the strip, or for a very slender one a thicker strip of smaller modulus with similar modes.

    The ratio of thickness to length changes bending and torsion by less than rounding errors do in a mesh of
    the slender strip: 3e-4 of the first frequency at length/thickness 1000, 5e-3 at 2500.
    """
    if strip.length < _SLENDEREST * strip.thickness:
        return strip
    thickness = strip.length / _THICKENED
    modulus = strip.youngs_modulus * (strip.thickness / thickness) ** 2
    return replace(strip, thickness=thickness, youngs_modulus=modulus)


def thinner(strip: Strip, body: Strip, kind: str) -> tuple[float, float]:
    """Return the ratio of the strip's frequency to the thickened strip's, and its relative error."""
    if body == strip:
        return 1.0, 0.0
    by_thickness = 0.05 / _THICKENED
    if kind in (BENDING, CAMBER):
        return 1.0, by_thickness
    if kind == TORSION:
        factor = math.sqrt(twist_factor(strip) / twist_factor(body))
        return factor, by_thickness + abs(factor - 1) / 2
    return body.thickness / strip.thickness, by_thickness + (0.02 if strip.speed else 0.0)


def twist_factor(strip: Strip) -> float:
    """Compute the torsional constant over width thickness^3 / 3, by Timoshenko and Goodier's series."""
    ratio, n = strip.width / strip.thickness, np.arange(1, 100, 2)
    return float(1 - 192 / np.pi**5 / ratio * np.sum(np.tanh(n * np.pi * ratio / 2) / n**5))


def error_by_rounding(strip: Strip, frequency: float) -> float:
    """Estimate the relative error of a frequency by rounding in CalculiX, from measurements."""
    first = 3.516 / (2 * math.pi * strip.time_unit())  # first frequency of the beam at rest
    return 3e-4 * (strip.length / (1000 * strip.thickness)) ** 4 * (first / frequency) ** 2


def error_through_thickness(strip: Strip, kind: str, count: int) -> float:
    """Estimate the relative error that one or two elements through the thickness leave on any mesh.

    Fitted from above to solutions with more of them: width/thickness 4 to 100, length/width 2.5 to 50, nu 0.3
    and 0.45.  The clamp, whose corners the elements do not resolve, counts for bending; the stress near the
    edges for torsion.
    """
    over_length, over_width = strip.thickness / strip.length, strip.thickness / strip.width
    if kind == TORSION:
        error = 0.03 * over_width
    elif kind in (BENDING, CAMBER):
        error = (0.002 + 0.8 * strip.poissons_ratio**3) * over_length
    else:
        error = (0.01 + 1.7 * strip.poissons_ratio**3) * over_length
    return error if count == 1 else error / 10


def pair(coarse: Sequence[Mode], fine: Sequence[Mode]) -> tuple[np.ndarray, np.ndarray]:
    """Find for each mode of a fine mesh the same mode of a coarse mesh, by kind and shape, with overlap."""
    step = len(fine[0].shape) // len(coarse[0].shape)
    shapes = (
        np.array([mode.shape[every - 1 :: every].ravel() for mode in each])
        for each, every in ((fine, step), (coarse, 1))
    )
    a, b = (each / np.linalg.norm(each, axis=1, keepdims=True) for each in shapes)
    overlap = np.abs(a @ b.T)
    alike = np.array([[one.kind == other.kind for other in coarse] for one in fine])
    own, partner = linear_sum_assignment(-overlap - alike)
    return partner, overlap[own, partner]


def extrapolate(by_mesh: Sequence[float]) -> tuple[float, float]:
    """Extrapolate three values, each on a mesh twice as fine as the last; return also the relative error.

    The order of convergence is the observed one, within bounds.  The error is half of the extrapolated
    correction if the order is within the bounds, the whole correction if convergence is slower, and three
    times the correction if it is faster than that of the elements (the coarsest mesh is then unreliable).  If
    the differences change sign, the finest value is returned.
    """
    before, last = (b - a for a, b in pairwise(by_mesh))
    finest = by_mesh[-1]
    if before * last <= 0:
        return finest, max(abs(before), abs(last)) / finest + _LEAST_ERROR
    ratio, (least, most) = before / last, (2.0**order for order in _ORDERS)
    beyond = last / (min(max(ratio, least), most) - 1)
    factor = 1.0 if ratio < least else 3.0 if ratio > most else 0.5
    return finest + beyond, factor * abs(beyond) / finest + _LEAST_ERROR
