"""Types of the inputs of joints and loads, described for checks, files and forms."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Any, get_args

from beamdyn.common.described import Described, described_hints, descriptions, kinds_of
from brakes.planar.points import GROUND, Point, check_point, unit_vector


@dataclass(frozen=True)
class DescribedPoint(Described):
    """Description of a point."""

    def check(self, name: str, value: Any) -> None:
        """Refuse what is not two finite coordinates."""
        check_point(name, value)


@dataclass(frozen=True)
class DescribedDirection(Described):
    """Description of a direction."""

    def check(self, name: str, value: Any) -> None:
        """Refuse what is not two finite components, or has no direction."""
        unit_vector(name, value)


def check_inputs(core: object, prefix: str = "") -> None:
    """Refuse described numbers, points and directions that are not as described.

    Parameters
    ----------
    core : object
        An instance of a dataclass; None is allowed for each of its inputs.
    prefix : str
        Put before their names in messages.

    Raises
    ------
    ValueError
        With the first that is refused.
    """
    hints = described_hints(type(core))
    for name, described in descriptions(type(core)).items():
        value, (kind, *_) = getattr(core, name), kinds_of(hints[name])
        if value is None or (type(described) is Described and kind is not float):
            continue
        for part in value if is_list(hints[name]) else (value,):
            described.check(prefix + name, part)


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
