"""The table [heat] of input files: repeated stops, and the mass that they heat."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from beamdyn.common.edge.config import CoreSection, fields_of, section_of
from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import InvalidInput, quantity
from brakes.common.heat import Duty, FrictionCurve

_SUCH_AS = 'such as [["20 degC", 0.4], ["300 degC", 0.3]]'


class CurveQuantity(Quantity):
    """An input that is a list of rows, each with a temperature and a friction coefficient."""

    @property
    def bounds(self) -> str:
        """An example of rows, for messages."""
        return _SUCH_AS

    def parse(self, given: object) -> Any:
        """Read rows of a temperature and a friction coefficient; return them as pairs, temperatures in K."""
        if not isinstance(given, list) or any(not isinstance(row, list) or len(row) != 2 for row in given):
            raise InvalidInput("", given, f"give rows {_SUCH_AS}")
        return tuple((quantity(at, "K"), Quantity(least=self.least).parse(mu)) for at, mu in given)


_TABLES = {FrictionCurve: CurveQuantity}
_OF_A_STOP = ("inertia", "speed", "heated_mass", "specific_heat", "load_torque", "free_angle", "most_pv")
REPEATED = fields_of(Duty, _TABLES, _OF_A_STOP)  # keys of [heat] in a file that describes the stop itself

if TYPE_CHECKING:
    HeatInput = CoreSection
else:
    HeatInput = section_of(Duty, tables=_TABLES)
