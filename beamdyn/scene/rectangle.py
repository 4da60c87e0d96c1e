"""The rectangular section of a beam, with piezoelectric layers, and the properties that follow from it.

A strip with layers is a plate: its stiffness and coupling differ if sections are held flat across.
Strip and layers are isotropic in their plane, so that the laminate is.  With the curvatures k1 and k2 along
and across, and the voltage v, its moments and charge per area are

    M1 = D11 k1 + D12 k2 - theta v,    M2 = D12 k1 + D11 k2 - theta v,    q = theta (k1 + k2) + C v.

The sum and the difference of the two moments do not couple.  They bend the strip like beams of the moduli
E/(1 - nu) and E/(1 + nu): D11 + D12 and D11 - D12 are the stiffnesses of these beams, each about its own
neutral axis, and the voltage bends only the first beam, by the stress e/(1 - nu).  A section that cambers
freely, M2 = 0, has the bending stiffness D11 - D12^2/D11 and the coupling theta (1 - D12/D11), as a beam has
if strip and layers have one Poisson's ratio, and the capacitance C + theta^2/D11, less than the beam's: the
strip hinders the bending across that a voltage causes.  A section that is held flat, k2 = 0, has D11,
theta and C.

Bending strains a layer unevenly through its thickness t, so that its electric field E varies, too.  As the
electric displacement is constant through the thickness, E = -v/t - e (S - mean of S)/eps, where S is the sum
of the strains in both directions.  This stiffens a layer against bending about its own middle, by
(e^2/eps) t^3/12 in D11 and in D12, whatever the circuit.

References
----------
Laminate: Jones (1999), Mechanics of Composite Materials, chapter 4; docs/harvester.md.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import real, refuse, set_fields, size
from beamdyn.common.numerics import gauss_rule
from beamdyn.common.results.snapshots import ADDED_LATER
from beamdyn.common.words import Words
from beamdyn.scene.names_elsewhere import FROM_STIFFNESS
from beamdyn.scene.profile import ONE, Profile, as_profile, combine

# Reduction of a clamp's stiffening in thick sections compared with a plate, fitted to solids of random
# cantilevers (CalculiX, see `benchmarks.solids`).  With the ratio r of thickness to width, the squared
# Poisson's ratio is multiplied by 1 + a r + b r^2, and the warping constant by 1/(1 + c r^2).
_THICK_CAMBER, _THICK_WARPING = (-0.975, 0.826), 7.0
# Length near the root over which the clamp stiffens bending in the direction of the width, in widths and in
# thicknesses; fitted to solids of random cantilevers.
_REACH_OF_WIDTH, _REACH_OF_THICKNESS = 0.195, 0.54
# Largest length near the root over which the clamp stiffens bending, as a fraction of the length of the beam.
_LONGEST_REACH = 0.7
_POINTS_OF_WARPING, _TERMS_OF_WARPING = 40, 12
_UNCHANGED = 1e-12  # distance of a factor from 1 that is no change: rounding of a product may cause it
# Stiffnesses by which normal strain follows from the loads.
_OF_MODULUS = {"bending_stiffness", "second_bending_stiffness", "axial_stiffness"}
_ZETA_5 = 1.036927755143369926  # 1 + 1/2^5 + 1/3^5 + ...; scipy.special is slow to import
SIDES = {"width": "m", "thickness": "m"}
SECTION_UNITS = SIDES | {"youngs_modulus": "Pa", "density": "kg/m3", "poissons_ratio": ""}


@dataclass(frozen=True)
class Rectangle:
    """A rectangular section of one material along a beam; sides that are constant may be given as numbers.

    Parameters
    ----------
    width, thickness : Profile
        Sides of the section [m]; the beam bends in the direction of its thickness.
    youngs_modulus : float
        Young's modulus [Pa].
    density : float
        Density [kg/m3].
    poissons_ratio : float, optional
        Poisson's ratio, for shear stiffness, camber and torsion; None without these.
    factors : tuple of pairs
        Names of properties that differ from those of the rectangle, and the factors that multiply them.  The
        stiffness of a plate is proportional to the bending stiffness, also in torsion.
    """

    width: Profile
    thickness: Profile
    youngs_modulus: float
    density: float
    poissons_ratio: float | None = None
    factors: tuple[tuple[str, float], ...] = field(default=(), metadata=ADDED_LATER)

    def __post_init__(self) -> None:
        modulus = size("youngs_modulus", self.youngs_modulus, "Pa")
        set_fields(self, youngs_modulus=modulus, density=size("density", self.density, "kg/m3"))
        for name in SIDES:  # the third power of a side, in the bending stiffness, must not overflow
            set_fields(self, **{name: as_profile(name, getattr(self, name), power=3)})

    @cached_property
    def properties(self) -> dict[str, Any]:
        """Compute stiffness, mass and outer fibre of a `Beam` along x/L, by the names of its fields."""
        b, h, e, rho = self.width, self.thickness, self.youngs_modulus, self.density
        area = b * h
        flat, edge = area * h * h, area * b * b
        axial, nu = area.scaled(e), self.poissons_ratio
        shear = None if nu is None else shear_stiffness_of_rectangle(axial, nu)
        made = {
            "mass_per_length": area.scaled(rho),
            "bending_stiffness": flat.scaled(e / 12),
            "axial_stiffness": axial,
            "outer_fibre": h.scaled(0.5),
            "second_bending_stiffness": edge.scaled(e / 12),
            "shear_stiffness": shear,
            "second_shear_stiffness": shear,
            "rotary_inertia": flat.scaled(rho / 12),
            "second_rotary_inertia": edge.scaled(rho / 12),
        }
        for name, factor in self.factors:
            made[name] = made[name].scaled(factor)
        return made

    def scaled(self, name: str, factor: float) -> Rectangle:
        """Multiply a side of the section, or one of its `properties`, by a factor."""
        if name in SIDES:
            return replace(self, **{name: getattr(self, name).scaled(factor)})
        product = factor * dict(self.factors).get(name, 1.0)
        others = tuple(each for each in self.factors if each[0] != name)
        changed = () if abs(product - 1) < _UNCHANGED else ((name, product),)
        return replace(self, factors=others + changed)

    @property
    def modulus_of_stress(self) -> float:
        """Young's modulus by which stress follows from strain [Pa]; nan where a stiffness has a factor.

        The modulus or the shape of the section may be the cause of such a factor.
        """
        return np.nan if _OF_MODULUS & dict(self.factors).keys() else self.youngs_modulus

    @cached_property
    def torsion_factor(self) -> Profile:
        """Torsional constant divided by width thickness^3/3, which it approaches for large width."""
        return combine(_torsion_factor, self.width, self.thickness)[0]

    @cached_property
    def torsion_stiffness(self) -> Profile:
        """Torsional stiffness G J [N m2] of the section (Saint-Venant); Poisson's ratio must be given."""
        assert self.poissons_ratio is not None, "torsion of a rectangle needs Poisson's ratio"
        return self.properties["bending_stiffness"] * self.twist_factor

    @cached_property
    def twist_factor(self) -> Profile:
        """Torsional stiffness G J divided by E I: 4 G/E times `torsion_factor`."""
        return self.torsion_factor.scaled(2 / (1 + (self.poissons_ratio or 0.0)))

    @cached_property
    def ratio(self) -> Profile:
        """Poisson's ratio along the beam; 0 where none is given."""
        return ONE.scaled(self.poissons_ratio or 0.0)

    @cached_property
    def camber_ratio(self) -> Profile:
        """Effective Poisson's ratio for camber, less than Poisson's ratio nu in thick sections.

        The formula nu (1 - 0.975 r + 0.826 r^2)^(1/2), with r = thickness/width, was fitted to solids:
        docs/conventions.md.
        """

        def ratio(b: np.ndarray, t: np.ndarray, nu: np.ndarray) -> np.ndarray:
            r, (linear, quadratic) = t / b, _THICK_CAMBER
            return (nu * np.sqrt(1 + linear * r + quadratic * r**2))[None]

        return combine(ratio, self.width, self.thickness, self.ratio)[0]

    @cached_property
    def camber_stiffening(self) -> Profile:
        """Bending stiffness without camber, divided by that with free camber: 1/(1 - camber_ratio^2)."""
        return combine(lambda nu: 1 / (1 - nu**2)[None], self.camber_ratio)[0]

    @cached_property
    def reach_of_clamp(self) -> float:
        """Length near the root over which the clamp stiffens bending in the direction of the width [m]."""
        b, t = (float(side(np.zeros(1))[0]) for side in (self.width, self.thickness))
        return _REACH_OF_WIDTH * b + _REACH_OF_THICKNESS * t

    def stiffening_across(self, length: float) -> Profile:
        """Compute the stiffness for bending along the width, divided by that far from the clamped root.

        With Poisson's ratio nu it is 1 + nu^2 (1 - x/c)^2 within the clamp's reach c, which follows from the
        sides at the root and is at most 0.7 of the length [m] of the beam.
        """
        nu, reach = self.poissons_ratio or 0.0, min(self.reach_of_clamp / length, _LONGEST_REACH)
        within = tuple(nu**2 * part for part in (1 / 3, -1 / 2, 1 / 6))  # Legendre series of (1 - x/c)^2
        return Profile((0.0, reach, 1.0), ((1 + within[0], *within[1:]), (1.0, 0.0, 0.0)))

    @cached_property
    def warping_factor(self) -> Profile:
        """Warping constant divided by that of a thin section, width^3 thickness^3/144: `_warping_factor`."""
        return combine(_warping_factor, self.width, self.thickness)[0]

    def kinks_of_width(self, length: float) -> np.ndarray:
        """Compute magnitudes of the jumps of the width's slope at inner breakpoints, for a length [m]."""
        left, right = self.width.derivative().end_values()
        return np.abs(left[1:] - right[:-1]) / length

    def sides(self) -> tuple[np.ndarray, np.ndarray]:
        """Return width and thickness (n,) [m] at n positions along the beam, on both sides of breakpoints."""
        ends = np.union1d(self.width.breakpoints, self.thickness.breakpoints)
        xi = np.union1d(np.linspace(0, 1, 257), [*(ends[:-1] + 1e-12), *(ends[1:] - 1e-12)])
        return self.width(xi), self.thickness(xi)

    def check_thickness(self, length: float) -> None:
        """Refuse a thickness that exceeds the length [m] of the beam, or the width anywhere."""
        b, h = self.sides()
        bound, advice = "it exceeds length = {limit}", "are the two swapped, or the units?"
        refuse(h.max() > length, "thickness", h.max(), "m", bound, advice, limit=length)
        bound = "it exceeds width = {limit}, but the beam bends in the direction of its thickness"
        advice = Words("swap the two, or use ", FROM_STIFFNESS, " for a section that is meant so")
        k = int((h > b).argmax())
        refuse(h[k] > b[k], "thickness", h[k], "m", bound, advice, limit=b[k])


