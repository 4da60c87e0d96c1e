"""Frequencies and critical speeds over the whole range of inputs: right, or refused.

Run: python -m benchmarks.extremes

Every answer is compared with another method: guaranteed bounds, the power series in mpmath, the closed form
of the uniform beam at rest for up to 200 modes, or finite elements for the beam with stretch.  An answer is
"wrong in silence" if its true error exceeds its stated error.
"""

from __future__ import annotations

import argparse
import os
import warnings
from collections import Counter
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass, replace
from functools import partial

# One thread each, set before numpy is imported: the worker processes share the processors.
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")

import numpy as np
from numpy.polynomial import Polynomial
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.modes.bounds import _nondimensional
from beamdyn.modes.flexibility import bound_flexibility
from beamdyn.modes.residual_bound import PlaneEnclosure
from benchmarks.cases.random_scenes import MOST_TENSION, largest_tension
from benchmarks.cases.reference.of_scene import exact, exact_critical_speed, relative_errors
from benchmarks.cases.scenes import time_unit
from benchmarks.cases.similar_beams import deviation
from benchmarks.rows import Row, show

_EPS = float(np.finfo(float).eps)

_QUARTER = np.pi / 2
SEED = 11
_NEAR = 1e-9  # relative distance from a critical speed at which the bounds' sign is not rounding
_QUICK_TENSION = 1e4  # tension over EI / L^2 up to which the power series takes a second for a critical speed
_FASTEST_GAMMA = 1e6  # gamma up to which the absence of a critical speed must be proven
_WARNED = 1e-6  # stated error above which an answer has a warning
_STEEL = 200e9, 7850.0


@dataclass(frozen=True)
class Outcome:
    """Outcome for one random scene."""

    kind: str
    verdict: str  # "right", "right, with a warning", "refused" or "wrong in silence"
    known: float  # relative uncertainty of the reference
    detail: str = ""


# Draws --------------------------------------------------------------------------------------------


def draw_beam(rng: np.random.Generator, taper: bool = True, tip: bool = True) -> bd.Beam:
    """Draw a beam of 10 um to 100 m, slenderness 10 to 1e6, with a tip body of up to 1e6 beam masses."""
    length = 10 ** rng.uniform(-5, 2)
    thickness = length / 10 ** rng.uniform(1, 6)
    tapers = rng.uniform(0, 0.9, 2) * rng.integers(0, 2) * taper
    sides = [Polynomial([s, -t * s]) for s, t in zip((10 * thickness, thickness), tapers, strict=True)]
    mass = _STEEL[1] * length * 10 * thickness**2 * 10 ** rng.uniform(-6, 6)
    body = bd.TipMass(mass, length * rng.uniform(0, 0.1)) if tip and rng.integers(0, 2) else None
    return bd.Beam.rectangular(length, *sides, *_STEEL, tip=body)


def draw_mount(rng: np.random.Generator, length: float) -> bd.Mount:
    """Draw a mount with a hub radius up to 1e6 lengths and any angles, many at or near a quarter turn."""
    angles = [0.0, np.pi, _QUARTER, _QUARTER + rng.choice([-1, 1]) * 1e-12, rng.uniform(-np.pi, np.pi)]
    return bd.Mount(
        length * rng.choice([0.0, 10 ** rng.uniform(-3, 6)]),
        angles[rng.integers(len(angles))],
        rng.choice([0.0, _QUARTER, rng.uniform(-np.pi, np.pi)]),
    )


def draw_scene_that_may_buckle(rng: np.random.Generator) -> bd.Scene:
    """Draw a scene; half of the tip bodies are inboard, half of the directions nearly tangential."""
    beam = draw_beam(rng)
    mount = draw_mount(rng, beam.length)
    if beam.tip is not None and rng.integers(0, 2):
        moments = np.sort(beam.tip.mass * beam.length**2 * 10 ** rng.uniform(-6, -1, 3))
        moments[2] = min(moments[2], moments[0] + moments[1])
        tip = bd.TipMass(beam.tip.mass, beam.length * rng.uniform(-0.3, 0.3), *rng.permutation(moments))
        beam = replace(beam, tip=tip)
    if rng.integers(0, 2):
        mount = replace(mount, setting_angle=_QUARTER + rng.choice([-1, 1]) * 10 ** rng.uniform(-6, -1.7))
    return bd.Scene(beam, mount)


