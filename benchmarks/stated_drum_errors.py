"""Test whether the stated errors of drum brakes, duo-servo brakes and stops cover the true errors.

Run: python -m benchmarks.stated_drum_errors [--drums N].  Random brakes down to a margin of 1e-12 to
self-locking, and trucks in both directions on slopes down to 1e-9 from the steepest on which they stop, are
compared with closed forms in 40 digits.
"""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterator, Mapping
from typing import Any, NamedTuple

import mpmath
import numpy as np
from mpmath import mpf

from benchmarks.cases import drum_digits as digits
from benchmarks.rows import Row, show
from brakes import drum, forklift

SEED = 12
LEAST_MARGIN = 1.001e-12
LEAST_MARGIN_OF_STOPS = 1.1e-9
_LEAST = 1e-17  # least true error, because double precision is no more accurate


class Errors(NamedTuple):
    """Stated and true relative error of an answer."""

    stated: float
    true: float


def _margin(rng: np.random.Generator, least: float = LEAST_MARGIN) -> float:
    return 10 ** rng.uniform(np.log10(least), -0.05)


def _compared(found: object, exact: Mapping[str, Any], scale: mpf | None = None) -> Errors:
    """Compare numbers with exact ones; return the largest relative error (vectors: over a scale)."""
    true = max(_relative(getattr(found, name), value, scale) for name, value in exact.items())
    return Errors(float(getattr(found, "error")), max(float(true), _LEAST))  # noqa: B009


def _relative(found: Any, exact: Any, scale: mpf | None) -> mpf:
    if np.ndim(found):
        return abs(mpmath.mpc(*map(float, found)) - exact) / (scale or abs(exact))
    return abs(mpf(float(found)) - exact) / abs(exact)


def draw_shoe(rng: np.random.Generator) -> drum.Shoe:
    """Draw a shoe of any size, with a lining of any length."""
    while True:
        r = 10 ** rng.uniform(-3, 1)
        start, end = np.sort(rng.uniform(-0.2, 3.2, 2))
        if rng.random() < 0.2:
            end = start + 10 ** rng.uniform(-2, -1)
        pivot = r * rng.uniform(-0.5, 0.9), -r * rng.uniform(0.05, 1.1)
        zero = "axis" if rng.random() < 0.3 else "pivot"
        try:
            return drum.Shoe(r, r * rng.uniform(0.1, 1), (start, end), pivot, r * rng.uniform(-0.04, 1), zero)
        except ValueError:  # a lining that covers the pin raises an error
            continue


def errors_of_shoe(rng: np.random.Generator) -> Errors:
    """Compute stated and true errors of a leading or trailing shoe, near self-locking if it can lock."""
    shoe, leading, force = draw_shoe(rng), bool(rng.random() < 0.8), 10 ** rng.uniform(-3, 6)
    limit = digits.locking_friction_of_shoe(shoe, leading)
    mu = float(limit * (1 - mpf(_margin(rng)))) if limit else rng.uniform(0.05, 1)
    found = drum.shoe_torque(shoe, friction=mu, force=force, leading=leading)
    exact = digits.forces_on_shoe(shoe, mu, force, leading)
    largest = max(mpf(force), *(abs(exact[name]) for name in ("normal", "tangential", "pin_reaction")))
    return _compared(found, exact, largest)


def draw_duo_servo(rng: np.random.Generator) -> tuple[forklift.DuoServo, float]:
    """Draw a duo-servo brake, and a clearance that it allows."""
    while True:
        r = 10 ** rng.uniform(-3, 1)
        brake = forklift.DuoServo(
            r,
            tip=(r * rng.uniform(0.1, 0.6), r * rng.uniform(0.3, 0.7)),
            adjuster=(r * rng.uniform(0.1, 0.5), -r * rng.uniform(0.2, 0.8)),
            face_tilt=rng.uniform(-0.3, 0.7),
            contact_angle=rng.uniform(0.2, 1.3),
            piston_bottom=r * 10 ** rng.uniform(-3, -1),
        )
        clearance = r * 10 ** rng.uniform(-4, -1)
        try:
            brake.find_levers(clearance)
        except ValueError:
            continue
        return brake, clearance


