"""Sensitivities as tables for reading and as rows of CSV files."""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Columns, columns_of_rows
from beamdyn.common.results.digits import supported
from beamdyn.studies.sensitivities.result import Sensitivities

_DIGITS = 7  # most of a derivative
_BESIDE = 4  # answers in a table


def sensitivities_table(result: Sensitivities) -> Group:
    """For each number its value, and of each answer the derivative and the relative change over its own."""
    values = [f"{a} {v:.6g} {result.unit}" for a, v in zip(result.answers, result.value, strict=True)]
    said = f"{'; '.join(values)}. Derivatives: in {result.unit} over the SI unit of the input."
    numbers = np.array([each.value for each in result.inputs])[:, None]
    with np.errstate(invalid="ignore"):
        error = result.error * np.abs(numbers / result.value)
    parts = [
        *_tables(f"Derivatives, by {result.provenance.method}", result, result.derivative, result.error),
        *_tables("Relative change over that of the input", result, result.relative, error),
    ]
    return Group(*parts, Text(said if values else "There is no crossing."))


def _tables(title: str, result: Sensitivities, value: np.ndarray, error: np.ndarray) -> Iterator[Group]:
    """A table for some answers after the other."""
    for start in range(0, len(result.answers), _BESIDE):
        shown = slice(start, start + _BESIDE)
        rows = (
            (each.name, f"{each.value:.6g} {each.unit}".rstrip(), *_cells(value[k, shown], error[k, shown]))
            for k, each in enumerate(result.inputs)
        )
        yield table(title, ("input", "value", *result.answers[shown]), rows, (0,))


def _cells(values: np.ndarray, errors: np.ndarray) -> list[str]:
    return [supported(value, error, _DIGITS) for value, error in zip(values, errors, strict=True)]


def sensitivities_csv(result: Sensitivities) -> Columns:
    """A row for each number and answer: values in SI, derivative, its error, relative change."""
    rows = []
    for k, each in enumerate(result.inputs):
        columns = (result.answers, result.value, result.derivative[k], result.error[k], result.relative[k])
        for answer, *numbers in zip(*columns, strict=True):
            rows.append((each.name, each.unit, each.value, answer, *map(float, numbers)))
    heads = "input", "unit", "value", "answer", "answer_value", "derivative", "error", "relative"
    return columns_of_rows(heads, rows)
