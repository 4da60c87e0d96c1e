"""Published numbers on brakes beside computed ones, consequences of the papers' errors, and figures.

The modules `*_as_printed` contain the papers' own mechanics, which is partly wrong; the rest of
`brakes` contains only the corrected mechanics.
"""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from rich.console import Console

from beamdyn.common.edge.console import comparison_table
from beamdyn.common.edge.reports import draw_pictures, print_heading, print_notes
from beamdyn.common.results.comparison import Verdict
from brakes.reproduce import drum_as_printed, eebrake, forklift_tables

_PAPERS = drum_as_printed, forklift_tables


def compare_all(screen: Console, folder: Path) -> Sequence[Verdict]:
    """Print the papers' numbers beside computed ones, and draw the figures.

    Parameters
    ----------
    screen : Console
        Console on which the tables are printed.
    folder : Path
        Folder for the pictures; it is made if needed, and files of the same names are replaced.

    Returns
    -------
    sequence of Verdict
        Verdicts of all comparisons.
    """
    for paper in _PAPERS:
        screen.rule()
        print_heading(screen, paper.PAPER)
        screen.print(f"\n{paper.PAPER['introduction']}\n")
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
    """Compare all numbers of the drum paper and of the forklift paper; return one `Cell` for each number."""
    return [cell for paper in _PAPERS for table in paper.tables().values() for cell in table.cells]


def pictures() -> dict:
    """Return the functions that draw the pictures of all papers, by file name."""
    return eebrake.PICTURES | drum_as_printed.PICTURES | forklift_tables.PICTURES
