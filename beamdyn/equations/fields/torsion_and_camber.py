"""Torsion of beams of any cross-section; torsion and camber of strips, modelled as plates.

Torsion of any cross-section uses section constants (Saint-Venant, with Vlasov's warping).  With the twist
theta (positive from e2 to e1), the stiffness G J and E Cw, the rotary inertias R1 = rho I1 and R2 = rho I2
per length about the section's two axes, the mass m per length, and the tension T in the beam, the energies
are

    1/2 int [G J theta'^2 + E Cw theta''^2 + T ((R1 + R2)/m + t^2) theta'^2] dx,
    1/2 int (R11 + R22) (d theta/dt)^2 dx,

t being the distance of the centre of tension from the shear centre, and R the tensor of rotary inertia about
the latter along e1, e2.  Rotation at the speed omega twists the section with its broad side towards the plane
of rotation (propeller moment): with the components a1, a2 of the axis of rotation along e1 and e2, the energy
is omega^2/2 int [(a1^2 - a2^2) (R22 - R11) - 4 a1 a2 R12] theta^2 dx, and the load per length -omega^2 [a1 a2
(R22 - R11) + (a1^2 - a2^2) R12].

The tension straightens fibres that twist deforms to helices; in a pretwisted beam they are helices at rest.
A tip body rotates with the tip section.  If a warping stiffness is given, the root cannot warp: theta' = 0.
The coupling of torsion with bending is in `beamdyn.equations.fields.offsets`.

A strip is modelled as a plate, whose sections twist and camber as far as the clamped root lets them.
The deflection of a thin rectangular section of width b and thickness t is

    w(x, y) = sum_k u_k(x) p_k(eta),    eta = 2 y/b,    p_k = (2 k + 1)^(1/2) P_k (Legendre),

with bending u_0, the mean over the width, torsion (odd k) and camber (even k from 2).  The strain energy of
a Kirchhoff plate of the stiffness D per width, with D b = E I/(1 - nu^2), is

    1/2 int int D [w_xx^2 + w_yy^2 + 2 nu w_xx w_yy + 2 (1 - nu) c w_xy^2] dy dx.

The factor c = 3 J/(b t^3) makes torsion that of a rectangle of finite width, whose constant J is
Saint-Venant's.  In torsion, w_xx^2 has the factor g, the ratio of the section's warping constant to that of a
thin one, and 2 nu w_xx w_yy has sqrt(g); in thick sections nu is a smaller ratio (`Rectangle`), and
torsion also has the rotary inertia of the thickness.  Rotation at the speed omega about
the unit vector a adds

    omega^2/2 int int [T w_x^2 + N_y w_y^2 - (1 - a1^2) rho t w^2] dy dx,
    N_y = rho t (1 - a2^2) (b^2/4 - y^2)/2,

where omega^2 T is the tension per width due to rotation, and a1, a2 are the components of a in the directions
of bending and of the width (with precone, its cosine times the sine and the cosine of the bending angle).
N_y is a tension across the width, which stiffens torsion (propeller moment).  Where a1 a2 is not zero,
rotation also twists the strip, by the load -omega^2 a1 a2 rho t y per area, reduced by the rotary inertia of
the thickness.

In a tapered strip d/dx at constant y is d/dx - eta (b'/b) d/d eta.  Where the width has kinks or jumps, the
functions of torsion are p_k(2 y/b(L)), with which the strip bends smoothly there.  Where it has none, these
are not used: they grow with the k-th power of the width, and would lose digits.

Bodies at the tip and along the beam, springs and accelerations of the root act on the mean deflection over
the width; a tip body also rotates with the mean twist of the tip.  Derivation: docs/conventions.md and
tests/invariants/test_plates.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import lru_cache
from typing import ClassVar

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import CLAMPED, FIXED, RootConditions, Space, Spaces
from beamdyn.equations.explanations import Condition, Explanation
from beamdyn.equations.fields.bending_shear_stretch import STRETCHED, Bending, Stretch
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.equations.fields.offsets import EXPLANATIONS, Offsets, SectionMotion
from beamdyn.equations.fields.strip import StackedSpace, Strip, WidthFunctions, argument_ratio
from beamdyn.equations.fields.transverse import TransverseField, Trial, axis_in_section
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE, Profile, combine
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import inertia_about_shear_centre, tip_inertia

_NAME = "torsion"
_TURNED = FIXED._replace(stiffness="torsion_stiffness")  # boundary condition of torsion at the root
_WARPED = CLAMPED._replace(stiffness="warping_stiffness")


@dataclass(frozen=True)
class TurnedSections:
    """Deflection of twisting cross-sections of unknown width: the torsion functions along the beam.

    Parameters
    ----------
    along : Space
        Functions along the beam.
    """

    of_strip: ClassVar[bool] = False
    along: Space

    @property
    def of_each(self) -> int:
        """Number of coordinates of each function across the width; they are consecutive."""
        return self.along.size

    @property
    def corner(self) -> np.ndarray:
        """Twist of the tip per unit of each coordinate, which replaces the deflection of the tip's corner."""
        return self.along.end(0)

    def curvature_across(self, xi: np.ndarray) -> np.ndarray:
        """Return zeros: twisting sections keep their shape, without curvature across."""
        return np.zeros((self.along.size, len(xi)))

    def evaluate(self, xi: np.ndarray, eta: np.ndarray) -> np.ndarray:
        """Raise a ValueError: no surface can be drawn, as the section width is not known."""
        raise ValueError("the width of the sections is not known: make the beam by Beam.rectangular")


