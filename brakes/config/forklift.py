"""A forklift's brakes in TOML: [truck] and [stop], [brake] or [levers], [forces]; each stage alone or all."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from functools import cached_property
from math import pi
from os import PathLike
from typing import Annotated, Any, Literal

import numpy as np
from pydantic import Field, model_validator

from beamdyn.common.edge.config import CoreSection, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.results import Result
from brakes.config.wording import in_range, of_file
from brakes.forklift import (
    DuoServo,
    InternalForces,
    Kinematics,
    Levers,
    ShoeMotion,
    Stop,
    Truck,
    follow,
    internal_forces,
    stop,
)
from brakes.forklift.vehicle import STANDARD_GRAVITY

__all__ = [
    "STAGES",
    "ForkliftAnswer",
    "ForkliftInput",
    "forklift_from_dict",
    "load_forklift",
    "parse_forklift",
]

StageName = Literal["vehicle", "kinematics", "forces"]
STAGES: tuple[StageName, ...] = ("vehicle", "kinematics", "forces")
Model = Literal["corrected", "as_printed"]


def load_forklift(path: str | PathLike[str]) -> ForkliftInput:
    """Read a forklift's brakes from a TOML file.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    ForkliftInput
        Its ``solve()`` is the answer.

    Raises
    ------
    ConfigError
        If there is no such file or it does not describe a forklift; the message lists all mistakes.
    """
    return parse_forklift(read(path), str(path))


def parse_forklift(text: str, source: str = "forklift") -> ForkliftInput:
    """Read a forklift's brakes from TOML text; see `load_forklift`."""
    return forklift_from_dict(parse(text, source), source)


def forklift_from_dict(data: Mapping[str, Any], source: str = "forklift") -> ForkliftInput:
    """A forklift's brakes from the tables of a TOML file; see `load_forklift`."""
    return validated(ForkliftInput, data, source)


_CG = {"empty_cg[0]": "empty_cg_x", "empty_cg[1]": "empty_cg_y", "empty_cg": "empty_cg_x or empty_cg_y"}
_PINS = {
    "adjuster[0]": "adjuster_x",
    "adjuster[1]": "adjuster_y",
    "tip[0]": "tip_x",
    "tip[1]": "tip_y",
}


class TruckInput(CoreSection):
    """[truck]: the truck and its load; x from the front axle to the rear, y up from the front axle."""

    empty_mass: Annotated[float, Quantity("kg", symbol="m", meaning="mass of the empty truck", above=0)]
    empty_cg_x: Annotated[
        float,
        Quantity("m", symbol="x", meaning="centre of gravity of the empty truck, behind the front axle"),
    ]
    empty_cg_y: Annotated[
        float, Quantity("m", symbol="y", meaning="centre of gravity of the empty truck, above the front axle")
    ]
    load_mass: Annotated[float, Quantity("kg", symbol="m_L", meaning="mass of the load", least=0)] = 0.0
    load_cg_x: Annotated[
        float, Quantity("m", symbol="x_L", meaning="the load's centre, behind the front axle: negative")
    ] = 0.0
    load_cg_y: Annotated[
        float, Quantity("m", symbol="y_L", meaning="the load's centre, above the front axle")
    ] = 0.0
    front_wheel_radius: Annotated[
        float, Quantity("m", symbol="r1", meaning="radius of the front wheels", above=0)
    ]
    wheelbase: Annotated[float, Quantity("m", symbol="L", meaning="distance of the axles", above=0)]

    @cached_property
    def core(self) -> Truck:
        """The truck."""
        with of_file(_CG):
            return Truck(
                self.empty_mass,
                (self.empty_cg_x, self.empty_cg_y),
                self.load_mass,
                (self.load_cg_x, self.load_cg_y),
                self.front_wheel_radius,
                self.wheelbase,
            )


