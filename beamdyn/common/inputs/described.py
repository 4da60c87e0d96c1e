"""Descriptions of inputs as data, and designs: combinations of values of several inputs.

Files, forms and help texts are made from the descriptions.  In a design, a path such as "beam.thickness"
leads to each input through nested objects: mappings, sequences, pydantic models of files, and dataclasses.  A
path contains the key that files have for a field, which may differ from the name of the field.
"""

from __future__ import annotations

import math
import operator
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import KW_ONLY, dataclass, fields, is_dataclass, replace
from functools import cache
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, one_of, real, refuse
from beamdyn.common.words import InputName


@dataclass(frozen=True)
class Described:
    """Description of an input, for ``Annotated[float, Described("m", "L", "length")]``.

    Parameters
    ----------
    unit : str
        SI unit; "" for a dimensionless number, and for an input that is a word.
    symbol : str
        Symbol of the quantity in formulas.
    meaning : str
        Meaning of the input: a phrase without a full stop.
    above, below : float, optional
        Open bounds: the value must be above `above` and below `below` [unit].
    least, most : float, optional
        Smallest and largest value [unit].
    remedy : str
        Advice about a value out of bounds.
    key : str
        Key in files, if it differs from the name of the argument.
    required : bool
        Whether files must give the input even if the argument has a default.
    default : object, optional
        Value for files that omit the input although the argument has no default.
    infinite : str
        Meaning of an infinite value, such as "clamped"; if empty, the value must be finite.
    whole : bool
        Whether the value must be a whole number.
    """

    unit: str = ""
    symbol: str = ""
    meaning: str = ""
    _: KW_ONLY
    above: float | None = None
    below: float | None = None
    least: float | None = None
    most: float | None = None
    remedy: str = ""
    key: str = ""
    required: bool = False
    default: object = None
    infinite: str = ""
    whole: bool = False

    @property
    def bounds(self) -> str:
        """Return the bounds in words, such as "greater than 0, at most 1"; empty if there are none."""
        return self.bounds_as(lambda bound: bound)

    def bounds_as(self, convert: Callable[[float], float]) -> str:
        """Return the bounds in words, with each number converted to another unit."""
        limits = (f"{words} {convert(bound):g}" for words, bound, _ in self._limits())
        return ", ".join([*["a whole number"] * self.whole, *limits])

    def _limits(self) -> Iterator[tuple[str, float, Callable[[Any, float], Any]]]:
        """Yield each bound in words, its number [unit], and the comparison that finds invalid values."""
        for words, bound, refuses in (
            ("greater than", self.above, operator.le),
            ("at least", self.least, operator.lt),
            ("below", self.below, operator.ge),
            ("at most", self.most, operator.gt),
        ):
            if bound is not None:
                yield words, bound, refuses

    def is_within_bounds(self, value: float) -> bool:
        """Return whether a value [unit] is within all bounds."""
        fits = not self.whole or float(value).is_integer()
        return fits and not any(refuses(value, bound) for _, bound, refuses in self._limits())

    def nearest_within(self, value: float) -> float:
        """Return the value [unit] within all bounds that is closest to a given value."""
        least = [self.least] if self.above is None else [self.least, math.nextafter(self.above, math.inf)]
        most = [self.most] if self.below is None else [self.most, math.nextafter(self.below, -math.inf)]
        value = max([value, *(bound for bound in least if bound is not None)])
        return min([value, *(bound for bound in most if bound is not None)])

    def refuse_out_of_bounds(self, name: str, values: Any) -> None:
        """Raise an error if a number, or any number of an array [unit], is out of bounds.

        Raises
        ------
        InvalidValue
            The error holds the name of the input, and the first bound that is violated.
        """
        if self.whole:
            refuse(values % 1 != 0, name, values, self.unit, "give a whole number")
        for words, bound, refuses in self._limits():
            said = f"it must be {words} {{limit}}"
            refuse(refuses(values, bound), name, values, self.unit, said, self.remedy, limit=bound)

    def check(self, name: str, value: Any) -> Any:
        """Return the value as a float; raise an error if it is not finite, or out of bounds.

        Raises
        ------
        InvalidValue
            The error holds the name of the input.
        """
        number = real(name, value, self.unit, self.remedy)
        self.refuse_out_of_bounds(name, number)
        return number


def description(hint: Any) -> Described | None:
    """Return the `Described` object in a type annotation or in one of its parts; None if there is none."""
    found = (entry for part in (hint, *get_args(hint)) for entry in getattr(part, "__metadata__", ()))
    return next((entry for entry in found if isinstance(entry, Described)), None)


