"""Random inverse questions about brakes and vehicles: the input that gives a wanted result."""

from __future__ import annotations

import tomllib
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from typing import Any, NamedTuple

import numpy as np

from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.inputs.described import part_at, with_parts
from brakes.answers import STANDARD
from brakes.answers.base import BrakeType
from brakes.answers.finding import find_in_file
from brakes.answers.forklift import FORKLIFT
from brakes.app.bases import base
from brakes.common.solutions import Solutions

PEDAL = """
[pedal]
ratio = 5
force = "300 N"
[line]
master_bore = "22.22 mm"
cylinder_bore = "31.75 mm"
"""
TYPES = {name: load() for name, (_, load) in STANDARD.items()} | {"forklift": FORKLIFT}
ROUNDING = ("error", "closure", "residual")  # results that contain only rounding error
SPREAD, SOUGHT = 1.3, 1.5  # factors for random inputs, and for the bounds of a search


class Asked(NamedTuple):
    """An inverse question whose answer is known.

    Parameters
    ----------
    what : str
        Names of brake, input and result.
    value : float
        Known value of the input, from which the result was computed [unit of the search].
    found : Solutions
        Result of the search.
    """

    what: str
    value: float
    found: Solutions

    @property
    def residual(self) -> float:
        """Largest relative difference of the results at found inputs from the wanted result."""
        return float(np.max(np.abs(self.found.residuals), initial=0.0)) / abs(self.found.target)

    @property
    def distance(self) -> float:
        """Relative distance of the known input from the nearest found input; inf if none is found."""
        within = np.clip(self.value, *self.found.ranges.T)
        return float(np.min(np.abs(np.append(self.found.values, within) / self.value - 1), initial=np.inf))


@dataclass(frozen=True)
class Outcome:
    """Outcome of the question with a number, as plain numbers."""

    number: int
    what: str
    residual: float
    distance: float
    answers: int


def measure(number: int, seed: int) -> list[Outcome]:
    """Draw and solve the question with a number, and return the outcome."""
    asked = draw(number, seed)
    answers = len(asked.found.values) + len(asked.found.ranges)
    return [Outcome(number, asked.what, asked.residual, asked.distance, answers)]


def draw(number: int, seed: int, names: Sequence[str] = tuple(TYPES)) -> Asked:
    """Draw the question with a number; the named types of brakes are used in turn."""
    name = names[number % len(names)]
    tries = (_question(TYPES[name], name, np.random.default_rng([seed, number, k])) for k in count())
    return next(asked for asked in tries if asked is not None)


def _question(brake: BrakeType[Any], name: str, rng: np.random.Generator) -> Asked | None:
    """Draw a question; None if the design has no answer, or the result does not depend on the input."""
    text = base(name).replace('piston_force = "11650 N"', "lining_friction = 0.3")
    tables = tomllib.loads(text + PEDAL * (name == "forklift"))
    design = brake.read(tables, name)
    inputs = [each for each in brake.sweep_inputs(design, tables) if part_at(design, each.path)]
    given = ((each, part_at(tables, each.path)) for each in inputs if not each.choices)
    # Inputs in the file that are numbers, but neither counts nor fractions.
    entries = [each for each, value in given if isinstance(value, str | float)]
    values = {e.path: part_at(design, e.path) * SPREAD ** rng.uniform(-1, 1) for e in entries}
    written = {e.path: f"{values[e.path]!r} {e.quantity.unit}" for e in entries if e.quantity.unit}
    tables = with_parts(tables, values | written)
    outputs = [each for each in brake.outputs(design) if not each.name.startswith(ROUNDING)]
    entry, output = entries[rng.integers(len(entries))], outputs[rng.integers(len(outputs))]
    value = float(values[entry.path])
    try:
        target = float(output.shown(brake.answer(tables, name)))
    except (ValueError, NoAnswer):
        return None
    if not target or not np.isfinite(target):
        return None
    bounds = sorted(entry.quantity.nearest_within(end) for end in (value / SOUGHT, value * SOUGHT))
    low, high = (repr(float(end)) for end in bounds)
    sought = f"{entry.path}={low}:{high}:33 {entry.quantity.unit}"
    found = find_in_file(brake, tables, name, sought, f"{output.name} = {target!r} {output.unit}")
    if [piece.course for piece in found.pieces] == ["is level"]:
        return None
    return Asked(f"{name}: {entry.path} for {output.name}", value, found)
