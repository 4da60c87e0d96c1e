"""Console output of commands: tables whose numbers are never cut, and a progress line."""

from __future__ import annotations

import codecs
import os
import sys
import textwrap
import time
from bisect import bisect_right
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import timedelta
from io import TextIOWrapper
from math import pi
from threading import RLock, Timer
from typing import TYPE_CHECKING, Any
from unicodedata import normalize

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, Group, RenderableType, RenderResult
from rich.table import Table
from rich.text import Text

from beamdyn.common.words import count_sure, supported

if TYPE_CHECKING:
    from rich.progress import Progress

    from beamdyn.common.results.columns import Column, Columns, DisplayUnits
    from beamdyn.common.results.comparison import Comparison

SILENCE = 1.0  # computing time after which the progress line appears [s]

# The progress line that is shown in this context; None if there is none.
_LINE: ContextVar[_ProgressLine | None] = ContextVar("line", default=None)


class Pace:
    """Estimates the remaining time from the steps done in the last half of the elapsed time.

    Earlier steps are disregarded, as they may have been slower.
    """

    def __init__(self) -> None:
        self._times: list[float] = []
        self._counts: list[int] = []

    def note(self, now: float, done: int) -> None:
        """Store the number of steps that are done by the time `now` [s]."""
        self._times.append(now)
        self._counts.append(done)

    def left(self, now: float, total: int) -> float | None:
        """Return the estimated time [s] for the remaining steps; None before the first step is done."""
        if not self._times or self._counts[-1] == self._counts[0]:
            return None
        last, done = self._times[-1], self._counts[-1]
        since = bisect_right(self._times, (self._times[0] + last) / 2) - 1
        each = (last - self._times[since]) / max(done - self._counts[since], 1)
        return max((total - done) * each - (now - last), 0.0)


class _ProgressLine:
    """A line with the elapsed time and, if steps are counted, a progress bar and the remaining time."""

    def __init__(self, what: str) -> None:
        self._what, self._began = what, time.monotonic()
        self._done, self._total, self._pace = 0, None, Pace()
        self._lock, self._timer, self._shown = RLock(), None, None

    def begin(self) -> None:
        """Show the line after one second, unless `hide` is called first."""
        self._timer = Timer(SILENCE, self._show)
        self._timer.daemon = True
        self._timer.start()

    def hide(self) -> None:
        """Remove the progress line from the screen; keep the counts of steps."""
        with self._lock:
            timer, self._timer = self._timer, None
            shown, self._shown = self._shown, None
        if timer is not None:
            timer.cancel()
        if shown is not None:
            shown.stop()

    def count(self, done: int, total: int) -> None:
        """Store the number of steps that are done, and the total number."""
        with self._lock:
            self._done, self._total = done, total
            self._pace.note(time.monotonic(), done)
            if self._shown is not None:
                self._update(self._shown)

    def _show(self) -> None:
        with self._lock:
            if self._timer is None:  # the line was hidden while this thread waited
                return
            self._shown = _bar(self._pace)
            self._shown.add_task(self._what, total=None, count="")
            self._shown.tasks[0].start_time = self._began
            self._update(self._shown)
            self._shown.start()

    def _update(self, bar: Progress) -> None:
        count = "" if self._total is None else f"{self._done}/{self._total}"
        bar.update(bar.task_ids[0], completed=self._done, total=self._total, count=count)


def _bar(pace: Pace) -> Progress:
    from rich.progress import BarColumn, Progress, ProgressColumn, Task, TextColumn, TimeElapsedColumn

    class Remaining(ProgressColumn):
        """Column of the progress line that shows the remaining time, if steps are counted."""

        max_refresh = 0.5

        def render(self, task: Task) -> Text:
            if task.total is None:
                return Text()
            left = pace.left(time.monotonic(), int(task.total))
            shown = "-:--:--" if left is None else str(timedelta(seconds=round(left)))
            return Text(f"{shown} left", style="progress.remaining")

    counted = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[count]}")
    screen = Console(stderr=True, force_terminal=True)
    # Otherwise rich would print on the terminal what the user redirects from standard output to a file.
    return Progress(
        *counted, TimeElapsedColumn(), Remaining(),
        console=screen, transient=True, redirect_stdout=False, redirect_stderr=False,
    )  # fmt: skip


@contextmanager
def at_work(what: str) -> Iterator[Callable[[int, int], None]]:
    """Show a progress line during the work in this context, if standard error is a terminal.

    Parameters
    ----------
    what : str
        Name of the work, such as "designs". A progress line that is started within another one replaces it.

    Yields
    ------
    callable
        Function to call with the number of finished steps and the number of all steps; the line has a bar
        only if it is called.
    """
    if sys.stderr is None or not sys.stderr.isatty():
        yield lambda done, total: None
        return
    line = _ProgressLine(what)
    with quiet():
        token = _LINE.set(line)
        line.begin()
        try:
            yield line.count
        finally:
            line.hide()
            _LINE.reset(token)


