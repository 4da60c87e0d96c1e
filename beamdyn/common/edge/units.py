"""Conversion of texts with a number and a unit to SI: "0.2 mm", "525 rpm", "7850 kg/m3"."""

from __future__ import annotations

import json
import math
import re
import unicodedata
from collections.abc import Callable
from datetime import date, time
from decimal import Decimal
from functools import cache
from typing import TYPE_CHECKING

from beamdyn.common.inputs.checks import InvalidValue

if TYPE_CHECKING:  # imported when a quantity first needs it, as the import of pint takes 0.3 s
    from pint import Unit, UnitRegistry

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_FACTOR = r"[A-Za-z_%°µμΩ]+(?:(?:\^|\*\*)?-?[1-9])?"
_SEPARATOR = r"(?:\s*[*/]\s*|\s+)"
# "1/s" must follow a blank: in 0.51/s, the number could be 0.5 or 0.51.
_UNITS = rf"(?<=\s)1/{_FACTOR}|{_FACTOR}(?:{_SEPARATOR}{_FACTOR})*"
_TEXT = re.compile(rf"\s*({_NUMBER})\s*((?:{_UNITS})?)\s*", re.ASCII)
_NO_NUMBER = re.compile(r"\s*[+-]?(nan|inf)", re.IGNORECASE)
_POWER = re.compile(r"(?:\^|\*\*)?(-?\d)")
# Minus signs and blanks as they occur in texts copied from printed pages.
_MINUS_SIGNS, _SPACES = "\u2212\u2013\uff0d", "\u00a0\u2007\u2009\u202f"
_PLAIN = str.maketrans(
    {"²": "2", "³": "3", "⁴": "4", "·": "*", "⋅": "*", "\uff0e": "."}
    | dict.fromkeys(_MINUS_SIGNS, "-")
    | dict.fromkeys(_SPACES, " ")
    | {0xFF10 + digit: str(digit) for digit in range(10)}  # full-width digits of East Asian fonts
)
# Patterns: the separator between several quantities in a text, and the text before a number.
_BETWEEN, _BEFORE_NUMBER = re.compile(r"[:,]|\bto\b"), re.compile(r"^[^\d.]*")
_KNOWN_SIGNS = "°µμΩ"  # characters of units that are not ASCII

_KINDS = {
    "m": "length",
    "m2": "area",
    "m4": "second moment of area",
    "kg": "mass",
    "kg/m": "mass per length",
    "kg/m3": "density",
    "kg m": "rotary inertia per length",
    "kg m2": "moment of inertia",
    "s": "time",
    "1/s": "rate",
    "Hz": "frequency",
    "rad": "angle",
    "rad/s": "angular speed",
    "rad/s2": "angular acceleration",
    "m/s": "velocity",
    "m/s2": "acceleration",
    "N": "force",
    "N/m": "stiffness",
    "N s/m": "damping",
    "N m": "moment",
    "N m/rad": "stiffness against rotation",
    "N m2": "bending stiffness",
    "Pa": "pressure or modulus",
    "1/Pa": "compliance",
    "ohm": "resistance",
    "C/m2": "piezoelectric stress constant",
    "m/V": "piezoelectric strain constant",
    "F/m": "permittivity",
    "W": "power",
    "K": "temperature",
    "": "plain number",
}
# Factors of common units, so that reading them does not load pint, which takes longer than most commands;
# factors of angles have more digits than a float can hold, so that conversion adds no error.
_COMMON = {
    "m": {"mm": "0.001", "cm": "0.01"},
    "kg": {"g": "0.001"},
    "kg m2": {"g mm2": "1e-9"},
    "Pa": {"GPa": "1e9", "MPa": "1e6"},
    "rad": {"deg": "0.0174532925199432957692369076848861"},
    "rad/s": {"rpm": "0.104719755119659774615421446109317"},
}
_USUAL = {"m": "mm", "kg": "g", "rad": "deg", "rad/s": "rpm", "Pa": "GPa", "kg m2": "g mm2"}


class InvalidInput(InvalidValue):
    """Raised for an invalid value in a file, form or command; the message shows it in TOML notation."""

    @property
    def shown(self) -> str:
        """Return the value as shown in the message."""
        return super().shown if isinstance(self.value, float) else show(self.value)


