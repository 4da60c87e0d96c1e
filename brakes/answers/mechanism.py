"""Planar mechanisms of bodies, joints and loads: what is shown of them, as drawn and over a stroke."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import pi
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.tables import table
from beamdyn.common.results import plain
from brakes.answers.planar import (
    PlanarAnswer,
    describe_statics,
    format_force,
    joint_outputs,
    name_output,
    reactions_table,
    select_rows,
    units_of,
)
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput
from brakes.drawings.mechanism import draw_open_and_closed
from brakes.drawings.mechanism_stroke import plot_curves
from brakes.planar import Equilibrium, Load, Mechanism, Stroke, assemble, solve, stroke

_SCALES = {"mm": 1e-3, "deg": pi / 180}


def mechanism_outputs(mechanism: Mechanism) -> tuple[Output, ...]:
    """Each load and its travel at the end of the stroke, and the largest force of each joint."""
    loads = (output for load in mechanism.loads for output in _load_outputs(load))
    return (*loads, *joint_outputs(mechanism, lambda answer: answer.last.magnitudes))


def _load_outputs(load: Load) -> tuple[Output, Output]:
    name, key = load.name, name_output(load.name)
    _, travel, size = units_of(load)
    return (
        Output(
            key,
            f"{name} at the end of the stroke",
            lambda answer: np.ravel(answer.last.amplitudes[name])[-1],
            size,
        ),
        Output(
            f"{key}_travel",
            f"travel of {name}",
            lambda answer: answer.motion.travel[name][-1] if answer.motion else np.nan,
            travel,
            _SCALES[travel],
        ),
    )


@dataclass(frozen=True)
class MechanismAnswer(PlanarAnswer):
    """Equilibrium of a mechanism as drawn, and over the stroke of a driver where one is named.

    Attributes
    ----------
    over : Equilibrium, optional
        Equilibrium at each position of the stroke.
    """

    over: Equilibrium | None

    @classmethod
    def of(cls, mechanism: Mechanism, design: CaliperInput | MechanismInput) -> MechanismAnswer:
        """Assemble the mechanism and solve for its forces; see `brakes.planar.assemble` and `stroke`."""
        drawn, run = solve(mechanism, assemble(mechanism)), design.run
        if run.driver is None or run.travel is None:
            return cls(design, drawn, None, None)
        motion = stroke(mechanism, run.driver, np.linspace(0.0, run.travel, run.points))
        return cls(design, drawn, motion, solve(mechanism, motion.position))

    @property
    def last(self) -> Equilibrium:
        """Equilibrium over the stroke, or as drawn."""
        return self.over or self.equilibrium

    @property
    def status(self) -> str:
        """Whether statics determines the forces."""
        return self.last.status

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return self.last.message

    @property
    def warnings(self) -> Sequence[str]:
        """Warnings of statics, and toggle positions."""
        toggles = [toggle.message for toggle in self.motion.toggles] if self.motion else []
        return (*self.last.warnings, *toggles)

    def tables(self) -> list[RenderableType]:
        """Forces as drawn, the stroke, and the diagnosis."""
        strokes = [self._stroke_table(self.motion)] if self.motion else []
        return [
            reactions_table(self.equilibrium, f"{self.design.title}: forces as drawn"),
            *strokes,
            describe_statics(self.equilibrium, self.message, float(np.max(self.last.virtual_work))),
        ]

    def _stroke_table(self, motion: Stroke) -> RenderableType:
        columns = self._columns()
        rows = [[format_force(v[k], 6) for v in columns.values()] for k in select_rows(len(motion.values))]
        return table(f"Stroke of {motion.driver}", [*columns], rows)

    def _columns(self) -> dict[str, np.ndarray]:
        """Travels and sizes of the loads over the stroke, by name and unit."""
        if self.motion is None or self.over is None:
            return {}
        units = {load.name: units_of(load) for load in self.equilibrium.position.mechanism.loads}
        travels = {
            f"{name} [{units[name][1]}]": units[name][0] * values
            for name, values in self.motion.travel.items()
        }
        return travels | {f"{name} [{units[name][2]}]": size for name, size in self.over.amplitudes.items()}

    def rows(self) -> Iterator[Sequence[object]]:
        """The stroke, or the reactions as drawn."""
        if self.motion is not None:
            columns = self._columns()
            yield [*columns]
            yield from np.stack([*columns.values()], axis=1).tolist()
            return
        yield "joint", "x_N", "y_N", "magnitude"
        for name, size in self.equilibrium.magnitudes.items():
            yield name, *np.ravel(self.equilibrium.reactions.get(name, (np.nan, np.nan))), float(size)

    def to_dict(self) -> dict[str, Any]:
        """The answer as plain numbers, lists and strings."""
        e = self.equilibrium
        keys = ("status", "message", "mobility", "indeterminacy", "loose", "undetermined", "warnings")
        forces = ("reactions", "magnitudes", "amplitudes")
        values = {key: plain(getattr(e, key)) for key in (*keys, *forces)}
        return {"title": self.design.title} | values | {"stroke": plain(self._columns())}

    def figure(self, place: float | None = None) -> Figure:
        """The mechanism as drawn and at a part of its stroke, from 0 to 1, and what the loads do over it."""
        part = 1.0 if place is None else place
        width = 12.0 if self.motion else 7.5
        figure = Figure(figsize=(width, 6))  # laid out by hand: a layout engine takes twice as long
        axes = figure.subplots(1, 2 if self.motion else 1, squeeze=False)[0]
        figure.subplots_adjust(0.8 / width, 0.1, 1 - 0.2 / width, 0.93, wspace=0.2)
        draw_open_and_closed(self.equilibrium.position, self._equilibrium_at(part), axes[0])
        axes[0].set_title(self.design.title)
        if self.motion is not None and self.over is not None:
            forces = dict(self.over.amplitudes)
            factor, unit, size = units_of(self.equilibrium.position.mechanism.load(self.motion.driver))
            label = f"travel of {self.motion.driver} [{unit}]"
            plot_curves(factor * self.motion.values, forces, axes[1], label, f"load [{size}]")
            travel = self.motion.values[_index(self.motion, part)]
            axes[1].axvline(factor * travel, color="0.4", linewidth=1, linestyle=":")
        return figure

    def _equilibrium_at(self, part: float) -> Equilibrium:
        if self.motion is None:
            return self.equilibrium
        position = self.motion.position[_index(self.motion, part)]
        return solve(position.mechanism, position)


def _index(motion: Stroke, part: float) -> int:
    """The position at a part of a stroke."""
    return round(part * (len(motion.values) - 1))
