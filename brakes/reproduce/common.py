"""A printed number beside ours, rows of such cells, and tables of them and of errata."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from rich.console import Group

from beamdyn.common.edge.tables import table
from beamdyn.common.results.comparison import Verdict
from brakes.published.errata import Erratum


@dataclass(frozen=True)
class Cell(Verdict):
    """A printed number beside ours.

    Parameters
    ----------
    printed : str
        The number as the paper prints it.
    ours : float
        The number computed by the paper's own way, in the unit printed.
    step : float
        Unit of the last significant digit printed.
    reason : str
        Why the two are known to differ; empty if they should agree.
    right : float, optional
        The number by the right mechanics, in the unit printed.
    """

    printed: str
    ours: float
    step: float
    reason: str = ""
    right: float | None = None

    @property
    def agrees(self) -> bool:
        """Whether ours rounds to what is printed."""
        return abs(self.ours - float(self.printed)) <= self.step / 2 * (1 + 1e-12)

    @property
    def texts(self) -> list[str]:
        """The printed number, then ours and, if there is one, the right one, each with a digit more."""
        decimals = max(0, 1 - round(math.log10(self.step)))
        shown = [self.printed, f"{self.ours:.{decimals}f}"]
        if self.right is None:
            return shown
        return [*shown, f"{self.right:.{decimals}f}" if math.isfinite(self.right) else "never stops"]


def step(printed: str, digits: int | None = None) -> float:
    """Unit of the last significant digit of a printed number.

    Parameters
    ----------
    printed : str
        The number.
    digits : int, optional
        Number of significant digits, where trailing zeros only pad.
    """
    if digits is not None:
        lead = len(printed.partition(".")[0].lstrip("-0"))
        return 10.0 ** (lead - digits)
    if "." in printed:
        return 10.0 ** -len(printed.partition(".")[2])
    return 10.0 if printed.endswith("0") else 1.0


Heads = tuple[tuple[str, ...], tuple[str, ...]]  # of the inputs and of the quantities of a table's rows


@dataclass(frozen=True)
class Row:
    """A row of a printed table: the inputs that vary, as text, and the compared numbers."""

    inputs: tuple[str, ...]
    cells: tuple[Cell, ...]

    @property
    def verdict(self) -> str:
        """The comparison of all its cells in words."""
        different = [f"{c.printed} {c.verdict}" for c in self.cells if c.verdict != "agrees"]
        return "; ".join(different) or "agrees"


def rows_table(title: str, inputs: Sequence[str], quantities: Sequence[str], rows: Sequence[Row]) -> Group:
    """Make a table with the printed number, ours by the paper's way, and the right one of each quantity."""
    heads: list[str] = [*inputs]
    for name, cell in zip(quantities, rows[0].cells, strict=True):
        heads += [name, "ours", "corrected"][: len(cell.texts)]
    lines = ([*row.inputs, *(t for cell in row.cells for t in cell.texts), row.verdict] for row in rows)
    return table(title, (*heads, "verdict"), lines, (len(heads),))


def errata_table(title: str, errata: Iterable[Erratum]) -> Group:
    """Make the table of a paper's errors."""
    rows = ([e.where, e.printed, e.right, e.consequence] for e in errata)
    return table(title, ("where", "the paper has", "right", "what follows"), rows, (0, 1, 2, 3))
