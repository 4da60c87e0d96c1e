"""A rectangular strip with layers as a plate: what holding it flat across changes in stiffness and coupling.

Strip and layers are isotropic in their plane, so that the laminate is.  With the curvatures k1 and k2 along
and across, and the voltage v, its moments and charge per area are

    M1 = D11 k1 + D12 k2 - theta v,    M2 = D12 k1 + D11 k2 - theta v,    q = theta (k1 + k2) + C v.

Sum and difference of the two directions do not couple.  They are beams of the moduli E/(1 - nu) and
E/(1 + nu): D11 + D12 and D11 - D12 are the stiffnesses of these, each about its own neutral axis, and the
voltage bends the first alone, by the stress e/(1 - nu).  A section that cambers freely, M2 = 0, has the
bending stiffness D11 - D12^2/D11 and the coupling theta (1 - D12/D11), as a beam has if strip and layers have
one Poisson's ratio, and the capacitance C + theta^2/D11, less than the beam's: the strip hinders the bending
across that a voltage causes.  A section that is held flat, k2 = 0, has D11, theta and C.

Bending strains a layer unevenly through its thickness t, and its field then varies: with the electric
displacement the same all through, it is E = -v/t - e (S - mean of S)/eps, S the sum of both strains.  That
stiffens a layer against its own curvature, by (e^2/eps) t^3/12 in D11 and in D12, whatever the circuit.

References
----------
Laminate: Jones (1999), Mechanics of Composite Materials, chapter 4; docs/harvester.md.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from beamdyn.scene.profile import ONE, Profile, combine
from beamdyn.scene.rectangle import Rectangle


class Material(NamedTuple):
    """Constants of a layer strained along one direction: c11E [Pa], e31 [C/m2] and eps33S [F/m]."""

    stiffness: float
    coupling: float
    permittivity: float

    def held_across(self, ratio: float) -> Material:
        """Return constants of each direction where both have the same strain, by Poisson's ratio."""
        coupled = self.coupling**2 / self.stiffness
        permittivity = self.permittivity - coupled * (1 + ratio) / (1 - ratio)
        return Material(self.stiffness / (1 - ratio), self.coupling / (1 - ratio), permittivity)


class Composite(NamedTuple):
    """Integrals of a property over the thickness: its sum, centre, and second moment about that."""

    area: float
    centre: float
    second: float


def composite(inner: float, layer: float, h: float, t: float, sides: int) -> Composite:
    """Compute integrals for a strip of thickness h between layers of thickness t on one side or both."""
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
        Poisson's ratio over x/L, D12/D11 under the layers.
    free : Profile
        Bending stiffness of a section that cambers freely, over that of the beam, which leaves out that strip
        and layers camber together.
    """

    along: Profile = ONE
    free: Profile = ONE

    @cached_property
    def ratio(self) -> Profile:
        """Poisson's ratio along the beam."""
        return self.along

    @cached_property
    def twist_factor(self) -> Profile:
        """Torsional stiffness of the plate over E I of the beam."""
        shear = combine(lambda nu, free: (2 * free / (1 + nu))[None], self.along, self.free)[0]
        return self.torsion_factor * shear

    @cached_property
    def camber_stiffening(self) -> Profile:
        """Bending stiffness of the section that cannot camber over that of the beam."""
        return combine(lambda nu, free: (free / (1 - nu**2))[None], self.camber_ratio, self.free)[0]


class Coupled(NamedTuple):
    """What electrodes do: bending moment per voltage [N m/V], and capacitance per length [F/m]."""

    moment: float
    capacitance: float


def couple(connection: str, width: float, t: float, arm: float, layer: Material, axial: float) -> Coupled:
    """Compute moment and capacitance of layers by their connection.

    Parameters
    ----------
    connection : {"series", "parallel", "unimorph"}
        The connection.
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
    """Compute D12/D11, the stiffness with free camber over `beam` [N m], and the composite of D11 + D12.

    The sides are the thickness of the strip, that of a layer, and the number of layers. Symbols as in this
    module.
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
