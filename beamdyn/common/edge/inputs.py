"""Descriptions of inputs, shared by files, commands, forms and documentation.

The computing classes take floats in SI units; their error messages are reworded for users of files, with the
keys of the file, and degrees in place of radians.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from dataclasses import KW_ONLY, dataclass, replace
from functools import lru_cache
from importlib import import_module
from typing import Any, ClassVar, Literal, get_args, get_origin

import numpy as np
from pydantic import BaseModel, ConfigDict, GetCoreSchemaHandler
from pydantic.fields import FieldInfo
from pydantic_core import CoreSchema, core_schema

from beamdyn.common.edge.units import InvalidInput, last_quantity, quantity, unit_as_written
from beamdyn.common.inputs.checks import OUT_OF_RANGE, InvalidValue, real
from beamdyn.common.inputs.described import Described


class Section(BaseModel):
    """A table of a file: types are not converted, unknown keys are errors, and objects cannot be changed.

    Instances can be pickled even if `section_of` made their class, which no module contains by name.
    """

    model_config = ConfigDict(strict=True, extra="forbid", frozen=True, arbitrary_types_allowed=True)

    @classmethod
    def __pydantic_init_subclass__(cls, **more: Any) -> None:
        super().__pydantic_init_subclass__(**more)
        _SECTIONS.setdefault(_known_as(cls), cls)

    def __reduce_ex__(self, protocol: Any) -> tuple[Any, ...]:
        known = _known_as(type(self))
        return (_empty_section, (type(self).__module__, known), self.__getstate__())


# Python class of each table, by module, name and keys; of classes that agree in these, the first is stored.
_SECTIONS: dict[str, type[Section]] = {}


def _known_as(section: type[Section]) -> str:
    return f"{section.__module__}.{section.__qualname__}({', '.join(section.model_fields)})"


def _empty_section(module: str, known: str) -> Section:
    """Make a table object without values; unpickling then sets them."""
    import_module(module)  # the import defines the class, unless the module is already imported
    section = _SECTIONS[known]
    return section.__new__(section)


class SiNumber(float):
    """A number in SI units; the file states the unit elsewhere, such as in a column heading."""


@dataclass(frozen=True)
class Quantity(Described):
    """A number with a unit in a file, for ``Annotated[float, Quantity("m", "L", "length")]``.

    Files give it as text with a unit ("50 mm"), or as a number alone if `unit` is "".  The pydantic model
    stores the value in SI units.
    """

    # Units that are accepted although they belong to another kind of quantity.
    further_units: ClassVar[tuple[str, ...]] = ()
    is_list: ClassVar[bool] = False  # whether a file gives it as a list of rows

    def parse(self, given: object) -> float:
        """Convert a text or number from a file to SI units, and check its bounds.

        Raises
        ------
        InvalidInput
            If the value is not a quantity of this kind, or is out of bounds; the error's `field` is empty.
        """
        return self.within_bounds(given, self.convert(given))

    def convert(self, given: object) -> float:
        """Convert a text or number from a file to SI units, without checking the bounds."""
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
        """Convert a value in SI units to a given unit; raise `InvalidInput` for a unit of another kind."""
        return value / quantity(f"1 {unit}", self.unit)

    def within_bounds(self, given: object, value: float) -> float:
        """Return a value if it is within the bounds; else raise an error that shows the text in the file."""
        if not self.is_within_bounds(value):
            unit, convert = unit_as_written(given, self.unit)
            raise InvalidInput(
                "", given, f"it must be {self.bounds_as(convert)} {unit}".rstrip(), self.remedy
            )
        return value

    def __get_pydantic_core_schema__(self, source: Any, handler: GetCoreSchemaHandler) -> CoreSchema:
        return core_schema.no_info_plain_validator_function(self.parse)


class SlopeQuantity(Quantity):
    """The angle of a slope, also given as a gradient: "5 %" is a rise of 5 m over 100 m of level."""

    further_units = ("%",)

    def convert(self, given: object) -> float:
        """Convert an angle with a unit, or a gradient in %, to rad."""
        if isinstance(given, str) and given.rstrip().endswith("%"):
            try:
                return math.atan(real("", float(given.rstrip()[:-1])) / 100)
            except ValueError:
                raise InvalidInput("", given, "not a number in %", 'give e.g. "5 %"') from None
        return super().convert(given)

    def in_unit(self, value: float, unit: str) -> float:
        """Convert the angle [rad] to another unit of angles, or to a gradient in %."""
        return 100 * math.tan(value) if unit == "%" else super().in_unit(value, unit)


@dataclass(frozen=True)
class WholeNumber(Quantity):
    """A whole number, such as a count, stored as an int."""

    _: KW_ONLY
    whole: bool = True

    def parse(self, given: object) -> int:
        """Read a whole number and check its bounds; see `Quantity.parse`."""
        return int(super().parse(given))


@dataclass(frozen=True)
class Lines(Quantity):
    """A text of several lines, such as the content of a file."""

    unit: str = ""

    def parse(self, given: object) -> str:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Return a text unchanged; raise an error for any other object."""
        if not isinstance(given, str):
            raise InvalidInput("", given, "give a text")
        return given


