"""Random rectangular cantilevers as solid bodies: CalculiX, elements C3D20R, extrapolated over three meshes.

x runs along the strip from its root, y across its thickness (the direction in which the beam bends), z across
its width.  The root face is held in all directions.  A static step with large displacements under the load of
rotation precedes the frequencies, which are those of a perturbation of it: stress and softening by rotation
count, Coriolis forces do not.
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
MODES = 12  # number of modes that are asked for
_TOWARDS_ROOT, _TOWARDS_EDGES = 2.0, 1.5  # powers by which elements shrink towards the clamp and its corners
# Width over thickness: above the first one element through the thickness, above the second two on all meshes.
_THIN, _THICK = 25.0, 6.0
# Length over thickness above which a strip is replaced, and that of its replacement.
_SLENDEREST, _THICKENED = 900.0, 600.0
_MOST_STRAIN = 2e-3  # largest strain by rotation at the root, which steel bears
_ORDERS = 0.8, 4.0  # least and largest order of convergence that is believed
_LEAST_ERROR = 2e-5  # least relative error of a frequency; smaller estimates have failed
_LONGEST = 900.0  # time limit of one mesh [s]
_OVERLAP = 0.5  # overlap of two shapes, above which they are one mode on two meshes
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
        Of the thickness out of the plane of rotation.
    taper : callable, optional
        Thickness and width at x/L over those given; for a strip that is no plain one.
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
        """Make the strip as a beam; plain, if no physics is given."""
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

    Rotation strains it by no more than steel bears, so that short and thick ones turn more slowly than that.
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
    """Round to the six digits that a file of references keeps."""
    return float(f"{value:.6g}")


# Solids -------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Mode:
    """A mode on one mesh: its frequency [Hz] and its displacements, of shape (points along, lines, 3)."""

    frequency: float
    shape: np.ndarray

    @property
    def shares(self) -> np.ndarray:
        """Share of each of `KINDS` in the squared displacements of the mid-surface."""
        u, v, w = np.moveaxis(self.shape, 2, 0)
        # Weights for Legendre polynomials.
        weights = [1 / 6, 2 / 3, 1 / 6], [-0.5, 0, 0.5], [1 / 3, -2 / 3, 1 / 3]
        mean, odd, even = (v @ each for each in weights)
        parts = mean, odd / math.sqrt(3), even / math.sqrt(5), w.mean(axis=1), u.mean(axis=1)
        squares = np.array([part @ part for part in parts])
        return squares / squares.sum()

    @property
    def kind(self) -> str:
        """Kind with the greatest share."""
        return KINDS[int(self.shares.argmax())]


def meshes(strip: Strip) -> tuple[Counts, Counts, Counts]:
    """Return three meshes, each twice as fine as the one before, but alike through a thin strip."""
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
    """Compute modes of the solid on one mesh, from the lowest frequency."""
    with TemporaryDirectory() as folder:
        Path(folder, "strip.inp").write_text(deck(strip, counts, modes))
        subprocess.run(["ccx", "-i", "strip"], cwd=folder, capture_output=True, timeout=_LONGEST)
        return read_modes(Path(folder, "strip.dat").read_text())


def deck(strip: Strip, counts: Counts, modes: int = MODES) -> str:
    """Write the input file of a mesh."""
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
    """Map a place in the strip of constant section to the tapered one."""
    if strip.taper is None:
        return x, y, z
    thicker, wider = strip.taper(x / strip.length)
    return x, y * thicker, z * wider


def coordinates(strip: Strip, counts: Counts) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return places [m] of nodes along x, y, z, in steps of half an element."""
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
    """Return nodes of the mid-surface on both edges and between them, without those of the root."""
    along, through, across = counts
    if across % 2:
        raise ValueError("an even number of elements across has nodes in the middle")
    return [number[2 * i, through, k] for i in range(1, along + 1) for k in (0, across, 2 * across)]


def read_modes(text: str) -> list[Mode]:
    """Read the modes of a .dat file."""
    values = rows(text, "E I G E N V A L U E   O U T P U T")
    if not len(values):
        raise ValueError("the .dat file has no frequency: the static step did not converge")
    # Fortran writes exponents of three digits without a letter.
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
        Within the kind, from 1.
    frequency : float
        Extrapolated [Hz].
    error : float
        Relative, of that frequency: an estimate.
    by_mesh : tuple of float
        Frequencies of the three meshes [Hz], from the coarsest.
    share : float
        Of the kind in the squared displacements.
    """

    kind: str
    number: int
    frequency: float
    error: float
    by_mesh: tuple[float, ...]
    share: float


def reference(strip: Strip, counts: Sequence[Counts] = (), modes: int = MODES) -> list[SolidMode]:
    """Compute modes of the strip as a solid, extrapolated over three meshes, in ascending order."""
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
    """Return the strip, or for a very slender one a thicker one of smaller modulus with like modes.

    What the thickness over the length still changes in bending and torsion is less than what rounding does
    in a mesh of the slender one: 3e-4 of the first frequency at length/thickness 1000, 5e-3 at 2500.
    """
    if strip.length < _SLENDEREST * strip.thickness:
        return strip
    thickness = strip.length / _THICKENED
    modulus = strip.youngs_modulus * (strip.thickness / thickness) ** 2
    return replace(strip, thickness=thickness, youngs_modulus=modulus)


def thinner(strip: Strip, body: Strip, kind: str) -> tuple[float, float]:
    """Return the factor from a thickened strip's frequency to the strip's, and its relative error."""
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
    """Compute the torsion constant over width thickness^3 / 3, by the series of Timoshenko and Goodier."""
    ratio, n = strip.width / strip.thickness, np.arange(1, 100, 2)
    return float(1 - 192 / np.pi**5 / ratio * np.sum(np.tanh(n * np.pi * ratio / 2) / n**5))


def error_by_rounding(strip: Strip, frequency: float) -> float:
    """Estimate the relative error of a frequency by rounding in CalculiX, as measured."""
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
    """Find for each mode of a fine mesh that of a coarse one, by kind and shape, and their overlap."""
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
    """Extrapolate three values, each of a mesh twice as fine as the last; return the relative error, too.

    The order is that observed, within bounds.  The error is half of what is extrapolated, where the order
    lies within them; all of it where convergence is slower, three times that where it is faster than the
    elements' own (the coarsest mesh says little then).  Where the differences change sign, nothing is
    extrapolated.
    """
    before, last = (b - a for a, b in pairwise(by_mesh))
    finest = by_mesh[-1]
    if before * last <= 0:
        return finest, max(abs(before), abs(last)) / finest + _LEAST_ERROR
    ratio, (least, most) = before / last, (2.0**order for order in _ORDERS)
    beyond = last / (min(max(ratio, least), most) - 1)
    factor = 1.0 if ratio < least else 3.0 if ratio > most else 0.5
    return finest + beyond, factor * abs(beyond) / finest + _LEAST_ERROR
