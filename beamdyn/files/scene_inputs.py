"""Tables of a scene's TOML file, and the objects that they describe; quantities are texts with units."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from contextlib import contextmanager
from dataclasses import replace
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.polynomial import Polynomial
from pydantic import BaseModel, BeforeValidator, Discriminator, Field, GetCoreSchemaHandler, Tag
from pydantic_core import CoreSchema, core_schema

from beamdyn.common.edge.config import CoreSection, MadeSection, one_of_kinds, section_of
from beamdyn.common.edge.inputs import Quantity, Section, describe, of_file
from beamdyn.common.edge.toml_columns import read_columns
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.scene.beam import Beam
from beamdyn.scene.harvester import Harvester
from beamdyn.scene.motion.kinds import KINDS
from beamdyn.scene.motion.rotations import Rotation
from beamdyn.scene.mount import Damping, Mount
from beamdyn.scene.physics import AUTO, AUTO_NAME, Physics
from beamdyn.scene.points import PointMass, PointSpring, TipLoad, TipMass
from beamdyn.scene.profile import Table
from beamdyn.scene.scene import Scene
from beamdyn.scene.section_matrices import UPPER, SectionMatrices, entry_name, entry_units

Along = float | Polynomial | Table  # a property along the beam: number, polynomial in x/L or table


class Metres(float):
    """A position given as a length, which becomes a fraction when the length of the beam is known."""


class Position(Quantity):
    """A position along the beam: the fraction x/L as a number without a unit, or a length with a unit."""

    def convert(self, given: object) -> float:
        """Convert to a fraction x/L, or to `Metres` if the position is a length."""
        return Metres(quantity(given, "m")) if isinstance(given, str) else super().convert(given)


_STATION = Position(meaning="position along the beam, as a fraction x/L or a length")
BREAKPOINT = Position(meaning="places where a property jumps or has a kink, as fractions x/L or lengths")


class Varying(Quantity):
    """A quantity that is constant, a polynomial in x/L, or a table over stations."""

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
    """Return the pydantic schema of an inline table of lists, from which `build` makes an object."""
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
    if isinstance(given, Table):  # the property is given by a column of beam.stations
        return "<column>"
    if not isinstance(given, dict):
        return None if isinstance(given, list) else "<constant>"
    kinds = {"<polynomial>": {"polynomial"}, "<table>": {"stations", "values"}}
    return next((kind for kind, keys in kinds.items() if keys & given.keys()), None)


# Tables of a scene file -----------------------------------------------------------------------------


# Classes of tables by kind of rotation or motion, in the order of `KINDS`.
ROTATIONS = {name: section_of(made, name) for name, made in KINDS.items() if issubclass(made, Rotation)}
_ROTATION = {Rotation: one_of_kinds(ROTATIONS)}
MOTIONS = {name: ROTATIONS.get(name) or section_of(made, name, _ROTATION) for name, made in KINDS.items()}


class _ChoosablePhysics(MadeSection):
    """The table [physics], or the word "auto" in its place."""

    auto: Annotated[
        bool, Field(description="each analysis adds the effects whose size exceeds its tolerance")
    ] = False

    @cached_property
    def core(self) -> Physics:
        """Make the `Physics` object, which states the physical effects to include."""
        with of_file(self.key_of):
            given = self.made(**self.given)
        if not self.auto:
            return given
        if given != Physics():
            name = next(name for name, value in vars(given).items() if value != getattr(Physics(), name))
            bound = "physics is auto: each analysis chooses the effects"
            raise InvalidValue(f"physics.{name}", getattr(given, name), bound, "leave one of the two out")
        return AUTO


def with_physics_as_table(tables: dict[str, Any]) -> dict[str, Any]:
    """Return the tables of a scene, with a table in place of the word "auto" for the physical effects."""
    return tables | ({"physics": _auto_as_table(tables["physics"])} if "physics" in tables else {})


def _auto_as_table(given: Any) -> Any:
    """Return a table with the same meaning if the word "auto" is given, else the given value."""
    if isinstance(given, Mapping):
        return given
    if given != AUTO_NAME:
        raise InvalidInput("", given, f'give "{AUTO_NAME}", or a table [physics]')
    return {AUTO_NAME: True}


def _in_a_list(key: str) -> BeforeValidator:
    """Make a validator that raises an error for a single table where a list of tables is expected."""

    def refuse_one(given: Any) -> Any:
        if isinstance(given, Mapping):
            raise InvalidInput("", dict(given), f"give [[beam.{key}]] in double brackets for each item")
        return given

    return BeforeValidator(refuse_one)


if TYPE_CHECKING:
    _TipInput = _PointMassInput = _PointSpringInput = _MountInput = CoreSection
    _MotionInput = _PhysicsInput = _DampingInput = _HarvesterInput = _TipLoadInput = CoreSection
else:
    _TipInput, _PointMassInput, _MountInput = map(section_of, (TipMass, PointMass, Mount))
    _TipLoadInput = section_of(TipLoad)
    _PointSpringInput, _DampingInput, _HarvesterInput = map(section_of, (PointSpring, Damping, Harvester))
    _PhysicsInput = section_of(Physics, base=_ChoosablePhysics)
    _MotionInput = one_of_kinds(MOTIONS)


class _BeamInput(CoreSection):
    length: Annotated[float, Quantity("m", "L", "length", above=0)]
    tip: _TipInput | None = None
    breakpoints: list[Annotated[float, BREAKPOINT]] = []  # noqa: RUF012  (pydantic copies it)
    stations: Annotated[
        list[list[Any]] | None,
        Field(
            description="table of the sections: a row of headings such as x/L and twist [deg], then numbers, "
            "one row per station; linear between stations; two rows at a jump; or name of a CSV file"
        ),
    ] = None
    twist: Annotated[
        Along | None,
        Varying("rad", "tau", "angle by which the section is turned, added to the bending angle"),
    ] = None
    sweep: Annotated[
        Along | None,
        Varying(
            "rad", "Lambda", "angle of the axis from its direction at the root, out of the plane of bending"
        ),
    ] = None
    prebend: Annotated[
        Along | None,
        Varying("rad", "beta", "angle of the axis from its direction at the root, in the plane of bending"),
    ] = None
    point_mass: Annotated[list[_PointMassInput], _in_a_list("point_mass")] = []  # noqa: RUF012  (the same)
    point_spring: Annotated[list[_PointSpringInput], _in_a_list("point_spring")] = []  # noqa: RUF012

    @property
    def _arguments(self) -> dict[str, Any]:
        """Return the arguments for the constructors of `Beam`."""
        others = ("stations", "point_mass", "point_spring")
        given = {name: value for name, value in self if value is not None and name not in others}
        given = {name: _to_fractions(value, self.length) for name, value in given.items()}
        points = {"point_masses": self.point_mass, "point_springs": self.point_spring}
        made = {name: tuple(point.core for point in tables) for name, tables in points.items()}
        return given | {"tip": self.tip and self.tip.core} | made


class RectangularInput(_BeamInput):
    """The table [beam] for a beam of rectangular section."""

    width: Annotated[Along, Varying("m", "b", "width of the section", above=0)]
    thickness: Annotated[Along, Varying("m", "h", "thickness, in the direction of bending", above=0)]
    youngs_modulus: Annotated[float, Quantity("Pa", "E", "Young's modulus", above=0)]
    density: Annotated[float, Quantity("kg/m3", "rho", "density", above=0)]
    poissons_ratio: Annotated[
        float | None,
        Quantity(
            "",
            "nu",
            "Poisson's ratio, for shear, camber and torsion",
            above=-1,
            most=0.5,
            remedy="steel has 0.3",
        ),
    ] = None

    @cached_property
    def core(self) -> Beam:
        """Make the beam."""
        with _of_stations(self.stations), _of_points():
            return Beam.rectangular(**self._arguments)


class StiffnessInput(_BeamInput):
    """The table [beam] for a beam of any section, described by its stiffness."""

    mass_per_length: Annotated[Along, Varying("kg/m", "rho A", "mass per length", above=0)]
    bending_stiffness: Annotated[Along, Varying("N m2", "E I", "bending stiffness", above=0)]
    axial_stiffness: Annotated[Along | None, Varying("N", "E A", "axial stiffness, for stretch", above=0)] = (
        None
    )
    outer_fibre: Annotated[
        Along | None,
        Varying("m", "c", "distance of the outer fibre from the neutral axis, for strain", above=0),
    ] = None
    second_bending_stiffness: Annotated[
        Along | None,
        Varying("N m2", "E I2", "bending stiffness in the second direction, for planes = 2", above=0),
    ] = None
    shear_stiffness: Annotated[
        Along | None, Varying("N", "kappa G A", "shear stiffness, for shear", above=0)
    ] = None
    second_shear_stiffness: Annotated[
        Along | None,
        Varying("N", "kappa G A2", "shear stiffness, second direction; default: shear_stiffness", above=0),
    ] = None
    rotary_inertia: Annotated[
        Along | None, Varying("kg m", "rho I", "rotary inertia of the section per length", above=0)
    ] = None
    second_rotary_inertia: Annotated[
        Along | None, Varying("kg m", "rho I2", "rotary inertia for bending in the second direction", above=0)
    ] = None
    torsion_stiffness: Annotated[
        Along | None, Varying("N m2", "G J", "stiffness against torsion", above=0)
    ] = None
    warping_stiffness: Annotated[
        Along | None, Varying("N m4", "E Cw", "warping stiffness; the root then cannot warp", above=0)
    ] = None
    mass_offset: Annotated[
        Along | None,
        Varying("m", "c", "offset of mass from shear centre across the bending direction, for torsion"),
    ] = None
    tension_offset: Annotated[
        Along | None,
        Varying(
            "m",
            "t",
            "offset of tension from shear centre, across; bending stiffness is about the tension centre",
        ),
    ] = None

    @cached_property
    def core(self) -> Beam:
        """Make the beam."""
        with _of_stations(self.stations), _of_points(), _naming_missing_key(StiffnessInput):
            return Beam.from_stiffness(**self._arguments)


class MatricesInput(_BeamInput):
    """The table [beam] for a beam whose sections couple all strains, described by 6 x 6 matrices."""

    matrices: Annotated[
        list[list[Any]],
        Field(
            description="table of the 6 x 6 matrices of the sections: a row of headings, x/L and entries of "
            "the upper triangles, K11 [N] to K66 [N m2] of stiffness and M11 [kg/m] to M66 [kg m] of mass, "
            "then one row of numbers per station; linear between stations; entries that are not given are 0"
        ),
    ]

    @cached_property
    def core(self) -> Beam:
        """Make the beam."""
        with _of_stations(self.stations), _of_points():
            matrices = _read_matrices(self.matrices, self.length)
            arguments: dict[str, Any] = self._arguments | {"matrices": matrices}
            return Beam.from_matrices(**arguments)


ENTRIES = {name: Quantity(unit, meaning="entry of a matrix") for name, unit in entry_units().items()}


def _read_matrices(rows: list[Any], length: float) -> SectionMatrices:
    """Read the cross-section matrices in a table; entries that are not given are 0."""
    columns = read_columns("matrices", rows, PLACES | ENTRIES)
    places = [name for name in columns if name in PLACES]
    if len(places) != 1:
        raise InvalidInput("matrices[0]", rows[0], 'give the position in one column, "x/L" or "x [m]"')
    x = _to_fractions(columns.pop(places[0]), length)
    both = []
    for letter in "KM":
        both.append(np.zeros((len(x), 6, 6)))
        for i, j in UPPER:
            both[-1][:, i, j] = both[-1][:, j, i] = columns.get(entry_name(letter, i, j), 0.0)
    return SectionMatrices.at_stations(x, *both)


def _to_fractions(given: Any, length: float) -> Any:
    """Convert positions in metres to fractions of the length; leave all other values unchanged."""
    if isinstance(given, Table):
        return Table(_to_fractions(given.stations, length), given.values)
    if isinstance(given, list | tuple):
        # Rounded, so that 20 mm of 50 mm equals the fraction 0.4, without a tiny interval between the two.
        return tuple(round(x / length, 14) if isinstance(x, Metres) else x for x in given)
    return given


@contextmanager
def _of_points() -> Iterator[None]:
    """In this context, reword errors about a point mass or spring: name the table of the file."""
    try:
        yield
    except InvalidValue as error:
        field = error.field.replace("point_masses[", "point_mass[")
        raise replace(error, field=field.replace("point_springs[", "point_spring[")) from None


@contextmanager
def _naming_missing_key(beam: type[BaseModel]) -> Iterator[None]:
    """In this context, reword errors about a missing property, so that they name the key in the file."""
    try:
        yield
    except InvalidValue as error:
        if not error.other:
            raise
        key = error.other if error.other in beam.model_fields else "poissons_ratio"
        raise replace(error, remedy=f"give beam.{key}") from None


# A table of stations ------------------------------------------------------------------------------


PLACES = {"x/L": Position(meaning="position"), "x": Position("m", meaning="position")}
VARYING = {
    entry.name: entry.quantity
    for section in (RectangularInput, StiffnessInput)
    for entry in describe(section)
    if isinstance(entry.quantity, Varying)
}


def _with_columns(given: Any) -> Any:
    """Add a key for each column of `stations`: the table of the property in the column."""
    if not isinstance(given, dict) or given.get("stations") is None:
        return given
    rows = given["stations"]
    if isinstance(rows, str):
        remedy = 'give a row of headings, ["x/L", "twist [deg]"], then rows of numbers'
        raise InvalidInput("stations", rows, f"{remedy}; only a scene in a file may name another file")
    columns = read_columns("stations", rows, PLACES | VARYING)
    places = [name for name in columns if name in PLACES]
    if len(places) != 1 or len(columns) < 2:
        remedy = 'give the position in one column, "x/L" or "x [m]", and properties in others'
        raise InvalidInput("stations[0]", rows[0], remedy)
    if twice := [name for name in columns if name in given]:
        raise InvalidInput("stations[0]", rows[0], f"{twice[0]} is both a column and a key; give it once")
    x = tuple(columns.pop(places[0]))
    return given | {name: Table(x, tuple(values)) for name, values in columns.items()}


@contextmanager
def _of_stations(rows: list[Any] | None) -> Iterator[None]:
    """In this context, reword errors about stations of a property, so that they name the table cells."""
    keys: dict[str, str] = {}
    if rows:
        place = next(c for c, head in enumerate(rows[0]) if head.partition("[")[0].strip() in PLACES)
        cells = {f"[{r - 1}]": f"stations[{r}][{place}]" for r in range(1, len(rows))}
        for name in VARYING:
            keys |= {f"{name}.stations": "stations", f"{name}.values": "stations"}
            keys |= {f"{name}.stations{index}": cell for index, cell in cells.items()}
    with of_file(keys):
        yield


def _own(section: type[Section]) -> list[str]:
    return [name for name in section.model_fields if name not in _BeamInput.model_fields]


def _needed(section: type[Section]) -> str:
    """List the required keys that only this kind of beam has."""
    return " and ".join(name for name in _own(section) if section.model_fields[name].is_required())


def _kind_of_beam(given: Any) -> str:
    keys = given.keys() if isinstance(given, dict) else set()
    if "matrices" in keys:
        return "<matrices>"
    return "<stiffness>" if keys & set(_own(StiffnessInput)) else "<rectangular>"


def _one_kind_of_beam(given: Any) -> Any:
    keys = given.keys() if isinstance(given, dict) else set()
    section, stiffness = ([k for k in _own(kind) if k in keys] for kind in (RectangularInput, StiffnessInput))
    if "matrices" in keys and section + stiffness:
        raise ValueError(f"give either matrices or {', '.join(section + stiffness)}, not both")
    if section and stiffness:
        raise ValueError(
            f"{', '.join(section)} and {', '.join(stiffness)} do not go together; describe the beam either "
            f"by {_needed(RectangularInput)} or by {_needed(StiffnessInput)}, with other keys of that kind"
        )
    return given


BeamInput = Annotated[
    Annotated[RectangularInput, Tag("<rectangular>")]
    | Annotated[StiffnessInput, Tag("<stiffness>")]
    | Annotated[MatricesInput, Tag("<matrices>")],
    Discriminator(_kind_of_beam),
    BeforeValidator(_one_kind_of_beam),
    BeforeValidator(_with_columns),
]


class ModelInput(Section):
    """The table [model]: modal damping ratio and gravity."""

    damping_ratio: Annotated[
        float,
        Quantity("", "zeta", "modal damping ratio of every mode", least=0, below=1, remedy="1 % is 0.01"),
    ] = Scene.damping_ratio
    gravity: Annotated[float, Quantity("m/s2", "g", "gravity")] = Scene.gravity


class SceneInput(CoreSection):
    """A scene file: the tables [beam] and [mount], and optional tables such as [harvester]."""

    beam: BeamInput
    mount: _MountInput
    motion: _MotionInput | None = None
    model: ModelInput = ModelInput()
    damping: _DampingInput = _DampingInput()
    tip_load: _TipLoadInput = _TipLoadInput()
    harvester: _HarvesterInput | None = None
    physics: Annotated[_PhysicsInput, BeforeValidator(_auto_as_table)] = _PhysicsInput()

    @cached_property
    def core(self) -> Scene:
        """Make the scene from its tables."""
        motion = self.motion and self.motion.core
        with _naming_missing_key(type(self.beam)):
            made = {name: getattr(self, name).core for name in ("physics", "damping", "tip_load")}
            bare = self.beam.core
            beam = bare if self.harvester is None else self.harvester.core.on(bare)
            return Scene(beam, self.mount.core, motion, **dict(self.model), **made)
