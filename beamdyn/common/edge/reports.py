"""The command `reproduce` of both programs: headings of papers, notes, pictures, and the verdicts."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console

from beamdyn.common.edge.console import console
from beamdyn.common.edge.exit_codes import NoAnswer
from beamdyn.common.results.files import check_writable
from beamdyn.common.results.pictures import Axes, Figure, save_figure


def report_verdicts(compare: Callable[[Console, Path], Sequence[Any]], folder: Path) -> Console:
    """Compare published numbers with computed ones, and state whether all verdicts are as expected.

    Parameters
    ----------
    compare : callable
        ``compare(screen, folder)`` prints the comparisons, draws pictures, and returns the verdicts.
    folder : Path
        Folder for the pictures.

    Returns
    -------
    Console
        Where the comparisons were printed.

    Raises
    ------
    NoAnswer
        If a verdict is not as expected.
    ValueError
        If the folder cannot be written to.
    """
    _check_folder(folder)
    screen = console()
    screen.print(f"Pictures go into the folder {folder} (--output names another).\n")
    checked = compare(screen, folder)
    unexpected = sum(not verdict.as_expected for verdict in checked)
    if unexpected:
        raise NoAnswer(f"{unexpected} of {len(checked)} verdicts are not as expected; see the tables")
    screen.print(
        f"\nAll {len(checked)} verdicts are as expected: agreement, or a difference with the reason above."
    )
    return screen


def _check_folder(folder: Path) -> None:
    """Raise an error, before anything is computed, if a folder cannot be made or written into."""
    there = next(place for place in (folder, *folder.absolute().parents) if place.exists())
    if not there.is_dir():
        raise ValueError(f"--output = {folder}: {there} is a file; give a folder")
    try:
        check_writable(there / "picture.png", force=True)
    except OSError as error:
        raise ValueError(f"--output = {folder}: {error}") from None


def print_heading(screen: Console, paper: Mapping[str, Any], between: str = ", ") -> None:
    """Print title, authors (with `between` between them), journal and year of a published paper."""
    people = between.join(paper.get("authors", ()))
    parts = people, paper.get("journal", ""), str(paper["year"])
    screen.print(f"{paper['title']}\n{', '.join(filter(None, parts))}", style="bold")


def print_notes(screen: Console, notes: Iterable[str]) -> None:
    """Print paragraphs, with a blank line after each."""
    for note in notes:
        screen.print(f"{note}\n")


def draw_pictures(screen: Console, folder: Path, pictures: Mapping[str, Callable[[], Axes | Figure]]) -> None:
    """Draw pictures into a folder, which is created if needed, and print the path of each picture.

    Parameters
    ----------
    screen : Console
        Where to print.
    folder : Path
        Folder of the pictures; existing files with the same names are replaced.
    pictures : mapping
        The function that draws each picture, by file name without suffix.
    """
    folder.mkdir(parents=True, exist_ok=True)
    for name, draw in pictures.items():
        path = save_figure(draw(), folder / f"{name}.png", force=True)
        screen.print(f"drawn: {path}", soft_wrap=True)
