"""Any planar mechanism in TOML: bodies, joints and loads, their inputs, and whether it is a named caliper."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from functools import cached_property
from os import PathLike
from typing import Annotated, Any

from pydantic import Field, create_model

from beamdyn.common.edge.config import CoreSection, MissingValue, parse, read, validated
from beamdyn.common.edge.inputs import Input, Quantity, Section, describe
from beamdyn.common.edge.sections import MadeSection, fields_of, section_of
from beamdyn.common.edge.units import InvalidInput, show
from beamdyn.common.edge.wording import in_small_units
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import described_hints, description, descriptions
from brakes.calipers import NAMED, Caliper
from brakes.config.caliper import (
    QUANTITIES,
    SHORT_TEXTS,
    Angle,
    CaliperInput,
    CaliperStopInput,
    Point,
    PointQuantity,
    RunInput,
    model_of,
    named,
)
from brakes.planar import JOINTS, LOADS, Joint, Load, Mechanism, Part
from brakes.planar.part import DescribedPoint, is_list
from brakes.planar.rows import Point as Coordinates


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
        return validated(model_of(name) if name in NAMED else CaliperInput, data, source)
    return validated(CompleteMechanismInput, _with_points(data), source)


# Any mechanism ------------------------------------------------------------------------------------


class PartSection(MadeSection):
    """Table of a joint or load; its refusals say where it is in millimetres, as the file does."""

    model_config = SHORT_TEXTS

    @cached_property
    def core(self) -> Part:
        """The joint or load."""
        try:
            return super().core
        except InvalidValue:  # it is put into the file's words where its key is known
            raise
        except ValueError as error:
            raise ValueError(in_small_units(str(error))) from None


SECTIONS = {  # sections by the name of their table
    part.key(): section_of(part, tables=QUANTITIES, base=PartSection) for part in (*JOINTS, *LOADS)
}


class RolesInput(Section):
    """[caliper] of a mechanism: its centring joints, and what `Caliper` describes (added by `_Roles`)."""

    centring: Annotated[list[str], Field(description="joints that hold only until the pads touch")] = []  # noqa: RUF012


class MechanismInput(CoreSection):
    """Any mechanism: its bodies, joints and loads, and where it is a caliper its cable and pads.

    A list of tables for each kind of joint and load is added by `CompleteMechanismInput`.
    """

    model_config = SHORT_TEXTS

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
            made = Mechanism(tuple(self.bodies), self._with_friction(joints), tuple(loads))
            self._check_driver(made)
            return made
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
            return
        turns = loads[run.driver].is_couple
        if turns != isinstance(run.travel, Angle):
            wanted = 'an angle, e.g. "10 deg"' if turns else 'a length, e.g. "3 mm"'
            bound, unit = f"the driver {show(run.driver)} moves by {wanted}", "m" if turns else "rad"
            raise InvalidInput("run.travel", float(run.travel), bound, unit=unit)

    def _check_driver(self, made: Mechanism) -> None:
        """Refuse friction that acts nowhere, and a driver that drives nothing."""
        run = self.run
        if run.friction and not made.friction:
            bound = "it is that of pins, and there is none; give friction at the slot or contact"
            raise InvalidInput("run.friction", run.friction, bound)
        rubs = made.friction or "friction" in run.model_fields_set  # friction may be 0 in a sweep
        if run.driver is not None and run.travel is None and not rubs:
            raise MissingValue("run.travel", None, "give the travel of the driver, or leave out driver")

    def _with_friction(self, joints: Sequence[Joint]) -> tuple[Joint, ...]:
        """The joints with the friction of [run] in the pins that have none of their own."""
        friction = self.run.friction
        if not friction:
            return tuple(joints)
        try:
            return tuple(joint.with_pivot(0.0, friction) for joint in joints)
        except ValueError as error:
            raise InvalidInput("run.friction", friction, f"it is that of every pin; {error}") from None


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


# Descriptions of the inputs of calipers and mechanisms for forms and sweeps; named designs as TOML -------


def _keys(part: type[Part]) -> str:
    """The kind of part, and its required and optional keys, as help text."""
    fields, keys = SECTIONS[part.key()].model_fields, {True: [], False: []}
    for key, described in descriptions(part).items():
        otherwise = described.meaning.partition("; ")[2]  # such as "the ground if not given"
        keys[fields[key].is_required()].append(f"{key} ({otherwise})" if otherwise else key)
    return f"{part.label}: {'; '.join(', '.join(some) for some in (keys[True], keys[False]) if some)}"


PARTS = {part.key(): _keys(part) for part in (*JOINTS, *LOADS)}
_LISTED = ("points", *PARTS)


def caliper_inputs(name: str) -> list[Input]:
    """Inputs of the caliper of a name; those without dimensions where there is no such name."""
    return describe(type(named(name)) if name in NAMED else CaliperInput)


def mechanism_inputs(points: Iterable[str]) -> list[Input]:
    """Inputs of a mechanism: one for each of its points, one for each list of parts."""
    rest = {
        entry.path: entry for entry in describe(CompleteMechanismInput) if _table(entry.path) not in _LISTED
    }
    place = PointQuantity("m", meaning="point in the drawing")
    return [
        rest.pop("title"),
        rest.pop("bodies"),
        *(_input(f"points.{name}", Coordinates, place, required=True) for name in points),
        *(_input(part, list[dict], Quantity(meaning=words)) for part, words in PARTS.items()),
        *rest.values(),
    ]


def _table(path: str) -> str:
    return path.partition(".")[0]


def _input(path: str, kind: Any, description: Quantity, required: bool = False) -> Input:
    return Input(path, CompleteMechanismInput, kind, description, (), required, None if required else [])


def inputs_of_tables(tables: Mapping[str, Any]) -> list[Input]:
    """Inputs of the caliper or mechanism that the tables of a file describe."""
    name, points = tables.get("caliper"), tables.get("points")
    if isinstance(name, str):
        return caliper_inputs(name)
    return mechanism_inputs(points if isinstance(points, dict) else ())


def idle_inputs(entries: Mapping[str, str]) -> list[str]:
    """Paths of inputs of a caliper alone, where the entries of a form, by path, are of a plain mechanism."""
    if any(text.strip() for path, text in entries.items() if _table(path) == "caliper"):
        return []
    stops = [path for path in entries if _table(path) == "stop"]
    stops = [] if any(entries[path].strip() for path in stops) else stops
    return ["run.finger", "run.wear", *stops]


def named_text(name: str) -> str:
    """TOML text of a named caliper with all its dimensions."""
    given = named(name)
    inputs = [entry for entry in caliper_inputs(name) if entry.path.startswith("dimensions.")]
    lines = [f"{entry.name} = {_shown(entry)}" for entry in inputs]
    return "\n".join([f"caliper = {show(given.caliper)}", "", "[dimensions]", *lines]) + "\n"


def _shown(entry: Input) -> str:
    """A dimension as a file gives it, lengths in mm."""
    value: Any = entry.default
    if isinstance(value, tuple):
        return f"[{', '.join(_length(part) for part in value)}]"
    return _length(value) if entry.quantity.unit == "m" else show(value)


def _length(metres: float) -> str:
    return f'"{1e3 * metres:.12g} mm"'
