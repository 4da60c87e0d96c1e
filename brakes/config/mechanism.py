"""Calipers and planar mechanisms in TOML: a named caliper and its dimensions, or bodies, joints and loads."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from functools import cache, cached_property
from os import PathLike
from typing import Annotated, Any, ClassVar, Literal

from pydantic import Field, create_model

from beamdyn.common.edge.config import CoreSection, MissingValue, parse, read, validated
from beamdyn.common.edge.inputs import Quantity, Section
from beamdyn.common.edge.units import InvalidInput, quantity, show
from brakes import planar
from brakes.calipers import NAMED, Caliper, Design, Stop, stop
from brakes.planar import GROUND, Mechanism
from brakes.planar.rows import Point as Coordinates

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
    return validated(MechanismInput, _with_points(data), source)


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
        """A vector."""
        if isinstance(given, str):
            angle = quantity(given, "rad")
            return math.cos(angle), math.sin(angle)
        return tuple(Quantity().parse(value) for value in _two(given, '[1, 0] or "30 deg"'))


class Turned(float):
    """A travel given as an angle [rad]."""


class TravelQuantity(Quantity):
    """A travel: a length, or an angle where the driver is a moment."""

    def convert(self, given: object) -> float:
        """A length [m], or `Turned`."""
        try:
            return Turned(quantity(given, "rad"))
        except ValueError:
            return quantity(given, "m")


def _two(given: object, example: str) -> list[Any]:
    if not isinstance(given, list) or len(given) != 2:
        raise InvalidInput("", given, f"give two values, e.g. {example}")
    return given


Point = Annotated[Coordinates, PointQuantity("m", meaning="point in the drawing")]
Direction = Annotated[Coordinates, DirectionQuantity(meaning="direction, as a vector or an angle")]
Name = Annotated[str, Field(description="name")]
Body = Annotated[str, Field(description="body")]
Other = Annotated[str, Field(description="other body; the ground if not given")]
Rubbing = Annotated[float, Quantity(symbol="mu", meaning="coefficient of friction", least=0)]
ForceSize = Annotated[float, Quantity("N", meaning="magnitude; unknown if not given")]
Length = Annotated[float, Quantity("m", meaning="length, if not the drawing's", above=0)]


# A caliper's run ----------------------------------------------------------------------------------


class RunInput(Section):
    """[run]: what is asked of it."""

    finger: Annotated[
        float, Quantity("N", symbol="P", meaning="force of the finger on the hand lever", above=0)
    ] = 40.0
    driver: Annotated[str | None, Field(description="load that drives a stroke of a plain mechanism")] = None
    travel: Annotated[float, TravelQuantity("m", meaning="travel of the cable or of the driver")] | None = (
        None
    )
    points: Annotated[int, Field(description="positions of the stroke", ge=2)] = 100
    friction: Rubbing = 0.0
    wear: list[Annotated[float, Quantity("m", meaning="thicknesses lost by each pad", least=0)]] = []  # noqa: RUF012


class StopInput(Section):
    """[stop]: a vehicle stopped by this brake alone."""

    mass: Annotated[float, Quantity("kg", symbol="M", meaning="mass, wheels included", above=0)]
    speed: Annotated[float, Quantity("m/s", symbol="v", meaning="speed", least=0)]
    friction: Annotated[float, Quantity(symbol="mu", meaning="friction of pads and rim", above=0)]
    wheel_inertia: Annotated[
        float, Quantity("kg m2", symbol="J", meaning="moment of inertia of all wheels", least=0)
    ] = 0.0
    tyre_radius: Annotated[float, Quantity("m", symbol="R", meaning="rolling radius", above=0)] | None = None
    rim_radius: Annotated[float, Quantity("m", symbol="r", meaning="radius at the pads", above=0)] | None = (
        None
    )

    def with_force(self, pad_force: float) -> Stop:
        """The stop with a force on each pad [N]."""
        return stop(pad_force=pad_force, **dict(self))


# A named caliper ----------------------------------------------------------------------------------


class DimensionsInput(CoreSection):
    """[dimensions] of a named caliper."""

    design: ClassVar[type[Design]]

    @cached_property
    def core(self) -> Caliper:
        """The caliper."""
        return self.design(**dict(self)).build()


class CaliperInput(Section):
    """A named caliper: its name, and where they differ its dimensions."""

    caliper: Annotated[
        Literal["eebrake", "single-pivot", "dual-pivot", "centre-pull", "cantilever", "v-brake"],
        Field(description="name"),
    ]
    title: Annotated[str, Field(description="title")] = ""
    run: RunInput = RunInput()
    stop: StopInput | None = None

    @property
    def core(self) -> Caliper:
        """The caliper."""
        built = self.dimensions.core  # pyright: ignore[reportAttributeAccessIssue]  (added by _model_of)
        return dataclasses.replace(built, name=self.title) if self.title else built


@cache
def _model_of(name: str) -> type[CaliperInput]:
    """The model of a caliper's file, with the dimensions of its design."""
    design = NAMED[name]
    fields: dict[str, Any] = {f.name: (_annotation(f), f.default) for f in dataclasses.fields(design)}
    dimensions = create_model(
        f"{design.__name__}Dimensions", __base__=DimensionsInput, __doc__=DimensionsInput.__doc__, **fields
    )
    dimensions.design = design
    return create_model(
        f"{design.__name__}Input",
        __base__=CaliperInput,
        __doc__=CaliperInput.__doc__,
        dimensions=(dimensions, dimensions()),
    )


