"""Sketches that explain the symbols of line, cylinders and wheels."""

from __future__ import annotations

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, Outline, Symbol
from beamdyn.common.drawing.sketch import Sketch

_DOWN, _LEFT = (0.0, -1.0), (-1.0, 0.0)


def line_sketch() -> Rows:
    """Sketch bores and travels of a hydraulic line's cylinders."""
    return [[_cylinder("Master cylinder", "d_m", "s_0"), _cylinder("Wheel cylinder", "d_w", "s_w")]]


def _cylinder(title: str, bore: str, travel: str) -> Drawing:
    """Sketch a cylinder with its piston, its bore and the travel of the piston."""
    s, half = Sketch(), 0.3
    s.add(
        Outline([(0, half), (1.2, half), (1.2, -half), (0, -half)], "body", 1.4, closed=True, filled=True),
        Outline([(0.45, half - 0.02), (0.45, 0.02 - half)], "contact", 4.0),
        Outline([(0.45, 0.0), (-0.45, 0.0)], "support", 4.0),
    )
    s.dashed((1.2, half), (1.85, half))
    s.dashed((1.2, -half), (1.85, -half))
    s.length(bore, (1.7, -half), (1.7, half), (1.0, 0.0))
    s.dashed((0.45, -half), (0.45, -1.1))
    s.dashed((0.85, half), (0.85, -1.1))
    s.length(travel, (0.45, -1.0), (0.85, -1.0), _DOWN)
    return s.drawing(title, f"{title}: bore {bore}, travel of its piston {travel}")


def wheel_sketch() -> Drawing:
    """Sketch the radii of a braked wheel and of its drum."""
    s = Sketch()
    s.add(Disc((0.0, 0.0), 1.0, "wheel", 1.4, filled=True), Disc((0.0, 0.0), 0.5, "neutral", 1.4))
    s.add(Symbol("cross", (0.0, 0.0), "axis", 9.0))
    s.length("r", (0.0, 0.0), (0.35, 0.35), (-1.0, 1.0))
    s.length("r_w", (0.0, 0.0), (-0.9, -0.44), _LEFT)
    return s.drawing("Wheel and drum", "A braked wheel and its drum: r_w, r")
