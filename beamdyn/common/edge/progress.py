"""A progress line on standard error, which appears when a command takes more than a second."""

from __future__ import annotations

import sys
import time
from bisect import bisect_right
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from contextvars import ContextVar
from datetime import timedelta
from threading import RLock, Timer
from typing import TYPE_CHECKING

from rich.console import Console
from rich.text import Text

if TYPE_CHECKING:
    from rich.progress import Progress

SILENCE = 1.0  # computing time after which the progress line appears [s]

# The progress line that is in use in this context; None if there is none.
_LINE: ContextVar[_ProgressLine | None] = ContextVar("line", default=None)


class Pace:
    """Estimate of the remaining time from steps in the last half of the elapsed time: steps may speed up."""

    def __init__(self) -> None:
        self._times: list[float] = []
        self._counts: list[int] = []

    def note(self, now: float, done: int) -> None:
        """Store how many steps are done at a time [s]."""
        self._times.append(now)
        self._counts.append(done)

    def left(self, now: float, total: int) -> float | None:
        """Return the time [s] that the remaining steps take; None until a step has ended."""
        if not self._times or self._counts[-1] == self._counts[0]:
            return None
        last, done = self._times[-1], self._counts[-1]
        since = bisect_right(self._times, (self._times[0] + last) / 2) - 1
        each = (last - self._times[since]) / max(done - self._counts[since], 1)
        return max((total - done) * each - (now - last), 0.0)


class _ProgressLine:
    """The progress line: the elapsed time, and a bar with the remaining time where steps are counted."""

    def __init__(self, what: str) -> None:
        self._what, self._began = what, time.monotonic()
        self._done, self._total, self._pace = 0, None, Pace()
        self._lock, self._timer, self._shown = RLock(), None, None

    def begin(self) -> None:
        """Show the line after a second, unless it is hidden before."""
        self._timer = Timer(SILENCE, self._show)
        self._timer.daemon = True
        self._timer.start()

    def hide(self) -> None:
        """Remove the line from the screen; keep the counts."""
        with self._lock:
            timer, self._timer = self._timer, None
            shown, self._shown = self._shown, None
        if timer is not None:
            timer.cancel()
        if shown is not None:
            shown.stop()

    def count(self, done: int, total: int) -> None:
        """Store the number of steps that are done, and of all."""
        with self._lock:
            self._done, self._total = done, total
            self._pace.note(time.monotonic(), done)
            if self._shown is not None:
                self._update(self._shown)

    def _show(self) -> None:
        with self._lock:
            if self._timer is None:  # the line was hidden while this waited
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
        """A column with the remaining time, where steps are counted."""

        max_refresh = 0.5

        def render(self, task: Task) -> Text:
            if task.total is None:
                return Text()
            left = pace.left(time.monotonic(), int(task.total))
            shown = "-:--:--" if left is None else str(timedelta(seconds=round(left)))
            return Text(f"{shown} left", style="progress.remaining")

    counted = TextColumn("{task.description}"), BarColumn(), TextColumn("{task.fields[count]}")
    screen = Console(stderr=True, force_terminal=True)
    # Without this, output redirected to a file would be printed on the terminal.
    return Progress(
        *counted, TimeElapsedColumn(), Remaining(),
        console=screen, transient=True, redirect_stdout=False, redirect_stderr=False,
    )  # fmt: skip


@contextmanager
def at_work(what: str) -> Iterator[Callable[[int, int], None]]:
    """Show progress during the work in this context, if standard error is a terminal.

    Parameters
    ----------
    what : str
        Name of the work, such as "designs". A line within another one takes its place.

    Yields
    ------
    callable
        To be called with the numbers of steps that are done and of all; without calls the line has no bar.
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
    """Hide the progress line in this context, so that something can be printed; it returns after a second."""
    line = _LINE.get()
    if line is None:
        yield
        return
    line.hide()
    try:
        yield
    finally:
        line.begin()
