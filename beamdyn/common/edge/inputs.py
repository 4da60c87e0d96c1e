"""Tables of inputs: each input is described once, for files, commands, forms and documentation."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import KW_ONLY, dataclass
from functools import lru_cache
from importlib import import_module
from typing import Any, ClassVar, Literal, get_args, get_origin

from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from beamdyn.common.edge.units import InvalidInput, quantity, unit_as_written
from beamdyn.common.inputs.checks import real
from beamdyn.common.inputs.described import Described


class Section(BaseModel):
    """A table of inputs: strict types, no unknown keys, frozen.

    An instance pickles even if `section_of` made its class, which then stands in no module under its name.
    """

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, arbitrary_types_allowed=True)

    @classmethod
    def __pydantic_init_subclass__(cls, **more: Any) -> None:
        super().__pydantic_init_subclass__(**more)
        _SECTIONS.setdefault(_known_as(cls), cls)

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        known = _known_as(type(self))
        return (_empty_section, (type(self).__module__, known), self.__getstate__())


# The class of each table, by its name and keys; of several equal classes the first one made.
_SECTIONS: dict[str, type[Section]] = {}


def _known_as(section: type[Section]) -> str:
    return f"{section.__module__}.{section.__qualname__}({', '.join(section.model_fields)})"


def _empty_section(module: str, known: str) -> Section:
    """Make a section without values, which pickle fills."""
    import_module(module)  # the import defines the class, unless the module was imported before
    section = _SECTIONS[known]
    return section.__new__(section)


class SiNumber(float):
    """A number in SI whose unit a file states elsewhere, such as in the head of a column."""


@dataclass(frozen=True)
class Quantity(Described):
    """A number of a file, for ``Annotated[float, Quantity("m", "L", "length")]``.

    A pydantic model takes it as text with a unit ("50 mm"), or bare where its unit is "", and holds the
    value in SI.
    """

    # Units that are accepted besides those of the quantity's kind.
    further_units: ClassVar[tuple[str, ...]] = ()

    def parse(self, given: object) -> float:
        """Convert to SI and check the bounds.

        Raises
        ------
        InvalidInput
            If the value is not such a quantity or is out of bounds; the error's `field` is empty.
        """
        return self.within_bounds(given, self.convert(given))

    def convert(self, given: object) -> float:
        """Convert a value to SI without checking bounds."""
        if isinstance(given, SiNumber):
            return float(given)
        if self.infinite and given in ("inf", math.inf):
            return math.inf
        if self.unit:
            return quantity(given, self.unit)
        try:
            if isinstance(given, int | float):
                return real("", given)
        except (ValueError, OverflowError):
            pass
        raise InvalidInput("", given, "give a finite number, without a unit or quotes")

    def in_unit(self, value: float, unit: str) -> float:
        """Convert a value in SI to another unit; raise `InvalidInput` for a unit of another kind."""
        return value / quantity(f"1 {unit}", self.unit)

    def within_bounds(self, given: object, value: float) -> float:
        """Return a value; refuse one that is out of bounds."""
        if not self.is_within_bounds(value):
            unit, convert = unit_as_written(given, self.unit)
            raise InvalidInput(
                "", given, f"it must be {self.bounds_as(convert)} {unit}".rstrip(), self.remedy
            )
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.parse)


class SlopeQuantity(Quantity):
    """The angle of a slope, which may be given by its rise: "5 %" is a rise of 5 in 100 along the level."""

    further_units = ("%",)

    def convert(self, given: object) -> float:
        """Convert the angle, or the rise in %, to rad."""
        if isinstance(given, str) and given.rstrip().endswith("%"):
            try:
                return math.atan(real("", float(given.rstrip()[:-1])) / 100)
            except ValueError:
                raise InvalidInput("", given, "not a number in %", 'give e.g. "5 %"') from None
        return super().convert(given)

    def in_unit(self, value: float, unit: str) -> float:
        """Convert the angle [rad] to another unit, or to a rise in %."""
        return 100 * math.tan(value) if unit == "%" else super().in_unit(value, unit)


@dataclass(frozen=True)
class WholeNumber(Quantity):
    """A whole number, such as a count, which stays an int."""

    _: KW_ONLY
    whole: bool = True

    def parse(self, given: object) -> int:
        """Read the number and check its bounds; see `Quantity.parse`."""
        return int(super().parse(given))


@dataclass(frozen=True)
class Lines(Quantity):
    """A text of several lines, such as that of a file."""

    unit: str = ""

    def parse(self, given: object) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Return a text unchanged; refuse anything else."""
        if not isinstance(given, str):
            raise InvalidInput("", given, "give a text")
        return given


