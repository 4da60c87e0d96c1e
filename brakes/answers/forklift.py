"""Results of a forklift's brakes: the stop, the motion of the shoes, and the forces in one brake."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, reduce
from typing import Any

import numpy as np
from rich.console import RenderableType

from beamdyn.common.drawing.layout import Rows
from beamdyn.common.drawing.on_axes import figure_of
from beamdyn.common.edge.console import table
from beamdyn.common.edge.input_sweep import Output
from beamdyn.common.edge.inputs import in_range, of_file
from beamdyn.common.results.pictures import Figure
from beamdyn.common.results.result import plain
from beamdyn.common.screens.screen_parts import Handle, Slider
from brakes.answers.base import Answer, ArrayBrakeType
from brakes.answers.doubts import hangs_on_friction, with_less_and_more
from brakes.answers.forklift_handles import duo_servo_handles, truck_handles
from brakes.answers.pedal import FromPedal, pedal_outputs, solve_pedal
from brakes.answers.tables import (
    list_outputs,
    outputs_csv,
    outputs_table,
    resultant,
    take,
    take_fields,
    take_from,
)
from brakes.config.forklift import ForkliftInput, StageName
from brakes.drawings.duo_servo import duo_servo
from brakes.drawings.forklift import answer_drawings, outcome
from brakes.drawings.sketches import duo_servo_sketch, levers_sketch, line_sketch, truck_sketch
from brakes.forklift import InternalForces, Kinematics, ShoeMotion, Stop, follow_shoes, internal_forces, stop

_VEHICLE = (
    *take_fields(Stop, "distance"),
    take("pulled_distance", "stopping distance if the slope also pulls while the brake force rises", "m"),
    *take_fields(
        Stop,
        "time acceleration torque_per_brake reaction_distance rise_distance braking_distance "
        "speed_lost_in_rise speed_gained_coasting front_load rear_load standing_front_load "
        "standing_rear_load",
    ),
)
_MOTION = take_fields(
    ShoeMotion,
    "seating_turn seating_travel drum_turn right_travel left_travel tip_gap lining_penetration "
    "penetration_angle",
)
_ARMS = (
    take("a1", "arm of P_L", "mm"),
    take("a2", "arm of P_T", "mm"),
    take("b1", "arm of Q", "mm"),
    take("alpha1", "angle of P_L", "deg"),
    take("alpha2", "angle of P_T", "deg"),
    take("gamma", "angle of Q", "deg"),
)
_FORCES = (
    *take_fields(
        InternalForces,
        "torque piston_force A B C D Q P_L lining_friction locking_friction margin c_star c_star_slope "
        "leading_share trailing_share",
    ),
    Output(
        "bolt_x", "force on the bolts, horizontal, + to the leading shoe", lambda f: f.bolt_force[..., 0], "N"
    ),
    Output("bolt_y", "force on the bolts, vertical, + up", lambda f: f.bolt_force[..., 1], "N"),
    Output("bolts", "force on the bolts, resultant", lambda f: resultant(f.bolt_force), "N"),
    *take_fields(InternalForces, "residual error"),
)


_OF_TYRES = "stop.friction", "tyres on the road: Stopping distance"
_OF_LININGS = "forces.lining_friction", "the linings (the brakes limit the stop): Stopping distance"


def stage_outputs(stages: Sequence[StageName], pedal: Sequence[Output] = ()) -> tuple[Output, ...]:
    """Describe the outputs of the stages, followed by those of the pedal if stop or forces are shown."""
    groups = {
        "vehicle": take_from(lambda answer: answer.stop, _VEHICLE),
        "kinematics": take_from(lambda answer: answer.motion, _MOTION),
        "forces": take_from(lambda answer: answer.forces, _FORCES),
    }
    further = () if stages == ("kinematics",) else take_from(lambda answer: answer.pedal, pedal)
    return (*(output for stage in stages for output in groups[stage]), *further)


@dataclass(frozen=True)
class ForkliftAnswer(Answer):
    """Results of a forklift's brakes, for some of the stages vehicle (the stop), kinematics and forces.

    Attributes
    ----------
    design : ForkliftInput
        The design that the file describes.
    stages : tuple of str
        The stages that are shown, some of "vehicle", "kinematics" and "forces".
    stop : Stop, optional
        Stop of the vehicle, if this stage is shown.
    motion : ShoeMotion, optional
        Motion of the shoes; also there if only the forces that follow from it are shown.
    forces : InternalForces, optional
        The forces in one brake.
    torque_from : str
        Origin of the torque: "the file", "the stop" or "the lining's friction".
    pedal : FromPedal, optional
        Results from the pedal to the stop, if the file has a pedal and vehicle or forces are shown.
    """

    design: ForkliftInput
    stages: tuple[StageName, ...]
    stop: Stop | None
    motion: ShoeMotion | None
    forces: InternalForces | None
    torque_from: str = ""
    pedal: FromPedal | None = None

    @cached_property
    def kinematics(self) -> Kinematics | None:
        """Motion of the shoes position by position, if this stage is shown; for a single case only."""
        return (
            None if self.motion is None else follow_shoes(self.motion.geometry, float(self.motion.clearance))
        )

    @property
    def warnings(self) -> Sequence[str]:
        """Sentences on a lining that enters the drum, and the warnings of forces and pedal."""
        interference = () if self.motion is None else self.motion.interference
        parts = (self.forces, self.pedal)
        return (*interference, *(said for part in parts if part is not None for said in part.warnings))

    @property
    def refusals(self) -> Sequence[str]:
        """Sentences on a truck that does not stop, and on a brake that locks or cannot give the torque."""
        found = self.stop if self.pedal is None else self.pedal.braked.stop
        stop = [] if found is None or np.all(found.stops) else [found.message]
        unbalanced = self.forces is not None and np.any(self.forces.status != "equilibrium")
        fade = () if self.pedal is None else self.pedal.refusals
        return (*stop, *fade, *([self.forces.message] if self.forces is not None and unbalanced else []))

    def refusals_of_cases(self, count: int) -> dict[int, str]:
        """Return a sentence on each design without a result, by its index; `count` counts all designs."""
        fade = None if self.pedal is None else self.pedal.fade
        hot = {} if fade is None else fade.messages_of_cases(count)
        stop = {} if self.stop is None else self.stop.messages_of_cases(count)
        return hot | stop | ({} if self.forces is None else self.forces.messages_of_cases(count))

    @property
    def error(self) -> Any:
        """Sum of the stages' relative errors."""
        stages = (self.stop, self.motion, self.forces, self.pedal)
        return sum(stage.error for stage in stages if stage is not None)

    def tables(self) -> list[RenderableType]:
        """Make the tables of vehicle, kinematics and forces, for the stages that are shown."""
        tables, heads, others = [], ("", "value", "unit"), self._doubtful()
        if self.stop is not None:
            rows = [
                ["", str(self.stop.status), ""],
                *list_outputs(_VEHICLE, [self.stop], [[each.stop for each in others]]),
            ]
            if self.stop.limited_by == "brake":
                rolls = ("wheels locked", "wheels rolling"), (", sliding", ", rolling")
                rows = [
                    [reduce(lambda said, each: said.replace(*each), rolls, w), *more] for w, *more in rows
                ]
            tables.append(table("Vehicle", heads, rows, (0, 2)))
            tables.append(self._doubt())
        if self.pedal is not None:
            tables += self.pedal.tables([each.pedal for each in others])
        if "kinematics" in self.stages and self.motion is not None and (done := self.kinematics) is not None:
            rows = [
                [
                    str(event.stage),
                    event.message,
                    f"{stage.rank.min()} of {stage.constraints}",
                    f"{stage.least_singular_value.min():.2g}",
                ]
                for event, stage in zip(done.events, (done.right, done.left, done.drum), strict=True)
            ]
            least = "smallest rank and relative singular value of the constraints' Jacobian during the motion"
            heads_of_events = ("stage", "event", "rank", "smallest singular value")
            tables.append(outputs_table("Kinematics of one brake", _MOTION, self.motion))
            tables.append(table(f"Events ({least})", heads_of_events, rows, (0, 1)))
        if (f := self.forces) is not None:
            rows = [
                *list_outputs(_FORCES, [f], [[each.forces for each in others]]),
                [],
                *list_outputs(_ARMS, [f.levers]),
            ]
            limit = None if self.pedal is None else str(self.pedal.braked.limited_by)
            source = {"brake": "the pedal", "road": "the road, on locked wheels", None: self.torque_from}[
                limit
            ]
            title = f"Forces in one brake; the torque is from {source}"
            tables.append(table(title, heads, rows, (0, 2)))
            if limit == "road" and self.design.forces is not None:
                tables.append(
                    "The linings stick to their drums: the locked wheels use "
                    f"{f.lining_friction:.4g} of their friction {self.design.forces.lining_friction:.4g}."
                )
        return tables

    def _doubtful(self) -> list[ForkliftAnswer]:
        """Solve the design with less and with more friction of the tyres, and of the linings."""
        paths = ("stop.friction", "forces.lining_friction")
        made = (with_less_and_more(self._one_stop, path, self._again) for path in paths)
        return [each for pair in made for each in pair]

    @property
    def _one_stop(self) -> ForkliftInput:
        """The design without repeated stops, which take long to compute."""
        return self.design.model_copy(update={"heat": None})

    def _again(self, design: ForkliftInput) -> ForkliftAnswer:
        return solve_stages(design, self.stages)

    def _doubt(self) -> str:
        """State the stopping distance with less and more friction of tyres or linings, whichever limit it."""

        def distance(design: ForkliftInput) -> float:
            found = solve_stages(design, ("vehicle",)).stop
            assert found is not None
            return float(found.distance) if np.all(found.stops) else np.nan

        assert self.stop is not None
        path, of = _OF_LININGS if self.stop.limited_by == "brake" else _OF_TYRES
        return hangs_on_friction(self._one_stop, path, of, distance, "m", "does not stop")

    def rows(self) -> Iterable[Sequence[object]]:
        """Make rows of name, value and unit of all outputs."""
        return outputs_csv(stage_outputs(self.stages, pedal_outputs(self.design)), value=self)

    def figure(self, place: float | None = None) -> Figure:
        """Draw truck, both stages of the brake's motion, and free bodies, for the stages that are shown."""
        return figure_of(self._drawn(place))

    def drawings(self, place: float) -> Rows:
        """Make the drawings of truck and brake; titles leave out slope and speed, which the form shows."""
        if self.stop is None:
            return self._drawn(place)
        (first, *others), *below = self._drawn(place)
        return ((replace(first, title=outcome(self.stop)), *others), *below)

    def _drawn(self, place: float | None) -> Rows:
        """Make all drawings; for kinematics alone, the brake at `place`, from 0 (rest) to 2 (end)."""
        if place is not None and self.stages == ("kinematics",) and (motion := self.motion) is not None:
            turns = (
                min(place, 1.0) * float(motion.seating_turn),
                max(place - 1.0, 0.0) * float(motion.drum_turn),
            )
            shoes, drum = np.degrees(turns)
            title = f"shoes turned {shoes:.3g} deg, drum turned {drum:.3g} deg"
            return ((duo_servo(motion.geometry, motion, place, title),),)
        shown = None if self.stages == ("forces",) else self.kinematics
        return answer_drawings(self.stop, shown, self.forces, self.kinematics)

    def values(self) -> dict[str, Any]:
        """Convert the results to plain numbers, lists and strings."""
        parts = {name: plain(getattr(self, name)) for name in ("stop", "motion", "forces", "torque_from")}
        parts |= {} if self.pedal is None else {"pedal": plain(self.pedal)}
        return parts | {"kinematics": self.kinematics and self.kinematics.to_dict()}

    def handles(self, place: float) -> Sequence[Handle]:
        """Make the handles of the truck if only the truck is shown, of the brake if only the brake is."""
        if self.stages == ("vehicle",) and self.stop is not None:
            return truck_handles(self.stop)
        if self.stages == ("kinematics",) and self.motion is not None:
            return duo_servo_handles(self.motion, place)
        return ()