def quantity(text: object, unit: str) -> float:
    """Convert a text with a number and a unit to SI units.

    Parameters
    ----------
    text : str
        A number and a unit, such as "0.2 mm" or "7850 kg/m^3".
    unit : str
        SI unit of the result, such as "m" or "kg/m3".  Angles count as a dimension: neither "5 Hz"
        nor "5 %" is a number of radians.

    Returns
    -------
    float
        The value in `unit`, converted in decimal: "5 cm" and "50 mm" are the same to the last bit.

    Raises
    ------
    InvalidInput
        If `text` is not a finite number with a unit of the same kind as `unit`; its `field` is empty.
    """
    number, given = _split(text, unit)
    if (factor := _common_factor(given, unit)) is not None:
        return _finite(_product(number, factor), text, unit)
    kind, wanted = _parse(given), _parse(unit)
    if kind is None or wanted is None:
        raise InvalidInput(
            "", text, f"unknown unit {given}", f"give {_kind(unit)}, e.g. {_example(unit, number)}"
        )
    if _root(kind) != _root(wanted):
        raise InvalidInput("", text, _mismatch(number, kind, unit))
    return _finite(_convert(number, kind, wanted), text, unit)


def _finite(value: float, text: object, unit: str) -> float:
    if not math.isfinite(value):
        raise InvalidInput("", text, "out of range", f"give a finite number in {unit}")
    return value


def _common_factor(given: str, unit: str) -> Decimal | None:
    """Return the conversion factor from a unit to an SI unit if the unit is a common one, else None."""
    factor = "1" if given == unit else _COMMON.get(unit, {}).get(given)
    return None if factor is None else Decimal(factor)


def _product(number: str, factor: Decimal) -> float:
    try:
        return float(Decimal(number) * factor)
    except ArithmeticError:  # the exponent is outside the range of decimal numbers
        return math.nan


def unit_as_written(text: object, unit: str) -> tuple[str, Callable[[float], float]]:
    """Return the unit written in a text, and the function that converts numbers from `unit` to it.

    If the text has no unit of the same kind, return `unit` itself.  For an angle, "%" means the gradient of a
    slope.
    """
    match = _TEXT.fullmatch(text.translate(_PLAIN)) if isinstance(text, str) and unit else None
    if match is None or not (written := match[2]):
        return unit, float
    if (written, unit) == ("%", "rad"):
        return written, lambda angle: 100 * math.tan(angle)
    if (factor := _common_factor(written, unit)) is not None:
        return written, lambda number: _product(repr(float(number)), 1 / factor)
    kind, wanted = _parse(written), _parse(unit)
    if kind is None or wanted is None or _root(kind) != _root(wanted):
        return unit, float
    return written, lambda number: _convert(repr(float(number)), wanted, kind)


def last_quantity(text: str) -> str:
    """Return the last of several quantities in a text, such as "100:5 rpm", with the unit common to all."""
    return _BEFORE_NUMBER.sub("", _BETWEEN.split(text)[-1])


def show(value: object, depth: int = 2) -> str:
    """Format a value as TOML writes it; a long or deeply nested value is shortened."""
    text = _toml(value, depth)
    return text if len(text) <= 60 else text[:57] + "..."


def _toml(value: object, depth: int) -> str:
    match value:
        case bool():
            return str(value).lower()
        case str():
            return json.dumps(value, ensure_ascii=False)
        case dict() | list() if value and not depth:
            return "..."
        case list():
            return f"[{', '.join(show(v, depth - 1) for v in value)}]"
        case dict() if value:
            return f"{{ {', '.join(f'{k} = {show(v, depth - 1)}' for k, v in value.items())} }}"
        case date() | time():
            return value.isoformat()
    return repr(value)


@cache
def _registry() -> UnitRegistry:
    import pint

    registry = pint.UnitRegistry(non_int_type=Decimal)  # pyright: ignore[reportArgumentType]  (works; typed too narrowly)
    registry.define("newton_meter = newton * meter = Nm")
    return registry


