"""Input files of vehicles on a slope: vehicle, road, shares of braking, stop, and parking brake."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated

from pydantic import Field, model_validator

from beamdyn.common.edge.config import CoreSection, section_of
from beamdyn.common.edge.inputs import Quantity, Section, SlopeQuantity
from brakes.chain import BrakeCable, HydraulicLine, Pedal, WheelBrakes
from brakes.vehicle import Approach, Road, Truck, Vehicle
from brakes.vehicle.axles import Braked
from brakes.vehicle.stop import SlopeAngle

__all__ = ["VehicleInput"]


_OF_FRONT = "share of the front wheels in the braking force"
_SHARE = Quantity("", "phi", _OF_FRONT, least=0, most=1, remedy="60 % is 0.6")


class BrakingInput(Section):
    """Table [braking] of a file: front wheels' share of the force, and axles that the parking brake holds."""

    front_share: Annotated[float, _SHARE]
    parked_by: Annotated[Braked, Field(description="axles whose wheels the parking brake holds")] = "both"


if TYPE_CHECKING:
    _TruckInput = _VehicleInput = _RoadInput = _ApproachInput = CoreSection
    _LeverInput = _CableInput = _LineInput = _BrakesInput = CoreSection
else:
    _TruckInput, _VehicleInput = section_of(Truck), section_of(Vehicle)
    _RoadInput = section_of(Road, tables={SlopeAngle: SlopeQuantity})
    _LeverInput, _CableInput, _ApproachInput = map(section_of, (Pedal, BrakeCable, Approach))
    _LineInput, _BrakesInput = section_of(HydraulicLine), section_of(WheelBrakes)


class VehicleInput(Section):
    """File of a vehicle on a slope: [truck] or [vehicle], [road], [braking], [stop], and its parking brake.

    The parking brake needs [lever], [cable] or [line], and [brakes].
    """

    truck: _TruckInput | None = None
    vehicle: _VehicleInput | None = None
    road: _RoadInput
    braking: BrakingInput
    stop: _ApproachInput | None = None
    lever: _LeverInput | None = None
    cable: _CableInput | None = None
    line: _LineInput | None = None
    brakes: _BrakesInput | None = None

    @model_validator(mode="after")
    def _whole(self) -> VehicleInput:
        if (self.truck is None) == (self.vehicle is None):
            raise ValueError("give either [truck], which has a load, or [vehicle]")
        if self.cable is not None and self.line is not None:
            raise ValueError("[cable] and [line] do not go together: one of them carries the lever's force")
        given = [part is not None for part in (self.lever, self.cable or self.line, self.brakes)]
        if any(given) and not all(given):
            raise ValueError("[lever], [cable] or [line], and [brakes] go together: give all three or none")
        return self

    @property
    def standing(self) -> Vehicle:
        """The vehicle with its load, as two axles and a centre of gravity."""
        if self.truck is not None:
            return self.truck.core.vehicle
        assert self.vehicle is not None
        return self.vehicle.core