# From file to results -----------------------------------------------------------------------------------


_NEEDS = {
    "vehicle": "[truck] and [stop]",
    "kinematics": "[brake]",
    "forces": "[forces], and [brake] or [levers]",
}


def solve_stages(design: ForkliftInput, stages: Sequence[StageName] = ()) -> ForkliftAnswer:
    """Solve stages of a forklift's brakes, and earlier stages if they are needed.

    Parameters
    ----------
    design : ForkliftInput
        The design that the file describes.
    stages : sequence of str
        Some of "vehicle", "kinematics", "forces"; by default those whose tables are in the file.

    Raises
    ------
    ValueError
        If a table is missing that a stage needs, or as for the functions of `brakes.forklift`.
    """
    shown = tuple(stages) or design.stages
    for name in shown:
        if name not in design.stages:
            raise ValueError(f"the stage {name} needs the tables {_NEEDS[name]}")
    given = design.forces and design.forces.torque
    from_stop = "forces" in shown and given is None and "vehicle" in design.stages
    stopped = forces = chained = None
    with in_range(design):
        if design.pedal and shown != ("kinematics",):
            chained = solve_pedal(design)
            stopped = chained.braked.stop
        elif (from_stop or "vehicle" in shown) and design.truck and design.stop:
            with of_file({}):
                stopped = stop(design.truck.core, design.stop.core)
        motion = design.brake.motion if design.brake and shown != ("vehicle",) else None
        torque = stopped.torque_per_brake if from_stop and stopped is not None else given
        geometry = motion or (design.levers and design.levers.core)
        if "forces" in shown and design.forces and geometry is not None:
            piston_force, friction = design.forces.piston_force, design.forces.lining_friction
            if chained is not None:  # solve for the friction: locked wheels may not use all of the linings'
                piston_force, friction = chained.braked.actuation.actuator_force, None
            with of_file({"friction": "lining_friction"}):
                forces = internal_forces(
                    geometry, piston_force=piston_force, torque=torque, friction=friction
                )
    source = "the stop" if from_stop else "the lining's friction" if given is None else "the file"
    source, shown_stop = source if forces else "", stopped if "vehicle" in shown else None
    return ForkliftAnswer(design, shown, shown_stop, motion, forces, source, chained)