def _annotation(field: dataclasses.Field[Any]) -> Any:
    """What a dimension is in a file."""
    unit, meaning = field.metadata.get("unit"), field.metadata["meaning"]
    if unit is None:
        return Annotated[Literal["equal force", "equal work"], Field(description=meaning)]
    if isinstance(field.default, tuple):
        return Annotated[Coordinates, PointQuantity(unit, meaning=meaning)]
    return Annotated[float, Quantity(unit, meaning=meaning)]


# Any mechanism ------------------------------------------------------------------------------------


class _Part(CoreSection):
    """A joint or load: its keys are those of the core's."""

    part: ClassVar[type]
    name: Name

    @cached_property
    def core(self) -> Any:
        """The joint or load."""
        return self.part(**dict(self))


class PinInput(_Part):
    """[[pin]]."""

    part = planar.Pin
    body: Body
    other: Other = GROUND
    at: Point
    at_other: Point | None = None
    radius: Annotated[float, Quantity("m", symbol="r", meaning="radius of the pivot", least=0)] = 0.0
    friction: Rubbing = 0.0


class BarInput(_Part):
    """[[bar]]."""

    part = planar.Bar
    body: Body
    other: Other = GROUND
    at: Point
    to: Point
    length: Length | None = None


class SlotInput(_Part):
    """[[slot]]."""

    part = planar.Slot
    body: Body
    other: Other = GROUND
    at: Point
    along: Direction
    on: Point | None = None
    friction: Rubbing = 0.0


class ContactInput(_Part):
    """[[contact]]."""

    part = planar.Contact
    body: Body
    other: Other = GROUND
    at: Point
    normal: Direction
    on: Point | None = None
    friction: Rubbing = 0.0


class RotationLockInput(_Part):
    """[[rotation_lock]]."""

    part = planar.RotationLock
    body: Body
    other: Other = GROUND
    ratio: Annotated[float, Quantity(meaning="ratio of the angles")] = 1.0


class CableInput(_Part):
    """[[cable]] of fixed length."""

    part = planar.Cable
    bodies: Annotated[list[str], Field(description="body of each point")]
    points: list[Point]
    length: Length | None = None

    @cached_property
    def core(self) -> planar.Cable:
        """The cable."""
        return planar.Cable(self.name, tuple(self.bodies), tuple(self.points), self.length)


class ForceInput(_Part):
    """[[force]]."""

    part = planar.Force
    body: Body
    at: Point
    direction: Direction
    magnitude: ForceSize | None = None
    follows: Annotated[bool, Field(description="whether it turns with the body")] = False


class MomentInput(_Part):
    """[[moment]]."""

    part = planar.Moment
    body: Body
    magnitude: Annotated[float, Quantity("N m", meaning="magnitude; unknown if not given")] | None = None
    other: Other = GROUND


class CablePairInput(_Part):
    """[[cable_pair]]: a cable and its housing."""

    part = planar.CablePair
    body: Body
    other: Other = GROUND
    at: Point
    to: Point
    magnitude: ForceSize | None = None


class SpringInput(_Part):
    """[[spring]]."""

    part = planar.Spring
    body: Body
    other: Other = GROUND
    at: Point
    to: Point
    stiffness: Annotated[float, Quantity("N/m", symbol="k", meaning="stiffness", least=0)]
    free_length: Annotated[float, Quantity("m", meaning="length without force", least=0)]


class TorsionSpringInput(_Part):
    """[[torsion_spring]]."""

    part = planar.TorsionSpring
    body: Body
    stiffness: Annotated[float, Quantity("N m/rad", symbol="k", meaning="stiffness", least=0)]
    free_angle: Annotated[float, Quantity("rad", meaning="angle without moment, from the drawing")]
    other: Other = GROUND


