"""Accuracy and speed of the brakes.  Run: python -m benchmarks.brakes

Solved are random mechanisms, duo-servo brakes and trucks, strokes of the eeBrake, designs from pedal to heat,
and inverse questions (--scenes N: number of questions; --save FILE stores them, and resumes an interrupted
run).
"""

from __future__ import annotations

import argparse
import ast
from collections.abc import Iterator
from functools import partial
from pathlib import Path
from time import perf_counter

import numpy as np

from benchmarks.cases import mechanisms
from benchmarks.cases.random_questions import Outcome, measure
from benchmarks.house import ROOT, code_lines, sources
from benchmarks.resumable import Cases, add_options
from benchmarks.rows import Row, best_time, show
from brakes import calipers, chain, forklift
from brakes.forklift import Levers, Truck, internal_forces
from brakes.planar import solve, stroke

MECHANISMS, LEVERS, TRUCKS = 10_000, 100_000, 10_000
DESIGNS, QUESTIONS, SEED = 100_000, 1000, 34
ROOMS = ("vehicle", "chain", "common", "machines")  # packages besides drums, calipers and the forklift


def check_planar() -> Iterator[Row]:
    """Check random mechanisms by virtual work, and time a stroke of the eeBrake with all reactions."""
    (all_motions, free), moved = mechanisms.worst_virtual_work(MECHANISMS)
    yield f"virtual work of {MECHANISMS} random mechanisms, scaled: largest", f"{all_motions:.1e}", "1e-9"
    yield "... by their free motions alone", f"{free:.1e}", "1e-9"
    yield "... of them solved away from the drawing as well", str(moved), ""
    time = best_time(lambda: run_strokes(100), 15)
    yield "stroke of the eeBrake, 100 positions with all reactions [ms]", f"{1e3 * time:.1f}", "50"
    caliper = calipers.EeBrake().build()
    time = best_time(lambda: caliper.stroke(3.5e-3, points=100), 15)
    yield "the same by `brakes.calipers`, with pad forces and advantage [ms]", f"{1e3 * time:.1f}", "50"


def run_strokes(points: int) -> None:
    """Solve a stroke of the eeBrake caliper: 3.5 mm of cable travel, in a number of positions."""
    brake = mechanisms.eebrake()
    solve(brake, stroke(brake, "cable", np.linspace(0, 3.5e-3, points)).position)


def check_duo_servo() -> Iterator[Row]:
    """Check the equilibrium of random duo-servo brakes, and time many designs."""
    rng = np.random.default_rng(19970101)
    answer = internal_forces(
        draw_levers(rng), torque=10 ** rng.uniform(0, 6, LEVERS), piston_force=10 ** rng.uniform(0, 6, LEVERS)
    )
    in_equilibrium = answer.status == "equilibrium"
    forces = np.array([answer.A, answer.B, answer.C, answer.D, answer.Q, answer.P_L])[:, in_equilibrium]
    yield f"{LEVERS} random duo-servo brakes: all forces positive", f"{(forces > 0).all(axis=0).sum()}", ""
    yield "... or refused with a reason", f"{(~in_equilibrium).sum()}", ""
    yield "... largest residual, scaled", f"{answer.residual[in_equilibrium].max():.1e}", "1e-9"
    start = perf_counter()
    run_trucks()
    yield f"{TRUCKS} designs through vehicle, kinematics and forces [s]", f"{perf_counter() - start:.2f}", "2"


def draw_levers(rng: np.random.Generator) -> Levers:
    """Draw random levers: arms up to the drum's radius, angles up to 45 deg."""
    r = rng.uniform(0.05, 0.4, LEVERS)
    a1, a2, b = (r * rng.uniform(0.02, 0.99, LEVERS) for _ in range(3))
    return Levers(r, a1, a2, b, b, *rng.uniform(-np.pi / 4, np.pi / 4, (3, LEVERS)))


def run_trucks() -> forklift.Procedure:
    """Solve random trucks in all three stages: stop, motion of the shoes, and forces."""
    rng = np.random.default_rng(10_000)
    truck, conditions = draw_stops(rng, TRUCKS)
    motion = forklift.BENDIX_12_5.move_shoes(rng.uniform(0.005, 0.021, TRUCKS))
    return forklift.brake_procedure(truck, conditions, motion, piston_force=rng.uniform(1e4, 1.3e4, TRUCKS))


