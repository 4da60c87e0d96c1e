"""Accuracy and speed of the brakes.  Run: python -m benchmarks.brakes

Prints every figure that the README quotes of them, each beside its bound.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import perf_counter

import numpy as np

from benchmarks.beam_core import Row, best_time, show
from benchmarks.cases import mechanisms
from brakes import calipers, forklift
from brakes.forklift import Levers, Truck, internal_forces
from brakes.planar import solve, stroke

MECHANISMS, LEVERS, TRUCKS = 10_000, 100_000, 10_000


def planar() -> Iterator[Row]:
    """Random mechanisms by virtual work, and a stroke of the eeBrake with all reactions."""
    (all_motions, free), moved = mechanisms.worst_virtual_work(MECHANISMS)
    yield f"virtual work of {MECHANISMS} random mechanisms, scaled: largest", f"{all_motions:.1e}", "1e-9"
    yield "... by their free motions alone", f"{free:.1e}", "1e-9"
    yield "... of them solved away from the drawing as well", str(moved), ""
    time = best_time(lambda: strokes(100), 15)
    yield "stroke of the eeBrake, 100 positions with all reactions [ms]", f"{1e3 * time:.1f}", "50"
    caliper = calipers.EeBrake().build()
    time = best_time(lambda: caliper.stroke(3.5e-3, points=100), 15)
    yield "the same by `brakes.calipers`, with pad forces and advantage [ms]", f"{1e3 * time:.1f}", "50"


def strokes(points: int) -> None:
    """The cable of the eeBrake pulled by 3.5 mm."""
    brake = mechanisms.eebrake()
    solve(brake, stroke(brake, "cable", np.linspace(0, 3.5e-3, points)).position)


def duo_servo() -> Iterator[Row]:
    """Random duo-servo brakes and designs."""
    rng = np.random.default_rng(19970101)
    found = internal_forces(
        levers_of(rng), torque=10 ** rng.uniform(0, 6, LEVERS), piston_force=10 ** rng.uniform(0, 6, LEVERS)
    )
    solved = found.status == "equilibrium"
    forces = np.array([found.A, found.B, found.C, found.D, found.Q, found.P_L])[:, solved]
    yield f"{LEVERS} random duo-servo brakes: all forces positive", f"{(forces > 0).all(axis=0).sum()}", ""
    yield "... or refused with a reason", f"{(~solved).sum()}", ""
    yield "... largest residual, scaled", f"{found.residual[solved].max():.1e}", "1e-9"
    start = perf_counter()
    trucks()
    yield f"{TRUCKS} designs through vehicle, kinematics and forces [s]", f"{perf_counter() - start:.2f}", "2"


def levers_of(rng: np.random.Generator) -> Levers:
    """Arms to the drum's radius, angles that together reach a right angle."""
    r = rng.uniform(0.05, 0.4, LEVERS)
    a1, a2, b = (r * rng.uniform(0.02, 0.99, LEVERS) for _ in range(3))
    return Levers(r, a1, a2, b, b, *rng.uniform(-np.pi / 4, np.pi / 4, (3, LEVERS)))


def trucks() -> forklift.Procedure:
    """Random trucks through all three stages."""
    rng = np.random.default_rng(10_000)

    def between(low: float, high: float) -> np.ndarray:
        return rng.uniform(low, high, TRUCKS)

    truck = Truck(
        empty_mass=between(5000, 6500),
        empty_cg=(between(1.0, 1.1), between(0.3, 0.5)),
        load_mass=between(0, 3500),
        load_cg=(-1.20, 0.450),
        front_wheel_radius=between(0.35, 0.45),
        wheelbase=1.89,
    )
    conditions = forklift.StopConditions(
        slope=between(0, 0.3),
        speed=between(2, 7),
        friction=between(0.5, 0.8),
        reaction_time=0.5,
        rise_time=0.3,
    )
    piston_force, motion = between(1e4, 1.3e4), forklift.BENDIX_12_5.move_shoes(between(0.005, 0.021))
    return forklift.brake_procedure(truck, conditions, motion, piston_force=piston_force)


PARTS = planar, duo_servo


def main() -> None:
    show("brakes", *PARTS)


if __name__ == "__main__":
    main()
