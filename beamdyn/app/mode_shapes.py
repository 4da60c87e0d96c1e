"""The screen of mode shapes at one speed, animated by a slider."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np

from beamdyn import natural_modes
from beamdyn.app.drawings import bent_beam, bent_strip
from beamdyn.app.scene_form import DRAGS, read_at_speed
from beamdyn.app.scene_screen import scene_screen
from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Drawing
from beamdyn.common.results.one_line import number
from beamdyn.common.screens.screen_parts import Drag, KeyResult, Slider
from beamdyn.equations.effects import words_of_directions
from beamdyn.modes.model_error.left_out_effects import say_size
from beamdyn.modes.modes import Mesh, Modes

_PLACES, _ROWS = 41, 5  # number of positions along the beam, and across the width of a strip
# Largest drawn deflection of a beam, and of a strip, as a fraction of the length.
_LARGEST, _LARGEST_OF_STRIP = 0.22, 0.12
_ABREAST = 2  # number of drawings side by side


def solve(tables: Mapping[str, Any]) -> Modes:
    """Compute the modes at the speed in the tables."""
    scene, speed, modes = read_at_speed(tables)
    return natural_modes(scene, speed, modes)


def drawings(modes: Modes, place: float = 0.0) -> Rows:
    """Draw each mode shape at a phase of its vibration: `place` 0 and 2 are extremes, 1 is undeflected."""
    if (mesh := modes.mesh(_PLACES, _ROWS)) is not None:
        return _abreast(_strips(modes, mesh, 1.0 - place))
    length, words = modes.scene.beam.length, words_of_directions(modes.scene)
    x = np.linspace(0.0, length, _PLACES)
    each = []
    for i, name in enumerate(modes.labels()):
        main = int(modes.plane_share[i].argmax()) if words else 0
        shape = np.real(modes.shape(x, main)[i])
        shape *= _LARGEST * length / (np.abs(shape).max() or 1.0)
        title = f"{name}, drawn in {words[main]}" if words else name
        each.append(bent_beam(x, (1.0 - place) * shape, title, "", (shape, -shape), _LARGEST * length))
    return _abreast(each)


def _strips(modes: Modes, mesh: Mesh, swing: float) -> list[Drawing]:
    """Draw each mode shape of a strip that twists or cambers, multiplied by the factor `swing`."""
    x, y, shapes, across = mesh
    room = _LARGEST_OF_STRIP * float(x[-1])
    each = []
    for name, shape, aside in zip(modes.labels(), shapes, across, strict=True):
        scale = swing * room / (max(np.abs(shape).max(), np.abs(aside).max()) or 1.0)
        each.append(bent_strip(x, y, scale * shape, scale * aside, name, room))
    return each


def _abreast(drawings: list[Drawing]) -> Rows:
    return [drawings[i : i + _ABREAST] for i in range(0, len(drawings), _ABREAST)]


def quick_headline(modes: Modes) -> Iterator[KeyResult]:
    """Yield the first frequency, and the largest numerical error of all modes."""
    first = modes.frequency[0]
    yield KeyResult("first frequency", number(first, "Hz") if np.isfinite(first) else "diverges")
    yield KeyResult("numerical error at most", f"{float(np.max(modes.error)):.0e}")


def headline(modes: Modes) -> Iterator[KeyResult]:
    """Yield the results of `quick_headline`, and the largest model error, whose computation takes longer."""
    yield from quick_headline(modes)
    if np.isfinite(modes.model_error).any():
        yield KeyResult("model error at most", say_size(float(np.nanmax(modes.model_error))))


MODE_SHAPES = scene_screen(
    "Mode shapes",
    "How the beam moves in each natural mode at one speed; the sizes of the deflections are arbitrary.",
    solve,
    ("operation", "options"),
    left_out_of="frequencies",
    slider=Slider("swing", ("one way", "at rest", "other way"), 0.05),
    drags=(Drag("operation.speed", 0.0, 150.0, 1.0, "rad/s"), *DRAGS),
    drawings=drawings,
    headline=headline,
    quick_headline=quick_headline,
)