class RolesInput(Section):
    """[caliper] of a mechanism: which of its loads are the cable and the pads."""

    cable: Annotated[str, Field(description="load that closes the brake")]
    pads: Annotated[
        list[str], Field(description="forces on the right and left pad", min_length=2, max_length=2)
    ]
    centring: Annotated[list[str], Field(description="joints that hold only until the pads touch")] = []  # noqa: RUF012
    split: Annotated[
        Literal["equal force", "equal work"], Field(description="how the rim loads coupled pads")
    ] = "equal force"
    lever_ratio: Annotated[float, Quantity(meaning="travel of finger over cable", above=0)] = 4.0
    clearance: Annotated[float, Quantity("m", meaning="mean gap between pad and rim", above=0)] = 1.25e-3
    pivot_radius: Annotated[float, Quantity("m", meaning="radius of the pivots", least=0)] = 4e-3


_JOINTS = ("pin", "bar", "slot", "contact", "rotation_lock", "cable")
_LOADS = ("force", "moment", "cable_pair", "spring", "torsion_spring")


class MechanismInput(CoreSection):
    """Any mechanism: its bodies, joints and loads, and where it is a caliper its cable and pads."""

    title: Annotated[str, Field(description="title")] = "mechanism"
    bodies: Annotated[list[str], Field(description="names of the bodies; the ground is there by itself")]
    points: dict[str, Point] = {}  # noqa: RUF012
    pin: list[PinInput] = []  # noqa: RUF012
    bar: list[BarInput] = []  # noqa: RUF012
    slot: list[SlotInput] = []  # noqa: RUF012
    contact: list[ContactInput] = []  # noqa: RUF012
    rotation_lock: list[RotationLockInput] = []  # noqa: RUF012
    cable: list[CableInput] = []  # noqa: RUF012
    force: list[ForceInput] = []  # noqa: RUF012
    moment: list[MomentInput] = []  # noqa: RUF012
    cable_pair: list[CablePairInput] = []  # noqa: RUF012
    spring: list[SpringInput] = []  # noqa: RUF012
    torsion_spring: list[TorsionSpringInput] = []  # noqa: RUF012
    caliper: RolesInput | None = None
    run: RunInput = RunInput()
    stop: StopInput | None = None

    @cached_property
    def core(self) -> Caliper | Mechanism:
        """The caliper, or the mechanism if it does not say which loads are cable and pads."""
        joints, loads = (
            [p.core for kind in kinds for p in getattr(self, kind)] for kinds in (_JOINTS, _LOADS)
        )
        self._check_run([load.name for load in loads])
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
        rest = {key: value for key, value in roles if key not in ("centring", "pads")}
        return Caliper(mechanism, centring, pads=(roles.pads[0], roles.pads[1]), name=self.title, **rest)

    def _check_run(self, loads: list[str]) -> None:
        run = self.run
        if run.driver is None:
            if run.travel is not None and self.caliper is None:
                raise MissingValue("run.driver", None, "name the load that drives the stroke")
            return
        if run.driver not in loads:
            raise InvalidInput("run.driver", run.driver, "no such load", f"name one of {', '.join(loads)}")
        if run.travel is None:
            raise MissingValue("run.travel", None, "give the travel of the driver")
        turns = run.driver in [moment.name for moment in self.moment]
        if turns != isinstance(run.travel, Turned):
            wanted = 'an angle, e.g. "10 deg"' if turns else 'a length, e.g. "3 mm"'
            bound, unit = f"the driver {show(run.driver)} moves by {wanted}", "m" if turns else "rad"
            raise InvalidInput("run.travel", float(run.travel), bound, unit=unit)


def _with_points(data: Mapping[str, Any]) -> dict[str, Any]:
    """The tables with the names of points replaced by what [points] says of them."""
    points = data.get("points")
    known = points if isinstance(points, dict) else {}

    def place(value: Any) -> Any:
        return known.get(value, value) if isinstance(value, str) else value

    def of_part(table: Any) -> Any:
        if not isinstance(table, dict):
            return table
        found = {key: place(v) if key in ("at", "to", "on", "at_other") else v for key, v in table.items()}
        if isinstance(found.get("points"), list):
            found["points"] = [place(value) for value in found["points"]]
        return found

    return {
        key: [of_part(table) for table in value]
        if key in (*_JOINTS, *_LOADS) and isinstance(value, list)
        else value
        for key, value in data.items()
    }
