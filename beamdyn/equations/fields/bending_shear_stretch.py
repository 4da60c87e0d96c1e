"""Bending with sections normal to the axis, and shear (Timoshenko), in two directions; and axial stretch.

The deflection is u = u_b + u_s, with the sections' rotation u_b'.  The shear deflection u_s thus vanishes at
the root like the stretch; there is no shear locking, and the limit of a slender beam is exact.

Axial stretch with its Coriolis coupling is as in Yoo and Shin (1998), for comparison.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import CLAMPED, FIXED, HINGED, RootConditions, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.equations.fields.transverse import Pair, TransverseField, Trial, plane_components
from beamdyn.equations.mass import gram_by_mass, loads_by_mass, product_by_mass
from beamdyn.scene.beam import PointSpring, TipMass
from beamdyn.scene.mount import Mount, exact_cos_sin
from beamdyn.scene.profile import Profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import section_tensor


class Bending(TransverseField):
    """Bending in the direction of the bending angle; every scene has this field."""

    name = "bending"
    direction = 0
    rotates = True
    partners = ()
    explanations: ClassVar[Mapping[str, Explanation]] = {
        **TransverseField.explanations,
        "bending stiffness": Explanation("KB q2", "always"),
        "root spring": Explanation("k D0 D0ᵀ q2", "the root turns against a spring", (why.ON_SPRINGS,)),
    }

    def complete(self, scene: Scene) -> Scene:
        """Return the scene with the tip body, damping, springs and angles that make every term nonzero."""
        body = TipMass(1.0, inertia=1.0, transverse_inertia=0.8, axial_inertia=0.5)
        mount = Mount(1.0, math.pi, 1.0, root_stiffness=1.0, second_root_stiffness=1.0, precone=0.5)
        springs = (PointSpring(scene.beam.length, scene.beam.bending_stiffness(np.zeros(1))[0]),)
        beam = replace(scene.beam, tip=body, point_springs=springs)
        return replace(scene.undamped, beam=beam, mount=mount, damping_ratio=0.5)

    def conditions(self, mount: Mount) -> RootConditions:
        """Return the boundary conditions at the root: clamped, or hinged if a spring supports the root."""
        at_root = HINGED if math.isfinite(mount.root_stiffnesses[self.direction]) else CLAMPED
        return at_root._replace(stiffness="bending_stiffness", direction=self.direction)

    def stiffening(self, section: Rectangle, length: float) -> Profile:
        """Compute the ratio of bending stiffness of sections that cannot camber to that of cambering ones."""
        return section.camber_stiffening

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the bending stiffness term and the spring at the root."""
        stiffness = section_tensor(pair.rows.beam, "bending_stiffness").get(pair.directions)
        if stiffness is not None:
            scene = pair.rows.scene
            if scene.physics.camber:
                assert scene.beam.strip is not None, "a scene with camber has a section"
                stiffness = stiffness * self.stiffening(scene.beam.strip, scene.beam.length)
            yield pair.term("bending stiffness", pair.integrate(stiffness, 2))
        spring = pair.rows.scene.mount.root_stiffnesses[self.direction]
        if pair.rows is pair.columns and math.isfinite(spring):
            slope = pair.rows.space.evaluate(np.zeros(1), 1)[:, 0] / pair.rows.beam.length
            yield pair.term("root spring", spring * np.outer(slope, slope))


class SecondBending(Bending):
    """Bending perpendicular to the direction of the bending angle, in scenes with two planes of bending."""

    name = "second bending"
    direction = 1
    requires: ClassVar[Mapping[str, object]] = {"planes": 2}
    partners = (*Bending.partners, Bending())

    def stiffening(self, section: Rectangle, length: float) -> Profile:
        """Compute the ratio of bending stiffness near a clamped root (camber hindered) to that elsewhere."""
        return section.stiffening_across(length)


class Shear(TransverseField):
    """Shear deflection in the direction of the bending angle."""

    name = "shear"
    direction = 0
    rotates = False
    requires: ClassVar[Mapping[str, object]] = {"shear": True}
    partners = (*SecondBending.partners, SecondBending())
    explanations: ClassVar[Mapping[str, Explanation]] = {
        **TransverseField.explanations,
        "shear stiffness": Explanation("KQ q2", "shear is modelled"),
    }

    def conditions(self, mount: Mount) -> RootConditions:
        """Return the boundary condition at the root: no shear deflection."""
        return FIXED._replace(stiffness="shear_stiffness", direction=self.direction)

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the shear stiffness term of a pair of shear fields, which may be the same field."""
        stiffness = section_tensor(pair.rows.beam, "shear_stiffness").get(pair.directions)
        if stiffness is not None and not pair.rows.field.rotates:
            yield pair.term("shear stiffness", pair.integrate(stiffness, 1))


class SecondShear(Shear):
    """Shear deflection perpendicular to the bending angle's direction, in scenes with both planes."""

    name = "second shear"
    direction = 1
    requires: ClassVar[Mapping[str, object]] = {"shear": True, "planes": 2}
    partners = (*Shear.partners, Shear())


# Stretch ---------------------------------------------------------------------------------------------

