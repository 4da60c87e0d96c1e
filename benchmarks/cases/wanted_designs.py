"""Inverse design questions with known answers: in closed form, by proportion, or by exhaustive search."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import Literal

import numpy as np
from scipy.optimize import brentq

import beamdyn as bd
from beamdyn.common.results.statements import unannounced
from beamdyn.scene.numbers import with_numbers
from beamdyn.scene.scene import Scene

E, DENSITY, LENGTH, WIDTH, THICKNESS = 200e9, 7850.0, 0.05, 0.01, 0.0002
STRIP = bd.Beam.rectangular(LENGTH, WIDTH, THICKNESS, E, DENSITY)
INWARD = bd.Scene(STRIP, bd.Mount(radius=0.215))
ROAD = bd.RollingWheel(0.3, 55.0, bd.RoadWave(0.3, velocity_amplitude=0.01))
ROLLING = bd.Scene(STRIP, bd.Mount(radius=0.215), ROAD, damping_ratio=0.02)
WIDE = {"beam.thickness": (1e-4, 4e-4), "beam.length": (0.03, 0.08)}


@dataclass(frozen=True)
class Wanted:
    """An inverse question, and its answer.

    Parameters
    ----------
    name : str
        Name of the question.
    scene, free, targets
        As for `design`.
    values : tuple of float or None
        The numbers to be found; None if no design meets the targets, or `best` is known alone.
    best : float or None
        The best value of the target, if the question asks for a largest or smallest value.
    """

    name: str
    scene: Scene
    free: dict[str, tuple[float, float]]
    targets: list[bd.Target]
    values: tuple[float, ...] | None = None
    best: float | None = None

    def found(self) -> tuple[float, int]:
        """Relative error of the answer, and number of solutions of the equations.

        The error is inf where a design is missed, and 0 where it is proven that there is none.
        """
        with unannounced():
            found = bd.design(self.scene, self.free, self.targets)
        if self.values is None and self.best is None:
            return (0.0 if found.why_none and not found.found else math.inf), found.solves
        if not found.found:
            return math.inf, found.solves
        if self.best is not None:
            return abs(float(found.reached[0]) / self.best - 1), found.solves
        return float(np.abs(found.value / np.array(self.values) - 1).max()), found.solves


def frequency(mode: int = 1, body: float = 0.0, **numbers: float) -> float:
    """Compute the frequency [Hz] of a cantilever at rest with a point mass at its tip, in closed form."""

    def determinant(b: float) -> float:
        bending = b * (math.cos(b) * math.sinh(b) - math.sin(b) * math.cosh(b))
        return 1 + math.cos(b) * math.cosh(b) + body * bending

    b = brentq(determinant, (mode - 1) * math.pi + 1e-3, mode * math.pi, xtol=1e-14)
    own = {"youngs_modulus": E, "density": DENSITY, "length": LENGTH, "thickness": THICKNESS} | numbers
    wave = math.sqrt(own["youngs_modulus"] / (12 * own["density"])) * own["thickness"]
    return b**2 * wave / (2 * math.pi * own["length"] ** 2)


def questions() -> Iterator[Wanted]:
    """Yield all questions."""
    for some in (_by_powers, _by_a_body, _out_of_reach, _as_before, _of_two_numbers, _the_best):
        yield from some()


def _by_powers() -> Iterator[Wanted]:
    """Yield questions on one number, if a frequency at rest is proportional to a power of it."""
    ranges = {"thickness": (1e-4, 4e-4), "length": (0.03, 0.08), "density": (2e3, 12e3)}
    ranges |= {"youngs_modulus": (50e9, 400e9)}
    for name, (low, high) in ranges.items():
        for mode, share in ((1, 0.2), (2, 0.7), (3, 0.93)):
            value = low * (high / low) ** share
            target = bd.Target("frequencies", equals=frequency(mode, **{name: value}), mode=mode)
            yield Wanted(f"{name}, mode {mode}", INWARD, {f"beam.{name}": (low, high)}, [target], (value,))
    own = bd.critical_speed(INWARD)
    for value in (1.3e-4, 3.7e-4):
        target = bd.Target("critical_speed", equals=own * value / THICKNESS)
        yield Wanted("buckling", INWARD, {"beam.thickness": (1e-4, 4e-4)}, [target], (value,))
    first = bd.resonance_speeds(ROLLING, 300.0, 1).crossings
    own = next(each.speed for each in first if each.line.name == "road +" and each.kind == "forced")
    for value in (1.4e-4, 2.9e-4):
        target = bd.Target("crossings", equals=own * value / THICKNESS, line="road +")
        yield Wanted("resonance", ROLLING, {"beam.thickness": (1e-4, 4e-4)}, [target], (value,))


def _by_a_body() -> Iterator[Wanted]:
    mass = DENSITY * LENGTH * WIDTH * THICKNESS
    for body in (0.03, 0.4, 1.7):
        for mode in (1, 2):
            target = bd.Target("frequencies", equals=frequency(mode, body), mode=mode)
            free = {"beam.tip.mass": (0.0, 2 * mass)}
            yield Wanted(f"tip mass, mode {mode}", INWARD, free, [target], (body * mass,))


def _out_of_reach() -> Iterator[Wanted]:
    """Yield questions with unreachable or contradictory targets."""
    thickness = {"beam.thickness": (1e-4, 2e-4)}
    for factor in (1.001, 3.0):
        target = bd.Target("frequencies", equals=factor * frequency())
        yield Wanted("too fast", INWARD, thickness, [target])
    yield Wanted("too slow", INWARD, thickness, [bd.Target("frequencies", equals=0.499 * frequency())])
    critical = bd.critical_speed(INWARD)
    yield Wanted("never buckles", INWARD, thickness, [bd.Target("critical_speed", at_least=1.01 * critical)])
    fastest = frequency(thickness=4e-4, length=0.03)
    yield Wanted("two numbers", INWARD, WIDE, [bd.Target("frequencies", equals=1.02 * fastest)])
    both = [
        bd.Target("frequencies", at_least=1.1 * frequency()),
        bd.Target("critical_speed", at_most=1.05 * critical),
    ]
    yield Wanted("contradictory", INWARD, {"beam.thickness": (1e-4, 4e-4)}, both)
    both = [bd.Target("frequencies", equals=frequency(mode), mode=mode) for mode in (1, 2)]
    both[1] = bd.Target("frequencies", equals=1.01 * frequency(2), mode=2)
    yield Wanted("a ratio that never is", INWARD, WIDE, both)


def _as_before() -> Iterator[Wanted]:
    """Yield questions on one number, whose target is the answer computed for a known design."""
    cases = {
        "beam.thickness": ((1e-4, 4e-4), (1.6e-4, 3.3e-4)),
        "mount.radius": ((0.05, 0.5), (0.11, 0.42)),
        "mount.setting_angle": ((0.0, 3.1), (0.4, 2.2)),
        "beam.length": ((0.03, 0.06), (0.035, 0.055)),
    }
    for path, (bounds, values) in cases.items():
        for value in values:
            scene = with_numbers(INWARD, {path: value})
            at = float(bd.natural_modes(scene, 50.0, 1).frequency[0])
            target = bd.Target("frequencies", equals=at, speed=50.0)
            yield Wanted(f"{path} at 50 rad/s", INWARD, {path: bounds}, [target], (value,))
    for value in (0.1, 0.4):
        at = bd.critical_speed(with_numbers(INWARD, {"mount.radius": value}))
        target = bd.Target("critical_speed", equals=at)
        yield Wanted("buckling by the radius", INWARD, {"mount.radius": (0.06, 0.5)}, [target], (value,))


def _of_two_numbers() -> Iterator[Wanted]:
    """Yield questions on two numbers: the nearest design on a line, or the design that meets two targets."""
    spans = np.array([math.log(high / low) for low, high in WIDE.values()])
    for factor in (0.7, 1.2, 1.8):
        # The nearest point of a + A d = 0, in fractions of the ranges, with frequency f ~ h / L^2.
        normal = np.array([1.0, -2.0]) * spans
        step = normal * math.log(factor) / (normal @ normal)
        values = np.array([THICKNESS, LENGTH]) * np.exp(step * spans)
        target = bd.Target("frequencies", equals=factor * frequency())
        yield Wanted("the nearest design", INWARD, WIDE, [target], tuple(values.tolist()))
    for thickness, length in ((1.5e-4, 0.04), (2.6e-4, 0.066), (3.5e-4, 0.05)):
        scene = with_numbers(INWARD, {"beam.thickness": thickness, "beam.length": length})
        both = [
            bd.Target("frequencies", equals=frequency(thickness=thickness, length=length)),
            bd.Target("critical_speed", equals=bd.critical_speed(scene)),
        ]
        yield Wanted("two answers", INWARD, WIDE, both, (thickness, length))
    both = [bd.Target("frequencies", equals=frequency()), bd.Target("critical_speed", at_least=180.0)]
    yield Wanted("limited", INWARD, WIDE, both, _limited(180.0))


def _limited(critical: float) -> tuple[float, float]:
    """Find thickness h and length L with unchanged frequency (h ~ L^2) that buckle at a speed [rad/s]."""

    def beyond(length: float) -> float:
        thickness = THICKNESS * (length / LENGTH) ** 2
        numbers = {"beam.thickness": thickness, "beam.length": length}
        return bd.critical_speed(with_numbers(INWARD, numbers)) - critical

    length = brentq(beyond, 0.05, 0.2, xtol=1e-13)
    return THICKNESS * (length / LENGTH) ** 2, length


def _the_best() -> Iterator[Wanted]:
    """Yield questions on the largest or smallest answer: at a corner of the ranges, a limit, or inside."""
    fastest = frequency(thickness=4e-4, length=0.03)
    slowest = frequency(thickness=1e-4, length=0.08)
    yield Wanted("fastest", INWARD, WIDE, [bd.Target("frequencies", best="largest")], best=fastest)
    yield Wanted("slowest", INWARD, WIDE, [bd.Target("frequencies", best="smallest")], best=slowest)
    longer, own = bd.critical_speed(with_numbers(INWARD, {"beam.length": 0.08})), bd.critical_speed(INWARD)
    thinnest = max(1e-4, THICKNESS * 100.0 / longer)
    both = [bd.Target("frequencies", best="smallest"), bd.Target("critical_speed", at_least=100.0)]
    best = frequency(thickness=thinnest, length=0.08)
    yield Wanted("slow, and no buckling", INWARD, WIDE, both, best=best)
    thickness = {"beam.thickness": (1e-4, 4e-4)}
    both = [bd.Target("frequencies", best="largest"), bd.Target("critical_speed", at_most=1.3 * own)]
    yield Wanted("fast, and buckles", INWARD, thickness, both, best=1.3 * frequency())
    for bounds in ((1.7e-4, 2.6e-4), (2.3e-4, 4e-4)):
        yield _amplitude("largest", bounds)
        yield _amplitude("smallest", bounds)


def _amplitude(word: Literal["largest", "smallest"], bounds: tuple[float, float]) -> Wanted:
    """Find the thickness of the best steady amplitude by exhaustive search, refined near the best."""

    def amplitudes(values: np.ndarray) -> np.ndarray:
        return bd.study(ROLLING, {"beam.thickness": values}, "amplitude", speed=55.0).value

    pick: Callable[[np.ndarray], np.intp] = np.argmax if word == "largest" else np.argmin
    values, best = np.linspace(*bounds, 41), 0.0
    for _ in range(3):
        found = amplitudes(values)
        k = int(pick(found))
        best = float(found[k])
        values = np.linspace(values[max(k - 1, 0)], values[min(k + 1, len(values) - 1)], 41)
    target = bd.Target("amplitude", best=word, speed=55.0)
    return Wanted(f"{word} amplitude", ROLLING, {"beam.thickness": bounds}, [target], best=best)
