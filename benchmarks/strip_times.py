"""Computing times of a strip as a plate, of the plain beam, and of CalculiX for the same error.

Run: python -m benchmarks.strip_times.  The strip is that of Lee and Yoo (2019), of steel, at 100 rad/s.
"""

from __future__ import annotations

import itertools
import os
from collections.abc import Callable, Iterator
from dataclasses import replace
from time import perf_counter

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # set before numpy is imported

import beamdyn as bd
from benchmarks.peers.solids import Strip, reference, solid_modes
from benchmarks.rows import Row, show

PUBLISHED = Strip(0.05, 0.01, 0.0002, 200e9, 7850.0, 0.3, 0.215, speed=100.0)
PLATE = bd.Physics(camber=True, torsion=True)
_MODES, _TOLERANCE, _REPEATS = 3, 1e-3, 60
_FINE, _LIMIT = 1e-4, bd.Ritz(18)
# Meshes, in order of refinement.
_MESHES = ((16, 1, 4), (24, 1, 6), (32, 1, 8), (48, 1, 12), (64, 1, 16), (96, 1, 24))


def summarize() -> Iterator[Row]:
    """Yield the time of the plate over that of the beam, and that of CalculiX over that of the plate."""
    count = itertools.count(1)

    def solve(physics: bd.Physics, tolerance: float | None = None) -> Callable[[], bd.Modes]:
        """Return a function that solves the strip without cached results."""
        scene = PUBLISHED.scene(physics)

        def run() -> bd.Modes:
            mount = replace(scene.mount, radius=PUBLISHED.radius + 1e-9 * next(count))
            return bd.natural_modes(replace(scene, mount=mount), PUBLISHED.speed, _MODES, tolerance=tolerance)

        return run

    solve(PLATE, _FINE)()  # after large arrays were freed, the allocator keeps the memory of smaller ones
    as_plate = solve(PLATE, _TOLERANCE)
    of_plate, of_plain = shortest(as_plate), shortest(solve(bd.Physics()))
    found = as_plate()
    limit = bd.natural_modes(found.scene, found.speed, _MODES, discretization=_LIMIT).frequency
    missed = float(abs(found.frequency / limit - 1).max())
    yield (
        f"plate at {_TOLERANCE:g}, {_MODES} modes: time over the plain call",
        f"{of_plate / of_plain:.1f}",
        "6",
    )
    yield "... its error, true and stated", f"{missed:.1e}, {found.error.max():.1e}", f"{_TOLERANCE:g}"
    true = [mode.frequency for mode in reference(PUBLISHED)][:_MODES]
    for mesh in _MESHES:
        start = perf_counter()
        modes = solid_modes(PUBLISHED, mesh)
        time = perf_counter() - start
        error = max(abs(m.frequency / f - 1) for m, f in zip(modes, true, strict=False))
        if error <= missed:
            break
    yield (
        f"CalculiX, {mesh[0]} x {mesh[2]} elements: error beside its limit",
        f"{error:.1e}",
        f"{missed:.1e}",
    )
    yield "... its time over that of the plate", f"{time / of_plate:.0f}", "300"


def shortest(run: Callable[[], object]) -> float:
    """Measure the shortest time of a call [s]."""
    times = []
    for _ in range(_REPEATS):
        start = perf_counter()
        run()
        times.append(perf_counter() - start)
    return min(times)


if __name__ == "__main__":
    show("time of a strip as a plate", summarize)