def draw_scene(rng: np.random.Generator) -> tuple[bd.Scene, float]:
    """Draw any scene and speed: gamma to 1e4, also past the critical speed."""
    beam = draw_beam(rng)
    scene = bd.Scene(beam, draw_mount(rng, beam.length))
    gamma = rng.choice([0.0, 10 ** rng.uniform(-8, 4)]) / time_unit(beam)
    if rng.integers(0, 2) and np.isfinite(critical := bd.critical_speed(scene)):
        side = rng.choice([1 - 10 ** rng.uniform(-12, 0), 1 + 10 ** rng.uniform(-12, 0.5)])
        return scene, float(side * critical * rng.choice([1, -1]))
    return scene, float(gamma * rng.choice([1, -1]))


# Checks against references ------------------------------------------------------------------------


def check_by_bounds(rng: np.random.Generator) -> Outcome:
    """Check three modes against the guaranteed bounds of their squares."""
    scene, speed = draw_scene(rng)
    modes = bd.natural_modes(scene, speed)
    bounds = bd.frequency_bounds(scene, speed)
    squared = -np.real(modes.eigenvalue**2)
    # Near the critical speed the squared frequency is a small difference of large terms: rounding grows.
    cond = np.abs(squared[-1] / squared) if len(squared) else 1.0
    error = np.maximum(modes.error, 4 * _EPS * cond)
    room = np.abs(squared) * (2 * error + error**2)
    low, high = bounds.lower_squared, bounds.upper_squared
    low, high = np.where(np.isnan(low), -np.inf, low), np.where(np.isnan(high), np.inf, high)
    fits = bool((np.maximum(low - squared, squared - high) <= room).all())
    width = float(np.median((high - low) / np.abs(squared))) / 2
    return judge("guaranteed bounds", modes, fits, width, f"{scene} at {speed!r}")


def check_by_series(rng: np.random.Generator) -> Outcome:
    """Check three modes against the power series, which is exact, up to a tension of 1e5 EI / L^2."""
    scene, speed = draw_scene(rng)
    speed = float(np.sign(speed) * min(abs(speed), np.sqrt(MOST_TENSION / largest_tension(scene))))
    modes = bd.natural_modes(scene, speed)
    true = np.array(relative_errors(modes, exact(scene, speed, digits=22)))
    squared = np.abs(modes.eigenvalue) ** 2
    fits = bool((true <= np.maximum(modes.error, 4 * _EPS * squared[-1] / squared)).all())
    return judge("power series", modes, fits, 1e-20, f"{scene} at {speed!r}")


def check_at_rest(rng: np.random.Generator) -> Outcome:
    """Check up to 200 modes of a uniform beam at rest against the roots of cos x cosh x = -1."""
    beam = draw_beam(rng, taper=False, tip=False)
    count = int(10 ** rng.uniform(0, np.log10(200)))
    modes = bd.natural_modes(bd.Scene(beam, bd.Mount(0.0)), 0.0, count)
    exact = np.array([find_root(n) for n in range(1, count + 1)]) ** 2 / time_unit(beam) / (2 * np.pi)
    true = np.abs(modes.frequency / exact - 1)
    fits = bool((true <= np.maximum(modes.error, 8 * _EPS)).all())
    return judge("closed form at rest, to 200 modes", modes, fits, _EPS, f"{beam}, {count} modes")


def check_critical_by_bounds(rng: np.random.Generator) -> Outcome:
    """Check a critical speed by guaranteed bounds on either side; its absence up to a high speed."""
    scene = draw_scene_that_may_buckle(rng)
    discretization = rng.choice(["ritz", "fem"], p=[0.9, 0.1])
    point = bd.critical_point(scene, str(discretization), draw_tolerance(rng))
    prover = Prover(scene)
    if np.isinf(point.error) or np.isinf(point.speed):
        top = min(point.none_below, _FASTEST_GAMMA / time_unit(scene.beam))
        speeds = top * np.append(1 - _NEAR, 10 ** rng.uniform(-6, 0, 3))
        fits, known = not any(prover.is_stable(speed) is False for speed in speeds), np.nan
    else:
        stable = [prover.is_stable(point.speed * (1 + side * (point.error + _NEAR))) for side in (-1, 1)]
        fits = stable[0] is not False and stable[1] is not True
        known = point.error if stable == [True, False] else np.nan
    kind = "guaranteed bounds, critical speed"
    return judge_answer(
        kind, bool(point.warnings), fits, known, f"{scene}: {point.speed!r} +- {point.error:.1e}"
    )


