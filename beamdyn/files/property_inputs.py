"""Values of scene files that vary along the beam: constants, polynomials in x/L and tables over stations."""

from __future__ import annotations

from typing import Any

from numpy.polynomial import Polynomial
from pydantic import GetCoreSchemaHandler
from pydantic_core import CoreSchema, core_schema

from beamdyn.common.edge.inputs import Quantity
from beamdyn.common.edge.units import quantity
from beamdyn.scene.profile import Table

Along = float | Polynomial | Table  # a property along the beam


class Metres(float):
    """A position given as a length, which becomes a fraction when the length of the beam is known."""


class Position(Quantity):
    """A position along the beam: a bare fraction x/L or a length with its unit."""

    def convert(self, given: object) -> float:
        """A fraction, or `Metres`."""
        return Metres(quantity(given, "m")) if isinstance(given, str) else super().convert(given)


_STATION = Position(meaning="position along the beam, as a fraction x/L or a length")
BREAKPOINT = Position(meaning="places where a property jumps or has a kink, as fractions x/L or lengths")


class Varying(Quantity):
    """A quantity that is constant, a polynomial in x/L or a table over stations."""

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        constant = core_schema.no_info_plain_validator_function(self.parse)
        coefficient = core_schema.no_info_plain_validator_function(self.convert)
        station = core_schema.no_info_plain_validator_function(_STATION.parse)
        return core_schema.tagged_union_schema(
            {
                "<constant>": constant,
                "<polynomial>": _table(_polynomial, polynomial=coefficient),
                "<table>": _table(_stations, stations=station, values=constant),
                "<column>": core_schema.is_instance_schema(Table),
            },
            discriminator=_kind_of_variation,
            custom_error_type="variation",
            custom_error_message="give a number with a unit, { polynomial = [...] } in powers of x/L, "
            "or { stations = [...], values = [...] }",
        )


def _table(build: Any, **lists: CoreSchema) -> CoreSchema:
    """Schema of an inline table of lists, from which something is built."""
    fields = {
        name: core_schema.typed_dict_field(core_schema.list_schema(item, strict=True, min_length=1))
        for name, item in lists.items()
    }
    table = core_schema.typed_dict_schema(fields, extra_behavior="forbid")
    return core_schema.no_info_after_validator_function(build, table)


def _polynomial(given: dict[str, list[float]]) -> Polynomial:
    return Polynomial(given["polynomial"])


def _stations(given: dict[str, list[float]]) -> Table:
    return Table(tuple(given["stations"]), tuple(given["values"]))


def _kind_of_variation(given: Any) -> str | None:
    if isinstance(given, Table):  # a column of beam.stations
        return "<column>"
    if not isinstance(given, dict):
        return None if isinstance(given, list) else "<constant>"
    kinds = {"<polynomial>": {"polynomial"}, "<table>": {"stations", "values"}}
    return next((kind for kind, keys in kinds.items() if keys & given.keys()), None)
