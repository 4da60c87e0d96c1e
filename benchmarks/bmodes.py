"""BModes' test blade, with torsion and offsets: the origin of its printed frequencies, and computing time.

Run: python -m benchmarks.bmodes [--before FOLDER]            (seconds)

Times with torsion and offsets are over those without: of this version, and with `--before` of an older one,
which is checked out in the folder, for example the parent of the commit that added beams in space:
git worktree add FOLDER 9143167f^.
"""

from __future__ import annotations

import argparse
import math
import os
from collections.abc import Iterator
from dataclasses import replace
from functools import partial
from pathlib import Path

# Set before numpy is imported; small matrices gain nothing by more threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.published import load
from beamdyn.reproduce.blades import blade_scene, stations, whole_blade_scene
from benchmarks.cases.reference import bmodes
from benchmarks.rows import Row, show, time_of_version, time_text

NAME, SPEED = "bmodes_test01", 2 * math.pi  # 60 rpm
# Number of modes, smallest difference in percent, and largest ratio to the time without torsion.
_MODES, _LEAST, _MOST = 5, 0.3, 2.0
_TURNS = 3
# Each call has a beam of another length, so that nothing is known from the one before.
_SCRIPT = """
from dataclasses import replace
from time import process_time
import beamdyn as bd
from beamdyn.reproduce.blades import {make}
scene, times = {make}({name!r}), []
for i in range(25):
    changed = replace(scene, beam=replace(scene.beam, length=scene.beam.length * (1 + 1e-13 * i)))
    start = process_time()
    bd.natural_modes(changed, {speed}, 3, tolerance=1e-6)
    times.append(process_time() - start)
print(min(times))
"""


def trace() -> Iterator[Row]:
    """Yield deviations of first frequencies from the printed ones [%]: by BModes' matrices and by ours."""
    data = stations(NAME)
    for parts in (1, 2, 8):
        ends = np.interp(np.arange(12 * parts + 1) / parts, np.arange(13), data["element_ends"])
        yield (
            f"matrices of BModes, {12 * parts} elements",
            _over_print(bmodes.frequencies(data, ends, SPEED, 5)),
            "",
        )
    read = bmodes.about_shear_centres(data, data["element_ends"], SPEED, _MODES)
    yield "its 12 elements, centres and inertia from the shear centre", _over_print(read), ""
    no_torsion = blade_scene(NAME)
    whole, by_elements = whole_blade_scene(NAME), whole_blade_scene(NAME, by_elements=True)
    yield "ours, without torsion and offsets", _over_print(_solve(no_torsion)), ""
    yield "ours", _over_print(_solve(whole)), ""
    yield "ours, by the sections of its 12 elements", _over_print(_solve(by_elements)), f"{_LEAST:g} %"
    beam, physics = by_elements.beam, by_elements.physics
    on_axis = replace(beam, mass_offset=beam.mass_offset and beam.mass_offset.scaled(0.0))
    without = {
        "centres of mass on the axis": replace(by_elements, beam=on_axis),
        "centres of tension on the axis": replace(by_elements, beam=replace(beam, tension_offset=None)),
        "torsion and offsets": replace(
            by_elements, physics=replace(physics, torsion=False, rotary_inertia=True)
        ),
        "torsion, offsets and rotary inertia": replace(by_elements, physics=replace(physics, torsion=False)),
    }
    for name, scene in without.items():
        left_out = "with" if name.startswith("centres") else "without"
        yield f"... {left_out} {name}", _over_print(_solve(scene)), ""


def measure_time(before: Path | None) -> Iterator[Row]:
    """Yield the time of three modes with torsion and offsets over that without, as the median of turns."""
    turns = [_measure_turn(before) for _ in range(_TURNS)]
    name = "torsion and offsets: three modes, 1e-6"
    for over, place in (("this version", 1), ("the older version", 2))[: len(turns[0]) - 1]:
        ratio, whole, plain = sorted((t[0] / t[place], t[0], t[place]) for t in turns)[_TURNS // 2]
        said = f"{time_text(whole)} over {time_text(plain)}: {ratio:.2f}"
        yield f"{name}, over those without, by {over}", said, f"{_MOST:g}" if place == 2 else ""


def _measure_turn(before: Path | None) -> list[float]:
    """Measure the times [s] with torsion and offsets, and without; the latter also of an older version."""
    here = Path(__file__).parents[1]
    cases = [("whole_blade_scene", here), ("blade_scene", here)]
    cases += [("blade_scene", before)] if before else []
    return [
        time_of_version(folder, _SCRIPT.format(make=make, name=NAME, speed=SPEED)) for make, folder in cases
    ]


def _solve(scene: bd.Scene) -> np.ndarray:
    return bd.natural_modes(scene, SPEED, _MODES, tolerance=1e-6).frequency


def _over_print(found: np.ndarray) -> str:
    (row,) = (row for row in load("blades")["blade"] if row["name"] == NAME)
    printed = np.array([float(text) for text in row["frequency_printed_by_bmodes"]])
    return ", ".join(f"{100 * value:+.3f}" for value in found / printed - 1)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--before", type=Path, help="folder with a checkout of an older version")
    before = parser.parse_args().before
    title = "BModes' own blade at 60 rpm: first five frequencies over the printed ones [%]"
    show(title, trace, partial(measure_time, before and before.resolve()))


if __name__ == "__main__":
    main()
