"""Computations of a page: one runs at a time, and only the latest of those requested meanwhile follows."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from time import monotonic
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.screens.processes import TakesTooLong

SOON = 0.15  # time after which the page says that it computes [s]; the message is visible within 0.3 s
_LOG = logging.getLogger(__name__)
_PATIENCE = 2.0  # time after which an unwanted computation is ended [s]; a new process takes 1 s to start


class LatestComputation:
    """The running computation of a page, and the one that follows it.

    Parameters
    ----------
    settle : callable
        Called with the future of each computation that is done, and whether nothing newer is wanted.
    fail : callable
        Called with the error if `settle` raises one: the result cannot be shown.
    tell : callable
        Called when `slow` or `busy` has changed, and each second during a long computation.

    Attributes
    ----------
    slow : bool
        Whether a computation has taken so long that the page should say so.
    waited : float
        Time that the running computation has taken so far [s].
    usual : float
        Time that the last long computation took in all [s]; 0 if there has been none.
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
        self._gives_way = self._wanted_gives_way = False  # for the running computation and the next one
        self._task: asyncio.Task[None] | None = None

    @property
    def busy(self) -> bool:
        """Whether a computation is running."""
        return self._task is not None

    def want(self, start: Callable[[], asyncio.Future[Any]], gives_way: bool = False) -> None:
        """Start a computation, or let it follow the running one in place of another that waited.

        Parameters
        ----------
        start : callable
            ``start()``: the future of the computation.
        gives_way : bool
            Whether the computation takes long, and is ended as soon as a newer one is wanted.
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
        """Cancel the running computation, and the one that waits."""
        self._wanted = None
        if self._future is not None:
            self._future.cancel()

    async def done(self) -> None:
        """Wait until no computation is under way."""
        while self._task is not None:
            await asyncio.wait([self._task])

    def _next(self) -> asyncio.Future[Any]:
        """Start the computation that waits; if that fails, return a future that holds the error."""
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
        except Exception as error:  # any exception at all: the page must not go on saying that it computes
            _LOG.exception("what has been computed cannot be shown")
            self._fail(error)

    @property
    def words(self) -> str:
        """Describe the time taken, and the time left if this takes as long as the last.

        Empty in the first second.
        """
        if self.waited < 1:
            return ""
        left = self.usual - self.waited
        return f"{self.waited:.0f} s" + (f", about {left:.0f} s left" if left >= 1 else "")

    def _count(self, waited: float) -> None:
        """Store the time waited, and tell the page once a second that the computation takes long."""
        tells = not self.slow or int(waited) > int(self.waited)
        self.slow, self.waited = True, waited
        if tells:
            self._tell()

    async def _follow(self, future: asyncio.Future[Any]) -> None:
        """Wait for the running computation, and show its result; then go on with the one wanted meanwhile.

        A computation that takes long and is no longer wanted is ended.
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
                # The new computation is sent off before the last result is shown, which takes time.
                await asyncio.sleep(0)
                if not done.cancelled():
                    self._settle(done, False)
        finally:
            self._task, self.slow, self.waited = None, False, 0.0
        self._settle(future, True)


class BusyRow:
    """A row that says that something is being computed, and for how long, with a button to cancel it.

    Parameters
    ----------
    cancel : callable
        Cancels the computation.
    words : str
        What is computed, for screen readers; empty where a text beside the row says it.
    """

    def __init__(self, cancel: Callable[[], object], words: str = "") -> None:
        self._row: Any = ui.row().classes("items-center gap-2")
        with self._row:
            said = f'role="status" aria-label="{words}"' if words else 'aria-hidden="true"'
            ui.spinner(size="sm").props(said)
            self._time: Any = ui.label().classes("status")
            ui.button("Cancel", on_click=cancel).props("dense outline no-caps size=sm")
        self._row.set_visibility(False)

    def show(self, busy: bool, time: str = "") -> None:
        """Show the row with the time taken so far, or hide it."""
        self._row.set_visibility(busy)
        self._time.set_text(time)


class FileMaking:
    """Making of files for download, with a row while it takes long: name, time taken, a button to cancel it.

    A file that is asked for meanwhile is made next.
    """

    def __init__(self) -> None:
        self._way = LatestComputation(self._settle, self._fail, self._tell)
        self._name = ""
        self._row: Any = ui.element("div").classes("making")
        with self._row:
            self._busy = BusyRow(self._way.cancel, "a file is being made")

    def want(self, name: str, start: Callable[[], asyncio.Future[str]]) -> None:
        """Have a file of a name made by what ``start()`` returns, and download it."""
        self._name = name
        self._way.want(start)

    def close(self) -> None:
        """Cancel the file that is being made, as the page is gone."""
        self._way.cancel()

    def _tell(self) -> None:
        self._busy.show(self._way.slow, f"{self._name} {self._way.words}".rstrip())

    def _settle(self, future: asyncio.Future[str], last: bool) -> None:
        if self._row.is_deleted:
            return
        self._tell()
        with self._row:  # notifications go to the page that has this row
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
    """Download bytes or a text as a file when they have been made; notify if that takes long, or fails.

    Parameters
    ----------
    making : asyncio.Future
        Future of the content, from `RunsTasks.submit`.
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
