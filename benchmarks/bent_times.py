"""Computing time of an equilibrium with three modes about it, in one plane and in space.

Run: python -m benchmarks.bent_times [--before FOLDER]    (seconds)

Rotation bends a strip at 45 deg to the radius.  Each call has a different radius, and a tolerance of 1e-6 for
the frequencies.  Times are medians of processor time, measured alternately in separate processes, over the
time in one plane; with `--before` over the time in one plane of an older version, which is checked out in the
folder, for example the parent of the commit that added beams in space: git worktree add FOLDER 9143167f^.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from pathlib import Path
from statistics import median

from benchmarks.rows import Row, show, time_of_version

_CALLS, _TURNS = 15, 3
_PLANE = "large_deflection=True"
_SPACE = f"{_PLANE}, planes=2"
_ALL = f"{_SPACE}, torsion=True, stretch=True, shear=True, rotary_inertia=True"
_CASES = {
    "in one plane": (_PLANE, "1.2"),
    "in space: two curvatures": (_SPACE, "3"),
    "... and torsion": (f"{_SPACE}, torsion=True", "3"),
    "... and stretch, shear, rotary inertia": (_ALL, "3"),
}
_SCRIPT = """
import warnings
from statistics import median
from time import process_time
import beamdyn as bd
warnings.simplefilter("ignore")
physics, times = bd.Physics({physics}), []
strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0{further})
for i in range({calls}):
    scene = bd.Scene(strip, bd.Mount(0.215 + 1e-4 * i, 0.785), physics=physics)
    start = process_time()
    bd.natural_modes(scene, 60.0, 3, tolerance=1e-6)
    times.append(process_time() - start)
print(median(times))
"""


def measure(folder: Path, physics: str, further: str = ", poissons_ratio=0.3") -> float:
    """Measure the median processor time [s] of calls of the program version in a folder."""
    return time_of_version(folder, _SCRIPT.format(physics=physics, further=further, calls=_CALLS))


def compare(before: Path | None) -> Iterator[Row]:
    """Yield the time of each case over that of the planar call, as the median of several measurements."""
    here = Path(__file__).parents[1]
    turns = []
    for _ in range(_TURNS):
        planar = measure(here, _PLANE) if before is None else measure(before, _PLANE, "")
        turns.append([measure(here, physics) / planar for physics, _ in _CASES.values()])
    over = "one plane" if before is None else "one plane, by the older version"
    for (name, (_, bound)), ratios in zip(_CASES.items(), zip(*turns, strict=True), strict=True):
        yield f"{name}: time over that of {over}", f"{median(ratios):.2f}", bound if before else ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--before", type=Path, help="folder with a checkout of an older version")
    before = parser.parse_args().before
    show("equilibrium and three modes, 1e-6", lambda: compare(before and before.resolve()))


if __name__ == "__main__":
    main()