def kinds_of(hint: Any) -> list[Any]:
    """Return the types that an annotation allows, without the `Described` objects in it."""
    if get_origin(hint) is Annotated:
        return kinds_of(get_args(hint)[0])
    if get_origin(hint) in (Union, UnionType):
        return [kind for part in get_args(hint) for kind in kinds_of(part)]
    return [hint]


@cache
def described_hints(made: Callable[..., Any]) -> dict[str, Any]:
    """Return the annotations, by name, of those arguments of a class or function that have a `Described`."""
    hints = get_type_hints(made, include_extras=True)
    return {name: hint for name, hint in hints.items() if description(hint)}


@cache
def descriptions(made: Callable[..., Any]) -> dict[str, Described]:
    """Return the `Described` objects of the arguments of a dataclass or function, by name, in order."""
    return {name: found for name, hint in described_hints(made).items() if (found := description(hint))}


# Designs: combinations of input values ---------------------------------------------------------------

_STEP = re.compile(r"\[(\d+)\]|((?:(?!\[\d+\])[^.])+)")
_AXES = "xy"  # names of the coordinates of a point


def part_at(whole: Any, path: str) -> Any:
    """Return the part of nested objects at a path; None if there is none."""
    for step in _steps(path):
        whole = _part(whole, step)
    return whole


def with_parts(whole: Any, parts: Mapping[str, Any]) -> Any:
    """Copy an object with new values at several paths, which are replaced together before any check.

    Dataclasses check the new values; pydantic models of files do not.
    """
    tree = _Tree()
    for path, value in parts.items():
        *inner, last = _steps(path)
        node = tree
        for step in inner:
            node = node.setdefault(step, _Tree())
        node[last] = value
    return _replaced(whole, tree)


class _Tree(dict[Any, Any]):
    """New values of an object's parts, by key or index; for parts of a part, another tree of new values."""


def _steps(path: str) -> list[str | int]:
    return [int(place) if place else name for place, name in _STEP.findall(path)]


def _place(step: str | int) -> int:
    return _AXES.index(step) if isinstance(step, str) else step


def _part(whole: Any, step: str | int) -> Any:
    if isinstance(whole, Mapping):
        return whole.get(step)
    if isinstance(whole, list | tuple):
        return whole[_place(step)] if _place(step) < len(whole) else None
    return getattr(whole, field_of(type(whole), str(step)), None)


def _replaced(whole: Any, new: Any) -> Any:
    if not isinstance(new, _Tree):
        return new
    if isinstance(whole, list | tuple):
        places = {_place(step): part for step, part in new.items()}
        return type(whole)(
            _replaced(part, places[k]) if k in places else part for k, part in enumerate(whole)
        )
    made = {field_of(type(whole), step): _replaced(_part(whole, step), part) for step, part in new.items()}
    if is_dataclass(whole) and not isinstance(whole, type):
        return replace(whole, **made)
    whole = {} if whole is None else whole
    return (
        {**whole, **made} if isinstance(whole, Mapping) else type(whole).model_construct(**dict(whole) | made)
    )


def field_of(made: type, key: str) -> str:
    """Return the name of the dataclass field whose key in files is `key`; for other classes, `key` itself."""
    return _fields_by_key(made).get(key, key)


@cache
def _fields_by_key(made: type) -> dict[str, str]:
    if not is_dataclass(made):
        return {}
    hints = get_type_hints(made, include_extras=True)
    found = {each.name: description(hints[each.name]) for each in fields(made)}
    return {(each and each.key) or name: name for name, each in found.items()}


COMBINATIONS = ("product", "zip")
MOST_DESIGNS = 1_000_000  # largest number of designs in one computation, so that results fit into memory


