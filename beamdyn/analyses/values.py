"""Reading of option values: numbers with units, ranges and lists of speeds."""

from __future__ import annotations

import re
from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from cyclopts import Parameter, Token

import beamdyn as bd
from beamdyn.common.edge.config import ConfigError
from beamdyn.common.edge.units import InvalidInput, quantity
from beamdyn.common.results.columns import known_unit
from beamdyn.files.scenes import as_velocity
from beamdyn.scene.motion.rolling import RollingWheel

if TYPE_CHECKING:
    from beamdyn.common.edge.inputs import Quantity


_MOST_SPEEDS = 10_000
_WHOLE = re.compile(r"[-+]?\d{1,18}", re.ASCII)
_UNIT = re.compile(r"[A-Za-zµ°%]+(\s*/\s*[A-Za-z]+)?$")
_NUMBER = re.compile(r"[-+]?[\d.]+([eE][-+]?\d+)?")


def at_most(most: int) -> Parameter:
    """Describe a whole-number option with a largest value, above which a command would take hours."""

    def whole(kind: object, tokens: Sequence[Token]) -> int | str:
        """Read a whole number, or "auto" if the type of the option, `kind`, is not int.

        The option parser cyclopts calls this function; by itself it would cut 2.5 down to 2.
        """
        text, auto = tokens[0].value.strip(), kind is not int
        if auto and text == "auto":
            return text
        if not _WHOLE.fullmatch(text):
            raise ValueError(f'"{text}" is not a whole number{" or auto" if auto else ""}.')
        return int(text)

    def check(_: object, value: object) -> None:
        if isinstance(value, int) and value > most:
            raise ValueError(f"Give at most {most}.")

    return Parameter(converter=whole, validator=check)


def parse_quantity(option: str, text: str, of: str | Quantity) -> float:
    """Convert a number with a unit to SI units; raise InvalidInput, naming the option, for any other text.

    `of` is the SI unit, or the description of the quantity.
    """
    try:
        return quantity(text, of) if isinstance(of, str) else of.convert(text)
    except InvalidInput as error:
        raise replace(error, field=option) from None


def parse_positive(option: str, text: str, unit: str, scene: bd.Scene | None = None) -> float:
    """Read a positive number with its unit, in SI units; with a scene, a speed, as `parse_speed` does."""
    value = parse_quantity(option, text, unit) if scene is None else parse_speed(option, text, scene)
    if value <= 0:
        raise ValueError(f'{option} = "{text}": it must be greater than 0')
    return value


def parse_speed(option: str, text: str, scene: bd.Scene | None = None) -> float:
    """Convert a speed with its unit to rad/s; raise ValueError, naming the option, for any other text.

    For a scene with a rolling wheel, the text may be the velocity of the vehicle, such as "60 km/h".
    """
    if scene is not None and isinstance(scene.motion, RollingWheel):
        velocity = as_velocity(text)
        if velocity is not None:
            return velocity / scene.motion.rolling_radius
    return parse_quantity(option, text, "rad/s")


def parse_window(text: str, t_end: float | None = None) -> tuple[float, float]:
    """Read start and end [s] in ``--window``, such as "20:30 s"; raise an error if it ends after `t_end`."""
    unit = _UNIT.search(text.strip())
    ends = text.strip()[: unit.start()].split(":") if unit else []
    if unit is None or len(ends) != 2:
        raise ValueError(f'--window = "{text}": give start:end and a unit, e.g. "20:30 s"')
    start, end = (parse_quantity("--window", f"{part.strip()} {unit.group()}", "s") for part in ends)
    if not 0 <= start < end:
        raise ValueError(f'--window = "{text}": it must start at 0 or later and end after its start')
    if t_end is not None and end > t_end:
        raise ValueError(f'--window = "{text}": it ends after the run, at {t_end:g} s; give a longer --t-end')
    return start, end


