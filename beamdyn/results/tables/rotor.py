"""Table and CSV rows of a drawn rotor."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group

from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Columns, columns_of_rows

if TYPE_CHECKING:
    from beamdyn.scene.rotor import RotorDrawing


def rotor_table(result: RotorDrawing) -> Group:
    """Lengths and angles as drawn, and how much depth and width are drawn larger."""
    unit = result.display_units.length_unit()
    rows = [
        ("radius r of the root", f"{unit.of(result.radius):.6g}", unit.name),
        ("length L of the beam", f"{unit.of(result.length):.6g}", unit.name),
        ("setting angle φ, 0 is inward", f"{np.degrees(result.setting_angle):.6g}", "deg"),
        ("bending angle ψ, 0 is in the plane of rotation", f"{np.degrees(result.bending_angle):.6g}", "deg"),
        ("precone η", f"{np.degrees(result.precone):.6g}", "deg"),
        ("depth of the beam drawn larger by", f"{result.magnification:g}", ""),
    ]
    return table("Rotor as drawn: undeformed, turned by 180 deg", ("", "value", "unit"), rows, (0, 2))


def rotor_csv(result: RotorDrawing) -> Columns:
    """Edge of the beam as drawn, in the plane of rotation, and how much its depth is drawn larger."""
    rows = ((x, y, result.magnification) for x, y in result.outline.tolist())
    return columns_of_rows((("x", "m"), ("y", "m"), "depth_magnification"), rows)