STRETCHED = FIXED._replace(stiffness="axial_stiffness")  # boundary condition of the stretch at the root


class Stretch(Field):
    """Displacement field of the axial stretch of the beam."""

    name = "stretch"
    partners: ClassVar[tuple[TransverseField, ...]] = (*SecondShear.partners, SecondShear())
    damping_name = "axial damping"
    requires: ClassVar[Mapping[str, object]] = {"stretch": True}
    explanations: ClassVar[Mapping[str, Explanation]] = {
        "stretch mass": Explanation("M11 q1''", "stretch is modelled"),
        "axial stiffness": Explanation("KS q1", "stretch is modelled"),
        "axial spin softening": Explanation("-ω² M11 q1", "the carrier turns", (why.TURNS,)),
        "Coriolis coupling of stretch": Explanation(
            "2 ω c M12 q2'", "the carrier turns", (why.TURNS, why.IN_PLANE)
        ),
        "Coriolis coupling of bending": Explanation(
            "-2 ω c M21 q1'", "the carrier turns", (why.TURNS, why.IN_PLANE)
        ),
        "Euler coupling of stretch": Explanation(
            "ω' c M12 q2", "the speed varies", (why.ACCELERATES, why.IN_PLANE)
        ),
        "Euler coupling of bending": Explanation(
            "-ω' c M21 q1", "the speed varies", (why.ACCELERATES, why.IN_PLANE)
        ),
        "spin coupling of stretch": Explanation(
            "ω² s sin(η) cos(η) M12 q2",
            "the precone turns the beam out of the plane of rotation",
            (why.TURNS, why.PRECONED, why.OUT_OF_PLANE),
        ),
        "axial damping": Explanation("C q1'", "the beam is damped", (why.DAMPED,)),
        "centrifugal stretching": Explanation("ω² Q1", "the carrier turns", (why.TURNS,)),
        "axial root acceleration": Explanation("-aO1 P1", why.say_tension, (why.TENSIONED,)),
    }

    def complete(self, scene: Scene) -> Scene:
        """Return the scene with `physics.stretch`, and with an axial stiffness if it has none."""
        stiffness = scene.beam.axial_stiffness or scene.beam.bending_stiffness
        beam, physics = replace(scene.beam, axial_stiffness=stiffness), replace(scene.physics, stretch=True)
        return replace(scene, beam=beam, physics=physics)

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble eqs. (13) of Lee and Yoo (2019), and the coupling in (14).

        The terms are mass M11 (15), axial stiffness KS (16), the softening of stretch due to rotation, and
        the loads (20), (21).
        """
        s, beam, space = self.name, scene.beam, spaces.functions(STRETCHED)
        tip = beam.tip or TipMass(0.0)
        assert beam.axial_stiffness is not None, "a scene with stretch has an axial stiffness"
        end, (cosine, _) = space.end(0), exact_cos_sin(scene.mount.precone)
        M = gram_by_mass(beam, space) + tip.mass * np.outer(end, end)
        P, Q = loads_by_mass(beam, space)
        P = P + tip.mass * end
        Q = Q + tip.mass * (beam.length + tip.offset) * end
        terms = [
            Term("stretch mass", s, s, 2, M),
            Term("axial stiffness", s, s, 0, space.gram(beam.axial_stiffness, 1) / beam.length),
            Term("axial spin softening", s, s, 0, M, "speed_squared", -(cosine**2)),
        ]
        for partner in self.partners:
            if partner.is_modelled(scene):
                terms += _coupling(Trial.of(partner, scene, spaces))
        loads = (
            Load("centrifugal stretching", s, Q, "speed_squared", cosine**2),
            Load("axial root acceleration", s, P, "root_axial", -1.0),
        )
        return FieldEquations(space, (*terms,), loads)


def _coupling(trial: Trial) -> list[Term]:
    """Couple the stretch with deflection in the plane of rotation, or with any deflection under precone.

    The coupling is by the mass matrix M12 of eq. (15) of Lee and Yoo (2019).
    """
    b, s, beam, i = trial.field.name, Stretch.name, trial.beam, trial.field.direction
    by_beam = product_by_mass(beam, trial.spaces, STRETCHED, trial.conditions)
    M12 = by_beam + trial.tip.mass * np.outer(trial.spaces.functions(STRETCHED).end(0), trial.centre)
    (d, n), (cosine, sine) = plane_components(trial.scene), exact_cos_sin(trial.scene.mount.precone)
    c, pressed = cosine * d[i], sine * cosine * n[i]
    return [
        Term("Coriolis coupling of stretch", s, b, 1, M12, "speed", 2 * c),
        Term("Coriolis coupling of bending", b, s, 1, M12.T, "speed", -2 * c),
        Term("Euler coupling of stretch", s, b, 0, M12, "acceleration", c),
        Term("Euler coupling of bending", b, s, 0, M12.T, "acceleration", -c),
        Term("spin coupling of stretch", s, b, 0, M12, "speed_squared", pressed),
        Term("spin coupling of stretch", b, s, 0, M12.T, "speed_squared", pressed),
    ]
