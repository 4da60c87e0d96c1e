"""Bending: the transverse deflection u of an Euler-Bernoulli beam under tension."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.centrifugal_tension import axial_tension
from beamdyn.equations.damping import modal_damping
from beamdyn.equations.discretization import Space, Spaces
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.field import Deflection, Field, FieldEquations, Load, Term
from beamdyn.equations.root_motion import exact_cos_sin
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.profile import FRACTION
from beamdyn.scene.scene import Scene

HELD = 2  # a clamped root: no deflection, no slope


@dataclass(frozen=True)
class BendingOperators:
    """Matrices (n, n) and vectors (n,) of the deflection u = sum phi_i(x/L) q_i, with the tip body.

    Symbols and equation numbers are those of Lee and Yoo (2019), eqs. (15)-(21), with rho A for their rho.

    Parameters
    ----------
    M : ndarray
        Mass (15) [kg].
    S : ndarray
        Mass matrix of the spin softening [kg]: M without the rotary inertia of the tip body.
    J : ndarray
        (J_e - J_1) phi_i'(L) phi_j'(L) [kg]: stiffening as the tip body tilts out of the plane of rotation.
    KB : ndarray
        Bending stiffness (17) [N/m].
    KGA : ndarray
        Stiffness due to the tension by a unit root acceleration (18) [kg/m].
    KGB : ndarray
        Stiffness due to the tension by rotation at unit speed about the root (19) [kg].
    P : ndarray
        Load under a unit root acceleration (21) [kg].
    Q : ndarray
        Load under a unit angular acceleration (20) [kg m].
    """

    M: np.ndarray
    S: np.ndarray
    J: np.ndarray
    KB: np.ndarray
    KGA: np.ndarray
    KGB: np.ndarray
    P: np.ndarray
    Q: np.ndarray


def bending_operators(beam: Beam, space: Space) -> BendingOperators:
    """Integrate the operators of bending in a space of clamped functions."""
    length, mass, tip = beam.length, beam.mass_per_length, beam.tip or TipMass(0.0)
    n_a, n_b = axial_tension(beam)
    reach = length + tip.offset
    slope = space.end(1) / length  # D: tip slope per coordinate
    centre = space.end(0) + tip.offset * slope  # t: deflection of the tip body's centre of gravity
    dd, tt = np.outer(slope, slope), np.outer(centre, centre)
    spin = space.gram(mass, 0) * length + tip.mass * tt
    return BendingOperators(
        M=spin + tip.inertia * dd,
        S=spin,
        J=(tip.inertia_about_bending_direction - tip.axial_inertia) * dd,
        KB=space.gram(beam.bending_stiffness, 2) / length**3,
        KGA=space.gram(n_a, 1) / length + tip.mass * tip.offset * dd,
        KGB=space.gram(n_b, 1) / length + tip.mass * reach * tip.offset * dd,
        P=space.load(mass) * length + tip.mass * centre,
        Q=space.load(mass * FRACTION) * length**2 + tip.mass * reach * centre + tip.inertia * slope,
    )


class Bending(Field):
    """Transverse deflection of the beam."""

    name = "bending"
    explanations: ClassVar[Mapping[str, Explanation]] = {
        "mass": Explanation("M22 q2''", "always"),
        "bending stiffness": Explanation("KB q2", "always"),
        "centrifugal stiffening": Explanation("ω² KGB q2", "the carrier turns", (why.TURNS,)),
        "spin softening": Explanation(
            "-ω² c² S22 q2", "it bends in the plane of rotation", (why.TURNS, why.IN_PLANE)
        ),
        "spin of the tip body": Explanation(
            "ω² s² (Je - J1) D Dᵀ q2",
            "the tip body tilts out of the plane of rotation",
            (why.TIP_BODY, why.TIP_INERTIA, why.OUT_OF_PLANE, why.TURNS),
        ),
        "tension by root acceleration": Explanation("-aO1 KGA q2", why.say_tension, (why.TENSIONED,)),
        "damping": Explanation("2 ζ Λ q2'", "the damping ratio is not 0", (why.DAMPED,)),
        "angular acceleration": Explanation("ω' c Q2", "the speed varies", (why.ACCELERATES, why.IN_PLANE)),
        "root acceleration": Explanation("-(c aO2 + s aO3) P2", why.say_static_load, (why.LOADED,)),
    }

    def is_modelled(self, scene: Scene) -> bool:
        """Every scene has this field."""
        return True

    def complete(self, scene: Scene) -> Scene:
        """Add a tip body, damping, and angles at which no term vanishes."""
        body = TipMass(1.0, inertia=1.0, axial_inertia=0.5)
        return replace(
            scene, beam=replace(scene.beam, tip=body), mount=Mount(1.0, 1.0, 1.0), damping_ratio=0.5
        )

    def assemble(self, scene: Scene, spaces: Spaces) -> FieldEquations:
        """Assemble eqs. (14) of Lee and Yoo (2019), corrected, with tip body and bending angle."""
        space = spaces.functions(HELD)
        op = bending_operators(scene.beam, space)
        deflection = Deflection(space, op.P, op.Q)
        return FieldEquations(space.size, (*_terms(scene, op),), (*_loads(scene, op),), deflection)


def _terms(scene: Scene, op: BendingOperators) -> Iterator[Term]:
    b, (c, s) = Bending.name, exact_cos_sin(scene.mount.bending_angle)
    yield Term("mass", b, b, 2, op.M)
    yield Term("bending stiffness", b, b, 0, op.KB)
    yield Term("centrifugal stiffening", b, b, 0, op.KGB, "speed_squared")
    yield Term("spin softening", b, b, 0, op.S, "speed_squared", -(c**2))
    yield Term("spin of the tip body", b, b, 0, op.J, "speed_squared", s**2)
    yield Term("tension by root acceleration", b, b, 0, op.KGA, "root_axial", -1.0)
    if scene.damping_ratio:
        yield Term("damping", b, b, 1, modal_damping(op.M, op.KB), factor=scene.damping_ratio)


def _loads(scene: Scene, op: BendingOperators) -> Iterator[Load]:
    b, (c, _) = Bending.name, exact_cos_sin(scene.mount.bending_angle)
    yield Load("angular acceleration", b, op.Q, "acceleration", c)
    yield Load("root acceleration", b, op.P, "root_transverse", -1.0)
