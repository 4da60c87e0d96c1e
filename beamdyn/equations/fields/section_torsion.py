"""Torsion of sections of any form, by their constants (Saint-Venant, with Vlasov's warping).

With the twist theta (positive from e2 to e1), the stiffness G J and E Cw, the rotary inertias R1 = rho I1 and
R2 = rho I2 per length about the two axes of the section, and the tension T of the beam of mass m per length,
the energies are

    1/2 int [G J theta'^2 + E Cw theta''^2 + T ((R1 + R2)/m + t^2) theta'^2] dx,
    1/2 int (R11 + R22) (d theta/dt)^2 dx,

t being the distance of the centre of tension from the shear centre, and R the tensor of rotary inertia about
the latter along e1, e2.  Rotation at the speed omega turns the section with its broad side into the plane of
rotation (propeller moment): with the components a1, a2 of the axis of rotation along e1 and e2, the energy is
omega^2/2 int [(a1^2 - a2^2) (R22 - R11) - 4 a1 a2 R12] theta^2 dx, and the load per length
-omega^2 [a1 a2 (R22 - R11) + (a1^2 - a2^2) R12].

The tension straightens fibres that the twist makes helices; in a twisted beam they are helices at rest.  A
body at the tip turns with the section there.  Where a warping stiffness is given, the root cannot warp:
theta' = 0.  The coupling of torsion with bending is in `beamdyn.equations.fields.offsets`.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache

import numpy as np

from beamdyn.equations.discretization import CLAMPED, FIXED, RootConditions, Space, Spaces
from beamdyn.equations.fields.field import FieldEquations, Load, Term
from beamdyn.equations.fields.offsets import Offsets, SectionMotion
from beamdyn.equations.fields.transverse import TransverseField, Trial, axis_in_section
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.profile import ONE, Profile, combine
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import section_tensor, tip_inertia

_NAME = "torsion"
_TURNED = FIXED._replace(stiffness="torsion_stiffness")  # conditions of torsion at the root
_WARPED = CLAMPED._replace(stiffness="warping_stiffness")


@dataclass(frozen=True)
class TurnedSections:
    """Deflection of twisting sections of unknown width: the torsion functions along the beam.

    Parameters
    ----------
    along : Space
        Functions along the beam.
    """

    along: Space

    @property
    def of_each(self) -> int:
        """Number of coordinates of each function across, which are consecutive."""
        return self.along.size

    @property
    def corner(self) -> np.ndarray:
        """Twist at the tip per coordinate (n,), which stands for the deflection of a corner."""
        return self.along.end(0)

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """Return zeros: twisting sections keep their shape."""
        return np.zeros((self.along.size, len(xi)))

    def evaluate(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Raise a ValueError: no surface can be drawn, as the width of the section is not known."""
        raise ValueError("the width of the sections is not known, but that of beams by Beam.rectangular")


def assemble_section_torsion(
    scene: Scene, spaces: Spaces, partners: Sequence[TransverseField], stretched: RootConditions | None
) -> FieldEquations:
    """Assemble torsion of a beam with a torsional stiffness and two rotary inertias.

    Offsets couple torsion with the partners (fields that deflect the beam), and with a stretch that has the
    conditions given at the root.
    """
    beam = scene.modelled_beam
    conditions = _TURNED if beam.warping_stiffness is None else _WARPED
    space = spaces.functions(conditions)
    terms, loads = [*_terms(scene, space)], [*_loads(scene, space)]
    if beam.has_offsets:
        along = (
            []
            if stretched is None
            else [SectionMotion("stretch", stretched, spaces.functions(stretched).end(0), along=0)]
        )
        turn = SectionMotion(_NAME, conditions, space.end(0), rotation=2)
        trials = [Trial.of(partner, scene, spaces) for partner in partners]
        offsets = Offsets(scene, spaces, turn, trials, along)
        terms, loads = [*terms, *offsets.terms()], [*loads, *offsets.loads()]
    return FieldEquations(space, (*terms,), (*loads,), sections=TurnedSections(space))


