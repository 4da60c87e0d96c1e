"""Reading of options for varied inputs, such as "stop.speed=10:30:9 km/h", and inputs with tolerances."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import get_args, get_origin

import numpy as np

from beamdyn.common.edge.command_options import SPREAD
from beamdyn.common.edge.inputs import Input, parts_of
from beamdyn.common.edge.units import InvalidInput, in_plain_characters, odd_character, quantity
from beamdyn.common.inputs.checks import InvalidValue
from beamdyn.common.inputs.described import Designs, VariedInput
from beamdyn.common.spreading.tolerances import SpreadInput, parse_tolerance

# Varied inputs -------------------------------------------------------------------------------------


_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_NO_NUMBER = re.compile(r"(?<!\w)[+-]?(nan|inf(inity)?)(?!\w)", re.IGNORECASE)
_RANGE = re.compile(rf"\s*({_NUMBER})\s*:\s*({_NUMBER})\s*:\s*(\d+)\s*(?::?\s*(log)\b)?\s*([^:]*?)\s*")
_LIST = re.compile(rf"\s*({_NUMBER}(?:\s*,\s*{_NUMBER})+)\s*(.*?)\s*")
MOST_AT_ONCE = 100_000  # largest number of designs that are solved at once, as arrays


@dataclass(frozen=True)
class Axis:
    """A varied input and its values.

    Parameters
    ----------
    input : Input
        The input.
    unit : str
        Unit in which the values were given.
    given : ndarray, shape (n,)
        The values in this unit.
    values : ndarray, shape (n,)
        The values in SI units.
    """

    input: Input
    unit: str
    given: np.ndarray
    values: np.ndarray


@dataclass(frozen=True)
class Coordinate(Input):
    """One coordinate of an input that is a point in the plane.

    Parameters
    ----------
    of : Input
        The input that is a point.
    place : int
        Index of the coordinate.
    """

    of: Input
    place: int


def numbers(inputs: Sequence[Input]) -> list[Input]:
    """List the inputs that can be varied: numbers, and the coordinates of points."""
    found: list[Input] = []
    for entry in inputs:
        parts = [*parts_of(entry.kind)]
        if get_origin(entry.kind) is tuple:
            for place, (axis, _) in enumerate(zip("xy", get_args(entry.kind), strict=True)):
                words = replace(entry.quantity, meaning=f"{axis} of the {entry.quantity.meaning}")
                path = f"{entry.path}.{axis}"
                found.append(
                    Coordinate(path, entry.section, float, words, (), entry.required, None, entry, place)
                )
        elif float in parts and not any(get_origin(part) in (list, tuple, dict) for part in parts):
            found.append(entry)
    return found


def parse_axis(inputs: Sequence[Input], text: str, option: str = "--vary", most: int = MOST_AT_ONCE) -> Axis:
    """Read the option text for a varied input: the input's key and its values.

    Parameters
    ----------
    inputs : sequence of Input
        Inputs that may be varied.
    text : str
        KEY=start:stop:count unit, at equal steps; start:stop:count:log unit, at equal ratios; or a list,
        KEY=1,2,5 unit.  The key is a path such as "beam.length", or its last part if this is unambiguous.
    option : str
        Name of the option that gives the text, for messages.
    most : int
        Largest number of values.

    Returns
    -------
    Axis

    Raises
    ------
    ValueError
        If there is no such input, or the values are not valid for it.
    """
    key, _, given = text.partition("=")
    rest, words = in_plain_characters(given), f'{option} = "{text}"'
    entry = find_input(inputs, key.strip(), words)
    if match := _RANGE.fullmatch(rest):
        start, stop, count, unit = float(match[1]), float(match[2]), int(match[3]), match[5]
        if not 2 <= count <= most or start == stop:
            raise ValueError(f"{words}: give two different ends, and a count from 2 to {most}")
        if match[4] and not start * stop > 0:
            raise ValueError(f"{words}: equal ratios need two ends of one sign, neither of them 0")
        low, high = (_in_si(entry, number, unit, words) for number in match.group(1, 2))
        spaced = np.geomspace if match[4] else np.linspace
        return Axis(entry, unit, spaced(start, stop, count), spaced(low, high, count))
    if match := _LIST.fullmatch(rest):
        parts = [part.strip() for part in match[1].split(",")]
        values = [_in_si(entry, part, match[2], words) for part in parts]
        return Axis(entry, match[2], np.array([*map(float, parts)]), np.array(values))
    if odd := _NO_NUMBER.search(rest):
        raise ValueError(f"{words}: {odd[0]} is not a finite number; give numbers")
    if odd := odd_character(rest):
        raise ValueError(f"{words}: it has the character {odd}, which no number or unit has")
    unit = f" {entry.quantity.unit}".rstrip()
    form = f'"{entry.path}=1:2:11{unit}", at equal ratios "1:2:11:log{unit}", or a list, "1,1.5,2{unit}"'
    raise ValueError(f"{words}: give KEY=start:stop:count unit, e.g. {form}")


def _in_si(entry: Input, number: str, unit: str, words: str) -> float:
    """Convert a value to SI units, and check it against the bounds of the input `entry`.

    An error message begins with `words`, the option as it was given.
    """
    quantity = entry.quantity
    given = f"{number} {unit}".strip() if quantity.unit or unit else float(number)
    try:
        return quantity.within_bounds(given, quantity.convert(given))
    except InvalidInput as error:
        raise ValueError(f"{words}: {replace(error, field=entry.path)}") from None


def find_input(inputs: Sequence[Input], key: str, words: str) -> Input:
    """Return the input for a key, which is the input's path or the last part of this path.

    Parameters
    ----------
    inputs : sequence of Input
        Inputs that the key may mean, including choices among words, which have an error message of their own.
    key : str
        The key.
    words : str
        The option as it was given, for messages.

    Raises
    ------
    ValueError
        If no input or several inputs have this key, or the input is a choice among words.
    """
    matches = [i for i in inputs if key in (i.path, i.name)]
    if all(i.required or i.default is None for i in matches):
        # A required input takes precedence over inputs that default to it, such as those of a second shoe.
        matches = [i for i in matches if i.required] or matches
    if len(matches) > 1:
        raise ValueError(f"{words}: {key} is ambiguous; give {' or '.join(i.path for i in matches)}")
    numbers = [i for i in inputs if not i.choices]
    if not matches:
        raise ValueError(f"{words}: {unknown(key, [i.path for i in numbers], [i.name for i in numbers])}")
    if choices := matches[0].choices:
        says = f"it is a choice ({', '.join(map(str, choices))}), no number: use a file for each; numbers are"
        raise ValueError(f"{words}: {matches[0].path}: {says} {', '.join(i.path for i in numbers)}")
    return matches[0]


def unknown(key: str, names: Sequence[str], more: Sequence[str] = ()) -> str:
    """Describe the unknown name `key`, and suggest the most similar of `names` and `more`.

    If none is similar, list `names`.
    """
    near = difflib.get_close_matches(key, [*names, *more], n=1)
    advice = f"did you mean {near[0]}?" if near else f"known are {', '.join(names)}"
    return f"unknown name {key!r}; {advice}"


def designs_of(axes: Sequence[Axis], combine: str = "product") -> Designs:
    """Make the designs from varied inputs, with values in the units that the user gave.

    Parameters
    ----------
    axes : sequence of Axis
        The inputs.
    combine : {"product", "zip"}
        Whether every value is combined with every value of the other inputs, or the n-th values of all inputs
        make a design.
    """
    return Designs([VariedInput(axis.input.path, axis.unit, axis.given) for axis in axes], combine)


# Tolerances ------------------------------------------------------------------------------------------


def parse_spreads(
    inputs: Sequence[Input], texts: Sequence[str], nominal: Callable[[Input], tuple[float, str]]
) -> tuple[SpreadInput, ...]:
    """Read the option texts for inputs with tolerances.

    Parameters
    ----------
    inputs : sequence of Input
        Inputs that may have a tolerance.
    texts : sequence of str
        KEY=TOLERANCE for each input; the key is as for `parse_axis`.
    nominal : callable
        ``nominal(input)`` returns the nominal value of an input in SI units, and its SI unit.

    Returns
    -------
    tuple of SpreadInput

    Raises
    ------
    ValueError
        If there is no such input, an input is given twice, or a tolerance cannot be read.
    """
    made: dict[str, SpreadInput] = {}
    for text in texts:
        words = f'{SPREAD} = "{text}"'
        key, _, tolerance = (part.strip() for part in text.partition("="))
        if not tolerance:
            raise ValueError(f'{words}: give KEY=TOLERANCE, such as "{key or "thickness"}=+-2%"')
        entry = find_input(inputs, key, words)
        if entry.path in made:
            raise ValueError(f"{words}: {entry.path} has a tolerance already; give each input once")
        value, unit = nominal(entry)

        def in_si(number: str, written: str, unit: str = unit) -> float:
            return quantity(f"{number} {written}".strip(), unit)

        try:
            given = parse_tolerance(entry.path, tolerance, value, unit, in_si)
        except InvalidValue as error:
            said = f"{entry.path}={tolerance}"
            raise InvalidInput(SPREAD, said, error.bound, error.remedy, error.unit, error.limit) from None
        made[entry.path] = SpreadInput(entry.path, unit, value, given)
    return tuple(made.values())
