"""Computations of a page: one at a time, then the newest of those asked for meanwhile; downloads."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from concurrent.futures import BrokenExecutor
from time import monotonic
from typing import Any

from nicegui import background_tasks, ui

from beamdyn.common.screens.processes import TakesTooLong

SOON = 0.15  # time after which the page says that it computes [s]; the message is there within 0.3 s
_LOG = logging.getLogger(__name__)
_PATIENCE = 2.0  # time after which what is no longer wanted is ended [s]; another process takes 1 s to start


class LatestComputation:
    """The computation that is under way, and the one that follows it.

    Parameters
    ----------
    settle : callable
        Called with the future of each computation that is done, and whether nothing newer is wanted.
    fail : callable
        Called with the error if `settle` raises one: the result cannot be shown.
    tell : callable
        Called when `slow` or `busy` has changed, and each second of what takes long.

    Attributes
    ----------
    slow : bool
        Whether a computation has taken so long that the page should say so.
    waited : float
        How long the one under way has taken [s].
    usual : float
        How long the last one that took long has taken in all [s]; 0 if none has.
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
        self._task: asyncio.Task[None] | None = None

    @property
    def busy(self) -> bool:
        """Whether something is under way."""
        return self._task is not None

    def want(self, start: Callable[[], asyncio.Future[Any]]) -> None:
        """Start a computation, or let it follow the one under way in place of another that waited."""
        self._wanted = start
        if self._task is None:
            future = self._next()
            if future.done():
                self._settle(future, True)
            else:
                self._task = background_tasks.create(self._follow(future))

    def cancel(self) -> None:
        """End the computation under way; nothing follows it."""
        self._wanted = None
        if self._future is not None:
            self._future.cancel()

    async def done(self) -> None:
        """Wait until no computation is under way."""
        if self._task is not None:
            await asyncio.wait([self._task])

    def _next(self) -> asyncio.Future[Any]:
        """Start what is wanted; the future of what cannot be started holds the error."""
        assert self._wanted is not None
        start, self._wanted = self._wanted, None
        try:
            self._future = start()
        except Exception as error:
            self._future = asyncio.get_running_loop().create_future()
            self._future.set_exception(error)
        return self._future

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        try:
            self._show(future, last)
        except Exception as error:  # whatever it is: the page must not go on saying that it computes
            _LOG.exception("what has been computed cannot be shown")
            self._fail(error)

    @property
    def words(self) -> str:
        """How long it has taken, and will if it is as the last time; empty within the first second."""
        if self.waited < 1:
            return ""
        left = self.usual - self.waited
        return f"{self.waited:.0f} s" + (f", about {left:.0f} s left" if left >= 1 else "")

    def _count(self, waited: float) -> None:
        """Tell that it takes long, and each second how long."""
        tells = not self.slow or int(waited) > int(self.waited)
        self.slow, self.waited = True, waited
        if tells:
            self._tell()

    async def _follow(self, future: asyncio.Future[Any]) -> None:
        """Show what is under way when it is done, and so with what was wanted meanwhile.

        What takes long and is no longer wanted is ended.
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
                await asyncio.sleep(0)  # it is on its way before the last one is shown, which takes its time
                if not done.cancelled():
                    self._settle(done, False)
        finally:
            self._task, self.slow, self.waited = None, False, 0.0
        self._settle(future, True)


async def download(making: asyncio.Future[Any], name: str) -> None:
    """Download bytes or a text as a file when they have been made; notify if that takes long, or fails.

    Parameters
    ----------
    making : asyncio.Future
        From `RunsTasks.submit`.
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
