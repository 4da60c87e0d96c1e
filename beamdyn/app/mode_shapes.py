"""The screen of mode shapes at one speed, which move as a slider is played."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from beamdyn import natural_modes
from beamdyn.app.bent_beam import bent_beam
from beamdyn.app.headlines import of_modes, of_numbers
from beamdyn.app.inputs import DRAGS, read_at_speed
from beamdyn.app.scene_screen import scene_screen
from beamdyn.common.drawing.shapes import Drawing
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.screens.screens import Drag, Slider
from beamdyn.equations.effects import words_of_directions
from beamdyn.modes.modes import Modes

_PLACES = 41  # along the beam
_LARGEST = 0.22  # deflection drawn, over the length
_ABREAST = 2  # drawings in a row


def solve(tables: Mapping[str, Any]) -> Modes:
    """The modes at the speed."""
    scene, speed, modes = read_at_speed(tables)
    return natural_modes(scene, speed, modes)


def drawings(modes: Modes, place: float = 0.0) -> Rows:
    """Each mode shape at a phase of its vibration: 0 and 2 are the extremes, 1 is the undeflected beam."""
    each = [*_drawings(modes, 1.0 - place)]
    return [each[i : i + _ABREAST] for i in range(0, len(each), _ABREAST)]


def _drawings(modes: Modes, swing: float) -> Iterator[Drawing]:
    length = modes.scene.beam.length
    x = np.linspace(0.0, length, _PLACES)
    words = words_of_directions(modes.scene)
    for i, name in enumerate(modes.labels()):
        main = int(modes.plane_share[i].argmax()) if words else 0
        shape = np.real(modes.shape(x, main)[i])
        shape *= _LARGEST * length / (np.abs(shape).max() or 1.0)
        said = f"{name}, drawn in {words[main]}" if words else name
        yield bent_beam(x, swing * shape, said, "", (shape, -shape), _LARGEST * length)


MODE_SHAPES = scene_screen(
    "Mode shapes",
    "How the beam moves in each natural mode at one speed; the sizes of the deflections are arbitrary.",
    solve,
    ("operation", "options"),
    left_out_of="frequencies",
    slider=Slider("swing", ("one way", "at rest", "other way"), 0.05),
    drags=(Drag("operation.speed", 0.0, 150.0, 1.0, "rad/s"), *DRAGS),
    drawings=drawings,
    headline=lambda modes: [*of_modes(modes)],
    quick_headline=lambda modes: [*of_numbers(modes)],
)