class StopInput(Section):
    """[stop]: the truck reverses down a slope and brakes with locked front wheels."""

    slope: Annotated[
        float,
        Quantity("rad", symbol="beta", meaning="slope, downhill as it travels", above=-pi / 2, below=pi / 2),
    ]
    speed: Annotated[float, Quantity("m/s", symbol="V", meaning="speed before the stop", above=0)]
    friction: Annotated[float, Quantity(symbol="mu", meaning="friction of tyres on the ground", above=0)]
    reaction_time: Annotated[float, Quantity("s", symbol="t1", meaning="time before the brakes act", least=0)]
    rise_time: Annotated[
        float, Quantity("s", symbol="t2", meaning="time in which the brake force rises", least=0)
    ]
    model: Annotated[
        Model, Field(description="corrected mechanics, or the paper's as_printed, which errs")
    ] = "corrected"
    distance: Annotated[
        Literal["exact", "printed"] | None,
        Field(description="formula of the distance; if not given, that of the model"),
    ] = None
    slope_factor: (
        Annotated[
            float,
            Quantity(
                symbol="k",
                meaning="factor on the slope's pull; if not given, 1, and as printed 0.97 for a reason "
                "that is not known",
                above=0,
            ),
        ]
        | None
    ) = None
    gravity: Annotated[float, Quantity("m/s2", symbol="g", meaning="gravity", above=0)] = STANDARD_GRAVITY

    def solve(self, truck: Truck, model: Model | None = None) -> Stop:
        """The stop of a truck, by this model or another one."""
        chosen = model or self.model
        default = ("exact", 1.0) if chosen == "corrected" else ("printed", PRINTED_FACTOR)
        with of_file({"factor": "slope_factor"}):
            return stop(
                truck,
                slope=self.slope,
                speed=self.speed,
                friction=self.friction,
                reaction_time=self.reaction_time,
                rise_time=self.rise_time,
                model=chosen,
                distance=self.distance or default[0],
                factor=default[1] if self.slope_factor is None else self.slope_factor,
                g=self.gravity,
            )


PRINTED_FACTOR = 0.97  # on the slope's pull, in the paper's tables


class BrakeInput(CoreSection):
    """[brake]: geometry of a duo-servo brake, the right side of it at rest; the left side mirrors it."""

    drum_radius: Annotated[float, Quantity("m", symbol="r", meaning="inner radius of the drum", above=0)]
    tip_x: Annotated[
        float, Quantity("m", symbol="x_t", meaning="pin of the shoe's tip, from the centre", above=0)
    ]
    tip_y: Annotated[
        float, Quantity("m", symbol="y_t", meaning="pin of the shoe's tip, above the centre", above=0)
    ]
    adjuster_x: Annotated[
        float, Quantity("m", symbol="x_a", meaning="pin of the adjuster, from the centre", above=0)
    ]
    adjuster_y: Annotated[
        float,
        Quantity("m", symbol="y_a", meaning="pin of the adjuster, above the centre: negative", below=0),
    ]
    face_tilt: Annotated[
        float,
        Quantity("rad", symbol="alpha", meaning="tilt of the pistons' faces", above=-pi / 2, below=pi / 2),
    ]
    contact_angle: Annotated[
        float,
        Quantity(
            "rad",
            meaning="where the lining touches first, up from the horizontal",
            above=-pi / 2,
            below=pi / 2,
        ),
    ]
    piston_bottom: Annotated[
        float, Quantity("m", meaning="how far a piston can be pushed in from its place at rest", above=0)
    ]
    piston_stroke: (
        Annotated[float, Quantity("m", meaning="how far a piston can come out; else not checked", above=0)]
        | None
    ) = None
    clearance: Annotated[
        float, Quantity("m", symbol="c_L", meaning="between lining and drum at rest", above=0)
    ]

    @cached_property
    def core(self) -> DuoServo:
        """The geometry."""
        with of_file(_PINS):
            return DuoServo(
                self.drum_radius,
                (self.tip_x, self.tip_y),
                (self.adjuster_x, self.adjuster_y),
                self.face_tilt,
                self.contact_angle,
                self.piston_bottom,
                self.piston_stroke,
            )

    @property
    def motion(self) -> ShoeMotion:
        """Where the shoes go."""
        with of_file(_PINS):
            return self.core.motion(self.clearance)


