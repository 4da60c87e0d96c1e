"""The answer of `brakes caliper` on any mechanism, and what it shares with that on a caliper."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.edge.tables import table
from beamdyn.common.results import Result, plain
from brakes.config.mechanism import CaliperInput, MechanismInput
from brakes.drawings.mechanism import animate, draw_open_and_closed, free_body_diagrams
from brakes.drawings.mechanism_parts import members
from brakes.drawings.mechanism_stroke import plot_curves
from brakes.planar import (
    Equilibrium,
    Joint,
    Load,
    Mechanism,
    Position,
    Stroke,
    assemble,
    solve,
    stroke,
)

_FRAMES = 30  # of an animation
_ROWS = 5  # of a stroke's table


@dataclass(frozen=True)
class MechanismAnswer(Result):
    """Equilibrium of a mechanism as drawn, and over the stroke of a driver where one is named."""

    title: str
    given: CaliperInput | MechanismInput
    drawn: Equilibrium
    motion: Stroke | None
    over: Equilibrium | None

    @classmethod
    def of(cls, mechanism: Mechanism, given: CaliperInput | MechanismInput) -> MechanismAnswer:
        """Solve."""
        title = given.title
        drawn = solve(mechanism, assemble(mechanism))
        asked = given.run
        if asked.driver is None or asked.travel is None:
            return cls(title, given, drawn, None, None)
        motion = stroke(mechanism, asked.driver, np.linspace(0.0, asked.travel, asked.points))
        return cls(title, given, drawn, motion, solve(mechanism, motion.position))

    @property
    def last(self) -> Equilibrium:
        """Equilibrium over the stroke, or as drawn."""
        return self.over or self.drawn

    @property
    def status(self) -> str:
        """Whether statics determines the forces."""
        return self.last.status

    @property
    def message(self) -> str:
        """The status as a sentence."""
        return self.last.message

    @property
    def warnings(self) -> tuple[str, ...]:
        """Warnings of statics, and toggle positions."""
        toggles = [toggle.message for toggle in self.motion.toggles] if self.motion else []
        return (*self.last.warnings, *toggles)

    def tables(self) -> list[RenderableType]:
        """Tables and sentences for people."""
        moved = self.motion and [table(f"Stroke of {self.motion.driver}", *self._stroke_table())]
        return [
            reactions_table(self.drawn, f"{self.title}: forces as drawn"),
            *(moved or []),
            verdict(self.drawn, self.message, float(np.max(self.last.virtual_work))),
        ]

    def _stroke_table(self) -> tuple[Sequence[str], list[list[str]]]:
        columns = self._columns()
        rows = some_rows(len(columns[0][1]))
        return [name for name, _ in columns], [[shown(values[k], 6) for _, values in columns] for k in rows]

    def _columns(self) -> list[tuple[str, np.ndarray]]:
        """Travels and amplitudes of the loads over the stroke."""
        if self.motion is None or self.over is None:
            return []
        units = {load.name: units_of(load) for load in self.drawn.position.mechanism.loads}
        travel = [
            (f"{name} [{units[name][1]}]", units[name][0] * values)
            for name, values in self.motion.travel.items()
        ]
        return travel + [(f"{name} [{units[name][2]}]", size) for name, size in self.over.amplitudes.items()]

    def rows(self) -> Iterator[Sequence[object]]:
        """Rows of the CSV file: the stroke, or the reactions as drawn."""
        if self.motion is not None:
            columns = self._columns()
            yield [name for name, _ in columns]
            yield from np.stack([values for _, values in columns], axis=1).tolist()
            return
        yield "joint", "x_N", "y_N", "magnitude"
        for name, size in self.drawn.magnitudes.items():
            yield name, *np.ravel(self.drawn.reactions.get(name, (np.nan, np.nan))), float(size)

    def to_dict(self) -> dict[str, Any]:
        """The answer as plain numbers, lists and strings."""
        e = self.drawn
        keys = ("status", "message", "mobility", "indeterminacy", "loose", "undetermined", "warnings")
        sets = {
            key: {name: plain(v) for name, v in getattr(e, key).items()}
            for key in ("reactions", "magnitudes", "amplitudes")
        }
        over = {name: plain(values) for name, values in self._columns()}
        return {"title": self.title} | {key: plain(getattr(e, key)) for key in keys} | sets | {"stroke": over}

    def figure(self, part: float = 1.0) -> Figure:
        """The mechanism as drawn and at a part of its stroke, and what the loads do over it."""
        width = 12.0 if self.motion else 7.5
        figure = Figure(figsize=(width, 6))  # laid out by hand, which takes half the time of matplotlib's way
        axes = figure.subplots(1, 2 if self.motion else 1, squeeze=False)[0]
        figure.subplots_adjust(0.8 / width, 0.1, 1 - 0.2 / width, 0.93, wspace=0.2)
        draw_open_and_closed(self.drawn.position, self._at(part), axes[0])
        axes[0].set_title(self.title)
        if self.motion is not None and self.over is not None:
            forces = dict(self.over.amplitudes)
            factor, unit, size = units_of(self.drawn.position.mechanism.load(self.motion.driver))
            label = f"travel of {self.motion.driver} [{unit}]"
            plot_curves(factor * self.motion.values, forces, axes[1], label, f"load [{size}]")
            place = self.motion.values[self._place(part)]
            axes[1].axvline(factor * place, color="0.4", linewidth=1, linestyle=":")
        return figure

    def _place(self, part: float) -> int:
        """The position of the stroke at a part of it."""
        return round(part * (len(self.motion.values) - 1)) if self.motion else 0

    def _at(self, part: float) -> Equilibrium:
        """Equilibrium there, or as drawn."""
        if self.motion is None:
            return self.drawn
        place = self.motion.position[self._place(part)]
        return solve(place.mechanism, place)

    def free_bodies(self) -> Figure:
        """A diagram of each body as drawn."""
        return free_body_diagrams(self.drawn)

    def animate(self, path: Path, force: bool) -> None:
        """Write the stroke as GIF."""
        if self.motion is None:
            raise ValueError("--animation needs a stroke: name run.driver and run.travel in the file")
        animate_stroke(self.motion, path, force)


# What both share ---------------------------------------------------------------------------------


def some_rows(count: int) -> np.ndarray:
    """Indices of the rows of a stroke's table, among so many positions."""
    return np.unique(np.linspace(0, count - 1, _ROWS).round().astype(int))


