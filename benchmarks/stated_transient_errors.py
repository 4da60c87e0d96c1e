"""Test whether the stated errors of transients cover the true errors.

Run: python -m benchmarks.stated_transient_errors [--scenes N] [--physics | --bent | --waves] [--save FILE].
The scenes and motions are random.  With --physics they have two planes, twist, shear, rotary inertia and
springs in all combinations; with --bent they have large deflection, and the modal truncation error is not
measured; with --waves they have tip bodies on wheels that spin up until the road excites a mode that is kept
or left out.  The reference for the time-integration error is DOP853 of `solve_ivp` or, where this takes too
long, our method at a tolerance of 1e-11; for the modal truncation error it has many modes at three speeds in
a large basis.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np

import beamdyn as bd
from beamdyn.common.results.statements import TOLERANCE, of_kind
from beamdyn.modes.modal.model import ModalBasis, find_speed_range
from beamdyn.transient.elastica_system import ElasticaSystem
from beamdyn.transient.transient import Transient
from benchmarks.cases.random_physics import random_still_scene
from benchmarks.cases.random_scenes import random_beam
from benchmarks.resumable import Cases, add_options
from benchmarks.rows import Row, show

_BOUND = 0.99
_FUNCTIONS = 120  # number of trial functions of the reference
_MANY = 8  # least number of modes of the reference
_DOP853 = 5e3  # largest phase angle of the fastest mode up to which DOP853 is the reference [rad]
SEED = 7
_ROUNDING = 1e-8  # rounding error of the references, over the largest deflection
_TIMES = 2000  # number of times at which tip deflections are compared
_SOFTEST = 0.1  # least spring at the root, over EI/L: with a softer spring the first period is very long


@dataclass(frozen=True)
class Case:
    """One random run: stated and true errors over the largest deflection, or the reason of a refusal."""

    number: int
    stated: tuple[float, float] = (0.0, 0.0)  # errors of time integration and modal truncation
    true: tuple[float, float] = (0.0, 0.0)
    refusal: str = ""
    missed_in_silence: int = 0  # 1 if the true truncation error exceeds the tolerance and no warning says so


def random_run(rng: np.random.Generator) -> dict:
    """Draw arguments of `simulate`: any motion to 0.9 of the critical speed, 3 to 20 periods."""
    beam = random_beam(rng)
    mount = bd.Mount(
        radius=beam.length * rng.choice([0.0, 10 ** rng.uniform(-2, 1)]),
        setting_angle=rng.choice([0.0, np.pi, rng.uniform(-np.pi, np.pi)]),
        bending_angle=rng.choice([0.0, rng.uniform(-np.pi, np.pi)]),
    )
    return _set_in_motion(rng, bd.Scene(beam, mount), (0.5, 1.3))


def random_physics_run(rng: np.random.Generator) -> dict:
    """Draw arguments of `simulate` with all physics; clamped, or on springs of at least 0.1 EI/L."""
    scene = random_still_scene(rng)
    least = _SOFTEST * float(scene.beam.bending_stiffness(np.zeros(1))[0]) / scene.beam.length
    stiff = (k if k >= least else np.inf for k in scene.mount.root_stiffnesses)
    springs = dict(zip(("root_stiffness", "second_root_stiffness"), stiff, strict=True))
    return _set_in_motion(rng, replace(scene, mount=replace(scene.mount, **springs)), (0.3, 0.8))


def random_bent_run(rng: np.random.Generator) -> dict:
    """Draw arguments of `simulate` with large deflection, at tolerances of 1e-3, 1e-6 or 1e-9."""
    beam = random_beam(rng)
    mount = bd.Mount(
        radius=beam.length * rng.choice([0.0, 10 ** rng.uniform(-1, 0.7)]),
        setting_angle=rng.uniform(-np.pi, np.pi),
        bending_angle=rng.choice([0.0, np.pi / 2]),
    )
    given = _set_in_motion(rng, bd.Scene(beam, mount, physics=bd.Physics(large_deflection=True)), (0.3, 0.8))
    return given | {"modes": int(rng.integers(1, 5)), "tolerance": float(rng.choice([1e-3, 1e-6, 1e-9]))}


def random_wave_run(rng: np.random.Generator) -> dict:
    """Draw a beam with tip body on a wheel that spins up until the road excites it near a mode."""
    beam = random_beam(rng)
    own = beam.length * float(beam.mass_per_length(np.linspace(0, 1, 101)).mean())
    mass = own * 10 ** rng.uniform(-1, 1)
    inertia = mass * (beam.length * rng.uniform(0, 0.3)) ** 2
    tip = bd.TipMass(mass, beam.length * rng.uniform(-0.1, 0.2), inertia)
    mount = bd.Mount(
        radius=beam.length * rng.choice([0.0, rng.uniform(0, 2)]),
        setting_angle=rng.choice([0.0, rng.uniform(-np.pi, np.pi)]),
        bending_angle=rng.uniform(-np.pi, np.pi),
    )
    damping = rng.choice([0.0, 10 ** rng.uniform(-4, -1.5)])
    still = bd.Scene(replace(beam, tip=tip), mount, damping_ratio=damping)
    first = 2 * np.pi * bd.natural_modes(still, 0.0, 1).frequency[0]
    speed = min(rng.uniform(0.3, 0.9) * bd.critical_speed(still), first * rng.uniform(0.3, 2))
    near = 2 * np.pi * bd.natural_modes(still, speed, 4).frequency[rng.integers(4)] * rng.uniform(0.85, 1.15)
    t_end = 2 * np.pi / first * 10 ** rng.uniform(0.5, 1.0)
    radius = beam.length * rng.uniform(1, 5)
    road = bd.RoadWave(2 * np.pi * radius * speed / near, height=beam.length * 10 ** rng.uniform(-5, -2.5))
    motion = bd.RollingWheel(radius, bd.SpinUp(speed, t_end * rng.uniform(0.1, 0.9)), road)
    return {
        "scene": replace(still, motion=motion),
        "t_end": float(t_end),
        "modes": "auto" if rng.integers(4) else int(rng.integers(1, 5)),
        "tolerance": 1e-5 if rng.integers(2) else float(10 ** rng.uniform(-6, -3)),
    }


def _set_in_motion(rng: np.random.Generator, scene: bd.Scene, periods: tuple[float, float]) -> dict:
    """Return arguments of `simulate` for a scene with damping, gravity and motion over 10^periods."""
    beam = scene.beam
    still = replace(
        scene,
        damping_ratio=rng.choice([0.0, 10 ** rng.uniform(-4, -1)]),
        gravity=rng.choice([0.0, 9.81]),
    )
    first = 2 * np.pi * bd.natural_modes(still, 0.0, 1).frequency[0]
    speed = min(rng.uniform(0, 0.9) * bd.critical_speed(still), 10 ** rng.uniform(-1.5, 0.7) * first)
    t_end = 2 * np.pi / first * 10 ** rng.uniform(*periods)
    return {
        "scene": replace(still, motion=random_motion(rng, speed, t_end, beam.length)),
        "t_end": float(t_end),
        "modes": "auto" if rng.integers(2) else int(rng.integers(1, 7)),
        "tolerance": float(10 ** rng.uniform(-7, -2)),
    }


def random_motion(rng: np.random.Generator, speed: float, t_end: float, length: float) -> bd.Motion:
    """Draw a motion: steady, spun up, or by a table of speeds; half of them on a wheel."""
    times = np.linspace(0, t_end, rng.integers(4, 9))
    rotation = [
        bd.SteadyRotation(speed),
        bd.SpinUp(speed, duration=t_end * rng.uniform(0.1, 0.9)),
        bd.SpinUp(speed, duration=t_end * rng.uniform(0.1, 0.9), law="linear"),
        bd.SampledRotation(times, speed * rng.uniform(0, 1, len(times)), interpolation="pchip"),
    ][rng.integers(4)]
    if rng.integers(2):
        return rotation
    radius = length * 10 ** rng.uniform(0, 1)
    road = bd.RoadWave(wavelength=radius * rng.uniform(0.3, 3), height=length * 10 ** rng.uniform(-4, -2))
    return bd.RollingWheel(radius, rotation, road if rng.integers(4) else None)


def measure(number: int, seed: int, draw: Callable[[np.random.Generator], dict] = random_run) -> list[Case]:
    """Compute stated and true errors of the run with a number."""
    given = draw(np.random.default_rng([seed, number]))
    t = np.linspace(0, given["t_end"], _TIMES)
    try:
        run = bd.simulate(**given, t_eval=t)
    except (ValueError, ArithmeticError) as error:
        return [Case(number, refusal=str(error))]
    size = run.largest or 1.0
    modes = (0.0, 0.0)
    if not run.scene.physics.large_deflection:
        find = find_error_by_twice_the_modes if draw is random_wave_run else find_mode_error
        modes = run.mode_error, find(run, t) / size
    stated, true = run.time_error / size, find_time_error(run, t) / size
    warned = bool(of_kind(run.warnings, TOLERANCE))
    missed = given["modes"] == "auto" and modes[1] > given["tolerance"] + _ROUNDING and not warned
    return [Case(number, (stated, modes[0]), (true, modes[1]), missed_in_silence=int(missed))]


def find_time_error(run: Transient, t: np.ndarray) -> float:
    """Compute the largest deviation [m] from the same modes with negligible time-integration error."""
    straight = run.system.straight if isinstance(run.system, ElasticaSystem) else run.system
    _, K, _ = straight.coefficients(np.zeros(1))
    phase = run.path.end * float(np.sqrt(np.abs(np.linalg.eigvals(K)).max()))
    if phase < _DOP853:
        options = {"atol": 1e-300 + 1e-13 * run.largest, "rtol": 3e-13}
        exact = replace(run.request, method="DOP853", options=options).run()
    else:
        exact = replace(run.request, tolerance=1e-11).run()
    return _largest_distance(run, exact, t)


def find_mode_error(run: Transient, t: np.ndarray) -> float:
    """Compute the largest deviation [m] from a run with many more modes, both without time error."""
    ends = find_speed_range(run.request.motion, run.path.end)
    speeds = tuple(np.unique([*ends, np.mean(ends)]).tolist())
    basis = ModalBasis(max(_MANY, 2 * (run.request.basis.modes or 0)), speeds)
    return _distance_with(run, basis, bd.Ritz(_FUNCTIONS), t)


def find_error_by_twice_the_modes(run: Transient, t: np.ndarray) -> float:
    """Compute the largest deviation [m] from a run with twice as many modes, at least four."""
    ends = find_speed_range(run.request.motion, run.path.end)
    modes = max(_MANY // 2, 2 * (run.request.basis.modes or 0))
    return _distance_with(run, ModalBasis(modes, ends), bd.Ritz(max(_FUNCTIONS // 2, 2 * modes)), t)


def _distance_with(run: Transient, basis: ModalBasis, discretization: bd.Ritz, t: np.ndarray) -> float:
    """Compute the largest difference [m] from a run in another basis, both without time error."""
    few = replace(run.request, tolerance=1e-8, t_eval=None)
    many = replace(few, discretization=discretization, basis=basis)
    try:
        return _largest_distance(few.run(), many.run(), t)
    except ArithmeticError:  # with more modes the motion is unstable
        return np.inf


def _largest_distance(run: Transient, other: Transient, t: np.ndarray) -> float:
    """Compute the largest distance of the tips of two runs [m], as vectors in both directions."""
    each = (run.deflection(t, i) - other.deflection(t, i) for i in range(run.system.equations.planes))
    return float(np.hypot.reduce([np.abs(difference) for difference in each]).max())


def summarize(cases: Sequence[Case]) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, the over-estimate, and refusals."""
    answered = [case for case in cases if not case.refusal]
    yield "random runs", str(len(cases)), "200"
    yield "refused", str(len(cases) - len(answered)), ""
    for k, name in enumerate(("time-integration error", "modal truncation error")):
        stated, true = (
            np.array([getattr(case, which)[k] for case in answered]) for which in ("stated", "true")
        )
        covered = stated + _ROUNDING >= true
        known = (true > 0) & np.isfinite(true) & np.isfinite(stated)
        over = np.median(stated[known] / true[known])
        yield f"{name} covered", f"{covered.mean():.1%}", f"{_BOUND:.0%}"
        yield "... median over-estimate", f"{over:.1f}", ""
        yield "... largest true error, over the largest deflection", f"{true.max():.1e}", ""
        for case in (case for case, hit in zip(answered, covered, strict=True) if not hit):
            yield f"... not covered: run {case.number}", f"{case.true[k]:.1e} > {case.stated[k]:.1e}", ""
    yield "tolerances missed in silence", str(sum(case.missed_in_silence for case in answered)), "0"
    for case in cases:
        if case.refusal:
            yield f"refused: run {case.number}", case.refusal, ""


def measure_sample() -> Iterator[Row]:
    """Measure the first 20 runs."""
    yield from summarize(Cases(partial(measure, seed=SEED), Case).measure_all(range(20)))


PARTS = (measure_sample,)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, scenes=200, seed=SEED)
    kind = parser.add_mutually_exclusive_group()
    kind.add_argument("--physics", action="store_true", help="with all physics in all combinations")
    kind.add_argument("--bent", action="store_true", help="with large deflection")
    kind.add_argument("--waves", action="store_true", help="of tip bodies on waves near their modes")
    given = parser.parse_args()
    draws = ("physics", random_physics_run), ("bent", random_bent_run), ("waves", random_wave_run)
    draw = next((draw for name, draw in draws if getattr(given, name)), random_run)
    runs = Cases(partial(measure, seed=given.seed, draw=draw), Case).run(given)
    show("stated errors of transients", lambda: summarize(runs))


if __name__ == "__main__":
    main()
