"""Test whether verdicts on mechanisms depend on rounding.

Run: python -m benchmarks.invariant_verdicts [--mechanisms N].

Random mechanisms of mobility 1 with friction are rotated, shifted, scaled to other units and perturbed.  Half
of them have their points on a grid, so that loads are collinear, do no work or are zero.  Their toggle
positions, verdicts on friction and kinds of warnings must not change.
"""

from __future__ import annotations

import argparse
import re
from collections.abc import Callable, Iterator
from dataclasses import fields, replace
from typing import Any

import numpy as np

from benchmarks.cases import mechanisms
from benchmarks.rows import Row, show
from brakes import planar

SEED = 29
_GRID = 0.25  # width of the grid [m]
_TRAVEL = 0.2  # distance along the curve of positions [m]
_POINTS = ("at", "to", "at_other", "on", "centre")
_DIRECTIONS = ("direction", "normal", "along")
_NUMBERS = ("radius", "length", "free_length", "stiffness", "magnitude")

Transform = Callable[[planar.Mechanism], planar.Mechanism]


def transform(
    mechanism: planar.Mechanism,
    scale: float = 1.0,
    angle: float = 0.0,
    shift: complex = 0j,
    noise: float = 0.0,
) -> planar.Mechanism:
    """Return the mechanism in another unit of length, turned, shifted, with perturbed points."""
    rng, turn = np.random.default_rng(SEED), np.exp(1j * angle)

    def perturbed(z: complex) -> complex:
        return z + noise * complex(*rng.uniform(-1, 1, 2))

    def placed(p: Any) -> tuple[float, float]:
        z = perturbed(complex(*p)) * scale * turn + shift
        return z.real, z.imag

    def turned(p: Any) -> tuple[float, float]:
        z = perturbed(complex(*p)) * turn
        return z.real, z.imag

    def moved(part: Any) -> Any:
        changes = {}
        for name in (field.name for field in fields(part)):
            value = getattr(part, name)
            if value is not None and name in _POINTS:
                changes[name] = placed(value)
            elif name == "points" and value is not None:
                changes[name] = tuple(map(placed, value))
            elif value is not None and name in _DIRECTIONS:
                changes[name] = turned(value)
            elif value is not None and name in _NUMBERS:
                changes[name] = value * scale ** _power(part, name)
        return replace(part, **changes)

    joints, loads = (tuple(map(moved, parts)) for parts in (mechanism.joints, mechanism.loads))
    return planar.Mechanism(mechanism.bodies, joints, loads)


def _power(part: Any, name: str) -> int:
    """Return the exponent of length in the unit of a joint's or load's number, for unchanged forces."""
    if isinstance(part, planar.Moment | planar.TorsionSpring):
        return 1
    return {"stiffness": -1, "magnitude": 0}.get(name, 1)


TRANSFORMS: dict[str, Transform] = {
    "turned by 1 rad": lambda mechanism: transform(mechanism, angle=1.0),
    "shifted by 1 m": lambda mechanism: transform(mechanism, shift=0.6 + 0.8j),
    "shifted by 10 km": lambda mechanism: transform(mechanism, shift=6e3 + 8e3j),
    "in mm": lambda mechanism: transform(mechanism, scale=1e3),
    "in km": lambda mechanism: transform(mechanism, scale=1e-3),
    "perturbed by 1e-12": lambda mechanism: transform(mechanism, noise=1e-12),
    "perturbed by 1e-9": lambda mechanism: transform(mechanism, noise=1e-9),
}


def draw_mechanism(rng: np.random.Generator) -> tuple[planar.Mechanism, str]:
    """Draw a mechanism of mobility 1 with friction, half of them on a grid, and its driving load."""
    is_on_grid = rng.random() < 0.5
    while True:
        drawn = mechanisms.random_mechanism(rng)
        unknown = [load.name for load in drawn.loads if getattr(load, "magnitude", 0.0) is None]
        driver = next((load for load in drawn.loads if load.name in unknown and load.has_coordinate), None)
        if len(unknown) != 1 or driver is None:
            continue
        rough = tuple(_with_friction(joint, rng) for joint in drawn.joints)
        mechanism = planar.Mechanism(drawn.bodies, rough, drawn.loads)
        if not is_on_grid:
            return mechanism, driver.name
        try:
            mechanism = _on_grid(mechanism)
            planar.solve_with_friction(mechanism, driver.name)
        except ValueError:  # on the grid two points coincide, or the mechanism cannot move
            continue
        return mechanism, driver.name