class Prover:
    """Prover, by guaranteed bounds of two sizes, that a scene's stiffness at a speed is positive or not."""

    def __init__(self, scene: bd.Scene) -> None:
        scaled, self.time = _nondimensional(scene)
        flexibility = bound_flexibility(scaled.beam.bending_stiffness)
        self.splits = [PlaneEnclosure(scaled, size, 0.0, flexibility) for size in (32, 64)]

    def is_stable(self, speed: float) -> bool | None:
        """Return whether the stiffness is proven to be positive, or not; None if neither is proven."""
        for split in self.splits:
            lower = split.stiffness_form((speed * self.time) ** 2)
            if lower is not None and np.isfinite(lower).all() and np.linalg.eigvalsh(lower)[0] >= 0:
                return True
            split.speed = speed * self.time
            if np.linalg.eigvalsh(split.upper_form(0.0))[0] <= 0:
                return False
        return None


def draw_tolerance(rng: np.random.Generator) -> float | None:
    """Draw a tolerance of 0.1 to 1e-9, or None."""
    return None if rng.integers(0, 2) else float(10 ** rng.uniform(-9, -1))


def check_critical_by_series(rng: np.random.Generator) -> Outcome:
    """Check a critical speed against the power series, up to a tension of 1e4 EI / L^2."""
    tension = np.inf
    while tension > _QUICK_TENSION:  # above, or without a critical speed, the series takes long
        scene = draw_scene_that_may_buckle(rng)
        point = bd.critical_point(scene, tolerance=draw_tolerance(rng))
        tension = point.speed**2 * largest_tension(scene)
    exact = exact_critical_speed(scene, digits=20)
    fits = bool(abs(point.speed / exact - 1) <= max(point.error, 4 * _EPS))
    kind = "power series, critical speed"
    return judge_answer(kind, bool(point.warnings), fits, 1e-20, f"{scene}: {point.speed!r}, exactly {exact}")


def find_root(n: int) -> float:
    """Find the n-th root of cos x = -1 / cosh x."""
    middle = (n - 0.5) * np.pi
    return (
        middle
        if n > 12
        else float(brentq(lambda x: np.cos(x) + 1 / np.cosh(x), middle - 1, middle + 1, xtol=1e-15))
    )


def check_with_stretch(rng: np.random.Generator) -> Outcome:
    """Check stretch with ratios EA L^2 / EI to 1e16 against finite elements."""
    beam = draw_beam(rng, tip=False)
    ratio = 10 ** rng.uniform(3, 16)
    soft = bd.Beam.from_stiffness(
        beam.length,
        beam.mass_per_length,
        beam.bending_stiffness,
        axial_stiffness=ratio * float(beam.bending_stiffness(np.zeros(1))[0]) / beam.length**2,
    )
    scene = bd.Scene(
        soft, bd.Mount(beam.length * 10 ** rng.uniform(-2, 1), np.pi), physics=bd.Physics(stretch=True)
    )
    speed = min(10 ** rng.uniform(-2, 1.5), 0.3 * np.sqrt(ratio)) / time_unit(beam)
    modes, other = (bd.natural_modes(scene, speed, 2, discretization) for discretization in ("ritz", "fem"))
    apart = np.abs(modes.eigenvalue - other.eigenvalue) / np.abs(modes.eigenvalue)
    fits = bool((apart <= modes.error + other.error).all())
    return judge(
        "finite elements, with stretch", modes, fits, float(other.error.max()), f"{scene} at {speed!r}"
    )


def judge(kind: str, modes: bd.Modes, fits: bool, known: float, detail: str) -> Outcome:
    """Return the outcome for modes, given whether they agree with the known values."""
    return judge_answer(kind, bool(modes.error.max() > _WARNED), fits, known, detail)


