"""Answers on planar mechanisms of bodies, joints and loads, as drawn and over a stroke."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from math import pi
from typing import Any

import numpy as np
from matplotlib.figure import Figure
from rich.console import RenderableType

from beamdyn.common.drawing.chart import Chart
from beamdyn.common.drawing.shapes import Drawing
from beamdyn.common.drawing.sheet import Rows
from beamdyn.common.edge.config import MissingValue
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.tables import table
from beamdyn.common.edge.wording import in_small_units
from beamdyn.common.results.result import plain
from brakes.answers.planar import (
    BRANCHES,
    WITHOUT,
    MechanismFriction,
    PlanarAnswer,
    describe_statics,
    format_force,
    joint_outputs,
    largest_error,
    name_output,
    reactions_table,
    select_rows,
    units_of,
    unknown_loads,
)
from brakes.config.caliper import CaliperInput
from brakes.config.mechanism import MechanismInput
from brakes.drawings.mechanism import (
    LoadsOverStroke,
    mechanism_figure,
    open_and_closed,
    with_lock,
    with_points,
)
from brakes.planar import Equilibrium, Load, Mechanism, Stroke, assemble, solve, stroke
from brakes.planar.system import join_names

_SCALES = {"mm": 1e-3, "deg": pi / 180}


def mechanism_outputs(mechanism: Mechanism) -> tuple[Output, ...]:
    """Each load and its travel at the end of the stroke, the largest force of each joint.

    With friction also the unknown load, squeezing and releasing.
    """
    loads = (output for load in mechanism.loads for output in _load_outputs(load))
    rubbing = (output for load in unknown_loads(mechanism) for output in _friction_outputs(load))
    joints = joint_outputs(mechanism, lambda answer: answer.last.magnitudes)
    return (*loads, *joints, *rubbing)


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


def _friction_outputs(load: Load) -> tuple[Output, Output]:
    key = name_output(load.name)
    squeezing, releasing = (
        Output(
            f"{key}_{name}",
            f"{load.name} at the end of the stroke, {name}",
            lambda answer, way=way: (
                np.ravel(getattr(answer.friction.last, way).amplitudes[load.name])[-1]
                if answer.friction
                else np.nan
            ),
            load.unit,
        )
        for name, way in (("squeezing", "squeeze"), ("releasing", "release"))
    )
    return squeezing, releasing


@dataclass(frozen=True)
class MechanismAnswer(PlanarAnswer):
    """Equilibrium of a mechanism as drawn, and over the stroke of a driver where one is named.

    Attributes
    ----------
    over : Equilibrium, optional
        Equilibrium at each position of the stroke.
    friction : MechanismFriction, optional
        Equilibria with friction, if a joint has friction, and statics determines the forces of the only
        motion.
    branch : {"without friction", "squeezing", "releasing"}
        The equilibrium whose forces are drawn.
    """

    over: Equilibrium | None
    friction: MechanismFriction | None
    branch: str = WITHOUT

    def branches(self) -> Mapping[str, MechanismAnswer]:
        """The answer with the forces of each branch drawn: without friction, squeezing, releasing."""
        return {name: replace(self, branch=name) for name in BRANCHES} if self.friction else {}

    @classmethod
    def of(cls, mechanism: Mechanism, design: CaliperInput | MechanismInput) -> MechanismAnswer:
        """Assemble the mechanism and solve for its forces; see `brakes.planar.assemble` and `stroke`.

        Raises
        ------
        MissingValue
            If joints have friction and no driver is named.
        """
        drawn, run = solve(mechanism, assemble(mechanism)), design.run
        motion, over, friction = None, None, None
        if run.driver is not None and run.travel is not None:
            motion = stroke(mechanism, run.driver, np.linspace(0.0, run.travel, run.points))
            over = solve(mechanism, motion.position)
        last = drawn if over is None else over
        if mechanism.friction and last.is_determined and drawn.mobility == 1:
            friction = MechanismFriction.of(drawn, _driver(design, mechanism), motion)
        return cls(design, drawn, motion, over, friction)

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
    def refusals(self) -> Sequence[str]:
        """Sentences on forces not determined, contacts that open, and directions in which friction jams."""
        found = super().refusals
        if self.friction is not None:
            return (*found, *map(in_small_units, self.friction.refusals))
        if self._mechanism.friction and self.last.is_determined:
            return (*found, f"friction acts against one motion; the mobility is {self.equilibrium.mobility}")
        return found

    @property
    def warnings(self) -> Sequence[str]:
        """Warnings of statics, toggle positions, and directions in which friction holds the mechanism."""
        moved = self._warnings_of_stroke(self.motion) if self.motion else ()
        held = self.friction.warnings if self.friction else ()
        return tuple(map(in_small_units, (*self.last.warnings, *moved, *held)))

    def _warnings_of_stroke(self, motion: Stroke) -> Iterator[str]:
        """Toggle positions, and joints that the motion shows to be doubtful."""
        yield from (toggle.message for toggle in motion.toggles)
        angles = {body: motion.position.angle(body) for body in self._mechanism.bodies}
        for joint in self._mechanism.joints:
            yield from joint.doubts(angles)

    @property
    def error(self) -> float:
        """Largest error of the forces, over the largest force."""
        return max(largest_error(self.last), self.friction.error if self.friction else 0.0)

    @property
    def equilibria(self) -> Mapping[str, Equilibrium]:
        """As drawn, or with friction the three equilibria as drawn."""
        if self.friction is None:
            return super().equilibria
        found = self.friction.drawn
        return {"without friction": found.without, "squeezing": found.squeeze, "releasing": found.release}

    @property
    def _mechanism(self) -> Mechanism:
        return self.equilibrium.position.mechanism

    def tables(self) -> list[RenderableType]:
        """Forces as drawn, with friction, the stroke, and the diagnosis."""
        return [
            reactions_table(self.equilibrium, self._forces_title("as drawn")),
            *([self.friction.table()] if self.friction else []),
            *(self._stroke_tables(self.motion) if self.motion else []),
            describe_statics(self.equilibrium, self.message, np.max(self.last.virtual_work), self.error),
        ]

    def _forces_title(self, where: str) -> str:
        """Title of a table of forces."""
        return f"{self.design.title}: forces {where}{', without friction' if self.friction else ''}"

    def _stroke_tables(self, motion: Stroke) -> list[RenderableType]:
        """Loads over the stroke, and all forces at its end."""
        columns = self._columns()
        rows = [[format_force(v[k], 6) for v in columns.values()] for k in select_rows(len(motion.values))]
        end = motion.position[len(motion.values) - 1]
        where = f"at {self._travelled(len(motion.values) - 1)}"
        return [
            table(f"Stroke of {motion.driver}", [*columns], rows),
            reactions_table(solve(end.mechanism, end), self._forces_title(where)),
        ]

    def _columns(self) -> dict[str, np.ndarray]:
        """Travels and sizes of the loads over the stroke, by name and unit."""
        if self.motion is None or self.over is None:
            return {}
        units = {load.name: units_of(load) for load in self._mechanism.loads}
        travels = {
            f"{name} [{units[name][1]}]": units[name][0] * values
            for name, values in self.motion.travel.items()
        }
        loads = {f"{name} [{units[name][2]}]": size for name, size in self.over.amplitudes.items()}
        return travels | loads | (self.friction.columns() if self.friction else {})

    def rows(self) -> Iterator[Sequence[object]]:
        """The stroke, or the forces as drawn: loads, then joints on the bodies named first."""
        if self.motion is not None:
            columns = self._columns()
            yield [*columns]
            yield from np.stack([*columns.values()], axis=1).tolist()
            return
        ways = list(self.equilibria.values())
        more = ("squeezing", "releasing") if self.friction else ()
        yield "force_of", "x_N", "y_N", "size", *more, "unit"
        for part in self._mechanism.parts:
            force = np.ravel(self.equilibrium.reactions.get(part.name, (np.nan, np.nan)))
            sizes = (float((way.magnitudes | way.amplitudes)[part.name]) for way in ways)
            yield part.name, *force, *sizes, part.unit

    def values(self) -> dict[str, Any]:
        """The answer as plain numbers, lists and strings."""
        keys = ("mobility", "indeterminacy", "loose", "undetermined", "open_or_slack")
        forces = ("reactions", "magnitudes", "amplitudes")
        drawn = {key: plain(getattr(self.equilibrium, key)) for key in (*keys, *forces)}
        told = {"title": self.design.title, "status": self.status, "message": self.message}
        more = {"warnings": plain(self.warnings), "stroke": plain(self._columns())}
        return told | drawn | more | {"friction": self.friction and self.friction.to_dict()}

    def figure(self, place: float | None = None) -> Figure:
        """The mechanism with its forces, and the loads over the stroke.

        Parameters
        ----------
        place : float, optional
            Part of the stroke, from 0 to 1; if not given, as drawn, which the table of forces shows.
        """
        index = self._index_at(0.0 if place is None else place)
        return mechanism_figure(self._drawing(index), self._over_stroke(index))

    def drawings(self, place: float) -> Rows:
        """The mechanism as drawn and at a part of its stroke, from 0 to 1."""
        return ((self._drawing(self._index_at(place)),),)

    def charts(self, place: float) -> Sequence[Chart]:
        """The loads over the stroke, if there is one."""
        loads = self._over_stroke(self._index_at(place))
        return () if loads is None else loads.charts()

    def _index_at(self, place: float) -> int:
        return 0 if self.motion is None else _index(self.motion, place)

    def _drawing(self, index: int) -> Drawing:
        caption = self.friction.caption(index) if self.friction else ""
        title = "\n".join(filter(None, (self._heading(index), *caption.split("; "))))
        now = self._equilibrium_at(index)
        drawn = open_and_closed(self.equilibrium.position, now, title)
        if now.status == "self-locking":
            drawn = with_lock(drawn, now, unknown_loads(self._mechanism)[-1].name)
        points = getattr(self.design, "points", {})  # of a file; a named caliper has dimensions
        return with_points(drawn, {name: (float(x), float(y)) for name, (x, y) in points.items()})

    def _heading(self, index: int) -> str:
        """Title, position and branch."""
        way = f", {self.branch}" if self.friction else ""
        if self.motion is None:
            return f"{self.design.title}{way}"
        moved = f"{self._travelled(index)}{way}; grey: as drawn"
        return f"{self.design.title}: {moved if index else f'as drawn{way}'}"

    def _travelled(self, index: int) -> str:
        """Travel of the driver at one of the positions."""
        if self.motion is None:
            return ""
        factor, unit, _ = units_of(self._mechanism.load(self.motion.driver))
        return f"{factor * self.motion.values[index]:.3g} {unit} of {self.motion.driver}"

    def _over_stroke(self, index: int) -> LoadsOverStroke | None:
        """Forces and moments over the stroke, if there is one."""
        if self.motion is None or self.over is None:
            return None
        factor, unit, _ = units_of(self._mechanism.load(self.motion.driver))
        sizes = {
            couples: {
                load.name: self.over.amplitudes[load.name]
                for load in self._mechanism.loads
                if load.is_couple == couples
            }
            | (self.friction.curves(couples) if self.friction else {})
            for couples in (False, True)
        }
        travel = factor * self.motion.values
        locked = self.friction.locked() if self.friction else {}
        return LoadsOverStroke(
            travel, self.motion.driver, unit, sizes[False], sizes[True], float(travel[index]), locked
        )

    def _equilibrium_at(self, index: int) -> Equilibrium:
        """Forces of the branch that is drawn."""
        position = self.equilibrium.position if self.motion is None else self.motion.position[index]
        if self.friction is not None and self.branch != WITHOUT:
            return self.friction.at(position, self.branch)
        return self.equilibrium if self.motion is None else solve(position.mechanism, position)


def _driver(design: CaliperInput | MechanismInput, mechanism: Mechanism) -> str:
    """The load that drives the motion against which friction acts."""
    if design.run.driver is None:
        names = join_names(mechanism.friction)
        raise MissingValue(
            "run.driver", None, f"friction of {names} resists a motion: name the load that drives it"
        )
    return design.run.driver


def _index(motion: Stroke, part: float) -> int:
    """The position at a part of a stroke."""
    return round(part * (len(motion.values) - 1))
