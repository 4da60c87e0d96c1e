"""Sketches that explain the inputs of calipers and mechanisms: dimensions, symbols of joints, angles."""

from __future__ import annotations

from collections.abc import Callable, Sequence

import numpy as np

from beamdyn.common.drawing.shapes import Arrow, Drawing, Label, Outline, Symbol
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.drawing.sketch import Sketch
from brakes.calipers import NAMED
from brakes.drawings.caliper import caliper_drawing
from brakes.drawings.sketches import bicycle_sketch
from brakes.planar import solve

_MM = 1e3
_LETTERS = 9.0


def caliper_sketch(name: str) -> Rows:
    """A named caliper with the names of its dimensions, and the vehicle; for an unknown name the latter."""
    return [[_dimensions(name)], [bicycle_sketch()]] if name in NAMED else [[bicycle_sketch()]]


def _dimensions(name: str) -> Drawing:
    design = NAMED[name]()
    drawn = caliper_drawing(design.build(), solve(design.build().mechanism), design.label)
    points = {key: value for key, value in vars(design).items() if isinstance(value, tuple)}
    middle = np.mean([*points.values()], axis=0)
    places: dict[tuple[float, float], list[str]] = {}
    for key, at in points.items():
        places.setdefault(at, []).append(key.replace("_", " "))
    labels = [
        Label("\n".join(names), np.multiply(_MM, at), "dimension", tuple(np.sign(at - middle)), size=_LETTERS)
        for at, names in places.items()
    ]
    words = f"Where the points of the form are: {', '.join(key.replace('_', ' ') for key in points)}"
    marks = [Symbol("dot", np.multiply(_MM, at), "dimension", 5.0) for at in places]
    shapes = [shape for shape in drawn.shapes if getattr(shape, "role", "") not in ("load", "reaction")]
    return Drawing((*shapes, *marks), tuple(labels), f"{design.label}, seen from the front", words, unit="")


def mechanism_sketch(stops: bool) -> Rows:
    """The symbols of joints and loads, and the angles of directions; with a vehicle if it stops one."""
    return [[_symbols()], [_directions()], *([[bicycle_sketch()]] if stops else [])]


def _symbols() -> Drawing:
    s = Sketch()
    symbols: Sequence[tuple[str, Callable[[Sketch, float, float], None]]] = (
        ("pin", _pin),
        ("pin on the ground", _grounded),
        ("bar", _bar),
        ("cable", _cable),
        ("spring", _spring),
        ("slot, contact", _face),
    )
    for i, (words, draw) in enumerate(symbols):
        x, y = 2.6 * (i % 2), -0.8 * (i // 2)
        draw(s, x, y)
        s.labels.append(Label(words, (x + 0.4, y), "text", (1.0, 0.0), size=_LETTERS))
    s.room = [(5.0, 0.0)]  # of the words on the right
    return s.drawing("Signs of joints", "How pins, bars, cables, springs, slots and contacts are drawn")


def _pin(s: Sketch, x: float, y: float) -> None:
    s.add(Symbol("pin", (x, y), "pin"))


def _grounded(s: Sketch, x: float, y: float) -> None:
    s.add(Symbol("ground", (x, y), "ground", 14.0), Symbol("pin", (x, y), "pin"))


def _line(s: Sketch, x: float, y: float, role: str, width: float, dash: tuple[float, ...] = ()) -> None:
    s.add(Outline([(x - 0.35, y), (x + 0.35, y)], role, width, dash))


def _bar(s: Sketch, x: float, y: float) -> None:
    _line(s, x, y, "neutral", 4.0)


def _cable(s: Sketch, x: float, y: float) -> None:
    _line(s, x, y, "cable", 1.4, (5.0, 3.0))


def _spring(s: Sketch, x: float, y: float) -> None:
    _line(s, x, y, "spring", 1.4, (1.5, 2.0))


def _face(s: Sketch, x: float, y: float) -> None:
    _line(s, x, y, "contact", 1.6)


def _directions() -> Drawing:
    """Directions of some angles."""
    s = Sketch()
    for words, way in {"0 deg": (1.0, 0.0), "90 deg": (0.0, 1.0), "-30 deg": (0.87, -0.5)}.items():
        s.add(Arrow((0.0, 0.0), way, "load", words, 1.6))
        s.labels.append(Label(words, way, "text", way, size=_LETTERS))
    s.room = [(-1.6, 0.0), (2.6, 0.0)]
    return s.drawing("Directions and angles", "0 deg points to the right, 90 deg up")