_SHOWN = {"rad": "deg"}  # usual units in which quantities are shown to users, by SI unit


@dataclass(frozen=True)
class Input:
    """Description of one input of a model, for forms and documentation.

    Parameters
    ----------
    path : str
        Path of the input in a file, such as "beam.thickness".
    section : type of Section
        Class of the table that contains the input; alternative tables have different classes.
    kind : type
        Type annotation, without the description.
    quantity : Quantity
        Symbol, unit, bounds and meaning.
    choices : tuple
        The allowed values, if only a few are allowed.
    required : bool
        Whether the file must give the input.
    default : object
        Value if the file does not give the input, in SI units.
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
        """Return the name of the input, which is the last part of its path."""
        return self.path.rpartition(".")[2]

    @property
    def help(self) -> str:
        """Return meaning, unit, bounds and meaning of inf in one phrase; angles in degrees, as in files."""
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
    """List all inputs of a pydantic model and of the models nested in it, in the order of the fields.

    Parameters
    ----------
    model : type of BaseModel
        Model whose fields are quantities, types such as str with a `description`, or further models.
    prefix : str
        Text to put before each path.
    choose : callable
        ``choose(path, models)`` selects which of the alternative models of a table to describe, such as two
        kinds of beam, from the path of the table and all its models.

    Returns
    -------
    list of Input
    """
    chosen = choose is not _each and _has_alternatives(model)
    return _describe_all(model, prefix, choose) if chosen else [*_described(model, prefix)]


@lru_cache(maxsize=256)  # cached, because a form calls this at each change of a field
def _described(model: type[BaseModel], prefix: str) -> tuple[Input, ...]:
    return tuple(_describe_all(model, prefix, _each))


@lru_cache(maxsize=256)
def _has_alternatives(model: type[BaseModel]) -> bool:
    """Return whether a table within the model has several alternative models."""
    tables = [_models_of(field) for field in model.model_fields.values()]
    return any(len(models) > 1 or any(map(_has_alternatives, models)) for models in tables)


def _models_of(field: FieldInfo) -> list[type[BaseModel]]:
    """Return the models (one for each alternative) of the table in a field; empty if it holds no table."""
    parts = [*parts_of(field.annotation), *field.metadata]
    return [part for part in parts if isinstance(part, type) and issubclass(part, BaseModel)]


def _describe_all(model: type[BaseModel], prefix: str, choose: Choice) -> list[Input]:
    """List the inputs of a model; a nested table is replaced by its inputs."""
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
    """Yield a type annotation and all annotations within it, recursively."""
    yield annotation
    for part in get_args(annotation):
        yield from parts_of(part)


# Error messages in terms of input files ------------------------------------------------------------

_SUSPECT = 12.0  # distance of a number from 1, in decades, above which its exponent may be mistyped
_FAR = "far too large or too small compared with the others: the results leave the range of numbers"
_CHECK = "check its exponent and its unit"


@contextmanager
def of_file(keys: Mapping[str, str]) -> Iterator[None]:
    """In this context, reword `InvalidValue` errors: keys of a file for argument names, degrees for radians.

    Parameters
    ----------
    keys : mapping
        Key of the file for each argument name, e.g. ``{"lining[0]": "lining_start"}``.
    """
    try:
        yield
    except InvalidValue as error:
        named = replace(
            error, field=keys.get(error.field, error.field), other=keys.get(error.other, error.other)
        )
        raise (in_degrees(named) if error.unit == "rad" else named) from None


@contextmanager
def in_range(design: BaseModel) -> Iterator[None]:
    """In this context, convert an overflow to a ValueError, as a mistyped exponent is the likely cause.

    Parameters
    ----------
    design : BaseModel
        The inputs of the computation. The message names the number whose size is farthest from 1, if it
        is far enough.

    Raises
    ------
    ValueError
        In place of an overflow or a division by zero.
    """
    try:
        with np.errstate(over="raise", divide="raise", invalid="raise"):
            yield
    except (OverflowError, FloatingPointError, ZeroDivisionError):
        path, number = max(_numbers(dict(design)), key=lambda found: _decades(found[1]), default=("", 1.0))
        if _decades(number) < _SUSPECT:
            raise ValueError(OUT_OF_RANGE) from None
        units = {entry.path: entry.quantity.unit for entry in describe(type(design))}
        raise InvalidValue(path, number, _FAR, _CHECK, units.get(path, "")) from None


def _numbers(given: object, path: str = "") -> Iterator[tuple[str, float]]:
    """Yield the numbers among the inputs, each with its path, such as "pad[0]"."""
    match given:
        case float():
            yield path, given
        case np.ndarray():
            yield from ((path, float(number)) for number in given.ravel())
        case BaseModel() | dict():
            for key, value in dict(given).items():
                yield from _numbers(value, f"{path}.{key}".removeprefix("."))
        case list() | tuple():
            for i, value in enumerate(given):
                yield from _numbers(value, f"{path}[{i}]")


def _decades(number: float) -> float:
    """Return the distance of a number's absolute value from 1 in decades; 0 for zero."""
    return abs(math.log10(abs(number))) if number and math.isfinite(number) else 0.0