def _split(given: object, unit: str) -> tuple[str, str]:
    """Split a text into number and unit, both as written."""
    bare = isinstance(given, int | float) and not isinstance(given, bool)
    text = str(given) if bare or isinstance(given, str) else ""
    match = _TEXT.fullmatch(text.translate(_PLAIN))
    if match is None:
        raise InvalidInput("", given, *_no_quantity(given, unit))
    number, name = match.groups()
    if unit and not name:
        choices = dict.fromkeys((f'"{number} {unit}"', f'"{number} {usual_unit(unit)}"'))
        raise InvalidInput("", given, f"give a unit, e.g. {' or '.join(choices)}")
    return number, name


@cache
def _parse(unit: str) -> Unit | None:
    """Parse a unit (m2, m^2 and m**2 are the same); return None if there is no such unit."""
    from pint.errors import PintError

    try:
        return _registry().Unit(_POWER.sub(r"**\1", f"{unit[2:]}-1" if unit.startswith("1/") else unit))
    except PintError:
        return None


def _root(unit: Unit) -> Unit:
    """Return a unit as a product of base units; radians are kept, so that rpm and Hz differ."""
    return _registry().get_root_units(unit)[1]


def _convert(number: str, kind: Unit, wanted: Unit) -> float:
    try:
        return float(_registry().Quantity(Decimal(number), kind).to(wanted).magnitude)
    except (ArithmeticError, TypeError):  # too large an exponent, or a logarithmic unit
        return math.nan


def _mismatch(number: str, kind: Unit, unit: str) -> str:
    names = {_root(parsed): name for text, name in _KINDS.items() if (parsed := _parse(text)) is not None}
    if unit == "rad/s" and names.get(_root(kind)) == "frequency":
        turns = f'"{60 * float(number):g} rpm"' if f"{kind:~}" == "Hz" else "rpm"
        return f"ambiguous for an angular speed; give {turns} if turns are meant, rad/s if radians"
    kind_of = names.get(_root(kind), f"{kind:~C}")
    return f"a unit of {kind_of} where {_kind(unit)} is wanted; give e.g. {_example(unit, number)}"


def _no_quantity(given: object, unit: str) -> tuple[str, str]:
    """Return why a value is not a number with a unit, and how to write it."""
    match given:
        case bool():
            return "a truth value", f"give a quantity, e.g. {_example(unit)}"
        case [str() as one] if _TEXT.fullmatch(one.translate(_PLAIN)):
            return "a list where one quantity is wanted", f"give it without brackets, {show(one)}"
        case list() | tuple():
            return "a list where one quantity is wanted", f"give e.g. {_example(unit)}"
        case dict():
            return "a table where one quantity is wanted", f"give e.g. {_example(unit)}"
        case float() | str() if _NO_NUMBER.match(str(given)):
            return "not a finite number", f"give e.g. {_example(unit)}"
        case str() if odd := odd_character(given):
            return f"not a number with a unit: it has the character {odd}", f"give e.g. {_example(unit)}"
        case str() if _TEXT.fullmatch(point := given.translate(_PLAIN).replace(",", ".", 1)):
            return "a decimal comma", f"give a point, {show(point)}"
    return "not a number with a unit", f"give e.g. {_example(unit)}"


def in_plain_characters(text: str) -> str:
    """Replace minus signs, blanks and digits copied from printed pages by ASCII characters."""
    return text.translate(_PLAIN)


def odd_character(text: str) -> str:
    """Return the name of the first character that can occur in no number or unit; empty if there is none."""
    plain = text.translate(_PLAIN)
    odd = next((c for c in plain if not (c.isascii() or c in _KNOWN_SIGNS)), "")
    return f"{unicodedata.name(odd, 'without a name')} (U+{ord(odd):04X})" if odd else ""


def _example(unit: str, number: str = "1") -> str:
    """Format a quantity as in a file, with the number as the user wrote it."""
    return f'"{number} {usual_unit(unit)}"' if unit else number


def _kind(unit: str) -> str:
    return _KINDS.get(unit, f"a quantity in {unit}")


def usual_unit(unit: str) -> str:
    """Return the unit in which a quantity is usually written, for its SI unit: "deg" for "rad"."""
    return _USUAL.get(unit, unit)
