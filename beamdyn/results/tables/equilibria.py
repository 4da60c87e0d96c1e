"""Tables and CSV rows of equilibria."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group

from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Columns, columns_of_rows
from beamdyn.common.results.digits import supported

if TYPE_CHECKING:
    from beamdyn.common.results.display_units import ShownUnit
    from beamdyn.modes.equilibria import Equilibrium, EquilibriumBranch, EquilibriumBranches

_AXES = "b1", "b2", "b3"


def equilibrium_table(result: Equilibrium) -> Group:
    """Position and slope of the tip, and whether the beam stays there."""
    length, unit = result.scene.beam.length, result.display_units.length_unit()
    speed = result.display_units.speed_unit().say(result.speed, 10)
    title = f"Equilibrium at {speed} ({result.branch} branch), by {result.provenance.method}"
    rows = [
        (f"tip along {axis}", supported(unit.of(x), unit.of(result.error)), f"{x / length:.4f}")
        for axis, x in zip(_AXES, result.tip.tolist(), strict=True)
    ]
    rows.append(("slope at the tip [deg]", supported(float(np.degrees(result.tip_angle)), 1e-9), ""))
    rows.append(("stable", "yes" if result.stable else f"no: grows at {result.growth_rate:.4g} 1/s", ""))
    return table(title, ("", f"[{unit.name}]", "over the length"), rows, (0,))


def equilibrium_csv(result: Equilibrium) -> Columns:
    """Position of the tip, stability and growth rate."""
    heads = ("speed", "rad/s"), "branch", *((f"tip_{axis}", "m") for axis in _AXES)
    row = result.speed, result.branch, *result.tip.tolist(), result.stable, result.growth_rate
    return columns_of_rows((*heads, "stable", ("growth_rate", "1/s")), [row])


def branches_table(result: EquilibriumBranches) -> Group:
    """From where to where each branch goes, and where it is stable."""
    unit = result.display_units.speed_unit()
    title = f"Branches of equilibria up to {unit.say(result.top_speed, 10)}, by {result.provenance.method}"
    rows = [(branch.name, *_describe(branch, unit)) for branch in result.branches]
    if np.isfinite(result.critical_speed):
        rows.append(("straight beam", "", "", f"buckles at {unit.say(result.critical_speed, 10)}"))
    heads = (f"{what} [{unit.name}]" for what in ("speeds", "stable", "turns back at"))
    return table(title, ("branch", *heads), rows, (0, 3))


def _describe(branch: EquilibriumBranch, unit: ShownUnit) -> tuple[str, str, str]:
    speeds = unit.of(branch.speeds)
    turning = ", ".join(f"{speed:.8g}" for speed in unit.of(branch.turning_speeds)) or "-"
    stable = _range(speeds[branch.stable]) if branch.stable.any() else "nowhere"
    return _range(speeds), stable, turning


def _range(speeds: np.ndarray) -> str:
    return f"{speeds.min():.6g} to {speeds.max():.6g}"


def branches_csv(result: EquilibriumBranches) -> Columns:
    """Speed, position of the tip and stability along each branch."""
    rows = (
        (branch.name, float(speed), *tip.tolist(), bool(stable))
        for branch in result.branches
        for speed, tip, stable in zip(branch.speeds, branch.tip, branch.stable, strict=True)
    )
    heads = "branch", ("speed", "rad/s"), *((f"tip_{axis}", "m") for axis in _AXES), "stable"
    return columns_of_rows(heads, rows)