class ForkliftType(ArrayBrakeType[ForkliftInput]):
    """Type of brake for a forklift's brakes, with all stages whose tables are in the file.

    Attributes
    ----------
    stages : tuple of str
        The stages that are shown; if empty, those whose tables are in the file.
    """

    name = "forklift"
    title = "Forklift"
    purpose = "Stopping distance of a forklift, motion of its duo-servo shoes, and the force on every part."
    method = "closed forms of the stop and of the shoes' motion; forces by roots of one or two equations"
    error_from = (
        "rounding of inputs and sums, divided by the margins to self-locking, to never stopping, and to the "
        "end of the shoes' reach"
    )
    model = ForkliftInput
    together = (
        "[truck] and [stop] are for the vehicle, [brake] for the kinematics, [forces] with [brake] or "
        "[levers] for the forces; [pedal] and [line] need the tables for vehicle and forces, [drums] needs "
        "[pedal], [heat] needs [drums]."
    )
    sections = needs = ("truck", "stop", "brake", "levers", "forces", "pedal", "line", "drums", "heat")
    example_sweep = "stop.speed=10:30:21 km/h"
    stages: tuple[StageName, ...] = ()

    def solve(self, design: ForkliftInput) -> ForkliftAnswer:
        """Solve the stages; see `solve_stages`."""
        return solve_stages(design, self.stages)

    def outputs(self, design: ForkliftInput) -> Sequence[Output]:
        """Describe the outputs of the stages that are shown, and of the pedal."""
        return stage_outputs(self.stages or design.stages, pedal_outputs(design))

    def default_results(self, design: ForkliftInput) -> str:
        """Return the names of the most important results of each stage, separated by commas."""
        return ",".join(TYPES[name].sweep_results for name in self.stages or design.stages)


