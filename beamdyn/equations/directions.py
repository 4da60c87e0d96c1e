"""The two directions of bending at the root, in words."""

from __future__ import annotations

from beamdyn.common.checks import InvalidValue
from beamdyn.scene.mount import Mount, exact_cos_sin
from beamdyn.scene.scene import Scene

# Directions in words, and in a word.
_EDGE = "in the plane of rotation (edge)", "edge"
_FLAP = "out of the plane of rotation (flap)", "flap"
_BENDING = "in the direction of bending", "bending"
_ACROSS = "across the direction of bending", "across"


def check_direction(direction: int) -> int:
    """Refuse what is no direction of deflection: 0 is that of bending at the root, 1 that across."""
    if direction not in (0, 1):
        bound = "give 0 for the direction of bending at the root, or 1 for the direction across"
        raise InvalidValue("direction", direction, bound)
    return direction


def name_directions(mount: Mount) -> tuple[tuple[str, str], tuple[str, str]]:
    """Name the direction of bending at the root, and that across, each in words and in a word.

    They are edge and flap where the bending angle is a whole number of quarter turns.
    """
    c, s = exact_cos_sin(mount.bending_angle)
    if s == 0:
        return _EDGE, _FLAP
    return (_FLAP, _EDGE) if c == 0 else (_BENDING, _ACROSS)


def first_drawn(mount: Mount) -> int:
    """Direction that is drawn solid: flap if one is, else the direction of bending."""
    return 1 if name_directions(mount)[1] is _FLAP else 0


def modelled_directions(scene: Scene) -> tuple[str, ...]:
    """Names of the directions in which a scene's beam bends, that of bending at the root first."""
    return tuple(words for words, _ in name_directions(scene.mount))[: scene.physics.planes]


def words_of_directions(scene: Scene) -> tuple[str, ...]:
    """The same, each in a word; none where one plane is modelled, which needs no telling apart."""
    return tuple(word for _, word in name_directions(scene.mount) if scene.physics.planes == 2)
