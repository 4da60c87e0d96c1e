"""Console reports of the command `reproduce`: headings of papers, notes, and pictures."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from pathlib import Path
from typing import Any

from rich.console import Console

from beamdyn.common.results.pictures import Axes, Figure, save_figure


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