class VehicleType(ForkliftType):
    """Type of brake for the stop of a forklift truck."""

    title = "Vehicle"
    purpose = "The truck drives down a slope and brakes: stopping distance, and the torque of each brake."
    sections = needs = ("truck", "stop")
    example_sweep = "stop.speed=10:30:21 km/h"
    sweep_results = "distance,torque_per_brake"
    key_results = (
        ("stopping distance", "distance"),
        ("time to rest", "time"),
        ("torque of each brake", "torque_per_brake"),
    )
    stages = ("vehicle",)
    sketches = staticmethod(truck_sketch)


class KinematicsType(ForkliftType):
    """Type of brake for the motion of a duo-servo brake's shoes."""

    title = "Kinematics"
    purpose = (
        "The shoes of a duo-servo brake: they turn onto the drum, then turn with it until a piston bottoms."
    )
    sections = needs = ("brake",)
    example_sweep = "brake.clearance=8:11:16 mm"
    sweep_results = "drum_turn,left_travel,lining_penetration"
    key_results = (
        ("the drum turns", "drum_turn"),
        ("right piston travels", "right_travel"),
        ("left piston travels", "left_travel"),
    )
    slider = Slider("stage", ("at rest", "linings on the drum", "piston at its bottom"))
    stages = ("kinematics",)
    sketches = staticmethod(duo_servo_sketch)


class ForcesType(ForkliftType):
    """Type of brake for the forces in a duo-servo brake."""

    title = "Internal forces"
    purpose = (
        "The force on every part of the brake, from the torque of the stop and the arms of the kinematics."
    )
    sections = ("forces", "levers", "pedal", "line", "drums", "heat")
    needs = ForkliftType.needs
    example_sweep = "forces.piston_force=9:13:17 kN"
    sweep_results = "A,B,Q,P_L,lining_friction"
    key_results = (
        ("torque of the brake", "torque"),
        ("brake factor C*", "c_star"),
        ("margin to self-locking", "margin"),
    )
    stages = ("forces",)
    sketches = staticmethod(lambda: [*levers_sketch(), *line_sketch()])


FORKLIFT = ForkliftType()
TYPES: dict[StageName, ForkliftType] = {
    "vehicle": VehicleType(),
    "kinematics": KinematicsType(),
    "forces": ForcesType(),
}
