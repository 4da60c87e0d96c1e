"""Sweeps of drum and forklift brakes, whose designs take arrays: all cases at once."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel

from beamdyn.common.edge import input_sweep as sweeps
from beamdyn.common.edge.input_sweep import Axis, InputSweep, Output, chosen
from beamdyn.common.edge.inputs import Input, describe

__all__ = ["Axis", "InputSweep", "Output", "chosen", "parse_axis", "replaced", "sweep"]

Design = TypeVar("Design", bound=BaseModel)


def parse_axis(design: BaseModel, text: str, option: str = "--sweep") -> Axis:
    """An input of a design, in the tables that its file has, and its values; see `sweeps.parse_axis`."""
    known = [i for i in describe(type(design)) if _number(i) and getattr(design, i.path.partition(".")[0])]
    return sweeps.parse_axis(known, text, option)


def _number(entry: Input) -> bool:
    """Whether an input is a number; others are choices."""
    return bool(entry.quantity.unit or entry.quantity.symbol)


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


def sweep(axes: Sequence[Axis], outputs: Sequence[Output], answer: Any) -> InputSweep:
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
    InputSweep
    """
    return sweeps.sweep(axes, outputs, [output.shown(answer) for output in outputs])