def _terms(scene: Scene, space: Space) -> Iterator[Term]:
    """Yield the terms of torsion, without coupling to other fields."""
    beam, L, tip = scene.modelled_beam, scene.beam.length, _tip_body(scene)
    (a1, a2), (cosine, _) = axis_in_section(scene), exact_cos_sin(scene.mount.precone)
    turn, (polar, broad, oblique) = np.outer(space.end(0), space.end(0)), _inertias(beam)
    assert beam.torsion_stiffness is not None, "a scene with torsion has its properties"
    yield Term("mass of torsion", _NAME, _NAME, 2, L * space.gram(polar, 0))
    yield Term("mass of the tip body in torsion", _NAME, _NAME, 2, tip.axial_inertia * turn)
    stiffness = space.gram(beam.torsion_stiffness, 1) / L
    if beam.warping_stiffness is not None:
        stiffness = stiffness + space.gram(beam.warping_stiffness, 2) / L**3
    yield _term("stiffness of torsion", stiffness)
    by_root, by_speed = (space.gram(pulled, 1) / L for pulled in _pulled_straight(beam))
    yield _term("centrifugal stiffening of torsion", by_speed, "speed_squared", cosine**2)
    yield _term("tension by root acceleration of torsion", by_root, "root_axial", -1.0)
    yield _term("spin of sections of torsion", L * space.gram(broad, 0), "speed_squared", a1**2 - a2**2)
    if oblique is not None and a1 * a2:
        turned = L * space.gram(oblique, 0)
        yield _term("spin of sections of torsion", turned, "speed_squared", -4 * a1 * a2)
    B = tip_inertia(tip, beam.tip_twist).centrifugal
    factor = (B[0, 0] - B[1, 1]) * (a1**2 - a2**2) + 4 * B[0, 1] * a1 * a2
    yield _term("spin of the tip body in torsion", turn, "speed_squared", float(factor))


def _loads(scene: Scene, space: Space) -> Iterator[Load]:
    """Yield the loads on torsion, without those of offsets."""
    beam, (a1, a2) = scene.modelled_beam, axis_in_section(scene)
    _, broad, oblique = _inertias(beam)
    L, B = beam.length, tip_inertia(_tip_body(scene), beam.tip_twist).centrifugal
    turned = L * space.load(broad) + (B[0, 0] - B[1, 1]) * space.end(0)
    yield Load("twisting by rotation", _NAME, turned, "speed_squared", -a1 * a2)
    if beam.twist is not None:
        turned = -B[0, 1] * space.end(0)
        turned = turned if oblique is None else turned + L * space.load(oblique)
        yield Load("twisting by rotation", _NAME, turned, "speed_squared", a2**2 - a1**2)
        by_root, by_speed = (
            space.load(pulled * beam.twist.derivative(), 1) / L for pulled in _pulled_straight(beam)
        )
        cosine, _ = exact_cos_sin(scene.mount.precone)
        yield Load("untwisting by tension", _NAME, by_speed, "speed_squared", cosine**2)
        yield Load("untwisting by tension", _NAME, by_root, "root_axial", -1.0)


def _tip_body(scene: Scene) -> TipMass:
    """Return the body at the tip, with moments of inertia about the axis of the beam."""
    return (scene.beam.tip or TipMass(0.0)).about(0.0)


@lru_cache(maxsize=64)
def _inertias(beam: Beam) -> tuple[Profile, Profile, Profile | None]:
    """Compute R11 + R22, R22 - R11, and R12 if it is not 0, about the shear centre, where sections turn."""
    R = section_tensor(replace(beam, tension_offset=None), "rotary_inertia")
    return R[0, 0] + R[1, 1], R[1, 1] + R[0, 0].scaled(-1.0), R.get((0, 1))


@lru_cache(maxsize=64)
def _pulled_straight(beam: Beam) -> list[Profile]:
    """Compute tension per root acceleration and per squared speed, times the fibres' squared radius.

    The fibres are taken to be distributed as the mass is, about the centre of tension.
    """
    R1, R2 = beam.rotary_inertia, beam.second_rotary_inertia
    assert R1 is not None and R2 is not None, "a scene with torsion has its properties"
    t = ONE.scaled(0.0) if beam.tension_offset is None else beam.tension_offset
    given = R1 + R2, beam.mass_per_length, t, *axial_tension(beam)
    return combine(lambda R, m, t, *pulls: (R / m + t**2) * np.stack(pulls), *given)


def _term(name: str, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0) -> Term:
    """Build a stiffness term of torsion."""
    return Term(name, _NAME, _NAME, 0, matrix, quantity, factor)
