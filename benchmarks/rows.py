"""Rows of measurements, printed and in Markdown, and measurement of times."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Callable, Iterable, Iterator, Sequence
from pathlib import Path
from time import perf_counter
from typing import TypeVar

from rich.console import Console
from rich.markup import escape
from rich.table import Table

AnyRow = TypeVar("AnyRow", bound=Sequence[str])
Row = tuple[str, str, str]  # measured quantity, value, and bound
RUNS = 7  # number of repetitions, of which the shortest counts


def best_time(
    action: Callable[[], object], runs: int = RUNS, clock: Callable[[], float] = perf_counter
) -> float:
    """Measure the shortest of several runs [s], as other programs on the machine only lengthen a run."""
    times = []
    for _ in range(runs):
        start = clock()
        action()
        times.append(clock() - start)
    return min(times)


def time_of_version(folder: Path, script: str) -> float:
    """Run a script that prints a time [s], with the version of the program that a folder holds."""
    set_to = os.environ | {"OPENBLAS_NUM_THREADS": "1", "PYTHONPATH": str(folder)}
    done = subprocess.run(
        [sys.executable, "-c", script], cwd=folder, env=set_to, check=True, capture_output=True, text=True
    )
    return float(done.stdout)


def show(title: str, *parts: Callable[[], Iterator[Row]]) -> list[Row]:
    """Print the rows of all measurements as one table, and return the rows."""
    return show_table(("what", "measured", "bound"), (row for part in parts for row in part()), title, 120)


def show_table(
    head: Sequence[str], rows: Iterable[AnyRow], title: str | None = None, width: int = 160
) -> list[AnyRow]:
    """Print rows below a line of headings, and return the rows."""
    table, shown = Table(*head, title=title), list(rows)
    for row in shown:
        table.add_row(*map(escape, row))
    Console(width=width).print(table)
    return shown


def markdown_table(head: Sequence[str], body: Iterable[Sequence[str]]) -> str:
    """Write a table in Markdown."""
    lines = [head, ["---"] * len(head), *body]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def time_text(time: float) -> str:
    """Format a time [s] with three digits, in s, ms or µs."""
    for unit, size in (("s", 1.0), ("ms", 1e-3)):
        if time >= size:
            return f"{time / size:.3g} {unit}"
    return f"{time / 1e-6:.3g} µs"
