"""The strip as a plate: sections that twist and camber, as far as the clamped root lets them.

The deflection of a thin rectangular section of width b and thickness t is

    w(x, y) = sum_k u_k(x) p_k(eta),    eta = 2 y/b,    p_k = (2 k + 1)^(1/2) P_k (Legendre),

with bending u_0, the mean over the width, torsion (odd k) and camber (even k from 2).  The strain energy of
a Kirchhoff plate of the stiffness D per width, with D b = E I/(1 - nu^2), is

    1/2 int int D [w_xx^2 + w_yy^2 + 2 nu w_xx w_yy + 2 (1 - nu) c w_xy^2] dy dx.

The factor c = 3 J/(b t^3) makes torsion that of a rectangle of finite width, whose constant J is
Saint-Venant's.  In torsion, w_xx^2 has the factor g, the ratio of the section's warping constant to that of a
thin one, and 2 nu w_xx w_yy has the root of g; in thick sections nu is a smaller ratio (`Rectangle`), and
torsion also has the rotary inertia of the thickness.  Rotation at the speed omega about
the unit vector a adds

    omega^2/2 int int [T w_x^2 + N_y w_y^2 - (1 - a1^2) rho t w^2] dy dx,
    N_y = rho t (1 - a2^2) (b^2/4 - y^2)/2,

where omega^2 T is the tension by rotation per width, and a1, a2 are the components of a in the directions
of bending and of the width (with precone, its cosine times the sine and the cosine of the bending angle).
N_y pulls the width apart, which stiffens torsion (propeller moment).  Where a1 a2 is not zero, rotation
also twists the strip, by the load -omega^2 a1 a2 rho t y per area, less what the inertia of the thickness
resists.  In a tapered strip the functions of torsion are p_k(2 y/b(L)), which lets it bend smoothly where
the width has a kink or jumps; of the even ones d/dx at constant y is d/dx - eta (b'/b) d/d eta.

Bodies at the tip and along the beam, springs and accelerations of the root act on the mean over the width;
a tip body also turns with the mean twist there.  Derivation: docs/conventions.md and
tests/invariants/test_plates.py.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from beamdyn.common.numerics import gauss_rule
from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import CLAMPED, Space, Spaces
from beamdyn.equations.explanations import Condition, Explanation
from beamdyn.equations.fields.bending_and_shear import Bending
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.equations.fields.offset_names import EXPLANATIONS
from beamdyn.equations.fields.section_torsion import assemble_section_torsion
from beamdyn.equations.fields.stretch import STRETCHED, Stretch
from beamdyn.equations.fields.strip import StackedSpace, Strip, WidthFunctions, over_tip
from beamdyn.equations.fields.transverse import TransverseField, axis_in_section
from beamdyn.equations.mass import axial_tension
from beamdyn.equations.root_motion import Quantity
from beamdyn.scene.mount import aligned_cos_sin, exact_cos_sin
from beamdyn.scene.profile import ONE, Profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene

_HELD = CLAMPED._replace(stiffness="bending_stiffness", direction=0)  # conditions at the root, as for bending
_SOME_RATIO = 0.3  # Poisson's ratio for the list of all terms, where none is given

_IS_TWISTED = Condition(lambda s: s.scene.modelled_beam.twist is not None, "the beam is not twisted")
_IS_OBLIQUE = Condition(
    lambda s: _IS_TWISTED.is_met(s) or min(map(abs, aligned_cos_sin(s.scene.mount.bending_angle))) != 0,
    "the strip stands along or across the plane of rotation",
)


class SectionField(Field):
    """Base of the fields that deform a strip's sections: torsion, odd across, and camber, even across."""

    first: ClassVar[int]  # number k of the first function across; the others follow in steps of two

    def complete(self, scene: Scene) -> Scene:
        """Return the scene with this field and, for a rectangle, a flat strip with Poisson's ratio."""
        section = scene.beam.section
        if section is None:
            return scene
        given = replace(section, poissons_ratio=section.poissons_ratio or _SOME_RATIO)
        beam = replace(scene.beam, twist=None).with_section(given)
        return replace(scene, beam=beam, physics=replace(scene.physics, **{self.name: True}))

    def numbers(self, count: int) -> range:
        """Return the numbers k of the functions of this field among `count` functions beyond the mean."""
        return range(self.first, count + 1, 2)

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble the terms of the plate's energy, with its coupling to bending."""
        strip = Strip(scene, spaces)
        numbers = tuple(self.numbers(spaces.across))
        fewer, is_odd = len(self.numbers(spaces.fewer_across)), self.first % 2
        stretch = over_tip(strip.section.width) if is_odd else ONE
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
        """Compute the factor of the plate's bending stiffness along the beam; by default 1."""
        return ONE

    def _coupling(self, strip: Strip, own: WidthFunctions) -> Iterator[Term]:
        """Yield the coupling terms with bending; by default none, as for deflections that are odd across."""
        return iter(())

    def _of_body(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Term]:
        """Yield the terms of a tip body, which the mean twist of the section turns; by default none."""
        return iter(())

    def _loads(self, strip: Strip, own: WidthFunctions, along: Space) -> Iterator[Load]:
        """Yield the loads; by default none, as loads act on the mean over the width."""
        return iter(())


def _explanations(name: str) -> dict[str, Explanation]:
    """Explain the terms that torsion and camber share."""
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
            "ω² NB r² β' θ'", "tension pulls straight the fibres of a twisted beam", (why.TURNS, _IS_TWISTED)
        ),
        **EXPLANATIONS,
    }

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble torsion: of a strip as a plate, of another section by its constants."""
        if scene.beam.section is None:
            deflecting = [field for field in self.partners if field.is_modelled(scene)]
            stretched = STRETCHED if Stretch().is_modelled(scene) else None
            return assemble_section_torsion(scene, spaces, deflecting, stretched)
        return super().assemble(scene, spaces)

    def warping(self, section: Rectangle) -> Profile:
        """Compute the warping constant of the section over that of a thin one."""
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
        turn = np.kron(own.tip * 2 / width, along.end(0))  # mean twist of the section at the tip
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
    """Camber of a strip: deflections that are even across its width, without the mean."""

    name = "camber"
    requires: ClassVar[Mapping[str, object]] = {"camber": True}
    damping_name = "damping of camber"
    first = 2
    explanations: ClassVar[Mapping[str, Explanation]] = _explanations("camber")

    def _coupling(self, strip: Strip, own: WidthFunctions) -> Iterator[Term]:
        bending = Bending()
        mean = strip.functions(bending, (0,), bending.conditions(strip.scene.mount))
        return super()._terms(strip, mean, own)