def judge_answer(kind: str, warned: bool, fits: bool, known: float, detail: str) -> Outcome:
    """Return the outcome for an answer, given whether it agrees with the known value."""
    if not fits:
        return Outcome(kind, "wrong in silence", known, detail)
    return Outcome(kind, "right, with a warning" if warned else "right", known)


_KINDS: tuple[tuple[str, float, Callable[[np.random.Generator], Outcome]], ...] = (
    ("guaranteed bounds", 0.64, check_by_bounds),
    ("guaranteed bounds, critical speed", 0.29, check_critical_by_bounds),
    ("power series, critical speed", 0.01, check_critical_by_series),
    ("power series", 0.01, check_by_series),
    ("closed form at rest, to 200 modes", 0.03, check_at_rest),
    ("finite elements, with stretch", 0.02, check_with_stretch),
)


def draw_and_check(number: int, seed: int) -> Outcome:
    """Draw the scene with a number, check it, and return the outcome."""
    rng = np.random.default_rng([seed, number])
    name, _, check = _KINDS[rng.choice(len(_KINDS), p=[share for _, share, _ in _KINDS])]
    try:
        with warnings.catch_warnings(action="ignore"):
            return check(rng)
    except (ValueError, ArithmeticError, np.linalg.LinAlgError) as error:
        return Outcome(name, "refused", np.nan, str(error))


# Report -------------------------------------------------------------------------------------------


def summarize(outcomes: Sequence[Outcome]) -> Iterator[Row]:
    """Yield counts of verdicts, and the reasons of refusals."""
    verdicts = Counter(o.verdict for o in outcomes)
    yield "random draws", str(len(outcomes)), "100000"
    yield "wrong in silence", str(verdicts["wrong in silence"]), "0"
    yield "refused", f"{verdicts['refused'] / len(outcomes):.2%}", "2%"
    yield "right", f"{verdicts['right'] / len(outcomes):.1%}", ""
    yield (
        "right, with a warning that digits are lost",
        f"{verdicts['right, with a warning'] / len(outcomes):.1%}",
        "",
    )
    for name, _, _ in _KINDS:
        of_kind = [o for o in outcomes if o.kind == name]
        bad = sum(o.verdict == "wrong in silence" for o in of_kind)
        known = np.nanmedian([o.known for o in of_kind])
        yield f"held against {name}", f"{len(of_kind)}, {bad} wrong", f"known to {known:.0e}"
    for o in [o for o in outcomes if o.verdict == "wrong in silence"][:10]:
        yield f"wrong in silence ({o.kind})", o.detail[:300], ""
    reasons = Counter(
        o.detail.partition(":")[2][:60] or o.detail[:60] for o in outcomes if o.verdict == "refused"
    )
    for reason, many in reasons.most_common(8):
        yield "refused", f"{many}", reason


def draw_all(first: int, scenes: int, workers: int, seed: int) -> list[Outcome]:
    """Draw and check a number of scenes, from a first number on, in several processes."""
    with ProcessPoolExecutor(workers) as pool:
        return list(pool.map(partial(draw_and_check, seed=seed), range(first, first + scenes), chunksize=64))


def measure_sample() -> Iterator[Row]:
    """Measure the first 1000 draws."""
    yield from summarize(draw_all(0, 1000, 2, SEED))


def measure_linear_models() -> Iterator[Row]:
    """Measure deviations between linear models of similar steel beams of 1 um to 1 km."""
    apart = [deviation(10.0**power, planes) for power in range(-6, 4) for planes in (1, 2)]
    yield "linear models of 1 um to 1 km, over those of 1 m", f"{max(apart):.0e}", "1e-9"


PARTS = (measure_sample, measure_linear_models)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--scenes", type=int, default=100_000)
    parser.add_argument("--first", type=int, default=0, help="number of the first draw, to go on in parts")
    parser.add_argument("--workers", type=int, default=2)
    parser.add_argument("--seed", type=int, default=SEED)
    options = parser.parse_args()
    outcomes = draw_all(options.first, options.scenes, options.workers, options.seed)
    show("the whole range of inputs", lambda: summarize(outcomes), measure_linear_models)


if __name__ == "__main__":
    main()
