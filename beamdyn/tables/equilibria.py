"""Tables and CSV rows of equilibria."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group

from beamdyn.common.digits import supported
from beamdyn.common.edge.tables import table

if TYPE_CHECKING:
    from beamdyn.spectrum.equilibria import Equilibrium, EquilibriumBranch, EquilibriumBranches

_AXES = "b1", "b2", "b3"


def equilibrium_table(result: Equilibrium) -> Group:
    """Position and slope of the tip, and whether the beam stays there."""
    length = result.scene.beam.length
    title = (
        f"Equilibrium at {result.speed:.10g} rad/s ({result.branch} branch), by {result.provenance.method}"
    )
    rows = [
        (f"tip along {axis}", supported(1e3 * x, 1e3 * result.error), f"{x / length:.4f}")
        for axis, x in zip(_AXES, result.tip.tolist(), strict=True)
    ]
    rows.append(("slope at the tip [deg]", supported(float(np.degrees(result.tip_angle)), 1e-9), ""))
    rows.append(("stable", "yes" if result.stable else f"no: grows at {result.growth_rate:.4g} 1/s", ""))
    return table(title, ("", "[mm]", "over the length"), rows, (0,))


def equilibrium_csv(result: Equilibrium) -> Iterator[Sequence[object]]:
    """Position of the tip, stability and growth rate."""
    yield "speed_rad_per_s", "branch", *(f"tip_{axis}_m" for axis in _AXES), "stable", "growth_rate_per_s"
    yield result.speed, result.branch, *result.tip.tolist(), result.stable, result.growth_rate


def branches_table(result: EquilibriumBranches) -> Group:
    """From where to where each branch goes, and where it is stable."""
    title = f"Branches of equilibria up to {result.top_speed:.10g} rad/s, by {result.provenance.method}"
    rows = [(branch.name, *_describe(branch)) for branch in result.branches]
    if np.isfinite(result.critical_speed):
        rows.append(("straight beam", "", "", f"buckles at {result.critical_speed:.10g} rad/s"))
    return table(title, ("branch", "speeds [rad/s]", "stable [rad/s]", "turns back at [rad/s]"), rows, (0, 3))


def _describe(branch: EquilibriumBranch) -> tuple[str, str, str]:
    turning = ", ".join(f"{speed:.8g}" for speed in branch.turning_speeds) or "-"
    stable = _range(branch.speeds[branch.stable]) if branch.stable.any() else "nowhere"
    return _range(branch.speeds), stable, turning


def _range(speeds: np.ndarray) -> str:
    return f"{speeds.min():.6g} to {speeds.max():.6g}"


def branches_csv(result: EquilibriumBranches) -> Iterator[Sequence[object]]:
    """Speed, position of the tip and stability along each branch."""
    yield "branch", "speed_rad_per_s", *(f"tip_{axis}_m" for axis in _AXES), "stable"
    for branch in result.branches:
        for speed, tip, stable in zip(branch.speeds, branch.tip, branch.stable, strict=True):
            yield branch.name, float(speed), *tip.tolist(), bool(stable)
