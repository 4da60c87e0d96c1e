"""Drawings of block brakes: drum, blocks and levers with their forces."""

from __future__ import annotations

import numpy as np

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.shapes import Disc, Drawing, DrawnShape, Outline, Symbol, arc
from beamdyn.common.drawing.sketch import Sketch
from brakes.drawings.arrows import ForceArrows, rotation
from brakes.drawings.sketches import width_sketch
from brakes.machines import Block, LiningResult, MachineResult

# Matrices that transform a block's axes to the drawing, for a block above and for one below the drum.
_SIDES = (np.eye(2), np.diag((1.0, -1.0)))


def draw_block(result: MachineResult) -> Drawing:
    """Draw the drum, its blocks and levers, with the forces on the levers to one scale; for a single case."""
    block = result.brake
    assert isinstance(block, Block)
    r, force = float(block.drum_radius), float(result.force)
    sizes = [float(x) for each in result.linings for x in each.reactions.values()]
    arrows = ForceArrows(0.0 if result.locked else 0.9 * r / max(force, *map(abs, sizes)))
    _add_drum(arrows.shapes, r, reverse=result.reverse)
    for i, (lining, placed) in enumerate(zip(result.linings, _SIDES, strict=False), 1):
        _add_lever(arrows.shapes, block, placed)
        if not result.locked:
            leads = result.reverse is (i == 2)  # whether the drum's surface moves towards the fulcrum
            _add_forces(arrows, block, lining, placed, f"_{i}", leads)
            end = _places(block)[2] @ placed
            arrows.add(end, np.array([0.0, -force]) @ placed, f"P_{i}", "load", ends_here=True)
    if result.locked:
        title = f"Friction {float(result.friction):.3g}: the brake locks itself"
        return arrows.drawing(title, "A block brake that locks: drum, blocks and levers", {})
    title = f"Forces on the levers at {force:.5g} N; torque {float(result.torque):.5g} N m"
    key = {
        "load": "actuating force P",
        "normal": "pressure N",
        "friction": "friction T",
        "reaction": "fulcrum R",
    }
    return arrows.drawing(title, "A block brake: drum, blocks and levers with their forces", key)


def _add_forces(
    arrows: ForceArrows, block: Block, lining: LiningResult, placed: np.ndarray, index: str, leads: bool
) -> None:
    """Add resultants of pressure and friction where their lines of action cross, and the fulcrum's force."""
    c, s, q = (float(each) for each in block.integrals())
    way = np.array([s, c]) / np.hypot(s, c)
    at = float(block.drum_radius) * q / np.hypot(s, c) * way
    normal, drag, *pin = (float(lining.reactions[each]) for each in block.reactions)
    across = np.array([-way[1], way[0]]) * (1.0 if leads else -1.0)
    arrows.add(at @ placed, normal * way @ placed, f"N{index}", "normal")
    arrows.add(at @ placed, drag * across @ placed, f"T{index}", "friction")
    arrows.add(_places(block)[1] @ placed, np.array(pin) @ placed, f"R{index}", "reaction")


def _places(block: Block) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return points (rows of x, y) of the block's face, the fulcrum and the force; the drum is below."""
    half, r = float(block.block_angle) / 2, float(block.drum_radius)
    face = arc((0, 0), r, np.pi / 2 + half, np.pi / 2 - half)
    fulcrum = np.array([-float(block.block_arm), float(block.height)])
    end = np.array([fulcrum[0] + float(block.force_arm), max(fulcrum[1], 1.3 * r)])
    return face, fulcrum, end


def _add_drum(shapes: list[DrawnShape], r: float, *, reverse: bool) -> None:
    """Add the drum and its rotation; forward, its top moves to the left, where the fulcrum is."""
    shapes += [Disc((0, 0), r, "neutral", 1.4), Symbol("cross", (0, 0), "axis", 9.0)]
    shapes += rotation(0.6 * r, 0.35, 1.0 if reverse else -1.0)


def _add_lever(shapes: list[DrawnShape], block: Block, placed: np.ndarray) -> None:
    """Add a block with its lever; the matrix `placed` transforms the block's axes to the drawing."""
    face, fulcrum, end = _places(block)
    back = face * (1.0, 0.0) + (0.0, 1.3 * float(block.drum_radius))
    knee = np.array([fulcrum[0], end[1]])
    shapes += [
        Outline(np.vstack([fulcrum, knee, end]) @ placed, "body", 5.0),
        Outline(np.vstack([face, back[::-1]]) @ placed, "support", 1.2, closed=True, filled=True),
        Symbol("pin", fulcrum @ placed, "pin", 8.0),
    ]


def block_sketch() -> Rows:
    """Sketch the dimensions of a block and its lever."""
    s, block = Sketch(), Block(1.0, 0.3, np.radians(50.0), force_arm=3.2, block_arm=1.7, offset=0.3)
    _add_drum(s.shapes, 1.0, reverse=False)
    _add_lever(s.shapes, block, _SIDES[0])
    _, fulcrum, end = _places(block)
    s.width("b", fulcrum, (0.0, 0.0), 1.95)
    s.width("c", fulcrum, end, 2.5)
    s.height("e", (0.0, 1.0), fulcrum, -2.15)
    s.length("r", (0.0, 0.0), (np.cos(0.3), np.sin(0.3)), (0.3, -1.0))
    for angle in np.radians((65.0, 115.0)):
        s.dashed((0, 0), (np.cos(angle), np.sin(angle)))
    s.angle("theta", (0, 0), 0.45, np.radians(65.0), np.radians(115.0))
    s.arrow("P", end + np.array([0.0, 0.9]), end + np.array([0.0, 0.05]))
    return [
        [s.drawing("Block and lever", "A block on its drum: r, theta, b, c, e, P")],
        [width_sketch("block")],
    ]
