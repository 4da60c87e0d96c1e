"""Drawings of disc brakes (from the front), and of multi-plate and cone brakes (cut along the axis)."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Outline, Symbol, arc
from beamdyn.common.drawing.sketch import Sketch
from brakes.drawings.arrows import ForceArrows, rotation
from brakes.machines import Cone, MachineResult, Plates
from brakes.machines import Disc as DiscBrake

_BOTH = 1.0, -1.0


# Drawings of results --------------------------------------------------------------------------------------


def draw_disc(result: MachineResult) -> Drawing:
    """Draw the disc from the front, with the friction of both pads together; for a single case."""
    disc = result.brake
    assert isinstance(disc, DiscBrake)
    # `sense` is the x direction (+1 or -1) of the friction at the top of the disc.
    r, sense = float(disc.reference_radius), 1.0 if result.reverse else -1.0
    drag = float(result.torque) / r
    arrows = ForceArrows(0.8 * r / drag if drag else 0.0)
    _add_disc(arrows.shapes, disc)
    arrows.shapes += rotation(0.55 * float(disc.inner_radius), 0.4, -sense)
    if drag:
        arrows.add((0.0, r), np.array([sense * drag, 0.0]), "F", "friction")
    title = f"Pads pressed by {float(result.force):.5g} N; torque {float(result.torque):.5g} N m"
    key = {"friction": "torque over effective radius"}
    return arrows.drawing(title, "A disc brake from the front: disc, pad and friction", key)


def draw_plates(result: MachineResult) -> Drawing:
    """Draw a section through the plates, with the force that presses them; for a single case."""
    return _draw_section(result, _add_plates, "A multi-plate brake, cut along its axis")


def draw_cone(result: MachineResult) -> Drawing:
    """Draw a section through the cone, with the force that presses it; for a single case."""
    return _draw_section(result, _add_cone, "A cone brake, cut along its axis")


def _draw_section(result: MachineResult, add: Callable[[list[DrawnShape], Any], None], words: str) -> Drawing:
    """Draw a section along the axis with the actuating force; `add` adds the shapes of the brake to it."""
    brake: Any = result.brake
    arrows = ForceArrows(0.6 * float(brake.outer_radius) / float(result.force))
    add(arrows.shapes, brake)
    arrows.add((0.0, 0.0), np.array([float(result.force), 0.0]), "P", "load", ends_here=True)
    title = f"Pressed by {float(result.force):.5g} N; torque {float(result.torque):.5g} N m"
    return arrows.drawing(title, words, {"load": "actuating force P"})


# Shapes of disc, plates and cone --------------------------------------------------------------------------


def _add_disc(shapes: list[DrawnShape], disc: DiscBrake) -> None:
    """Add the disc, with a pad at its top, to the shapes."""
    low, high, half = float(disc.inner_radius), float(disc.outer_radius), float(disc.pad_angle) / 2
    ends = np.pi / 2 - half, np.pi / 2 + half
    pad = np.vstack([arc((0, 0), low, *ends), arc((0, 0), high, *ends)[::-1]])
    shapes += [
        Disc((0, 0), 1.04 * high, "wheel", 1.4, filled=True),
        Disc((0, 0), 0.9 * low, "body", 1.2, filled=True),
        Outline(pad, "support", 1.2, closed=True, filled=True),
        Symbol("cross", (0, 0), "axis", 9.0),
    ]


def _add_plates(shapes: list[DrawnShape], plates: Plates) -> None:
    """Add the plates, one more than there are pairs of faces, above and below the axis."""
    low, high, faces = float(plates.inner_radius), float(plates.outer_radius), int(plates.faces)
    step = min(0.25 * high, 1.2 * high / (faces + 1))
    shapes.append(Outline([(-0.3 * high, 0.0), ((faces + 1) * step + 0.2 * high, 0.0)], "axis", 0.8, (6, 2)))
    for k in range(faces + 1):  # plates on the shaft reach inward, plates in the housing outward
        ends = (0.75 * low, high) if k % 2 else (low, high + 0.25 * low)
        for side in _BOTH:
            box = [(k * step, ends[0]), (k * step, ends[1]), ((k + 0.8) * step, ends[1])]
            points = np.array([*box, ((k + 0.8) * step, ends[0])]) * (1.0, side)
            shapes.append(Outline(points, "body" if k % 2 else "wheel", 1.0, closed=True, filled=True))


def _add_cone(shapes: list[DrawnShape], cone: Cone) -> None:
    """Add the cone in its cup to the shapes; the force pushes it towards its narrow end."""
    low, high, width = float(cone.inner_radius), float(cone.outer_radius), float(cone.width)
    body = [(0.0, -high), (0.0, high), (width, low), (width, -low)]
    shapes += [
        Outline(body, "body", 1.2, closed=True, filled=True),
        Outline([(-0.4 * high, 0.0), (width + 0.4 * high, 0.0)], "axis", 0.8, (6, 2)),
    ]
    for side in _BOTH:
        lining = np.array([(0.0, high), (width, low)]) * (1.0, side)
        shapes += [Outline(lining, "support", 5.0), Outline(lining * (1.0, 1.06), "wheel", 3.0)]


# Sketches -------------------------------------------------------------------------------------------------


def disc_sketch() -> Rows:
    """Sketch the dimensions of a pad."""
    s, disc = Sketch(), DiscBrake(0.6, 1.0, np.radians(80.0))
    _add_disc(s.shapes, disc)
    for symbol, radius, angle in (("r_i", disc.inner_radius, -0.5), ("r_o", disc.outer_radius, -2.4)):
        tip = radius * np.array([np.cos(angle), np.sin(angle)])
        s.add(Disc((0, 0), radius, "axis", 0.8, (4.0, 2.5)))
        s.length(symbol, (0, 0), tip, (-tip[1], tip[0]))
    s.angle("theta", (0, 0), 0.32, np.radians(50.0), np.radians(130.0))
    for end in np.radians((50.0, 130.0)):
        s.dashed((0, 0), (0.6 * np.cos(end), 0.6 * np.sin(end)))
    return [[s.drawing("Disc and pad", "A pad on its disc: r_i, r_o, theta")]]


def plates_sketch() -> Rows:
    """Sketch the dimensions of a set of plates."""
    s = Sketch()
    _add_plates(s.shapes, Plates(0.6, 1.0, faces=4))
    s.height("r_o", (0.2, 0.0), (0.2, 1.0), 1.5)
    s.height("r_i", (0.2, 0.0), (0.2, 0.6), -0.35)
    s.arrow("P", (-0.75, 0.0), (-0.05, 0.0))
    return [[s.drawing("Plates, cut along the axis", "Plates on their axis: r_i, r_o, P")]]


def cone_sketch() -> Rows:
    """Sketch the dimensions of a cone."""
    s = Sketch()
    _add_cone(s.shapes, Cone(0.7, 1.0, width=0.9))
    s.height("r_o", (0.0, 0.0), (0.0, 1.0), -0.25)
    s.height("r_i", (0.9, 0.0), (0.9, 0.7), 1.15)
    s.width("w", (0.0, 1.0), (0.9, 0.7), 1.3)
    s.arrow("P", (-0.9, 0.0), (-0.02, 0.0))
    return [[s.drawing("Cone, cut along the axis", "A cone on its axis: r_i, r_o, w, P")]]
