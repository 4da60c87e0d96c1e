"""Sketches that explain the symbols in forms: truck, duo-servo brake, drum brake, cylinders, wheel."""

from __future__ import annotations

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, Outline, Symbol, arc
from beamdyn.common.drawing.sketch import Sketch
from brakes.drawings.duo_servo import duo_servo
from brakes.drawings.forklift import draw_chassis
from brakes.forklift import BENDIX_12_5, Truck

_SLOPE = np.radians(14.0)
_UP, _LEFT = (0.0, 1.0), (-1.0, 0.0)


# Forklift -------------------------------------------------------------------------------------------------


def truck_sketch() -> Rows:
    """Sketch the dimensions of a truck with its load, and the slope."""
    r1, L = 0.5, 1.9
    t = Truck(5000.0, (1.1, 0.62), 2000.0, (-1.1, 0.85), front_wheel_radius=r1, wheelbase=L)
    return [[_dimensions_of(t, r1, L)], [_slope()]]


def _dimensions_of(t: Truck, r1: float, L: float) -> Drawing:
    s = Sketch()
    draw_chassis(s.shapes, t, np.eye(2))
    cg, load = np.array([1.1, 0.62 + r1]), np.array([-1.1, 0.85 + r1])
    s.add(Symbol("dot", cg, "weight", 7.0), Symbol("dot", load, "weight", 7.0))
    s.say("m", cg, (1.0, 1.0), "weight")
    s.say("m_L", load, (-1.0, 1.0), "weight")
    s.width("L", (0.0, r1), (L, 0.75 * r1), -1.4)
    s.width("x", (0.0, r1), cg, -0.35)
    s.width("x_L", (0.0, r1), load, -0.35)
    s.height("y_L", (0.0, r1), load, -1.95)
    s.height("y", (0.0, r1), cg, 2.7)
    s.length("r1", (2.7, 0.0), (2.7, r1), (1.0, 0.0))
    return s.drawing("Truck and load", "A truck with its load: L, x, y, r1, x_L, y_L")


def _slope() -> Drawing:
    s = Sketch()
    way = np.array([np.cos(_SLOPE), -np.sin(_SLOPE)])
    top = np.array([0.0, 1.0])
    foot = top + 4.2 * way
    normal = np.array([-way[1], way[0]])
    s.add(Outline([top, foot], "ground", 2.0))
    s.dashed(foot, foot - (2.4, 0.0))
    s.angle("beta", foot, 1.9, np.pi, np.pi - float(_SLOPE))
    start = top + 0.8 * way + 0.3 * normal
    s.arrow("V", start, start + 1.1 * way)
    return s.drawing("Slope, downhill as it travels", "The slope, and the speed down it: beta, V")


def duo_servo_sketch() -> Rows:
    """Sketch the dimensions of a duo-servo brake at rest."""
    s, drawn = Sketch(), duo_servo(BENDIX_12_5, BENDIX_12_5.move_shoes(0.0106), 0.0)
    s.shapes += drawn.shapes
    r, (x, y), (ax, ay) = 0.15875, (0.06155, 0.10229), (0.05304, -0.12211)
    s.length("r", (0.0, 0.0), r * np.array([-np.cos(0.5), -np.sin(0.5)]), (0.4, -1.0))
    far = 0.19
    s.height("y_t", (0.0, 0.0), (x, y), far)
    s.height("y_a", (0.0, 0.0), (ax, ay), far)
    s.width("x_t", (0.0, 0.0), (x, y), far)
    s.width("x_a", (0.0, 0.0), (ax, ay), -far)
    tilt = float(BENDIX_12_5.face_tilt)  # type: ignore[arg-type]
    s.dashed((-x, y), (-x, y + 0.07))
    s.say("alpha", (-x, y) + 0.06 * np.array([-np.sin(tilt / 2), np.cos(tilt / 2)]), (-0.4, 1.0), "dimension")
    gap = np.array([np.cos(2.75), np.sin(2.75)])
    s.arrow("c_L", 1.3 * r * gap, 0.97 * r * gap, "dimension")
    return [[s.drawing("At rest", "A duo-servo brake at rest: r, x_t, y_t, x_a, y_a, alpha, c_L")]]


def levers_sketch() -> Rows:
    """Sketch lever arms and angles of the forces on both shoes of a duo-servo brake."""
    return [[_shoe_with_arms(1)], [_shoe_with_arms(-1)]]


def _shoe_with_arms(side: int) -> Drawing:
    """Sketch the forces on the leading shoe, on the right (1), or on the trailing shoe, on the left (-1)."""
    s, words = Sketch(), "Leading shoe" if side > 0 else "Trailing shoe"
    alpha, gamma = np.radians((20.0, 16.0)).tolist()
    s.add(Disc((0.0, 0.0), 1.0, "axis", 1.2, (4.0, 2.0)))
    s.axis((0, 0))
    s.add(Outline(arc((0.0, 0.0), 0.94, -0.8, 0.75) * (side, 1.0), "body", 5.0))
    push, name = np.array([side * np.cos(alpha), -np.sin(alpha)]), "1" if side > 0 else "2"
    arm = 0.66 * np.array([side * np.sin(alpha), np.cos(alpha)])
    _force_with_arm(s, ("P_L", "a1") if side > 0 else ("P_T", "a2"), push, arm, "load")
    start = arm - 0.45 * push
    s.dashed(start, start + np.array([1.3 * side, 0.0]))
    s.angle(f"alpha{name}", start, 1.15, *((0.0, -alpha) if side > 0 else (np.pi, np.pi + alpha)))
    hold = side * np.array([np.cos(gamma), np.sin(gamma)])
    below = 0.72 * np.array([np.sin(gamma), -np.cos(gamma)])
    _force_with_arm(s, ("Q", f"b{name}"), hold, below, "reaction")
    if side > 0:
        s.dashed(below, below + np.array([1.2, 0.0]))
        s.angle("gamma", below, 1.0, 0.0, gamma)
        s.length("r", (0.0, 0.0), (-np.cos(0.2), np.sin(0.2)), _UP)
        s.moment("T", (0.0, 0.0), 1.15, 2.5, 3.3, "load")
    return s.drawing(words, f"Arms and angles of the forces on the {words.lower()}")


