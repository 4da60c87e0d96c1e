"""The forklift paper's three screens: vehicle, kinematics, internal forces, each handing on to the next."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.app.documents import Document, Handle, Screen, Slider, Sweeps
from beamdyn.common.edge.inputs import describe
from brakes.answers.tables import (
    forces_table,
    forklift_outputs,
    kinematics_tables,
    outputs_csv,
    vehicle_table,
)
from brakes.app.bases import base
from brakes.app.handles import of_duo_servo, of_truck
from brakes.config.forklift import (
    ForkliftAnswer,
    ForkliftInput,
    StageName,
    forklift_from_dict,
    parse_forklift,
)
from brakes.config.sweeps import Sweep, chosen, parse_axis, replaced, sweep
from brakes.drawings.duo_servo import duo_servo, free_bodies
from brakes.drawings.forklift import truck
from brakes.reproduce.forklift import compare
from brakes.reproduce.forklift_as_printed import answer_as_printed


@dataclass(frozen=True)
class Both:
    """A stage's answer, and the same with the paper's stop where that has a part in it."""

    corrected: ForkliftAnswer
    as_printed: ForkliftAnswer | None


def solve(stage: StageName, tables: Mapping[str, Any]) -> Both:
    """The answer of one stage; it follows from the tables given alone."""
    design = forklift_from_dict(tables)
    stages = ("kinematics", stage) if stage == "forces" and design.brake is not None else (stage,)
    return Both(design.solve(stages).followed(), answer_as_printed(design, stages))


def notes(found: Both) -> Sequence[str]:
    """Warnings and refusals."""
    return (*found.corrected.refusals, *found.corrected.warnings)


def rows(stage: StageName, found: Both) -> Iterable[Sequence[object]]:
    """Rows of the CSV file."""
    return outputs_csv(forklift_outputs((stage,)), value=found.corrected)


def draw_as_printed(stage: StageName, found: Both) -> Figure:
    """Results of the stage beside those that follow from the paper's stop."""
    return compare(forklift_outputs((stage,)), found.corrected, found.as_printed or found.corrected)


# What each shows ----------------------------------------------------------------------------------------


def vehicle_report(found: Both) -> Sequence[RenderableType]:
    """The stop."""
    assert found.corrected.stop is not None
    return [vehicle_table(found.corrected.stop)]


def kinematics_report(found: Both) -> Sequence[RenderableType]:
    """The shoes' motion and its events."""
    motion, followed = found.corrected.motion, found.corrected.kinematics
    assert motion is not None and followed is not None
    return [kinematics_tables(motion, followed)]


def forces_report(found: Both) -> Sequence[RenderableType]:
    """The forces in one brake."""
    assert found.corrected.forces is not None
    return [forces_table(found.corrected.forces, found.corrected.torque_from)]


def draw_vehicle(found: Both, _: float = 0.0) -> Figure:
    """The truck on its slope."""
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    assert found.corrected.stop is not None
    truck(figure.subplots(), found.corrected.stop)
    return figure


def draw_kinematics(found: Both, progress: float = 0.0) -> Figure:
    """The brake at a place of its two stages, from 0 to 2."""
    motion = found.corrected.motion
    assert motion is not None
    figure = Figure(figsize=(7.0, 6.2), layout="constrained")
    ax = duo_servo(figure.subplots(), motion.geometry, motion, progress)
    ax.set_title(_place(found.corrected, progress), fontsize=11)
    return figure


def _place(answer: ForkliftAnswer, progress: float) -> str:
    motion = answer.motion
    assert motion is not None
    seated, turned = min(progress, 1.0), max(progress - 1.0, 0.0)
    shoes = np.degrees(seated * float(motion.seating_turn))
    return f"shoes turned {shoes:.3g} deg, drum turned {np.degrees(turned * float(motion.drum_turn)):.3g} deg"


def draw_forces(found: Both, _: float = 0.0) -> Figure:
    """Both shoes as free bodies; of a brake without equilibrium the reason."""
    forces = found.corrected.forces
    assert forces is not None
    figure = Figure(figsize=(10.0, 5.4), layout="constrained")
    if forces.status == "equilibrium":
        free_bodies(figure, forces, found.corrected.kinematics)
    else:
        figure.text(0.5, 0.5, forces.message, ha="center", va="center", wrap=True)
    return figure


def vehicle_handles(found: Both, _: float) -> Sequence[Handle]:
    """Points of the truck."""
    assert found.corrected.stop is not None
    return of_truck(found.corrected.stop)


def kinematics_handles(found: Both, progress: float) -> Sequence[Handle]:
    """Points of the brake."""
    assert found.corrected.motion is not None
    return of_duo_servo(found.corrected.motion, progress)


# Sweeps -------------------------------------------------------------------------------------------------


def run_sweep(stage: StageName, tables: Mapping[str, Any], text: str, results: str) -> Sweep:
    """A sweep of one input."""
    design = forklift_from_dict(tables)
    axes = [parse_axis(design, text, "sweep")]
    wanted = chosen(forklift_outputs((stage,)), results, "results")
    return sweep(axes, wanted, replaced(design, axes).solve((stage,)))


def _sweeps(stage: StageName, example: str, results: str) -> Sweeps:
    names = [output.name for output in forklift_outputs((stage,))]
    return Sweeps(lambda _: names, example, results, partial(run_sweep, stage))


VEHICLE = Screen(
    "Vehicle",
    "The truck reverses down a slope and brakes: stopping distance, and the torque of each brake.",
    ("truck", "stop"),
    ("truck", "stop"),
    partial(solve, "vehicle"),
    vehicle_report,
    draw_vehicle,
    notes,
    partial(rows, "vehicle"),
    more=(("As the paper prints", partial(draw_as_printed, "vehicle")),),
    handles=vehicle_handles,
    sweeps=_sweeps("vehicle", "stop.speed=10:30:21 km/h", "distance"),
)
KINEMATICS = Screen(
    "Kinematics",
    "The shoes of a duo-servo brake: they turn onto the drum, then turn with it until a piston bottoms.",
    ("brake",),
    ("brake",),
    partial(solve, "kinematics"),
    kinematics_report,
    draw_kinematics,
    notes,
    partial(rows, "kinematics"),
    handles=kinematics_handles,
    slider=Slider("stage", ("at rest", "linings on the drum", "piston at its bottom")),
    sweeps=_sweeps("kinematics", "brake.clearance=8:11:16 mm", "drum_turn,left_travel"),
)
FORCES = Screen(
    "Internal forces",
    "The force on every part of the brake, from the torque of the stop and the arms of the kinematics.",
    ("forces", "levers"),
    ("truck", "stop", "brake", "levers", "forces"),
    partial(solve, "forces"),
    forces_report,
    draw_forces,
    notes,
    partial(rows, "forces"),
    more=(("As the paper prints", partial(draw_as_printed, "forces")),),
    sweeps=_sweeps("forces", "forces.piston_force=9:13:17 kN", "A,B,Q,P_L"),
)
FORKLIFT = Document(
    "forklift",
    base("forklift"),
    lambda _: describe(ForkliftInput),
    parse_forklift,
    (VEHICLE, KINEMATICS, FORCES),
)
