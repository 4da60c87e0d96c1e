"""The published numbers on brakes, each beside ours, with the cost of the papers' errors, and pictures.

The modules `*_as_printed` and `newton` have the papers' own, partly wrong, mechanics; the rest of `brakes`
has only the right one.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from beamdyn.common.edge.reports import draw_pictures, print_heading, print_notes
from beamdyn.common.edge.tables import comparison_table
from beamdyn.common.results.comparison import Verdict
from brakes.reproduce import drum_as_printed, eebrake, forklift_tables

_PAPERS = drum_as_printed, forklift_tables


def compare_all(screen: Console, folder: Path) -> Sequence[Verdict]:
    """Print the papers' numbers beside ours and draw the pictures.

    Parameters
    ----------
    screen : Console
        Where to print.
    folder : Path
        Where to draw; it is made if needed, and files of the same names are replaced.

    Returns
    -------
    sequence of Verdict
        All that was compared.
    """
    for paper in _PAPERS:
        screen.rule()
        print_heading(screen, paper.PAPER)
        screen.print(f"\n{paper.INTRODUCTION}\n")
        print_notes(screen, paper.summary())
        for made in paper.shown():
            screen.print(made)
        print_notes(screen, paper.notes())
    screen.rule()
    print_heading(screen, eebrake.PAPER)
    screen.print("")
    compared = eebrake.sections()
    for title, rows in compared.items():
        screen.print(comparison_table(title, rows))
    print_notes(screen, eebrake.notes())
    draw_pictures(screen, folder, pictures())
    return [*cells(), *(row for rows in compared.values() for row in rows)]


def cells() -> list[Verdict]:
    """Compare all numbers of both papers on drum brakes."""
    return [cell for paper in _PAPERS for table in paper.tables().values() for cell in table.cells]


def pictures() -> dict:
    """Functions that draw the pictures of all papers, by the names of their files."""
    return eebrake.PICTURES | drum_as_printed.PICTURES | forklift_tables.PICTURES
