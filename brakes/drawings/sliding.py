"""Drawings of drum brakes with sliding shoes: contact of the linings, and forces on the shoes."""

from __future__ import annotations

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Label, Outline, Symbol
from beamdyn.common.drawing.sketch import Sketch
from brakes.drawings.arrows import ForceArrows, on_rim, rotation
from brakes.drawings.sketches import width_sketch
from brakes.machines import MachineResult, Sliding

_SIDES = (np.array([1.0, 1.0]), np.array([-1.0, 1.0]))


def draw_sliding(result: MachineResult) -> Drawing:
    """Draw the drum and its shoes, with the forces on each to one scale; for a single case.

    The leading shoe of a simplex brake is on the right, in a drum that turns clockwise. The second shoe of a
    duplex brake, whose abutment is at the opposite end, is drawn in the orientation of the first.
    """
    brake = result.brake
    assert isinstance(brake, Sliding)
    r, sizes = float(brake.drum_radius), [float(result.force)]
    for lining in result.linings:
        sizes += [abs(float(force)) for force in lining.reactions.values()]
    arrows = ForceArrows(0.0 if result.locked else 0.6 * r / max(sizes), 0.05 * r)
    arrows.shapes += [Disc((0, 0), r, "neutral", 1.4), Symbol("cross", (0, 0), "axis", 9.0)]
    arrows.shapes += rotation(0.2 * r, 0.6, -1.0 if result.reverse else 1.0)
    for i, (lining, side) in enumerate(zip(result.linings, _SIDES, strict=False)):
        _add_shoe(arrows.shapes, brake, side)
        if not result.locked:
            at, lean = brake.pressure_on(i, _along(brake), float(result.friction), result.reverse), 0.93 * r
            arrows.shapes.append(Outline(on_rim(lean, _along(brake)[at > 0]) * side, "normal", 5.0))
            _add_forces(arrows, brake, lining.reactions, float(result.force), side, f"_{i + 1}")
    if result.locked:
        arrows.labels.append(Label("a shoe grips by itself", (0.0, 0.4 * r), "inside", priority=4))
        title = f"Friction {float(result.friction):.3g}: the brake locks itself"
        return arrows.drawing(title, "A brake with sliding shoes that locks", {})
    title = f"Shoes pressed by {float(result.force):.5g} N; torque {float(result.torque):.5g} N m"
    words = {"load": "actuating force P", "normal": "pressure N, where it touches", "friction": "friction T"}
    key = words | {"reaction": "abutment A"}
    return arrows.drawing(title, "A drum brake with sliding shoes and the forces on them", key)


def _along(brake: Sliding) -> np.ndarray:
    return np.linspace(float(brake.lining_start), float(brake.lining_end), 81)


def _add_shoe(shapes: list[DrawnShape], brake: Sliding, side: np.ndarray) -> None:
    """Add a shoe with lining and abutment to the shapes; `side` has the signs of x and y on its side."""
    r, alpha = float(brake.drum_radius), _along(brake)
    foot = np.array([float(brake.abutment_offset), -float(brake.abutment_depth)])
    head = np.array([foot[0], float(brake.force_arm)])
    face = np.array([-np.sin(float(brake.abutment_angle)), np.cos(float(brake.abutment_angle))]) * 0.12 * r
    shapes += [
        Outline(on_rim(0.97 * r, alpha) * side, "support", 4.0),
        Outline(np.vstack([foot, on_rim(0.86 * r, alpha), head]) * side, "body", 3.0),
        Outline(np.array([foot - face, foot + face]) * side, "ground", 3.0),
    ]


def _add_forces(
    arrows: ForceArrows, brake: Sliding, reactions: dict[str, float], force: float, side: np.ndarray, i: str
) -> None:
    """Add a shoe's forces: pressure and friction where their lines of action cross, actuation, abutment."""
    nx, ny, tx, ty, abutment = (float(each) for each in reactions.values())
    normal, psi = np.array([nx, ny]), float(brake.abutment_angle)
    at = -float(brake.drum_radius) * normal / np.hypot(*normal)
    foot = np.array([float(brake.abutment_offset), -float(brake.abutment_depth)])
    arrows.add(at * side, normal * side, f"N{i}", "normal")
    arrows.add(at * side, np.array([tx, ty]) * side, f"T{i}", "friction")
    pushed = abutment * np.array([np.cos(psi), np.sin(psi)])
    arrows.add(foot * side, pushed * side, f"A{i}", "reaction")
    head = np.array([foot[0], float(brake.force_arm)])
    arrows.add(head * side, np.array([force, 0.0]) * side, f"P{i}", "load", ends_here=True)


def sliding_sketch() -> Rows:
    """Sketch the dimensions of a sliding shoe."""
    s, brake = Sketch(), Sliding(1.0, 0.3, np.radians(35.0), np.radians(135.0), 0.15, 0.75, 0.8, 0.3)
    s.add(Disc((0, 0), 1.0, "neutral", 1.4), Symbol("cross", (0, 0), "axis", 9.0))
    _add_shoe(s.shapes, brake, _SIDES[0])
    s.width("b", (0.0, 0.0), (0.15, -0.75), -1.2)
    s.height("c", (0.0, 0.0), (0.15, -0.75), -1.25)
    s.height("a", (0.0, 0.0), (0.15, 0.8), -1.25)
    s.length("r", (0.0, 0.0), (-np.cos(0.9), np.sin(0.9)), (-0.3, 1.0))
    for symbol, angle, size in (("alpha1", 35.0, 0.4), ("alpha2", 135.0, 0.65)):
        s.dashed((0, 0), on_rim(1.0, np.radians(np.array([angle])))[0])
        s.angle(symbol, (0, 0), size, -np.pi / 2, -np.pi / 2 + np.radians(angle))
    s.arrow("P", (-0.45, 0.8), (0.1, 0.8))
    s.arrow("psi", (-0.4, -0.92), (0.1, -0.77))
    return [
        [
            s.drawing("Sliding shoe", "A sliding shoe in its drum: r, alpha1, alpha2, a, b, c, psi, P"),
            width_sketch("lining"),
        ]
    ]
