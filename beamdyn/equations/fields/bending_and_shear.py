"""Fields of bending, with sections normal to the axis, and of shear (Timoshenko), in two directions each.

The deflection is u = u_b + u_s, with the sections' rotation u_b'.  Shear is thus a field that vanishes at
the root like the stretch; there is no locking, and the slender beam is the exact limit.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from dataclasses import replace
from typing import ClassVar

import numpy as np

from beamdyn.equations import explanations as why
from beamdyn.equations.discretization import CLAMPED, FIXED, HINGED, RootConditions
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.field import Term
from beamdyn.equations.fields.transverse import Pair, TransverseField
from beamdyn.scene.beam import PointSpring, TipMass
from beamdyn.scene.mount import Mount
from beamdyn.scene.profile import Profile
from beamdyn.scene.rectangle import Rectangle
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import section_tensor


class Bending(TransverseField):
    """Bending in the direction of the bending angle: the field that every scene has."""

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
        """Return the scene with tip body, damping, springs and angles that make every term present."""
        body = TipMass(1.0, inertia=1.0, transverse_inertia=0.8, axial_inertia=0.5)
        mount = Mount(1.0, math.pi, 1.0, root_stiffness=1.0, second_root_stiffness=1.0, precone=0.5)
        springs = (PointSpring(scene.beam.length, scene.beam.bending_stiffness(np.zeros(1))[0]),)
        beam = replace(scene.beam, tip=body, point_springs=springs)
        return replace(scene.undamped, beam=beam, mount=mount, damping_ratio=0.5)

    def conditions(self, mount: Mount) -> RootConditions:
        """Return the conditions at the root: clamped, or hinged where a spring holds the root."""
        at_root = HINGED if math.isfinite(mount.root_stiffnesses[self.direction]) else CLAMPED
        return at_root._replace(stiffness="bending_stiffness", direction=self.direction)

    def stiffening(self, section: Rectangle, length: float) -> Profile:
        """Compute the bending stiffness of sections that keep their shape over that of cambering ones."""
        return section.camber_stiffening

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the bending stiffness and the spring at the root."""
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
    """Bending in the direction across, for scenes with both planes."""

    name = "second bending"
    direction = 1
    requires: ClassVar[Mapping[str, object]] = {"planes": 2}
    partners = (*Bending.partners, Bending())

    def stiffening(self, section: Rectangle, length: float) -> Profile:
        """Compute the bending stiffness near a clamped root, which hinders camber, over that elsewhere."""
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
        """Return the conditions at the root: no shear deflection."""
        return FIXED._replace(stiffness="shear_stiffness", direction=self.direction)

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the shear stiffness between two shear fields."""
        stiffness = section_tensor(pair.rows.beam, "shear_stiffness").get(pair.directions)
        if stiffness is not None and not pair.rows.field.rotates:
            yield pair.term("shear stiffness", pair.integrate(stiffness, 1))


class SecondShear(Shear):
    """Shear deflection in the direction across, for scenes with shear and both planes."""

    name = "second shear"
    direction = 1
    requires: ClassVar[Mapping[str, object]] = {"shear": True, "planes": 2}
    partners = (*Shear.partners, Shear())