def parse_speeds(text: str, scene: bd.Scene | None = None) -> np.ndarray:
    """Read the speeds [rad/s] in ``--speeds``: start:stop:count or a list, with a unit at the end.

    Parameters
    ----------
    text : str
        The option's text, e.g. "0:150:301 rad/s" or "0, 50, 100 rad/s".
    scene : Scene, optional
        The scene; if its wheel rolls, velocities are allowed as in `parse_speed`.

    Returns
    -------
    ndarray, shape (S,)

    Raises
    ------
    ValueError
        If there are no speeds, they do not ascend, or a unit of angular speed is missing.
    """

    def refusal(said: str) -> ValueError:
        return ValueError(f'--speeds = "{text}": {said}')

    def member(number: str) -> float:
        if not _NUMBER.fullmatch(number):
            example = 'give numbers and one unit at their end, e.g. "0, 50, 100 rad/s"'
            raise refusal(f"'{number}' is not a number; {example}")
        return parse_speed("--speeds", f"{number} {unit}", scene)

    if not text.strip(" ,:"):
        raise refusal('it is empty; give e.g. "0:150:301 rad/s" or "0, 50, 100 rad/s"')
    match = _UNIT.search(text.strip())
    if match is None:
        raise refusal(f'give a unit at its end, e.g. "{text.strip()} rad/s"')
    unit, numbers = match.group(), text.strip()[: match.start()]
    if ":" not in numbers:
        parts = [part.strip() for part in numbers.split(",")]
        values = [member(part) for part in parts]
        if any(high <= low for low, high in pairwise(values)):
            written = {float(part): part for part in parts}
            ordered = ", ".join(written[number] for number in sorted(written))
            raise refusal(f'the speeds must ascend without repeats; give "{ordered} {unit}"')
        return np.array(values)
    parts = [part.strip() for part in numbers.split(":")]
    if len(parts) != 3:
        raise refusal('give start:stop:count, e.g. "0:150:301 rad/s"')
    start, stop = map(member, parts[:2])
    if not parts[2].isdecimal() or not 1 <= int(parts[2]) <= _MOST_SPEEDS:
        raise refusal(f"the count {parts[2]!r} must be a whole number from 1 to {_MOST_SPEEDS}")
    if start > stop or (start == stop) != (int(parts[2]) == 1):
        raise refusal("start must be below stop (with a count of 1: equal to it)")
    return np.linspace(start, stop, int(parts[2]))


def parse_amounts(option: str, text: str, of: str | Quantity, example: str) -> tuple[list[float], list[str]]:
    """Read a list of numbers with a unit at its end, such as "62.1, 389 Hz".

    Return the values, in SI units, and the numbers as written.  `of` is the SI unit, or the description of
    the quantity; `example` is a valid text for the error message.
    """
    found = _UNIT.search(text.strip())
    values = [value for (value,) in _tuples(option, text, 1, example, of)]
    return values, [part.strip() for part in text.strip()[: found.start() if found else None].split(",")]


def parse_positions(option: str, text: str) -> list[float]:
    """Read positions along the beam [m]: a list with a unit at its end, such as "0, 10, 25 mm"."""
    return [x for (x,) in _tuples(option, text, 1, "0, 10, 25 mm")]


def parse_points(option: str, text: str) -> list[list[float]]:
    """Read points of a cross-section [m]: pairs with a unit at the end, such as "-0.1:0, 0.1:2 mm"."""
    return _tuples(option, text, 2, "-0.1:0, 0.1:0 mm")


def _tuples(option: str, text: str, size: int, example: str, of: str | Quantity = "m") -> list[list[float]]:
    """Read a list of groups of `size` numbers, with one unit for all at the end; return values in SI units.

    `of` is the SI unit, or the description of the quantity; `example` is a valid text for the error message.
    """
    unit = _UNIT.search(text.strip())
    members = text.strip()[: unit.start()].split(",") if unit else []
    parts = [[number.strip() for number in member.split(":")] for member in members]
    if unit is None or any(len(part) != size or not all(map(_NUMBER.fullmatch, part)) for part in parts):
        raise ValueError(f'{option} = "{text}": give numbers and one unit at their end, e.g. "{example}"')
    return [[parse_quantity(option, f"{number} {unit.group()}", of) for number in part] for part in parts]


def unit_of_speed(*texts: str | None) -> str:
    """Return the unit of the first text with a speed, if results can be displayed in this unit.

    The unit is empty if there is none.
    """
    found = (_UNIT.search(text.strip()) for text in texts if text is not None)
    return next(filter(None, (known_unit("speed", unit.group()) for unit in found if unit)), "")


def in_unit_of(scene: bd.Scene, *texts: str | None) -> bd.Scene:
    """Return the scene; its results are displayed in the unit of the speed in a text, if there is one."""
    return replace(scene, units=scene.units.with_others({"speed": unit_of_speed(*texts)}))


def check_moves(scene: bd.Scene, path: Path) -> None:
    """Raise an error for a scene without a motion."""
    if scene.motion is None:
        example = 'kind = "spin_up", speed = "50 rad/s" and duration = "10 s"'
        sentence = f"motion: missing, but this analysis needs it: give a table [motion], e.g. with {example}"
        raise ConfigError(str(path), [sentence], ["motion"])
