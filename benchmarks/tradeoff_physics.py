"""Computing time against accuracy, model error included.  Run: python -m benchmarks.tradeoff_physics

Takes half a minute; writes docs/tradeoff_physics.md and docs/tradeoff_physics.png.
"""

from __future__ import annotations

import math
import os
import platform
from dataclasses import replace
from datetime import date
from pathlib import Path
from time import perf_counter

import beamdyn as bd
from beamdyn.studies.tradeoffs.frequencies import AS_GIVEN, physics_diagram
from beamdyn.studies.tradeoffs.measurements import Diagram
from benchmarks.cases.scenes import HARVESTER
from benchmarks.rows import markdown_table, time_text

DOCS = Path(__file__).parents[1] / "docs"
MODES, BUDGET = 3, 15.0  # number of modes, and time for each scene [s]


def make_scenes() -> dict[str, tuple[bd.Scene, float]]:
    """Make three scenes, each with a different dominant effect, and a speed [rad/s] for each."""
    oblique = replace(HARVESTER, mount=replace(HARVESTER.mount, setting_angle=math.radians(45)))
    stocky = steel_bar(0.6, 0.06, 0.06)
    twisted = steel_bar(0.1524, 0.0254, 0.0017272, twist=math.radians(45))
    outward = bd.Mount(0.1, math.pi, math.pi / 2)
    return {
        "harvester at 45 deg": (oblique, 100.0),
        "stocky blade": (bd.Scene(stocky, outward), 100.0),
        "twisted blade": (bd.Scene(twisted, outward), 100.0),
    }


def steel_bar(length: float, width: float, thickness: float, twist: float = 0.0) -> bd.Beam:
    """Make a rectangular bar, twisted linearly to an angle at its tip."""
    return bd.Beam.rectangular(
        length,
        width,
        thickness,
        youngs_modulus=206.85e9,
        density=7857.6,
        poissons_ratio=0.3,
        twist=bd.Polynomial([0.0, twist]) if twist else None,
    )


PAGE = """# What accuracy costs, the model included

Written by `python -m benchmarks.tradeoff_physics` on {day} in {time:.0f} s (Python {python}, {machine}).
Times are processor times of one thread, the shortest of several runs: matrices, equilibrium, eigenvalues.
`beamdyn tradeoff SCENE` and `bd.tradeoff(scene)` measure the same on a scene of your own.

![Error against time](tradeoff_physics.png)

The [other page](tradeoff.md) counts the error of the numbers of one model. Here the error is that against
the largest set of effects that can be combined, finely discretized: each line is a choice of physics, each
point a number of Legendre functions. **More functions do not take a line below the error of its model**:
twelve digits of the wrong one are worth as much as the few that hold.

- harvester at 45 deg: the published one, turned; at 100 rad/s rotation bends its tip by 0.34 lengths;
- stocky blade: a steel bar of ten thicknesses, which flaps at 100 rad/s;
- twisted blade: that of Carnegie, 45 deg over its length, which flaps at 100 rad/s; as given it has one
  plane of bending, that of its root. Both blades are of steel, with Poisson's ratio 0.3.

The worst of the first {modes} frequencies, relative. "Reached with": the fewest functions that come within
10 % of the least error, or to 1e-10.

{table}
{skipped}"""
HEAD = ("scene", "physics", "least error", "reached with", "time", "over that as given")


def list_rows(diagrams: dict[str, Diagram]) -> list[tuple[str, ...]]:
    """List for each scene and physics the least error, the setting that has it, and the time."""
    rows = []
    for name, diagram in diagrams.items():
        reached = {}
        for m in diagram.measurements:
            least = min(n.error for n in diagram.measurements if n.family == m.family)
            if m.error <= max(1.1 * least, 1e-10):
                reached.setdefault(m.family, (least, m))
        for family, (least, m) in reached.items():
            ratio = m.time / reached[AS_GIVEN][1].time
            rows.append((name, family, f"{least:.1e}", m.setting, time_text(m.time), f"{ratio:.1f}"))
    return rows


def write_page(diagrams: dict[str, Diagram], start: float) -> str:
    """Write the page of the documentation."""
    skipped = "".join(f"- {name}: {s}\n" for name, d in diagrams.items() for s in d.skipped)
    return PAGE.format(
        day=date.today(),
        time=perf_counter() - start,
        python=platform.python_version(),
        machine=f"{platform.system()} {platform.machine()}, {os.cpu_count()} cores",
        modes=MODES,
        table=markdown_table(HEAD, list_rows(diagrams)),
        skipped=f"\nNot in the picture:\n{skipped}" if skipped else "",
    )


def draw_picture(diagrams: dict[str, Diagram], path: Path) -> None:
    """Draw one panel for each scene."""
    from matplotlib.figure import Figure

    figure = Figure(figsize=(15.0, 4.8), layout="constrained")
    for ax, (name, diagram) in zip(figure.subplots(1, len(diagrams)), diagrams.items(), strict=True):
        diagram.plot(ax)
        ax.set_title(name, fontsize=12)
        ax.set(ylim=(3e-14, 3))
    figure.suptitle(f"Error including that of the model against time: {MODES} frequencies at one speed")
    figure.savefig(path, dpi=100)


def main() -> None:
    start = perf_counter()
    diagrams = {name: physics_diagram(*scene, MODES, BUDGET) for name, scene in make_scenes().items()}
    (DOCS / "tradeoff_physics.md").write_text(write_page(diagrams, start), encoding="utf-8")
    draw_picture(diagrams, DOCS / "tradeoff_physics.png")


if __name__ == "__main__":
    main()
