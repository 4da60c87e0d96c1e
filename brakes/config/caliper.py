"""Input files of named calipers: dimensions that determine the mechanism, stroke, and stop."""

from __future__ import annotations

import dataclasses
import math
from functools import cache, cached_property
from typing import TYPE_CHECKING, Annotated, Any, Literal

from pydantic import ConfigDict, Field, create_model

from beamdyn.common.edge.config import CoreSection, MadeSection, fields_of, section_of, validated
from beamdyn.common.edge.inputs import Quantity, Section, WholeNumber
from beamdyn.common.edge.units import InvalidInput, quantity
from brakes.calipers import NAMED, Caliper, Stance, StoppingDistance, stop
from brakes.planar.part import DescribedDirection, DescribedPoint
from brakes.planar.rows import Point as Coordinates

SHORT_TEXTS = ConfigDict(str_max_length=200)  # limits titles and names, as drawings show them

# Inputs that are points, directions or travels ----------------------------------------------------


_FARTHEST = 1e6  # largest coordinate of a mechanism [m], larger than any real one


class PointQuantity(Quantity):
    """An input that is a point: two lengths."""

    def parse(self, given: object) -> Any:
        """Read a point, given as two lengths, and return its coordinates x, y [m]."""
        if isinstance(given, str):
            raise InvalidInput("", given, "no such point in [points]", 'name one, or give ["1 mm", "2 mm"]')
        point = tuple(quantity(value, "m") for value in _two(given, '["1 mm", "2 mm"]'))
        if max(map(abs, point)) > _FARTHEST:
            bound = f"give coordinates of at most {_FARTHEST:g} m either way"
            raise InvalidInput("", given, bound, "check their units")
        return point


class DirectionQuantity(Quantity):
    """An input that is a direction: two numbers, or an angle from x, anticlockwise."""

    def parse(self, given: object) -> Any:
        """Read a direction, given as two numbers or an angle; return x and y components, not normalised."""
        if isinstance(given, str):
            angle = quantity(given, "rad")
            return math.cos(angle), math.sin(angle)
        return tuple(Quantity().parse(value) for value in _two(given, '[1, 0] or "30 deg"'))


class Angle(float):
    """A travel that is an angle [rad]."""


class TravelQuantity(Quantity):
    """An input that is a travel: a length, or an angle if the driver is a moment."""

    def convert(self, given: object) -> float:
        """Return the travel as a length [m], or as an `Angle` [rad]."""
        try:
            return Angle(quantity(given, "rad"))
        except ValueError:
            return quantity(given, "m")


def _two(given: object, example: str) -> list[Any]:
    if not isinstance(given, list) or len(given) != 2:
        raise InvalidInput("", given, f"give two values, e.g. {example}")
    return given


Point = Annotated[Coordinates, PointQuantity("m", meaning="point in the drawing")]
QUANTITIES = {DescribedPoint: PointQuantity, DescribedDirection: DirectionQuantity}


# The stroke of a caliper, and the stop ------------------------------------------------------------


_DRIVER = Field(
    description="load that drives a mechanism without [caliper]; in squeezing, it moves in its own direction"
)
_FRICTION = Quantity("", "mu", "friction coefficient of pins for which none is given", least=0, most=10)
_Loss = Annotated[float, Quantity("m", "", "thicknesses lost by each pad", least=0)]


class RunInput(Section):
    """Table [run] of a file: the stroke, the finger's force, friction, and wear of the pads."""

    finger: Annotated[float, Quantity("N", "P", "force of the finger on the hand lever", above=0)] = 40.0
    driver: Annotated[str | None, _DRIVER] = None
    travel: Annotated[float | None, TravelQuantity("m", "", "travel of the cable or of the driver")] = None
    points: Annotated[int, WholeNumber(meaning="positions of the stroke", least=2, most=2000)] = 100
    friction: Annotated[float, _FRICTION] = 0.0
    wear: Annotated[list[_Loss], Field(max_length=100)] = []  # noqa: RUF012


class _StopInput(CoreSection):
    """Table [stop] of a file: the vehicle that this one brake stops; the inputs of `stop` and `Stance`."""

    @cached_property
    def core(self) -> StoppingDistance:
        """The stop without pad force, computed to check the inputs."""
        return self.with_force(0.0)

    def with_force(self, pad_force: float) -> StoppingDistance:
        """Compute the stop with a force on each pad [N]."""
        stance = Stance(**{key: getattr(self, key) for key in _STANCE})
        return stop(pad_force=pad_force, stance=stance, **{key: getattr(self, key) for key in _STOP})


_STOP, _STANCE = fields_of(stop, leave_out=("pad_force", "stance")), fields_of(Stance)

if TYPE_CHECKING:
    CaliperStopInput = _StopInput
else:
    CaliperStopInput = create_model(
        "CaliperStopInput", __base__=_StopInput, __module__=__name__, **_STOP, **_STANCE
    )


# A named caliper ----------------------------------------------------------------------------------


class DimensionsInput(MadeSection):
    """Table [dimensions] of a named caliper, with the lengths that differ from the usual values."""

    @cached_property
    def core(self) -> Caliper:
        """The caliper with these dimensions."""
        return self.made(**self.given).build()


_Name = Literal["eebrake", "single-pivot", "dual-pivot", "centre-pull", "cantilever", "v-brake"]


class CaliperInput(Section):
    """File of a named caliper: name, and dimensions that differ from the usual values."""

    model_config = SHORT_TEXTS

    caliper: Annotated[_Name, Field(description="name")]
    title: Annotated[str, Field(description="title")] = ""
    run: RunInput = RunInput()
    stop: CaliperStopInput | None = None

    @property
    def core(self) -> Caliper:
        """The caliper with the dimensions of the file."""
        built = self.dimensions.core  # pyright: ignore[reportAttributeAccessIssue]  (added by model_of)
        return dataclasses.replace(built, name=self.title) if self.title else built


@cache
def model_of(name: str) -> type[CaliperInput]:
    """Make the description of the file of a named caliper, with the dimensions of its design."""
    design = NAMED[name]
    made = section_of(design, tables=QUANTITIES, base=DimensionsInput)
    return create_model(f"{design.__name__}Input", __base__=CaliperInput, dimensions=(made, made()))


def named(name: str) -> CaliperInput:
    """Make the input of a named caliper with its usual dimensions."""
    return validated(model_of(name), {"caliper": name}, name)
