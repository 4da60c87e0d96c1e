"""Checks of the load at the tip and of springs, at the root and along the beam, against beam and physics."""

from __future__ import annotations

import math

from beamdyn.common.inputs.checks import InvalidValue, refuse
from beamdyn.common.words import Setting, Words
from beamdyn.scene.beam import Beam
from beamdyn.scene.mount import Mount, aligned_cos_sin
from beamdyn.scene.physics import AutomaticPhysics, Physics
from beamdyn.scene.points import ACROSS, TipLoad
from beamdyn.scene.profile import mean

ROOT_SPRINGS = "root_stiffness", "second_root_stiffness"
_ALONG = 1e-12  # component out of the plane of bending, over the load, that counts as rounding
# Spring at the root over EI/L of the beam: a stiffer one turns by less than rounding of the beam's bending.
_STIFFEST = 1e16
# Spring along the beam over EI/L^3: beyond, rounding hides the deflection that the spring allows.
_STIFFEST_POINT = 1e9


def check_tip_load(load: TipLoad, mount: Mount, physics: Physics | AutomaticPhysics) -> None:
    """Refuse a load at the tip of a straight beam, and one in a direction in which the beam is rigid."""
    if not load.acts:
        return
    if not physics.large_deflection:
        bound = "a load at the tip changes the shape about which a beam vibrates"
        remedy = Words(Setting("physics", large_deflection=True), " models it")
        raise InvalidValue("physics.large_deflection", False, bound, remedy)
    if physics.planes == 2:
        return
    c, s = aligned_cos_sin(mount.bending_angle)
    (_, *force), (turning, *moment) = load.force, load.moment
    across = [c * force[1] - s * force[0], c * moment[0] + s * moment[1], 0.0 if physics.torsion else turning]
    if max(map(abs, across)) > _ALONG * max(map(abs, (*load.force, *load.moment))):
        bound = "the load at the tip acts out of the one plane in which the beam bends, where it is rigid"
        raise InvalidValue("physics.planes", 1, bound, Words("give ", Setting("physics", planes=2)))


def check_root_springs(mount: Mount, beam: Beam) -> None:
    """Refuse modelled root springs that are so stiff that rounding hides the beam's own stiffness."""
    bending = [EI for EI in (beam.bending_stiffness, beam.second_bending_stiffness) if EI is not None]
    for name, spring in zip(ROOT_SPRINGS, mount.root_stiffnesses, strict=True):
        modelled = name == "root_stiffness" or beam.second_bending_stiffness is not None
        if modelled and spring < math.inf and spring > 0:
            stiffest = _STIFFEST * max(map(mean, bending)) / beam.length
            bound = "it must be at most {limit}, 1e16 EI/L of the beam: rounding hides the turn beyond"
            remedy = "leave it out: the root is clamped"
            refuse(spring > stiffest, f"mount.{name}", spring, "N m/rad", bound, remedy, limit=stiffest)


def check_point_springs(beam: Beam, physics: Physics | AutomaticPhysics) -> None:
    """Refuse point springs that rounding does not tell from supports, and springs in a rigid direction."""
    for k, spring in enumerate(beam.point_springs):
        stiffest = _STIFFEST_POINT * mean(beam.bending_stiffness) / beam.length**3
        bound = "it must be at most {limit}, 1e9 EI/L^3 of the beam"
        name = f"point_springs[{k}].stiffness"
        refuse(spring.stiffness > stiffest, name, spring.stiffness, "N/m", bound, "soften it", limit=stiffest)
        if spring.direction == ACROSS and physics.planes == 1:
            bound = "a beam of one plane is rigid in this direction"
            remedy = Words("give ", Setting("physics", planes=2))
            raise InvalidValue(f"point_springs[{k}].direction", ACROSS, bound, remedy)
