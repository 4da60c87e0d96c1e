"""Axial stretch of the beam with its Coriolis coupling, as in Yoo and Shin (1998), for comparison."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.damping import modal_damping
from beamdyn.equations.discretization import Spaces
from beamdyn.equations.explanations import Condition, Explanation
from beamdyn.equations.fields import bending
from beamdyn.equations.fields.bending import Bending
from beamdyn.equations.fields.field import Field, FieldEquations, Load, Term
from beamdyn.equations.root_motion import exact_cos_sin
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.profile import FRACTION
from beamdyn.scene.scene import Scene

HELD = 1  # no displacement at the root
MODELLED = Condition(lambda s: s.scene.stretch, "no stretch: the beam is modelled as inextensible")


@dataclass(frozen=True)
class StretchOperators:
    """Matrices and vectors of the stretch s = sum phi_i(x/L) q_i and its coupling with bending.

    Symbols and equation numbers are those of Lee and Yoo (2019).

    Parameters
    ----------
    M : ndarray, shape (m, m)
        Mass M11 (15) [kg].
    M12 : ndarray, shape (m, n)
        Coupling mass (15) [kg].
    KS : ndarray, shape (m, m)
        Axial stiffness (16) [N/m].
    P, Q : ndarray, shape (m,)
        Loads (21) [kg] and (20) [kg m].
    """

    M: np.ndarray
    M12: np.ndarray
    KS: np.ndarray
    P: np.ndarray
    Q: np.ndarray


def stretch_operators(beam: Beam, spaces: Spaces) -> StretchOperators:
    """Integrate the operators of stretch and of its coupling with bending."""
    length, mass, tip = beam.length, beam.mass_per_length, beam.tip or TipMass(0.0)
    assert beam.axial_stiffness is not None, "a scene with stretch has an axial stiffness"
    space, clamped = spaces.functions(HELD), spaces.functions(bending.HELD)
    end = space.end(0)
    centre = clamped.end(0) + tip.offset / length * clamped.end(1)
    return StretchOperators(
        M=space.gram(mass, 0) * length + tip.mass * np.outer(end, end),
        M12=spaces.product(mass, HELD, bending.HELD) * length + tip.mass * np.outer(end, centre),
        KS=space.gram(beam.axial_stiffness, 1) / length,
        P=space.load(mass) * length + tip.mass * end,
        Q=space.load(mass * FRACTION) * length**2 + tip.mass * (length + tip.offset) * end,
    )


class Stretch(Field):
    """Axial stretch of the beam."""

    name = "stretch"
    explanations: ClassVar[Mapping[str, Explanation]] = {
        "stretch mass": Explanation("M11 q1''", "stretch is modelled", (MODELLED,)),
        "axial stiffness": Explanation("KS q1", "stretch is modelled", (MODELLED,)),
        "axial spin softening": Explanation("-ω² M11 q1", "the carrier turns", (MODELLED, why.TURNS)),
        "Coriolis coupling of stretch": Explanation(
            "2 ω c M12 q2'", "the carrier turns", (MODELLED, why.TURNS, why.IN_PLANE)
        ),
        "Coriolis coupling of bending": Explanation(
            "-2 ω c M21 q1'", "the carrier turns", (MODELLED, why.TURNS, why.IN_PLANE)
        ),
        "Euler coupling of stretch": Explanation(
            "ω' c M12 q2", "the speed varies", (MODELLED, why.ACCELERATES, why.IN_PLANE)
        ),
        "Euler coupling of bending": Explanation(
            "-ω' c M21 q1", "the speed varies", (MODELLED, why.ACCELERATES, why.IN_PLANE)
        ),
        "axial damping": Explanation("2 ζ Λ q1'", "the damping ratio is not 0", (MODELLED, why.DAMPED)),
        "centrifugal stretching": Explanation("ω² Q1", "the carrier turns", (MODELLED, why.TURNS)),
        "axial root acceleration": Explanation("-aO1 P1", why.say_tension, (MODELLED, why.TENSIONED)),
    }

    def is_modelled(self, scene: Scene) -> bool:
        """Whether `scene.stretch` is set."""
        return scene.stretch

    def complete(self, scene: Scene) -> Scene:
        """Set `stretch`, and an axial stiffness if there is none."""
        stiffness = scene.beam.axial_stiffness or scene.beam.bending_stiffness
        return replace(scene, beam=replace(scene.beam, axial_stiffness=stiffness), stretch=True)

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble eqs. (13) of Lee and Yoo (2019), and the coupling in (14)."""
        op = stretch_operators(scene.beam, spaces)
        return FieldEquations(len(op.P), (*_terms(scene, op),), (*_loads(op),))


def _terms(scene: Scene, op: StretchOperators) -> Iterator[Term]:
    b, s, (c, _) = Bending.name, Stretch.name, exact_cos_sin(scene.mount.bending_angle)
    yield Term("stretch mass", s, s, 2, op.M)
    yield Term("axial stiffness", s, s, 0, op.KS)
    yield Term("axial spin softening", s, s, 0, op.M, "speed_squared", -1.0)
    yield Term("Coriolis coupling of stretch", s, b, 1, op.M12, "speed", 2 * c)
    yield Term("Coriolis coupling of bending", b, s, 1, op.M12.T, "speed", -2 * c)
    yield Term("Euler coupling of stretch", s, b, 0, op.M12, "acceleration", c)
    yield Term("Euler coupling of bending", b, s, 0, op.M12.T, "acceleration", -c)
    if scene.damping_ratio:
        yield Term("axial damping", s, s, 1, modal_damping(op.M, op.KS), factor=scene.damping_ratio)


def _loads(op: StretchOperators) -> Iterator[Load]:
    yield Load("centrifugal stretching", Stretch.name, op.Q, "speed_squared")
    yield Load("axial root acceleration", Stretch.name, op.P, "root_axial", -1.0)
