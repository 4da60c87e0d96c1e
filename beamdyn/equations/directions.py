"""The two directions of bending at the root, in words."""

from __future__ import annotations

from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.scene.mount import aligned_cos_sin
from beamdyn.scene.scene import Scene

_OUTWARD = -1.0, 0.0  # cosine and sine of the setting angle
# Directions in words, and in a word.
_EDGE = "in the plane of rotation (edge)", "edge"
_FLAP = "out of the plane of rotation (flap)", "flap"
_OWN_EDGE = "edgewise, in the section's direction (edge)", "edge"
_OWN_FLAP = "flapwise, in the section's direction (flap)", "flap"
_BENDING = "in the direction of bending", "bending"
_ACROSS = "across the direction of bending", "across"


def check_direction(direction: int) -> int:
    """Refuse what is no direction of deflection: 0 is that of bending at the root, 1 that across."""
    if direction not in (0, 1):
        bound = "give 0 for the direction of bending at the root, or 1 for the direction across"
        raise InvalidValue("direction", direction, bound)
    return direction


def name_directions(scene: Scene) -> tuple[tuple[str, str], tuple[str, str]]:
    """Name the direction of bending at the root, and that across, each in words and in a word.

    They are edge and flap where the bending angle is a whole number of quarter turns.  Of a beam that points
    outward they are so at any angle, a blade's pitch: flap is the direction nearer to the axis of rotation.
    """
    c, s = aligned_cos_sin(scene.mount.bending_angle)
    if s == 0:
        return _EDGE, _FLAP
    if c == 0:
        return _FLAP, _EDGE
    if aligned_cos_sin(scene.mount.setting_angle) != _OUTWARD:
        return _BENDING, _ACROSS
    return (_OWN_FLAP, _OWN_EDGE) if abs(s) >= abs(c) else (_OWN_EDGE, _OWN_FLAP)


def first_drawn(scene: Scene) -> int:
    """Direction that is drawn solid: flap if one is, else the direction of bending."""
    return 1 if name_directions(scene)[1][1] == "flap" else 0


def modelled_directions(scene: Scene) -> tuple[str, ...]:
    """Names of the directions in which a scene's beam bends, that of bending at the root first."""
    return tuple(words for words, _ in name_directions(scene))[: scene.physics.planes]


def words_of_directions(scene: Scene) -> tuple[str, ...]:
    """Name the two directions of bending in a word each; none where one plane is modelled."""
    return tuple(word for _, word in name_directions(scene) if scene.physics.planes == 2)
