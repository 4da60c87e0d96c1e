"""Input files of a forklift's brakes: [truck] and [stop], [brake] or [levers], [forces]; some stages or all.

[pedal] and [line] replace a given piston force by the force of the driver's foot.
"""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import create_model, model_validator

from beamdyn.common.edge.config import CoreSection, MadeSection, fields_of, parse, read, section_of, validated
from beamdyn.common.edge.inputs import Quantity, Section, SlopeQuantity, of_file
from brakes.chain import Drums, HydraulicLine, Pedal
from brakes.config.load import REPEATED
from brakes.forklift import DuoServo, Levers, ShoeMotion, StopConditions, Truck
from brakes.vehicle.stop import STEEPEST, SlopeAngle

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
        The tables of the file; `brakes.answers.forklift.solve_stages` solves them.

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
    """Read a forklift's brakes from the tables of a TOML file; see `load_forklift`."""
    return validated(ForkliftInput, data, source)


class DuoServoInput(MadeSection):
    """Table [brake] of a file: geometry of a duo-servo brake's right side at rest; the left mirrors it."""

    if TYPE_CHECKING:  # this field is made from an argument of `DuoServo.move_shoes`
        clearance: float

    @property
    def motion(self) -> ShoeMotion:
        """Motion of the shoes at the file's clearance."""
        with of_file(self.key_of):
            return self.core.move_shoes(self.clearance)


class LeversInput(MadeSection):
    """Table [levers] of a file: lever arms and directions of the forces, for a brake of unknown geometry."""

    @cached_property
    def core(self) -> Levers:
        """Lever arms and directions of the forces; refuses different arms of the adjuster's force."""
        arms: Levers = super().core
        if abs(arms.b1 - arms.b2) > 1e-9 * arms.b1:
            raise ValueError(
                f"b1 = {arms.b1:g} m and b2 = {arms.b2:g} m differ: the adjuster's force Q has one line of "
                "action; give the same arm twice"
            )
        return arms


def _slope_of_road(**described: Any) -> SlopeQuantity:
    """Make the description of a slope in files, within the bounds of a road."""
    bounds: dict[str, Any] = {"above": None, "below": None, "least": -STEEPEST, "most": STEEPEST}
    return SlopeQuantity(**{**described, **bounds, "remedy": "no road is steeper"})


if TYPE_CHECKING:
    _TruckInput = CoreSection
    _StopInput = CoreSection
    _DuoServoInput = DuoServoInput
    _LeversInput = LeversInput
    _PedalInput = _LineInput = _DrumsInput = CoreSection
    _HeatInput = Section
else:
    _TruckInput = section_of(Truck)
    _StopInput = section_of(StopConditions, tables={SlopeAngle: _slope_of_road})
    _geometry = section_of(DuoServo, base=DuoServoInput)
    _DuoServoInput = create_model("_Brake", __base__=_geometry, **fields_of(DuoServo.move_shoes))
    _LeversInput = section_of(Levers, base=LeversInput)
    _PedalInput, _LineInput, _DrumsInput = (section_of(each) for each in (Pedal, HydraulicLine, Drums))
    _HeatInput = create_model("_Heat", __base__=Section, **REPEATED)


_BY_FOOT = "force of the piston on the trailing shoe; by [pedal] and [line] if given"
_PISTON = Quantity("N", "P_T", _BY_FOOT, above=0)
_TORQUE = Quantity("N m", "T", "torque of one brake; if not given, that of the stop", above=0)
_COMPARED = "friction of the linings: gives the torque, or is compared with what a given torque needs"
_LINING = Quantity("", "mu_l", _COMPARED, above=0, most=10, remedy="40 % is 0.4")


class ForcesInput(Section):
    """Table [forces] of a file: piston force, torque and lining friction for the forces in one brake."""

    piston_force: Annotated[float | None, _PISTON] = None
    torque: Annotated[float | None, _TORQUE] = None
    lining_friction: Annotated[float | None, _LINING] = None


class ForkliftInput(Section):
    """File of a forklift's brakes: [truck] and [stop], [brake] or [levers], [forces], for the stages wanted.

    [pedal], [line], [drums] and [heat] need the tables of the stages vehicle and forces.
    """

    truck: _TruckInput | None = None
    stop: _StopInput | None = None
    brake: _DuoServoInput | None = None
    levers: _LeversInput | None = None
    forces: ForcesInput | None = None
    pedal: _PedalInput | None = None
    line: _LineInput | None = None
    drums: _DrumsInput | None = None
    heat: _HeatInput | None = None

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
        if self.pedal or self.line or self.drums or self.heat:
            self._refuse_half_a_chain()
        elif f is not None and f.piston_force is None:
            raise ValueError("[forces]: give piston_force, or [pedal] and [line], which give it")
        if f is not None and "vehicle" not in self.stages and f.torque is None and f.lining_friction is None:
            raise ValueError(
                "[forces]: give torque or lining_friction, or [truck] and [stop], which give the torque"
            )
        return self

    def _refuse_half_a_chain(self) -> None:
        f = self.forces
        if f is None or not (self.pedal and self.line and {"vehicle", "forces"} <= {*self.stages}):
            raise ValueError(
                "[pedal], [line], [drums] and [heat] go with a stop: give [pedal], [line], [truck], [stop], "
                "[forces] with lining_friction, and [brake] or [levers]"
            )
        if self.heat and not self.drums:
            raise ValueError("[heat] needs [drums], the drums that are heated: give [drums]")
        if f.piston_force is not None or f.torque is not None or f.lining_friction is None:
            raise ValueError(
                "[forces]: with [pedal] give lining_friction alone: piston_force and torque follow from it"
            )

    @property
    def stages(self) -> tuple[StageName, ...]:
        """The stages whose tables are in the file."""
        there = {
            "vehicle": self.truck is not None and self.stop is not None,
            "kinematics": self.brake is not None,
            "forces": self.forces is not None and (self.brake is not None or self.levers is not None),
        }
        return tuple(name for name in STAGES if there[name])
