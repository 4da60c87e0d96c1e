"""Trade-offs as tables for reading and as rows of CSV files."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

from rich.console import Group
from rich.text import Text

from beamdyn.common.edge.tables import table
from beamdyn.common.results.columns import Columns, columns_of_rows
from beamdyn.common.results.pictures import figure_of

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from beamdyn.studies.tradeoffs import Diagram, Tradeoff


def diagram_table(diagram: Diagram) -> Group:
    """Cost of each digit, the Pareto front, and the reference of the errors."""
    rows = [
        (f"{d.error:.0e}", d.family, d.setting, f"{1e3 * d.time:.3g}", "" if i == 0 else f"{d.ratio:.2f}")
        for i, d in enumerate(diagram.per_digit)
    ]
    heads = ("error", "cheapest", "setting", "time [ms]", "over the digit before")
    return Group(
        table(diagram.title[:1].upper() + diagram.title[1:], heads, rows, (1, 2)),
        Text(f"Pareto front: {diagram.summary}."),
        Text(f"Error: of {diagram.error_of}."),
        Text(f"Reference: {diagram.reference}; errors below {diagram.resolved:.0e} count as that."),
        *(Text(f"Left out: {sentence}.") for sentence in diagram.skipped),
        Text(),
    )


def tradeoff_csv(result: Tradeoff) -> Columns:
    """All measurements, one row each."""
    rows = ((each.title, *row) for each in result.diagrams for row in _measurements(each))
    return columns_of_rows(("diagram", *_MEASUREMENT), rows)


def diagram_csv(diagram: Diagram) -> Columns:
    """The measurements of one diagram, one row each."""
    return columns_of_rows(_MEASUREMENT, _measurements(diagram))


_MEASUREMENT = "family", "setting", "size", "relative_error", ("time", "s"), "in_front"


def _measurements(diagram: Diagram) -> Iterator[Sequence[object]]:
    for m in diagram.measurements:
        yield m.family, m.setting, m.size, m.error, m.time, m in diagram.front


def tradeoff_figure(result: Tradeoff) -> Figure:
    """All diagrams, two in a row."""
    rows = -(-len(result.diagrams) // 2)
    return figure_of(result.plot, (6.5 * min(2, len(result.diagrams)), 4.5 * rows))
