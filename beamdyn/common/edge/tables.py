"""Tables for people: numbers with the digits they deserve, on the console."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager

from rich import box
from rich.console import Console, Group, RenderableType
from rich.table import Table
from rich.text import Text

_DIGITS = 10  # most that a table shows
_PIPE_WIDTH = 120  # of tables that go to a file or another program


def console() -> Console:
    """Where reports are printed: standard output, without markup."""
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    return Console(width=width, markup=False, highlight=False, emoji=False)


def show(parts: Iterable[RenderableType]) -> None:
    """Print tables and sentences on standard output."""
    screen = console()
    for part in parts:
        screen.print(part)


@contextmanager
def progress_bar(what: str) -> Iterator[Callable[[int, int], None]]:
    """A bar with the remaining time on standard error, if that is a terminal: yields its progress."""
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    columns = TextColumn("{task.description}"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn()
    screen = Console(stderr=True)
    with Progress(*columns, console=screen, transient=True, disable=not screen.is_terminal) as bar:
        task = bar.add_task(what)
        yield lambda done, total: bar.update(task, completed=done, total=total)


def supported(value: float, error: float, most: int = _DIGITS) -> str:
    """A number with the digits that its error leaves: half a unit of the last one is not below the error.

    Parameters
    ----------
    value : float
        The number.
    error : float
        Its absolute error.
    most : int
        Most significant digits.

    Returns
    -------
    str
        "0 ± error" where no digit is sure, "unresolved" where the error is not known.
    """
    if not math.isfinite(value):
        return "none" if math.isnan(value) else str(value)
    if not math.isfinite(error):
        return "unresolved"
    if value == 0 and error == 0:
        return "0"
    if 2 * error >= abs(value):
        return f"0 ± {abs(value) + error:.1g}"
    lead = math.floor(math.log10(abs(value)))
    decimals = most - 1 - lead
    if error > 0:
        decimals = min(decimals, math.floor(-math.log10(2 * error)))
    if decimals + lead < 0:
        return f"0 ± {abs(value) + error:.1g}"
    return f"{value:.{decimals}f}" if lead > -4 and decimals >= 0 else f"{value:.{decimals + lead}e}"


def table(
    title: str, columns: Sequence[str], rows: Iterable[Sequence[str]], left: Sequence[int] = (0,)
) -> Group:
    """A table of text.

    Parameters
    ----------
    title : str
        Above it.
    columns : sequence of str
        Headings.
    rows : iterable of sequences of str
        Cells; an empty row draws a line.
    left : sequence of int
        Columns that are flush left, such as words; numbers are flush right.

    Returns
    -------
    rich.console.Group
        The title and the table.
    """
    made = Table(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0))
    for i, heading in enumerate(columns):
        made.add_column(heading, justify="left" if i in left else "right", no_wrap=i not in left)
    for row in rows:
        if row:
            made.add_row(*row)
        else:
            made.add_section()
    return Group(Text(title, style="bold"), made)