def draw_levers(rng: np.random.Generator) -> forklift.Levers:
    """Draw lever arms of any size."""
    r = 10 ** rng.uniform(-3, 1)
    a1, a2, b = r * rng.uniform(0.1, 1.2, 3)
    return forklift.Levers(r, a1, a2, b, b, *rng.uniform(-0.6, 0.6, 3))


def errors_of_duo_servo(rng: np.random.Generator) -> Errors:
    """Compute errors of a duo-servo brake, given by levers or geometry, and by friction or torque."""
    if rng.random() < 0.5:
        geometry, clearance = draw_duo_servo(rng)
        exact = digits.exact_levers(geometry, clearance)
    else:
        geometry, clearance = draw_levers(rng), None
        exact = digits.given_levers(geometry)
    limit, piston = digits.locking_friction(exact), 10 ** rng.uniform(-3, 6)
    mu = float(limit * (1 - mpf(_margin(rng)))) if limit else 10 ** rng.uniform(-2, 2)
    found = forklift.internal_forces(geometry, piston_force=piston, friction=mu, clearance=clearance)
    if rng.random() < 0.7:
        slope = digits.slope_at_friction(exact, piston, mu)
        return _compared(found, digits.forces_from_friction(exact, piston, mu) | slope)
    torque = float(found.torque)
    found = forklift.internal_forces(geometry, piston_force=piston, torque=torque, clearance=clearance)
    mu = digits.friction_of_torque(exact, piston, torque, mu)
    return _compared(found, digits.forces_from_friction(exact, piston, mu))


def errors_of_stop(rng: np.random.Generator) -> Errors:
    """Compute errors of a truck's stop, in either direction, on a slope that is nearly too steep."""
    size = 10 ** rng.uniform(-2, 2)
    truck = forklift.Truck(
        5950,
        (size * rng.uniform(0.5, 0.95), size * rng.uniform(-0.1, 0.4)),
        float(rng.choice([0.0, 3500.0])),
        (-size * rng.uniform(0, 0.8), size * rng.uniform(0, 0.5)),
        front_wheel_radius=0.2 * size,
        wheelbase=size,
    )
    (a, y), L = truck.cg, truck.wheelbase
    h, direction = y + truck.front_wheel_radius, "forward" if rng.random() < 0.5 else "reverse"
    mu, steepness = rng.uniform(0.3, 1), 1 - _margin(rng, LEAST_MARGIN_OF_STOPS)
    if direction == "forward":
        mu, h = min(mu, 0.99 * a / h), -h  # with friction above a / h, braking overturns the truck
    slope = steepness * np.arctan(mu * (L - a) / (L + mu * h))
    conditions = forklift.StopConditions(
        slope, rng.uniform(1, 20), mu, 0.5, rng.uniform(0, 1), direction=direction
    )
    return _compared(forklift.stop(truck, conditions), digits.exact_stop(truck, conditions))


KINDS: dict[str, Callable[[np.random.Generator], Errors]] = {
    "drums": errors_of_shoe,
    "duo-servo brakes": errors_of_duo_servo,
    "stops": errors_of_stop,
}


def measure(kind: str, number: int, seed: int = SEED) -> list[Errors]:
    """Compute errors of a number of random answers of a kind."""
    rng = np.random.default_rng(seed)
    with mpmath.workdps(digits.DIGITS):
        return [KINDS[kind](rng) for _ in range(number)]


def rows(number: int) -> Iterator[Row]:
    """Yield the fraction of true errors covered by stated errors, and the over-estimate."""
    for kind in KINDS:
        stated, true = np.array([each for each in measure(kind, number) if not np.isnan(each.stated)]).T
        over = stated / true
        yield f"{len(stated)} {kind}: stated errors that cover", f"{(over >= 1).mean():.2%}", "99.9 %"
        yield "... refused, the margin being within its error", str(number - len(stated)), ""
        yield "... largest true error", f"{true.max():.2g}", ""
        yield "... true over stated: largest", f"{(1 / over).max():.2g}", ""
        yield "... stated over true: median", f"{np.median(over):.3g}", "100"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--drums", type=int, default=1000)
    number = parser.parse_args().drums
    show("Stated errors of drum brakes against 40 digits", lambda: rows(number))


if __name__ == "__main__":
    main()