class LeversInput(CoreSection):
    """[levers]: arms about the drum's centre and directions, for the forces without a geometry."""

    drum_radius: Annotated[float, Quantity("m", symbol="r", meaning="inner radius of the drum", above=0)]
    a1: Annotated[float, Quantity("m", symbol="a1", meaning="arm of P_L, on the leading shoe", above=0)]
    a2: Annotated[float, Quantity("m", symbol="a2", meaning="arm of P_T, on the trailing shoe", above=0)]
    b1: Annotated[float, Quantity("m", symbol="b1", meaning="arm of Q on the leading shoe", above=0)]
    b2: Annotated[float, Quantity("m", symbol="b2", meaning="arm of Q on the trailing shoe", above=0)]
    alpha1: Annotated[float, Quantity("rad", symbol="alpha1", meaning="angle of P_L, below the horizontal")]
    alpha2: Annotated[float, Quantity("rad", symbol="alpha2", meaning="angle of P_T, below the horizontal")]
    gamma: Annotated[float, Quantity("rad", symbol="gamma", meaning="angle of Q, above the horizontal")]

    @model_validator(mode="after")
    def _one_line(self) -> LeversInput:
        if abs(self.b1 - self.b2) > 1e-9 * self.b1:
            raise ValueError(
                f"b1 = {self.b1:g} m and b2 = {self.b2:g} m differ: the adjuster's force Q has one line of "
                "action; give the same arm twice"
            )
        return self

    @cached_property
    def core(self) -> Levers:
        """The arms."""
        with of_file({}):
            return Levers(**dict(self))


class ForcesInput(Section):
    """[forces]: what the forces in a brake follow from."""

    piston_force: Annotated[
        float, Quantity("N", symbol="P_T", meaning="force of the piston on the trailing shoe", above=0)
    ]
    torque: (
        Annotated[
            float,
            Quantity(
                "N m", symbol="T", meaning="torque of one brake; if not given, that of the stop", above=0
            ),
        ]
        | None
    ) = None
    lining_friction: (
        Annotated[
            float,
            Quantity(
                symbol="mu_l",
                meaning="friction of the linings: compared with what the torque needs, or gives the torque",
                above=0,
            ),
        ]
        | None
    ) = None


_NEEDS = {
    "vehicle": "[truck] and [stop]",
    "kinematics": "[brake]",
    "forces": "[forces], and [brake] or [levers]",
}


