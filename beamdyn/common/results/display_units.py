"""Units in which results are shown to people: tables, columns of CSV files and pictures; all else is SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import pi
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, one_of
from beamdyn.common.results.one_line import spanned

if TYPE_CHECKING:
    from typing import Self


# By kind of quantity: how many of each unit make one of SI, which stands first.
_PER_SI = {
    "speed": {"rad/s": 1.0, "rpm": 30 / pi, "deg/s": 180 / pi},
    "length": {"m": 1.0, "mm": 1e3, "cm": 1e2, "um": 1e6, "in": 1 / 0.0254, "ft": 1 / 0.3048},
}


class ShownUnit(NamedTuple):
    """A unit in which a quantity is shown.

    Parameters
    ----------
    name : str
        Such as "rpm".
    per_si : float
        How many make one of SI.
    """

    name: str
    per_si: float

    def of(self, values: Any) -> Any:
        """Values in this unit, from SI."""
        return values * self.per_si

    def say(self, value: float, digits: int = 6) -> str:
        """A value with its unit, from SI."""
        return f"{value * self.per_si:.{digits}g} {self.name}"


@dataclass(frozen=True)
class DisplayUnits:
    """Units in which speeds and lengths are shown.

    Parameters
    ----------
    speed : {"", "rad/s", "rpm", "deg/s"}
        Unit of speeds of rotation; "": that which is usual in its place, rad/s.
    length : {"", "m", "mm", "cm", "um", "in", "ft"}
        Unit of lengths; "": that which is usual in its place, such as mm for deflections.

    Raises
    ------
    ValueError
        If a unit is not known.

    Examples
    --------
    >>> scene = bd.Scene(bd.Beam.from_stiffness(1.0, 1.0, 1.0), units=bd.DisplayUnits(speed="rpm"))
    >>> scene.units.speed
    'rpm'
    """

    speed: str = ""
    length: str = ""

    def __post_init__(self) -> None:
        for kind, known in _PER_SI.items():
            one_of(f"units.{kind}", getattr(self, kind), ("", *known))

    @classmethod
    def of(cls, given: DisplayUnits | Mapping[str, str] | None) -> DisplayUnits:
        """Make them of a mapping such as {"speed": "rpm"}; raises a ValueError for an unknown kind."""
        if isinstance(given, cls):
            return given
        kinds = [each.name for each in fields(cls)]
        remedy = 'give a dictionary such as {"speed": "rpm", "length": "mm"}'
        if given is not None and not isinstance(given, Mapping):
            raise InvalidValue("units", given, "", remedy)
        for kind in given or {}:
            if kind not in kinds:
                raise InvalidValue("units", kind, f"it is none of {', '.join(kinds)}", remedy)
        return cls(**(given or {}))

    def with_others(self, given: DisplayUnits | Mapping[str, str] | None) -> DisplayUnits:
        """A copy with the given units in place of its own."""
        new = DisplayUnits.of(given)
        return DisplayUnits(new.speed or self.speed, new.length or self.length)

    def speed_unit(self) -> ShownUnit:
        """Unit of speeds: rad/s if none was given."""
        return self._unit("speed", "rad/s")

    def length_unit(self, usual: str = "mm") -> ShownUnit:
        """Unit of lengths, or the one that is usual in a place if none was given."""
        return self._unit("length", usual)

    def _unit(self, kind: str, usual: str) -> ShownUnit:
        name = getattr(self, kind) or usual
        return ShownUnit(name, _PER_SI[kind][name])


SI_UNITS = DisplayUnits()


class InDisplayUnits:
    """Base of what is shown in units: those of its scene, if it has one, or others."""

    @property
    def display_units(self) -> DisplayUnits:
        """Units of its tables, columns and pictures: those of its scene, unless `in_units` gave others."""
        given = vars(self).get("_display_units")
        return given or getattr(getattr(self, "scene", None), "units", SI_UNITS)

    def say_speed(self, speeds: np.ndarray | float) -> str:
        """A speed, or from where to where several go, in its display unit, for the headline."""
        unit = self.display_units.speed_unit()
        return spanned(np.multiply(speeds, unit.per_si), unit.name)

    def say_length(self, lengths: np.ndarray | float) -> str:
        """A length, or from where to where several go, in its display unit, for the headline."""
        unit = self.display_units.length_unit()
        return spanned(np.multiply(lengths, unit.per_si), unit.name)

    def in_units(self, speed: str = "", length: str = "") -> Self:
        """A copy with tables, columns and pictures in other units; its numbers stay SI.

        Parameters
        ----------
        speed : {"rad/s", "rpm", "deg/s"}, optional
            Unit of speeds of rotation.
        length : {"m", "mm", "cm", "um", "in", "ft"}, optional
            Unit of lengths.

        Raises
        ------
        ValueError
            If a unit is not known.
        """
        shown = object.__new__(type(self))
        vars(shown).update(vars(self))
        units = self.display_units.with_others({"speed": speed, "length": length})
        object.__setattr__(shown, "_display_units", units)
        return shown


def known_unit(kind: str, name: str) -> str:
    """The name of a unit if it is one in which a kind of quantity can be shown, else ""."""
    name = name.replace(" ", "")
    return name if name in _PER_SI[kind] else ""
