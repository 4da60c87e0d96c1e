"""A forklift's brakes in TOML: [truck] and [stop], [brake] or [levers], [forces]; each stage alone or all."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import create_model, model_validator

from beamdyn.common.edge.config import CoreSection, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section, SlopeQuantity
from beamdyn.common.edge.sections import MadeSection, fields_of, section_of
from beamdyn.common.edge.wording import of_file
from brakes.forklift import DuoServo, Levers, ShoeMotion, StopConditions, Truck
from brakes.vehicle import SlopeAngle

__all__ = ["STAGES", "ForkliftInput", "forklift_from_dict", "load_forklift", "parse_forklift"]

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
        Parts of the file; `brakes.answers.forklift.solve_stages` solves them.

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


class DuoServoInput(MadeSection):
    """[brake]: geometry of a duo-servo brake, the right side of it at rest; the left side mirrors it."""

    if TYPE_CHECKING:  # described by `DuoServo.move_shoes`
        clearance: float

    @property
    def motion(self) -> ShoeMotion:
        """Motion of the shoes."""
        with of_file(self.key_of):
            return self.core.move_shoes(self.clearance)


class LeversInput(MadeSection):
    """[levers]: lever arms and directions of the forces, where no geometry of the brake is known."""

    @cached_property
    def core(self) -> Levers:
        """The arms."""
        arms: Levers = super().core
        if abs(arms.b1 - arms.b2) > 1e-9 * arms.b1:
            raise ValueError(
                f"b1 = {arms.b1:g} m and b2 = {arms.b2:g} m differ: the adjuster's force Q has one line of "
                "action; give the same arm twice"
            )
        return arms


if TYPE_CHECKING:
    _TruckInput = CoreSection
    _StopInput = CoreSection
    _DuoServoInput = DuoServoInput
    _LeversInput = LeversInput
else:
    _TruckInput = section_of(Truck)
    _StopInput = section_of(StopConditions, tables={SlopeAngle: SlopeQuantity})
    _geometry = section_of(DuoServo, base=DuoServoInput)
    _DuoServoInput = create_model("_Brake", __base__=_geometry, **fields_of(DuoServo.move_shoes))
    _LeversInput = section_of(Levers, base=LeversInput)


class ForcesInput(Section):
    """[forces]: the inputs of the forces in one brake."""

    piston_force: Annotated[float, Quantity("N", "P_T", "force of the piston on the trailing shoe", above=0)]
    torque: Annotated[
        float | None, Quantity("N m", "T", "torque of one brake; if not given, that of the stop", above=0)
    ] = None
    lining_friction: Annotated[
        float | None,
        Quantity(
            "",
            "mu_l",
            "friction of the linings: compared with what the torque needs, or gives the torque",
            above=0,
            most=10,
            remedy="40 % is 0.4",
        ),
    ] = None


class ForkliftInput(Section):
    """A forklift's brakes: [truck] and [stop], [brake] or [levers], [forces], as far as they are wanted."""

    truck: _TruckInput | None = None
    stop: _StopInput | None = None
    brake: _DuoServoInput | None = None
    levers: _LeversInput | None = None
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
