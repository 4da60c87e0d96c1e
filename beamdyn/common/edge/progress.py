"""A progress line on standard error, which appears when a command takes more than a second."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from threading import RLock, Timer
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.progress import Progress

SILENCE = 1.0  # time after which the line appears [s]

_LINE: ContextVar[_ProgressLine | None] = ContextVar("line", default=None)  # the present line


class _ProgressLine:
    """The line: the elapsed time, and a bar with the remaining time where steps are counted."""

    def __init__(self, what: str) -> None:
        self._what, self._began = what, time.monotonic()
        self._done, self._total = 0, None
        self._lock, self._timer, self._shown = RLock(), None, None

    def begin(self) -> None:
        """Show it after a second, unless it is hidden before."""
        self._timer = Timer(SILENCE, self._show)
        self._timer.daemon = True
        self._timer.start()

    def hide(self) -> None:
        """Take it from the screen; counts are kept."""
        with self._lock:
            timer, self._timer = self._timer, None
            shown, self._shown = self._shown, None
        if timer is not None:
            timer.cancel()
        if shown is not None:
            shown.stop()

    def count(self, done: int, total: int) -> None:
        """Set the numbers of steps that are done, and of all."""
        with self._lock:
            self._done, self._total = done, total
            if self._shown is not None:
                self._update(self._shown)

    def _show(self) -> None:
        with self._lock:
            if self._timer is None:  # hidden while this waited
                return
            self._shown = _bar()
            self._shown.add_task(self._what, total=None, count="")
            self._shown.tasks[0].start_time = self._began
            self._update(self._shown)
            self._shown.start()

    def _update(self, bar: Progress) -> None:
        count = "" if self._total is None else f"{self._done}/{self._total}"
        bar.update(bar.task_ids[0], completed=self._done, total=self._total, count=count)


def _bar() -> Progress:
    from rich.console import Console
    from rich.progress import BarColumn, Progress, Task, TextColumn, TimeElapsedColumn, TimeRemainingColumn
    from rich.text import Text

    class Remaining(TimeRemainingColumn):
        """The remaining time, where steps are counted."""

        def render(self, task: Task) -> Text:
            return Text() if task.total is None else super().render(task).append(" left")

    counted = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[count]}")
    screen = Console(stderr=True, force_terminal=True)
    # Redirected, a standard output that goes to a file would be printed on the terminal.
    return Progress(
        *counted, TimeElapsedColumn(), Remaining(),
        console=screen, transient=True, redirect_stdout=False, redirect_stderr=False,
    )  # fmt: skip


@contextmanager
def at_work(what: str) -> Iterator[Callable[[int, int], None]]:
    """Within it, a line shows progress on standard error, if that is a terminal.

    Parameters
    ----------
    what : str
        Name of the work, such as "designs". A line within another one takes its place.

    Yields
    ------
    callable
        To be called with the numbers of steps that are done and of all; the line has a bar only then.
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
    """Within it no line is shown, so that something can be printed; it returns after a second."""
    line = _LINE.get()
    if line is None:
        yield
        return
    line.hide()
    try:
        yield
    finally:
        line.begin()