def assemble_section_torsion(
    scene: Scene, spaces: Spaces, partners: Sequence[TransverseField], stretched: RootConditions | None
) -> FieldEquations:
    """Assemble torsion of a beam that has a torsional stiffness and two rotary inertias.

    Offsets couple torsion with `partners` (fields that deflect the beam) and with stretch, whose boundary
    conditions are `stretched`.
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
    """Yield the loads on torsion, except for those due to offsets."""
    beam, (a1, a2) = scene.modelled_beam, axis_in_section(scene)
    _, broad, oblique = _inertias(beam)
    L, B = beam.length, tip_inertia(_tip_body(scene), beam.tip_twist).centrifugal
    turned = L * space.load(broad) + (B[0, 0] - B[1, 1]) * space.end(0)
    yield Load("twisting by rotation", _NAME, turned, "speed_squared", -a1 * a2)
    if beam.twist is not None:
        turned = -B[0, 1] * space.end(0)
        turned = turned if oblique is None else turned + L * space.load(oblique)
        yield Load("twisting by rotation", _NAME, turned, "speed_squared", a2**2 - a1**2)
        rate = beam.twist.derivative()
        by_root, by_speed = (space.load(pulled * rate, 1) / L for pulled in _pulled_straight(beam))
        cosine, _ = exact_cos_sin(scene.mount.precone)
        yield Load("untwisting by tension", _NAME, by_speed, "speed_squared", cosine**2)
        yield Load("untwisting by tension", _NAME, by_root, "root_axial", -1.0)


def _tip_body(scene: Scene) -> TipMass:
    """Return the body at the tip, with moments of inertia about the axis of the beam."""
    return (scene.beam.tip or TipMass(0.0)).about(0.0)


@lru_cache(maxsize=64)
def _inertias(beam: Beam) -> tuple[Profile, Profile, Profile | None]:
    """Compute R11 + R22, R22 - R11, and R12 if not 0, of the rotary inertia R about the shear centre."""
    R = inertia_about_shear_centre(beam)
    return R[0, 0] + R[1, 1], R[1, 1] + R[0, 0].scaled(-1.0), R.get((0, 1))


@lru_cache(maxsize=64)
def _pulled_straight(beam: Beam) -> list[Profile]:
    """Compute tension per root acceleration and per squared speed, times the fibres' mean squared radius.

    The fibres are assumed to be distributed about the centre of tension as the mass is.
    """
    R1, R2 = beam.rotary_inertia, beam.second_rotary_inertia
    assert R1 is not None and R2 is not None, "a scene with torsion has its properties"
    t = ONE.scaled(0.0) if beam.tension_offset is None else beam.tension_offset
    given = R1 + R2, beam.mass_per_length, t, *axial_tension(beam)
    return combine(lambda R, m, t, *pulls: (R / m + t**2) * np.stack(pulls), *given)


def _term(name: str, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0) -> Term:
    """Build a stiffness term of torsion."""
    return Term(name, _NAME, _NAME, 0, matrix, quantity, factor)


# Plates ----------------------------------------------------------------------------------------------

# Boundary conditions of torsion and camber of a strip at the root: clamped, as for bending.
_HELD = CLAMPED._replace(stiffness="bending_stiffness", direction=0)
_SOME_RATIO = 0.3  # Poisson's ratio in the list of all terms, if none is given

_IS_TWISTED = Condition(lambda s: s.scene.modelled_beam.twist is not None, "the beam is not twisted")
_IS_OBLIQUE = Condition(
    lambda s: _IS_TWISTED.is_met(s) or min(map(abs, aligned_cos_sin(s.scene.mount.bending_angle))) != 0,
    "the strip is parallel or perpendicular to the plane of rotation",
)


class SectionField(Field):
    """Base class of fields that deform a strip's sections: torsion (odd across) and camber (even across)."""

    # Number k of the first function across the width; further ones follow in steps of two.
    first: ClassVar[int]

    def complete(self, scene: Scene) -> Scene:
        """Return the scene with this field; unchanged if the section is not rectangular.

        A section without Poisson's ratio gets one, and the twist is removed.
        """
        section = scene.beam.section
        if section is None:
            return scene
        given = replace(section, poissons_ratio=section.poissons_ratio or _SOME_RATIO)
        beam = replace(scene.beam, twist=None).with_section(given)
        return replace(scene, beam=beam, physics=replace(scene.physics, **{self.name: True}))

    def numbers(self, count: int) -> range:
        """Return those numbers k of functions across the width, from 1 to `count`, that this field has."""
        return range(self.first, count + 1, 2)

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble the terms of the plate's energy, with the coupling to bending."""
        strip = Strip(scene, spaces)
        numbers = tuple(self.numbers(spaces.across))
        fewer, stretch = (
            len(self.numbers(spaces.fewer_across)),
            argument_ratio(strip.section.width, self.first),
        )
        space = StackedSpace(spaces.functions(_HELD), numbers, fewer, stretch)
        if not numbers:
            return FieldEquations(space, (), ())
        own = strip.functions(self, numbers, _HELD)
        terms = [*self._terms(strip, own, own), *self._of_body(strip, own, space.along)]
        coupling = [t for t in self._coupling(strip, own) if t.matrix.any()]
        mirrored = [replace(t, rows=t.columns, columns=t.rows, matrix=t.matrix.T) for t in coupling]
        loads = (*self._loads(strip, own, space.along),)
        return FieldEquations(space, (*terms, *coupling, *mirrored), loads, sections=space)

    def _terms(self, strip: Strip, rows: WidthFunctions, columns: WidthFunctions) -> Iterator[Term]:
        scene, names = strip.scene, (rows.field, columns.field)
        beam, c1, c2 = scene.beam, *axis_in_section(scene)
        mass, (n_a, n_b) = beam.mass_per_length, axial_tension(beam)
        eta, _ = gauss_rule(strip.points)

        def stiffness(
            name: str, matrix: np.ndarray, quantity: Quantity = "unity", factor: float = 1.0
        ) -> Term:
            return Term(f"{name} of {self.name}", *names, 0, matrix, quantity, factor)

        inertia = strip.integrate(mass, (rows, "w"), (columns, "w"))
        yield Term(f"mass of {self.name}", *names, 2, inertia)
        yield stiffness("stiffness", strip.stiffness(rows, columns, self.warping(strip.section)))
        slopes = (rows, "w_x"), (columns, "w_x")
        cosine, _ = exact_cos_sin(scene.mount.precone)
        yield stiffness("centrifugal stiffening", strip.integrate(n_b, *slopes), "speed_squared", cosine**2)
        yield stiffness("tension by root acceleration", strip.integrate(n_a, *slopes), "root_axial", -1.0)
        yield stiffness("spin softening", inertia, "speed_squared", -(1 - c1**2))
        if c2**2 != 1:
            pull, slopes = mass * strip.section.width * strip.section.width, ((rows, "w_y"), (columns, "w_y"))
            matrix = strip.integrate(pull.scaled(1 / 8), *slopes, 1 - eta**2)
            yield stiffness("pull across", matrix, "speed_squared", 1 - c2**2)

    def warping(self, section: Rectangle) -> Profile:
        """Compute the factor of the plate's bending stiffness along the beam; 1 by default."""
        return ONE

    def _coupling(self, strip: Strip, own: WidthFunctions) -> Iterator[Term]:
        """Yield the coupling terms with bending; none by default: odd deflections across are not coupled."""
        return iter(())

    def _of_body(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Term]:
        """Yield the terms of a tip body, which rotates with the mean twist of the tip; none by default."""
        return iter(())

    def _loads(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Load]:
        """Yield the loads; none by default, as loads act on the mean over the width."""
        return iter(())


