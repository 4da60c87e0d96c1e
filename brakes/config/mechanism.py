"""Calipers and planar mechanisms in TOML: a named caliper and its dimensions, or bodies, joints and loads."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from functools import cache, cached_property
from os import PathLike
from typing import Annotated, Any, Literal

from pydantic import Field, create_model

from beamdyn.common.described import described_hints, description
from beamdyn.common.edge.config import CoreSection, MissingValue, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.edge.sections import MadeSection, fields_of, section_of
from beamdyn.common.edge.units import InvalidInput, quantity, show
from brakes.calipers import NAMED, Caliper, StoppingDistance, stop
from brakes.planar import JOINTS, LOADS, Load, Mechanism, Part
from brakes.planar.inputs import DescribedDirection, DescribedPoint, is_list
from brakes.planar.points import Point as Coordinates

__all__ = [
    "CaliperInput",
    "MechanismInput",
    "load_mechanism",
    "mechanism_from_dict",
    "named",
    "parse_mechanism",
]


def load_mechanism(path: str | PathLike[str]) -> CaliperInput | MechanismInput:
    """Read a caliper or a mechanism from a TOML file.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    CaliperInput or MechanismInput
        A file with the key ``caliper = "name"`` is of the first kind.

    Raises
    ------
    ConfigError
        If there is no such file or it does not describe a mechanism; the message lists all mistakes.
    """
    return parse_mechanism(read(path), str(path))


def parse_mechanism(text: str, source: str = "mechanism") -> CaliperInput | MechanismInput:
    """Read a caliper or a mechanism from TOML text; see `load_mechanism`."""
    return mechanism_from_dict(parse(text, source), source)


def mechanism_from_dict(data: Mapping[str, Any], source: str = "mechanism") -> CaliperInput | MechanismInput:
    """A caliper or a mechanism from the tables of a TOML file; see `load_mechanism`."""
    name = data.get("caliper")
    if isinstance(name, str):
        return validated(_model_of(name) if name in NAMED else CaliperInput, data, source)
    return validated(CompleteMechanismInput, _with_points(data), source)


def named(name: str) -> CaliperInput:
    """A caliper of `calipers.NAMED` with its usual dimensions."""
    return validated(_model_of(name), {"caliper": name}, name)


# Kinds of values ----------------------------------------------------------------------------------


class PointQuantity(Quantity):
    """A point: two lengths."""

    def parse(self, given: object) -> Any:
        """Its coordinates [m]."""
        if isinstance(given, str):
            raise InvalidInput("", given, "no such point in [points]", 'name one, or give ["1 mm", "2 mm"]')
        return tuple(quantity(value, "m") for value in _two(given, '["1 mm", "2 mm"]'))


class DirectionQuantity(Quantity):
    """A direction: two numbers, or an angle from x anticlockwise."""

    def parse(self, given: object) -> Any:
        """Its components."""
        if isinstance(given, str):
            angle = quantity(given, "rad")
            return math.cos(angle), math.sin(angle)
        return tuple(Quantity().parse(value) for value in _two(given, '[1, 0] or "30 deg"'))


class Angle(float):
    """A travel that was given as an angle [rad]."""


class TravelQuantity(Quantity):
    """A travel: a length, or an angle where the driver is a moment."""

    def convert(self, given: object) -> float:
        """A length [m], or an `Angle` [rad]."""
        try:
            return Angle(quantity(given, "rad"))
        except ValueError:
            return quantity(given, "m")


def _two(given: object, example: str) -> list[Any]:
    if not isinstance(given, list) or len(given) != 2:
        raise InvalidInput("", given, f"give two values, e.g. {example}")
    return given


Point = Annotated[Coordinates, PointQuantity("m", meaning="point in the drawing")]
_QUANTITIES = {DescribedPoint: PointQuantity, DescribedDirection: DirectionQuantity}


# A caliper's run ----------------------------------------------------------------------------------


class RunInput(Section):
    """[run]: the stroke, the finger's force, and what else is to be computed."""

    finger: Annotated[float, Quantity("N", "P", "force of the finger on the hand lever", above=0)] = 40.0
    driver: Annotated[str | None, Field(description="load that drives a stroke of a plain mechanism")] = None
    travel: Annotated[float | None, TravelQuantity("m", "", "travel of the cable or of the driver")] = None
    points: Annotated[int, Field(description="positions of the stroke", ge=2)] = 100
    friction: Annotated[float, Quantity("", "mu", "coefficient of friction", least=0)] = 0.0
    wear: list[Annotated[float, Quantity("m", "", "thicknesses lost by each pad", least=0)]] = []  # noqa: RUF012


class CaliperStopInput(Section):
    """[stop]: the vehicle that this brake alone stops."""

    mass: Annotated[float, Quantity("kg", "M", "mass, wheels included", above=0)]
    speed: Annotated[float, Quantity("m/s", "v", "speed", least=0)]
    friction: Annotated[float, Quantity("", "mu", "friction of pads and rim", above=0)]
    wheel_inertia: Annotated[float, Quantity("kg m2", "J", "moment of inertia of all wheels", least=0)] = 0.0
    tyre_radius: Annotated[float | None, Quantity("m", "R", "rolling radius", above=0)] = None
    rim_radius: Annotated[float | None, Quantity("m", "r", "radius at the pads", above=0)] = None

    def with_force(self, pad_force: float) -> StoppingDistance:
        """The stopping distance with a force on each pad [N]."""
        return stop(pad_force=pad_force, **dict(self))


# A named caliper ----------------------------------------------------------------------------------