def _with_friction(joint: planar.Joint, rng: np.random.Generator) -> planar.Joint:
    """Return the joint with a random coefficient of friction, if it can have one."""
    if isinstance(joint, planar.Pin):
        return replace(joint, radius=float(rng.uniform(0.01, 0.1)), friction=float(rng.uniform(0.1, 0.6)))
    if isinstance(joint, planar.Slot | planar.Contact):
        return replace(joint, friction=float(rng.uniform(0.1, 0.6)))
    return joint


def _on_grid(mechanism: planar.Mechanism) -> planar.Mechanism:
    """Round all points and directions to a grid."""

    def rounded(p: Any) -> tuple[float, float]:
        x, y = (_GRID * np.round(np.array(p) / _GRID)).tolist()
        return x, y

    def snapped(part: Any) -> Any:
        names = {field.name for field in fields(part)} & {*_POINTS, *_DIRECTIONS}
        changes: dict[str, Any] = {
            name: rounded(value) for name in names if (value := getattr(part, name)) is not None
        }
        if hasattr(part, "points"):
            changes["points"] = tuple(map(rounded, part.points))
        return replace(part, **changes)

    joints, loads = (tuple(map(snapped, parts)) for parts in (mechanism.joints, mechanism.loads))
    return planar.Mechanism(mechanism.bodies, joints, loads)


def verdicts(mechanism: planar.Mechanism, driver: str, scale: float = 1.0) -> tuple[Any, ...]:
    """Return toggle positions by load, states with friction, and kinds of warnings."""
    try:
        path = planar.trace(mechanism, driver, _TRAVEL * scale, 5)
        toggles: Any = sorted(str(toggle.load) for toggle in path.toggles)
    except ValueError as error:
        toggles = _kind(str(error))
    try:
        found = planar.solve_with_friction(mechanism, driver)
    except ValueError as error:
        return toggles, _kind(str(error))
    states = tuple(
        (way.status, way.open_or_slack, tuple(map(_kind, way.warnings)))
        for way in (found.without, found.squeeze, found.release)
    )
    return toggles, states


def _kind(sentence: str) -> str:
    """Return a sentence without its numbers and units."""
    return re.sub(r"-?\d[\d.]*(e[-+]?\d+)?", "#", sentence)


def count_changes(
    number: int, seed: int = SEED
) -> Iterator[tuple[int, str, tuple[Any, ...], tuple[Any, ...]]]:
    """Yield mechanisms with changed verdicts: number, transformation, verdicts before and after."""
    rng = np.random.default_rng(seed)
    for k in range(number):
        mechanism, driver = draw_mechanism(rng)
        before = verdicts(mechanism, driver)
        for name, changed in TRANSFORMS.items():
            scale = {"in mm": 1e3, "in km": 1e-3}.get(name, 1.0)
            after = verdicts(changed(mechanism), driver, scale)
            if after != before:
                yield k, name, before, after


def rows(number: int) -> Iterator[Row]:
    """Yield the number of mechanisms with changed verdicts, and each change."""
    changes = list(count_changes(number))
    changed = {k for k, *_ in changes}
    yield f"{number} mechanisms times {len(TRANSFORMS)} transforms: changed", str(len(changed)), "0"
    for k, name, before, after in changes:
        yield f"mechanism {k} {name}", f"{before} -> {after}", ""


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--mechanisms", type=int, default=500)
    number = parser.parse_args().mechanisms
    show("Verdicts on mechanisms that rounding does not decide", lambda: rows(number))


if __name__ == "__main__":
    main()
