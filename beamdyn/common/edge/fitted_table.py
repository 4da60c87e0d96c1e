"""A table that is never cut: columns that do not fit on the screen follow below."""

from __future__ import annotations

import textwrap
from collections.abc import Iterator, Sequence

from rich import box
from rich.cells import cell_len
from rich.console import Console, ConsoleOptions, RenderResult
from rich.table import Table
from rich.text import Text

_BETWEEN, _EDGES = 3, 1  # characters that a column, and a table, have beside their text
_WORDS = 16  # least width of a column of words, in characters


class FittedTable(Table):
    """A table whose numbers are never cut.

    Where it is wider than the screen its headings are broken between words; where that does not suffice its
    columns stand in several tables below each other, each with the key columns, or with the number of the row
    where there is no room for these.

    Parameters
    ----------
    columns : sequence of str
        Headings.
    left : sequence of int
        Columns of words, which are flush left and may be wrapped; numbers are flush right.
    keys : int
        Number of first columns that identify a row.
    """

    def __init__(self, columns: Sequence[str], left: Sequence[int], keys: int = 1) -> None:
        super().__init__(box=box.SIMPLE_HEAD, padding=(0, 2, 0, 0))
        self._keys = keys
        for i, heading in enumerate(columns):
            self.add_column(heading, justify="left" if i in left else "right", no_wrap=i not in left)

    def __rich_console__(self, console: Console, options: ConsoleOptions) -> RenderResult:
        """Yield the table, or its parts."""
        width = options.max_width
        if _total(self._widths(range(len(self.columns)))) <= width:
            yield from super().__rich_console__(console, options)
            return
        for part in self._parts(width):
            yield from part.__rich_console__(console, options)

    # Widths -----------------------------------------------------------------------------------------

    def _widths(self, columns: Sequence[int], broken: bool = False) -> list[int]:
        """Least widths of columns, in characters; headings may be broken between words if `broken`."""
        return [self._width(i, broken) for i in columns]

    def _width(self, i: int, broken: bool) -> int:
        cells = max((_longest(cell) for cell in self.columns[i].cells), default=0)
        heading = str(self.columns[i].header)
        parts = heading.split() if broken else [heading]
        whole = max([cells, *map(cell_len, parts)])
        return whole if self.columns[i].no_wrap else min(whole, _WORDS)

    # Parts ------------------------------------------------------------------------------------------

    def _parts(self, width: int) -> Iterator[Table]:
        """Yield tables with some of the columns each, no wider than the screen."""
        places = [*range(len(self.columns))]
        keys, others = places[: self._keys], places[self._keys :]
        needed = dict(zip(places, self._widths(places, broken=True), strict=True))
        widest = max((needed[i] for i in others), default=0)
        numbered = _total([*(needed[i] for i in keys), widest]) > width
        if numbered:
            keys, others = [], places
        first = [cell_len(str(self.row_count))] if numbered else [needed[i] for i in keys]
        group: list[int] = []
        for i in others:
            if group and _total([*first, *(needed[k] for k in (*group, i))]) > width:
                yield self._part([*keys, *group], needed, numbered)
                group = []
            group.append(i)
        yield self._part([*keys, *group], needed, numbered)

    def _part(self, places: Sequence[int], needed: dict[int, int], numbered: bool) -> Table:
        """A table of some columns, with the numbers of the rows in front if `numbered`."""
        made = Table(box=self.box, padding=self.padding)
        if numbered:
            made.add_column("", justify="right", no_wrap=True)
        for i in places:
            column = self.columns[i]
            heading = "\n".join(textwrap.wrap(str(column.header), needed[i]))
            overflow = "fold" if column.no_wrap else "ellipsis"  # where not even one column has room
            made.add_column(heading, justify=column.justify, no_wrap=column.no_wrap, overflow=overflow)
        cells = [[*self.columns[i].cells] for i in places]
        for k, row in enumerate(self.rows):
            first = [f"{k + 1}"] if numbered else []
            made.add_row(*first, *(column[k] for column in cells), end_section=row.end_section)
        return made


def _longest(cell: object) -> int:
    text = cell.plain if isinstance(cell, Text) else str(cell)
    return max(map(cell_len, text.split("\n")), default=0)


def _total(widths: Sequence[int]) -> int:
    """Width of a table with columns of these widths."""
    return sum(widths) + _BETWEEN * len(widths) + _EDGES
