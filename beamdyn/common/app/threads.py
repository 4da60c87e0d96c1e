"""Work in a thread of its own, which the page does not wait for."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Future
from threading import Thread
from typing import TypeVar

Made = TypeVar("Made")


def in_thread(make: Callable[[], Made]) -> Future[Made]:
    """Start a function in a thread, which the end of the program does not wait for either."""
    future: Future[Made] = Future()
    future.set_running_or_notify_cancel()  # else a closed page cancels it, and its result is refused

    def run() -> None:
        try:
            future.set_result(make())
        except BaseException as error:  # handed on to whom asks for the result
            future.set_exception(error)

    Thread(target=run, daemon=True).start()
    return future
