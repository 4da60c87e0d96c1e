"""The published numbers on brakes, each beside ours, with the cost of the papers' errors, and pictures.

The modules `*_as_printed` and `newton` have the papers' own, partly wrong, mechanics; the rest of `brakes`
has only the right one.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from rich.console import Console

from beamdyn.common.edge.tables import comparison_table
from beamdyn.common.results.comparison import Verdict
from beamdyn.common.results.pictures import save_figure
from brakes.published import load
from brakes.reproduce import caliper, drum, forklift


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
    folder.mkdir(parents=True, exist_ok=True)
    checked: list[Verdict] = []
    for part in (drum, forklift):
        screen.rule()
        screen.print(part.title(), style="bold")
        screen.print(f"\n{part.introduction()}\n")
        _print_notes(screen, part.summary())
        for made in part.tables():
            screen.print(made)
        _print_notes(screen, part.notes())
    checked += cells()
    checked += _caliper(screen, folder)
    for path in draw(folder):
        screen.print(f"drawn: {path}", soft_wrap=True)
    return checked


def cells() -> list[Verdict]:
    """Compare all numbers of both papers on drum brakes."""
    rows = [*drum.rows(), *(row for table in forklift.rows().values() for row in table)]
    return [cell for row in rows for cell in row.cells]


def draw(folder: Path) -> list[Path]:
    """Draw the pictures of both papers into a folder."""
    made = drum.pictures() | forklift.pictures()
    return [save_figure(figure, folder / f"{name}.png", force=True) for name, figure in made.items()]


def _print_notes(screen: Console, notes: Iterable[str]) -> None:
    for note in notes:
        screen.print(f"{note}\n")


def _caliper(screen: Console, folder: Path) -> list[Verdict]:
    """Print and draw the section on bicycle calipers."""
    compared: list[Verdict] = []
    page = load("eebrake")
    screen.rule()
    screen.print(f"{page['title']}\n{page['journal']}, {page['year']}\n", style="bold")
    for title, rows in caliper.sections().items():
        screen.print(comparison_table(title, rows))
        compared += rows
    _print_notes(screen, caliper.notes())
    for path in caliper.draw(folder):
        screen.print(f"drawn: {path}", soft_wrap=True)
    return compared
