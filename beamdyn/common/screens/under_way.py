"""The computations of a page: one at a time; of those asked for meanwhile only the newest follows."""

from __future__ import annotations

import asyncio
import logging
from collections.abc import Callable
from time import monotonic
from typing import Any

from nicegui import background_tasks

SOON = 0.15  # time after which the page says that it computes [s]; the message is there within 0.3 s
_LOG = logging.getLogger(__name__)
_PATIENCE = 2.0  # time after which what is no longer wanted is ended [s]; another process takes 1 s to start


class UnderWay:
    """The computation that is under way, and the one that follows it.

    Parameters
    ----------
    settle : callable
        Called with the future of each computation that is done, and whether nothing newer is wanted.
    fail : callable
        Called with the error if `settle` raises one: the result cannot be shown.
    tell : callable
        Called when `slow` or `busy` has changed.

    Attributes
    ----------
    slow : bool
        Whether a computation has taken so long that the page should say so.
    """

    def __init__(
        self,
        settle: Callable[[asyncio.Future[Any], bool], object],
        fail: Callable[[Exception], object],
        tell: Callable[[], object] = lambda: None,
    ) -> None:
        self.slow = False
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
        """Start what is wanted."""
        assert self._wanted is not None
        start, self._wanted = self._wanted, None
        self._future = _started(start)
        return self._future

    def _settle(self, future: asyncio.Future[Any], last: bool) -> None:
        try:
            self._show(future, last)
        except Exception as error:  # whatever it is: the page must not go on saying that it computes
            _LOG.exception("what has been computed cannot be shown")
            self._fail(error)

    async def _follow(self, future: asyncio.Future[Any]) -> None:
        try:
            await self._wait(future)
            while self._wanted is not None:
                done, future = future, self._next()
                await asyncio.sleep(0)  # it is on its way before the last one is shown, which takes its time
                if not done.cancelled():
                    self._settle(done, False)
                await self._wait(future)
        finally:
            self._task, self.slow = None, False
        self._settle(future, True)

    async def _wait(self, future: asyncio.Future[Any]) -> None:
        """Wait for the computation under way; end it if it takes long and is no longer wanted."""
        start = monotonic()
        await asyncio.wait([future], timeout=SOON)
        while not future.done():
            if not self.slow:
                self.slow = True
                self._tell()
            if self._wanted is not None and monotonic() - start > _PATIENCE:
                future.cancel()
            await asyncio.wait([future], timeout=SOON)


def _started(start: Callable[[], asyncio.Future[Any]]) -> asyncio.Future[Any]:
    """The future of a computation; one with the error if it cannot be started."""
    try:
        return start()
    except Exception as error:
        failed: asyncio.Future[Any] = asyncio.get_running_loop().create_future()
        failed.set_exception(error)
        return failed
