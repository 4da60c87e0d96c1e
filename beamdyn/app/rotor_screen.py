"""The screen of the rotor: a drawing of the beam on its rotor, with points that the user can drag."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from beamdyn import draw as draw_rotor
from beamdyn.app.scene_form import first_frequency, read_scene
from beamdyn.app.scene_screen import scene_screen
from beamdyn.common.drawing.layout import Rows
from beamdyn.common.screens.screen_parts import Handle
from beamdyn.scene.rotor import RotorDrawing

# A length set by dragging is rounded to a multiple of a power of ten: the largest that is at most the length
# of the beam divided by this number.
_STEPS = 200


def solve(tables: Mapping[str, Any]) -> RotorDrawing:
    """Make the drawing of the rotor; raise an error if the scene cannot be computed."""
    scene = read_scene(tables)
    first_frequency(scene)  # raises an error if the scene cannot be computed
    return draw_rotor(scene)


def drawings(rotor: RotorDrawing, _: float = 0.0) -> Rows:
    """Draw the rotor seen along its axis, and beside it the cross-section at the root in its own scale.

    If the beam is also drawn separately in its own scale, it and the cross-section are in a second row.
    """
    (plan,), *details = rotor.drawings()
    apart = [replace(detail, own_scale=True) for (detail,) in details]
    return [[plan], apart] if len(apart) > 1 else [[plan, *apart]]


def handles(rotor: RotorDrawing, _: float = 0.0) -> Sequence[Handle]:
    """Make handles that set the radius, the setting angle and the length of the beam."""
    r, C = rotor.radius, np.cos(rotor.precone)
    along = np.array([-np.cos(rotor.setting_angle), np.sin(rotor.setting_angle)])
    grain = float(10.0 ** np.floor(np.log10(rotor.length / _STEPS)))

    def turn(x: float, y: float) -> dict[str, float]:
        return {"mount.setting_angle": float(np.arctan2(y, r - x))}

    def stretch(x: float, y: float) -> dict[str, float]:
        return {"beam.length": max(2 * float(np.hypot(x - r, y)) / C, grain)}

    def place(share: float) -> tuple[float, float]:
        x, y = np.array([r, 0.0]) + share * rotor.length * C * along
        return float(x), float(y)

    each = {"step": 10 * grain, "grain": grain}
    return (
        Handle("root: radius", (r, 0.0), lambda x, y: {"mount.radius": max(x, 0.0)}, **each),
        Handle("tip: setting angle", place(1.0), turn, **each),
        Handle("middle of the beam: length", place(0.5), stretch, **each),
    )


ROTOR = scene_screen(
    "Rotor",
    "The beam on its carrier, seen along the axis of rotation, and the section of its root.",
    solve,
    (),
    draw=lambda rotor, _: rotor.figure(),
    drawings=drawings,
    handles=handles,
    effort="",
)
