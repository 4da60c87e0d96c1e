"""Time of many designs solved at once, against a loop of single calls.  Run: python -m benchmarks.study

The 10 000 designs combine ten thicknesses, tip masses, radii and speeds.  The loop builds the scene of each
design and calls `natural_modes` of this version with the default tolerance, as in the study; it is timed on a
random sample of the designs, whose answers are compared.  Both run in one process with one thread.  Then
other analyses are timed in processor time, with random thickness, radius and speed.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from time import perf_counter, process_time
from typing import Literal

import numpy as np

import beamdyn as bd
from beamdyn.common.edge.rendering import png
from beamdyn.common.edge.views import picture_of
from beamdyn.common.parallel.workers import one_blas_thread
from benchmarks.rows import Row, best_time, show

LENGTH, WIDTH, MODULUS, DENSITY = 0.05, 0.01, 200e9, 7850.0
VARY = {
    "beam.thickness": np.linspace(1e-4, 4e-4, 10),
    "beam.tip.mass": np.linspace(0.0, 1e-3, 10),
    "mount.radius": np.linspace(0.0, 0.3, 10),
    "speed": np.linspace(0.0, 80.0, 10),
}
SAMPLE = 300  # number of designs in the loop of single calls
SIDE = 200  # number of values of each of two inputs of a plot
# Numbers of designs for the other analyses, and top speed [rad/s].
OTHERS, SAMPLE_OF_OTHERS, TOP_SPEED = 2000, 20, 150.0


def single(design: dict[str, float]) -> bd.Modes:
    """Solve one design by a single call, as a user would."""
    tip = bd.TipMass(design["beam.tip.mass"])
    beam = bd.Beam.rectangular(LENGTH, WIDTH, design["beam.thickness"], MODULUS, DENSITY, tip)
    return bd.natural_modes(bd.Scene(beam, bd.Mount(design["mount.radius"])), design["speed"], 3)


def compare() -> Iterator[Row]:
    """Yield the time per design of a study and of single calls, and their largest difference."""
    beam = bd.Beam.rectangular(LENGTH, WIDTH, 2e-4, MODULUS, DENSITY, bd.TipMass(0.0))
    scene, random = bd.Scene(beam, bd.Mount()), np.random.default_rng(17)
    study = bd.study(scene, VARY)
    number = study.value[..., 0].size
    at_once = best_time(lambda: bd.study(scene, VARY), runs=3) / number
    places = [tuple(random.integers(study.shape)) for _ in range(SAMPLE)]
    designs = [study.design(*place) for place in places]
    singles, each = [], []
    with one_blas_thread():
        for design in designs:
            start = perf_counter()
            singles.append(single(design))
            each.append(perf_counter() - start)
    # The shortest of each ten calls, because other programs can only lengthen a call.
    one = float(np.mean(np.min(np.reshape(each, (-1, 10)), axis=1)))
    yield f"{number} designs, three modes: a design of a study [us]", f"{1e6 * at_once:.0f}", "-"
    yield "... one by one, this commit [us]", f"{1e6 * one:.0f}", "-"
    yield "... one by one over a study", f"{one / at_once:.0f}", "50"
    drawn = {name: random.uniform(values[0], values[-1], number) for name, values in VARY.items()}
    together = best_time(lambda: bd.study(scene, drawn, combine="zip"), runs=3) / number
    yield "... over random designs, each with a speed of its own", f"{one / together:.0f}", "-"
    worst = max(map(_deviation, singles, (study.value[p] for p in places), (study.error[p] for p in places)))
    yield f"{SAMPLE} of them: largest deviation over the stated errors of both", f"{worst:.2f}", "1"


def _deviation(modes: bd.Modes, frequency: np.ndarray, error: np.ndarray) -> float:
    return float(np.nanmax(np.abs(frequency / modes.frequency - 1) / (error + modes.error)))


@dataclass(frozen=True)
class Case:
    """An analysis of many random designs, and the same analysis of one design."""

    name: str
    scene: bd.Scene
    single: Callable[[bd.Scene, float], object]
    what: Literal["frequencies", "critical_speed", "crossings"] = "frequencies"
    more: dict[str, tuple[float, float]] = field(default_factory=dict)


def list_cases() -> Iterator[Case]:
    """Yield the other analyses that solve many designs at once."""
    beam, wheel = bd.Beam.rectangular(LENGTH, WIDTH, 2e-4, MODULUS, DENSITY), bd.Mount(0.1)
    road = bd.RoadWave(wavelength=0.3, velocity_amplitude=0.01)
    rolling = bd.RollingWheel(0.3, bd.SteadyRotation(50.0), road)

    def modes(scene: bd.Scene, speed: float) -> bd.Modes:
        return bd.natural_modes(scene, speed)

    yield Case("damped frequencies", bd.Scene(beam, wheel), modes, more={"model.damping_ratio": (0.0, 0.1)})
    springs = {"mount.root_stiffness": (0.01, 1.0)}
    yield Case("frequencies on springs", bd.Scene(beam, wheel), modes, more=springs)
    yield Case("frequencies in two planes", bd.Scene(beam, wheel, physics=bd.Physics(planes=2)), modes)
    yield Case("critical speeds", bd.Scene(beam, wheel), lambda s, _: bd.critical_point(s), "critical_speed")
    resonances = bd.Scene(beam, wheel, rolling, gravity=9.81)
    yield Case("crossings", resonances, lambda s, _: bd.resonance_speeds(s, TOP_SPEED), "crossings")


def compare_others() -> Iterator[Row]:
    """Yield the time per design of studies by other analyses, over that of single calls."""
    for case in list_cases():
        random = np.random.default_rng(17)
        ranges = {"beam.thickness": (1e-4, 4e-4), "mount.radius": (0.01, 0.3)} | case.more
        ranges |= {"speed": (0.0, 80.0)} if case.what == "frequencies" else {}
        drawn = {name: random.uniform(*ends, OTHERS) for name, ends in ranges.items()}
        speed = {"speed": TOP_SPEED} if case.what == "crossings" else {}
        study = bd.study(case.scene, drawn, case.what, combine="zip", **speed)
        many = best_time(
            lambda c=case, d=drawn, s=speed: bd.study(c.scene, d, c.what, combine="zip", **s), 2, process_time
        )
        places = random.integers(OTHERS, size=SAMPLE_OF_OTHERS).tolist()
        scenes = [(study.scene_at(i), study.design(i).get("speed", 0.0)) for i in places]
        with one_blas_thread():
            alone = best_time(lambda c=case, s=scenes: [c.single(*each) for each in s], 1, process_time)
        ratio = alone / SAMPLE_OF_OTHERS / (many / OTHERS)
        name = f"{case.name} of {OTHERS} random designs: a design [us], one by one over a study"
        yield name, f"{1e6 * many / OTHERS:.0f}, {ratio:.0f}", "-"


def draw_maps() -> Iterator[Row]:
    """Yield the time to draw the plot of a finished study over two inputs."""
    beam = bd.Beam.rectangular(LENGTH, WIDTH, 2e-4, MODULUS, DENSITY)
    rolling = bd.RollingWheel(0.3, bd.SteadyRotation(50.0), bd.RoadWave(0.3, velocity_amplitude=0.01))
    sides = {"beam.thickness": np.linspace(1e-4, 4e-4, SIDE), "speed": np.linspace(0.0, TOP_SPEED, SIDE)}
    study = bd.study(bd.Scene(beam, bd.Mount(0.215), rolling), sides)
    draw = picture_of(study)
    assert draw is not None
    yield (
        f"maps of three modes over {SIDE} x {SIDE} designs [s]",
        f"{best_time(lambda: png(draw()), 3):.2f}",
        "2",
    )


PARTS = compare, compare_others, draw_maps


if __name__ == "__main__":
    show("many designs", *PARTS)
