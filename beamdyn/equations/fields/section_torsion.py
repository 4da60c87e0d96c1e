"""Torsion of sections of any form, by their constants (Saint-Venant, with Vlasov's warping).

With the twist theta, the stiffness G J and E Cw, the rotary inertias R1 = rho I1 and R2 = rho I2 per length
about the two axes of the section, and the tension T of the beam of mass m per length, the energies are

    1/2 int [G J theta'^2 + E Cw theta''^2 + T (R1 + R2)/m theta'^2] dx,
    1/2 int (R1 + R2) (d theta/dt)^2 dx.

Rotation at the speed omega turns the section with its broad side into the plane of rotation (propeller
moment): with the components a1, a2 of the axis of rotation in the directions of bending and across, the
energy is omega^2/2 (a1^2 - a2^2) int (R2 - R1) theta^2 dx, and the load per length
-omega^2 a1 a2 (R2 - R1).

The tension pulls fibres straight that the twist makes helices.  Bodies along the beam stand on its axis; one
at the tip turns with it.  A root without warping holds theta', where a stiffness against warping is given.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from beamdyn.equations.discretization import CLAMPED, FIXED, Space, Spaces
from beamdyn.equations.fields.field import FieldEquations, Load, Term
from beamdyn.equations.fields.transverse import axis_in_section
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.beam import TipMass
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.profile import combine
from beamdyn.scene.scene import Scene

_NAME = "torsion"
_TURNED = FIXED._replace(stiffness="torsion_stiffness")  # at the root
_WARPED = CLAMPED._replace(stiffness="warping_stiffness")


@dataclass(frozen=True)
class TurnedSections:
    """Deflection of sections of unknown width that turn by the functions along the beam.

    Parameters
    ----------
    along : Space
        Functions along the beam.
    """

    along: Space

    @property
    def of_each(self) -> int:
        """Number of coordinates of each function across."""
        return self.along.size

    @property
    def corner(self) -> np.ndarray:
        """Twist at the tip (n,), as which a corner deflects."""
        return self.along.end(0)

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """None: the sections keep their shape."""
        return np.zeros((self.along.size, len(xi)))

    def evaluate(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Refuse a surface: a ValueError, as the width is not known."""
        raise ValueError("the width of the sections is not known, but that of beams by Beam.rectangular")


def assemble_section_torsion(scene: Scene, spaces: Spaces) -> FieldEquations:
    """Assemble torsion of a beam with a torsional stiffness and two rotary inertias."""
    beam, L, warping = scene.beam, scene.beam.length, scene.beam.warping_stiffness
    GJ, R1, R2 = beam.torsion_stiffness, beam.rotary_inertia, beam.second_rotary_inertia
    assert GJ is not None and R1 is not None and R2 is not None, "a scene with torsion has its properties"
    held = _TURNED if warping is None else _WARPED
    space = spaces.functions(held)
    (a1, a2), (cosine, _) = axis_in_section(scene), exact_cos_sin(scene.mount.precone)
    polar, broad = R1 + R2, R2 + R1.scaled(-1.0)
    (squared_radius,) = combine(lambda inertia, mass: (inertia / mass)[None], polar, beam.mass_per_length)
    pulled_by_root, pulled_by_speed = (
        space.gram(tension * squared_radius, 1) / L for tension in axial_tension(beam)
    )
    tip = beam.tip or TipMass(0.0)
    turn = np.outer(space.end(0), space.end(0))
    stiffness = space.gram(GJ, 1) / L
    if warping is not None:
        stiffness = stiffness + space.gram(warping, 2) / L**3
    propeller = L * space.gram(broad, 0)
    body = (tip.inertia_about_bending_direction - tip.inertia) * turn
    terms = [
        Term("mass of torsion", _NAME, _NAME, 2, L * space.gram(polar, 0)),
        Term("mass of the tip body in torsion", _NAME, _NAME, 2, tip.axial_inertia * turn),
        _term("stiffness of torsion", stiffness),
        _term("centrifugal stiffening of torsion", pulled_by_speed, "speed_squared", cosine**2),
        _term("tension by root acceleration of torsion", pulled_by_root, "root_axial", -1.0),
        _term("spin of sections of torsion", propeller, "speed_squared", a1**2 - a2**2),
        _term("spin of the tip body in torsion", body, "speed_squared", a1**2 - a2**2),
    ]
    load = Load("twisting by rotation", _NAME, L * space.load(broad), "speed_squared", -a1 * a2)
    return FieldEquations(space, (*terms,), (load,), sections=TurnedSections(space))


def _term(name: str, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0) -> Term:
    """A stiffness of torsion."""
    return Term(name, _NAME, _NAME, 0, matrix, quantity, factor)
