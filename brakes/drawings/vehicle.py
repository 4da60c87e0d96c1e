"""Drawings of a vehicle with two axles on a slope, with weight, axle loads and friction."""

from __future__ import annotations

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Outline, Symbol
from beamdyn.common.drawing.sketch import Sketch
from brakes.drawings.arrows import ForceArrows
from brakes.drawings.sketches import line_sketch, truck_sketch, wheel_sketch
from brakes.vehicle import Holding, Vehicle

_WHEEL = 0.16  # radius of the drawn wheels, over the wheelbase


def standing(found: Holding) -> Drawing:
    """Draw the vehicle on its slope, with the holding forces to one scale; for a single case, in m."""
    v, beta = found.vehicle, float(found.road.slope) * (1 if found.downhill == "rear" else -1)
    L, h, a = float(v.wheelbase), float(v.cg_height), float(v.cg_behind_front)
    turn = np.array([[np.cos(beta), -np.sin(beta)], [np.sin(beta), np.cos(beta)]])  # rotates row vectors
    weight = float(v.mass) * float(found.road.gravity)
    arrows = ForceArrows(0.8 * max(L, h) / weight, 0.12 * L)
    _draw_body(arrows.shapes, v, turn)
    loads = {"A": (0.0, float(found.front_load), "front"), "B": (L, float(found.rear_load), "rear")}
    braked = {k: load for k, (_, load, axle) in loads.items() if found.braked in (axle, "both") and load > 0}
    for name, (x, load, _) in loads.items():
        if load > 0:
            arrows.add(
                np.array([x, 0.0]) @ turn, np.array([0.0, load]) @ turn, f"N_{name}", "normal", ends_here=True
            )
        if name in braked and beta:
            share = load / sum(braked.values())
            held = np.array([-np.sign(beta) * float(found.braking_force) * share, 0.0])
            arrows.add(np.array([x, 0.0]) @ turn, held @ turn, f"R_{name}", "friction")
    at = np.array([a, h]) @ turn
    arrows.add(at, np.array([0.0, -weight]), "Mg", "weight")
    arrows.shapes.append(Symbol("dot", at, "weight", 7.0))
    on, most = np.degrees([float(found.road.slope), float(found.largest_slope)])
    most_held = f"{found.limited_by} past {most:.4g} deg"
    title = f"{found.downhill} axle downhill, {on:.3g} deg: {found.status}; {most_held}"
    key = {"weight": "weight", "normal": "axle loads", "friction": "friction of the braked tyres"}
    return arrows.drawing(title, "A vehicle at rest on a slope with the forces on it", key)


def _draw_body(shapes: list[DrawnShape], v: Vehicle, turn: np.ndarray) -> None:
    """Add ground, wheels, and a triangular frame from hub to hub over the centre of gravity."""
    L, h, a = float(v.wheelbase), float(v.cg_height), float(v.cg_behind_front)
    r = _WHEEL * L
    shapes.append(Outline(np.array([(-0.7 * L, 0.0), (1.7 * L, 0.0)]) @ turn, "ground", 2.0))
    shapes.append(Outline(np.array([(0.0, r), (a, h), (L, r)]) @ turn, "body", 3.0, closed=True))
    for x in (0.0, L):
        hub = np.array([x, r]) @ turn
        shapes += [Disc(hub, r, "wheel", 1.2, filled=True), Symbol("cross", hub, "axis", 6.0)]


def vehicle_sketch() -> Rows:
    """Sketch the dimensions of a vehicle, a truck, the brake line's cylinders, and a braked wheel."""
    return [[_dimensions()], [truck_sketch()[0][0]], *line_sketch(), [wheel_sketch()]]


def _dimensions() -> Drawing:
    s, v = Sketch(), Vehicle(1.0, cg_behind_front=1.1, cg_height=1.2, wheelbase=1.9)
    _draw_body(s.shapes, v, np.eye(2))
    s.add(Symbol("dot", (1.1, 1.2), "weight", 7.0))
    s.width("a", (0.0, 0.3), (1.1, 1.2), -0.45)
    s.width("L", (0.0, 0.3), (1.9, 0.3), -1.5)
    s.height("h", (1.9, 0.0), (1.1, 1.2), 2.7)
    s.dashed((-1.2, 0.0), (-3.2, 0.5))
    s.dashed((-1.2, 0.0), (-3.2, 0.0))
    s.angle("beta", (-1.2, 0.0), 1.5, np.pi, np.pi - 0.245)
    return s.drawing("Vehicle and slope", "A vehicle of two axles and its slope: a, h, L, beta")
