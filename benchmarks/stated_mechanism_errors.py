"""Test whether the stated errors of mechanisms cover the true errors.

Run: python -m benchmarks.stated_mechanism_errors [--mechanisms N].  Random mechanisms are solved without
friction and sliding in either direction; some of them are far from the origin, some have nearly the friction
at which they jam.  Blocks on round drums that have rotated are solved, too.  The reference is equilibrium in
40 digits.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator
from dataclasses import replace
from typing import NamedTuple

import mpmath
import numpy as np

from beamdyn.common.results.statements import IN_LINE, of_kind
from benchmarks.cases import mechanisms
from benchmarks.cases.mechanism_digits import exact_forces
from benchmarks.invariant_verdicts import draw_mechanism, transform
from benchmarks.rows import Row, show
from brakes import planar

SEED = 4
_LEAST = 1e-17  # least true error, because double precision is no more accurate
_FAR = 1e4  # largest shift of a mechanism [m]


class Case(NamedTuple):
    """A mechanism, its driving load if it has friction, and the travel of this load [rad, m]."""

    mechanism: planar.Mechanism
    driver: str | None
    moved: float = 0.0


class Errors(NamedTuple):
    """Stated and true relative error of the forces of a mechanism."""

    stated: float
    true: float


def draw(rng: np.random.Generator) -> Case:
    """Draw a random mechanism; one in three is far from the origin."""
    mechanism, driver = (
        draw_mechanism(rng) if rng.random() < 0.5 else (mechanisms.random_mechanism(rng), None)
    )
    if driver is not None and rng.random() < 0.5:
        mechanism = _near_jamming(mechanism, driver, 1 - 10 ** rng.uniform(-8, -1))
    return Case(_maybe_far(rng, mechanism), driver)


def draw_on_round_face(rng: np.random.Generator) -> Case:
    """Draw one or two levers that press blocks on a drum that has rotated from the drawing."""
    axle, radius = mechanisms.random_point(rng), rng.uniform(0.1, 0.5)
    joints: list[planar.Joint] = [
        planar.Pin("axle", "drum", "ground", axle, radius=0.1 * radius, friction=rng.choice([0.0, 0.2]))
    ]
    loads: list[planar.Load] = [planar.Moment("torque", "drum")]
    levers = [f"lever {k}" for k in range(rng.integers(1, 3))]
    for lever in levers:
        out = np.exp(2j * np.pi * rng.random())
        block = complex(*axle) + radius * out
        fulcrum = block + out * rng.uniform(-0.1, 0.3) + 1j * out * rng.uniform(0.2, 1) * rng.choice([-1, 1])
        at, pivot = (block.real, block.imag), (fulcrum.real, fulcrum.imag)
        joints += [
            planar.Pin(f"fulcrum of {lever}", lever, "ground", pivot),
            planar.Contact(
                f"block of {lever}", lever, "drum", at, centre=axle, friction=rng.uniform(0.1, 0.6)
            ),
        ]
        loads.append(mechanisms.random_load(rng, "Force", f"hand of {lever}", [lever], rng.uniform(1, 2)))
    mechanism = planar.Mechanism(("drum", *levers), tuple(joints), tuple(loads))
    if rng.random() < 0.5:
        mechanism = _near_jamming(mechanism, "torque", 1 - 10 ** rng.uniform(-8, -1))
    return Case(_maybe_far(rng, mechanism), "torque", rng.uniform(-3, 3))


def _maybe_far(rng: np.random.Generator, mechanism: planar.Mechanism) -> planar.Mechanism:
    """Return the mechanism, in one of three cases rotated and shifted by up to 10 km."""
    if rng.random() >= 0.3:
        return mechanism
    away = 10 ** rng.uniform(0, np.log10(_FAR)) * np.exp(2j * np.pi * rng.random())
    return transform(mechanism, shift=away, angle=rng.uniform(0, 6))


def _near_jamming(mechanism: planar.Mechanism, driver: str, part: float) -> planar.Mechanism:
    """Return the mechanism with friction slightly below jamming, if 20 times its friction jams it."""
    low, high = 1.0, 20.0
    if _jams(mechanism, driver) or not _jams(_with_friction(mechanism, high), driver):
        return mechanism
    while high - low > 1e-12 * low:
        middle = (low + high) / 2
        low, high = (low, middle) if _jams(_with_friction(mechanism, middle), driver) else (middle, high)
    return _with_friction(mechanism, max(1.0, part * low))


def _jams(mechanism: planar.Mechanism, driver: str) -> bool:
    return bool(np.isnan(planar.solve_with_friction(mechanism, driver).squeeze.multiplier).any())


def _with_friction(mechanism: planar.Mechanism, factor: float) -> planar.Mechanism:
    """Return the mechanism with all coefficients of friction multiplied."""
    joints = [
        replace(joint, friction=factor * joint.friction) if getattr(joint, "friction", 0.0) else joint
        for joint in mechanism.joints
    ]
    return planar.Mechanism(mechanism.bodies, tuple(joints), mechanism.loads)


def errors_of(mechanism: planar.Mechanism, driver: str | None, moved: float = 0.0) -> Iterator[Errors]:
    """Yield stated and true errors of those equilibria of a mechanism that have a solution."""
    if driver is None:
        yield from _compared(planar.solve(mechanism))
        return
    position = planar.stroke(mechanism, driver, [moved]).position[0] if moved else None
    found = planar.solve_with_friction(mechanism, driver, position)
    for way in (found.without, found.squeeze, found.release):
        yield from _compared(way)


def _compared(found: planar.Equilibrium) -> Iterator[Errors]:
    mechanism = found.position.mechanism
    if not found.is_determined or of_kind(found.warnings, IN_LINE):
        return
    system = mechanism.system
    parts = {name: found.multiplier[rows] for name, rows in system.joints.items()}
    senses = {name: float(np.sign(size)) for name, size in found.friction.items() if size != 0}
    exact = exact_forces(mechanism, senses, {name: parts[name].tolist() for name in senses})
    if exact is None:
        return
    given = parts | {name: np.array([found.multiplier[row]]) for name, row in system.loads.items()}
    unit = {name: system.unit[rows] for name, rows in (system.joints | system.loads).items()}
    largest = float(np.abs(found.multiplier / system.unit).max())
    with mpmath.workdps(40):
        wrong = (
            float(abs(exact_part - mpmath.mpf(float(part)))) / float(np.ravel(size)[0])
            for name, expected in exact.items()
            for exact_part, part, size in zip(
                expected, given[name], np.broadcast_to(unit[name], len(expected)), strict=True
            )
        )
        yield Errors(float(found.error), max(wrong) / largest)


KINDS = {"mechanisms": draw, "blocks on drums that have turned": draw_on_round_face}


def measure(number: int, kind: str = "mechanisms", seed: int = SEED) -> list[Errors]:
    """Compute errors of a number of random mechanisms of a kind."""
    rng = np.random.default_rng(seed)
    return [errors for _ in range(number) for errors in errors_of(*KINDS[kind](rng))]


def rows(number: int) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and the over-estimate."""
    for kind in KINDS:
        stated, true = np.array(measure(number, kind)).T
        over = stated / np.maximum(true, _LEAST)
        yield (
            f"{number} {kind}, {len(stated)} equilibria: stated errors that cover",
            f"{(over >= 1).mean():.2%}",
            "99.9 %",
        )
        yield "... true over stated: largest", f"{(1 / over).max():.2g}", ""
        yield "... stated over true: median", f"{np.median(over):.3g}", "100"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mechanisms", type=int, default=1000)
    number = parser.parse_args().mechanisms
    show("Stated errors of mechanisms against 40 digits", lambda: rows(number))


if __name__ == "__main__":
    main()