@dataclass(frozen=True)
class ForkliftAnswer(Result):
    """What the stages that were asked for found.

    Attributes
    ----------
    stop : Stop, optional
        The vehicle.
    motion : ShoeMotion, optional
        The kinematics.
    forces : InternalForces, optional
        The forces in one brake.
    torque_from : str
        Where the torque comes from: "the file", "the stop" or "the lining's friction".
    kinematics : Kinematics, optional
        The shoes' motion position by position, if `followed`.
    """

    stop: Stop | None
    motion: ShoeMotion | None
    forces: InternalForces | None
    torque_from: str = ""
    kinematics: Kinematics | None = None

    def followed(self, positions: int = 21) -> ForkliftAnswer:
        """The same with the shoes' motion position by position, if there is any; of one case."""
        if self.motion is None:
            return self
        found = follow(self.motion.geometry, float(self.motion.clearance), positions)
        return replace(self, kinematics=found)

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings."""
        return super().to_dict() | {"kinematics": self.kinematics and self.kinematics.to_dict()}

    @property
    def warnings(self) -> tuple[str, ...]:
        """What to look at."""
        interference = () if self.motion is None else self.motion.interference
        return (*interference, *(() if self.forces is None else self.forces.warnings))

    @property
    def refusals(self) -> tuple[str, ...]:
        """Why there is no stop, or no equilibrium: one sentence each, none if all is well."""
        found = []
        if self.stop is not None and not np.all(self.stop.stops):
            found.append(self.stop.message)
        if self.forces is not None and np.any(self.forces.status != "equilibrium"):
            found.append(self.forces.message)
        return tuple(found)


@dataclass(frozen=True)
class Models(Result):
    """The answers of both models, side by side."""

    corrected: ForkliftAnswer
    as_printed: ForkliftAnswer

    def to_dict(self) -> dict[str, Any]:
        """The result as plain numbers, lists and strings."""
        return {"corrected": self.corrected.to_dict(), "as_printed": self.as_printed.to_dict()}


class ForkliftInput(Section):
    """A forklift's brakes: [truck] and [stop], [brake] or [levers], [forces], as far as they are wanted."""

    truck: TruckInput | None = None
    stop: StopInput | None = None
    brake: BrakeInput | None = None
    levers: LeversInput | None = None
    forces: ForcesInput | None = None

    @model_validator(mode="after")
    def _something(self) -> ForkliftInput:
        if not self.stages:
            raise ValueError(
                "no stage is complete: give [truck] and [stop] for the vehicle, [brake] for the kinematics, "
                "[forces] with [brake] or [levers] for the forces"
            )
        if self.brake is not None and self.levers is not None:
            raise ValueError("[brake] and [levers] do not go together: the arms follow from the geometry")
        f = self.forces
        if f is not None and "vehicle" not in self.stages and f.torque is None and f.lining_friction is None:
            raise ValueError(
                "[forces]: give torque or lining_friction, or [truck] and [stop], which give the torque"
            )
        return self

    @property
    def stages(self) -> tuple[StageName, ...]:
        """The stages whose tables are there."""
        there = {
            "vehicle": self.truck is not None and self.stop is not None,
            "kinematics": self.brake is not None,
            "forces": self.forces is not None and (self.brake is not None or self.levers is not None),
        }
        return tuple(name for name in STAGES if there[name])

    def solve(
        self, stages: tuple[StageName, ...] | None = None, model: Model | None = None
    ) -> ForkliftAnswer:
        """What the stages find; those before them are computed where they are needed.

        Parameters
        ----------
        stages : tuple of str, optional
            Of "vehicle", "kinematics", "forces"; those whose tables are there if not given.
        model : {"corrected", "as_printed"}, optional
            In place of that of the file.

        Raises
        ------
        ValueError
            If a table is missing that a stage needs, or as for the functions of `brakes.forklift`.
        """
        wanted = self.stages if stages is None else stages
        self._require(wanted)
        with in_range():
            return self._solve(wanted, model)

    def _solve(self, wanted: tuple[StageName, ...], model: Model | None) -> ForkliftAnswer:
        stopped = self._stopped(model) if "vehicle" in wanted or self._torque_of_stop else None
        motion = None if self.brake is None or wanted == ("vehicle",) else self.brake.motion
        forces = self._forces(stopped, motion) if "forces" in wanted else None
        shown = stopped if "vehicle" in wanted else None
        return ForkliftAnswer(
            shown, motion if "kinematics" in wanted else None, forces, self._source if forces else ""
        )

    def _require(self, stages: tuple[StageName, ...]) -> None:
        for name in stages:
            if name not in self.stages:
                raise ValueError(f"the stage {name} needs the tables {_NEEDS[name]}")

    @property
    def _torque_of_stop(self) -> bool:
        return "vehicle" in self.stages and self.forces is not None and self.forces.torque is None

    @property
    def _source(self) -> str:
        if self.forces is not None and self.forces.torque is not None:
            return "the file"
        return "the stop" if self._torque_of_stop else "the lining's friction"

    def _stopped(self, model: Model | None) -> Stop:
        assert self.truck is not None and self.stop is not None
        return self.stop.solve(self.truck.core, model)

    def _forces(self, stopped: Stop | None, motion: ShoeMotion | None) -> InternalForces:
        assert self.forces is not None
        levers = motion.levers if motion is not None else self.levers and self.levers.core
        torque = self.forces.torque
        if torque is None and stopped is not None:
            torque = stopped.torque_per_brake
        assert levers is not None
        with of_file({"friction": "lining_friction"}):
            return internal_forces(
                levers,
                piston_force=self.forces.piston_force,
                torque=torque,
                friction=self.forces.lining_friction,
            )
