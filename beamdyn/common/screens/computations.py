"""Computations of a page: one at a time; of the requests made meanwhile, only the last is run next."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from time import monotonic
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.screens.processes import TakesTooLong

SOON = 0.15  # time after which the page shows "computing" [s], so that users see it within 0.3 s
_LOG = logging.getLogger(__name__)
_PATIENCE = 2.0  # age at which a computation is ended if a newer one waits [s]; a new process takes 1 s


class LatestComputation:
    """The running computation of a page, and the computation that will run next.

    Parameters
    ----------
    settle : callable
        Called with the future of each finished computation, and whether no newer one was requested.
    fail : callable
        Called with the error if `settle` raises one because the result cannot be shown.
    tell : callable
        Called when `slow` or `busy` has changed, and each second during a long computation.

    Attributes
    ----------
    slow : bool
        Whether a computation has taken so long that the page should show that it computes.
    waited : float
        Elapsed time of the running computation [s].
    usual : float
        Total time of the last long computation [s]; 0 if there has been none.
    """

    def __init__(
        self,
        settle: Callable[[asyncio.Future[Any], bool], object],
        fail: Callable[[Exception], object],
        tell: Callable[[], object] = lambda: None,
    ) -> None:
        self.slow, self.waited, self.usual = False, 0.0, 0.0
        self._show, self._fail, self._tell = settle, fail, tell
        self._wanted: Callable[[], asyncio.Future[Any]] | None = None
        self._future: asyncio.Future[Any] | None = None
        # Whether a newer request terminates the running computation, or the next one once it runs.
        self._gives_way = self._wanted_gives_way = False
        self._task: asyncio.Task[None] | None = None

    @property
    def busy(self) -> bool:
        """Return whether a computation is running."""
        return self._task is not None

    def want(self, start: Callable[[], asyncio.Future[Any]], gives_way: bool = False) -> None:
        """Start a computation, or let it wait for the running one; it replaces another that waits.

        Parameters
        ----------
        start : callable
            ``start()`` starts the computation, and returns its future.
        gives_way : bool
            Whether the computation takes long, and is terminated as soon as a newer one is requested.
        """
        self._wanted, self._wanted_gives_way = start, gives_way
        if self._task is not None and self._future is not None and self._gives_way:
            self._future.cancel()
        if self._task is None:
            future = self._next()
            if future.done():
                self._settle(future, True)
            else:
                self._task = background_tasks.create(self._follow(future))

    def cancel(self) -> None:
        """Cancel the running computation and the waiting one."""
        self._wanted = None
        if self._future is not None:
            self._future.cancel()

    async def done(self) -> None:
        """Wait until no computation is running."""
        while self._task is not None:
            await asyncio.wait([self._task])

    def _next(self) -> asyncio.Future[Any]:
        """Start the waiting computation; if that fails, return a future with the error."""
        assert self._wanted is not None
        start, self._wanted = self._wanted, None
        self._gives_way = self._wanted_gives_way
        try:
            self._future = start()
        except Exception as error:
            self._future = asyncio.get_running_loop().create_future()
            self._future.set_exception(error)
        return self._future

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        try:
            self._show(future, last)
        except Exception as error:  # else the page would show "computing" forever
            _LOG.exception("what has been computed cannot be shown")
            self._fail(error)

    @property
    def words(self) -> str:
        """Describe the elapsed time, and the remaining time if the duration is as last time.

        The text is empty in the first second.
        """
        if self.waited < 1:
            return ""
        left = self.usual - self.waited
        return f"{self.waited:.0f} s" + (f", about {left:.0f} s left" if left >= 1 else "")

    def _count(self, waited: float) -> None:
        """Store the elapsed time; once a second, let the page show that the computation takes long."""
        tells = not self.slow or int(waited) > int(self.waited)
        self.slow, self.waited = True, waited
        if tells:
            self._tell()

    async def _follow(self, future: asyncio.Future[Any]) -> None:
        """Wait for the running computation and show its result; then run the computation requested meanwhile.

        A long computation whose result is no longer needed is terminated.
        """
        try:
            while True:
                start, self.waited = monotonic(), 0.0
                await asyncio.wait([future], timeout=SOON)
                while not future.done():
                    self._count(monotonic() - start)
                    if self._wanted is not None and self.waited > _PATIENCE:
                        future.cancel()
                    await asyncio.wait([future], timeout=SOON)
                if self.slow and not future.cancelled():
                    self.usual = monotonic() - start
                if self._wanted is None:
                    break
                done, future = future, self._next()
                # The next computation is started before the last result is shown, as showing takes time.
                await asyncio.sleep(0)
                if not done.cancelled():
                    self._settle(done, False)
        finally:
            self._task, self.slow, self.waited = None, False, 0.0
        self._settle(future, True)


class BusyRow:
    """A row that shows that something is being computed, the elapsed time, and a button to cancel.

    Parameters
    ----------
    cancel : callable
        Cancels the computation.
    words : str
        Name of the computation for screen readers; empty if a text beside the row names it.
    """

    def __init__(self, cancel: Callable[[], object], words: str = "") -> None:
        self._row: Any = ui.row().classes("items-center gap-2")
        with self._row:
            said = f'role="status" aria-label="{words}"' if words else 'aria-hidden="true"'
            ui.spinner(size="sm").props(said)
            self._time: Any = ui.label().classes("status")
            ui.button("Cancel", on_click=cancel).props("dense outline no-caps size=sm")
        self._row.set_visibility(False)

    @property
    def parts(self) -> tuple[Any, ...]:
        """Return the elements that `show` changes."""
        return self._row, self._time

    def show(self, busy: bool, time: str = "") -> None:
        """Show the row with the elapsed time, or hide it."""
        self._row.set_visibility(busy)
        self._time.set_text(time)


class FileMaking:
    """Makes files for download; a row shows name, elapsed time and a button to cancel if this takes long.

    A file that is requested meanwhile is made next.
    """

    def __init__(self) -> None:
        self._way = LatestComputation(self._settle, self._fail, self._tell)
        self._name = ""
        self._row: Any = ui.element("div").classes("making")
        with self._row:
            self._busy = BusyRow(self._way.cancel, "a file is being made")

    def want(self, name: str, start: Callable[[], asyncio.Future[str]]) -> None:
        """Make a file with the given name from the future that ``start()`` returns, and download it."""
        self._name = name
        self._way.want(start)

    def close(self) -> None:
        """Cancel the file that is being made, because the page was closed."""
        self._way.cancel()

    def _tell(self) -> None:
        self._busy.show(self._way.slow, f"{self._name} {self._way.words}".rstrip())

    def _settle(self, future: asyncio.Future[str], last: bool) -> None:
        if self._row.is_deleted:
            return
        self._tell()
        with self._row:  # notifications are shown on the page that has this row
            if future.cancelled():
                ui.notify(f"{self._name} was cancelled")
            elif isinstance(error := future.exception(), TakesTooLong | BrokenExecutor):
                ui.notify(f"{self._name} was given up: {error}", type="negative")
            else:
                ui.download.content(future.result().encode(), self._name)

    def _fail(self, error: Exception) -> None:
        with self._row:
            ui.notify(f"{self._name} was given up: {error}", type="negative")


async def download(making: asyncio.Future[Any], name: str) -> None:
    """Download bytes or a text as a file when ready; notify the user if that takes long, or fails.

    Parameters
    ----------
    making : asyncio.Future
        Future whose result is the content, from `RunsTasks.submit`.
    name : str
        Name of the file.
    """
    await asyncio.wait([making], timeout=SOON)
    if not making.done():
        ui.notify(f"{name} is being made")
    try:
        made = await making
    except (TakesTooLong, BrokenExecutor) as error:
        ui.notify(f"{name} was given up: {error}", type="negative")
        return
    ui.download.content(made.encode() if isinstance(made, str) else made, name)
