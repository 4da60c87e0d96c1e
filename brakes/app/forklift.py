"""The forklift paper's three screens: vehicle, kinematics, internal forces, each handing on to the next."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.app.screens import Document, Handle, Screen, Slider, Sweeps
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
from brakes.config.sweeps import InputSweep, chosen, parse_axis, replaced, sweep
from brakes.drawings.duo_servo import duo_servo, free_bodies
from brakes.drawings.forklift import truck


@dataclass(frozen=True)
class Both:
    """A stage's answer by the model of the design, and by both models under their names."""

    chosen: ForkliftAnswer
    models: dict[str, ForkliftAnswer]


def solve(stage: StageName, tables: Mapping[str, Any]) -> Both:
    """The answer of one stage; it follows from the tables given alone."""
    design = forklift_from_dict(tables)
    stages = ("kinematics", stage) if stage == "forces" and design.brake is not None else (stage,)
    models = {name: design.solve(stages, name).followed() for name in _models(stage, design)}
    own = design.stop.model if design.stop is not None else "corrected"
    return Both(models.get(own, next(iter(models.values()))), models)


def _models(stage: StageName, design: ForkliftInput) -> tuple[Any, ...]:
    """Both models where they differ: where the vehicle has its say."""
    of_stop = design.forces is not None and design.forces.torque is None and "vehicle" in design.stages
    return ("corrected", "as_printed") if stage == "vehicle" or of_stop else ("corrected",)


def notes(found: Both) -> Sequence[str]:
    """Warnings and refusals of the design's own model."""
    return (*found.chosen.refusals, *found.chosen.warnings)


def rows(stage: StageName, found: Both) -> Iterable[Sequence[object]]:
    """Rows of the CSV file."""
    names = found.models if len(found.models) > 1 else {"value": found.chosen}
    return outputs_csv(forklift_outputs((stage,)), **names)


# What each shows ----------------------------------------------------------------------------------------


def vehicle_report(found: Both) -> Sequence[RenderableType]:
    """The stop by both models."""
    return [vehicle_table([answer.stop for answer in found.models.values() if answer.stop is not None])]


def kinematics_report(found: Both) -> Sequence[RenderableType]:
    """The shoes' motion and its events."""
    motion, followed = found.chosen.motion, found.chosen.kinematics
    assert motion is not None and followed is not None
    return [kinematics_tables(motion, followed)]


def forces_report(found: Both) -> Sequence[RenderableType]:
    """The forces, by both models where the torque is that of the stop."""
    return [forces_table([*found.models.values()], [name.replace("_", " ") for name in found.models])]


def draw_vehicle(found: Both, _: float = 0.0) -> Figure:
    """The truck on its slope."""
    figure = Figure(figsize=(9.0, 4.6), layout="constrained")
    assert found.chosen.stop is not None
    truck(figure.subplots(), found.chosen.stop)
    return figure


def draw_kinematics(found: Both, progress: float = 0.0) -> Figure:
    """The brake at a place of its two stages, from 0 to 2."""
    motion = found.chosen.motion
    assert motion is not None
    figure = Figure(figsize=(7.0, 6.2), layout="constrained")
    ax = duo_servo(figure.subplots(), motion.geometry, motion, progress)
    ax.set_title(_place(found.chosen, progress), fontsize=11)
    return figure


def _place(answer: ForkliftAnswer, progress: float) -> str:
    motion = answer.motion
    assert motion is not None
    seated, turned = min(progress, 1.0), max(progress - 1.0, 0.0)
    shoes = np.degrees(seated * float(motion.seating_turn))
    return f"shoes turned {shoes:.3g} deg, drum turned {np.degrees(turned * float(motion.drum_turn)):.3g} deg"


def draw_forces(found: Both, _: float = 0.0) -> Figure:
    """Both shoes as free bodies; of a brake without equilibrium the reason."""
    forces = found.chosen.forces
    assert forces is not None
    figure = Figure(figsize=(10.0, 5.4), layout="constrained")
    if forces.status == "equilibrium":
        free_bodies(figure, forces, found.chosen.kinematics)
    else:
        figure.text(0.5, 0.5, forces.message, ha="center", va="center", wrap=True)
    return figure


def vehicle_handles(found: Both, _: float) -> Sequence[Handle]:
    """Points of the truck."""
    assert found.chosen.stop is not None
    return of_truck(found.chosen.stop)


def kinematics_handles(found: Both, progress: float) -> Sequence[Handle]:
    """Points of the brake."""
    assert found.chosen.motion is not None
    return of_duo_servo(found.chosen.motion, progress)


# Sweeps -------------------------------------------------------------------------------------------------


def run_sweep(stage: StageName, tables: Mapping[str, Any], text: str, results: str) -> InputSweep:
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
    sweeps=_sweeps("forces", "forces.piston_force=9:13:17 kN", "A,B,Q,P_L"),
)
FORKLIFT = Document(
    "forklift",
    base("forklift"),
    lambda _: describe(ForkliftInput),
    parse_forklift,
    (VEHICLE, KINEMATICS, FORCES),
)
