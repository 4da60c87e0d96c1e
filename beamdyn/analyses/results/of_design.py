"""Designs sought backwards, as tables for reading and as columns of files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.file_words import in_files
from beamdyn.common.edge.tables import table
from beamdyn.common.edge.views import View
from beamdyn.common.results.columns import Column, Columns, name_in_heads
from beamdyn.common.results.pictures import figure_of
from beamdyn.studies.designing.target import say_number

if TYPE_CHECKING:
    from beamdyn.studies.designing.found_design import FoundDesign


def design_tables(result: FoundDesign) -> Group:
    """The numbers, the targets with what is reached, and what limits the design."""

    def said(value: float, unit: str) -> str:
        return "-" if np.isnan(value) else in_files(say_number(value, unit), result.display_units)

    values = zip(result.names, result.units, result.given, result.value, result.low, result.high, strict=True)
    numbers = [(name, *(said(float(value), unit) for value in row)) for name, unit, *row in values]
    title = f"{'Found' if result.found else 'The nearest'}, {result.solves} solves"
    rows = [
        (
            in_files(target.says, result.display_units),
            said(float(value), target.kind.unit),
            f"{error:.1e}",
            "met" if met else "missed",
            ", ".join(f"{each:+.4g}" for each in relative),
        )
        for target, value, error, met, relative in zip(
            result.targets, result.reached, result.error, result.met, result.relative, strict=True
        )
    ]
    heads = "target", "reached", "error", "", f"relative change over that of {', '.join(result.names)}"
    notes = (Text(in_files(each, result.display_units)) for each in result.sentences())
    return Group(
        table(title, ("number", "in the scene", "found", "from", "to"), numbers, (0, 1, 2, 3, 4)),
        table("What was wanted", heads, rows, (0, 1, 2, 3, 4)),
        *notes,
    )


def design_csv(result: FoundDesign) -> Columns:
    """A row a number: its values in SI, and the derivative of each answer by it."""
    slopes = zip(result.targets, result.derivative, strict=True)
    return Columns(
        Column("number", result.names),
        Column("unit", result.units),
        Column("given", result.given),
        Column("value", result.value),
        Column("low", result.low),
        Column("high", result.high),
        *(Column("derivative", each, number=name_in_heads(target.name)) for target, each in slopes),
    )


VIEWS = {
    "FoundDesign": View(
        design_tables,
        design_csv,
        1,
        lambda result: figure_of(result.plot, (8.5, 2.0 + 1.0 * len(result.names))),
    )
}