@contextmanager
def quiet() -> Iterator[None]:
    """Hide the progress line in this context, to print text; it is shown again after a second."""
    line = _LINE.get()
    if line is None:
        yield
        return
    line.hide()
    try:
        yield
    finally:
        line.begin()


# Tables ----------------------------------------------------------------------------------------------

_BETWEEN, _EDGES = 3, 1  # additional characters per column (spaces and rules), and per table
_WORDS = 16  # least width of a column of words, in characters
_PIPE_WIDTH = 120  # width of tables that go to a file or another program


# ASCII replacements for characters of tables that a console without Unicode cannot show.
_SPELLED = {
    "ω": "omega", "ζ": "zeta", "η": "eta", "Λ": "Lambda", "Ω": "ohm", "µ": "u", "μ": "u", "ᵀ": "^T",
    "²": "^2", "³": "^3", "±": "+-", "°": " deg", "·": "*", "×": "x", "─": "-",
}  # fmt: skip


def spell(text: str, encoding: str) -> str:
    """Replace characters that an encoding lacks, for example the Greek letter omega by "omega"."""

    def spelled(character: str) -> str:
        if character.encode(encoding, "ignore"):
            return character
        plain = normalize("NFKD", character).encode("ascii", "ignore").decode()
        return _SPELLED.get(character) or plain or "?"

    try:
        text.encode(encoding)
    except UnicodeEncodeError:
        return "".join(map(spelled, text))
    return text


def spell_output(stream: TextIOWrapper) -> None:
    """Make a stream replace the characters that its encoding lacks."""

    def replaced(error: UnicodeError) -> tuple[str, int]:
        assert isinstance(error, UnicodeEncodeError)
        return spell(error.object[error.start : error.end], "ascii"), error.end

    codecs.register_error("beamdyn.spell", replaced)
    stream.reconfigure(errors="beamdyn.spell")


class Terminal(Console):
    """A console for standard output that replaces characters that the terminal cannot show.

    It does so before the widths of columns are computed.  If the reader of a pipe closes it, as `head` does,
    the command goes on without output.
    """

    def render_str(self, text: str, **options: Any) -> Text:  # pyright: ignore[reportIncompatibleMethodOverride]
        """Convert a string to rich's text; characters that the console cannot show are replaced."""
        return super().render_str(spell(text, self.encoding), **options)

    def print(self, *objects: Any, **options: Any) -> None:
        """Print objects; raise an OSError that names the standard output if it cannot be written."""
        try:
            with quiet():
                super().print(*objects, **options)
        except OSError as error:
            raise OSError(f"the standard output cannot be written ({error.strerror or error})") from None

    def on_broken_pipe(self) -> None:
        """Stop writing when the reader of a pipe has closed it, and let the command finish."""
        self.quiet = True
        nowhere = os.open(os.devnull, os.O_WRONLY)
        os.dup2(nowhere, sys.stdout.fileno())
        os.close(nowhere)


def console() -> Terminal:
    """Make a console for standard output that does not interpret markup in texts."""
    width = None if sys.stdout.isatty() else _PIPE_WIDTH
    return Terminal(width=width, markup=False, highlight=False, emoji=False)


def show(parts: Iterable[RenderableType]) -> None:
    """Print tables and sentences on standard output."""
    screen = console()
    for part in parts:
        screen.print(part)


