"""Shear deformation: the part of the deflection that does not turn the sections (Timoshenko).

The deflection is u = u_b + u_s, with the sections' rotation u_b'.  Shear is thus a field that vanishes at
the root like the stretch; there is no locking, and the slender beam is the exact limit.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import ClassVar

from beamdyn.equations.discretization import FIXED, RootConditions
from beamdyn.equations.explanations import Explanation
from beamdyn.equations.fields.bending import SecondBending
from beamdyn.equations.fields.field import Term
from beamdyn.equations.fields.transverse import Pair, TransverseField, term_of
from beamdyn.scene.mount import Mount
from beamdyn.scene.scene import Scene
from beamdyn.scene.sections import section_tensor


class Shear(TransverseField):
    """Shear deflection in the direction of the bending angle."""

    name = "shear"
    direction = 0
    rotates = False
    partners = (*SecondBending.partners, SecondBending())
    explanations: ClassVar[Mapping[str, Explanation]] = {
        **TransverseField.explanations,
        "shear stiffness": Explanation("KQ q2", "shear is modelled"),
    }

    def is_modelled(self, scene: Scene) -> bool:
        """Whether `physics.shear` is set."""
        return scene.physics.shear

    def complete(self, scene: Scene) -> Scene:
        """The scene as it is."""
        return scene

    def conditions(self, mount: Mount) -> RootConditions:
        """No deflection at the root."""
        return FIXED.against("shear_stiffness", self.direction)

    def own_stiffness(self, pair: Pair) -> Iterator[Term]:
        """Yield the shear stiffness of shear with shear."""
        stiffness = section_tensor(pair.rows.beam, "shear_stiffness").get(pair.directions)
        if stiffness is not None and not pair.rows.rotates:
            yield term_of("shear stiffness", pair, pair.integrate(stiffness, 1))


class SecondShear(Shear):
    """Shear deflection in the direction across."""

    name = "second shear"
    direction = 1
    partners = (*Shear.partners, Shear())

    def is_modelled(self, scene: Scene) -> bool:
        """Whether shear and both planes are modelled."""
        return scene.physics.shear and scene.physics.planes == 2
