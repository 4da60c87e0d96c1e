"""Types of the inputs of joints and loads, described for checks, files and forms."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from types import NoneType
from typing import Annotated, Any, NamedTuple, get_args

from beamdyn.common.checks import flag, kind, set_fields, several
from beamdyn.common.described import Described, described_hints, descriptions, kinds_of
from brakes.planar.points import GROUND, Point, check_point, unit_vector


@dataclass(frozen=True)
class DescribedPoint(Described):
    """Description of a point."""

    def check(self, name: str, value: Any) -> Point:
        """The point; what is not two finite coordinates is refused."""
        return check_point(name, value)


@dataclass(frozen=True)
class DescribedDirection(Described):
    """Description of a direction."""

    def check(self, name: str, value: Any) -> Point:
        """The unit vector; what is not two finite components, or has no direction, is refused."""
        return unit_vector(name, value)


def check_inputs(core: object, prefix: str = "") -> None:
    """Refuse described inputs that are not as described, and keep numbers as floats.

    Parameters
    ----------
    core : object
        An instance of a frozen dataclass.
    prefix : str
        Put before their names in messages.

    Raises
    ------
    ValueError
        With the first that is refused.
    """
    for name, wanted in _wanted(type(core)).items():
        value = getattr(core, name)
        if value is None and wanted.optional:
            continue
        if wanted.listed:
            for k, part in enumerate(several(prefix + name, value, object)):
                _check(f"{prefix}{name}[{k}]", part, wanted.kind, wanted.described)
        elif (checked := _check(prefix + name, value, wanted.kind, wanted.described)) is not None:
            set_fields(core, **{name: checked})


class _Wanted(NamedTuple):
    """What is wanted of an input: its type, or that of its parts if it is a list; whether it may be None."""

    kind: Any
    listed: bool
    optional: bool
    described: Described


@cache
def _wanted(core: type) -> dict[str, _Wanted]:
    """What is wanted of each input of a dataclass: told once, since designs are made by the thousand."""
    hints = described_hints(core)
    return {name: _read(hints[name], described) for name, described in descriptions(core).items()}


def _read(hint: Any, described: Described) -> _Wanted:
    kinds, listed = kinds_of(hint), is_list(hint)
    kind = kinds_of(get_args(kinds[0])[0])[0] if listed else kinds[0]
    return _Wanted(kind, listed, NoneType in kinds, described)


def _check(name: str, value: object, wanted: Any, described: Described) -> float | None:
    """Refuse a value that is not as described; a number is returned as a float."""
    if wanted is float:
        return described.check(name, value)
    if wanted is str:
        kind(name, value, str)
    elif wanted is bool:
        flag(name, value)
    elif type(described) is not Described:
        described.check(name, value)
    return None


def is_list(hint: Any) -> bool:
    """Whether an annotation is that of a tuple of any length."""
    return Ellipsis in get_args(kinds_of(hint)[0])


Body = Annotated[str, Described(meaning="body")]
Other = Annotated[str, Described(meaning="other body; the ground if not given", default=GROUND)]
DrawnPoint = Annotated[Point, DescribedPoint("m", meaning="point in the drawing")]
Direction = Annotated[Point, DescribedDirection(meaning="direction, as a vector or an angle")]
Length = Annotated[float, Described("m", meaning="length, if not the drawing's", above=0)]
Coefficient = Annotated[
    float,
    Described(
        symbol="mu",
        meaning="coefficient of friction",
        least=0,
        remedy="friction opposes the motion by itself; give its size",
    ),
]


def _magnitude(unit: str) -> Described:
    return Described(
        unit, meaning="magnitude; unknown if not given", remedy="or None for an unknown amplitude"
    )


Newtons = Annotated[float, _magnitude("N")]
NewtonMetres = Annotated[float, _magnitude("N m")]
