"""BModes' test blade, with torsion and offsets: the origin of its printed frequencies, and computing time.

Run: python -m benchmarks.bmodes            (seconds)
"""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from dataclasses import replace
from itertools import count
from time import process_time

# Set before numpy is imported; small matrices gain nothing by more threads.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.published import load
from beamdyn.reproduce.blades import blade_scene, stations, whole_blade_scene
from benchmarks.cases.reference import bmodes
from benchmarks.rows import Row, best_time, show, time_text

NAME, SPEED = "bmodes_test01", 2 * math.pi  # 60 rpm
# Number of modes, smallest difference in percent, and largest ratio to the time without torsion.
_MODES, _LEAST, _MOST = 5, 0.3, 2.0
_NUMBERS = count(1)  # numbers that make scenes differ in their last digits


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


def measure_time() -> Iterator[Row]:
    """Yield the time of three modes at a tolerance of 1e-6 with torsion and offsets, over that without."""
    plain, whole = (_time(scene) for scene in (blade_scene(NAME), whole_blade_scene(NAME)))
    said = f"{time_text(whole)} over {time_text(plain)}: {whole / plain:.2f}"
    yield "torsion and offsets: three modes, 1e-6", said, f"{_MOST:g}"


def _solve(scene: bd.Scene) -> np.ndarray:
    return bd.natural_modes(scene, SPEED, _MODES, tolerance=1e-6).frequency


def _over_print(found: np.ndarray) -> str:
    (row,) = (row for row in load("blades")["blade"] if row["name"] == NAME)
    printed = np.array([float(text) for text in row["frequency_printed_by_bmodes"]])
    return ", ".join(f"{100 * value:+.3f}" for value in found / printed - 1)


def _time(scene: bd.Scene) -> float:
    """Measure the shortest processor time [s] of a call without cached results."""
    lengths = (scene.beam.length * (1 + 1e-13 * k) for k in _NUMBERS)
    scenes = (replace(scene, beam=replace(scene.beam, length=length)) for length in lengths)
    made = [next(scenes) for _ in range(9)]
    return best_time(lambda: bd.natural_modes(made.pop(), SPEED, 3, tolerance=1e-6), 9, process_time)


if __name__ == "__main__":
    show("BModes' own blade at 60 rpm: first five frequencies over the printed ones [%]", trace, measure_time)
