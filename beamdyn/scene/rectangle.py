"""The rectangular section that a beam's properties are those of: what `Beam.rectangular` takes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from beamdyn.scene.beam import Beam
from beamdyn.scene.profile import Profile, Property

_SAME = 1e-9  # relative difference of a property from the rectangle's: far above rounding
_KAPPA = 5.0, 12.0, 11.0  # kappa G / E = 5 / (12 + 11 nu), of `beam.shear_stiffness_of_rectangle`


@dataclass(frozen=True)
class Rectangle:
    """Arguments of `Beam.rectangular` that describe the section.

    Parameters
    ----------
    width, thickness : Property
        Sides of the section [m].
    youngs_modulus : float
        Young's modulus [Pa].
    density : float
        Density [kg/m3].
    poissons_ratio : float, optional
        Poisson's ratio; None without shear stiffness.
    """

    width: Property
    thickness: Property
    youngs_modulus: float
    density: float
    poissons_ratio: float | None


def rectangle_of(beam: Beam) -> Rectangle | None:
    """Find the rectangular section of a beam from its properties; None if they are not those of one.

    The thickness is twice the outer fibre, and the squared width 12 times the quotient of the second bending
    stiffness and the axial stiffness.
    """
    axial, fibre, edge = beam.axial_stiffness, beam.outer_fibre, beam.second_bending_stiffness
    if axial is None or fibre is None or edge is None:
        return None

    def width(xi: np.ndarray) -> np.ndarray:
        return np.sqrt(12 * edge(xi) / axial(xi))

    root = np.zeros(1)
    area = float((width(root) * 2 * fibre(root))[0])
    e, rho = float(axial(root)[0]) / area, float(beam.mass_per_length(root)[0]) / area
    constant = all(p.degree == 0 and len({*p.coefficients}) == 1 for p in (edge, axial))
    side = float(width(root)[0]) if constant else width
    found = Rectangle(side, fibre.scaled(2.0), e, rho, _poissons_ratio(beam.shear_stiffness, axial))
    return found if _agrees(found, width, beam) else None


def _poissons_ratio(shear: Profile | None, axial: Profile) -> float | None:
    if shear is None:
        return None
    above, constant, slope = _KAPPA
    return float((above * axial(np.zeros(1)) / shear(np.zeros(1)) - constant)[0] / slope)


def _agrees(found: Rectangle, width: Callable[[np.ndarray], np.ndarray], beam: Beam) -> bool:
    """Whether mass and stiffness along the beam are those of the rectangle, of one material."""
    ends = np.array(beam.breakpoints)
    xi = np.unique(np.concatenate([np.linspace(0, 1, 33), (ends[:-1] + ends[1:]) / 2]))
    assert isinstance(found.thickness, Profile) and beam.axial_stiffness is not None
    b, h = width(xi), found.thickness(xi)
    area = b * h
    pairs = (
        (beam.mass_per_length, found.density * area),
        (beam.axial_stiffness, found.youngs_modulus * area),
        (beam.bending_stiffness, found.youngs_modulus * area * h**2 / 12),
    )
    return all(np.allclose(given(xi), value, rtol=_SAME, atol=0.0) for given, value in pairs)
