"""Axial stretch of the beam with its Coriolis coupling, as in Yoo and Shin (1998), for comparison."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import FIXED, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.bending_and_shear import SecondShear
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.equations.fields.transverse import TransverseField, Trial, plane_components
from beamdyn.equations.mass import first_moment_by_mass, gram_by_mass, load_by_mass, product_by_mass
from beamdyn.scene.beam import TipMass
from beamdyn.scene.mount import exact_cos_sin
from beamdyn.scene.scene import Scene

_CONDITIONS = FIXED.against("axial_stiffness")


class Stretch(Field):
    """Axial stretch of the beam."""

    name = "stretch"
    partners: ClassVar[tuple[TransverseField, ...]] = (*SecondShear.partners, SecondShear())
    damping_name = "axial damping"
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

    def is_modelled(self, scene: Scene) -> bool:
        """Whether `physics.stretch` is set."""
        return scene.physics.stretch

    def complete(self, scene: Scene) -> Scene:
        """Set `physics.stretch`, and an axial stiffness if there is none."""
        stiffness = scene.beam.axial_stiffness or scene.beam.bending_stiffness
        beam, physics = replace(scene.beam, axial_stiffness=stiffness), replace(scene.physics, stretch=True)
        return replace(scene, beam=beam, physics=physics)

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble eqs. (13) of Lee and Yoo (2019), and the coupling in (14)."""
        coupling = (
            term
            for partner in self.partners
            if partner.is_modelled(scene)
            for term in _coupling(Trial(partner, scene, spaces))
        )
        terms = (*_own_terms(scene, spaces), *coupling)
        return FieldEquations(spaces.functions(_CONDITIONS), terms, (*_loads(scene, spaces),))


def _own_terms(scene: Scene, spaces: Spaces) -> Iterator[Term]:
    """Yield mass M11 (15), axial stiffness KS (16) and its softening by spin."""
    s, beam, space = Stretch.name, scene.beam, spaces.functions(_CONDITIONS)
    assert beam.axial_stiffness is not None, "a scene with stretch has an axial stiffness"
    end = space.end(0)
    M = gram_by_mass(beam, space) + _tip(scene).mass * np.outer(end, end)
    yield Term("stretch mass", s, s, 2, M)
    yield Term("axial stiffness", s, s, 0, space.gram(beam.axial_stiffness, 1) / beam.length)
    cosine, _ = exact_cos_sin(scene.mount.precone)
    yield Term("axial spin softening", s, s, 0, M, "speed_squared", -(cosine**2))


def _coupling(trial: Trial) -> Iterator[Term]:
    """Yield the coupling, by the mass M12 (15), with a deflection in the plane, or by precone any."""
    b, s, beam = trial.field.name, Stretch.name, trial.beam
    by_beam = product_by_mass(beam, trial.spaces, _CONDITIONS, trial.conditions)
    M12 = by_beam + trial.tip.mass * np.outer(trial.spaces.functions(_CONDITIONS).end(0), trial.centre)
    d, n = plane_components(trial.scene)
    cosine, sine = exact_cos_sin(trial.scene.mount.precone)
    c, pressed = cosine * d[trial.direction], sine * cosine * n[trial.direction]
    yield Term("Coriolis coupling of stretch", s, b, 1, M12, "speed", 2 * c)
    yield Term("Coriolis coupling of bending", b, s, 1, M12.T, "speed", -2 * c)
    yield Term("Euler coupling of stretch", s, b, 0, M12, "acceleration", c)
    yield Term("Euler coupling of bending", b, s, 0, M12.T, "acceleration", -c)
    yield Term("spin coupling of stretch", s, b, 0, M12, "speed_squared", pressed)
    yield Term("spin coupling of stretch", b, s, 0, M12.T, "speed_squared", pressed)


def _loads(scene: Scene, spaces: Spaces) -> Iterator[Load]:
    """Yield the loads of eqs. (21) and (20)."""
    beam, tip, space = scene.beam, _tip(scene), spaces.functions(_CONDITIONS)
    end = space.end(0)
    P = load_by_mass(beam, space) + tip.mass * end
    Q = first_moment_by_mass(beam, space) + tip.mass * (beam.length + tip.offset) * end
    cosine, _ = exact_cos_sin(scene.mount.precone)
    yield Load("centrifugal stretching", Stretch.name, Q, "speed_squared", cosine**2)
    yield Load("axial root acceleration", Stretch.name, P, "root_axial", -1.0)


def _tip(scene: Scene) -> TipMass:
    return scene.beam.tip or TipMass(0.0)