def run_chain() -> chain.Heat:
    """Solve random trucks from the pedal's force through brakes and stop to the heat of the drums."""
    rng = np.random.default_rng(34)
    truck, conditions = draw_stops(rng, DESIGNS)
    motion = forklift.BENDIX_12_5.move_shoes(rng.uniform(0.005, 0.021, DESIGNS))
    unit = internal_forces(motion, piston_force=1.0, friction=rng.uniform(0.2, 0.4, DESIGNS))
    pedal = chain.Pedal(rng.uniform(4, 6, DESIGNS), rng.uniform(200, 450, DESIGNS), booster=3.0)
    line = chain.HydraulicLine(rng.uniform(0.02, 0.024, DESIGNS), rng.uniform(0.03, 0.035, DESIGNS))
    braked = chain.brake_from_pedal(truck, conditions, pedal, line, unit.torque)
    pressed = (unit.A + unit.C) * braked.stop.torque_per_brake / unit.torque
    return chain.heat_of_stop(braked.stop, chain.Drums(18.0, 0.05), pressed, unit.levers.drum_radius)


def draw_stops(rng: np.random.Generator, count: int) -> tuple[Truck, forklift.StopConditions]:
    """Draw random trucks, and the conditions of their stops."""

    def between(low: float, high: float) -> np.ndarray:
        return rng.uniform(low, high, count)

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
    return truck, conditions


def check_backwards(given: argparse.Namespace | None = None) -> Iterator[Row]:
    """Solve random brakes and vehicles, then solve inverse questions: one input from one result."""
    seed = given.seed if given else SEED
    cases = Cases(partial(measure, seed=seed), Outcome)
    asked = cases.run(given) if given else cases.measure_all(range(QUESTIONS))
    worst = max(each.residual for each in asked)
    yield (
        f"{len(asked)} random vehicles and brakes backwards: largest relative residual",
        f"{worst:.1e}",
        "1e-10",
    )
    yield (
        "... the known input from the nearest found, relative",
        f"{max(q.distance for q in asked):.1e}",
        "1e-10",
    )
    several = sum(each.answers > 1 for each in asked)
    yield "... questions with more than one answer", str(several), ""


def check_chain() -> Iterator[Row]:
    """Check designs from pedal to heat against designs solved by the forklift's three stages."""
    whole, stages = best_time(run_chain, 5) / DESIGNS, best_time(run_trucks) / TRUCKS
    name = f"{DESIGNS} designs from pedal to heat: time of one over that of {TRUCKS} through three stages"
    yield name, f"{whole / stages:.2f}", "1"


def check_size() -> Iterator[Row]:
    """Count the files for one type of brake, and the lines of code."""
    modules = [path for path in sources() if path.is_relative_to(ROOT / "brakes")]
    named = [path for path in modules if names_it(path, "band")]
    files = len(named) + len([*(ROOT / "examples").glob("band.toml")])
    yield "files that name the band brake, without tests and pages", f"{files}", "6"
    rooms = [path for path in modules if path.relative_to(ROOT / "brakes").parts[0] in ROOMS]
    yield "code lines of brakes", f"{sum(map(code_lines, modules))}", ""
    yield f"... of them in {', '.join(ROOMS)}", f"{sum(map(code_lines, rooms))}", ""


def names_it(path: Path, name: str) -> bool:
    """Return whether a module is named after a brake, imports its class, or contains its name as a word."""
    nodes = [*ast.walk(ast.parse(path.read_text(encoding="utf-8")))]
    words = {node.value for node in nodes if isinstance(node, ast.Constant) and isinstance(node.value, str)}
    imported = {each.name for node in nodes if isinstance(node, ast.ImportFrom) for each in node.names}
    return path.stem == name or name in words or name.title() in imported


PARTS = check_planar, check_duo_servo, check_chain, check_size, check_backwards


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__)
    add_options(parser, QUESTIONS, SEED)
    show("brakes", *PARTS[:-1], partial(check_backwards, parser.parse_args()))


if __name__ == "__main__":
    main()