def in_degrees(error: InvalidValue) -> InvalidValue:
    """Convert the numbers in an error about an angle from rad to degrees."""
    return error.in_unit("deg", math.degrees)


def in_millimetres(error: InvalidValue) -> InvalidValue:
    """Convert the numbers in an error about a length below 1 m to mm; leave other errors unchanged."""
    short = error.unit == "m" and isinstance(error.value, float) and abs(error.value) < 1
    return error.in_unit("mm", lambda metres: 1e3 * metres) if short else error


def in_unit_of(error: InvalidValue, text: str) -> InvalidValue:
    """Convert an error's numbers to the unit at the end of a text, as in "+-2 g/cm3", if the unit fits."""
    return error.in_unit(*unit_as_written(last_quantity(text), error.unit))


# The input that an error is about --------------------------------------------------------------------


def wholes_of(field: str) -> Iterator[str]:
    """Yield a path and all paths that contain it: "width.values[1]", "width.values", "width"."""
    yield field
    if (cut := max(field.rfind("."), field.rfind("["))) > 0:
        yield from wholes_of(field[:cut])


def without_indices(field: str) -> str:
    """Return a path without indices, as in descriptions: "point_mass.mass" for "point_mass[0].mass"."""
    return re.sub(r"\[\d+\]", "", field)


def path_of(error: Exception, paths: Iterable[str], table: str = "") -> str:
    """Return the path of the input that an error is about; empty if no single input can be named.

    Parameters
    ----------
    error : Exception
        The error; only an `InvalidValue` names its argument.
    paths : iterable of str
        Paths of inputs.
    table : str
        Path of the table in which the input is looked for.
    """
    field = error.field if isinstance(error, InvalidValue) else ""
    paths = list(paths)
    names = (*wholes_of(field), without_indices(field))
    return next(filter(None, (_path_ending(name, paths, table) for name in names)), "")


def _path_ending(field: str, paths: list[str], table: str) -> str:
    """Return the only path in a table that ends with the field's name; empty if there is none or several."""
    exact = f"{table}.{field}".lstrip(".")
    ends = {path for path in paths if field and f".{path}".endswith(f".{field}")}
    inside = {path for path in ends if path.startswith(table and f"{table}.")}
    return exact if exact in inside else inside.pop() if len(inside) == 1 else ""
