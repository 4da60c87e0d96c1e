"""Any input of a file against any result: "stop.speed=10:30:9 km/h"."""

from __future__ import annotations

import difflib
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel

from beamdyn.common.inputs import Input, describe
from beamdyn.common.results import Result
from beamdyn.common.units import quantity
from brakes.arrays import Numbers

Design = TypeVar("Design", bound=BaseModel)

_NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_RANGE = re.compile(rf"\s*({_NUMBER})\s*:\s*({_NUMBER})\s*:\s*(\d+)\s*(.*?)\s*")
_MOST = 100_000


@dataclass(frozen=True)
class Axis:
    """Values of an input.

    Parameters
    ----------
    input : Input
        What it is.
    unit : str
        Unit in which the values were given.
    given, values : ndarray, shape (n,)
        The values, in that unit and in SI.
    """

    input: Input
    unit: str
    given: np.ndarray
    values: np.ndarray

    @property
    def label(self) -> str:
        """For tables and pictures: the key and its unit."""
        return f"{self.input.name} [{self.unit}]" if self.unit else self.input.name


@dataclass(frozen=True)
class Output:
    """A number of a result, as people read it.

    Parameters
    ----------
    name : str
        Its name on the command line and in files.
    words : str
        What it is.
    of : callable
        Takes it from a result, in SI.
    unit : str
        Unit in which it is shown.
    scale : float
        That unit in SI.
    """

    name: str
    words: str
    of: Callable[[Any], Numbers]
    unit: str = ""
    scale: float = 1.0

    def shown(self, result: Any) -> Numbers:
        """Its value or values in the unit shown."""
        return np.asarray(self.of(result)) / self.scale

    @property
    def label(self) -> str:
        """For tables and pictures: name and unit."""
        return f"{self.name} [{self.unit}]" if self.unit else self.name


@dataclass(frozen=True)
class Sweep(Result):
    """Results over one or two inputs.

    Attributes
    ----------
    inputs, units : tuple of str
        Keys of the inputs, and the units in which their values are given.
    values : tuple of ndarray
        Their values, n of the first and, if there is a second, m of it.
    results, result_units : tuple of str
        Names of the results and their units.
    found : tuple of ndarray, shape (n,) or (m, n)
        The results; nan or inf where there is none.
    """

    inputs: tuple[str, ...]
    units: tuple[str, ...]
    values: tuple[np.ndarray, ...]
    results: tuple[str, ...]
    result_units: tuple[str, ...]
    found: tuple[np.ndarray, ...]


def parse_axis(design: BaseModel, text: str, option: str = "--sweep") -> Axis:
    """An input and its values.

    Parameters
    ----------
    design : BaseModel
        What the file describes.
    text : str
        KEY=start:stop:count unit; the key is a path, or its last part where that is unique, or unique
        among the inputs that must be given.
    option : str
        Its name, for messages.

    Raises
    ------
    ValueError
        If there is no such input, or the values do not fit it.
    """
    key, _, rest = text.partition("=")
    said = f'{option} = "{text}"'
    entry = _find(design, key.strip(), said)
    unit = entry.quantity.unit
    match = _RANGE.fullmatch(rest)
    if match is None:
        form = f"{entry.path}=1:2:11 {unit}".strip()
        raise ValueError(f'{said}: give KEY=start:stop:count unit, e.g. "{form}"')
    start, stop, count = float(match[1]), float(match[2]), int(match[3])
    if not 2 <= count <= _MOST or start == stop:
        raise ValueError(f"{said}: give two different ends, and a count from 2 to {_MOST}")
    low, high = (_in_si(entry, number, match[4], said) for number in (match[1], match[2]))
    return Axis(entry, match[4], np.linspace(start, stop, count), np.linspace(low, high, count))


def _in_si(entry: Input, number: str, unit: str, said: str) -> float:
    """An end of the range within the bounds of the input."""
    given = f"{number} {unit}".strip()
    try:
        if not entry.quantity.unit:
            return entry.quantity.parse(given if unit else float(number))
        return entry.quantity.within_bounds(given, quantity(given, entry.quantity.unit))
    except ValueError as error:
        raise ValueError(f"{said}: {entry.path} = {error}") from None


def _find(design: BaseModel, key: str, said: str) -> Input:
    """The input of a key, in the tables that the file has."""
    known = [i for i in describe(type(design)) if _number(i) and getattr(design, i.path.partition(".")[0])]
    found = [i for i in known if key in (i.path, i.name)]
    if len(found) > 1:
        found = [i for i in found if i.required] or found
    if len(found) > 1:
        raise ValueError(f"{said}: {key} is ambiguous; give {' or '.join(i.path for i in found)}")
    if not found:
        raise ValueError(f"{said}: {unknown(key, [i.path for i in known], [i.name for i in known])}")
    return found[0]


def _number(entry: Input) -> bool:
    """Whether an input is a number; others are choices."""
    return bool(entry.quantity.unit or entry.quantity.symbol)


def unknown(key: str, names: Sequence[str], more: Sequence[str] = ()) -> str:
    """That a name is not known, and the nearest one or all."""
    near = difflib.get_close_matches(key, [*names, *more], n=1)
    advice = f"did you mean {near[0]}?" if near else f"known are {', '.join(names)}"
    return f"unknown name {key!r}; {advice}"


def replaced(design: Design, axes: Sequence[Axis]) -> Design:
    """A design with arrays in place of the inputs; with two axes the second is a column."""
    for place, axis in enumerate(axes):
        values = axis.values if place == 0 else axis.values[:, None]
        design = _with(design, axis.input.path, values)
    return design


def _with(model: Design, path: str, values: np.ndarray) -> Design:
    """A copy without validation: the core checks the values."""
    head, _, rest = path.partition(".")
    fields: dict[str, Any] = dict(model) | {
        head: _with(getattr(model, head), rest, values) if rest else values
    }
    return type(model).model_construct(**fields)


def sweep(axes: Sequence[Axis], outputs: Sequence[Output], answer: Any) -> Sweep:
    """The results of a design with arrays.

    Parameters
    ----------
    axes : sequence of Axis
        One or two inputs.
    outputs : sequence of Output
        What is wanted.
    answer : object
        The result of `replaced` design.

    Returns
    -------
    Sweep
    """
    shape = tuple(len(axis.values) for axis in reversed(axes))
    return Sweep(
        inputs=tuple(axis.input.path for axis in axes),
        units=tuple(axis.unit for axis in axes),
        values=tuple(axis.given for axis in axes),
        results=tuple(output.name for output in outputs),
        result_units=tuple(output.unit for output in outputs),
        found=tuple(np.broadcast_to(output.shown(answer), shape) for output in outputs),
    )


def chosen(outputs: Sequence[Output], names: str, option: str = "--result") -> list[Output]:
    """The outputs of names that are separated by commas.

    Raises
    ------
    ValueError
        If there is none of a name; the message says what there is.
    """
    known = {output.name: output for output in outputs}
    wanted = [name.strip() for name in names.split(",") if name.strip()]
    for name in wanted:
        if name not in known:
            raise ValueError(f'{option} = "{names}": {unknown(name, [*known])}')
    return [known[name] for name in dict.fromkeys(wanted)]
