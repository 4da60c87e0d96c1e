"""Tables of input files that all brakes share: load, direction, friction, and repeated stops."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Any, ClassVar, Literal

from pydantic import Field, model_validator

from beamdyn.common.edge.config import CoreSection, fields_of, section_of
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.edge.units import InvalidInput, quantity
from brakes.common.heat import Duty, FrictionCurve
from brakes.common.loads import wheel_cylinder_force

_DIRECTION = Field(description="direction of the drum")
_FRICTION = Quantity("", "mu", "friction of the linings", least=0, most=10, remedy="35 % is 0.35")
_FORCE = Quantity("N", "P", "actuating force: on each shoe, pad or lever", above=0)
_BORE = Quantity("m", "d", "bore of the cylinder, with line_pressure in place of a force", above=0)
_PRESSURE = Quantity("Pa", "p_h", "pressure in the line, with cylinder_bore", above=0)
_TORQUE = Quantity("N m", "M", "torque that the brake is to give, in place of a force", above=0)
_PEAK = Quantity("Pa", "p_max", "largest pressure on any lining, in place of a force", above=0)


class RubbingInput(Section):
    """Table [brake] of a file: direction of rotation, and friction of the linings."""

    direction: Annotated[Literal["forward", "reverse"], _DIRECTION] = "forward"
    friction: Annotated[float, _FRICTION]


class LoadInput(Section):
    """Table [load] of a file: actuating force, or the wanted torque or pressure."""

    force: Annotated[float | None, _FORCE] = None
    cylinder_bore: Annotated[float | None, _BORE] = None
    line_pressure: Annotated[float | None, _PRESSURE] = None
    torque: Annotated[float | None, _TORQUE] = None
    peak_pressure: Annotated[float | None, _PEAK] = None

    ONE: ClassVar[str] = "give one of force, torque, peak_pressure, or cylinder_bore with line_pressure"

    @model_validator(mode="after")
    def _one(self) -> LoadInput:
        given = [name for name, value in self if value is not None]
        if given not in (["force"], ["cylinder_bore", "line_pressure"], ["torque"], ["peak_pressure"]):
            raise ValueError(f"{self.ONE}; got {' and '.join(given) or 'none'}")
        return self

    @property
    def given(self) -> dict[str, Any]:
        """The load as the keyword argument of the function that solves the brake."""
        if self.line_pressure is not None:
            return {"force": wheel_cylinder_force(self.cylinder_bore, self.line_pressure)}
        return {name: value for name, value in self if value is not None}


_SUCH_AS = 'such as [["20 degC", 0.4], ["300 degC", 0.3]]'


class CurveQuantity(Quantity):
    """An input that is a list of rows, each with a temperature and a friction coefficient."""

    is_list = True

    @property
    def bounds(self) -> str:
        """An example of rows, which messages show in place of bounds."""
        return _SUCH_AS

    def parse(self, given: object) -> Any:
        """Read rows of a temperature and a friction coefficient; return them as pairs, temperatures in K."""
        if not isinstance(given, list) or any(not isinstance(row, list) or len(row) != 2 for row in given):
            raise InvalidInput("", given, f"give rows {_SUCH_AS}")
        return tuple((quantity(at, "K"), Quantity(least=self.least).parse(mu)) for at, mu in given)


_TABLES = {FrictionCurve: CurveQuantity}
_OF_A_STOP = ("inertia", "speed", "heated_mass", "specific_heat", "load_torque", "free_angle", "most_pv")
# Keys of [heat] in a forklift's file: fields of `Duty`, but not those in `_OF_A_STOP`, because other tables
# of that file describe the stop.
REPEATED = fields_of(Duty, _TABLES, _OF_A_STOP)

if TYPE_CHECKING:
    HeatInput = CoreSection
else:
    HeatInput = section_of(Duty, tables=_TABLES)