class FittedTable(Table):
    """A table whose numbers are never cut.

    If the table is wider than the screen, headings are broken between words.  If it is still too wide, the
    columns are split into several tables below each other.  Each of them repeats the key columns, or shows
    the row number if there is no room for the key columns.

    Parameters
    ----------
    columns : sequence of str
        Headings.
    left : sequence of int
        Indices of columns with words, which are left-aligned and may be wrapped; numbers are right-aligned.
    keys : int
        Number of key columns: the first columns, which identify a row.
    """

    def __init__(self, columns: Sequence[str], left: Sequence[int], keys: int = 1) -> None:
        super().__init__(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0))
        self._keys = keys
        for i, heading in enumerate(columns):
            self.add_column(heading, justify="left" if i in left else "right", no_wrap=i not in left)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table, or the several tables into which it is split if it is too wide for the screen."""
        room, places = options.max_width, [*range(len(self.columns))]
        if _total([self._width(i) for i in places]) <= room:
            yield from super().__rich_console__(console, options)
            return
        needed = [self._width(i, broken=True) for i in places]
        keys, others = places[: self._keys], places[self._keys :]
        widest = max((needed[i] for i in others), default=0)
        numbered = _total([*(needed[i] for i in keys), widest]) > room
        if numbered:
            keys, others = [], places
        first = [cell_len(str(self.row_count))] if numbered else [needed[i] for i in keys]
        groups: list[list[int]] = [[]]
        for i in others:
            if groups[-1] and _total([*first, *(needed[k] for k in (*groups[-1], i))]) > room:
                groups.append([])
            groups[-1].append(i)
        for group in groups:
            yield from self._part([*keys, *group], needed, numbered).__rich_console__(console, options)

    def _width(self, i: int, broken: bool = False) -> int:
        """Return the least width of a column in characters; if `broken`, the heading may be wrapped."""
        texts = [cell.plain if isinstance(cell, Text) else str(cell) for cell in self.columns[i].cells]
        heading = str(self.columns[i].header)
        lines = [line for text in texts for line in text.split("\n")]
        whole = max(map(cell_len, (*lines, *(heading.split() if broken else [heading]))), default=0)
        return whole if self.columns[i].no_wrap else min(whole, _WORDS)

    def _part(self, places: Sequence[int], needed: Sequence[int], numbered: bool) -> Table:
        """Make a table from the columns with indices `places`, with row numbers in front if `numbered`.

        `needed` contains the width of each column of the table; headings are broken to fit into it.
        """
        made = Table(box=self.box, padding=self.padding)
        if numbered:
            made.add_column("", justify="right", no_wrap=True)
        for i in places:
            column = self.columns[i]
            heading = "\n".join(textwrap.wrap(str(column.header), needed[i]))
            # Cells are cut only if the screen is too narrow for a single column.
            overflow = "fold" if column.no_wrap else "ellipsis"
            made.add_column(heading, justify=column.justify, no_wrap=column.no_wrap, overflow=overflow)
        cells = [[*self.columns[i].cells] for i in places]
        for k, row in enumerate(self.rows):
            first = [f"{k + 1}"] if numbered else []
            made.add_row(*first, *(column[k] for column in cells), end_section=row.end_section)
        return made


def _total(widths: Sequence[int]) -> int:
    """Return the width of a table whose columns have these widths, in characters."""
    return sum(widths) + _BETWEEN * len(widths) + _EDGES


BEYOND = "dim"  # style of digits that are smaller than the number's error


def set_apart(text: str, error: float) -> Text:
    """Return the text of a number; digits smaller than its absolute error are dimmed."""
    sure = count_sure(text, error)
    return Text.assemble(text[:sure], (text[sure:], BEYOND))


def table(
    title: str,
    columns: Sequence[str],
    rows: Iterable[Sequence[str | Text]],
    left: Sequence[int] = (0,),
    keys: int = 1,
) -> Group:
    """Make a table of texts; it is split into several tables if it is too wide for the screen.

    Parameters
    ----------
    title : str
        Title above the table.
    columns : sequence of str
        Headings.
    rows : iterable of sequences of str or Text
        Cells; an empty row draws a line.
    left : sequence of int
        Indices of columns that are left-aligned, such as words; numbers are right-aligned.
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


def table_of(columns: Columns, units: DisplayUnits, title: str = "", keys: int = 1) -> Group:
    """Make a table from the columns of a result in display units, followed by the notes on these columns.

    Words are left-aligned, numbers right-aligned.  A given `title` replaces the title of the columns.  The
    first `keys` columns identify a row.
    """
    shown = [_for_people(column, units) for column in columns.columns if column.words is not None]
    left = [i for i, column in enumerate(shown) if isinstance(next(iter(column.values), None), str)]
    heads, cells = [column.title for column in shown], zip(*map(_cells, shown), strict=True)
    made = table(title or columns.title, heads, cells, left, keys)
    return Group(made, *map(Text, columns.note.splitlines()))


def _for_people(column: Column, units: DisplayUnits) -> Column:
    """Convert a column to display units: angles in degrees, lengths in mm unless another unit is given."""
    return column.times(180 / pi, "deg") if column.unit == "rad" else column.in_units(units, "mm")


def _cells(column: Column) -> Sequence[str | Text]:
    """Return the text of each cell of a column: the given text, or else the formatted value."""
    given = column.cells
    if given is None:
        return _values(column)
    if all(each is not None for each in given):
        return given
    return [value if cell is None else cell for value, cell in zip(_values(column), given, strict=True)]


def _values(column: Column) -> Sequence[str | Text]:
    """Format the values of a column for a table, with the digits that their errors support."""
    form = column.form or (".6g" if column.error is None else supported)
    if isinstance(form, str):
        return [each if isinstance(each, str) else format(each, form) for each in column.plain]
    errors = [0.0] * len(column.values) if column.error is None else column.error.tolist()
    texts = [*map(form, column.plain, errors)]
    return texts if column.beyond is None else [*map(set_apart, texts, column.beyond.tolist())]


def comparison_table(title: str, rows: Iterable[Comparison]) -> Group:
    """Make a table of comparisons; a line separates rows whose `what` differs in its first two words."""
    cells: list[list[str]] = []
    topics: list[list[str]] = []
    for row in rows:
        topic = row.what.replace(",", "").split()[:2]
        cells += [[]] if topics and topics[-1] != topic else []
        cells.append(row.cells())
        topics.append(topic)
    heads = ("what", "published by", "published", "ours", "deviation", "verdict")
    return table(title, heads, cells, (0, 1, 5))
