"""Words for the directions in which a beam bends, for pictures and tables of its motion."""

from __future__ import annotations

from beamdyn.scene.scene import Scene
from beamdyn.spectrum.planes import name_directions


def direction_names(scene: Scene) -> tuple[str, ...]:
    """Names of the directions, that of bending at the root first; one where one plane is modelled."""
    return tuple(words for words, _ in name_directions(scene.mount))[: scene.physics.planes]
