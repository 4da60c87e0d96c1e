"""Whether the stated errors of frequencies hold.  Run: python -m benchmarks.coverage [--scenes N]

Random scenes of the range in which nothing is refused, against the power series in mpmath.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from functools import partial

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # before numpy: the workers share the processors

import numpy as np
from numpy.polynomial import Polynomial

import beamdyn as bd
from beamdyn.equations.operators import tension
from benchmarks.beam_core import Row, show
from benchmarks.cases.reference.of_scene import exact, relative_errors

_MATERIALS = ((200e9, 7850.0), (70e9, 2700.0), (5e9, 1200.0))  # Young's modulus [Pa], density [kg/m3]
_BOUND, _OVER = 0.999, 30.0
MOST_TENSION = 1e5
SEED = 5
_DIGITS = 22  # of the reference: enough for errors down to the last bit


@dataclass(frozen=True)
class Case:
    """One random scene: stated and true errors of its first three frequencies, or why it was refused."""

    number: int
    stated: tuple[float, ...] = ()
    true: tuple[float, ...] = ()
    refusal: str = ""


def random_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """A scene and a speed: slenderness 20...2000, gamma <= 50, |delta| <= 10, to 0.999 critical.

    The tension is at most 1e5 EI / L^2 anywhere: past it the series of the reference takes minutes.
    """
    beam = random_beam(rng)
    mount = bd.Mount(
        radius=beam.length * rng.choice([0.0, rng.uniform(0, 10), 10 ** rng.uniform(-2, 1)]),
        setting_angle=rng.choice([0.0, np.pi, rng.uniform(-np.pi, np.pi)]),
        bending_angle=rng.choice([0.0, np.pi / 2, rng.uniform(-np.pi, np.pi)]),
    )
    scene = bd.Scene(beam, mount)
    share = rng.choice([rng.uniform(0, 0.999), 1 - 10 ** rng.uniform(-3, 0)])
    fastest = MOST_TENSION / largest_tension(scene)
    limits = rng.uniform(0, 50) / time_unit(beam), share * bd.critical_speed(scene), np.sqrt(fastest)
    return scene, float(min(limits))


def largest_tension(scene: bd.Scene) -> float:
    """Largest tension over EI / L^2 at unit speed [s^2]."""
    beam, mount, xi = scene.beam, scene.mount, np.linspace(0, 1, 101)
    n_a, n_b = tension(beam)
    force = n_b(xi) - np.cos(mount.setting_angle) * mount.radius * n_a(xi)
    return float(np.abs(force / beam.bending_stiffness(xi)).max()) * beam.length**2


def random_beam(rng: np.random.Generator) -> bd.Beam:
    """A beam of rectangular section, half of them tapered, half with a tip body."""
    length = 10 ** rng.uniform(-2, 1)
    thickness = length / 10 ** rng.uniform(np.log10(20), np.log10(2000))
    width = thickness * 10 ** rng.uniform(0.7, 1.5)
    modulus, density = _MATERIALS[rng.integers(len(_MATERIALS))]
    tapers = rng.uniform(0, 0.8, 2) * rng.integers(0, 2)
    sides = [
        Polynomial([side, -taper * side]) for side, taper in zip((width, thickness), tapers, strict=True)
    ]
    mass = density * length * width * thickness
    return bd.Beam.rectangular(length, *sides, modulus, density, tip=random_tip(rng, mass, length))


def random_tip(rng: np.random.Generator, beam_mass: float, length: float) -> bd.TipMass | None:
    """None, or a slender or stout body of up to ten beam masses."""
    if rng.integers(0, 2):
        return None
    mass = beam_mass * 10 ** rng.uniform(-3, 1)
    inertia = mass * (length * rng.uniform(0, 0.3)) ** 2
    return bd.TipMass(mass, length * rng.uniform(0, 0.2), inertia, axial_inertia=inertia * rng.uniform(0, 1))


def time_unit(beam: bd.Beam) -> float:
    """sqrt(rho A L^4 / EI) at the root [s]."""
    root = np.zeros(1)
    return float(beam.length**2 * np.sqrt(beam.mass_per_length(root) / beam.bending_stiffness(root))[0])


def measured(number: int, seed: int) -> Case:
    """One case, told by its number."""
    scene, speed = random_scene(np.random.default_rng([seed, number]))
    try:
        found = bd.natural_modes(scene, speed)
    except (ValueError, ArithmeticError) as error:
        return Case(number, refusal=str(error))
    return Case(
        number,
        tuple(found.error.tolist()),
        tuple(relative_errors(found, exact(scene, speed, digits=_DIGITS))),
    )


def coverage(cases: Sequence[Case]) -> Iterator[Row]:
    """Share of errors covered, and by how much."""
    answered = [case for case in cases if not case.refusal]
    stated, true = (np.array([getattr(case, name) for case in answered]) for name in ("stated", "true"))
    covered = stated >= true
    yield "random scenes, first three frequencies", str(len(cases)), "10000"
    yield "refused", str(len(cases) - len(answered)), "0"
    yield "stated error covers the true one", f"{covered.mean():.2%}", f"{_BOUND:.1%}"
    yield "median over-estimate", f"{np.median(stated / true):.1f}", f"{_OVER:g}"
    for mode, over in enumerate(np.median(stated / true, axis=0), 1):
        yield f"... of mode {mode}", f"{over:.1f}", ""
    yield "largest ratio of true to stated error", f"{(true / stated).max():.2g}", "1"
    yield "largest true error", f"{true.max():.1e}", ""
    for case in (case for case, hit in zip(answered, covered, strict=True) if not hit.all()):
        yield f"not covered: scene {case.number}", f"{max(case.true):.1e} > {max(case.stated):.1e}", ""


def run(first: int, scenes: int, workers: int, seed: int) -> list[Case]:
    """Measure so many cases."""
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(partial(measured, seed=seed), range(first, first + scenes), chunksize=8))


def sample() -> Iterator[Row]:
    """The first 200 scenes."""
    yield from coverage(run(0, 200, 2, SEED))


PARTS = (sample,)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first case, to go on in parts")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=SEED, help="4 was used to fit the estimate of rounding")
    options = parser.parse_args()
    cases = run(options.first, options.scenes, options.workers, options.seed)
    show("stated errors of frequencies", lambda: coverage(cases))


if __name__ == "__main__":
    main()
