"""Printed numbers beside computed ones, tables of them, and a paper's errors with their consequences."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from rich.console import Group

from beamdyn.common.edge.console import table
from beamdyn.common.results.comparison import Verdict


@dataclass(frozen=True)
class Cell(Verdict):
    """A printed number beside the number that the paper's own method gives, and the corrected one.

    Parameters
    ----------
    printed : str
        The number as the paper prints it.
    ours : float
        The number that the paper's own method gives, in the printed unit.
    step : float
        Unit of the last significant digit printed.
    reason : str
        Why the two numbers are known to differ; empty if they should agree.
    right : float, optional
        The number that the corrected mechanics gives, in the printed unit.
    """

    printed: str
    ours: float
    step: float
    reason: str = ""
    right: float | None = None

    @property
    def agrees(self) -> bool:
        """Whether the number by the paper's method rounds to the printed number."""
        return abs(self.ours - float(self.printed)) <= self.step / 2 * (1 + 1e-12)

    @property
    def texts(self) -> list[str]:
        """Texts of the numbers: as printed, by the paper's method, and by the corrected mechanics.

        The last two have one digit more than the printed number.
        """
        decimals = max(0, 1 - round(math.log10(self.step)))
        numbers = [x for x in (self.ours, self.right) if x is not None]
        return [self.printed, *(f"{x:.{decimals}f}" if math.isfinite(x) else "never stops" for x in numbers)]


def step(printed: str, digits: int | None = None) -> float:
    """Compute the unit of the last significant digit of a printed number.

    Parameters
    ----------
    printed : str
        The number as printed.
    digits : int, optional
        Number of significant digits, if trailing zeros are only padding.
    """
    if digits is not None:
        return 10.0 ** (len(printed.partition(".")[0].lstrip("-0")) - digits)
    if "." in printed:
        return 10.0 ** -len(printed.partition(".")[2])
    return 10.0 if printed.endswith("0") else 1.0


@dataclass(frozen=True)
class PrintedTable:
    """A table of a paper, with computed numbers beside the printed ones.

    Parameters
    ----------
    title : str
        Title of the table.
    inputs, quantities : tuple of str
        Headings of the inputs that vary from row to row, and of the compared quantities.
    rows : list of (tuple of str, list of Cell)
        Inputs and compared numbers of each row.
    unit : str
        Unit of all quantities, if the title states it and the headings do not.
    """

    title: str
    inputs: tuple[str, ...]
    quantities: tuple[str, ...]
    rows: list[tuple[tuple[str, ...], list[Cell]]]
    unit: str = ""

    @property
    def cells(self) -> list[Cell]:
        """All numbers of the table, row by row."""
        return [cell for _, cells in self.rows for cell in cells]

    def shown(self) -> Group:
        """Make the table for the console: printed numbers, those by the paper's method, corrected ones."""
        heads = [*self.inputs]
        for name, cell in zip(self.quantities, self.cells, strict=False):
            heads += [name, "ours", "corrected"][: len(cell.texts)]
        lines = []
        for inputs, cells in self.rows:
            different = "; ".join(f"{c.printed} {c.verdict}" for c in cells if c.verdict != "agrees")
            lines.append([*inputs, *(t for cell in cells for t in cell.texts), different or "agrees"])
        return table(self.title, (*heads, "verdict"), lines, (len(heads),))


@dataclass(frozen=True)
class Erratum:
    """An error in a paper, and its consequence: a wrong number beside the right one.

    Attributes
    ----------
    name : str
        Short name of the error.
    where, printed, right : str
        The place in the paper, what is printed there, and what it should be.
    quantity, unit : str
        Name and unit of the two values; the name is empty if the error has no consequence.
    printed_value, right_value : float
        The number that results from the error, and the right one.
    remark : str
        A further remark on the consequence.
    """

    name: str
    where: str
    printed: str
    right: str
    quantity: str = ""
    unit: str = ""
    printed_value: float = 0.0
    right_value: float = 0.0
    remark: str = ""

    @property
    def consequence(self) -> str:
        """One sentence that describes the consequence of the error."""
        if not self.quantity:
            return "none further on"
        unit, remark = (self.unit and f" {self.unit}"), (self.remark and f"; {self.remark}")
        return f"{self.quantity}: {self.printed_value:.5g} in place of {self.right_value:.5g}{unit}{remark}"


def errata_of(
    paper: Mapping[str, Any], costs: Mapping[str, tuple[str, str, Any, Any]]
) -> tuple[Erratum, ...]:
    """List the errors in a published file, in its order, with their consequences.

    Parameters
    ----------
    paper : mapping
        Contents of the published file.
    costs : mapping
        Consequence by the error's name: quantity, unit, value as printed and right value.
    """
    found = []
    for known in paper["erratum"]:
        quantity, unit, printed, right = costs.get(known["name"], ("", "", 0.0, 0.0))
        erratum = Erratum(**known, quantity=quantity, unit=unit)
        found.append(replace(erratum, printed_value=float(printed), right_value=float(right)))
    return tuple(found)


def errata_table(title: str, errata: Iterable[Erratum]) -> Group:
    """Make the table of a paper's errors."""
    rows = ([e.where, e.printed, e.right, e.consequence] for e in errata)
    return table(title, ("where", "the paper has", "right", "what follows"), rows, (0, 1, 2, 3))
