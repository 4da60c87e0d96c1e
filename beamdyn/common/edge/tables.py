"""Tables on the console."""

from __future__ import annotations

import codecs
import os
import sys
from collections.abc import Collection, Iterable, Mapping, Sequence
from io import TextIOWrapper
from typing import Any
from unicodedata import normalize

from rich.console import Console, Group, RenderableType
from rich.text import Text

from beamdyn.common.edge.fitted_table import FittedTable
from beamdyn.common.edge.progress import quiet
from beamdyn.common.results.comparison import Comparison
from beamdyn.common.results.digits import count_sure

_PIPE_WIDTH = 120  # width of tables that go to a file or another program


# ASCII for characters of our tables that a console without Unicode may lack.
_SPELLED = {
    **{
        "ω": "omega",
        "ζ": "zeta",
        "η": "eta",
        "Λ": "Lambda",
        "Ω": "ohm",
        "µ": "u",
        "μ": "u",
        "ᵀ": "^T",
        "²": "^2",
    },
    **{"³": "^3", "±": "+-", "°": " deg", "·": "*", "×": "x", "─": "-"},
}


def spell(text: str, encoding: str) -> str:
    """Replace the characters that an encoding lacks: "omega^2" where it has no Greek letters."""
    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return "".join(_spell_character(c, encoding) for c in text)
    return text


def _spell_character(character: str, encoding: str) -> str:
    if character.encode(encoding, "ignore"):
        return character
    plain = normalize("NFKD", character).encode("ascii", "ignore").decode()
    return _SPELLED.get(character) or plain or "?"


def spell_output(stream: TextIOWrapper) -> None:
    """Let a stream replace the characters that its encoding lacks."""
    codecs.register_error("beamdyn.spell", _spell_error)
    stream.reconfigure(errors="beamdyn.spell")


def _spell_error(error: UnicodeError) -> tuple[str, int]:
    assert isinstance(error, UnicodeEncodeError)
    return spell(error.object[error.start : error.end], "ascii"), error.end


class Terminal(Console):
    """A console on standard output whose columns are laid out for the characters that it can show.

    If the reader of a pipe closes it, as `head` does, the command goes on without output.
    """

    def render_str(self, text: str, **options: Any) -> Text:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Convert a string to rich's text."""
        return super().render_str(spell(text, self.encoding), **options)

    def print(self, *objects: Any, **options: Any) -> None:
        """Print; raises an OSError that names the standard output."""
        try:
            with quiet():
                super().print(*objects, **options)
        except OSError as error:
            raise OSError(f"the standard output cannot be written ({error.strerror or error})") from None

    def on_broken_pipe(self) -> None:
        """Send further output nowhere, and let the command finish."""
        self.quiet = True
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def console() -> Terminal:
    """The console on standard output, without markup."""
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    return Terminal(width=width, markup=False, highlight=False, emoji=False)


def show(parts: Iterable[RenderableType]) -> None:
    """Print tables and sentences on standard output."""
    screen = console()
    for part in parts:
        screen.print(part)


BEYOND = "dim"  # style of the digits of a number that its error does not support


def set_apart(text: str, error: float) -> Text:
    """A number's text, with the digits beyond an absolute error dimmed."""
    sure = count_sure(text, error)
    return Text.assemble(text[:sure], (text[sure:], BEYOND))


def table(
    title: str,
    columns: Sequence[str],
    rows: Iterable[Sequence[str | Text]],
    left: Sequence[int] = (0,),
    keys: int = 1,
) -> Group:
    """A table of text; where it is too wide for the screen, several below each other.

    Parameters
    ----------
    title : str
        Title above the table.
    columns : sequence of str
        Headings.
    rows : iterable of sequences of str or Text
        Cells; an empty row draws a line.
    left : sequence of int
        Columns that are flush left, such as words; numbers are flush right.
    keys : int
        Number of first columns that identify a row.

    Returns
    -------
    rich.console.Group
        The title and the table.
    """
    made = FittedTable(columns, left, keys)
    for row in rows:
        if row:
            made.add_row(*row)
        else:
            made.add_section()
    return Group(Text(title, style="bold"), made)


def table_of(title: str, columns: Mapping[str, Sequence[str | Text]], words: Collection[str] = ()) -> Group:
    """A table of columns by their heads; those in `words` stand at the left, all others are numbers."""
    left = [i for i, head in enumerate(columns) if head in words]
    return table(title, [*columns], zip(*columns.values(), strict=True), left)


def comparison_table(title: str, rows: Iterable[Comparison]) -> Group:
    """The table of comparisons, with a line where the first two words of `what` change."""
    cells: list[list[str]] = []
    for row in rows:
        if cells and _topic(cells[-1][0]) != _topic(row.what):
            cells.append([])
        cells.append(row.cells())
    return table(
        title,
        ("what", "published by", "published", "ours", "deviation", "verdict"),
        cells,
        (0, 1, 5),
    )


def _topic(what: str) -> list[str]:
    return what.replace(",", "").split()[:2]