@dataclass(frozen=True)
class VariedInput:
    """An input whose value is varied, with its values.

    Parameters
    ----------
    name : str
        Path of the input in files, such as "beam.thickness".
    unit : str
        Unit of the values.
    values : ndarray, shape (n,)
        Values of the input [unit].

    Examples
    --------
    >>> strip = bd.Beam.rectangular(0.05, 0.01, 0.0002, 200e9, 7850.0)
    >>> varied = bd.study(bd.Scene(strip), {"beam.thickness": [0.0002, 0.0004]}, modes=1).inputs[0]
    >>> varied.name, varied.unit
    ('beam.thickness', 'm')
    """

    name: str
    unit: str
    values: np.ndarray

    @property
    def label(self) -> str:
        """Return name and unit of the input, for tables."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name

    @property
    def in_words(self) -> str:
        """Return the name as shown in forms and pictures: "thickness" for "beam.thickness"."""
        return InputName(self.name).on_form


@dataclass(frozen=True)
class Designs:
    """A set of N designs: combinations of values of inputs; the last input of a product changes fastest.

    Parameters
    ----------
    inputs : sequence of VariedInput
        The inputs.
    combine : {"product", "zip"}
        Whether each value is combined with all values of other inputs, or the first values of all inputs make
        a design, the second values another, and so on.
    """

    inputs: Sequence[VariedInput]
    combine: str = "product"

    @property
    def shape(self) -> tuple[int, ...]:
        """Return the shape of result arrays: an axis per input, or one axis for inputs taken together."""
        lengths = tuple(len(each.values) for each in self.inputs)
        return lengths[:1] if self.combine == "zip" else lengths

    @property
    def count(self) -> int:
        """Return the number N of designs; 1 without inputs."""
        return math.prod(self.shape)

    def columns(self, rows: slice | np.ndarray = slice(None)) -> dict[str, np.ndarray]:
        """Return the values of each input in some of the designs, by name of the input."""
        places = np.arange(*rows.indices(self.count)) if isinstance(rows, slice) else rows
        if self.combine == "zip":
            return {each.name: each.values[places] for each in self.inputs}
        indices = np.unravel_index(places, self.shape) if self.inputs else ()
        return {each.name: each.values[i] for each, i in zip(self.inputs, indices, strict=True)}

    def at(self, *place: int) -> dict[str, float]:
        """Return the input values, by name, of the design with indices (i1, ..., id) in the array of designs.

        Raises
        ------
        ValueError
            If the number of indices differs from the number of axes, or an index is out of range.
        """
        if len(place) != len(self.shape):
            raise ValueError(f"place {place}: give one index per axis of the shape {self.shape}")
        if any(not -length <= i < length for i, length in zip(place, self.shape, strict=True)):
            raise ValueError(f"place {place}: it is outside the shape {self.shape}; indices begin at 0")
        places = place * len(self.inputs) if self.combine == "zip" else place
        return {each.name: float(each.values[i]) for each, i in zip(self.inputs, places, strict=True)}

    def chunks(self, size: int) -> list[slice]:
        """Split the row numbers of the designs into slices of at most a given size."""
        return [slice(k, min(k + size, self.count)) for k in range(0, self.count, size)]

    def without(self, name: str) -> Designs:
        """Return a copy of the designs without one of the inputs."""
        return Designs([each for each in self.inputs if each.name != name], self.combine)

    def extremes(self) -> Iterator[dict[str, float]]:
        """Yield all combinations of the smallest and the largest value of each input."""
        ends = [VariedInput(i.name, i.unit, np.unique([i.values.min(), i.values.max()])) for i in self.inputs]
        yield from rows_of(Designs(ends).columns())


def rows_of(columns: dict[str, np.ndarray]) -> list[dict[str, float]]:
    """Convert arrays of input values, by name, to one mapping from names to values for each design."""
    return [
        dict(zip(columns, row, strict=True))
        for row in zip(*(c.tolist() for c in columns.values()), strict=True)
    ]


def check_designs(designs: Designs, most: int = MOST_DESIGNS, option: str = "vary") -> None:
    """Refuse an unknown `combine`, repeated inputs, inputs of unequal length in a zip, and too many designs.

    Parameters
    ----------
    designs : Designs
        The designs.
    most : int
        Largest number of designs.
    option : str
        Name of the option for the inputs, for messages.

    Raises
    ------
    InvalidValue
        The message gives the reason.
    """
    one_of("combine", designs.combine, COMBINATIONS)
    names = [each.name for each in designs.inputs]
    for name in names:
        if names.count(name) > 1:
            raise InvalidValue(option, name, "the input is given twice", "give all its values at once")
    lengths = [len(each.values) for each in designs.inputs]
    if designs.combine == "zip" and len({*lengths}) > 1:
        bound = f"the inputs have {' and '.join(map(str, lengths))} values"
        raise InvalidValue("combine", "zip", bound, "give as many of each to take them together")
    if designs.count > most:
        counts = " x ".join(map(str, lengths)) if designs.combine == "product" else str(designs.count)
        bound = f"at most {most} designs are solved"
        raise InvalidValue(option, f"{counts} values", bound, "give fewer values")
