"""Separation of two uncoupled planes of bending into scenes with one plane each."""

from __future__ import annotations

import math
from dataclasses import replace

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.scene.beam import Beam, TipMass
from beamdyn.scene.mount import RIGHT_ANGLE, aligned_cos_sin
from beamdyn.scene.physics import Physics
from beamdyn.scene.scene import Scene
from beamdyn.scene.validity import refuse_large_deflection

_SPRINGS = "root_stiffness", "second_root_stiffness"
_QUARTER = math.pi / 2


def separate_planes(scene: Scene, spinning: bool = True) -> tuple[Scene, ...]:
    """Split a scene into scenes of slender beams with one plane each.

    Parameters
    ----------
    scene : Scene
        The scene.
    spinning : bool
        Whether the carrier rotates; if not, the bending angle and the precone do not couple the planes.

    Returns
    -------
    tuple of Scene
        The scene itself, if its beam is slender and modelled in one plane.  For two uncoupled planes of a
        slender beam, a scene for the direction of bending at the root, and one for the perpendicular one;
        otherwise empty.
    """
    if scene.is_slender_beam_in_one_plane:
        return (scene,)
    slender = replace(scene.physics, planes=1, stretch=False) == Physics()
    clamped = min(scene.mount.root_stiffnesses[: scene.physics.planes]) == math.inf
    if not (slender and clamped) or (quarters := _quarter_turns(scene.beam)) is None:
        return ()
    if spinning and (scene.mount.precone or 0.0 not in aligned_cos_sin(scene.mount.bending_angle)):
        return ()
    beam, tip, angle = scene.beam, scene.beam.tip, scene.mount.bending_angle
    assert beam.second_bending_stiffness is not None
    properties = ("bending_stiffness", "shear_stiffness", "rotary_inertia")
    unread = (*(f"second_{name}" for name in properties), *properties[1:], "twist")
    first = replace(beam, **dict.fromkeys(unread))
    if tip is not None:  # in the second direction, the tip body rotates about another axis
        moments = tip.inertia_about_bending_direction, tip.inertia, tip.axial_inertia
        tip = TipMass(tip.mass, tip.offset, *moments)
    second = replace(first, bending_stiffness=beam.second_bending_stiffness, tip=tip, outer_fibre=None)
    angles = angle, angle - math.copysign(_QUARTER, angle)
    bent = zip((first, second)[:: -1 if quarters % 2 else 1], angles, strict=True)
    return tuple(
        replace(scene, beam=each, mount=replace(scene.mount, bending_angle=at), physics=Physics())
        for each, at in bent
    )


def refuse_uncovered(scene: Scene, speed: float) -> None:
    """Raise an error for a scene with features that `beamdyn.modes.bounds` does not cover.

    Raises
    ------
    InvalidValue
        If the theorem does not cover the scene; the message has the remedy.
    """
    bound = "bounds are known for an undamped slender beam on a clamped root"
    refuse_large_deflection(scene, bound)
    for name in ("shear", "rotary_inertia", "camber", "torsion", "stretch"):
        if getattr(scene.physics, name):
            raise InvalidValue(f"physics.{name}", True, bound, "leave it out of physics")
    if scene.damping_ratio:
        raise InvalidValue("damping_ratio", scene.damping_ratio, bound, "give 0")
    if scene.damping.damps:
        raise InvalidValue("damping", scene.damping, bound, "leave it out")
    if scene.beam.point_springs:
        raise InvalidValue("point_springs", len(scene.beam.point_springs), bound, "leave them out")
    springs = {name: getattr(scene.mount, name) for name in _SPRINGS[: scene.physics.planes]}
    for name, value in springs.items():
        if math.isfinite(value):
            raise InvalidValue(name, value, bound, "leave it out", "N m/rad")
    lumps = scene.beam.point_masses
    if lumps and scene.physics.planes == 2 and not separate_planes(scene, spinning=bool(speed)):
        of_lumps = (
            "bounds for two planes coupled by twist or bending angle are known only without point masses"
        )
        raise InvalidValue("point_masses", len(lumps), of_lumps, "leave them out, or model one plane")
    if scene.physics.planes == 2 and speed and scene.mount.precone:
        gyroscopic = "precone couples two planes by gyroscopic terms, but bounds need equations without them"
        remedy = "give 0, or speed = 0, or model one plane"
        raise InvalidValue("precone", scene.mount.precone, gyroscopic, remedy, "rad")


def _quarter_turns(beam: Beam) -> int | None:
    """Return by how many 90 degree turns the twist turns all sections; None unless one whole number."""
    if beam.twist is None:
        return 0
    if any(any(row[1:]) for row in beam.twist.coefficients):
        return None
    turned = {row[0] / _QUARTER for row in beam.twist.coefficients}
    whole = {round(c) for c in turned if abs(c - round(c)) <= RIGHT_ANGLE / _QUARTER * max(1.0, abs(c))}
    return whole.pop() if len(whole) == len(turned) == 1 else None
