"""Frequencies of three public blades given by tables of stations: error and time, compared with pyBModes.

Run: python -m benchmarks.blades.  Three modes in each plane are computed, at rest and at rated speed.  The
elements of pyBModes end at the stations of the input file.  Each of our calls has a scene that differs in its
last digits, so that no cached result is used; scenes are built before the time is measured, like pyBModes'
input.
"""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from itertools import count, islice
from time import process_time

# One thread, set before numpy is imported: more threads do not speed up small matrices.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from benchmarks.cases.blades import NAMES, blade_scene
from benchmarks.cases.reference.resolved import known_frequencies
from benchmarks.peers import pybmodes, twisted
from benchmarks.rows import RUNS, Row, best_time, show, time_text

RATED = {"iea_15": 7.56, "nrel_5": 12.1, "bmodes_test01": 60.0}  # rated speeds [rpm]
TOLERANCES = (1e-6, 1e-9, None)
_MODES = 6  # three modes in each plane
_NUMBERS = count(1)  # numbers that make each scene different
_SPEEDS = 1000  # number of speeds of a locus
_TWO_PLANES = bd.Physics(planes=2)
# Least ratios of pyBModes' time to ours that are the goal, at a tolerance of 1e-6 and by default.
_FASTER, _SLOWER = 5.0, 1.0
_LOCUS = 3.0  # largest allowed time of a locus, over that of one call


def measure_errors() -> Iterator[Row]:
    """Yield the largest true errors of frequencies, with and without twist, against collocation."""
    for name in NAMES:
        for rpm in (0.0, RATED[name]):
            for is_twisted in (False, True):
                scene, speed = blade_scene(name, twisted=is_twisted), rpm * math.pi / 30
                known = known_frequencies(scene, speed, _MODES)
                what = f"{name}, {rpm:g} rpm, {'twisted' if is_twisted else 'two planes apart'}"
                for tolerance in TOLERANCES:
                    found = bd.natural_modes(scene, speed, _MODES, tolerance=tolerance)
                    true = np.abs(found.eigenvalue / known.eigenvalue - 1)
                    covered = (true <= found.error + known.uncertainty).all()
                    said = (
                        f"{true.max():.0e}, stated {found.error.max():.0e}{'' if covered else ' NOT COVERED'}"
                    )
                    yield f"{what}, {_name(tolerance)}: error", said, f"{tolerance or 1e-9:g}"


def measure_times() -> Iterator[Row]:
    """Yield the times of one call at rated speed and of pyBModes, for bending in both planes."""
    for name in NAMES:
        theirs = their_time(name)
        if theirs is not None:
            yield f"{name}: {pybmodes.NAME}, own stations", time_text(theirs), ""
        for is_twisted in (False, True):
            for tolerance, bound in ((1e-6, _FASTER), (None, _SLOWER)):
                ours = _time(a_call(name, is_twisted, tolerance))
                ratio = "" if theirs is None else f", {pybmodes.NAME} {theirs / ours:.1f} times"
                what = f"{name}, {'twisted' if is_twisted else 'two planes apart'}, {_name(tolerance)}"
                yield what, f"{time_text(ours)}{ratio}", f"{bound:g} times"


def measure_loci() -> Iterator[Row]:
    """Yield the time of a locus of 1000 speeds over that of one call, for three modes of flap at 1e-9."""
    for name in NAMES:
        one, many = (_time(call) for call in calls_of_flap(name))
        said = f"{time_text(many)}, {many / one:.1f} times one call"
        yield f"{name}: {_SPEEDS} speeds", said, f"{_LOCUS:g} times"


def calls_of_flap(name: str) -> tuple[Callable[[], object], Callable[[], object]]:
    """Return calls for three modes at rated speed, and for a locus up to that."""
    top, scenes = RATED[name] * math.pi / 30, distinct_scenes(name, 2 * RUNS, bd.Physics())
    speeds = np.linspace(0, top, _SPEEDS)
    return (
        lambda: bd.natural_modes(next(scenes), top, 3, tolerance=1e-9),
        lambda: bd.frequency_locus(next(scenes), speeds, 3, tolerance=1e-9),
    )


def a_call(name: str, is_twisted: bool, tolerance: float | None) -> Callable[[], object]:
    """Return a function that makes one call for six modes in two planes."""
    scenes, speed = distinct_scenes(name, RUNS, twisted=is_twisted), RATED[name] * math.pi / 30
    return lambda: bd.natural_modes(next(scenes), speed, _MODES, tolerance=tolerance)


def distinct_scenes(
    name: str,
    number: int,
    physics: bd.Physics = _TWO_PLANES,
    twisted: bool = False,
) -> Iterator[bd.Scene]:
    """Yield scenes of a blade that all differ in their last digits."""
    scene = blade_scene(name, physics, twisted)
    lengths = [scene.beam.length * (1 + 1e-13 * k) for k in islice(_NUMBERS, number)]
    return iter([replace(scene, beam=replace(scene.beam, length=length)) for length in lengths])


def their_time(name: str) -> float | None:
    """Measure the time [s] of pyBModes, without reading its files; None if it is not installed."""
    if pybmodes.version() is None:
        return None
    with pybmodes.model(twisted.main_file(name, RATED[name], 1), twisted.sections(name)) as blade:
        return _time(lambda: blade.run(n_modes=_MODES, check_model=False))


def _time(action: Callable[[], object]) -> float:
    """Measure the shortest processor time [s] of several calls in one thread."""
    return best_time(action, clock=process_time)


def _name(tolerance: float | None) -> str:
    return "by default" if tolerance is None else f"tolerance {tolerance:g}"


PARTS = (measure_times, measure_loci, measure_errors)

if __name__ == "__main__":
    show("blades by their stations", *PARTS)
