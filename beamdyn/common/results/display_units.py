"""Units in which tables, columns of CSV files and pictures are shown; everything else is in SI."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from math import pi
from typing import Any, NamedTuple, Self

import numpy as np

from beamdyn.common.inputs.checks import InvalidValue, one_of
from beamdyn.common.results.one_line import known_digits, spanned

# By kind of quantity: how many of each unit make one of the SI unit, which comes first.
_PER_SI = {
    "speed": {"rad/s": 1.0, "rpm": 30 / pi, "deg/s": 180 / pi},
    "length": {"m": 1.0, "mm": 1e3, "cm": 1e2, "um": 1e6, "in": 1 / 0.0254, "ft": 1 / 0.3048},
}


class ShownUnit(NamedTuple):
    """A unit in which a quantity is shown, and its size.

    Parameters
    ----------
    name : str
        Name of the unit, such as "rpm".
    per_si : float
        Number of this unit in one SI unit.
    """

    name: str
    per_si: float

    def of(self, values: Any) -> Any:
        """Convert values from SI to this unit."""
        return values * self.per_si

    def say(self, value: float, digits: int = 6) -> str:
        """Format a value, given in SI, in this unit."""
        return f"{known_digits(value * self.per_si):.{digits}g} {self.name}"


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
        """Make display units from a mapping such as {"speed": "rpm"}.

        Raise a ValueError for an unknown kind.
        """
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
        """Return a copy with the given units in place of its own."""
        new = DisplayUnits.of(given)
        return DisplayUnits(new.speed or self.speed, new.length or self.length)

    def speed_unit(self) -> ShownUnit:
        """Return the unit of speeds; rad/s if none was given."""
        return self._unit("speed", "rad/s")

    def length_unit(self, usual: str = "mm") -> ShownUnit:
        """Return the unit of lengths, or the one that is usual in a place if none was given."""
        return self._unit("length", usual)

    def _unit(self, kind: str, usual: str) -> ShownUnit:
        name = getattr(self, kind) or usual
        return ShownUnit(name, _PER_SI[kind][name])


SI_UNITS = DisplayUnits()


class InDisplayUnits:
    """Base of classes that are shown in units: those of their scene, if they have one, or others."""

    @property
    def display_units(self) -> DisplayUnits:
        """Units of tables, columns and pictures: those of the scene, unless `in_units` gave others."""
        given = vars(self).get("_display_units")
        return given or getattr(getattr(self, "scene", None), "units", SI_UNITS)

    def say_speed(self, speeds: np.ndarray | float) -> str:
        """Format a speed, or the range of several, in its display unit."""
        unit = self.display_units.speed_unit()
        return spanned(np.multiply(speeds, unit.per_si), unit.name)

    def say_length(self, lengths: np.ndarray | float) -> str:
        """Format a length, or the range of several, in its display unit."""
        unit = self.display_units.length_unit()
        return spanned(np.multiply(lengths, unit.per_si), unit.name)

    def in_units(self, speed: str = "", length: str = "") -> Self:
        """Return a copy with tables, columns and pictures in other units; its numbers stay SI.

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
    """Return the name of a unit in which a kind of quantity can be shown; "" if it is none."""
    name = name.replace(" ", "")
    return name if name in _PER_SI[kind] else ""