def _torsion_factor(b: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Compute 3 J/(b t^3) as a series, for arrays of sides b >= t; the result has a first axis of length 1.

    J is the torsional constant.  With tanh = 1 the terms of the series add up to a multiple of zeta(5); the
    remaining terms decrease as exp(-n pi b/t).
    """
    n = np.arange(1, 16, 2)[:, None, None]
    left = ((1 - np.tanh(n * np.pi * b / (2 * t))) / n**5).sum(axis=0)
    return (1 - 192 / np.pi**5 * t / b * (31 / 32 * _ZETA_5 - left))[None]


def _warping_factor(b: np.ndarray, t: np.ndarray) -> np.ndarray:
    """Compute the warping function's mean square divided by b^2 t^2/144, for arrays of sides b >= t.

    The result has an additional first axis of length 1.  It is divided by 1 + 7 (t/b)^2, which was fitted to
    solids.

    With y along the width and z along the thickness, Saint-Venant's warping function is y z minus
    8 t^2/pi^3 sum over odd n of (-1)^((n-1)/2) sin(n pi z/t) sinh(n pi y/t)/(n^3 cosh(n pi b/2t)).
    """
    s, w = gauss_rule(_POINTS_OF_WARPING)
    y, z = (s[:, None] * b.ravel()[:, None, None] / 2), s * t.ravel()[:, None, None] / 2
    b, t, shape = b.ravel()[:, None, None], t.ravel()[:, None, None], b.shape
    warped = y * z
    for k, n in enumerate(range(1, 2 * _TERMS_OF_WARPING, 2)):
        rising = np.exp(n * np.pi * (np.abs(y) - b / 2) / t) * -np.expm1(-2 * n * np.pi * np.abs(y) / t)
        along = np.sign(y) * rising / (1 + np.exp(-n * np.pi * b / t))
        warped = warped - (-1) ** k * 8 * t**2 / (np.pi * n) ** 3 * np.sin(n * np.pi * z / t) * along
    mean = np.einsum("cyz,y,z->c", warped**2, w / 2, w / 2)
    ratio = (t / b).ravel()
    factor = mean / (b * t).ravel() ** 2 * 144 / (1 + _THICK_WARPING * ratio**2)
    return factor.reshape(shape)[None]


def shear_stiffness_of_rectangle(axial_stiffness: Profile, poissons_ratio: float) -> Profile:
    """Compute shear stiffness kappa G A [N] of rectangles by Cowper (1966) from axial stiffness E A."""
    nu = real("poissons_ratio", poissons_ratio)
    bad, bound = not -1 < nu <= 0.5, "it must be above -1 and at most 0.5"
    refuse(bad, "poissons_ratio", nu, "", bound, "steel has 0.3, rubber 0.5")
    return axial_stiffness.scaled(10 * (1 + nu) / (12 + 11 * nu) / (2 * (1 + nu)))


# Strips with layers ----------------------------------------------------------------------------------


class Material(NamedTuple):
    """Constants of a layer with strain in one direction: c11E [Pa], e31 [C/m2] and eps33S [F/m]."""

    stiffness: float
    coupling: float
    permittivity: float

    def held_across(self, ratio: float) -> Material:
        """Return the constants for equal strains along and across the beam, from Poisson's ratio."""
        coupled = self.coupling**2 / self.stiffness
        permittivity = self.permittivity - coupled * (1 + ratio) / (1 - ratio)
        return Material(self.stiffness / (1 - ratio), self.coupling / (1 - ratio), permittivity)


class Composite(NamedTuple):
    """Integrals of a property over the thickness: sum, centroid, and second moment about the centroid."""

    area: float
    centre: float
    second: float


def composite(inner: float, layer: float, h: float, t: float, sides: int) -> Composite:
    """Integrate over the thickness a property of a strip with layers on 1 or 2 sides.

    It is `inner` in the strip of thickness h, and `layer` in the layers of thickness t each.
    """
    z, area = (h + t) / 2, inner * h + sides * layer * t
    centre = layer * t * z / area if sides == 1 else 0.0
    second = inner * h**3 / 12 + sides * layer * t * (t**2 / 12 + z**2)
    return Composite(area, centre, second - area * centre**2)


@dataclass(frozen=True)
class Laminate(Rectangle):
    """A rectangle with layers over a part of its length, which change its properties as a plate.

    Parameters
    ----------
    along : Profile
        Poisson's ratio over x/L; under the layers the ratio D12/D11 of the plate's bending stiffnesses.
    free : Profile
        Bending stiffness of a section that cambers freely, divided by that of the beam model, which neglects
        that strip and layers have to camber together.
    """

    along: Profile = ONE
    free: Profile = ONE

    @cached_property
    def ratio(self) -> Profile:
        """Poisson's ratio of the strip, effective one under the layers, over x/L."""
        return self.along

    @cached_property
    def twist_factor(self) -> Profile:
        """Torsional stiffness of the plate, divided by E I of the beam."""
        shear = combine(lambda nu, free: (2 * free / (1 + nu))[None], self.along, self.free)[0]
        return self.torsion_factor * shear

    @cached_property
    def camber_stiffening(self) -> Profile:
        """Bending stiffness of the section that cannot camber, divided by that of the beam."""
        return combine(lambda nu, free: (free / (1 - nu**2))[None], self.camber_ratio, self.free)[0]


class Coupled(NamedTuple):
    """Effects of electrodes: bending moment per voltage [N m/V], and capacitance per length [F/m]."""

    moment: float
    capacitance: float


def couple(connection: str, width: float, t: float, arm: float, layer: Material, axial: float) -> Coupled:
    """Compute moment and capacitance of layers by their connection.

    Parameters
    ----------
    connection : {"series", "parallel", "unimorph"}
        Electrical connection of two layers, or "unimorph" for one layer on one side.
    width, t : float
        Width and thickness of a layer [m].
    arm : float
        Distance of a layer's middle from the neutral axis [m].
    layer : Material
        Constants of the layer's material.
    axial : float
        Axial stiffness per width of strip and layers [N/m], against which a voltage on one side stretches
        them; half of it where they stretch in both directions alike.
    """
    moment, of_layer = width * layer.coupling * arm, width * layer.permittivity / t
    return {
        "series": Coupled(moment, of_layer / 2),
        "parallel": Coupled(2 * moment, 2 * of_layer),
        "unimorph": Coupled(moment, of_layer + width * layer.coupling**2 / axial),
    }[connection]


def laminate(
    bare: Rectangle, layer: Material, ratio: float, sides: tuple[float, float, int], beam: float
) -> tuple[float, float, Composite]:
    """Compute D12/D11, the relative bending stiffness with free camber, and the integrals of D11 + D12.

    `ratio` is Poisson's ratio of the layers, `sides` are the thickness of the strip, that of a layer, and the
    number of layers; the stiffness is relative to `beam`, that of the beam model per width [N m].  Symbols as
    in the docstring of this module.
    """
    nu, (h, t, number) = bare.poissons_ratio or 0.0, sides
    both, opposed = (
        composite(bare.youngs_modulus / (1 - s * nu), layer.stiffness / (1 - s * ratio), h, t, number)
        for s in (1, -1)
    )
    held = layer.held_across(ratio)
    both = both._replace(second=both.second + number * held.coupling**2 / held.permittivity * t**3 / 6)
    total = both.second + opposed.second
    return (both.second - opposed.second) / total, 2 * both.second * opposed.second / total / beam, both
