"""A forklift's brakes in TOML: [truck] and [stop], [brake] or [levers], [forces]; each stage alone or all."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from math import pi
from os import PathLike
from typing import Annotated, Any, Literal

from pydantic import model_validator

from beamdyn.common.edge.config import CoreSection, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.edge.wording import of_file
from brakes.forklift import DuoServo, Levers, ShoeMotion, StopConditions, Truck
from brakes.forklift.vehicle import STANDARD_GRAVITY

__all__ = [
    "STAGES",
    "ForkliftInput",
    "forklift_from_dict",
    "load_forklift",
    "parse_forklift",
]

StageName = Literal["vehicle", "kinematics", "forces"]
STAGES: tuple[StageName, ...] = ("vehicle", "kinematics", "forces")


def load_forklift(path: str | PathLike[str]) -> ForkliftInput:
    """Read a forklift's brakes from a TOML file.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    ForkliftInput
        What the file describes; `brakes.answers.forklift.solve_stages` solves it.

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


class StopInput(CoreSection):
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
    gravity: Annotated[float, Quantity("m/s2", symbol="g", meaning="gravity", above=0)] = STANDARD_GRAVITY

    @cached_property
    def core(self) -> StopConditions:
        """The conditions of the stop."""
        with of_file({}):
            return StopConditions(**dict(self))


class DuoServoInput(CoreSection):
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
        float, Quantity("m", meaning="travel of a piston from rest to its bottom, inward", above=0)
    ]
    piston_stroke: (
        Annotated[
            float,
            Quantity(
                "m",
                meaning="largest travel of a piston from rest, outward; if not given, not checked",
                above=0,
            ),
        ]
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
        """Motion of the shoes."""
        with of_file(_PINS):
            return self.core.move_shoes(self.clearance)


class LeversInput(CoreSection):
    """[levers]: lever arms and directions of the forces, where no geometry of the brake is known."""

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
    """[forces]: the inputs of the forces in one brake."""

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


class ForkliftInput(Section):
    """A forklift's brakes: [truck] and [stop], [brake] or [levers], [forces], as far as they are wanted."""

    truck: TruckInput | None = None
    stop: StopInput | None = None
    brake: DuoServoInput | None = None
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
