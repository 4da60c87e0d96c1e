"""Input files of planar mechanisms: bodies, joints and loads, or a named caliper."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping
from functools import cache, cached_property
from os import PathLike
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from pydantic import ConfigDict, Field, create_model

from beamdyn.common.edge import config
from beamdyn.common.edge.config import CoreSection, MadeSection, fields_of, section_of, validated
from beamdyn.common.edge.inputs import Input, Quantity, Section, WholeNumber, describe
from beamdyn.common.edge.units import InvalidInput, quantity, show
from beamdyn.common.inputs.described import described_hints, description, descriptions
from brakes.calipers import NAMED, Caliper, Stance, StoppingDistance, stop
from brakes.planar import JOINTS, LOADS, Load, Mechanism
from brakes.planar.part import DescribedDirection, DescribedPoint, is_list
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


# Files of mechanisms -----------------------------------------------------------------------------------


def load_mechanism(path: str | PathLike[str]) -> CaliperInput | MechanismInput:
    """Read a caliper or a mechanism from a TOML file.

    Parameters
    ----------
    path : str or path-like
        The file.

    Returns
    -------
    CaliperInput or MechanismInput
        The input; a file with the key ``caliper = "name"`` is a `CaliperInput`.

    Raises
    ------
    ConfigError
        If there is no such file or it does not describe a mechanism; the message lists all mistakes.
    """
    return parse_mechanism(config.read(path), str(path))


def parse_mechanism(text: str, source: str = "mechanism") -> CaliperInput | MechanismInput:
    """Read a caliper or a mechanism from TOML text; see `load_mechanism`."""
    return mechanism_from_dict(config.parse(text, source), source)


def mechanism_from_dict(data: Mapping[str, Any], source: str = "mechanism") -> CaliperInput | MechanismInput:
    """Read a caliper or a mechanism from the tables of a TOML file; see `load_mechanism`."""
    name = data.get("caliper")
    if isinstance(name, str):
        return config.validated(model_of(name) if name in NAMED else CaliperInput, data, source)
    return config.validated(CompleteMechanismInput, _with_points(data), source)


# Any mechanism ------------------------------------------------------------------------------------


class PartSection(config.MadeSection):
    """A table that describes a joint or a load."""

    model_config = SHORT_TEXTS


SECTIONS = {  # sections by the name of the table
    part.key(): config.section_of(part, tables=QUANTITIES, base=PartSection) for part in (*JOINTS, *LOADS)
}


class RolesInput(Section):
    """Table [caliper] of a mechanism's file: names of its centring joints.

    A class derived from this one adds the cable, the pads and the other inputs of `Caliper`.
    """

    centring: Annotated[list[str], Field(description="joints that hold only until the pads touch")] = []  # noqa: RUF012


class MechanismInput(config.CoreSection):
    """File of a mechanism: bodies, joints and loads; if it is a caliper, also its cable and pads.

    `CompleteMechanismInput` adds a list of tables for each kind of joint and load.
    """

    model_config = SHORT_TEXTS

    title: Annotated[str, Field(description="title")] = "mechanism"
    bodies: Annotated[list[str], Field(description="names of the bodies; the ground always exists")]
    points: dict[str, Point] = {}  # noqa: RUF012
    caliper: RolesInput | None = None
    run: RunInput = RunInput()
    stop: CaliperStopInput | None = None

    @cached_property
    def core(self) -> Caliper | Mechanism:
        """The caliper, or the mechanism if the file does not name cable and pads among the loads."""
        joints, loads = (
            [table.core for part in parts for table in getattr(self, part.key())] for parts in (JOINTS, LOADS)
        )
        self._check_run({load.name: load for load in loads})
        if self.caliper is None:
            friction = self.run.friction
            try:  # pins without a friction coefficient have that of [run]
                joints = [joint.with_pivot(0.0, friction) for joint in joints] if friction else joints
            except ValueError as error:
                bound = f"it is that of every pin; {error}"
                raise InvalidInput("run.friction", friction, bound) from None
            made = Mechanism(tuple(self.bodies), tuple(joints), tuple(loads))
            if friction and not made.friction:
                bound = "it is for pins, and there are no pins; give friction at the slot or contact"
                raise InvalidInput("run.friction", friction, bound)
            rubs = made.friction or "friction" in self.run.model_fields_set  # true also if a sweep sets 0
            if self.run.driver is not None and self.run.travel is None and not rubs:
                remedy = "give the travel of the driver, or leave out driver"
                raise config.MissingValue("run.travel", None, remedy)
            return made
        roles = self.caliper
        missing = [name for name in roles.centring if name not in {joint.name for joint in joints}]
        if missing:
            raise ValueError(f"caliper.centring: {missing[0]!r} is not a joint; name one of the joints")
        lasting = tuple(joint for joint in joints if joint.name not in roles.centring)
        centring = tuple(joint for joint in joints if joint.name in roles.centring)
        given: dict[str, Any] = dict(roles)
        given |= {"centring": centring, "pads": tuple(given["pads"])}
        return Caliper(Mechanism(tuple(self.bodies), lasting, tuple(loads)), **given, name=self.title)

    def _check_run(self, loads: Mapping[str, Load]) -> None:
        """Refuse a stroke without a driver, an unknown driver, and a travel that does not suit the driver."""
        run = self.run
        if run.driver is None:
            if run.travel is not None and self.caliper is None:
                raise config.MissingValue("run.driver", None, "name the load that drives the stroke")
            return
        if run.driver not in loads:
            raise InvalidInput("run.driver", run.driver, "no such load", f"name one of {', '.join(loads)}")
        if run.travel is None:
            return
        turns = loads[run.driver].is_couple
        if turns != isinstance(run.travel, Angle):
            wanted = 'an angle, e.g. "10 deg"' if turns else 'a length, e.g. "3 mm"'
            bound, unit = f"the driver {show(run.driver)} moves by {wanted}", "m" if turns else "rad"
            raise InvalidInput("run.travel", float(run.travel), bound, unit=unit)


_ROLES = config.fields_of(Caliper, leave_out=("mechanism", "centring", "name"))
_Roles = create_model("_Roles", __base__=RolesInput, __module__=__name__, **_ROLES)
_TABLES: dict[str, Any] = {"caliper": (_Roles | None, None)} | {
    key: (list[section], []) for key, section in SECTIONS.items()
}
CompleteMechanismInput = create_model(
    "CompleteMechanismInput", __base__=MechanismInput, __module__=__name__, **_TABLES
)


def _with_points(data: Mapping[str, Any]) -> dict[str, Any]:
    """Replace names of points in tables by coordinates from [points]."""
    points = data.get("points")
    known = points if isinstance(points, dict) else {}

    def place(value: Any, many: bool = False) -> Any:
        if many and isinstance(value, list):
            return [place(each) for each in value]
        return known.get(value, value) if isinstance(value, str) else value

    made = dict(data)
    for part in (*JOINTS, *LOADS):
        hints = described_hints(part).items()
        many = {key: is_list(hint) for key, hint in hints if isinstance(description(hint), DescribedPoint)}
        if isinstance(tables := data.get(part.key()), list):
            made[part.key()] = [
                table | {key: place(table[key], many[key]) for key in many if key in table}
                if isinstance(table, dict)
                else table
                for table in tables
            ]
    return made


# Descriptions of the inputs of calipers and mechanisms for forms and sweeps, and calipers as TOML -------


# Help text of each kind of joint or load, by the name of its table: its required, then its optional keys.
PARTS: dict[str, str] = {}
for _part in (*JOINTS, *LOADS):
    _keys: dict[bool, list[str]] = {True: [], False: []}
    for _key, _described in descriptions(_part).items():
        _otherwise = _described.meaning.partition("; ")[2]  # a phrase such as "the ground if not given"
        _required = SECTIONS[_part.key()].model_fields[_key].is_required()
        _keys[_required].append(f"{_key} ({_otherwise})" if _otherwise else _key)
    PARTS[_part.key()] = f"{_part.label}: {'; '.join(', '.join(some) for some in _keys.values() if some)}"


def inputs_of_tables(tables: Mapping[str, Any]) -> list[Input]:
    """Return the inputs of the caliper or mechanism that the tables of a file describe.

    A caliper without dimensions has the inputs that all calipers have; a mechanism has an input for each
    point, for each list of joints or loads, and for each key outside of these.
    """
    name, points = tables.get("caliper"), tables.get("points")
    if isinstance(name, str):
        return describe(type(named(name)) if name in NAMED else CaliperInput)

    def made(path: str, kind: Any, quantity: Quantity, required: bool = False) -> Input:
        return Input(path, CompleteMechanismInput, kind, quantity, (), required, None if required else [])

    every = describe(CompleteMechanismInput)
    rest = {entry.path: entry for entry in every if _table(entry.path) not in ("points", *PARTS)}
    place = PointQuantity("m", meaning="point in the drawing")
    return [
        rest.pop("title"),
        rest.pop("bodies"),
        *(
            made(f"points.{at}", Coordinates, place, True)
            for at in (points if isinstance(points, dict) else ())
        ),
        *(made(part, list[dict], Quantity(meaning=words)) for part, words in PARTS.items()),
        *rest.values(),
    ]


def _table(path: str) -> str:
    """Return the name of the table in an input's path."""
    return path.partition(".")[0]


def idle_inputs(entries: Mapping[str, str]) -> list[str]:
    """Return paths of inputs that only calipers use, if a form's entries describe another mechanism."""
    if any(text.strip() for path, text in entries.items() if _table(path) == "caliper"):
        return []
    stops = [path for path in entries if _table(path) == "stop"]
    stops = [] if any(entries[path].strip() for path in stops) else stops
    return ["run.finger", "run.wear", *stops]


def named_text(name: str) -> str:
    """Write a named caliper as TOML text, with all its dimensions, lengths in mm."""
    lines = [f"caliper = {show(named(name).caliper)}", "", "[dimensions]"]
    for entry in inputs_of_tables({"caliper": name}):
        if entry.path.startswith("dimensions."):
            default: Any = entry.default
            if entry.quantity.unit == "m":
                lengths = [f'"{1e3 * part:.12g} mm"' for part in np.ravel(default).tolist()]
                value = f"[{', '.join(lengths)}]" if isinstance(default, tuple) else lengths[0]
            else:
                value = show(default)
            lines.append(f"{entry.name} = {value}")
    return "\n".join(lines) + "\n"
