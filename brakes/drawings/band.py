"""Drawings of band brakes: drum, band and lever with their forces."""

from __future__ import annotations

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Label, Outline, Symbol, arc
from beamdyn.common.drawing.sketch import Sketch
from brakes.drawings.arrows import ForceArrows, rotation
from brakes.drawings.sketches import width_sketch
from brakes.machines import Band, MachineResult


def draw_band(result: MachineResult) -> Drawing:
    """Draw the drum, its band and the lever, with the forces on the lever to one scale; for a single case.

    The arms of the lever are to scale. The lever's distance from the drum, and so the direction of the band's
    free ends, is not given: the lever is drawn near the drum.
    """
    band = result.brake
    assert isinstance(band, Band)
    r, lining = float(band.drum_radius), result.linings[0]
    forces = {name: float(lining.reactions[name]) for name in ("first", "second")}
    largest = max(*forces.values(), float(result.force))
    arrows = ForceArrows(0.0 if result.locked else 0.8 * r / largest, 0.15 * r)
    rim, (first, second, _, end) = _places(band)
    _add_body(arrows.shapes, band)
    arrows.shapes += rotation(0.6 * r, 0.35, -1.0 if result.reverse else 1.0)
    if result.locked:
        arrows.labels.append(Label("the band grips by itself", (0.0, 0.2 * r), "inside", priority=4))
        title = f"Friction {float(result.friction):.3g}: the brake locks itself"
        return arrows.drawing(title, "A band brake that locks: drum, band and lever", {})
    for name, at, on in (("first", first, rim[-1]), ("second", second, rim[0])):
        way = (on - at) / np.hypot(*(on - at))
        arrows.add(at, forces[name] * way, "T_1" if name == "first" else "T_2", "tension")
    arrows.add(end, np.array([0.0, -float(result.force)]), "P", "load", ends_here=True)
    title = f"Forces on the lever at {float(result.force):.5g} N; torque {float(result.torque):.5g} N m"
    key = {"load": "actuating force P", "tension": "tension of an end"}
    return arrows.drawing(title, "A band brake: drum, band and lever with the forces on the lever", key)


def _places(band: Band) -> tuple[np.ndarray, tuple[np.ndarray, ...]]:
    """Return points of the band, from the second end over the top to the first end, and of the lever."""
    r, half = float(band.drum_radius), float(band.wrap) / 2
    a, s, far = (float(arm) for arm in (band.first_arm, band.second_arm, band.force_arm))
    rim = arc((0, 0), r, np.pi / 2 + half, np.pi / 2 - half, 121)
    # Fulcrum of the lever: one end of the band is as far to the right of the drum's centre as the other is to
    # the left.
    middle = np.array([(s - a) / 2, -1.45 * r])
    return rim, tuple(middle + np.array([x, 0.0]) for x in (a, -s, 0.0, far))


def _add_body(shapes: list[DrawnShape], band: Band) -> None:
    """Add drum, band, lever and fulcrum to the shapes."""
    rim, (first, second, fulcrum, end) = _places(band)
    shapes += [
        Disc((0, 0), float(band.drum_radius), "neutral", 1.4),
        Symbol("cross", (0, 0), "axis", 9.0),
        Outline([(min(second[0], fulcrum[0]), fulcrum[1]), end], "body", 6.0),
        Outline(np.vstack([second, rim, first]), "support", 4.0),
        *(Symbol("dot", at, "pin", 5.0) for at in (first, second)),
        Symbol("ground", fulcrum, "ground", 12.0),
        Symbol("pin", fulcrum, "pin", 8.0),
    ]


def band_sketch() -> Rows:
    """Sketch the dimensions of a differential band brake."""
    s = Sketch()
    band = Band(1.0, 0.2, np.radians(230.0), force_arm=2.0, first_arm=0.7, second_arm=0.45)
    rim, (first, second, fulcrum, end) = _places(band)
    _add_body(s.shapes, band)
    s.length("r", (0.0, 0.0), (np.cos(2.6), np.sin(2.6)), (0.3, 1.0))
    s.dashed((0.0, 0.0), rim[0])
    s.dashed((0.0, 0.0), rim[-1])
    s.angle("phi", (0.0, 0.0), 0.4, np.pi / 2 + float(band.wrap) / 2, np.pi / 2 - float(band.wrap) / 2)
    for symbol, at, low in (("a", first, 0.45), ("s", second, 0.45), ("c", end, 0.85)):
        s.width(symbol, fulcrum, at, fulcrum[1] - low)
    s.arrow("P", end + np.array([0.0, 0.75]), end + np.array([0.0, 0.08]))
    s.moment("M", (0.0, 0.0), 1.15, 2.0, 1.1, "load")
    return [[s.drawing("A differential band", "A band brake: r, phi, a, s, c, P, M"), width_sketch("band")]]