_SHOWN = {"rad": "deg"}  # units in which values are shown to people, by the SI unit


@dataclass(frozen=True)
class Input:
    """Description of one input of a model, for forms and documentation.

    Parameters
    ----------
    path : str
        Where it stands, such as "beam.thickness".
    section : type of Section
        The table that holds it; where tables are alternatives, this tells them apart.
    kind : type
        Its type annotation, without the description.
    quantity : Quantity
        Symbol, unit, bounds and meaning.
    choices : tuple
        The values allowed, if they are few.
    required : bool
        Whether it must be given.
    default : object
        Value if it is not given, in SI.
    """

    path: str
    section: type[BaseModel]
    kind: Any
    quantity: Quantity
    choices: tuple[object, ...]
    required: bool
    default: object

    @property
    def name(self) -> str:
        """The last part of the path."""
        return self.path.rpartition(".")[2]

    @property
    def help(self) -> str:
        """Meaning, unit, bounds and meaning of inf, in one phrase; angles in degrees, as in files."""
        q = self.quantity
        shown = _SHOWN.get(q.unit, q.unit)
        bounds = q.bounds if shown == q.unit else q.bounds_as(lambda bound: q.in_unit(bound, shown))
        unit, bounds = shown and f" [{' or '.join((shown, *q.further_units))}]", bounds and f", {bounds}"
        infinite = q.infinite and f"; inf is {q.infinite}"
        return f"{q.meaning}{unit}{bounds}{infinite}"


Choice = Callable[[str, Sequence[type[BaseModel]]], Sequence[type[BaseModel]]]


def _each(_: str, models: Sequence[type[BaseModel]]) -> Sequence[type[BaseModel]]:
    return models


def describe(model: type[BaseModel], prefix: str = "", choose: Choice = _each) -> list[Input]:
    """List all inputs of a model and of the models within it, in their order.

    Parameters
    ----------
    model : type of BaseModel
        Its fields are quantities, plain types with a `description`, or further models.
    prefix : str
        Put before each path.
    choose : callable
        ``choose(path, models)``: which models to describe of a table with alternatives, such as two kinds of
        beam, given its path and the models of all.

    Returns
    -------
    list of Input
    """
    chosen = choose is not _each and _has_alternatives(model)
    return _describe_all(model, prefix, choose) if chosen else [*_described(model, prefix)]


@lru_cache(maxsize=256)  # cached, as forms ask at each change of a field
def _described(model: type[BaseModel], prefix: str) -> tuple[Input, ...]:
    return tuple(_describe_all(model, prefix, _each))


@lru_cache(maxsize=256)
def _has_alternatives(model: type[BaseModel]) -> bool:
    """Whether a table within the model has several alternative models."""
    tables = [_models_of(field) for field in model.model_fields.values()]
    return any(len(models) > 1 or any(map(_has_alternatives, models)) for models in tables)


def _models_of(field: FieldInfo) -> list[type[BaseModel]]:
    """Return the models of the table that a field holds, one for each alternative; empty without a table."""
    parts = [*parts_of(field.annotation), *field.metadata]
    return [part for part in parts if isinstance(part, type) and issubclass(part, BaseModel)]


def _describe_all(model: type[BaseModel], prefix: str, choose: Choice) -> list[Input]:
    """List the inputs of a model; those of tables within it take the table's place."""
    found: list[Input] = []
    for name, field in model.model_fields.items():
        path = prefix + name
        if models := _models_of(field):
            chosen = choose(path, models) if len(models) > 1 else models
            found += [entry for each in chosen for entry in describe(each, path + ".", choose)]
            continue
        parts, required = [*parts_of(field.annotation), *field.metadata], field.is_required()
        words = Quantity(meaning=field.description or "")
        described = next((part for part in parts if isinstance(part, Quantity)), words)
        choices = next((get_args(part) for part in parts if get_origin(part) is Literal), ())
        default = None if required else field.get_default(call_default_factory=True)
        found.append(Input(path, model, field.annotation, described, choices, required, default))
    return found


def parts_of(annotation: Any) -> Iterator[Any]:
    """Yield an annotation and its parts, recursively."""
    yield annotation
    for part in get_args(annotation):
        yield from parts_of(part)
