"""Words for the two directions of bending at the root."""

from __future__ import annotations

import math

from beamdyn.scene.scene import Scene


def direction_names(scene: Scene) -> tuple[str, ...]:
    """Names of the directions in which a scene's beam bends, by their angles to the plane of rotation.

    Parameters
    ----------
    scene : Scene
        The scene.

    Returns
    -------
    tuple of str
        Such as "e1 (out of the plane of rotation)" and "e2 (in the plane of rotation)" of an ordinary blade;
        one for a beam that bends in one plane.
    """
    turned = math.degrees(scene.mount.bending_angle) % 180.0
    out_of_plane = min(turned, 180.0 - turned)
    angles = (out_of_plane, 90.0 - out_of_plane)[: scene.physics.planes]
    return tuple(f"e{i} ({_place(angle)})" for i, angle in enumerate(angles, 1))


def _place(degrees: float) -> str:
    words = {0.0: "in the plane of rotation", 90.0: "out of the plane of rotation"}
    return words.get(round(degrees, 6), f"{degrees:.4g} deg to the plane of rotation")