def _force_with_arm(s: Sketch, names: tuple[str, str], along: np.ndarray, arm: np.ndarray, role: str) -> None:
    """Add to a sketch a force on its line of action, and the force's lever arm about (0, 0).

    `names` has the symbols of the force and of the arm; `along` is the direction of the force.
    """
    s.dashed(arm - 0.5 * along, arm + 0.9 * along)
    s.arrow(names[0], arm - 0.45 * along, arm + 0.25 * along, role)
    s.length(names[1], (0.0, 0.0), arm, (-along[0], -along[1]))


# Drum brake -----------------------------------------------------------------------------------------------


def drum_sketch() -> Rows:
    """Sketch the dimensions of a shoe in its drum, the width of the lining, and a wheel cylinder."""
    return [[_shoe()], [_width(), cylinder_sketch()]]


def _shoe() -> Drawing:
    s = Sketch()
    start, end = np.radians((32.0, 112.0))
    pin, force = np.array([0.2, -0.78]), 0.72
    rim = arc((0.0, 0.0), 1.0, start - np.pi / 2, end - np.pi / 2)
    lever = np.array([0.5, force])
    s.add(Disc((0.0, 0.0), 1.0, "neutral", 1.4), Outline(np.vstack([pin, 0.86 * rim, lever]), "body", 5.0))
    s.add(Outline(rim, "support", 7.0), Symbol("pin", pin, "pin", 8.0))
    s.axis((0, 0))
    s.length("r", (0.0, 0.0), (-np.cos(0.5), -np.sin(0.5)), (-0.3, 1.0))
    s.arrow("P", lever - (0.6, 0.0), lever)
    s.height("a", (0.0, 0.0), lever, -0.3)
    s.height("c", (0.0, 0.0), pin, -0.3)
    s.width("b", (0.0, 0.0), pin, -1.14)
    s.dashed((0.0, 0.0), 1.0 * rim[0])
    s.dashed((0.0, 0.0), 1.0 * rim[-1])
    s.angle("alpha1", (0.0, 0.0), 0.42, -np.pi / 2, float(start) - np.pi / 2)
    s.angle("alpha2", (0.0, 0.0), 0.62, -np.pi / 2, float(end) - np.pi / 2)
    s.moment("M", (0.0, 0.0), 1.13, 2.0, 1.1, "load")
    return s.drawing("A shoe in the drum", "A shoe in its drum: r, a, b, c, alpha1, alpha2, P, M")


def _width() -> Drawing:
    s = Sketch()
    s.add(Outline([(0, 1.0), (0, 0), (1.0, 0), (1.0, 1.0)], "neutral", 1.4))
    s.add(Outline([(0.2, 0.0), (0.8, 0.0)], "support", 9.0))
    s.length("w", (0.2, 0.3), (0.8, 0.3), _UP)
    return s.drawing("Along the axis", "The width of the lining along the drum's axis: w")


def width_sketch(part: str) -> Drawing:
    """Sketch the width of a band, block or lining outside or inside its drum, along the drum's axis."""
    s = Sketch()
    s.add(Outline([(0, 0), (1.0, 0)], "neutral", 1.4), Outline([(0.2, 0.1), (0.8, 0.1)], "support", 6.0))
    s.length("w", (0.2, 0.4), (0.8, 0.4), _UP)
    return s.drawing("Along the axis", f"The width of the {part} along the drum's axis: w")


def cylinder_sketch() -> Drawing:
    """Sketch bore and pressure of a wheel cylinder."""
    s = Sketch()
    s.add(Outline([(0, 0.25), (1.0, 0.25), (1.0, -0.25), (0, -0.25)], "body", 1.4, closed=True, filled=True))
    s.add(
        Outline([(0.7, 0.24), (0.7, -0.24)], "contact", 4.0),
        Outline([(0.7, 0.0), (1.3, 0.0)], "support", 4.0),
    )
    s.say("p_h", (0.35, 0.0), role="load")
    s.height("d", (0.0, -0.25), (0.0, 0.25), -0.3)
    return s.drawing("Cylinder", "The bore of a cylinder and its pressure: d, p_h")


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
    s.height(bore, (1.2, -half), (1.2, half), 1.7)
    s.width(travel, (0.45, -half), (0.85, half), -1.0)
    return s.drawing(title, f"{title}: bore {bore}, travel of its piston {travel}")


def wheel_sketch() -> Drawing:
    """Sketch the radii of a braked wheel and of its drum."""
    s = Sketch()
    s.add(Disc((0.0, 0.0), 1.0, "wheel", 1.4, filled=True), Disc((0.0, 0.0), 0.5, "neutral", 1.4))
    s.add(Symbol("cross", (0.0, 0.0), "axis", 9.0))
    s.length("r", (0.0, 0.0), (0.35, 0.35), (-1.0, 1.0))
    s.length("r_w", (0.0, 0.0), (-0.9, -0.44), _LEFT)
    return s.drawing("Wheel and drum", "A braked wheel and its drum: r_w, r")
