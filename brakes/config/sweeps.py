"""Designs whose numbers are swept all at once: arrays in place of inputs of a validated file."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, TypeVar

import numpy as np
from pydantic import BaseModel

from beamdyn.common.edge.inputs import Input, describe

FileModel = TypeVar("FileModel", bound=BaseModel)


def numeric_inputs(design: BaseModel) -> list[Input]:
    """Inputs of a design that are numbers, in the tables that its file has."""
    there = [entry for entry in describe(type(design)) if getattr(design, entry.path.partition(".")[0])]
    return [entry for entry in there if entry.quantity.unit or entry.quantity.symbol]  # others are choices


def with_arrays(design: FileModel, columns: Mapping[str, np.ndarray]) -> FileModel:
    """A design with arrays in place of its inputs.

    Parameters
    ----------
    design : FileModel
        A validated design.
    columns : mapping of str to ndarray, shape (N,)
        Values in SI of each input, by its path.

    Returns
    -------
    FileModel
        A copy that is not validated: the core checks the values.
    """
    for path, values in columns.items():
        design = _replace_input(design, path, values)
    return design


def _replace_input(model: FileModel, path: str, values: np.ndarray) -> FileModel:
    head, _, rest = path.partition(".")
    fields: dict[str, Any] = dict(model) | {
        head: _replace_input(getattr(model, head), rest, values) if rest else values
    }
    return type(model).model_construct(**fields)
