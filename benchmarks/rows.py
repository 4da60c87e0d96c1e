"""Rows of measurements, printed and in Markdown, and the clock that times them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from time import perf_counter

from rich.console import Console
from rich.markup import escape
from rich.table import Table

Row = tuple[str, str, str]  # what, measured, bound
RUNS = 7  # of which the shortest counts


def best_time(
    action: Callable[[], object], runs: int = RUNS, clock: Callable[[], float] = perf_counter
) -> float:
    """Shortest of several runs [s]: other programs on the machine only ever lengthen a run."""
    times = []
    for _ in range(runs):
        start = clock()
        action()
        times.append(clock() - start)
    return min(times)


def show(title: str, *parts: Callable[[], Iterator[Row]]) -> list[Row]:
    """Print the rows of all parts as one table, and return them."""
    table = Table("what", "measured", "bound", title=title)
    rows = [row for part in parts for row in part()]
    for row in rows:
        table.add_row(*map(escape, row))
    Console(width=120).print(table)
    return rows


def markdown_table(head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """A table in Markdown."""
    lines = [head, ["---"] * len(head), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def time_text(time: float) -> str:
    """A time [s] to three digits, in s, ms or µs."""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if time >= size:
            return f"{time / size:.3g} {unit}"
    return f"{time / 1e-6:.3g} µs"