class DimensionsInput(MadeSection):
    """[dimensions] of a named caliper."""

    @cached_property
    def core(self) -> Caliper:
        """The caliper."""
        return self.made(**self.given).build()


class CaliperInput(Section):
    """A named caliper: its name, and where they differ its dimensions."""

    caliper: Annotated[
        Literal["eebrake", "single-pivot", "dual-pivot", "centre-pull", "cantilever", "v-brake"],
        Field(description="name"),
    ]
    title: Annotated[str, Field(description="title")] = ""
    run: RunInput = RunInput()
    stop: CaliperStopInput | None = None

    @property
    def core(self) -> Caliper:
        """The caliper."""
        built = self.dimensions.core  # pyright: ignore[reportAttributeAccessIssue]  (added by _model_of)
        return dataclasses.replace(built, name=self.title) if self.title else built


@cache
def _model_of(name: str) -> type[CaliperInput]:
    """The model of a caliper's file, with the dimensions of its design."""
    design = NAMED[name]
    dimensions = section_of(design, tables=_QUANTITIES, base=DimensionsInput)
    return create_model(
        f"{design.__name__}Input", __base__=CaliperInput, dimensions=(dimensions, dimensions())
    )


# Any mechanism ------------------------------------------------------------------------------------


SECTIONS = {part.key(): section_of(part, tables=_QUANTITIES) for part in (*JOINTS, *LOADS)}  # by table


class RolesInput(Section):
    """[caliper] of a mechanism: its centring joints, and what `Caliper` describes (added by `_Roles`)."""

    centring: Annotated[list[str], Field(description="joints that hold only until the pads touch")] = []  # noqa: RUF012


class MechanismInput(CoreSection):
    """Any mechanism: its bodies, joints and loads, and where it is a caliper its cable and pads.

    A list of tables for each kind of joint and load is added by `CompleteMechanismInput`.
    """

    title: Annotated[str, Field(description="title")] = "mechanism"
    bodies: Annotated[list[str], Field(description="names of the bodies; the ground is there by itself")]
    points: dict[str, Point] = {}  # noqa: RUF012
    caliper: RolesInput | None = None
    run: RunInput = RunInput()
    stop: CaliperStopInput | None = None

    @cached_property
    def core(self) -> Caliper | Mechanism:
        """The caliper, or the mechanism if it does not say which loads are cable and pads."""
        joints, loads = (
            [table.core for part in parts for table in getattr(self, part.key())] for parts in (JOINTS, LOADS)
        )
        self._check_run({load.name: load for load in loads})
        if self.caliper is None:
            return Mechanism(tuple(self.bodies), tuple(joints), tuple(loads))
        roles = self.caliper
        missing = [name for name in roles.centring if name not in {joint.name for joint in joints}]
        if missing:
            raise ValueError(f"caliper.centring: {missing[0]!r} is not a joint; name one of the joints")
        mechanism = Mechanism(
            tuple(self.bodies), tuple(j for j in joints if j.name not in roles.centring), tuple(loads)
        )
        centring = tuple(j for j in joints if j.name in roles.centring)
        given: dict[str, Any] = dict(roles)
        given |= {"centring": centring, "pads": tuple(given["pads"])}
        return Caliper(mechanism, **given, name=self.title)

    def _check_run(self, loads: Mapping[str, Load]) -> None:
        run = self.run
        if run.driver is None:
            if run.travel is not None and self.caliper is None:
                raise MissingValue("run.driver", None, "name the load that drives the stroke")
            return
        if run.driver not in loads:
            raise InvalidInput("run.driver", run.driver, "no such load", f"name one of {', '.join(loads)}")
        if run.travel is None:
            raise MissingValue("run.travel", None, "give the travel of the driver")
        turns = loads[run.driver].is_couple
        if turns != isinstance(run.travel, Angle):
            wanted = 'an angle, e.g. "10 deg"' if turns else 'a length, e.g. "3 mm"'
            bound, unit = f"the driver {show(run.driver)} moves by {wanted}", "m" if turns else "rad"
            raise InvalidInput("run.travel", float(run.travel), bound, unit=unit)


_ROLES = fields_of(Caliper, leave_out=("mechanism", "centring", "name"))
_Roles = create_model("_Roles", __base__=RolesInput, __module__=__name__, **_ROLES)
_TABLES: dict[str, Any] = {"caliper": (_Roles | None, None)} | {
    key: (list[section], []) for key, section in SECTIONS.items()
}
CompleteMechanismInput = create_model(
    "CompleteMechanismInput", __base__=MechanismInput, __module__=__name__, **_TABLES
)


def _with_points(data: Mapping[str, Any]) -> dict[str, Any]:
    """The tables with the names of points replaced by what [points] says of them."""
    points = data.get("points")
    known = points if isinstance(points, dict) else {}
    return dict(data) | {
        part.key(): [_table_with_points(table, part, known) for table in data[part.key()]]
        for part in (*JOINTS, *LOADS)
        if isinstance(data.get(part.key()), list)
    }


def _table_with_points(table: Any, part: type[Part], known: Mapping[str, Any]) -> Any:
    """The table of a joint or load with the names of points replaced; anything else as it is."""
    if not isinstance(table, dict):
        return table

    def place(value: Any) -> Any:
        return known.get(value, value) if isinstance(value, str) else value

    replaced = {}
    for key, hint in described_hints(part).items():
        if isinstance(description(hint), DescribedPoint) and key in table:
            many = is_list(hint) and isinstance(table[key], list)
            replaced[key] = [place(value) for value in table[key]] if many else place(table[key])
    return table | replaced