def animate_stroke(motion: Stroke, path: Path, force: bool) -> None:
    """Write an animation of a stroke."""
    chosen = np.unique(np.linspace(0, len(motion.values) - 1, _FRAMES).round().astype(int))
    positions = Position(motion.position.mechanism, motion.position.batch[chosen])
    factor, unit, _ = units_of(motion.position.mechanism.load(motion.driver))
    animate(
        positions, path, lambda k: f"{motion.driver}: {factor * motion.values[chosen[k]]:.2f} {unit}", force
    )


def units_of(load: Load) -> tuple[float, str, str]:
    """Factor and unit of a load's travel for people, and the unit of its size."""
    return (180 / np.pi, "deg", load.unit) if load.is_couple else (1e3, "mm", load.unit)


def reactions_table(equilibrium: Equilibrium, title: str) -> Any:
    """Loads and the forces of all joints on the bodies named first."""
    mechanism, rows = equilibrium.position.mechanism, []
    for load in mechanism.loads:
        rows.append((load.name, "load", "", "", shown(equilibrium.amplitudes[load.name]), ""))
    rows.append(())
    for joint in mechanism.joints:
        force = np.ravel(equilibrium.reactions.get(joint.name, (np.nan, np.nan)))
        size = equilibrium.magnitudes[joint.name]
        xy = ("", "") if joint.is_couple else (shown(force[0]), shown(force[1]))
        unit = joint.unit if joint.is_couple else _sense(joint, float(np.ravel(size)[0]))
        ends = f"on {joint.acts_on[0]} from {joint.acts_on[-1]}"
        rows.append((joint.name, ends, *xy, shown(size), unit))
    for member in members(equilibrium.position, equilibrium):
        if member.name in mechanism.bodies and np.isfinite(member.force):
            kind = "tension" if member.force > 0 else "compression"
            rows.append((member.name, "two-force body", "", "", shown(abs(member.force)), kind))
    return table(title, ("force", "of", "x [N]", "y [N]", "size [N]", ""), rows, (0, 1, 5))


def _sense(joint: Joint, size: float) -> str:
    return "" if not np.isfinite(size) else joint.signs[0] if size > 0 else joint.signs[1]


def shown(value: Any, digits: int = 5) -> str:
    """A number for a table; nan is what statics does not determine."""
    number = float(np.ravel(value)[0])
    if np.isnan(number):
        return "not determined"
    return f"{0.0 if abs(number) < 1e-9 else number:.{digits}g}"


def verdict(equilibrium: Equilibrium, message: str, virtual_work: float) -> str:
    """Diagnosis in a sentence or two."""
    return (
        f"Statics: {message}. Mobility {int(np.max(equilibrium.mobility))}, indeterminacy "
        f"{int(np.max(equilibrium.indeterminacy))}; virtual work of all loads "
        f"{virtual_work:.1e} of the largest force."
    )