def _explanations(name: str) -> dict[str, Explanation]:
    """Explain the terms that torsion and camber have in common."""
    return {
        f"mass of {name}": Explanation("Mkk qk''", "the strip is a plate"),
        f"stiffness of {name}": Explanation("Kk qk", "the strip is a plate"),
        f"centrifugal stiffening of {name}": Explanation("ω² KGBk qk", "the carrier turns", (why.TURNS,)),
        f"tension by root acceleration of {name}": Explanation(
            "-aO1 KGAk qk", why.say_tension, (why.TENSIONED,)
        ),
        f"pull across of {name}": Explanation(
            "ω² KNk qk", "rotation pulls the width apart", (why.TURNS, why.TILTED)
        ),
        f"spin softening of {name}": Explanation(
            "-ω² c² Mkk qk", why.say_softening, (why.TURNS, why.SOFTENED)
        ),
        f"damping of {name}": Explanation("C qk'", "the beam is damped", (why.DAMPED,)),
    }


class Torsion(SectionField):
    """Torsion of a strip: deflections that are odd across its width."""

    name = "torsion"
    partners: ClassVar[tuple[TransverseField, ...]] = Stretch.partners
    requires: ClassVar[Mapping[str, object]] = {"torsion": True}
    damping_name = "damping of torsion"
    first = 1
    explanations: ClassVar[Mapping[str, Explanation]] = {
        **_explanations("torsion"),
        "rotary inertia of torsion": Explanation("Rkk qk''", "sections turn"),
        "spin of sections of torsion": Explanation("ω² (c² - s²) Rkk qk", "the carrier turns", (why.TURNS,)),
        "mass of the tip body in torsion": Explanation(
            "Jp r rᵀ qk''", "a body at the tip turns", (why.TIP_BODY,)
        ),
        "spin of the tip body in torsion": Explanation(
            "-ω² (c² - s²) (J1 - J2) r rᵀ qk", "a body at the tip turns", (why.TIP_BODY, why.TURNS)
        ),
        "twisting by rotation": Explanation(
            "-ω² c s Qk", "rotation turns the strip into its plane", (why.TURNS, _IS_OBLIQUE)
        ),
        "untwisting by tension": Explanation(
            "ω² NB r² β' θ'", "tension straightens the fibres of a twisted beam", (why.TURNS, _IS_TWISTED)
        ),
        **EXPLANATIONS,
    }

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble torsion: of a strip as a plate, of another beam by section constants."""
        if scene.beam.section is None:
            deflecting = [field for field in self.partners if field.is_modelled(scene)]
            stretched = STRETCHED if Stretch().is_modelled(scene) else None
            return assemble_section_torsion(scene, spaces, deflecting, stretched)
        return super().assemble(scene, spaces)

    def warping(self, section: Rectangle) -> Profile:
        """Compute the ratio of the section's warping constant to that of a thin section."""
        return section.warping_factor

    def _terms(self, strip: Strip, rows: WidthFunctions, columns: WidthFunctions) -> Iterator[Term]:
        yield from super()._terms(strip, rows, columns)
        (c1, c2), name = axis_in_section(strip.scene), self.name
        tilt = strip.integrate(strip.rotary_inertia, (rows, "w_y"), (columns, "w_y"))
        yield Term("rotary inertia of torsion", name, name, 2, tilt)
        yield Term("spin of sections of torsion", name, name, 0, tilt, "speed_squared", c2**2 - c1**2)

    def _of_body(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Term]:
        tip = strip.scene.beam.tip
        if tip is None:
            return
        width = float(strip.section.width(np.ones(1))[0])
        turn = np.kron(own.tip * 2 / width, along.end(0))  # mean twist of the tip section
        turns, (c1, c2) = np.outer(turn, turn), axis_in_section(strip.scene)
        yield Term("mass of the tip body in torsion", self.name, self.name, 2, tip.axial_inertia * turns)
        spin = (tip.inertia_about_bending_direction - tip.inertia) * turns
        yield Term(
            "spin of the tip body in torsion", self.name, self.name, 0, spin, "speed_squared", c1**2 - c2**2
        )

    def _loads(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Load]:
        c1, c2 = axis_in_section(strip.scene)
        if not c1 * c2:
            return
        eta, _ = gauss_rule(strip.points)
        lever = (strip.scene.beam.mass_per_length * strip.section.width).scaled(1 / 2)
        vector = strip.load(lever, (own, "w"), along, eta)
        # The rotary inertia of the thickness reduces the load.
        vector = vector - strip.load(strip.rotary_inertia, (own, "w_y"), along)
        yield Load("twisting by rotation", self.name, vector, "speed_squared", -c1 * c2)


class Camber(SectionField):
    """Camber of a strip: the bending of its cross-sections.

    Its deflection is symmetric about the middle of the width.  The mean over the width belongs to bending,
    and is not a part of camber.
    """

    name = "camber"
    requires: ClassVar[Mapping[str, object]] = {"camber": True}
    damping_name = "damping of camber"
    first = 2
    explanations: ClassVar[Mapping[str, Explanation]] = _explanations("camber")

    def _coupling(self, strip: Strip, own: WidthFunctions) -> Iterator[Term]:
        bending = Bending()
        mean = strip.functions(bending, (0,), bending.conditions(strip.scene.mount))
        return super()._terms(strip, mean, own)
