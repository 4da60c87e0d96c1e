"""Descriptions of inputs as plain data, from which files, forms and help texts are made."""

from __future__ import annotations

import math
import operator
from collections.abc import Callable, Iterator
from dataclasses import KW_ONLY, dataclass
from functools import cache
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from beamdyn.common.inputs.checks import real, refuse


@dataclass(frozen=True)
class Described:
    """Description of an input, for ``Annotated[float, Described("m", "L", "length")]``.

    Parameters
    ----------
    unit : str
        SI unit; "" for a plain number, or a word.
    symbol : str
        Symbol in formulas.
    meaning : str
        Meaning for people: a phrase without a full stop.
    above, below : float, optional
        Bounds that the value must not reach [unit].
    least, most : float, optional
        Smallest and largest value [unit].
    remedy : str
        Advice about a value out of bounds.
    key : str
        Its key in files, if that is not the name of the argument.
    required : bool
        Whether files must give it, even where the argument has a default.
    default : object, optional
        Value where files leave it out, though the argument has no default.
    infinite : str
        What an infinite value stands for, such as "clamped"; where it is empty, none is allowed.
    whole : bool
        Whether it is a whole number.
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
        """Bounds in words, such as "greater than 0, at most 1"; empty if there are none."""
        return self.bounds_as(lambda bound: bound)

    def bounds_as(self, convert: Callable[[float], float]) -> str:
        """Describe the bounds, with each number converted to another unit."""
        limits = (f"{words} {convert(bound):g}" for words, bound, _ in self._limits())
        return ", ".join([*["a whole number"] * self.whole, *limits])

    def _limits(self) -> Iterator[tuple[str, float, Callable[[Any, float], Any]]]:
        """Yield each bound in words, its number [unit], and the comparison that refuses a value."""
        for words, bound, refuses in (
            ("greater than", self.above, operator.le),
            ("at least", self.least, operator.lt),
            ("below", self.below, operator.ge),
            ("at most", self.most, operator.gt),
        ):
            if bound is not None:
                yield words, bound, refuses

    def is_within_bounds(self, value: float) -> bool:
        """Whether a value [unit] is within all bounds."""
        fits = not self.whole or float(value).is_integer()
        return fits and not any(refuses(value, bound) for _, bound, refuses in self._limits())

    def nearest_within(self, value: float) -> float:
        """Return the value within all bounds that is nearest to a given value [unit]."""
        least = [self.least] if self.above is None else [self.least, math.nextafter(self.above, math.inf)]
        most = [self.most] if self.below is None else [self.most, math.nextafter(self.below, -math.inf)]
        value = max([value, *(bound for bound in least if bound is not None)])
        return min([value, *(bound for bound in most if bound is not None)])

    def refuse_out_of_bounds(self, name: str, values: Any) -> None:
        """Refuse a number or an array of numbers [unit] of which any is out of bounds.

        Raises
        ------
        InvalidValue
            With the name, and the first bound that is not kept.
        """
        if self.whole:
            refuse(values % 1 != 0, name, values, self.unit, "give a whole number")
        for words, bound, refuses in self._limits():
            said = f"it must be {words} {{limit}}"
            refuse(refuses(values, bound), name, values, self.unit, said, self.remedy, limit=bound)

    def check(self, name: str, value: Any) -> Any:
        """Return the value as a float; refuse what is not finite, or out of bounds.

        Raises
        ------
        InvalidValue
            With the name.
        """
        number = real(name, value, self.unit, self.remedy)
        self.refuse_out_of_bounds(name, number)
        return number


def description(hint: Any) -> Described | None:
    """Return the description in an annotation, or in one of its parts; None if there is none."""
    parts = (hint, *get_args(hint))
    found = (entry for part in parts for entry in getattr(part, "__metadata__", ()))
    return next((entry for entry in found if isinstance(entry, Described)), None)


def kinds_of(hint: Any) -> list[Any]:
    """Return the types that an annotation allows, without their descriptions."""
    if get_origin(hint) is Annotated:
        return kinds_of(get_args(hint)[0])
    if get_origin(hint) in (Union, UnionType):
        return [kind for part in get_args(hint) for kind in kinds_of(part)]
    return [hint]


@cache
def described_hints(made: Callable[..., Any]) -> dict[str, Any]:
    """Return the annotations of the described arguments of a dataclass or function, in order."""
    hints = get_type_hints(made, include_extras=True)
    return {name: hint for name, hint in hints.items() if description(hint)}


@cache
def descriptions(made: Callable[..., Any]) -> dict[str, Described]:
    """Return the descriptions of the arguments of a dataclass or function, in order."""
    hints = described_hints(made)
    return {name: found for name, hint in hints.items() if (found := description(hint))}
