"""Designs whose numbers are swept all at once: arrays in place of inputs of a validated file."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel

from beamdyn.common.edge.input_sweep import Axis
from beamdyn.common.edge.inputs import Input, describe

FileModel = TypeVar("FileModel", bound=BaseModel)


def numeric_inputs(design: BaseModel) -> list[Input]:
    """Inputs of a design that are numbers, in the tables that its file has."""
    there = [entry for entry in describe(type(design)) if getattr(design, entry.path.partition(".")[0])]
    return [entry for entry in there if entry.quantity.unit or entry.quantity.symbol]  # others are choices


def with_arrays(design: FileModel, axes: Sequence[Axis]) -> FileModel:
    """A design with arrays in place of its inputs.

    Parameters
    ----------
    design : FileModel
        A validated design.
    axes : sequence of Axis
        One or two inputs; the values of the second become a column, shape (m, 1).

    Returns
    -------
    FileModel
        A copy that is not validated: the core checks the values.
    """
    for place, axis in enumerate(axes):
        values = axis.values if place == 0 else axis.values[:, None]
        design = _replace_input(design, axis.input.path, values)
    return design


def _replace_input(model: FileModel, path: str, values: np.ndarray) -> FileModel:
    head, _, rest = path.partition(".")
    fields: dict[str, Any] = dict(model) | {
        head: _replace_input(getattr(model, head), rest, values) if rest else values
    }
    return type(model).model_construct(**fields)
